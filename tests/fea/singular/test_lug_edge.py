"""The exponent at a sharp edge of a lug: against the boundary conditions, known limits, and the
pressures of contact on rings that are graded towards the edge.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.tractions import Traction
from fea.harmonic.assembly import around
from fea.harmonic.model import HarmonicModel
from fea.singular.lug_edge import edge_exponent, lug_edge_exponent, next_power
from fea.singular.williams import plane_exponent
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.sizing import Grade
from tests.support.each import each, sampled

Complex = NDArray[np.complex128]

RIGHT = math.pi / 2.0
HALF_PLANE = -math.pi
E, NU, D = 210e9, 0.3, 0.02

materials = st.tuples(st.floats(-0.9, 0.49), st.floats(0.05, 20.0))  # nu, E of pin or lug


def material(nu: float, modulus: float) -> Material:
    return Material("m", modulus, nu)


def conditions(at: Complex, end: float) -> tuple[list[list[Complex]], list[list[Complex]]]:
    """Of one body from theta = 0 to `end`, on the stress function r^(L+1) f(theta): rows that are
    zero (shear at 0; hoop and shear stress at the end), and f and what is bound to the material in
    u_theta at 0. f = A cos (L+1)t + B sin (L+1)t + C cos (L-1)t + D sin (L-1)t.
    """
    p, m, none, one = at + 1.0, at - 1.0, np.zeros_like(at), np.ones_like(at)
    c, s, C, S = np.cos(p * end), np.sin(p * end), np.cos(m * end), np.sin(m * end)
    slope = [none, p, none, m]
    zero = [slope, [c, s, C, S], [-p * s, p * c, -m * S, m * C]]
    return zero, [[one, none, one, none], [none, none, none, -one], [-x for x in slope]]


def determinant(at: Complex, angle: float, pin: Material, lug: Material) -> Complex:
    """Of the eight conditions for each L in `at`: six zeros of one body, the same normal stress and
    the same normal displacement of both where they touch.
    """
    rows: list[list[Complex]] = []
    none = [np.zeros_like(at)] * 4
    shared: list[list[list[Complex]]] = []
    for body, end in ((pin, HALF_PLANE), (lug, angle)):
        zero, (f, of_material, slope) = conditions(at, end)
        mu, nu = body.lame[1], body.poisson_ratio
        moved = [(4.0 * (1.0 - nu) * a + b) / mu for a, b in zip(of_material, slope, strict=True)]
        first = body is pin
        rows += [[*row, *none] if first else [*none, *row] for row in zero]
        shared.append([f, moved])
    rows += [[*a, *(-x for x in b)] for a, b in zip(*shared, strict=True)]
    return np.asarray(np.linalg.det(np.moveaxis(np.array(rows), -1, 0)), dtype=np.complex128)


def zeros_between(
    low: float, high: float, angle: float, pin: Material, lug: Material
) -> int | None:
    """Zeros of the determinant in low < Re L < high, |Im L| < 6 / angle: turns of its phase; None
    where the path round them comes too near to one to count.
    """
    up = 6.0 / angle
    frame = (low - up * 1j, high - up * 1j, high + up * 1j, low + up * 1j, low - up * 1j)
    path = np.concatenate([np.linspace(a, b, 4000) for a, b in pairwise(frame)])
    values = determinant(path, angle, pin, lug)
    turns = np.angle(values[1:] / values[:-1])
    return None if np.abs(turns).max() > 1.0 else round(float(turns.sum()) / (2.0 * math.pi))


@each(
    ("lug_over_pin", "exponent"),
    [(0.1, 0.0378), (1 / 3, 0.1078), (1.0, 0.2260), (3.0, 0.3545), (10.0, 0.4443)],
)
def test_right_angles(lug_over_pin: float, exponent: float) -> None:
    """As in docs/theory.md. For one material Dundurs and Lee have 0.23: 2 cos pi L (sin^2 (pi L/2)
    - L^2) + sin^2 pi L = 0.
    """
    pin, lug = Material("pin", E, NU), Material("lug", lug_over_pin * E, NU)
    assert lug_edge_exponent(pin, lug) == pytest.approx(exponent, abs=5e-5)


def test_one_material_whatever_it_is() -> None:
    """By the equation of two quarter planes and a half plane; neither E nor nu counts."""
    s = edge_exponent(1.0, 1.0)
    L = 1.0 - s
    sine = math.sin(math.pi * L / 2.0)
    left = 2.0 * math.cos(math.pi * L) * (sine**2 - L**2) + math.sin(math.pi * L) ** 2
    assert left == pytest.approx(0.0, abs=1e-14)
    for nu in (-0.5, 0.0, 0.49):
        assert lug_edge_exponent(material(nu, 7.0), material(nu, 7.0)) == pytest.approx(s)


def test_the_next_term_is_from_that_of_a_punch_to_an_even_one() -> None:
    """Of a rigid lug the power is that of a punch, 1/2; it rises to 1 as the lug becomes soft."""
    powers = [
        next_power(Material("pin", E, NU), Material("lug", E * 10.0**x, NU))
        for x in (6.0, 2.0, 0.0, -2.0, -6.0)
    ]
    assert powers == sorted(powers)
    assert powers[0] == pytest.approx(0.5, abs=1e-5)
    assert powers[-1] == pytest.approx(1.0, abs=2e-3)  # as the root of the ratio


@each("angle", [0.3, 1.0, RIGHT, 2.0, 3.0])
def test_a_rigid_lug_is_a_punch(angle: float) -> None:
    assert edge_exponent(1.0, 0.0, angle) == pytest.approx(0.5, abs=1e-12)
    assert edge_exponent(1.0, 1e-12, angle) == pytest.approx(0.5, abs=1e-6)


@each("angle", [0.3, 1.0, RIGHT, 1.8, 2.5, 3.1])
def test_on_a_rigid_pin_a_lug_is_half_of_a_notch(angle: float) -> None:
    """Mirrored by the smooth rigid surface, of twice the angle: finite up to 90 degrees."""
    notch = plane_exponent(2.0 * angle, NU, "free", "free")
    assert edge_exponent(0.0, 1.0, angle) == pytest.approx(notch, abs=1e-9)
    assert edge_exponent(1e-9, 1.0, angle) == pytest.approx(notch, abs=1e-6)


@settings(max_examples=50)
@given(st.floats(-6.0, 4.0), st.floats(0.01, 2.0))
def test_a_stiffer_lug_is_more_singular(decades: float, more: float) -> None:
    low, high = (edge_exponent(10.0**x, 1.0) for x in (decades, decades + more))
    assert 0.0 < low < high < 0.5
    assert edge_exponent(10.0**decades * 1e-11, 1e-11) == pytest.approx(low, rel=1e-9)


@settings(max_examples=100, deadline=None)
@given(materials, materials, st.floats(0.2, 3.0))
def test_the_eigenvalue_satisfies_the_boundary_conditions(
    pin: tuple[float, float], lug: tuple[float, float], angle: float
) -> None:
    bodies = material(*pin), material(*lug)
    if s := lug_edge_exponent(*bodies, angle):
        value, scale = np.abs(determinant(np.array([1.0 - s, 0.5 + 1.0j]), angle, *bodies))
        assert value < 1e-10 * scale


@each(("lug", "angle"), [((0.3, 0.1), 2.0), ((0.3, 1.0), RIGHT), ((0.1, 10.0), 2.5)])
def test_no_other_is_stronger(lug: tuple[float, float], angle: float) -> None:
    """Up to just before the eigenvalue there is no zero; just behind it there is one."""
    bodies = material(NU, 1.0), material(*lug)
    L = 1.0 - lug_edge_exponent(*bodies, angle)
    counted = [zeros_between(0.1, L + step, angle, *bodies) for step in (-0.02, 0.02)]
    assert counted == [0, 1]


@pytest.mark.slow
@settings(max_examples=50, deadline=None)
@given(materials, materials, st.floats(0.3, 3.0))
def test_none_is_stronger_for_any(
    pin: tuple[float, float], lug: tuple[float, float], angle: float
) -> None:
    """Nor is there one at angles that are called finite; 0.02 keeps the path clear of L = 1."""
    bodies = material(*pin), material(*lug)
    L = 1.0 - lug_edge_exponent(*bodies, angle)
    counted = zeros_between(0.1, L - 0.02, angle, *bodies)
    assume(counted is not None)
    assert counted == 0


def graded_rings() -> Floats:
    """Ends of rings of a lug two diameters long, from 1e-4 diameters at both ends on, m."""
    near, length = D * np.geomspace(1e-4, 0.25, 20), 2.0 * D
    middle = np.linspace(0.25 * D, length - 0.25 * D, 8)[1:-1]
    return np.concatenate([[0.0], near, middle, length - near[::-1], [length]])


def flexibility(body: Pin, rings: list[str], of: Material, inwards: bool, start: float) -> Floats:
    """C_0 (1, R, R), m/Pa, as fea.support.contact.flexibility, on a mesh that is graded to the
    edges.
    """
    edges = ((D / 2.0, start), (D / 2.0, start + 2.0 * D))
    mesh = meridian_mesh(body, SectionSize(6.0), finer=[Grade(edges, 7e-5 * D, 0.0, 0.2)])
    model = HarmonicModel(body, mesh, of, ())
    model.pivot = 0.5
    push = np.array([-1.0 if inwards else 1.0, 0.0, 0.0])
    forces = model.forces(0, [(Traction(name, 0.0, push, np.zeros(3)),) for name in rings])
    work = forces.T @ model.displace(0, forces) / around(0)
    bands = [model.pin.band(name) for name in rings]
    return np.asarray(work / np.array([b.radius * b.length for b in bands])[:, None])[None]


@each("lug_over_pin", [0.1, 1.0, 10.0])
def test_contact_has_the_exponent(lug_over_pin: float) -> None:
    """A lug pressed onto a pin: pressures on rings from 0.0005 to 0.005 diameters off its edge grow
    with the exponent, to 0.005. The two next to the edge oscillate, as means over rings do there.
    """
    ends, pin_material, lug_material = (
        graded_rings(), Material("pin", E, NU), Material("lug", lug_over_pin * E, NU),
    )  # fmt: skip
    names = [f"ring {i}" for i in range(len(ends) - 1)]
    lengths = list(zip(np.diff(ends).tolist(), names, strict=True))
    over = Segment(D, D)
    pin = Pin("P", (over, *(Segment(x, D, connection=name) for x, name in lengths), over))
    lug = Pin("L", tuple(Segment(x, 3.0 * D, D, connection=name) for x, name in lengths))
    both = flexibility(pin, names, pin_material, True, D)
    both += flexibility(lug, [f"bore {name}" for name in names], lug_material, False, 0.0)
    z, count = 0.5 * (ends[1:] + ends[:-1]), len(names)
    bands = Bands(
        z, np.diff(ends), np.full(count, D / 2), np.zeros(count, int), np.full(count, -1e-5)
    )
    problem = ContactProblem(bands, both, np.full(count, 1e-13), [math.inf], 4)
    pressure = problem.solve(np.zeros((1, 2))).pressure[:, 0]
    seen = (z > 5e-4 * D) & (z < 5e-3 * D)
    slope = np.polyfit(np.log(z[seen]), np.log(pressure[seen]), 1)[0]
    assert -slope == pytest.approx(lug_edge_exponent(pin_material, lug_material), abs=0.005)


@pytest.mark.slow
@pytest.mark.parametrize("lug_over_pin", sampled([0.1, 1 / 3, 1.0, 3.0, 10.0], every=5))
def test_a_joint_has_the_exponent(lug_over_pin: float) -> None:
    """In the rings next to the first, whose mean pressure is not that in its middle, to 0.01."""
    pin_material, lug_material = Material("pin", E, NU), Material("lug", lug_over_pin * E, NU)
    over = Segment(D, D)
    pin = Pin("P", (over, Segment(2.0 * D, D, connection="L"), over))
    lug = Lug("L", 3.0 * D, lug_material, clearance=-2e-5)
    model = ContactModel(pin, pin_material, [lug], Resolution(60, 4, 0, 60.0))
    found = model.solve(PinLoads("pressed on", ("L",), np.zeros((1, 1, 3))))
    near = slice(1, 4)
    distance = found.bands.z[near] - D
    assert distance[-1] < 0.01 * D
    pressure = found.contact[0].pressure[near, 0]
    slope = np.polyfit(np.log(distance), np.log(pressure), 1)[0]
    assert -slope == pytest.approx(lug_edge_exponent(pin_material, lug_material), abs=0.01)

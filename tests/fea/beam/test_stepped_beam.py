"""The stepped beam against closed forms, statics and superposition."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.beam.round_section import Circle
from fea.beam.timoshenko import (
    AXIAL,
    MAX_CONE_CHANGE,
    MOMENT,
    SHEAR,
    TORQUE,
    InternalForces,
    stepped_beam,
)
from fea.core.material import Material
from fea.core.pin_loads import BODY_SURFACE, UnitLoad
from geometry import GeometryError, Pin, Segment
from tests.support.errors import raises
from tests.support.exact.beam_deflection import deflections
from tests.support.pins.plain_pins import COUPLE, PLAIN, PULL, SPIN, A, B, I, L, d


def kappa_g_a(steel: Material) -> float:
    nu = steel.poisson_ratio
    return 6 * (1 + nu) / (7 + 6 * nu) * steel.youngs_modulus / (2 * (1 + nu)) * A


def one(forces: InternalForces, z: float) -> list[float]:
    return [float(x) for x in forces.at(np.array([z]))[0, :, 0]]


def test_cantilever_under_a_uniform_load(steel: Material) -> None:
    """w = 1/L: w L^4 / (8 E I) + w L^2 / (2 kappa G A); exact."""
    forces = stepped_beam(PLAIN, steel, (B,), ("start",))
    EI = steel.youngs_modulus * I
    u, phi = deflections(forces, steel, np.array([L]))[0, :2, 0]
    assert u == pytest.approx(L**3 / (8 * EI) + L / (2 * kappa_g_a(steel)), rel=1e-12)
    assert phi == pytest.approx(L**2 / (6 * EI), rel=1e-12)
    assert one(forces, L / 3)[:2] == pytest.approx([2 / 3, L / 2 * (2 / 3) ** 2], rel=1e-12)


def test_it_is_the_same_from_the_other_end(steel: Material) -> None:
    """Held at z = L instead: V changes sign, M and u do not, the slope does."""
    a, b = (stepped_beam(PLAIN, steel, (B,), (end,)) for end in ("start", "end"))
    z = np.array([0.02, 0.1, 0.25])
    assert b.at(L - z)[:, MOMENT] == pytest.approx(a.at(z)[:, MOMENT], rel=1e-9)
    assert b.at(L - z)[:, SHEAR] == pytest.approx(-a.at(z)[:, SHEAR], rel=1e-9)
    u, v = deflections(a, steel, z), deflections(b, steel, L - z)
    assert v[:, 0] == pytest.approx(u[:, 0], rel=1e-9)
    assert v[:, 1] == pytest.approx(-u[:, 1], rel=1e-9)


def test_fixed_at_both_ends(steel: Material) -> None:
    """Ends -w L^2 / 12, middle w L^2 / 24 (the signs of M: at the ends as a cantilever's); middle
    w L^4 / (384 E I) + w L^2 / (8 kappa G A).
    """
    forces = stepped_beam(PLAIN, steel, (B,), ("start", "end"))
    assert one(forces, 0.0)[:2] == pytest.approx([0.5, L / 12], rel=1e-9)
    assert one(forces, L)[:2] == pytest.approx([-0.5, L / 12], rel=1e-9)
    assert one(forces, L / 2)[MOMENT] == pytest.approx(-L / 24, rel=1e-9)
    u = deflections(forces, steel, np.array([0.0, L / 2, L]))[:, 0, 0]
    EI = steel.youngs_modulus * I
    middle = L**3 / (384 * EI) + L / (8 * kappa_g_a(steel))
    assert u == pytest.approx([0.0, middle, 0.0], rel=1e-9, abs=1e-9 * middle)


def test_fixed_ends_share_a_load_off_the_middle(steel: Material) -> None:
    """A nearly point load at a: end moments P a b^2 / L^2 and P a^2 b / L^2 for a beam that shear
    hardly bends (slender: the shear's part is (d / L)^2, 4e-5 here).
    """
    a, width, span = 0.9, 1e-3, 3.0
    pin = Pin(
        "P",
        (
            Segment(a - width / 2, d),
            Segment(width, d, connection="B"),
            Segment(span - a - width / 2, d),
        ),
    )
    forces = stepped_beam(pin, steel, (B,), ("start", "end"))
    b = span - a
    left, right = one(forces, 0.0)[MOMENT], one(forces, span)[MOMENT]
    assert [left, right] == pytest.approx([a * b**2 / span**2, a**2 * b / span**2], rel=1e-3)


def test_a_clamped_band_is_rigid(steel: Material) -> None:
    """A lug that holds from z = 0.1 to 0.14: beyond it a cantilever, and nothing within."""
    pin = Pin("P", (Segment(0.1, d), Segment(0.04, d, name="lug"), Segment(L, d, connection="B")))
    forces = stepped_beam(pin, steel, (B,), ("lug",))
    assert one(forces, 0.14)[:2] == pytest.approx([1.0, L / 2], rel=1e-12)
    assert one(forces, 0.12) == [0.0] * 4
    assert one(forces, 0.05) == [0.0] * 4
    with raises(GeometryError, "unknown-surface", "'hub'"):
        stepped_beam(pin, steel, (B,), ("hub",))


STEPPED = Pin(
    "P", (Segment(0.1, 0.03), Segment(0.15, 0.02), Segment(0.05, 0.025, connection="B")), fillet=0.0
)


def test_a_stepped_beam_by_castigliano(steel: Material) -> None:
    """Tip deflection under a dummy tip force: int M m / E I + V v / kappa G A, by quadrature."""
    nu = steel.poisson_ratio
    forces = stepped_beam(STEPPED, steel, (B,), ("start",))
    total = 0.0
    x, g = np.polynomial.legendre.leggauss(20)
    for a, b, dia in ((0.0, 0.1, 0.03), (0.1, 0.25, 0.02), (0.25, 0.3, 0.025)):
        z = 0.5 * (a + b) + 0.5 * (b - a) * x
        M = np.where(z < 0.25, 0.275 - z, (0.3 - z) ** 2 / 2 / 0.05)
        V = np.where(z < 0.25, 1.0, (0.3 - z) / 0.05)
        area, inertia = math.pi / 4 * dia**2, math.pi / 64 * dia**4
        G = steel.youngs_modulus / 2 / (1 + nu)
        density = M * (0.3 - z) / (steel.youngs_modulus * inertia)
        density += V / (6 * (1 + nu) / (7 + 6 * nu) * G * area)
        total += 0.5 * (b - a) * float(g @ density)
    assert deflections(forces, steel, np.array([0.3]))[0, 0, 0] == pytest.approx(total, rel=1e-10)


def test_redundant_holding_of_a_stepped_beam_leaves_no_gap(steel: Material) -> None:
    """Integrated from the start, all four motions come back to zero at the end."""
    units = (B, COUPLE, PULL, SPIN, UnitLoad(BODY_SURFACE, "body", 1))
    forces = stepped_beam(STEPPED, steel, units, ("start", "end"))
    free = deflections(stepped_beam(STEPPED, steel, units, ("start",)), steel, np.array([0.3]))[0]
    held = deflections(forces, steel, np.array([0.3]))[0]
    assert np.abs(held).max() < 1e-9 * np.abs(free).max()
    V = forces.at(np.array([0.0, 0.3]))[:, SHEAR, 0]
    assert V[0] - V[1] == pytest.approx(1.0)


def test_torsion_and_tension_in_series(steel: Material) -> None:
    """At the end band's left edge the twist is sum L / G J, the stretch sum L / E A; held at both
    ends, the torque on each side is by the stiffness of the other.
    """
    forces = stepped_beam(STEPPED, steel, (SPIN, PULL), ("start",))
    J = [math.pi / 32 * x**4 for x in (0.03, 0.02)]
    areas = [math.pi / 4 * x**2 for x in (0.03, 0.02)]
    found = deflections(forces, steel, np.array([0.25]))[0]
    _, G = steel.lame
    assert found[TORQUE, 0] == pytest.approx((0.1 / J[0] + 0.15 / J[1]) / G, rel=1e-12)
    stretch = (0.1 / areas[0] + 0.15 / areas[1]) / steel.youngs_modulus
    assert found[AXIAL, 1] == pytest.approx(stretch, rel=1e-12)
    both = stepped_beam(STEPPED, steel, (SPIN,), ("start", "end"))
    soft = [0.1 / J[0], 0.15 / J[1], 0.05 / (math.pi / 32 * 0.025**4)]
    start, end = (one(both, z)[TORQUE] for z in (0.0, 0.3))
    assert start - end == pytest.approx(1.0)
    assert start / -end == pytest.approx((soft[2] / 2) / (soft[0] + soft[1] + soft[2] / 2))


def test_a_tube(steel: Material) -> None:
    """Cowper's coefficient: of the solid circle at no bore, 2 (1 + nu) / (4 + 3 nu) for a thin
    wall; the axial shift of a tube, and its bending.
    """
    nu = 0.3
    assert Circle(1.0).shear_coefficient(nu) == pytest.approx(6 * (1 + nu) / (7 + 6 * nu))
    thin = Circle(1.0, 0.9999).shear_coefficient(nu)
    assert thin == pytest.approx(2 * (1 + nu) / (4 + 3 * nu), rel=1e-6)
    tube = Pin("P", (Segment(L, d, 0.012, connection="B"),))
    forces = stepped_beam(tube, steel, (PULL,), ("start",))
    area = math.pi / 4 * (d**2 - 0.012**2)
    shift = deflections(forces, steel, np.array([L]))[0, AXIAL, 0]
    assert shift == pytest.approx(L / 2 / (steel.youngs_modulus * area), rel=1e-12)


@pytest.mark.parametrize("clamps", [("start",), ()])
def test_a_couple_along_its_band(clamps: tuple[str, ...], steel: Material) -> None:
    """w = 12 (z - L/2) / L^3 has the moment 1 and no force: V is a parabola of 3/2 / L in the
    middle, M falls from 1 to 0. Balanced, the same traction takes it up again.
    """
    forces = stepped_beam(PLAIN, steel, (COUPLE,), clamps)
    for z in (0.0, 0.1 * L, 0.25 * L, 0.5 * L, 0.8 * L, L):
        x = z / L - 0.5
        V = 6.0 / L * (0.25 - x**2) if clamps else 0.0
        M = 0.5 - 1.5 * x + 2.0 * x**3 if clamps else 0.0
        assert one(forces, z)[:2] == pytest.approx([V, M], rel=1e-12, abs=1e-12)


def test_cells_of_a_cone_change_little_from_one_to_the_next(steel: Material) -> None:
    """Each has the thinnest of its sections, which are equally apart from end to end."""
    cone = Segment(0.04, 0.02, end_diameter=0.03)
    pin = Pin("P", (Segment(0.01, 0.02), cone, Segment(0.01, 0.03, connection="A")))
    beam = stepped_beam(pin, steel, (UnitLoad("A", "force", 1),), ("start",))
    outer = np.array([s.outer for s in beam.sections])
    steps = np.diff(outer[1:-1])  # of the cells on the cone, whose first is as thin as the shaft
    assert outer[1] == pytest.approx(0.01)
    assert steps == pytest.approx(steps.mean())
    assert outer[-1] - outer[-2] == pytest.approx(steps.mean())
    assert steps.max() <= MAX_CONE_CHANGE * 0.02

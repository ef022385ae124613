"""Bounds of the limit load that were none: a lower bound above what plastic theory gives.

The beam took M^2 + N^2 + V^2 + T^2 <= 1 (each over its plastic value) for every round section. A
solid cantilever with M/Mp = N/Np was said to collapse at 1.58 to 2.23 times its loads where it does
at 1.400: a margin of collapse of +0.05 instead of -0.07. The elastic-plastic solid gave the factor
that its finest mesh reached as lower bound: 1.0043 of the exact one in bending.

Independent: the section as 4000 strips and a linear program (scipy, HiGHS) for what they carry
together; closed forms for tension, bending and torsion; for tension with torsion the least work of
flow of a bar that stretches and twists, by quadrature; and for shear stress fields of our own.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import linprog, minimize_scalar

import pinstress
from assess.plastic.hinge import beam_bounds
from assess.plastic.limit_load import bracket
from assess.plastic.solve import MESH_SIZES, limit_load
from assess.situation import Situation, SolvedRow
from assess.strength.collapse import COLLAPSE_METHOD, collapse
from fea.beam.plastic_interaction import bending_and_axial_use
from fea.beam.round_section import Circle
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment
from tests.support.each import each
from tests.support.exact.plastic import STEEL, YIELD, D, bar, limit

R, SHEAR_YIELD = D / 2.0, YIELD / math.sqrt(3.0)

SWING = """
title = "A notch, and a root that collapses at another time"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = 250
[analysis]
model = "harmonic"
tolerance = 0.5
[case.swing]
kind = "given"
table = "swing.csv"
[pin.P]
material = "steel"
clamp = ["start"]
profile = [
  { length = 100, diameter = 40 },
  { length = 20, diameter = 40, connection = "A" },
  { length = 10, diameter = 40, fillet = 0.2 },
  { length = 40, diameter = 16 },
  { length = 20, diameter = 16, connection = "B" },
]
"""


def _strips(bore: float, moment: float, axial: float, strips: int = 4000) -> float:
    """The largest factor on M (N m) and N (N) that strips of a section carry; bore in diameters."""
    y = (np.arange(strips) + 0.5) / strips * 2.0 * R - R
    inner = np.maximum((bore * R) ** 2 - y**2, 0.0)
    area = 2.0 * (np.sqrt(R**2 - y**2) - np.sqrt(inner)) * (2.0 * R / strips)
    scale = YIELD * area.sum()
    sums = np.array([np.append(area * YIELD, -axial), np.append(area * YIELD * y / R, -moment / R)])
    found = linprog(
        np.append(np.zeros(strips), -1.0),
        A_eq=sums / scale,
        b_eq=[0.0, 0.0],
        bounds=[(-1.0, 1.0)] * strips + [(0.0, None)],
    )
    assert found.x is not None
    return float(found.x[-1])


def _stretched_and_twisted(bore: float, axial: float, torque: float) -> float:
    """The least work of flow over the power of the loads, of a bar that stretches by e and twists
    by k, for e^2 + k^2 = 1 (k times the radius).
    """

    def ratio(angle: float) -> float:
        e, k = math.cos(angle), math.sin(angle)
        work = quad(
            lambda r: YIELD * math.hypot(e, k * r / R / math.sqrt(3.0)) * 2.0 * math.pi * r,
            bore * R,
            R,
        )[0]
        return float(work / (axial * e + torque * k / R))

    return float(minimize_scalar(ratio, bounds=(0.0, math.pi / 2.0), method="bounded").fun)


def _ends(moment: float, axial: float, torque: float) -> PinLoads:
    """The same moment, axial force and torque all along the middle of tests.support's bar."""
    forces, moments = np.zeros((2, 1, 2, 3))
    forces[0, :, 2] = -axial, axial
    moments[0, :, 1] = moment, -moment
    moments[0, :, 2] = torque, -torque
    return PinLoads("ends", ("a", "b"), forces, moments)


def _plastic(bore: float) -> tuple[float, float, float]:
    """Mp, Np, Tp of a section, each in closed form."""
    cubes, squares = 1.0 - bore**3, 1.0 - bore**2
    return (
        4.0 / 3.0 * YIELD * R**3 * cubes,
        YIELD * math.pi * R**2 * squares,
        2.0 / 3.0 * math.pi * SHEAR_YIELD * R**3 * cubes,
    )


@each("bore", [0.0, 0.5, 0.7, 0.95])
@each(("m", "n"), [(1.0, 0.0), (0.0, 1.0), (1.0, 0.2), (1.0, 1.0), (0.3, 1.0), (0.02, 1.0)])
def test_bending_with_tension_is_what_strips_carry(bore: float, m: float, n: float) -> None:
    Mp, Np, _ = _plastic(bore)
    exact = _strips(bore, m * Mp, n * Np)
    found = beam_bounds(bar(bore), STEEL, (), _ends(m * Mp, n * Np, 0.0))
    assert found.lower[0] <= exact * (1.0 + 1e-5) <= found.upper[0] * (1.0 + 3e-5)  # of strips
    assert found.lower[0] >= 0.93 * exact  # couples on bands leave shear in these
    assert found.upper[0] == pytest.approx(exact, rel=2e-4)
    most, least = bending_and_axial_use(Circle(R, bore * R), np.array(m), np.array(n))
    assert 1.0 / most == pytest.approx(exact, rel=1e-4)
    assert 1.0 / most <= 1.0 / least * (1.0 + 1e-12)
    circle = 1.0 / math.hypot(m, n)
    assert m * n == 0.0 or exact < 0.999 * circle  # so the circle was on the unsafe side


@each("radius", [0.010656951, 0.025411765530221113])
def test_a_pull_uses_its_share_whatever_the_radius(radius: float) -> None:
    """The squares of these, by Python and by NumPy, differ in their last bit."""
    for use in bending_and_axial_use(Circle(radius, 0.0), np.array(0.0), np.array(0.4)):
        assert use == pytest.approx(0.4, rel=1e-12)


@each("bore", [0.0, 0.5, 0.7, 0.95])
def test_torsion_is_the_plastic_torque(bore: float) -> None:
    """4/3 of the torque at first yield if solid: with q = b/a, 4/3 (1 - q^3) / (1 - q^4)."""
    first = SHEAR_YIELD * math.pi / 2.0 * R**3 * (1.0 - bore**4)
    exact = 4.0 / 3.0 * (1.0 - bore**3) / (1.0 - bore**4) * first
    found = beam_bounds(bar(bore), STEEL, (), _ends(0.0, 0.0, 1.0))
    assert found.lower[0] == pytest.approx(exact, rel=1e-9)
    assert found.upper[0] == pytest.approx(exact, rel=1e-9)


@each("bore", [0.0, 0.5, 0.99])
@each("ratio", [0.3, 1.0, 3.0])
def test_tension_with_torsion_is_between_the_bounds(bore: float, ratio: float) -> None:
    _, Np, Tp = _plastic(bore)
    exact = _stretched_and_twisted(bore, Np, ratio * Tp)
    found = beam_bounds(bar(bore), STEEL, (), _ends(0.0, Np, ratio * Tp))
    assert found.lower[0] <= exact * (1.0 + 1e-9) <= found.upper[0] * (1.0 + 2e-9)
    assert found.upper[0] <= 1.07 * exact
    assert found.lower[0] >= 0.97 * exact
    if bore == 0.99:  # of a thin tube n^2 + t^2 = 1 is exact
        assert found.lower[0] == pytest.approx(exact, rel=1e-4)


def _cantilever(bore: float, m: float, n: float, length: float = 20.0) -> tuple[Pin, PinLoads]:
    """m Mp and n Np at the clamp."""
    Mp, Np, _ = _plastic(bore)
    band = Segment(0.5 * D, D, bore * D, connection="a")
    pin = Pin("p", (Segment((length - 0.5) * D, D, bore * D), band))
    across = m * Mp / ((length - 0.25) * D)
    return pin, PinLoads("c", ("a",), np.array([[[across, 0.0, n * Np]]]))


def test_a_cantilever_with_an_axial_force_misses_its_margin() -> None:
    pin, loads = _cantilever(0.0, 0.448, 0.448)
    Mp, Np, _ = _plastic(0.0)
    exact = _strips(0.0, 0.448 * Mp, 0.448 * Np)
    assert exact == pytest.approx(1.400, abs=1e-3)
    found = limit_load(pin, STEEL, ("start",), loads)
    assert found.method == "beam"
    assert found.lower is not None
    assert found.upper is not None
    assert 0.99 * exact < found.lower <= exact * (1.0 + 1e-5) <= found.upper < 1.03 * exact
    row = SolvedRow(Maximum("P", "c", "solid", "converged", ""), found)
    (margin,) = collapse(Situation(None, STEEL, row=row))
    assert margin.margin == pytest.approx(-0.067, abs=0.01)


def test_a_tube_of_20_by_14_with_an_axial_force_is_not_said_to_carry_its_loads() -> None:
    """The circle had 1.16 where strips have 0.975."""
    m = n = 1.0 / math.sqrt(2.0) / 1.16
    pin, loads = _cantilever(0.7, m, n)
    Mp, Np, _ = _plastic(0.7)
    exact = _strips(0.7, m * Mp, n * Np)
    assert exact == pytest.approx(0.975, abs=0.005)
    found = beam_bounds(pin, STEEL, ("start",), loads)
    assert 0.99 * exact < found.lower[0] <= exact * (1.0 + 1e-5) <= found.upper[0]


@each("length", [0.1, 0.6, 4.0])
def test_a_neck_is_not_said_to_break_where_shoulders_hold_it(length: float) -> None:
    """A short one carries more than its section times yield, as it cannot contract: by slip along
    a plane within it, at most. Only a long one has that as a bound, which was that of all.
    """
    head = Segment(D, 2.0 * D, connection="a"), Segment(D, 2.0 * D, connection="b")
    pin = Pin("p", (head[0], Segment(length * D, D), head[1]))
    upper = beam_bounds(pin, STEEL, (), _ends(0.0, _plastic(0.0)[1], 0.0)).upper[0]
    slopes = np.linspace(1e-3, min(length, 1.0), 2000)
    area_over_shear = (1.0 + slopes**2) / slopes / math.sqrt(3.0)
    slip = min(area_over_shear.min(), 4.0)  # which the heads carry
    assert upper == pytest.approx(1.0 if length > 2.0 * 0.75 else slip, rel=0.02)


@each("bore", [0.0, 0.5, 0.9])
@each("length", [0.8, 3.0])
def test_a_stress_field_has_the_forces_of_the_lower_bound_and_yields_nowhere(
    bore: float, length: float
) -> None:
    """Bending, tension, shear and torsion together, in points over the section at the clamp.

    Shear: s_tz = -C sin theta and s_rz = f cos theta with f zero at both surfaces and
    (r f)' = C r - V r^2 / I, which is in equilibrium with elastic bending; C from f there.
    """
    pin, loads = _cantilever(bore, 0.5, 0.3, length)
    Mp, Np, Tp = _plastic(bore)
    loads = PinLoads("c", ("a",), loads.forces, np.array([[[0.0, 0.0, 0.2 * Tp]]]))
    factor = beam_bounds(pin, STEEL, ("start",), loads).lower[0]
    V = factor * 0.5 * Mp / ((length - 0.25) * D)
    M, N, T = factor * np.array([0.5 * Mp, 0.3 * Np, 0.2 * Tp])
    b = bore * R
    x, w = np.polynomial.legendre.leggauss(60)
    r = b + (R - b) * (x + 1.0) / 2.0
    theta = (np.arange(720) + 0.5) * math.pi / 360.0
    r, theta = r[:, None], theta[None, :]
    area = (w * (R - b) / 2.0)[:, None] * r * (math.pi / 360.0)
    inertia = math.pi / 4.0 * (R**4 - b**4)
    C = V / inertia * (R**3 - b**3) / (3.0 * (R - b))
    f = C - V / inertia * r**2 / 3.0 - (C * b - V / inertia * b**3 / 3.0) / r
    hoop = -C * np.sin(theta) + T / (2.0 / 3.0 * math.pi * (R**3 - b**3))
    radial = f * np.cos(theta)
    assert ((radial * np.cos(theta) - hoop * np.sin(theta)) * area).sum() == pytest.approx(V)
    assert (hoop * r * area).sum() == pytest.approx(T)
    sheared = math.sqrt(3.0) * np.hypot(radial, hoop).max() / YIELD
    left = YIELD * math.sqrt(1.0 - sheared**2)  # constant, so strips carry in proportion
    assert _strips(bore, M, N) * left / YIELD >= 1.0 - 1e-4


@pytest.mark.parametrize(
    ("bore", "m", "n"),
    [
        (0.0, 1.0, 0.0),
        pytest.param(0.5, 1.0, 0.0, marks=[pytest.mark.slow, pytest.mark.long]),
        pytest.param(0.7, 1.0, 0.0, marks=[pytest.mark.slow, pytest.mark.long]),
        pytest.param(0.0, 0.0, 1.0, marks=[pytest.mark.slow, pytest.mark.long]),
        pytest.param(0.0, 0.3, 1.0, marks=[pytest.mark.slow, pytest.mark.long]),
        pytest.param(0.0, 1.0, 1.0, marks=[pytest.mark.slow, pytest.mark.long]),
        pytest.param(0.7, 1.0, 1.0, marks=pytest.mark.slow),
    ],
)
def test_the_solids_bracket_has_the_exact_factor(bore: float, m: float, n: float) -> None:
    Mp, Np, _ = _plastic(bore)
    exact = _strips(bore, m * Mp, n * Np)
    loads = _ends(m * Mp, n * Np, 0.0)
    meshes = [limit(bar(bore), loads, size) for size in MESH_SIZES[:2]]
    lower, upper = bracket(meshes)
    assert lower <= exact <= upper
    assert upper < 1.03 * lower
    if (bore, m, n) == (0.0, 1.0, 0.0):
        assert meshes[1].reached > 1.003 * exact  # which was the lower bound


@pytest.mark.slow
def test_a_mesh_that_exceeds_a_strict_upper_bound_gives_no_lower_bound_there() -> None:
    """A short pin between two clamps: both bounds were 2 A s_y / sqrt 3, at which both its sections
    slip, while its meshes, the coarser the more, are stiffer. What they tend to, straight in the
    size of their elements, is between the bounds now.
    """
    ends = Segment(0.5 * D, D, name="left"), Segment(0.5 * D, D, name="right")
    pin = Pin("p", (ends[0], Segment(D, D, connection="a"), ends[1]))
    loads = PinLoads("c", ("a",), np.array([[[1.0, 0.0, 0.0]]]))
    slip = 2.0 * math.pi / 4.0 * D**2 * SHEAR_YIELD
    found = limit_load(pin, STEEL, (pin.surface("left"), pin.surface("right")), loads, "solid")
    reached = [mesh.lower for mesh in found.meshes]
    assert found.upper == pytest.approx(slip, rel=1e-9)
    assert reached[0] > reached[1] > reached[2] > slip
    sizes = [size.along for size in MESH_SIZES]
    towards = reached[2] - sizes[2] * (reached[1] - reached[2]) / (sizes[1] - sizes[2])
    assert found.lower is not None
    assert found.lower < 0.98 * slip
    assert found.lower < towards < slip


@pytest.mark.long
@pytest.mark.slow
def test_the_solids_bracket_of_torsion_has_the_exact_factor() -> None:
    exact = _plastic(0.0)[2]
    meshes = [limit(bar(), _ends(0.0, 0.0, 1.0), size) for size in MESH_SIZES[:2]]
    lower, upper = bracket(meshes)
    assert lower <= exact <= upper
    assert upper < 1.03 * lower


def test_the_instant_is_that_of_collapse_and_not_that_of_a_notch(tmp_path: Path) -> None:
    """A sharp corner has the largest stress at 2 s, where the thin end carries 1.7 times its load;
    at 1 s the root collapses, between M_p / (110 F) and, 0.75 diameters off the clamp,
    M_p / (80 F). The pin was said to bend, with a margin of collapse of +0.14.
    """
    rows = ((0, 0.0, 0.0), (1, 42000.0, 0.0), (2, 0.0, 2000.0))
    lines = [f"{name},{f},0,{t}" for t, *both in rows for name, f in zip("AB", both, strict=True)]
    (tmp_path / "swing.csv").write_text("\n".join(["connection,fx,fy,time", *lines]))
    (tmp_path / "study.toml").write_text(SWING)
    (row,) = pinstress.run(pinstress.load_study(tmp_path / "study.toml")).pins
    assert row.maximum.time == 2.0
    limit, root = row.limit_load, 4.0 / 3.0 * 250.0 * 20.0**3 / 42000.0
    assert limit is not None and limit.lower and limit.upper  # noqa: PT018
    assert (limit.time, limit.carries) == (1.0, False)
    assert root / 110.0 * 0.98 < limit.lower < limit.upper < root / 80.0 * 1.02
    (margin,) = (m for m in row.worst if m.method == COLLAPSE_METHOD)
    assert margin.time == 1.0
    assert margin.margin == pytest.approx(limit.lower / 1.5 - 1.0)

"""Derivatives of the largest stress: exact solutions, rules of sums, and differences of the same
discrete problem on meshes that are moved.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from assess.derivatives.derivatives import derivatives
from assess.derivatives.records import Derivatives, SolvedCase
from assess.derivatives.virtual_work import shape_gradient, work
from benchmarks.pins.derivatives import by_differences, moved_maximum, richardson
from benchmarks.random_pins import trials
from fea.beam.stress_concentration import BENDING_FIT, shoulder_factor
from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.harmonic.assembly import Section, elasticity
from fea.harmonic.evaluate import harmonic_result
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.singular.singularities import singularities_of
from fea.solve.refine import MESH_RATIO
from fea.support.contact.pressure_loads import PressureLoads
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.shape.dimensions import dimensions
from tests.support.each import each, sampled

STEEL = Material("steel", 210e9, 0.3, 7850.0)
HELD = ("start",)
ACROSS = PinLoads("c", ("B",), np.array([[[300.0, 1000.0, 200.0]]]), np.array([[[3.0, 1.0, 20.0]]]))
BALANCED = PinLoads(
    "c", ("A", "B", "C"), np.array([[[0.0, -6000.0, 0.0], [0, 10000, 0], [0, -4000, 0]]])
)
SHOULDER = Pin("P", (Segment(0.1, 0.02), Segment(0.1, 0.03, connection="B")), fillet=0.002)
TUBE = Pin(
    "P",
    (
        Segment(0.03, 0.02, bore=0.012, connection="A"),
        Segment(0.04, 0.026, bore=0.012, connection="B", edge_radii=(0.001, 0.001)),
        Segment(0.03, 0.02, bore=0.008, connection="C"),
    ),
    fillet=0.001,
)
JOINED = "profile[1].diameter & profile[2].diameter"  # of a cylinder and its cone
CONE = Pin(
    "P",
    (
        Segment(0.03, 0.02, bore=0.006),
        Segment(0.02, 0.02, end_diameter=0.03, bore=0.006, end_bore=0.004),
        Segment(0.03, 0.03, bore=0.004, connection="B"),
    ),
    fillet=0.002,
)
STRAIGHT = Pin(
    "P",
    tuple(
        Segment(length, 0.02, connection=name)
        for length, name in ((0.02, "A"), (0.01, None), (0.03, "B"), (0.01, None), (0.02, "C"))
    ),
)
PRESSED = replace(BALANCED, distribution="cosine")
HEAVY = replace(PRESSED, body=np.array([[3e3, 1e4, 2e3]]))
CASES: Mapping[str, tuple[Pin, tuple[str, ...], PinLoads]] = {
    "fillet, at the edge of a clamp's zone": (SHOULDER, HELD, ACROSS),
    "pressure": (SHOULDER, HELD, replace(ACROSS, distribution="cosine")),
    "free tube with rounded edges": (TUBE, (), BALANCED),
    "free tube with its weight": (TUBE, (), HEAVY),
    "straight pin, pressed": (STRAIGHT, (), PRESSED),
    "cone, on the rim of a zone": (CONE, HELD, replace(ACROSS, moments=np.zeros(3))),
    "end of a pressure": (
        Pin("P", (Segment(0.05, 0.02), Segment(0.004, 0.02, connection="B"), Segment(0.05, 0.02))),
        ("start", "end"),
        PinLoads("c", ("B",), np.array([[[0.0, 9000.0, 0.0]]]), distribution="cosine"),
    ),
}


def solved(pin: Pin, clamps: tuple[str, ...], loads: PinLoads, level: int = 0) -> SolvedCase:
    zones = singularities_of(pin, STEEL, clamps, (loads,))
    problem = SectionProblem(pin, STEEL, clamps, (loads,), zones)
    before = [harmonic_result(harmonic_solution(problem, 0, MESH_RATIO), zones, loads)]
    section = harmonic_solution(problem, level, MESH_RATIO, before if level else ())
    return SolvedCase(pin, STEEL, clamps, loads, section, zones)


def found(of: SolvedCase) -> Derivatives:
    return derivatives(of, dimensions(of.pin))


def check_differences(of: SolvedCase, some: slice) -> None:
    """Relative to the maximum over the dimension."""
    ours, values = found(of), {one.key: one.value for one in dimensions(of.pin)}
    for key, theirs in by_differences(of, some).items():
        close = pytest.approx(theirs, abs=1e-6 * ours.maximum / values[key])
        assert ours.by_dimension[key] == close, key


@pytest.mark.parametrize("name", CASES)
def test_by_dimensions_they_are_those_of_a_mesh_that_is_moved(name: str) -> None:
    """Every fourth one: 1e-6, where the issue asks for 1e-4. The points are on skins, rims and at
    the end of a pressure.
    """
    check_differences(solved(*CASES[name]), slice(1, None, 4))


@pytest.mark.parametrize("k", range(5))
def test_of_random_pins(k: int) -> None:
    """Another dimension of each."""
    trial = trials(5, seed=3)[k]
    loads = trial.loads.at(np.array([k]))
    check_differences(solved(trial.pin, trial.clamps, loads), slice(k, k + 1))


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(CASES, every=3))
def test_by_all_dimensions(name: str) -> None:
    check_differences(solved(*CASES[name], level=2), slice(None))


@each("name", CASES)
def test_sums_over_dimensions_and_loads(name: str) -> None:
    """All lengths s times as large under the same forces: stress goes as 1 / s^2; a moment weighs
    1 / s, a weight s^3. All loads s times as large: stress goes as s.
    """
    of = solved(*CASES[name])
    ours, loads = found(of), of.loads
    assert ours.without == {}
    lengths = sum(one.value * ours.by_dimension[one.key] for one in dimensions(of.pin))
    forces, moments = (
        sum(
            x * float(of_kind[0, loads.surfaces.index(c), "xyz".index(a)])
            for (c, a), x in by.items()
        )
        for by, of_kind in ((ours.by_force, loads.forces), (ours.by_moment, loads.moments))
    )
    weight = (STEEL.density or 0.0) * ours.density
    scale = ours.maximum
    assert lengths == pytest.approx(-2.0 * scale - moments + 3.0 * weight, abs=1e-8 * scale)
    assert forces + moments + weight == pytest.approx(scale, rel=1e-9)


@each("name", [*CASES][::3])
def test_by_poissons_ratio(name: str) -> None:
    of = solved(*CASES[name])
    still = np.zeros((len(of.solution.mesh.nodes), 2))

    def at(x: float) -> float:
        return moved_maximum(of, of.pin, still, replace(STEEL, poisson_ratio=0.3 + x))

    ours = found(of)
    assert ours.poisson_ratio == pytest.approx(richardson(at, 1e-3), abs=1e-6 * ours.maximum)
    stiffer = moved_maximum(of, of.pin, still, replace(STEEL, youngs_modulus=100e9))
    assert stiffer == pytest.approx(ours.maximum, rel=1e-9)
    assert ours.youngs_modulus == 0.0


@each(
    ("force", "moment", "power"),
    [
        ((0.0, 0.0, 1e4), (0, 0, 0), -2),
        ((0.0, 0, 0), (0, 90.0, 0), -3),
        ((0.0, 0, 0), (0, 0, 90.0), -3),
    ],
)
def test_of_bars(force: tuple[float, ...], moment: tuple[float, ...], power: int) -> None:
    """At a fillet far from clamp and load lengths do not count, and all that lies across together
    as the nominal stress says.
    """
    pin = Pin("P", (Segment(0.12, 0.02), Segment(0.06, 0.04, connection="B")), fillet=0.004)
    loads = PinLoads("c", ("B",), np.array([[force]]), np.array([[moment]]))
    ours = found(solved(pin, HELD, loads, 1))
    assert 0.11 < ours.location[2] < 0.12
    powers = {
        one.key: one.value / ours.maximum * ours.by_dimension[one.key] for one in dimensions(pin)
    }
    for length in ("profile[1].length", "profile[2].length"):
        assert abs(powers.pop(length)) < 0.01, length  # what stretching the mesh does
    assert sum(powers.values()) == pytest.approx(power, abs=0.02)
    assert power - 1.0 < powers["profile[1].diameter"] < power + 0.5
    assert powers["fillet"] < -0.05


def test_of_a_tube_under_pressure() -> None:
    """Lame: 2 p b^2 / (b^2 - a^2) at the bore, of p that goes as 1 / (b length)."""
    a, b, length = 0.006, 0.010, 0.02
    pin = Pin("P", (Segment(length, 2.0 * b, bore=2.0 * a, connection="B"),))
    unit = UnitLoad("B", "pressure", 0)
    loads = PressureLoads("c", ("B",), np.zeros((1, 1, 3)), acting={unit: np.array([[1e5, 0.0]])})
    ours = found(solved(pin, (), loads, 4))
    pressure = 1e5 * 2.0 / (np.pi**2 * b * length)
    exact = 2.0 * pressure * b * b / (b * b - a * a)
    assert ours.maximum == pytest.approx(exact, rel=1e-4)
    by_a, by_b = 2.0 * a / (b * b - a * a), 1.0 / b - 2.0 * b / (b * b - a * a)
    for key, relative in (("bore", by_a / 2.0), ("diameter", by_b / 2.0), ("length", -1 / length)):
        assert ours.by_dimension[f"profile[1].{key}"] == pytest.approx(exact * relative, rel=2e-3)


def test_what_cannot_matter_does_not() -> None:
    """What is beyond the load, or on its far side."""
    pin = Pin(
        "P",
        (
            Segment(0.1, 0.02),
            Segment(0.02, 0.02, connection="B"),
            Segment(0.06, 0.02),
            Segment(0.03, 0.016, bore=0.004),
        ),
        fillet=0.001,
    )
    ours = found(solved(pin, HELD, PinLoads("c", ("B",), np.array([[[0.0, 1e3, 0.0]]]))))
    values = {one.key: one.value for one in dimensions(pin)}
    for key in ("profile[3].length", "profile[4].diameter", "profile[4].bore", "fillet"):
        assert abs(ours.by_dimension[key]) * values[key] < 1e-6 * ours.maximum, key


def test_the_radius_of_a_fillet_is_petersons() -> None:
    """Slope of the notch factor in bending, a fit that is itself good to a few per cent."""
    d, D, rho, M = 0.02, 0.03, 0.002, 50.0
    pin = Pin("P", (Segment(0.06, D), Segment(0.06, d, connection="B")), fillet=rho)
    bent = PinLoads("c", ("B",), np.zeros((1, 1, 3)), np.array([[[0.0, M, 0.0]]]))
    ours = found(solved(pin, HELD, bent, 3))
    nominal = 32.0 * M / (np.pi * d**3)

    def peterson(r: float) -> float:
        return nominal * (shoulder_factor(BENDING_FIT, D, d, r) or 0.0)

    slope = (peterson(1.02 * rho) - peterson(0.98 * rho)) / (0.04 * rho)
    assert ours.by_dimension["fillet"] == pytest.approx(slope, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("free tube with rounded edges", ("profile[1].diameter", "profile[1-2].bore", "fillet")),
        ("cone, on the rim of a zone", (f"{JOINED}[1]", "profile[1].length")),
    ],
)
def test_they_are_those_of_other_meshes(name: str, keys: tuple[str, ...]) -> None:
    """Made anew, of pins that are 4 % off: within the noise of these meshes."""
    pin, clamps, loads = CASES[name]
    ours = found(solved(pin, clamps, loads, 4))
    every = {one.key: one for one in dimensions(pin)}
    for key in keys:
        one = every[key]
        more, less = (
            found(solved(one.changed(times * one.value), clamps, loads, 4)).maximum
            for times in (1.04, 0.96)
        )
        power = np.log(more / less) / np.log(1.04 / 0.96)
        assert ours.by_dimension[key] * one.value / ours.maximum == pytest.approx(power, abs=0.06)


def test_ties_are_named() -> None:
    """The two sides of a symmetric pin, and two instants of a motion."""
    pin = Pin(
        "P",
        (
            Segment(0.02, 0.02, connection="A"),
            Segment(0.03, 0.02, connection="B"),
            Segment(0.02, 0.02, connection="C"),
        ),
    )
    once = np.array([[0.0, -5e3, 0.0], [0, 10e3, 0], [0, -5e3, 0]])
    forces = np.array([0.2, 1.0, 0.5, 0.999, 0.3])[:, None, None] * once
    moving = PinLoads("c", ("A", "B", "C"), forces, distribution="cosine", times=np.arange(5.0))
    of = replace(solved(pin, (), moving.at(np.array([1]))), error=0.02, history=moving)
    ours = found(of)
    assert ours.tied_times == (3.0,)
    r, z = np.hypot(*ours.location[:2]), ours.location[2]
    assert any(np.hypot(r - R, 0.07 - z - Z) < 2e-3 for R, Z in ours.tied_places)
    alone = found(solved(SHOULDER, HELD, ACROSS))
    assert (alone.tied_places, alone.tied_times) == ((), ())


def test_a_dimension_with_another_shape_on_one_side_has_none() -> None:
    """A fillet as high as its step cannot be larger."""
    pin = Pin("P", (Segment(0.05, 0.02), Segment(0.05, 0.03, connection="B")), fillet=0.005)
    ours = found(solved(pin, HELD, ACROSS))
    assert {"fillet", "profile[1].diameter", "profile[2].diameter"} <= set(ours.without)
    assert "profile[1].length" in ours.by_dimension


def test_the_work_is_that_of_the_stiffness(steel: Material) -> None:
    space = Section(meridian_mesh(CONE, SectionSize()))
    chance = np.random.default_rng(5)
    for n in (0, 1, 3):
        u, v = chance.normal(size=(2, space.unknowns))
        ours = work(space, elasticity(steel), n, u, v)
        assert ours == pytest.approx(float(v @ (space.stiffness(steel, n) @ u)), rel=1e-9)
        along = shape_gradient(space, elasticity(steel), n, u, v)[:, 1]
        assert abs(along.sum()) < 1e-9 * np.abs(along).sum()  # along the axis nothing changes

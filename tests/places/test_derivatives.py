"""Derivatives of stress where rows read it: in fillets, under lugs, at their edges, in sections.

They are compared with differences of complete solutions on meshes that are moved, with the cells in
contact as they are: contact, pressures and stress are found anew, and the maximum of the place.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from assess.derivatives.derivatives import Adjoint
from assess.derivatives.in_lugs import JointDerivatives, JointParameter, joint_derivatives
from assess.derivatives.in_section import section_derivatives
from assess.derivatives.reading_point import Continued, OnSkin, Relieved
from assess.derivatives.records import SolvedCase
from benchmarks.joints.joint_derivatives import WholeJoint, parameters, solved_in_lugs, whole_joint
from benchmarks.pins.derivatives import moved_maximum, richardson
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.places import Place
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.free_surface import surface_points
from fea.solve.solve import solve_in_lugs, solve_pin
from fea.support.contact.resolution import Resolution
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem, Solution
from geometry import Pin, Segment
from geometry.mesh.outline_motion import DIFFERENCE_STEPS
from geometry.shape.dimensions import dimensions
from pinbase.arrays import Floats
from tests.support.each import sampled

STEEL = Material("steel", 210e9, 0.3, 7850.0, yield_strength=700e6)
ALUMINIUM = Material("aluminium", 70e9, 0.33)
ROUGH = Resolution(4, 24, 8)
FINE = Resolution(16, 24, 8)  # so short rings that stress is continued to the edges of lugs
STEP = 1e-4  # of a parameter
FILLET = Pin(
    "P",
    (
        Segment(0.002, 0.02),
        Segment(0.010, 0.02, connection="L"),
        Segment(0.0016, 0.02),
        Segment(0.020, 0.026, connection="M"),
        Segment(0.0016, 0.019),
        Segment(0.010, 0.019, connection="R"),
        Segment(0.002, 0.019),
    ),
    fillet=0.001,
)
STUB = Pin(
    "P",
    (
        Segment(0.002, 0.02),
        Segment(0.012, 0.02, name="seat"),
        Segment(0.003, 0.02),
        Segment(0.008, 0.02, connection="M"),
        Segment(0.002, 0.02),
    ),
)
TOUCHING = Pin(
    "P",
    (
        Segment(0.002, 0.024),
        Segment(0.004, 0.024, bore=0.006, connection="L"),
        Segment(0.0002, 0.024, bore=0.006),
        Segment(0.012, 0.024, bore=0.006, connection="M"),
        Segment(0.0002, 0.02),
        Segment(0.004, 0.02, connection="R"),
        Segment(0.002, 0.02),
    ),
)
LOOSE = tuple(
    Lug(name, 0.05, made_of, 1e-5, tilt=math.inf)
    for name, made_of in (("L", STEEL), ("M", ALUMINIUM), ("R", STEEL))
)
TIGHT = Lug("seat", 0.05, ALUMINIUM, -2e-5, tilt=math.inf), Lug("M", 0.05, STEEL, 2e-5, tilt=0.0)
SHEARED = PinLoads(
    "c",
    ("L", "M", "R"),
    np.array([[[-25e3, 3e3, 800.0], [50e3, -1e3, -200.0], [-25e3, -2e3, -600.0]]]),
    np.array([[[0.0, 0.0, 30.0], [0.0, 0.0, -10.0], [0.0, 0.0, -20.0]]]),
)
PUSHED = PinLoads("c", ("M",), np.array([[[10e3, 0.0, 0.0]]]), body=np.array([[0.0, -1e4, 50.0]]))


@cache
def joint(name: str) -> tuple[WholeJoint, tuple[JointParameter, ...], JointDerivatives]:
    places: dict[str, tuple[Pin, tuple[Lug, ...], PinLoads, Place]] = {
        "fillet": (FILLET, LOOSE, SHEARED, "surface"),
        "tension fibre": (STUB, TIGHT, PUSHED, "surface"),
        "section": (TOUCHING, LOOSE, SHEARED, "section"),
        "seated section": (STUB, TIGHT, PUSHED, "section"),
    }
    pin, lugs, links, place = places[name]
    whole = whole_joint(pin, STEEL, lugs, links, ROUGH, place)
    every = tuple(parameters(pin, STEEL, lugs))
    found = joint_derivatives(whole.solved, whole.model, links, every, place=place)
    return whole, every, found


def check(name: str, keys: tuple[str, ...], step: int | None = None) -> None:
    whole, every, found = joint(name)
    assert not found.without
    some = {p.key: p for p in every}
    for one in [*(some[key] for key in keys), *(every[::step] if step else ())]:
        little = 2e-6 * found.maximum / one.scale
        ours = found.by_parameter[one.key]
        assert ours == pytest.approx(whole.derivative(one), rel=1e-5, abs=little), one.key


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "kind", "near"),
    [("fillet", OnSkin, 0.0340), ("tension fibre", Relieved, 0.0)],
)
def test_where_they_are(name: str, kind: type, near: float) -> None:
    """Of the pins below: one in a fillet beside a lug, one under it."""
    point = Adjoint(joint(name)[0].solved)
    assert isinstance(point.point, kind)
    if near:
        assert point.read_at.points[point.top.point, 1] == pytest.approx(near, abs=3e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "keys"),
    [
        ("fillet", ("fillet",)),
        ("tension fibre", ("profile[1-5].diameter",)),
        ("section", ("profile[2].length", "lug.M.clearance")),
        ("seated section", ("material.steel.density",)),
    ],
)
@pytest.mark.parametrize("step", sampled([27, 1], every=2))
def test_as_by_differences(name: str, keys: tuple[str, ...], step: int) -> None:
    """By these parameters and one in so many of all."""
    check(name, keys, step)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["section", "seated section"])
def test_sections_by_sums(name: str) -> None:
    """Without clearances stress would be in proportion to the loads; with them loads, moduli and
    weight in proportion change no strain. And all lengths times s, forces s^2, moments s^3 and the
    field of gravity 1/s give the same stress.
    """
    whole, every, found = joint(name)
    links = whole.links
    forces, moments = (
        sum(
            x * float(given[0, links.surfaces.index(c), "xyz".index(axis)])
            for (c, axis), x in by.items()
        )
        for by, given in ((found.by_force, links.forces), (found.by_moment, links.moments))
    )

    def rate(*ends: str) -> float:
        return sum(p.value * found.by_parameter[p.key] for p in every if p.key.endswith(ends))

    total = rate("youngs_modulus") + rate("density") + forces + moments
    assert total == pytest.approx(found.maximum, rel=1e-8)
    lengths = rate("diameter", "length", "bore", "fillet", "clearance", "edge_radius")
    # weight and pressure under it: density stands for gravity, which goes as 1 / s
    scaled = lengths + 2.0 * forces + 3.0 * moments - rate("density")
    assert scaled == pytest.approx(0.0, abs=1e-8 * found.maximum)


@pytest.mark.slow
def test_at_the_edge_of_a_lug() -> None:
    """Where stress is continued to it from beside it: by shape, by Poisson's ratio, and by the
    exponent of pressure there, under pressures that stay.
    """
    model, links = (whole := whole_joint(STUB, STEEL, TIGHT, PUSHED, FINE)).model, PUSHED
    solved = whole.solved
    pressed = solved.loads.pressed
    assert pressed is not None
    of = surface_points(solved.solution.fields, pressed.rings, STEEL.poisson_ratio)
    edges = np.zeros(len(of.relieved), dtype=bool)
    edges[list(of.cusps)] = True
    adjoint = Adjoint(solved, edges)
    assert isinstance(adjoint.point, Continued)
    assert adjoint.top.value > 0.2 * Adjoint(solved).top.value
    nodes = adjoint.outline_nodes
    for one in parameters(STUB, STEEL, TIGHT):
        if not one.key.startswith("profile"):
            continue
        step = STEP * one.value

        def other(x: float, one: JointParameter = one) -> float:
            made = model.reshaped(*one.changed(one.value + x))
            shift = nodes.at(made.pin) - nodes.at(model.pin)
            moved = adjoint.interior.velocity(shift[:, :, None])[:, :, 0]
            pressed = made.arcs(model.pressed(links))
            loads = replace(solved.loads, pressed=pressed)
            return moved_maximum(solved, made.pin, moved, STEEL, loads, adjoint.top.point)

        pins = tuple(
            model.reshaped(*one.changed(one.value + x * step)).pin for x in DIFFERENCE_STEPS
        )
        ours = adjoint.by_motions([nodes.among(one.key, pins, step)])[one.key]
        little = 1e-6 * adjoint.top.value / one.value
        assert ours == pytest.approx(richardson(other, step), rel=1e-5, abs=little), one.key

    def exponent(x: float) -> float:
        rings = replace(pressed.rings, exponent=pressed.rings.exponent + x)
        loads = replace(solved.loads, pressed=replace(pressed, rings=rings))
        none = np.zeros_like(solved.solution.mesh.nodes)
        return moved_maximum(solved, solved.pin, none, STEEL, loads, adjoint.top.point)

    little = 1e-6 * adjoint.top.value
    assert adjoint.by_exponent() == pytest.approx(richardson(exponent, 1e-3), abs=little)


def test_a_prescribed_section_by_formula() -> None:
    """A cantilever under a force across: 32 F l / (pi d^3) at its clamp, l to the middle of the
    band; as a short one 1.36 F / A is the shear on the axis, of which von Mises is sqrt(3) times
    (Timoshenko & Goodier, Theory of Elasticity, art. 148: (3 + 2 nu) / (2 (1 + nu)) F / A).
    """
    force, nu = 1e3, STEEL.poisson_ratio
    loads = PinLoads("c", ("B",), np.array([[[force, 0.0, 0.0]]]))
    for length, band, power, by in ((0.1, 0.01, -3.0, 1.0 / 0.105), (5e-4, 0.004, -2.0, 0.0)):
        pin = Pin("P", (Segment(length, 0.02), Segment(band, 0.02, connection="B")))
        (found,) = solve_pin(pin, STEEL, ("start",), (loads,), Requirement(0.05, model="harmonic"))
        assert isinstance(found.answer, HarmonicField)
        solved = SolvedCase(pin, STEEL, ("start",), loads, found.answer.solution, ())
        ours = section_derivatives(solved, tuple(dimensions(pin)))
        diameter = ours.by_dimension["profile[1-2].diameter"]
        assert diameter * 0.02 / ours.maximum == pytest.approx(power, abs=0.02)
        assert ours.by_dimension["profile[1].length"] / ours.maximum == pytest.approx(by, abs=1e-6)
        assert ours.by_force["B", "x"] * force == pytest.approx(ours.maximum, rel=1e-9)
        if by:
            nominal = 32.0 * force * 0.105 / (math.pi * 0.02**3)
            assert ours.maximum == pytest.approx(nominal, rel=1e-3)
            assert ours.poisson_ratio == pytest.approx(0.0, abs=1e-3 * ours.maximum)
            continue
        shear = math.sqrt(3.0) * force / (math.pi * 0.01**2)
        rate = -1.0 / (2.0 * (1.0 + nu) ** 2)  # of (3 + 2 nu) / (2 (1 + nu))
        assert ours.maximum == pytest.approx(shear * (3 + 2 * nu) / (2 + 2 * nu), rel=1e-2)
        assert ours.poisson_ratio == pytest.approx(shear * rate, rel=0.05)


def _moving(times: Floats) -> PinLoads:
    along = np.stack([np.cos(2.0 * times), np.sin(2.0 * times), 0.0 * times], axis=1)
    size = 1.0 + 0.2 * np.sin(np.pi * times)
    share = np.array([-0.5, 1.0, -0.5])[None, :, None]
    forces = 50e3 * share * (size[:, None] * along)[:, None, :]
    return PinLoads("c", ("L", "M", "R"), forces, times=times)


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("place", ["surface", "section"])
def test_of_whole_solutions(place: Place) -> None:
    """The places of a pin, the surface along a motion, and what they become with another diameter,
    solved anew on other meshes and cells.
    """
    surface = place == "surface"
    pin = FILLET if surface else TOUCHING
    loads = _moving(np.linspace(0.0, 1.0, 5) if surface else np.array([0.5]))
    lugs = tuple(replace(x, edge_radius=5e-4, clearance=0.0) for x in LOOSE)
    every = {p.key: p for p in parameters(pin, STEEL, lugs)}
    one = every["profile[5-7].diameter" if surface else "profile[1-4].diameter"]

    def solved(pin: Pin) -> tuple[Solution, float]:
        (made,) = solve_in_lugs(PinProblem(pin, STEEL, lugs, (loads,)), Requirement(0.02))
        places = made.peak.places
        assert places is not None
        value = places.surface if surface else places.section
        assert value is not None
        return made, value.max_von_mises

    made, maximum = solved(pin)
    assert surface == (made.peak.max_von_mises == maximum)
    ours = joint_derivatives(*solved_in_lugs(made, STEEL), [one], place=place)
    assert ours.maximum == pytest.approx(maximum, rel=1e-6)
    more, less = (solved(one.changed(x * one.value)[0])[1] for x in (1.02, 0.98))
    slope = (more - less) / (0.04 * one.value)
    assert ours.by_parameter[one.key] == pytest.approx(slope, rel=0.03)

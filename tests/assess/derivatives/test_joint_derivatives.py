"""Derivatives of a pin in contact: rules of sums, and differences of whole solutions on meshes that
are moved.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from assess.derivatives.in_lugs import JointDerivatives, JointParameter, joint_derivatives
from benchmarks.joints.joint_derivatives import WholeJoint, parameters, solved_in_lugs, whole_joint
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_in_lugs
from fea.support.contact.resolution import Resolution
from fea.support.lugs.lug import Bushing, Lug
from fea.support.support import PinProblem
from geometry import Pin, Segment
from tests.fea.support.contact.test_solve_in_lugs import LUGS, PIN, STEADY, STEEL
from tests.support.each import each, sampled

ROUGH = Resolution(4, 24, 8)
BRONZE, ALUMINIUM = Material("bronze", 110e9, 0.34), Material("aluminium", 70e9, 0.33)
GUIDED = tuple(replace(lug, tilt=math.inf) for lug in LUGS)
LOOSE = tuple(replace(lug, clearance=2e-5) for lug in GUIDED)
STEPPED = Pin(
    "P",
    (
        Segment(0.003, 0.018, bore=0.008),
        Segment(0.010, 0.018, bore=0.008, connection="L"),
        Segment(0.002, 0.018, bore=0.008),
        Segment(0.022, 0.022, bore=0.008, connection="M"),
        Segment(0.002, 0.022, bore=0.008),
        Segment(0.010, 0.018, bore=0.008, connection="R"),
        Segment(0.002, 0.018, bore=0.008),
    ),
    fillet=0.001,
)
SEATS = (
    Lug("L", 0.045, STEEL, 2e-5, 0.0008, tilt=500.0),
    Lug("M", 0.055, ALUMINIUM, 3e-5, 0.001, bushing=Bushing(0.002, BRONZE)),
    Lug("R", 0.045, STEEL, -1e-5, tilt=0.0),
)
EVERY_WAY = PinLoads(
    "c",
    ("L", "M", "R"),
    np.array([[[-8e3, 3e3, 500.0], [20e3, -1e3, -200.0], [-12e3, -2e3, -300.0]]]),
    np.array([[[0.0, 0.0, 5.0], [0.0, 0.0, -2.0], [0.0, 0.0, -3.0]]]),
)
HEAVY = replace(STEEL, density=7850.0)
GROUND = (
    Lug("seat", 0.05, HEAVY, tilt=0.0),
    Lug("M", 0.05, HEAVY, 1e-5),
    Lug("other", 0.05, HEAVY),
)
SEATED = Pin(
    "P",
    (
        Segment(0.002, 0.02),
        Segment(0.010, 0.02, name="seat"),
        Segment(0.001, 0.02),
        Segment(0.020, 0.02, connection="M"),
        Segment(0.002, 0.02),
        Segment(0.010, 0.02, name="other"),
        Segment(0.002, 0.02),
    ),
)
TURNING = np.array([[[0.0, 50.0, 0.0], [20.0, -80.0, 0.0], [0.0, 0.0, 0.0]]])
PUSHED = PinLoads("c", ("M",), np.array([[[30e3, 0.0, 0.0]]]), body=np.array([[0.0, -1e4, 0.0]]))


@cache
def joint(name: str) -> tuple[WholeJoint, tuple[JointParameter, ...], JointDerivatives]:
    pin, material, lugs, links = {
        "closed": (PIN, STEEL, GUIDED, STEADY),
        "loose": (PIN, STEEL, LOOSE, STEADY),
        "stepped": (STEPPED, STEEL, SEATS, EVERY_WAY),
        "seated": (SEATED, HEAVY, GROUND, PUSHED),
        "turning": (PIN, STEEL, LOOSE, replace(STEADY, moments=TURNING)),
    }[name]
    whole = whole_joint(pin, material, lugs, links, ROUGH)
    every = tuple(parameters(pin, material, lugs))
    return whole, every, joint_derivatives(whole.solved, whole.model, links, every)


def rate(name: str, *some: str) -> float:
    """Sum of p d/dp over the parameters whose keys end so, over the maximum."""
    _, every, found = joint(name)
    return (
        sum(p.value * found.by_parameter[p.key] for p in every if p.key.endswith(some))
        / found.maximum
    )


def of_forces(name: str) -> float:
    """The same of all forces and moments."""
    whole, _, found = joint(name)
    links = whole.links
    pairs = [(found.by_force, links.forces), (found.by_moment, links.moments)]
    return sum(
        x * float(given[0, links.surfaces.index(c), "xyz".index(axis)])
        for by, given in pairs for (c, axis), x in by.items()
    ) / found.maximum  # fmt: skip


LENGTHS = ("diameter", "length", "bore", "fillet", "clearance", "edge_radius", "thickness")


@pytest.mark.parametrize("name", ["closed", "loose"])
def test_a_joint_of_another_size_under_loads_as_its_section_has_the_same_stress(name: str) -> None:
    """Without clearances stress is in proportion to the loads."""
    assert rate(name, *LENGTHS) + 2.0 * of_forces(name) == pytest.approx(0.0, abs=1e-8)
    assert (of_forces(name) == pytest.approx(1.0, abs=1e-9)) == (name == "closed")


@each("name", ["closed", "loose", "seated", "turning"])
def test_moduli_loads_and_weight_in_proportion_change_no_strain(name: str) -> None:
    found = rate(name, "youngs_modulus")
    assert found + of_forces(name) + rate(name, "density") == pytest.approx(1.0, abs=1e-9)
    assert (abs(found) < 1e-9) == (name == "closed")


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("closed", "profile[1-7].diameter"),
        ("loose", "profile[4].length"),
        ("loose", "lug.M.outer_diameter"),
        ("loose", "material.steel.poisson_ratio"),
        ("seated", "material.steel.density"),
        ("turning", "profile[2].length"),
    ],
)
def test_as_by_differences(name: str, key: str) -> None:
    whole, every, found = joint(name)
    (one,) = (p for p in every if p.key == key)
    little = 1e-7 * found.maximum / one.scale
    assert found.by_parameter[key] == pytest.approx(whole.derivative(one), abs=little)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["closed", "stepped", "seated"])
@pytest.mark.parametrize("step", sampled([18, 1], every=2))
def test_all_as_by_differences(name: str, step: int) -> None:
    """By one in so many parameters: bushing, rounded edges, interference, tilts, bore, fillets, a
    structure; loads across and along, torque, weight.
    """
    whole, every, found = joint(name)
    assert not found.without
    for one in every[::step]:
        little = 1e-7 * found.maximum / one.scale
        ours = found.by_parameter[one.key]
        assert ours == pytest.approx(whole.derivative(one), abs=little), one.key


def test_materials_are_told_apart() -> None:
    """What pin and lugs are made of adds up to what they are made of together."""
    whole, _, found = joint("loose")
    lugs = tuple(replace(x, material=replace(STEEL, name="other")) for x in LOOSE)
    every = [p for p in parameters(PIN, STEEL, lugs) if p.key.startswith("material")]
    apart = joint_derivatives(whole.solved, whole.model, STEADY, every[:0])
    assert apart.by_parameter == {}
    other = whole_joint(PIN, STEEL, lugs, STEADY, ROUGH)
    both = joint_derivatives(other.solved, other.model, STEADY, every).by_parameter
    for name in ("youngs_modulus", "poisson_ratio"):
        total = both[f"material.steel.{name}"] + both[f"material.other.{name}"]
        assert total == pytest.approx(found.by_parameter[f"material.steel.{name}"], rel=1e-7)


@pytest.mark.slow
def test_of_a_solution_by_forces_clearances_and_shape() -> None:
    """All forces and clearances s times as large: pressures and stress as well. By a force across
    what is symmetric there is none. By the diameter it is as between two other solutions.
    """
    lugs = tuple(replace(lug, clearance=1e-5) for lug in GUIDED)
    (made,) = solve_in_lugs(PinProblem(PIN, STEEL, lugs, (STEADY,)), Requirement(0.1))
    solution, (solved, model, links) = made, solved_in_lugs(made, STEEL)
    every = tuple(parameters(PIN, STEEL, lugs))
    ours = joint_derivatives(solved, model, links, every)
    assert ours.maximum == pytest.approx(solution.peak.max_von_mises, rel=1e-12)
    forces = sum(
        x * float(links.forces[0, links.surfaces.index(c), "xy".index(axis)])
        for (c, axis), x in ours.by_force.items()
    )
    loose = sum(1e-5 * ours.by_parameter[f"lug.{c}.clearance"] for c in "LMR")
    assert len(ours.by_force) == 6
    assert forces + loose == pytest.approx(ours.maximum, rel=1e-8)
    for c in "LMR":
        assert abs(ours.by_force[c, "y"]) < 1e-6 * abs(ours.by_force[c, "x"])
    (wide,) = (p for p in every if p.key == "profile[1-7].diameter")
    stress = []
    for times in (1.02, 0.98):
        pin, _, same = wide.changed(times * wide.value)
        (other,) = solve_in_lugs(PinProblem(pin, STEEL, same, (STEADY,)), Requirement(0.1))
        stress.append(other.peak.max_von_mises or 0.0)
    slope = (stress[0] - stress[1]) / (0.04 * wide.value)
    assert ours.by_parameter[wide.key] == pytest.approx(slope, rel=0.02)

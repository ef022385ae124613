"""Rows of pins with a hardened surface against bars in closed form, and a fillet solved apart."""

import math

import numpy as np
import pytest

from fea.core.hardened import Hardened
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.places import PartPlace
from fea.core.requirement import Requirement
from fea.solve.solve import DEFAULT_REQUIREMENT, solve, solve_pin
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import ArgumentError, Pin, Segment
from tests.fea.support.tension_bar import Fillet, largest_on_offset

SURFACE, CORE, R = 900e6, 500e6, 0.02
CROSSOVER = R * (1.0 - CORE / SURFACE)  # depth at which case and core yield together, linearly


def steel(pin: Pin, depth: float) -> Material:
    case = Hardened(0.0, pin.length, SURFACE, CORE, depth)
    return Material("m", 210e9, 0.3, yield_strength=CORE, hardened=(case,))


def row(
    pin: Pin, material: Material, loads: PinLoads, need: Requirement = DEFAULT_REQUIREMENT
) -> Maximum:
    (solution,) = solve_pin(pin, material, (), (loads,), need)
    return solution.peak


def parts(peak: Maximum) -> dict[str, PartPlace]:
    assert peak.places is not None
    return {part.part: part for part in peak.places.hardened}


def bar() -> tuple[Pin, PinLoads, float]:
    """A bar under four forces, and its bending stress between the inner two."""
    lengths = (0.02, "A"), (0.08, None), (0.02, "B"), (0.12, None), (0.02, "C"), (0.08, None)
    segments = [Segment(x, 2.0 * R, connection=name) for x, name in (*lengths, (0.02, "D"))]
    F = 2e4
    forces = np.array([[[0.0, F, 0.0], [0.0, -F, 0.0], [0.0, -F, 0.0], [0.0, F, 0.0]]])
    loads = PinLoads("c", ("A", "B", "C", "D"), forces, distribution="uniform")
    return Pin("P", tuple(segments)), loads, F * 0.1 * 4.0 / (math.pi * R**3)


@pytest.mark.parametrize(
    ("depth", "governs"),
    [(0.001, "core"), (0.97 * CROSSOVER, "core"), (1.03 * CROSSOVER, "case"), (0.015, "case")],
)
def test_bending_is_governed_by_the_core_up_to_the_crossover(depth: float, governs: str) -> None:
    pin, loads, stress = bar()
    peak = row(pin, steel(pin, depth), loads)
    exact = {"case": stress / SURFACE, "core": stress * (1.0 - depth / R) / CORE}
    assert peak.safety_factor(None) == pytest.approx(1.0 / max(exact.values()), rel=0.01)
    assert peak.places is not None
    assert peak.places.hardened[0].part == governs
    for name, use in exact.items():
        assert 1.0 / parts(peak)[name].safety_factor == pytest.approx(use, rel=0.01)
    core = parts(peak)["core"].depth
    assert core is not None
    assert depth <= core <= 1.01 * depth


@pytest.mark.parametrize("depth", [0.001, 0.008])
def test_the_plastic_moment_of_a_section_is_that_of_case_and_core(depth: float) -> None:
    pin, loads, stress = bar()
    places = row(pin, steel(pin, depth), loads).places
    assert places is not None
    assert places.section is not None
    moment, core = stress * math.pi * R**3 / 4.0, R - depth
    plastic = 4.0 / 3.0 * (SURFACE * (R**3 - core**3) + CORE * core**3)
    assert places.section.plastic_utilisation == pytest.approx(moment / plastic, rel=0.01)


@pytest.mark.parametrize(("depth", "governs"), [(0.004, "core"), (0.012, "case")])
def test_torsion(depth: float, governs: str) -> None:
    segments = [Segment(x, 2.0 * R, connection=n) for x, n in ((0.2, "A"), (0.2, None), (0.2, "B"))]
    pin, T = Pin("P", tuple(segments)), 2000.0
    moments = np.array([[[0.0, 0.0, T], [0.0, 0.0, -T]]])
    loads = PinLoads("c", ("A", "B"), np.zeros((1, 2, 3)), moments, distribution="uniform")
    peak = row(pin, steel(pin, depth), loads)
    stress = math.sqrt(3.0) * 2.0 * T / (math.pi * R**3)
    exact = {"case": stress / SURFACE, "core": stress * (1.0 - depth / R) / CORE}
    # The edges of the tractions that make the torque add 1.6 % at the surface.
    assert peak.safety_factor(None) == pytest.approx(1.0 / max(exact.values()), rel=0.02)
    assert peak.places is not None
    assert peak.places.hardened[0].part == governs


def test_case_has_the_stress_of_a_plain_pin_and_its_core_less() -> None:
    pin, loads, _ = bar()
    plain = Material("m", 210e9, 0.3, yield_strength=CORE)
    whole = row(pin, plain, loads, Requirement(model="harmonic"))
    found = parts(row(pin, steel(pin, 0.001), loads))
    assert found["case"].max_von_mises == pytest.approx(whole.max_von_mises, rel=1e-3)
    assert found["core"].safety_factor > (whole.safety_factor(CORE) or 0.0)


@pytest.mark.slow
def test_fillet_in_tension_has_the_stress_of_a_finer_solution_at_depth() -> None:
    # Nominal stress is even, so that all that falls beneath the surface is the notch's; linearly it
    # would fall by 5 %.
    rho, depth, F = 0.004, 0.0008, 1e5
    pin = Pin(
        "P",
        (
            Segment(0.1, 0.03, connection="A"),
            Segment(0.06, 0.03, fillet=rho),
            Segment(0.04, 0.05),
            Segment(0.1, 0.05, connection="B"),
        ),
    )
    forces = np.array([[[0.0, 0.0, -F], [0.0, 0.0, F]]])
    loads = PinLoads("c", ("A", "B"), forces, distribution="uniform")
    peak = row(pin, steel(pin, depth), loads, Requirement(0.01))
    found = parts(peak)
    bar = Fillet(0.015, 0.025, rho, 0.16, 0.14, 0.1, F)
    at_surface, beneath = (largest_on_offset(bar, d) for d in (0.0, depth))
    assert beneath < 0.75 * at_surface
    assert found["case"].max_von_mises == pytest.approx(at_surface, rel=0.015)
    assert found["core"].max_von_mises == pytest.approx(beneath, rel=0.01)
    assert found["core"].error_estimate > abs(found["core"].max_von_mises - beneath)


def test_models_without_a_field_by_depth_refuse() -> None:
    pin = Pin("P", (Segment(0.1, 0.04, connection="A"), Segment(0.1, 0.04, connection="B")))
    loads = PinLoads("c", ("A", "B"), np.array([[[0.0, 0.0, -1e4], [0.0, 0.0, 1e4]]]))
    for need in (Requirement(model="beam"), Requirement(model="solid")):
        with pytest.raises(ArgumentError, match="hardened surface"):
            row(pin, steel(pin, 0.001), loads, need)


def test_bore_beneath_a_lug_counts_with_the_core() -> None:
    """A tube that its lugs squeeze has its largest stress in its bore, which is not hardened."""
    bands = (0.01, "L"), (0.001, None), (0.02, "M"), (0.001, None), (0.01, "R")
    pin = Pin("P", tuple(Segment(x, 0.02, 0.012, connection=name) for x, name in bands))
    forces = 2e4 * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
    loads = PinLoads("c", ("L", "M", "R"), forces)
    material = steel(pin, 0.001)
    lugs = tuple(Lug(name, 0.05, material.elastic_part, tilt=2e4) for name in "LMR")
    need = Requirement(0.1, joints="contact", cells="alone")
    (solution,) = solve(PinProblem(pin, material, lugs, (loads,)), need)
    peak = solution.peak
    assert peak.places is not None
    surface, core = peak.places.surface, parts(peak)["core"]
    assert math.hypot(*surface.location[:2]) == pytest.approx(0.006)
    assert core.max_von_mises == pytest.approx(surface.max_von_mises)
    assert peak.safety_factor(None) == pytest.approx(CORE / surface.max_von_mises)

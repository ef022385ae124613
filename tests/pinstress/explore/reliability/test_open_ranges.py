"""What stays open where numbers have laws, on rows that are made up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.places import ContactPlace, Places, SurfacePlace
from fea.support.records import (
    FRICTION,
    TOGETHER,
    BandContact,
    JointRange,
    JointResult,
    Variation,
)
from pinstress.explore.reliability.designs import Answers
from pinstress.explore.reliability.open_ranges import left_out, with_open_ranges
from pinstress.explore.reliability.risk import RiskColumn
from pinstress.explore.sweep.number import Path
from reports.data.row import LandingRange, PinResult
from reports.data.unknowns import growth
from tests.support.each import each
from tests.support.results.made_up_run import make_results
from tests.support.results.rows import with_values

STRESS = 100.0
VARIATIONS = (
    Variation("clearance", "none", 90.0, 0.0),
    Variation("clearance", "twice", 150.0, 0.1),
    Variation("tilt", "free", 120.0, interval=(115.0, 125.0)),
    Variation(FRICTION, "0.1, load growing", 80.0),
)
M, N = ("pin", "A", "lug", "M"), ("pin", "A", "lug", "N")


def row(model: str = "contact") -> PinResult:
    bands = tuple(BandContact(n, 1.0, 60.0, 1.0, (), 0.0, 0.05, 2.0) for n in ("M", "N"))
    joint = JointResult("contact", bands=bands, range=JointRange((90.0, 150.0), VARIATIONS, model))
    return with_values(
        make_results().pins[0], joint=joint, max_von_mises=STRESS, safety_factor=3.0,
        safety_factor_interval=None, verdict="converged",
    )  # fmt: skip


@each(
    ("laws", "expected"),
    [
        (set(), 1.5),
        ({(*M, "clearance"), (*N, "clearance")}, 1.25),
        ({(*M, "clearance"), (*N, "fit")}, 1.25),
        ({(*M, "clearance")}, 1.5),  # all lugs are varied at once
        ({("lug_defaults", "clearance")}, 1.25),
        ({("material", "steel", "youngs_modulus")}, 1.5),
    ],
)
def test_clearances_with_laws_are_not_open(laws: set[Path], expected: float) -> None:
    """They counted twice: by their law, and over the range that a joint without one has."""
    open_row = with_open_ranges(row(), laws, "steel")
    assert growth(open_row) == pytest.approx((expected, 1.0))
    assert open_row.joint is not None
    assert open_row.joint.range is not None
    low, high = open_row.joint.range.max_von_mises
    assert (low, high) == pytest.approx((90.0 if expected > 1.4 else STRESS, STRESS * expected))
    told = list(left_out([row()], laws, {"A": "steel"}))
    assert bool(told) == (expected < 1.4)
    assert all(x.startswith("The range of the clearances is left out") for x in told)


@each(
    ("material", "law_of", "left"),
    [("steel", "steel", True), ("steel", "bronze", False)],
)
def test_a_law_of_another_materials_strength_describes_no_range(
    material: str, law_of: str, left: bool
) -> None:
    """A pin whose own strength has a range was safe where that of a bushing had a law."""
    ranged = replace(row(), joint=None, strength_range=(200.0, 300.0))
    laws: set[Path] = {("material", law_of, "yield_strength")}
    assert (with_open_ranges(ranged, laws, material).strength_range is None) == left
    assert bool(list(left_out([ranged], laws, {"A": material}))) == left


@each(
    ("velocities", "pulses", "laws", "left"),
    [
        ([2.0, 2.0], ["half-sine", "half-sine"], ["impulse_time"], True),
        ([2.0, 3.0], ["half-sine", "half-sine"], ["impulse_time"], False),
        ([2.0, 3.0], ["half-sine", "half-sine"], ["impulse_time", "velocity_change"], True),
        ([2.0, 2.0], ["half-sine", "triangular"], ["impulse_time"], False),
        ([2.0, 2.0], ["half-sine", "half-sine"], ["mass"], False),
    ],
)
def test_a_law_describes_what_it_is_of_in_a_landing(
    velocities: list[float], pulses: list[str], laws: list[str], left: bool
) -> None:
    """A law of any number of the case, as its temperature, took the range of the impulse away."""
    values, stress = np.array(velocities), np.array([STRESS, 2.0 * STRESS])
    case = row().case
    landing = LandingRange(
        "A", case, np.array([0.1, 0.2]), values, values, stress, 300.0 / stress, (0.1, 2.0),
        "converged", pulses=tuple(pulses), nominal_pulse="half-sine",
    )  # fmt: skip
    impulse = "case", case, "apply", 0, "impulse"
    every: set[Path] = {(*impulse, key) for key in laws} | {("case", case, "temperature")}
    assert (with_open_ranges(replace(row(), landing=landing), every, "").landing is None) == left


def test_the_range_of_a_prescribed_support_stays() -> None:
    """Its ends have the error of the foundation, which no variation has alone."""
    laws = {("lug_defaults", "clearance")}
    assert growth(with_open_ranges(row("foundation"), laws, "steel"))[0] == pytest.approx(1.5)


def in_contact(beneath: float) -> PinResult:
    """The row with a stress beneath contact."""
    surface = SurfacePlace(STRESS, 0.0, "converged", (0.0, 0.0, 0.0))
    contact = ContactPlace(beneath, 0.0, (0.0, 0.0, 0.0), None, 0.0, 0.0, (), ())
    return with_values(row(), places=Places("surface", surface, None, contact))


def over(*variations: Variation) -> JointRange:
    return JointRange((STRESS, max(x.max_von_mises for x in variations)), variations)


@each(
    ("variations", "expected"),
    [
        ([Variation("clearance", "high", 104.0, beneath=135.0)], 1.5),
        ([Variation("clearance", "high", 104.0, beneath=80.0)], 1.0),
        ([Variation("clearance", "high", 104.0), Variation(FRICTION, "0.1", 105.0)], 1.0),
        (
            [
                Variation("clearance", "high", 104.0, beneath=108.0),
                Variation("tilt", "free", 100.0, beneath=99.0),
            ],
            1.2 * 1.1,
        ),
        (
            [
                Variation("clearance", "high", 104.0, beneath=108.0),
                Variation("tilt", "free", 100.0, beneath=99.0),
                Variation(TOGETHER, "all", 104.0, beneath=117.0),
            ],
            1.3,
        ),
    ],
)
def test_stress_beneath_contact_has_its_own_growth(
    variations: list[Variation], expected: float
) -> None:
    """It was raised as the row is: a pin was safe whose wide clearance a run finds too large
    beneath contact.
    """
    ranged = over(*variations)
    made = replace(in_contact(90.0), joint=JointResult("contact", range=ranged))
    assert growth(made) == pytest.approx((ranged.max_von_mises[1] / STRESS, expected))


def test_a_sample_is_raised_beneath_contact_by_its_own_growth() -> None:
    """At 0.6 of the strength on the surface and 0.7 beneath contact, where clearances raise the
    first by 1.1 and the second by 1.5.
    """
    used, never = np.array([[0.6]]), np.zeros((1, 1), dtype=bool)
    answers = Answers(used, 0.0 * used, np.array([[0.7]]), never, never)
    for column in (RiskColumn(0), RiskColumn(None)):
        assert column.deep(answers) == pytest.approx([0.7])
        assert column.deep(answers, np.array([[1.1, 1.5]])) == pytest.approx([1.05])
        assert column.deep(answers, np.array([[1.9, 1.0]])) == pytest.approx([1.14])


def test_nothing_is_open_without_a_row() -> None:
    assert growth(None) == (1.0, 1.0)

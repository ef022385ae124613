"""Sizes count what a row is judged by: surface and section with their errors, and what lies beneath
contact with its own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.peak import Maximum
from fea.core.places import ContactPlace, Places, SectionPlace, SurfacePlace
from pinstress.analysis.plan import prepare
from pinstress.analysis.results import run
from pinstress.explore.size.counted import beneath, surface_and_section
from pinstress.explore.size.lightest_pin import problem_of
from pinstress.explore.size.pin_answers import design_stresses
from pinstress.explore.size.pin_stress import PinStress
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.size_pin import CONTACT_FACTOR_TOLERANCE, SizingGoal, size_pin
from pinstress.explore.size.weight_search import WeightGoal
from pinstress.study.reading.file import Study, parse_study
from reports.data.decision import low_factor
from reports.tables.strength.changes import change_notes
from tests.conftest import ROOT

SURFACE = SurfacePlace(100.0, 5.0, "converged", (0.0, 0.0, 1.0))
SECTION = SectionPlace(104.0, 0.5, "converged", 1.0, None, 0.0, 1.0, 1.0, 0.0)


def contact(stress: float, error: float) -> ContactPlace:
    return ContactPlace(stress, error, (0.0, 0.0, 1.0), None, 0.0, 0.0, (), ())


def peak(beneath: ContactPlace | None) -> Maximum:
    places = Places("section", SURFACE, SECTION, beneath)
    return Maximum("P", "c", "harmonic", "converged", "", 104.0, 1.0, places=places)


def test_what_counts() -> None:
    """By hand: of the surface 105, of the section 104.5, of the row 105, beneath 118 or 98."""
    assert dict(surface_and_section(peak(None))) == {"surface": 105.0, "section": 104.5}
    assert beneath(peak(None)) == 0.0
    assert max(design_stresses(peak(None))) == 105.0
    assert max(design_stresses(peak(contact(110.0, 8.0)))) == 118.0
    assert max(design_stresses(peak(contact(90.0, 8.0)))) == 105.0
    singular = replace(peak(contact(90.0, 8.0)), verdict="singular", interval=(100.0, 140.0))
    assert max(design_stresses(singular)) == 104.0


def touching(required: float) -> Study:
    """Lugs that nearly touch, stiff and short: stress beneath the contact is the largest."""
    path = ROOT / "studies" / "clevis.toml"
    text = path.read_text()
    text = text.replace("length = 10, diameter = 20", "length = 4, diameter = 20")
    text = text.replace("length = 20, diameter = 20", "length = 8, diameter = 20")
    text = text.replace("length = 1, diameter = 20", "length = 0.3, diameter = 20")
    text = text.replace("edge_radius = 0.5", "edge_radius = 0.1").replace(
        "clearance = 0.05", "clearance = 0"
    )
    return parse_study(
        path, text.replace("required_safety_factor = 1.5", f"required_safety_factor = {required}")
    )


@pytest.mark.slow
def test_what_lies_beneath_has_a_remedy() -> None:
    """Surface and section have a factor of 3.0, what lies beneath one of 2.25."""
    results = run(touching(2.6))
    (before,) = results.pins
    assert any("beneath contact" in note for note in change_notes(results))
    assert before.decided
    assert [x.over for x in before.depends_on] == ["beneath"]
    assert (low_factor(before) or 0.0) < 2.6 < (before.safety_factor or 0.0)
    (remedy,) = results.changes
    strength = before.yield_strength or 0.0
    needed = strength * 2.6 / (low_factor(before) or 1.0)
    assert remedy.yield_strength == pytest.approx(needed, rel=0.02)


@pytest.mark.long
@pytest.mark.slow
def test_a_pin_is_sized_by_what_lies_beneath() -> None:
    """A run of the new study is safe, beneath, too."""
    study = touching(2.6)
    sized = size_pin(prepare(study), "P", SizingGoal(2.6), {})
    assert sized.scale is not None
    assert 1.02 < sized.scale < 1.3
    (after,) = run(resized_study(study, {"P": sized.scale})).pins
    assert not [x for x in after.depends_on if x.over == "beneath"]
    assert 2.6 <= (low_factor(after) or 0.0) <= 2.6 * (1.0 + CONTACT_FACTOR_TOLERANCE)


@pytest.mark.slow
def test_a_search_has_what_lies_beneath_as_a_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """With its value from the run and, once two designs are known, the slope between them."""
    monkeypatch.setattr("pinstress.explore.size.pin_stress.UNKNOWN_PLACE_WINDOW", 1.0)
    study = touching(2.6)
    problem = problem_of(study, prepare(study), "P", WeightGoal(2.6))
    assert not isinstance(problem, str)
    stress, values = PinStress(problem, lambda _: None), problem.shape.values
    first, second = (stress.at(values * x) for x in (1.0, 1.05))
    one, other = (
        next(p for p in x.places if p.name == "pull, beneath contact") for x in (first, second)
    )
    assert one.value == pytest.approx(np.log(2.6 / 2.25), abs=0.05)
    assert first.worst == one.value
    assert other.slope is not None
    assert other.slope.sum() == pytest.approx((other.value - one.value) / np.log(1.05), rel=1e-6)
    named = {p.name: p.slope for p in first.places}
    assert named.keys() == {"pull, surface", "pull, section", "pull, beneath contact"}
    slope = named["pull, surface"]
    assert slope is not None
    values_of = [next(p.value for p in x.places if "surface" in p.name) for x in (first, second)]
    by_differences = (values_of[1] - values_of[0]) / np.log(1.05)
    # stress counts with its error, which on rough cells changes by 2 % between these designs
    assert slope.sum() == pytest.approx(by_differences, abs=0.3)

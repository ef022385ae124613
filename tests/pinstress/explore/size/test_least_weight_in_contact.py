"""`size --least-weight` of pins in contact with lugs, whose eyes follow them."""

from __future__ import annotations

import numpy as np
import pytest

import pinstress
from pinstress.analysis.plan import prepare
from pinstress.explore.size.least_weight import lighten
from pinstress.explore.size.lightest_pin import problem_of
from pinstress.explore.size.other_dimensions import written_study
from pinstress.explore.size.pin_stress import PinStress
from pinstress.explore.size.weight_search import WeightGoal
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import load_study
from reports.data.decision import low_factor
from tests.conftest import ROOT
from tests.support.pins.clevis import CLEVIS

EYE = CLEVIS.replace("[pin.P.lug.M]", "[pin.P.lug.M]\nouter_diameter = 32").replace(
    "yield_strength", 'density = "7850 kg/m^3"\nyield_strength'
)


def test_eyes_follow_a_pin_in_the_search_as_in_what_is_written() -> None:
    """From 1.5 times the diameter on: 32 mm about 20, 36 about 24."""
    study = pinstress.study_from(EYE)
    problem = problem_of(study, prepare(study), "P", WeightGoal(2.0))
    assert not isinstance(problem, str)
    stress, shape = PinStress(problem, lambda _: None), problem.shape
    for times, eye in ((1.0, 0.032), (1.05, 0.032), (1.2, 0.036)):
        values = times * shape.values
        by_key = dict(zip(shape.keys, map(float, values), strict=True))
        written = written_study(study, {"P": (shape.pin, shape.dimensions)}, {"P": by_key})
        for new in (stress.study_at(values), written):
            assert new.table.pin["P"].lug["M"].outer_diameter == pytest.approx(eye, rel=1e-9)


@pytest.mark.long
@pytest.mark.slow
def test_the_clevis_settles_in_one_pass() -> None:
    """Its run has finer cells and so a smaller error than its search, which is no reason to search
    under the same loads again.
    """
    found = lighten(load_study(ROOT / "studies" / "clevis.toml"), WeightGoal(1.5))
    assert (found.settled, found.passes) == (True, 1)
    (row,) = found.results.pins
    assert 1.5 <= (low_factor(row) or 0.0) <= 1.5 * 1.05


@pytest.mark.slow
def test_in_contact_rough_cells_are_corrected_by_usual_ones() -> None:
    """Three times the usual factor: the pin and its eye grow, and a run on its own cells has it."""
    found = lighten(pinstress.study_from(EYE), WeightGoal(6.0))
    (only,) = found.pins
    assert found.settled
    assert only.values is not None, only.why
    assert only.optimality is not None
    assert only.optimality.residual < 0.02
    (row,) = found.results.pins
    assert row.joint is not None
    assert 6.0 <= (low_factor(row) or 0.0) <= 6.0 * 1.06
    band = 2.0 * pin_of(found.study, "P").band("M").radius
    assert found.study.table.pin["P"].lug["M"].outer_diameter == pytest.approx(1.5 * band, rel=1e-3)


@pytest.mark.long
@pytest.mark.slow
def test_in_contact_stress_has_the_derivatives_of_differences() -> None:
    """Where the eye grows with the pin, too. What lies beneath is only supposed to scale with the
    pin: by the cube of its dimensions.
    """
    study = pinstress.study_from(EYE)
    problem = problem_of(study, prepare(study), "P", WeightGoal(2.0))
    assert not isinstance(problem, str)
    stress, values = PinStress(problem, lambda _: None), 1.2 * problem.shape.values
    here, more, less = (
        {place.name: place for place in stress.at(values * np.exp(x)).places}
        for x in (0.0, 0.02, -0.02)
    )
    assert set(here) == {"pull, surface", "pull, section", "pull, beneath contact"}
    for name, place in here.items():
        assert place.slope is not None
        expected = (more[name].value - less[name].value) / 0.04
        off = 0.1 if "beneath" in name else 0.005
        assert float(place.slope.sum()) == pytest.approx(expected, rel=off)

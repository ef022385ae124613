"""Results of a motion do not depend on how many samples a study asks for."""

from __future__ import annotations

import numpy as np
import pytest

from pinstress import run
from pinstress.analysis.plan import prepare
from pinstress.study.model.cases import at_time
from pinstress.study.reading.file import Study, load_study, parse_study
from reports.data.row import PinResult
from tests.conftest import ROOT

STUDY = ROOT / "studies" / "slider_crank.toml"
SAMPLES = "samples = 241"


def study(samples: int, turns: int = 1) -> Study:
    """The slider-crank of the shipped study, over so many turns of as long each."""
    text = STUDY.read_text(encoding="utf-8")
    for old, new in (
        (SAMPLES, f"samples = {samples}"),
        ('end = "380 deg"', f'end = "{20 + 360 * turns} deg"'),
        ("duration = 0.25", f"duration = {0.25 * turns}"),
    ):
        assert old in text
        text = text.replace(old, new)
    return parse_study(STUDY, text)


def solved(samples: int, turns: int = 1) -> PinResult:
    (pin,) = run(study(samples, turns), pins=["O"], tolerance=0.05).pins
    return pin


@pytest.fixture(scope="module")
def many() -> PinResult:
    return solved(4001)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("samples", "turns"), [(2, 1), pytest.param(41, 1, marks=pytest.mark.long), (11, 10)]
)
def test_the_maximum_is_of_time_not_of_samples(samples: int, turns: int, many: PinResult) -> None:
    """Beside 4,001 samples of one turn, where a sample is at most 3e-5 s from the crest: maximum to
    1e-6, time (of whichever turn) to 1e-5 s; eleven samples of ten turns are all at one angle.
    """
    few = solved(samples, turns)
    assert few.verdict == many.verdict == "converged"
    assert few.max_von_mises == pytest.approx(many.max_von_mises, rel=1e-6)
    assert few.time is not None
    assert many.time is not None
    assert few.time % 0.25 == pytest.approx(many.time, abs=1e-5)
    assert few.position is not None
    assert few.position % 360.0 == pytest.approx(many.position or 0.0, abs=0.02)


def test_loads_beside_the_maximum_are_those_of_its_instant() -> None:
    """What the report shows is what a motion sampled there has."""
    few = solved(41)
    assert few.time is not None
    plan = prepare(study(41), pins=["O"])
    case = at_time(plan.loads["turn"], few.time)
    assert case is not None
    reactions = case.reactions
    (load,) = few.loads
    c = reactions.connections.index(load.connection)
    assert load.force == pytest.approx(reactions.forces[0, c], rel=1e-9)


def test_loads_between_samples_are_the_mechanisms_own() -> None:
    """Polynomials beside the mechanism solved at 200 times, to 1e-6 of the largest force."""
    loads = prepare(load_study(STUDY)).loads["turn"]
    assert loads.moving is not None
    times = np.sort(np.random.default_rng(5).uniform(0.0, 0.25, 200))
    found, _ = loads.moving.at(times)
    assert loads.solve is not None
    exact = loads.solve(times).reactions
    size = np.abs(exact.forces).max()
    assert np.abs(found.forces - exact.forces).max() <= 1e-6 * size
    assert np.abs(found.turn - exact.turn).max() <= 1e-6

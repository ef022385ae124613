"""Results of a motion do not depend on how many samples a study asks for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pinstress import run
from pinstress.analysis.plan import prepare
from pinstress.study.model.cases import at_time
from pinstress.study.reading.file import Study, load_study, parse_study
from reports.data.row import PinResult
from tests.conftest import ROOT
from tests.support.study_text import edited

STUDY = ROOT / "studies" / "slider_crank.toml"
SAMPLES = "samples = 241"


def study(samples: int, turns: int = 1) -> Study:
    """The slider-crank of the shipped study, over so many turns of as long each."""
    changes = (
        (SAMPLES, f"samples = {samples}"),
        ('end = "380 deg"', f'end = "{20 + 360 * turns} deg"'),
        ("duration = 0.25", f"duration = {0.25 * turns}"),
    )
    return parse_study(STUDY, edited(STUDY.read_text(encoding="utf-8"), changes))


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
    """What the report shows is what a motion sampled there has, to the polynomials' accuracy."""
    few = solved(41)
    assert few.time is not None
    plan = prepare(study(41), pins=["O"])
    case = at_time(plan.loads["turn"], few.time)
    assert case is not None
    reactions = case.reactions
    (load,) = few.loads
    c = reactions.connections.index(load.connection)
    size = float(reactions.magnitudes[0, c])
    assert load.force == pytest.approx(reactions.forces[0, c], abs=1e-6 * size)


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


PRESS = """
title = "A press that ends at rest"
units = "in-lbf-s"
[case.press]
kind = "motion"
samples = 5
[[case.press.apply]]
body = "piston"
at = "C"
direction = [-1, 0]
force_law = { points = [["0 s", 0], ["1 s", 10000]] }
[mechanism]
gravity = [0, 0]
[mechanism.drive]
body = "crank"
line = ["O", "A"]
start = "60 deg"
end = "40 deg"
duration = 1
law = "cycloidal"
[mechanism.joint]
O = { at = [0, 0], fixed_in = "ground", connections = { O = "crank" } }
A = { at = [2, 3.4641016151377544], fixed_in = "crank", connections = { A = "rod" } }
C = { at = [12, 0], fixed_in = "piston", connections = { C = "rod" } }
[mechanism.slider.guide]
bodies = ["ground", "piston"]
joints = ["O", "C"]
direction = [1, 0]
friction = 0.2
[mechanism.body]
crank = { mass = 0, inertia = 0 }
rod = { mass = 0, inertia = 0 }
piston = { mass = 0 }
[material.steel]
youngs_modulus = "30e6 psi"
poisson_ratio = 0.3
yield_strength = "150 ksi"
[analysis]
model = "beam"
tolerance = 0.9
[pin.A]
material = "steel"
clamp = ["start"]
profile = [{ length = 2, diameter = 1.5 }, { length = 1.5, diameter = 1, connection = "A" }]
"""


def test_the_force_beside_a_maximum_is_that_before_its_mechanism_rests() -> None:
    """A piston without mass, pushed against 10,000 lbf until it stops, beside the equilibrium of
    its rod, guide and friction: the row's force, the table's and the checks' are that just before.
    """
    results = run(parse_study(STUDY, PRESS))
    (row,) = results.pins
    (load,) = row.loads
    inclined = math.asin(4.0 * math.sin(math.radians(40.0)) / math.hypot(10.0, 4.0 * 3**0.5 / 2))
    rod = 10000.0 / (math.cos(inclined) - 0.2 * math.sin(inclined))
    assert float(np.linalg.norm(load.force)) == pytest.approx(rod, rel=1e-6)
    (peak,) = (p for table in results.reactions for p in table.largest if p.connection == "A")
    assert peak.force == pytest.approx(rod, rel=1e-6)
    bearing = next(m for m in row.margins if m.method == "bearing" and m.demand)
    assert bearing.demand == pytest.approx(rod / (1.0 * 1.5), rel=1e-6)


def test_no_force_of_the_start_stands_beside_a_motion_without_a_solution() -> None:
    """It was shown as that of the instant which governs."""
    loose = PRESS.replace('clamp = ["start"]\n', "")
    (row,) = run(parse_study(STUDY, loose)).pins
    assert (row.verdict, row.time, row.loads) == ("rigid", None, ())

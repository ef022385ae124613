"""Item 7: damage of a spectrum of which a part is missing, and failures of the assessment.

A case that could not be solved was left out of the damage: "no damage at any critical point". A
life below two repetitions of the sequence ended `fkm-p-ram` in "float division by zero", and all
results of the run were lost. And (item 19) pyLife's warnings went to the terminal.

Independent values: the same pin with the case in equilibrium, with its stress by beam theory;
pyLife's own life where it has one.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import pinstress
from assess.fatigue.fkm import FkmMaterial, p_ram_life
from fea.harmonic.evaluate import SECTION_MESHES
from pinstress.analysis.results import RunResults
from reports.data.requirements import requirement_rows
from reports.tables.json_results import to_json
from reports.tables.strength.fatigue import fatigue_sentence, shown_fatigue

STUDY = """
title = "A pin without a clamp"
units = "mm-N-s"
[material.steel]
youngs_modulus = "200 GPa"
poisson_ratio = 0.3
yield_strength = "800 MPa"
[material.steel.fatigue]
knee_stress = "250 MPa"
knee_cycles = 1e6
slope = 5
scatter = 3.5
mean_stress_sensitivity = 0.2
[pin.P]
material = "steel"
profile = [{ length = 10, diameter = 20, connection = "A" },
           { length = 40, diameter = 20, connection = "B" },
           { length = 10, diameter = 20, connection = "C" }]
[case.work]
kind = "given"
forces = { A = [-10000, 0], B = [20000, 0], C = [-10000, 0] }
[case.jam]
kind = "given"
forces = { A = [-30000, 0], B = [JAM, 0], C = [-30000, 0] }
[analysis]
model = "beam"
tolerance = 0.5
[fatigue]
unit = "day"
life = 1000
[fatigue.occurrences]
"""
BALANCED, RIGID = "60000", "80000"
BOTH = "work = 10\njam = 10\n"
SEQUENCE = """day = 10
[sequence.day]
steps = [{ case = "work", duration = "1 s" }, { case = "jam", duration = "1 s" }]
"""
Run = Callable[..., RunResults]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    def results(text: str, cases: list[str] | None = None) -> RunResults:
        path = tmp_path / "pin.toml"
        path.write_text(text)
        return pinstress.run(pinstress.load_study(path), cases=cases)

    return results


def _margin(results: RunResults) -> tuple[float | None, str]:
    (found,) = (m.margin for m in results.margins if m.margin.method == "fatigue life")
    return found.margin, found.needs


@pytest.mark.parametrize("spectrum", [BOTH, SEQUENCE])
def test_a_case_that_could_not_be_solved_leaves_the_pin_undecided(run: Run, spectrum: str) -> None:
    results = run(STUDY.replace("JAM", RIGID) + spectrum)
    assert results["P", "jam"].verdict == "rigid"
    assert results.fatigue is not None
    assert results.fatigue.not_decided == {"P": "case jam was not solved (rigid)"}
    sentence = fatigue_sentence(results.fatigue)
    assert sentence.startswith("Fatigue of pin P is not decided: case jam was not solved (rigid)")
    assert "no damage" not in sentence
    assert _margin(results) == (None, "a solution of case jam")
    told = to_json(results)["fatigue"]
    assert told["not_decided"] == results.fatigue.not_decided
    assert {row["not_decided"] for row in results.tables["fatigue"].records()} == {
        "case jam was not solved (rigid)"
    }
    table = shown_fatigue(results)
    assert table is not None
    assert all(row[3].startswith("≥") for row in table.grid(results.units).body)


def test_in_equilibrium_the_case_takes_most_of_the_life(run: Run) -> None:
    """What had no word: pulses of 30 kN at 30 mm in the middle of the span, by beam theory."""
    results = run(STUDY.replace("JAM", BALANCED) + BOTH)
    assert results.fatigue is not None
    assert not results.fatigue.not_decided
    moment = 30000.0 * 25.0 - 60000.0 / 40.0 * 20.0**2 / 2.0
    amplitude = 0.5 * moment / (np.pi * 20.0**3 / 32.0) * 1.2
    damage = 10.0 * (amplitude / 250.0) ** 5 / 1e6
    assert results.fatigue.points[0].damage == pytest.approx(damage, rel=0.05)
    assert _margin(results)[0] == pytest.approx(1.0 / (1000.0 * damage) - 1.0, rel=0.05)


def test_a_case_that_was_not_run_leaves_the_pin_undecided(run: Run) -> None:
    results = run(STUDY.replace("JAM", BALANCED) + BOTH, cases=["work"])
    assert results.fatigue is not None
    assert results.fatigue.not_decided == {"P": "case jam was not run"}
    assert _margin(results) == (None, "case jam to be run")


def test_stress_whose_error_is_unknown_leaves_the_pin_undecided(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One mesh does not tell it; twice the stress was taken for its bound."""
    coarse = replace(SECTION_MESHES, max_unknowns=1)
    monkeypatch.setattr("fea.harmonic.evaluate.SECTION_MESHES", coarse)
    small = STUDY.replace("JAM", BALANCED).replace('"beam"', '"harmonic"')
    results = run(small.replace("0000", "000") + BOTH)
    assert results.fatigue is not None
    reason = "the error of the stress is unknown in cases work, jam"
    assert results.fatigue.not_decided == {"P": reason}
    assert _margin(results) == (None, "a known error of the stress")


def test_a_pin_that_has_too_much_damage_already_fails(run: Run) -> None:
    hard = STUDY.replace("JAM", RIGID).replace("10000", "30000").replace("20000", "60000")
    results = run(hard.replace("life = 1000", "life = 1e6") + BOTH)
    assert results.fatigue is not None
    assert not results.fatigue.not_decided
    assert any("too low: case jam was not solved" in said for said in results.fatigue.left_out)
    margin, needs = _margin(results)
    assert margin is not None
    assert margin < 0.0
    assert not needs


CORNER = (
    STUDY.partition("[pin.P]")[0]
    + """
[pin.P]
material = "steel"
profile = [{ length = 20, diameter = 30, connection = "A" },
           { length = 10, diameter = 30, fillet = 0 },
           { length = 40, diameter = 20, connection = "B" },
           { length = 10, diameter = 20, connection = "C" }]
[case.pull]
kind = "given"
forces = { A = [-500, 0], B = [1300, 0], C = [-800, 0] }
[analysis]
tolerance = 0.1
[fatigue]
life = 1e6
[fatigue.occurrences]
pull = 1
[[require]]
check = "fatigue"
factor = 1
"""
)


def test_a_sharp_corner_leaves_the_pin_undecided(run: Run) -> None:
    """A crack starts there first. Its zone was left out: "no damage at any critical point", and
    the pin was safe in fatigue over all cases.
    """
    sharp, filleted = run(CORNER), run(CORNER.replace("fillet = 0", "fillet = 3"))
    assert sharp["P", "pull"].verdict == "singular"
    assert sharp.fatigue is not None
    assert filleted.fatigue is not None
    reason = "cracks may start at a sharp corner, where the stress has no maximum"
    assert sharp.fatigue.not_decided == {"P": reason}
    assert not filleted.fatigue.not_decided
    asked = [
        next(r for r in requirement_rows(x) if r.check == "fatigue") for x in (sharp, filleted)
    ]
    assert [x.outcome for x in asked] == ["not decided", "met"]
    assert asked[0].needs == "a maximum of the stress"


def _broken(*_: object) -> None:
    raise RuntimeError("no convergence")


@pytest.mark.parametrize(
    ("what", "reason"),
    [
        (
            "pinstress.analysis.gather.gather_fatigue.assess_over",
            "at point 1, signed-von-mises failed",
        ),
        (
            "assess.fatigue.critical_points.stress_histories",
            "no history of stress in cases work, jam",
        ),
    ],
)
def test_a_failure_loses_nothing_else(
    run: Run, monkeypatch: pytest.MonkeyPatch, what: str, reason: str
) -> None:
    monkeypatch.setattr(what, _broken)
    results = run(STUDY.replace("JAM", BALANCED) + BOTH)
    assert results["P", "work"].max_von_mises
    assert results.fatigue is not None
    assert reason in results.fatigue.not_decided["P"]
    assert "RuntimeError: no convergence" in results.fatigue.not_decided["P"]
    assert _margin(results)[0] is None


FKM = FkmMaterial("Steel", 1000e6, 6.3e-6, 1.7)


def test_a_life_below_two_repetitions_is_found() -> None:
    lives = [
        p_ram_life(1e6 * np.array([0.0, a, -a, 0.0]), FKM).repetitions
        for a in (1600.0, 2000.0, 2400.0, 3000.0, 5000.0)
    ]
    # pyLife 2.3 has 24.7058 and 3.93595, and 0 for the rest: of these the second run of the
    # sequence, which is the first with a closed cycle, takes the whole life.
    assert lives[:2] == pytest.approx([24.705833, 3.9359547], rel=1e-6)
    assert all(x > y >= 1.0 for x, y in pairwise(lives))


@pytest.mark.parametrize("plastic", [1.0, 1.7])
def test_pylife_says_nothing(capsys: pytest.CaptureFixture[str], plastic: float) -> None:
    """Cycles in compression, of whose P_RAM it takes the root of a negative number."""
    material = FkmMaterial("Steel", 1000e6, 6.3e-6, plastic)
    sequence = -1e6 * np.array([0.0, 900.0, 850.0, 900.0, 0.0])
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = p_ram_life(sequence, material)
        assert found.at is not None
        assert found.at(0.1) < found.at(0.9)
    assert not caught
    assert capsys.readouterr() == ("", "")

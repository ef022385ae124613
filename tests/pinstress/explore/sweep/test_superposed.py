"""Designs that differ by loads and strengths, solved together, against each solved alone."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest

import pinstress
from pinbase.memo import Memo
from pinstress import Study, changed_study, study_from
from pinstress.explore.sweep.evaluate import DesignRow, Evaluator
from pinstress.explore.sweep.laws import Floats
from pinstress.explore.sweep.number import number_at
from tests.support.each import each

PIN = """title = "Three bands"
units = "mm-N-s"
[material.steel]
youngs_modulus = "205 GPa"
poisson_ratio = 0.3
density = 7.85e-9
yield_strength = "500 MPa"
[pin.P]
material = "steel"
{held}
profile = [
  {{ length = 20, diameter = 24, connection = "left" }},
  {{ length = 30, diameter = 30, connection = "middle" }},
  {{ length = 20, diameter = 24, connection = "right" }},
]
{fillet}
[case.pull]
kind = "given"
distribution = "{spread}"
forces = {{ left = [300, 5000], {middle}right = [300, 5000] }}
[analysis]
required_safety_factor = 2
tolerance = {tolerance}
"""
CLAMPED = {"held": 'clamp = ["start"]', "middle": "middle = [0, -8000], "}
BALANCED = {"held": 'balance = "middle"', "middle": ""}
ROUND, SHARP = {"fillet": "fillet = 1.5"}, {"fillet": ""}
KEYS = (
    "case.pull.forces.left[1]",
    "case.pull.forces.left[2]",
    "case.pull.forces.right[2]",
    "material.steel.yield_strength",
)
MEMO = Memo()
FRESH = """
import json, sys
import pinstress
row = pinstress.run(pinstress.study_from(sys.stdin.read())).pins[0]
print(json.dumps([row.max_von_mises, row.error_estimate, row.safety_factor, row.verdict]))
"""


def _pin(
    held: dict[str, str], fillet: dict[str, str], spread: str = "cosine", tolerance: float = 0.05
) -> Study:
    return study_from(PIN.format(**held, **fillet, spread=spread, tolerance=tolerance))


def _evaluator(study: Study, memo: Memo = MEMO) -> Evaluator:
    evaluator = Evaluator(study, [number_at(study, key) for key in KEYS])
    evaluator.memo = memo  # of meshes and unit fields, not of rows
    return evaluator


def _designs(evaluator: Evaluator, count: int) -> Floats:
    """Values (count, 4) scattered about those of the study: by a fifth, or, without a clamp, by so
    little that bands react the couple that is left.
    """
    nominal = [number.nominal for number in evaluator.numbers]
    part = 0.2 if evaluator.study.table.pin["P"].clamp else 0.002
    normal = np.random.default_rng(5).standard_normal((count, len(nominal)))
    return np.asarray((1.0 + part * normal) * nominal)


def _changes(evaluator: Evaluator, design: Floats) -> dict[str, float | str]:
    pairs = zip(evaluator.numbers, design.tolist(), strict=True)
    return {n.key: n.in_study(n.shown(x)) for n, x in pairs}


@each(
    ("held", "fillet", "spread", "verdicts"),
    [
        (CLAMPED, ROUND, "cosine", {"converged", "singular"}),
        (BALANCED, ROUND, "uniform", {"converged"}),
        (BALANCED, SHARP, "cosine", {"singular"}),
    ],
)
def test_designs_together_are_each_alone(
    held: dict[str, str], fillet: dict[str, str], spread: str, verdicts: set[str]
) -> None:
    """To the last bit, whichever others are solved with them and in what order, and as a run has
    them.
    """
    study = _pin(held, fillet, spread)
    evaluator = _evaluator(study)
    designs = _designs(evaluator, 5)
    together = evaluator.rows_of(designs)
    alone, others = _evaluator(study), _evaluator(study)
    assert [alone.rows(design) for design in designs] == together
    assert others.rows_of(designs[4:1:-1]) == together[4:1:-1]
    assert {row.verdict for (row,) in together} == verdicts
    stress, (row,) = study.system.factor("stress"), together[3]
    run = pinstress.run(changed_study(study, _changes(evaluator, designs[3]))).pins[0]
    assert row.max_von_mises is not None
    assert row.error_estimate is not None
    ours = row.max_von_mises / stress, row.error_estimate / stress, row.safety_factor, row.verdict
    assert ours == (run.max_von_mises, run.error_estimate, run.safety_factor, run.verdict)
    assert row.reason == ("" if run.verdict == "converged" else run.note)


def test_designs_that_no_harmonic_mesh_solves_are_among_others() -> None:
    """With some unit loads less, out of balance, or accurate enough by a beam."""
    designs = _designs(_evaluator(_pin(CLAMPED, ROUND)), 3)
    without = designs.copy()
    without[1, :3] = 0.0  # the middle still pulls
    loose = BALANCED | {"held": "", "middle": "middle = [-600, -20000], "}
    rows = [
        *_same(_pin(CLAMPED, ROUND), without),
        *_same(_pin(loose, ROUND), designs),
        *_same(_pin(BALANCED, ROUND, tolerance=0.9), designs[:, [0, 1, 1, 3]]),
    ]
    first = ["converged", "singular", "singular"]
    assert [row.verdict for row in rows] == [*first, *["rigid"] * 3, *["converged"] * 3]


def _same(study: Study, designs: Floats) -> list[DesignRow]:
    """The rows of designs, which are those of each alone."""
    together, alone = _evaluator(study).rows_of(designs), _evaluator(study)
    assert [alone.rows(design) for design in designs] == together
    return [row for (row,) in together]


def test_together_nothing_is_meshed_more_often() -> None:
    together, once = (_evaluator(_pin(CLAMPED, ROUND), Memo()) for _ in range(2))
    designs = _designs(once, 12)
    together.rows_of(designs)
    for design in designs:
        once.rows(design)
    assert 3 <= together.memo.made <= once.memo.made


@pytest.mark.slow
def test_designs_are_fresh_runs_in_processes_of_their_own() -> None:
    """One in ten of twenty, to 1e-9: another process may use other instructions."""
    study = _pin(BALANCED, ROUND)
    evaluator = _evaluator(study)
    designs = _designs(evaluator, 20)
    stress = study.system.factor("stress")
    pairs = list(zip(designs, evaluator.rows_of(designs), strict=True))
    for design, (row,) in pairs[::10]:
        text = changed_study(study, _changes(evaluator, design)).text
        command = [sys.executable, "-c", FRESH]
        out = subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout
        *numbers, verdict = json.loads(out)
        assert row.max_von_mises is not None
        assert row.error_estimate is not None
        ours = [row.max_von_mises / stress, row.error_estimate / stress, row.safety_factor]
        assert ours == pytest.approx(numbers, rel=1e-9)
        assert row.verdict == verdict

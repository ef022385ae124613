"""All that a study answers in numbers, by names that survive a change of how it is said."""

from __future__ import annotations

import random
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import pinstress
from tests.fuzz.quantity import Tree, write


@dataclass(frozen=True)
class Row:
    """Of a pin in a case: maximum and error, Pa, and what was judged of it."""

    maximum: float
    error: float
    verdict: str


@dataclass(frozen=True)
class Answers:
    """Rows by pin and case; utilisations by pin, case, check and place; damage by pin."""

    rows: dict[tuple[str, str], Row]
    used: dict[tuple[str, str, str, str, str], float | None]
    damage: dict[str, float] = field(default_factory=dict)


def answers(tree: Tree, spelling: random.Random | None = None, model: str = "auto") -> Answers:
    """Run a study."""
    with tempfile.TemporaryDirectory() as folder:
        study = pinstress.load_study(write(tree, Path(folder), spelling))
        results = pinstress.run(study, tolerance=0.2, model=model)  # type: ignore[arg-type]
    pascal = study.system.factor("stress")
    rows = {}
    for row in results.pins:
        assert row.max_von_mises is not None, row.note
        assert row.error_estimate is not None
        rows[row.pin, row.case] = Row(
            row.max_von_mises * pascal, row.error_estimate * pascal, row.verdict
        )
    margins = [m for m in results.margins if m.margin.governs]
    checks = [(m.pin, m.case, m.margin.method, m.margin.level) for m in margins]
    # Of a check with one margin `at` is the worst place, which others may equal to round-off.
    used: dict[tuple[str, str, str, str, str], float | None] = {
        (*check, m.margin.at if checks.count(check) > 1 else ""): m.margin.utilisation
        for check, m in zip(checks, margins, strict=True)
    }
    damage: dict[str, float] = {}
    for point in results.fatigue.points if results.fatigue is not None else ():
        damage[point.pin] = max(point.damage, damage.get(point.pin, 0.0))
    return Answers(rows, used, damage)

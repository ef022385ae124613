"""Fatigue and histories of stress, as tables and as JSON."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fea.fatigue.records import PointFatigue
from reports.data.results import Fatigue, Results
from reports.format.files.csv import Cell
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, finite
from reports.tables.table import Table

PROBABILITIES = ("10 %", "50 %", "90 %")
METHODS = {
    "signed-von-mises": "signed von Mises stress",
    "critical-plane": "Findley's critical plane",
    "fkm-p-ram": "P_RAM of the FKM guideline for local strains",
}
HISTORY = ("pin", "case", "time", "point", "von_mises", "signed")
POINTS = ("pin", "point", "x", "y", "z", "chosen")
COLUMNS = (
    *("pin", "point", "x", "y", "z", "method", "damage", "life", "life_10", "life_50", "life_90"),
    *("utilisation", "amplitude", "mean_stress", "note", "normal_x", "normal_y", "normal_z"),
)


def fatigue_tables(results: Results) -> list[Table]:
    """Histories, their points, and damage."""
    return [
        Table.of("stress_history", HISTORY, _history(results)),
        Table.of("critical_points", POINTS, _points(results)),
        Table.of("fatigue", COLUMNS, _rows(results.fatigue)),
    ]


def _history(results: Results) -> Iterator[list[Cell]]:
    for h in results.histories:
        for case in h.cases:
            times = [None] * len(case.signed) if case.times is None else case.times.tolist()
            values = (case.von_mises.tolist(), case.signed.tolist())
            for time, von_mises, signed in zip(times, *values, strict=True):
                yield [h.pin, case.case, time, h.point, von_mises, signed]


def _points(results: Results) -> Iterator[list[Cell]]:
    for h in results.histories:
        yield [h.pin, h.point, *h.location, h.chosen]


def _rows(fatigue: Fatigue | None) -> Iterator[list[Cell]]:
    for p in fatigue.points if fatigue else ():
        lives = p.lives or (None,) * len(PROBABILITIES)
        yield [
            *(p.pin, p.point, *p.location, p.method, p.damage, p.life, *lives),
            *(p.utilisation, p.amplitude, p.mean, p.note),
            *(p.normal or (None,) * 3),
        ]


def worst_points(fatigue: Fatigue) -> list[PointFatigue]:
    """Of each pin the point with the most damage, the worst pin first."""
    return list({p.pin: p for p in reversed(fatigue.points)}.values())[::-1]


def fatigue_grid(results: Results) -> Grid | None:
    """Each pin's worst point; None where nothing is assessed."""
    fatigue = results.fatigue
    if fatigue is None or not fatigue.points:
        return None
    unit, stress = fatigue.unit, results.units.stress
    head = ["Pin", "point", f"z [{results.units.length}]", f"damage per {unit}", f"life [{unit}s]"]
    scattered = any(p.lives for p in fatigue.points)
    head += [f"at {p}" for p in PROBABILITIES] if scattered else []
    head += ["utilisation"] if fatigue.life is not None else []
    head += [f"amplitude [{stress}]", f"mean [{stress}]"]
    head += ["normal of the plane"] if fatigue.method == "critical-plane" else []
    body = []
    for p in worst_points(fatigue):
        lives = [life_words(x) for x in p.lives] or [DASH] * len(PROBABILITIES)
        body.append(
            [
                *(p.pin, str(p.point), engineering(p.location[2], 3)),
                *(engineering(p.damage, 3) if p.damage else "none", life_words(p.life)),
                *(lives if scattered else []),
                *([_per_cent(p.utilisation)] if fatigue.life is not None else []),
                *(engineering(p.amplitude, 3), engineering(p.mean, 3)),
                *([", ".join(f"{x:.2f}" for x in p.normal)] if p.normal else []),
            ]
        )
    return Grid(head, body, [False, *[True] * (len(head) - 1)])


def life_words(life: float | None) -> str:
    """Units until damage 1."""
    return "no limit" if life is None else engineering(life, 3)


def _per_cent(part: float | None) -> str:
    return DASH if part is None else f"{engineering(100.0 * part, 3)} %"


def fatigue_sentence(fatigue: Fatigue) -> str:
    """The worst point in a line."""
    if not fatigue.points:
        return "Fatigue is not assessed."
    worst, unit = fatigue.points[0], fatigue.unit
    if not worst.damage:
        return f"Fatigue: no damage at any critical point ({METHODS[fatigue.method]})."
    text = f"Fatigue: pin {worst.pin} reaches damage 1 after {life_words(worst.life)} {unit}s"
    if worst.lives:
        few, many = life_words(worst.lives[0]), life_words(worst.lives[2])
        text += f" ({few} at 10 %, {many} at 90 % failure probability)"
    if worst.utilisation is not None:
        text += f"; the design life uses {_per_cent(worst.utilisation)} of it"
    return f"{text} ({METHODS[fatigue.method]})."


def fatigue_json(fatigue: Fatigue | None) -> dict[str, Any] | None:
    """As in results.json."""
    if fatigue is None:
        return None
    return {
        "unit": fatigue.unit,
        "occurrences": fatigue.occurrences,
        "method": fatigue.method,
        "failure_probability": finite(fatigue.probability),
        "design_life": finite(fatigue.life),
        "points": [_point(p) for p in fatigue.points],
        "left_out": list(fatigue.left_out),
    }


def _point(p: PointFatigue) -> dict[str, Any]:
    lives = {name: finite(x) for name, x in zip(("10", "50", "90"), p.lives, strict=False)}
    return {
        "pin": p.pin,
        "point": p.point,
        "location": [finite(x) for x in p.location],
        "cases": list(p.cases),
        "damage": finite(p.damage),
        "life": finite(p.life),
        "life_at_probability": lives,
        "utilisation": finite(p.utilisation),
        "amplitude": finite(p.amplitude),
        "mean": finite(p.mean),
        "note": p.note,
        "plane_normal": None if p.normal is None else [finite(x) for x in p.normal],
    }

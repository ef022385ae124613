"""Fatigue and histories of stress, as tables and as JSON."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import Any

from assess.fatigue.records import PointFatigue
from reports.data.results import Fatigue, Results
from reports.format.files.csv import Cell
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, finite
from reports.tables.table import Table

LIFE_PROBABILITIES = ("10 %", "50 %", "90 %")
METHOD_NAMES = {
    "signed-von-mises": "signed von Mises stress",
    "critical-plane": "Findley's critical plane",
    "fkm-p-ram": "P_RAM of the FKM guideline for local strains",
}
HISTORY_COLUMNS = ("pin", "case", "time", "point", "von_mises", "signed")
POINT_COLUMNS = ("pin", "point", "x", "y", "z", "chosen")
COLUMNS = (
    *("pin", "point", "x", "y", "z", "method", "damage", "life", "life_10", "life_50", "life_90"),
    *("utilisation", "amplitude", "mean_stress", "note", "normal_x", "normal_y", "normal_z"),
    "not_decided",
)


def fatigue_tables(results: Results) -> list[Table]:
    """Histories, their points, and damage."""
    return [
        Table.of("stress_history", HISTORY_COLUMNS, _history(results)),
        Table.of("critical_points", POINT_COLUMNS, _points(results)),
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
    if fatigue is None:
        return
    for p in fatigue.points:
        lives = p.lives or (None,) * len(LIFE_PROBABILITIES)
        yield [
            *(p.pin, p.point, *p.location, p.method, p.damage, p.life, *lives),
            *(p.utilisation, p.amplitude, p.mean, p.note),
            *(p.normal or (None,) * 3),
            fatigue.not_decided.get(p.pin, ""),
        ]
    shown = {p.pin for p in fatigue.points}
    for pin, reason in fatigue.not_decided.items():
        if pin not in shown:
            yield [pin, *(None,) * (len(COLUMNS) - 2), reason]


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
    worst = worst_points(fatigue)
    scattered = any(p.lives for p in fatigue.points)
    instead = any(p.method != fatigue.method for p in worst)
    head += [f"at {p}" for p in LIFE_PROBABILITIES] if scattered else []
    head += ["utilisation"] if fatigue.life is not None else []
    head += [f"amplitude [{stress}]", f"mean [{stress}]"]
    head += ["method"] if instead else []
    head += ["normal of the plane"] if any(p.normal for p in worst) else []
    body = []
    for p in worst:
        least, most = ("≥ ", "≤ ") if p.pin in fatigue.not_decided else ("", "")
        lives = [most + life_words(x) for x in p.lives] or [DASH] * len(LIFE_PROBABILITIES)
        damage = least + _or_infinite(p.damage) if p.damage or least else "none"
        body.append(
            [
                *(p.pin, str(p.point), engineering(p.location[2], 3)),
                *(damage, DASH if most and p.life is None else most + life_words(p.life)),
                *(lives if scattered else []),
                *([least + _per_cent(p.utilisation)] if fatigue.life is not None else []),
                *(engineering(p.amplitude, 3), engineering(p.mean, 3)),
                *([p.method] if instead else []),
                *([", ".join(f"{x:.2f}" for x in p.normal) if p.normal else DASH]
                  if head[-1] == "normal of the plane" else []),
            ]
        )  # fmt: skip
    return Grid(head, body, [False, *[True] * (len(head) - 1)])


def life_words(life: float | None) -> str:
    """Units until damage 1."""
    return "no limit" if life is None else engineering(life, 3)


def _per_cent(part: float | None) -> str:
    return DASH if part is None else f"{_or_infinite(100.0 * part)} %"


def _or_infinite(value: float) -> str:
    return "∞" if value == inf else engineering(value, 3)


def fatigue_sentence(fatigue: Fatigue) -> str:
    """The worst point in a line, with the pins that are not decided and those that another method
    than the asked one was taken for.
    """
    known = [p for p in fatigue.points if p.pin not in fatigue.not_decided]
    sentences = [_worst(known[0], fatigue)] if known else []
    sentences += [
        f"Fatigue of pin {pin} is not decided: {reason}{_so_far(pin, fatigue)}."
        for pin, reason in fatigue.not_decided.items()
    ]
    sentences += [
        f"Pin {p.pin}, point {p.point}: {p.note.partition('; ')[2]}."
        for p in worst_points(fatigue)
        if p.method != fatigue.method
    ]
    return " ".join(sentences) or "Fatigue is not assessed."


def _worst(worst: PointFatigue, fatigue: Fatigue) -> str:
    unit, method = fatigue.unit, METHOD_NAMES[worst.method]
    if not worst.damage:
        return f"Fatigue: no damage at any critical point{_elsewhere(fatigue)} ({method})."
    text = f"Fatigue: pin {worst.pin} reaches damage 1 after {life_words(worst.life)} {unit}s"
    if worst.lives:
        few, many = life_words(worst.lives[0]), life_words(worst.lives[2])
        text += f" ({few} at 10 %, {many} at 90 % failure probability)"
    if worst.utilisation is not None:
        text += f"; the design life uses {_per_cent(worst.utilisation)} of it"
    return f"{text} ({method})."


def _elsewhere(fatigue: Fatigue) -> str:
    return " of the other pins" if fatigue.not_decided else ""


def _so_far(pin: str, fatigue: Fatigue) -> str:
    """What the damage is at least."""
    worst = next((p for p in fatigue.points if p.pin == pin and p.damage), None)
    if worst is None:
        return ""
    if worst.utilisation is None:
        return f"; damage is at least {_or_infinite(worst.damage)} per {fatigue.unit}"
    return f"; the design life uses at least {_per_cent(worst.utilisation)}"


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
        "not_decided": dict(fatigue.not_decided),
    }


def _point(p: PointFatigue) -> dict[str, Any]:
    lives = {name: finite(x) for name, x in zip(("10", "50", "90"), p.lives, strict=False)}
    return {
        "pin": p.pin,
        "point": p.point,
        "location": [finite(x) for x in p.location],
        "cases": list(p.cases),
        "method": p.method,
        "damage": finite(p.damage),
        "life": finite(p.life),
        "life_at_probability": lives,
        "utilisation": finite(p.utilisation),
        "amplitude": finite(p.amplitude),
        "mean": finite(p.mean),
        "note": p.note,
        "plane_normal": None if p.normal is None else [finite(x) for x in p.normal],
    }

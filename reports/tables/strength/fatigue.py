"""Fatigue and histories of stress, as tables and as JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import inf
from typing import Any

from assess.fatigue.records import ERROR_OF_STRESS, CaseHistory, PointFatigue, PointHistory
from reports.data.results import Fatigue, Results
from reports.format.numbers import DASH, engineering
from reports.format.ranges import used_text
from reports.tables.column import ArrayTable, Column, Table, fields, json_of, read_only, texts

LIFE_PROBABILITIES = ("10 %", "50 %", "90 %")
METHOD_NAMES = {
    "signed-von-mises": "signed von Mises stress",
    "critical-plane": "Findley's critical plane",
    "fkm-p-ram": "P_RAM of the FKM guideline for local strains",
}

OPEN_WORDS = {
    ERROR_OF_STRESS: "the numerical error of its stress",
    "joint": "the range of its joint",
    "landing": "the range of the landing",
    "links": "the stiffness of the links",
}


@dataclass(frozen=True)
class FatigueRow:
    """A point of a pin; None where the fatigue of the pin is not known."""

    pin: str
    point: PointFatigue | None
    fatigue: Fatigue


HISTORY_COLUMNS: list[Column[tuple[PointHistory, CaseHistory]]] = [
    *fields("0.pin 1.case"),
    *fields("time=1.times", "time"),
    *fields("0.point"),
    *fields("1.von_mises 1.signed", "stress"),
]
POINT_COLUMNS: list[Column[PointHistory]] = [
    *fields("pin point"),
    *fields("x=location.0 y=location.1 z=location.2", "length"),
    *fields("chosen"),
]


COLUMNS: list[Column[FatigueRow]] = [
    *fields("pin"),
    *fields("point?.point"),
    *fields("x=point?.location?.0 y=point?.location?.1 z=point?.location?.2", "length"),
    *fields("point?.method point?.damage point?.life"),
    *fields("life_10=point?.lives?.0 life_50=point?.lives?.1 life_90=point?.lives?.2"),
    *fields("point?.utilisation point?.largest_damage"),
    *fields("point?.amplitude mean_stress=point?.mean", "stress"),
    *fields("point?.note"),
    *fields("normal_x=point?.normal?.0 normal_y=point?.normal?.1 normal_z=point?.normal?.2"),
    Column("not_decided", lambda row: row.fatigue.not_decided.get(row.pin, "")),
]


def fatigue_tables(results: Results) -> list[Table[Any]]:
    """Return the tables of histories, their points, and damage."""
    histories = [(h, case) for h in results.histories for case in h.cases]
    return [
        ArrayTable("stress_history", HISTORY_COLUMNS, histories),
        Table("critical_points", POINT_COLUMNS, results.histories),
        Table("fatigue", COLUMNS, _rows(results.fatigue)),
    ]


def _rows(fatigue: Fatigue | None) -> list[FatigueRow]:
    if fatigue is None:
        return []
    assessed = {p.pin for p in fatigue.points}
    rows = [FatigueRow(p.pin, p, fatigue) for p in fatigue.points]
    return rows + [FatigueRow(x, None, fatigue) for x in fatigue.not_decided if x not in assessed]


def worst_points(fatigue: Fatigue) -> list[PointFatigue]:
    """Return the most damaged point of each pin, the worst pin first."""
    return list({p.pin: p for p in reversed(fatigue.points)}.values())[::-1]


def shown_fatigue(results: Results) -> Table[PointFatigue] | None:
    """Return the worst point of each pin; None where nothing was assessed."""
    fatigue = results.fatigue
    if fatigue is None or not fatigue.points:
        return None
    unit, open_pins, worst = fatigue.unit, fatigue.not_decided, worst_points(fatigue)

    def least(p: PointFatigue) -> str:
        return "≥ " if p.pin in open_pins else ""

    def damage(p: PointFatigue) -> str:
        return least(p) + _or_infinite(p.damage) if p.damage or least(p) else "none"

    def life(p: PointFatigue) -> str:
        if p.pin not in open_pins:
            return life_words(p.life)
        return DASH if p.life is None else f"≤ {life_words(p.life)}"

    def life_at(k: int) -> Callable[[PointFatigue], str]:
        most = dict.fromkeys(open_pins, "≤ ")
        return lambda p: most.get(p.pin, "") + life_words(p.lives[k]) if p.lives else DASH

    scattered = any(p.lives for p in fatigue.points)
    columns = [
        *texts("Pin=pin"),
        read_only("point", lambda p: str(p.point)),
        read_only("z", lambda p: engineering(p.location[2], 3), "length"),
        read_only(f"damage per {unit}", damage),
        read_only(f"life [{unit}s]", life),
        *[read_only(f"at {at}", life_at(k)) for k, at in enumerate(LIFE_PROBABILITIES)] * scattered,
        *[read_only("utilisation", lambda p: least(p) + _per_cent(p.utilisation))]
        * (fatigue.life is not None),
        read_only(f"largest damage per {unit}", _largest_damage, drop_if_empty=True),
        read_only("amplitude", lambda p: engineering(p.amplitude, 3), "stress"),
        read_only("mean", lambda p: engineering(p.mean, 3), "stress"),
        *[read_only("method", lambda p: p.method)] * any(p.method != fatigue.method for p in worst),
        read_only("normal of the plane", _normal, drop_if_empty=True),
    ]
    return Table("fatigue", columns, worst)


def _normal(p: PointFatigue) -> str:
    return ", ".join(f"{x:.2f}" for x in p.normal) if p.normal else DASH


def _largest_damage(p: PointFatigue) -> str:
    if p.largest_damage is None:
        return DASH
    return _or_infinite(p.largest_damage) if p.largest_damage else "none"


def life_words(life: float | None) -> str:
    """Return the number of units until damage 1, as text."""
    return "no limit" if life is None else engineering(life, 3)


def _per_cent(part: float | None) -> str:
    if part is None:
        return DASH
    return "∞ %" if part == inf else used_text(part)


def _or_infinite(value: float) -> str:
    return "∞" if value == inf else engineering(value, 3)


def fatigue_sentence(fatigue: Fatigue) -> str:
    """Return a sentence on the worst point.

    Further sentences name the pins that are not decided, and the pins that were assessed by another
    method than the requested one.
    """
    known = [p for p in fatigue.points if p.pin not in fatigue.not_decided]
    sentences = [_worst(known[0], fatigue)] if known else []
    sentences += [
        f"Fatigue of pin {pin} is not decided: {reason}{_so_far(pin, fatigue)}."
        for pin, reason in fatigue.not_decided.items()
    ]
    sentences += _not_everywhere(fatigue)
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


def _not_everywhere(fatigue: Fatigue) -> Iterator[str]:
    """Yield a sentence on each point that reaches the design life as described, but not over all
    that is open in its stress.
    """
    for p in fatigue.points if fatigue.life else ():
        assert fatigue.life
        if open_ := p.open_beyond(1.0 / fatigue.life):
            over, life = " and ".join(OPEN_WORDS[x] for x in open_), 1.0 / (p.largest_damage or inf)
            text = f"Pin {p.pin}, point {p.point}, may reach damage 1 after {life_words(life)}"
            yield f"{text} {fatigue.unit}s, by {over}."


def _elsewhere(fatigue: Fatigue) -> str:
    return " of the other pins" if fatigue.not_decided else ""


def _so_far(pin: str, fatigue: Fatigue) -> str:
    """Return the lower bound of the damage as text."""
    worst = next((p for p in fatigue.points if p.pin == pin and p.damage), None)
    if worst is None:
        return ""
    if worst.utilisation is None:
        return f"; damage is at least {_or_infinite(worst.damage)} per {fatigue.unit}"
    return f"; the design life uses at least {_per_cent(worst.utilisation)}"


# Keys of results.json.
FATIGUE = fields(
    "unit occurrences method failure_probability=probability design_life=life left_out not_decided"
)
POINT: list[Column[PointFatigue]] = [
    *fields("pin point location cases method damage life utilisation amplitude mean note"),
    *fields("largest_damage damage_over plane_normal=normal"),
    Column("life_at_probability", lambda p: dict(zip(("10", "50", "90"), p.lives, strict=False))),
]


def fatigue_json(fatigue: Fatigue | None) -> dict[str, Any] | None:
    """Return the fatigue for results.json."""
    if fatigue is None:
        return None
    return {**json_of(FATIGUE, fatigue), "points": [json_of(POINT, p) for p in fatigue.points]}

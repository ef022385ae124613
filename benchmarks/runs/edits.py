"""Edits of studies drawn at random, each solved by an engine at once, and some of them also by a
run.

An edit changes one number of a study that the engine has fully solved, on top of up to two earlier
changes. It then requests the rows of the pin that it changes, or of any pin.
"""

from __future__ import annotations

import math
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import pinstress
from benchmarks import ROOT
from benchmarks.processes import process
from benchmarks.timing import table
from pinbase.records import pack, plain, unpack
from pinstress import Engine, InputError, Study
from pinstress.study.reading.file import raw_study
from reports.data.row import PinResult

COUNT, RUN_ANEW, SEED = 1_000, 50, 7
MAX_CHANGES = 3  # at once
STUDIES = {  # with the cases to solve; empty for all
    "landing_gear": (),
    "clevis": (),
    "lifting_arm": (),
    "one_pin": (),
    "excavator": ("breakout",),
}
OTHER = "another"  # a material added to those of the study
FULL_DIFFERENCE = 1e-9  # allowed relative difference between an engine and a run
TIMELESS = {"seconds"}  # keys of values that differ from run to run
ANEW = """
import sys
from pathlib import Path
from benchmarks.runs.edits import run_anew
sys.stdout.buffer.write(run_anew(sys.argv[1], sys.argv[2], sys.argv[3:]).hex().encode())
"""

Draw = Callable[[np.random.Generator], "Change"]


@dataclass(frozen=True)
class Change:
    """Another value of a key of a study. pin: the pin whose rows are requested."""

    key: str
    value: Any
    pin: str


@dataclass
class Edited:
    """A study that is edited.

    draws: by kind of edit, functions that draw one.
    changes: the current changes.
    """

    name: str
    study: Study
    engine: Engine
    draws: Mapping[str, list[Draw]]
    changes: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Asked:
    """An edit and its quick answer.

    seconds: processor time.
    refused: the reason why the study cannot be built with this edit; rows are then empty.
    """

    kind: str
    edited: Edited
    changes: dict[str, Any]
    pin: str
    seconds: float
    rows: Mapping[tuple[str, str], PinResult] = field(default_factory=dict)
    refused: str = ""


@dataclass(frozen=True)
class Compared:
    """An edit compared with a run of the same study.

    edit: the row and the changes, as text.
    full: the largest relative difference of any number of the full answer.
    off, error: difference and estimated error of the quick maximum, relative to that of the run.
    """

    kind: str
    edit: str
    full: float
    off: float
    error: float


def edits(count: int = COUNT, names: Iterable[str] = STUDIES) -> str:
    """Return the tables of `count` edits of some studies."""
    rng = np.random.default_rng(SEED)
    studies = [_edited(name) for name in names]
    asked = [_ask(studies[k % len(studies)], rng) for k in range(count)]
    answered = [x for x in asked if x.rows]
    anew = min(RUN_ANEW, len(answered))
    some = [answered[k] for k in np.linspace(0, len(answered) - 1, anew).round().astype(int)]
    compared = [one for x in some for one in _compare(x)]
    return "\n\n".join((_times(asked), _accuracy(compared), _failures(compared)))


def _edited(name: str) -> Edited:
    """Return a study with an additional material, with its engine warm."""
    given = pinstress.load_study(ROOT / "studies" / f"{name}.toml")
    raw = raw_study(given)
    first = dict(next(iter(raw["material"].values())))
    first |= {"youngs_modulus": "110 GPa", "poisson_ratio": 0.32, "yield_strength": "830 MPa"}
    study = pinstress.changed_study(given, {f"material.{OTHER}": first})
    engine = Engine(study, cases=STUDIES[name] or None)
    engine.rows({})
    engine.rows({}, accuracy="quick")
    return Edited(name, study, engine, _draws(study))


def _draws(study: Study) -> dict[str, list[Draw]]:
    """Return the functions that draw edits, by kind."""
    raw, pins = raw_study(study), tuple(study.table.pin)
    out: dict[str, list[Draw]] = {}

    def add(kind: str, key: str, value: Callable[[float], Any], low: float, high: float,
            pin: str = "") -> None:  # fmt: skip
        def draw(rng: np.random.Generator) -> Change:
            factor = low * (high / low) ** rng.random()
            return Change(key, value(factor), pin or str(rng.choice(pins)))

        out.setdefault(kind, []).append(draw)

    for kind, key, value in _loads(raw):
        add(kind, key, partial(_scaled, value), 0.1, 1.6)
        if kind == "load":
            add("small load", key, partial(_scaled, value), 0.01, 0.1)
    for name, made_of in study.table.material.items():
        strength = (made_of.yield_strength or 5e8) / 1e6
        key = f'material."{name}".yield_strength'
        add("strength", key, _times_unit(strength, "MPa"), 0.7, 1.4)
        key = f'material."{name}".range'
        add("range of strength", key, partial(_strengths, strength), 0.7, 1.0)
    for pin, shape in study.table.pin.items():
        add("material", f"pin.{pin}.material", lambda _: OTHER, 1.0, 1.0, pin)
        segments = shape.profile or []
        for k, segment in enumerate(segments, 1):
            if segment.connection and isinstance(segment.diameter, float):
                key = f"pin.{pin}.profile[{k}].diameter"
                add("diameter", key, _times_unit(1e3 * segment.diameter, "mm"), 0.93, 1.2, pin)
            key = f"pin.{pin}.profile[{k}].length"
            add("length", key, _times_unit(1e3 * segment.length, "mm"), 0.93, 1.2, pin)
        for lug in shape.lug:
            size = 2e3 * segments[0].length
            key = f'pin.{pin}.lug."{lug}".clearance'
            add("clearance", key, _times_unit(0.002 * size, "mm"), 0.1, 2.0, pin)
            add("gap", key, _times_unit(0.002 * size, "mm"), 2.0, 10.0, pin)
    return out


def _times_unit(value: float, unit: str) -> Callable[[float], str]:
    return lambda factor: f"{value * factor!r} {unit}"


def _strengths(strength: float, factor: float) -> dict[str, list[str]]:
    """Return a range about a strength, MPa, whose lower end is the strength times a factor."""
    return {"yield_strength": [f"{strength * x!r} MPa" for x in (factor, 2.0 - factor)]}


def _scaled(value: Any, factor: float) -> Any:
    """Return a number, a text with a unit, or a list or table of these, times a factor."""
    if isinstance(value, Mapping):
        return {k: _scaled(v, factor) for k, v in value.items()}
    if isinstance(value, list):
        return [_scaled(v, factor) for v in value]
    if isinstance(value, str):
        number, _, unit = value.partition(" ")
        return f"{float(number) * factor!r} {unit}"
    return value * factor


def _loads(raw: Mapping[str, Any]) -> Iterator[tuple[str, str, Any]]:
    """Yield kind, key and value of the loads in a study's cases."""
    for name, case in raw["case"].items():
        if "forces" in case:
            yield "load", f"case.{name}.forces", case["forces"]
        for k, apply in enumerate(case.get("apply", ()), 1):
            at = f"case.{name}.apply[{k}]"
            if "force" in apply:
                yield "load", f"{at}.force", apply["force"]
            if "impulse" in apply:
                of = apply["impulse"]
                yield "load", f"{at}.impulse.velocity_change", of["velocity_change"]
                yield "impulse time", f"{at}.impulse.impulse_time", of["impulse_time"]


def _ask(edited: Edited, rng: np.random.Generator) -> Asked:
    """Draw an edit and request its quick rows."""
    kinds = list(edited.draws)
    kind = kinds[int(rng.integers(len(kinds)))]
    draws = edited.draws[kind]
    change = draws[int(rng.integers(len(draws)))](rng)
    edited.changes.pop(change.key, None)
    edited.changes[change.key] = change.value
    if len(edited.changes) > MAX_CHANGES:
        edited.changes.pop(next(iter(edited.changes)))
    changes, start = dict(edited.changes), time.process_time()
    try:
        rows = edited.engine.rows(changes, [change.pin], accuracy="quick")
    except InputError as error:
        edited.changes.pop(change.key)
        spent = time.process_time() - start
        return Asked(kind, edited, changes, change.pin, spent, refused=str(error))
    return Asked(kind, edited, changes, change.pin, time.process_time() - start, rows)


def run_anew(path: str, pin: str, cases: list[str]) -> bytes:
    """Return the packed rows of a pin of a study, as a run in this process finds them."""
    found = pinstress.run(pinstress.load_study(Path(path)), pins=[pin], cases=cases or None)
    return pack(found.pins)


def _compare(asked: Asked) -> Iterator[Compared]:
    """Yield the comparison of each row of an edit with a run in a process of its own."""
    edited = asked.edited
    study = pinstress.changed_study(edited.study, asked.changes)
    full = edited.engine.rows(asked.changes, [asked.pin])
    folder = ROOT / "studies"  # where the files that the study names are found
    with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=folder, encoding="utf-8") as file:
        file.write(study.text)
        file.flush()
        arguments = [sys.executable, "-c", ANEW, file.name, asked.pin, *STUDIES[edited.name]]
        anew = process(arguments, ROOT).output
    for row in unpack(tuple[PinResult, ...], bytes.fromhex(anew)):
        quick = asked.rows[row.pin, row.case]
        value = row.max_von_mises or math.nan
        apart = _difference(plain(full[row.pin, row.case]), plain(row))
        off = abs((quick.max_von_mises or math.nan) / value - 1.0)
        error = (quick.error_estimate or math.nan) / value
        edit = f"pin {row.pin}, {row.case} of `{edited.name}` with {asked.changes}"
        yield Compared(asked.kind, edit, apart, off, error)


def _difference(one: Any, other: Any) -> float:
    """Return the largest relative difference of two numbers at the same place; inf for other
    content.
    """
    if isinstance(one, Mapping) and isinstance(other, Mapping) and one.keys() == other.keys():
        keys = one.keys() - TIMELESS
        return max((_difference(one[k], other[k]) for k in keys), default=0.0)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple) and len(one) == len(other):
        return max((_difference(*both) for both in zip(one, other, strict=True)), default=0.0)
    if isinstance(one, float) and isinstance(other, float):
        return 0.0 if one == other else abs(one - other) / max(abs(one), abs(other))
    return 0.0 if one == other else math.inf


def _times(asked: list[Asked]) -> str:
    """Return the table of medians and 95th percentiles by kind of edit, ms of processor time."""
    rows = []
    for kind in sorted({x.kind for x in asked}):
        spent = 1e3 * np.array([x.seconds for x in asked if x.kind == kind and x.rows])
        refused = sum(x.kind == kind and bool(x.refused) for x in asked)
        if len(spent):
            median, most = np.percentile(spent, (50, 95))
            rows.append((kind, len(spent), refused, f"{median:.0f}", f"{most:.0f}"))
    names = ", ".join(f"`{name}`" for name in dict.fromkeys(x.edited.name for x in asked))
    return (
        f"{len(asked):,} edits of {names} drawn at random, up to {MAX_CHANGES} changes at a time. "
        "Processor time of the quick rows of one pin:\n\n"
        + table(("edit of a", "answers", "refused", "median, ms", "95 %, ms"), rows)
    )


def _accuracy(compared: list[Compared]) -> str:
    """Return the table of the differences from runs, by kind of edit."""
    rows = []
    for kind in sorted({x.kind for x in compared}):
        some = [x for x in compared if x.kind == kind]
        off, error = (np.array([getattr(x, n) for x in some]) for n in ("off", "error"))
        within = sum(x.off <= x.error for x in some)
        rows.append(
            (kind, len(some), f"{max(x.full for x in some):.1e}", f"{np.median(off):.2%}",
             f"{off.max():.1%}", f"{np.median(error):.1%}", f"{within} of {len(some)}")
        )  # fmt: skip
    head = (
        "edit of a",
        "rows",
        "full: most",
        "quick: median",
        "most",
        "its error, median",
        "within",
    )
    return (
        "Rows compared with runs of the changed study, each in a process of its own:\n\n"
        + table(head, rows)
    )


def _failures(compared: list[Compared]) -> str:
    """Return a sentence on rows beyond the allowed differences, and a line for each such row."""
    full = [x for x in compared if not x.full <= FULL_DIFFERENCE]
    quick = [x for x in compared if not x.off <= x.error]
    lines = [f"- {x.edit}: full, {x.full:.1e}" for x in full]
    lines += [f"- {x.edit}: quick, off by {x.off:.2%}, stated {x.error:.2%}" for x in quick]
    sentence = (
        f"{len(full)} of {len(compared)} full rows differ by more than {FULL_DIFFERENCE:g} from a "
        f"run, and {len(quick)} quick rows by more than their stated error."
    )
    return "\n\n".join((sentence, "\n".join(lines))) if lines else sentence

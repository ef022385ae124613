"""Pins of least weight on the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from assess.judgement import DEPENDS, NOT_DECIDED, SAFE
from reports.format.numbers import DASH, engineering, short
from reports.tables.column import Column, Table, read_only, texts
from reports.text.fitted_table import fitted_table
from reports.text.safety_factors import OUTCOME_COLOURS
from reports.text.sizes import heavy, reached

if TYPE_CHECKING:
    from rich.console import Console

RESIDUAL_ROUND_OFF = 1e-6  # smaller residuals are round-off


@dataclass(frozen=True)
class ChangedDimension:
    """A changed dimension: its key in the study, its value before and after."""

    key: str
    before: float
    after: float


@dataclass(frozen=True)
class LightRow:
    """The result of a pin of least weight.

    factor: as text, in the run of the new study. factor_before: in the given study.
    governs: the governing case.
    weights: before, of the pin that is only scaled, and now; None where they are not known.
    residual: of the optimality conditions.
    dimensions: those that changed.
    binding: active constraints with their multipliers.
    at: the factor at a probability, if requested.
    bands: those that changed.
    solved: number of designs.
    why: the reason why the factor is not shown to be reached.
    way: a note on a search that was not run or did not end.
    outcome: the outcome of the new study with such a reason (assess.judgement).
    """

    pin: str
    factor: str
    factor_before: float | None
    governs: str
    weights: tuple[float | None, float | None, float | None]
    residual: float | None
    dimensions: tuple[ChangedDimension, ...]
    binding: tuple[tuple[str, float], ...]
    at: float | None
    bands: tuple[str, ...]
    solved: int
    why: str = ""
    way: str = ""
    outcome: str = NOT_DECIDED

    @property
    def result(self) -> str:
        """The outcome in words."""
        return self.outcome if self.why else SAFE

    @property
    def saved(self) -> float | None:
        """The saved fraction of the weight, relative to the pin that is only scaled."""
        _, scaled, now = self.weights
        return None if scaled is None or now is None else 1.0 - now / scaled


def print_light(
    rows: Sequence[LightRow], required: float | None, units: tuple[str, str, bool], console: Console
) -> None:
    """Print a row for each pin, the totals, and the changes.

    required: None where it is not the same for all pins.
    units: the unit of length, that of weight or volume, and whether weights are compared.
    """
    from rich.text import Text

    length, unit, heavy = units
    what = "weight" if heavy else "volume"
    tints = {"Result": [OUTCOME_COLOURS.get(row.result, "yellow") for row in rows]}
    table = light_table(rows, f"{what} [{unit}]")
    console.print(fitted_table(table, None, console.width, tints))
    for line in (*_total(rows, required, what, unit), *_details(rows, length)):
        console.print(Text(line))


def light_table(rows: Sequence[LightRow], weight: str) -> Table[LightRow]:
    """Return the table with a row for each pin.

    weight: the heading of the weight, with the unit.
    """
    columns: list[Column[LightRow]] = [
        *texts("Pin=pin Result=result"),
        read_only("factor", lambda row: row.factor),
        read_only("factor at p", lambda row: row.at, drop_if_empty=True),
        read_only(weight, lambda row: heavy(row.weights[0]), rank=1),
        read_only("scaled", lambda row: heavy(row.weights[1])),
        read_only("least", lambda row: heavy(row.weights[2])),
        read_only("saved", lambda row: _saved(row.saved)),
        read_only("residual", lambda row: _residual(row.residual)),
        read_only("governs", lambda row: row.governs, rank=2, numeric=False),
        read_only("factor before", lambda row: row.factor_before, rank=3),
        read_only("designs", lambda row: str(row.solved), rank=4),
    ]
    return Table("least_weight", columns, rows)


def _saved(part: float | None) -> str:
    return DASH if part is None else f"{round(part, 3) + 0.0:.1%}"


def _residual(residual: float | None) -> str:
    if residual is None:
        return DASH
    return f"<{RESIDUAL_ROUND_OFF:g}" if residual < RESIDUAL_ROUND_OFF else f"{residual:.1g}"


def _total(rows: Sequence[LightRow], required: float | None, what: str, unit: str) -> Iterator[str]:
    whys, depending = [row.why for row in rows], sum(row.result == DEPENDS for row in rows)
    text = reached(whys, depending, required, "in a run of the new study")
    yield f"{text}, with the error of its stress."
    known = [row for row in rows if row.saved is not None]
    if len(known) > 1:
        was, scaled, now = (sum(row.weights[k] or 0.0 for row in known) for k in range(3))
        yield (
            f"Together: {what} {engineering(was, 3)} {unit}; with the factor, only scaled "
            f"{engineering(scaled, 3)}, least {engineering(now, 3)}, {_saved(1.0 - now / scaled)} "
            "less."
        )
    yield (
        "residual: part of the weight's gradient that active constraints do not balance; 0 at an "
        "optimum."
    )


def _details(rows: Sequence[LightRow], length: str) -> Iterator[str]:
    for row in rows:
        if row.dimensions:
            entries = (f"{d.key} {short(d.before)} → {short(d.after)}" for d in row.dimensions)
            yield f"Changed [{length}]: {', '.join(entries)}."
        if row.binding:
            entries = (f"{text} ({multiplier:.2g})" for text, multiplier in row.binding)
            yield f"  binding, with multipliers: {'; '.join(entries)}."
        if row.bands:
            yield f"  the bores of its links must follow: {', '.join(row.bands)}."
        if row.way:
            yield f"  {row.way}."

"""The sizes of pins on the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from assess.judgement import DEPENDS, NOT_DECIDED, SAFE
from reports.data.row import Units
from reports.format.numbers import DASH, engineering, short
from reports.tables.column import Column, Table, read_only, texts
from reports.text.fitted_table import fitted_table
from reports.text.safety_factors import OUTCOME_COLOURS

if TYPE_CHECKING:
    from rich.console import Console

MIN_SLENDERNESS = 1.0  # length over diameter; shorter pins are wider than long


@dataclass(frozen=True)
class SizeRow:
    """The result of sizing a pin.

    before, after: its distinct diameters; `after` is None if it was not sized.
    factor_before: the lowest factor before, roughly. factor: the lowest in the new study, as text.
    least: the lowest over all ranges of the study, as text; empty without ranges.
    governs: the governing case of the new study.
    weights: before and after; None without a density.
    slenderness: length over largest diameter under a link.
    why: the reason why the required factor is not reached, if it is not.
    limited: whether limits of the study prevent reaching it.
    outcome: the outcome of the new study with such a reason (assess.judgement).
    stricter: a hand check with a smaller factor, if any.
    """

    pin: str
    before: tuple[float, ...]
    after: tuple[float, ...] | None
    factor_before: float | None
    factor: str
    governs: str
    weights: tuple[float | None, float | None]
    slenderness: float
    why: str = ""
    stricter: str = ""
    limited: bool = False
    outcome: str = NOT_DECIDED
    least: str = ""

    @property
    def result(self) -> str:
        """The outcome in words."""
        if self.limited:
            return "not reached"
        return self.outcome if self.why else SAFE


def print_sizes(
    rows: Sequence[SizeRow],
    required: float | None,
    units: Units,
    console: Console,
    written: bool = True,
    over_ranges: bool = False,
) -> None:
    """Print a row for each pin and the number of pins that reach the factor.

    required: None where it is not the same for all pins.
    written: whether a new study was written.
    over_ranges: whether the pins were sized over all ranges of the study.
    """
    from rich.text import Text

    tints = {"Result": [OUTCOME_COLOURS.get(row.result, "yellow") for row in rows]}
    console.print(fitted_table(sizes_table(rows), units, console.width, tints))
    whys, depending = [row.why for row in rows], sum(row.result == DEPENDS for row in rows)
    outcome = reached(whys, depending, required, "in the new study" if written else "")
    unchanged = (
        " Lengths and the weights of links are unchanged; check that the links have room for the "
        "new diameters."
    )
    more = " --over-ranges finds larger pins that reach it there, too." * (not over_ranges)
    console.print(Text(f"{outcome}.{more * bool(depending)}{unchanged * written}"))
    for line in _remarks(rows):
        console.print(Text(line))


def reached(whys: Sequence[str], depending: int, required: float | None, where: str) -> str:
    """Return the number of pins that reach the factor: "2 of 3 pins reach the safety factor 2 ...".

    whys: the reason why each pin does not reach it, empty for pins that do.
    depending: the number of pins that reach it as described, but not over all ranges of the study.
    required: None where it is not the same for all pins.
    where: the run in which they reach it, in words; may be empty.
    """
    everywhere = sum(not why for why in whys)
    as_described = everywhere + depending
    ranges = "" if as_described == everywhere else f" as described, {everywhere} over its ranges"
    factor = "their required factors"
    if required is not None:
        factor = f"the safety factor {short(required)}"
    pins = "pin reaches" if len(whys) == 1 else "pins reach"
    return f"{as_described} of {len(whys)} {pins} {factor}{where and f' {where}'}{ranges}"


def _remarks(rows: Sequence[SizeRow]) -> Iterator[str]:
    """Yield objections to the sizes: pins wider than long, and hand checks with a smaller
    factor.
    """
    if wide := [row.pin for row in rows if row.after and row.slenderness < MIN_SLENDERNESS]:
        yield (
            f"Wider than long: {', '.join(wide)}. No pin is made like this: use a stronger "
            "material, smaller loads or another arrangement of the lugs."
        )
    if strict := [f"{row.pin} ({row.stricter})" for row in rows if row.after and row.stricter]:
        yield f"A hand check gives a smaller factor: {', '.join(strict)}."


def sizes_table(rows: Sequence[SizeRow]) -> Table[SizeRow]:
    """Return the table with a row for each pin."""
    columns: list[Column[SizeRow]] = [
        *texts("Pin=pin Result=result"),
        read_only("factor", lambda row: row.factor),
        read_only("over ranges", lambda row: row.least or None, rank=3, drop_if_empty=True),
        read_only("new", lambda row: _joined(row.after) or "unchanged", "length", numeric=False),
        read_only("before", lambda row: _joined(row.before), "length", rank=4, numeric=False),
        read_only("factor before", lambda row: engineering(row.factor_before, 2), rank=5),
        read_only("weight", lambda row: " → ".join(map(heavy, row.weights)), "force", rank=2),
        read_only("L/d", lambda row: engineering(row.slenderness, 2), rank=1),
        read_only("governs", lambda row: row.governs, rank=3, numeric=False),
    ]
    return Table("sizes", columns, rows)


def _joined(diameters: tuple[float, ...] | None) -> str:
    return ", ".join(map(short, diameters or ()))


def heavy(weight: float | None) -> str:
    """Return a weight as text; a dash where it is not known."""
    return DASH if weight is None else engineering(weight, 3)

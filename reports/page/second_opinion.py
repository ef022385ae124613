"""The page's part on CalculiX's second opinion on a row."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from operator import mul

from assess.opinion.opinions import BandOpinion, Opinion
from reports.data.row import Units
from reports.format.numbers import percent
from reports.tables.column import Column, Grid, Table, read_only
from reports.text.second_opinion import outcome_of, sentences

LENGTH_PARTS = (
    ("first quarter", 0.0, 0.25),
    ("middle half", 0.25, 0.75),
    ("last quarter", 0.75, 1.0),
)
BandPart = tuple[BandOpinion, tuple[str, float, float]]  # a band and one of LENGTH_PARTS


@dataclass(frozen=True)
class OpinionPart:
    """The agreement with CalculiX, sentences, and the loads per length at the ends and the middle
    of lugs.
    """

    outcome: str
    sentences: list[str]
    loads: Grid | None


def opinion_part(opinion: Opinion | None, units: Units) -> OpinionPart | None:
    """Return the part on a second opinion; None without one."""
    if opinion is None:
        return None
    grid = _loads(opinion.contact.bands, units) if opinion.contact else None
    return OpinionPart(outcome_of(opinion), sentences(opinion, units), grid)


def _loads(bands: tuple[BandOpinion, ...], units: Units) -> Grid:
    """Return the mean loads per length over the ends and the middle of each band."""

    def mean(load: str) -> Callable[[BandPart], float]:
        return lambda row: _mean(row[0].ends, getattr(row[0], load), *row[1][1:])

    columns: list[Column[BandPart]] = [
        read_only("connection", lambda row: row[0].name, numeric=False),
        read_only("part", lambda row: row[1][0], numeric=False),
        read_only("ours", mean("ours"), "force per length"),
        read_only("CalculiX", mean("theirs"), "force per length"),
        read_only("load elsewhere", lambda row: "" if row[1][1] else percent(row[0].elsewhere)),
    ]
    rows = [(band, part) for band in bands for part in LENGTH_PARTS]
    return Table("loads", columns, rows).grid(units)


def _mean(ends: Sequence[float], load: Sequence[float], low: float, high: float) -> float:
    """Return the mean of a piecewise constant load between two fractions of the length.

    ends: the boundaries of the pieces, one more than the loads.
    """
    whole = ends[-1] - ends[0]
    z0, z1 = ends[0] + low * whole, ends[0] + high * whole
    shared = (max(0.0, min(b, z1) - max(a, z0)) for a, b in pairwise(ends))
    return float(sum(map(mul, load, shared)) / (z1 - z0))

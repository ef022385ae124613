"""The page's part on CalculiX's second opinion on a row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from operator import mul

from assess.opinion.opinions import BandOpinion, Opinion
from reports.data.results import Units
from reports.format.grid import Grid
from reports.format.numbers import engineering
from reports.text.chart_summary import percent
from reports.text.second_opinion import outcome_of, sentences

LENGTH_PARTS = (
    ("first quarter", 0.0, 0.25),
    ("middle half", 0.25, 0.75),
    ("last quarter", 0.75, 1.0),
)


@dataclass(frozen=True)
class OpinionPart:
    """Whether it agrees, sentences, and the loads per length at the lugs' ends and middle."""

    outcome: str
    sentences: list[str]
    loads: Grid | None


def opinion_part(opinion: Opinion | None, units: Units) -> OpinionPart | None:
    """None where CalculiX was not asked."""
    if opinion is None:
        return None
    grid = _loads(opinion.contact.bands, units) if opinion.contact else None
    return OpinionPart(outcome_of(opinion), sentences(opinion, units), grid)


def _loads(bands: tuple[BandOpinion, ...], units: Units) -> Grid:
    """Means over the ends and the middle of each band."""
    body = []
    for band in bands:
        elsewhere = [percent(band.elsewhere), "", ""]
        for (name, low, high), part in zip(LENGTH_PARTS, elsewhere, strict=True):
            both = (_mean(band.ends, load, low, high) for load in (band.ours, band.theirs))
            body.append([band.name, name, *map(engineering, both), part])
    unit = f"[{units.force}/{units.length}]"
    head = ["connection", "part", f"ours {unit}", f"CalculiX {unit}", "load elsewhere"]
    return Grid(head, body, [False, False, True, True, True])


def _mean(ends: Sequence[float], load: Sequence[float], low: float, high: float) -> float:
    """Between two parts of the whole length, of a load that is even between ends."""
    whole = ends[-1] - ends[0]
    z0, z1 = ends[0] + low * whole, ends[0] + high * whole
    shared = (max(0.0, min(b, z1) - max(a, z0)) for a, b in pairwise(ends))
    return float(sum(map(mul, load, shared)) / (z1 - z0))

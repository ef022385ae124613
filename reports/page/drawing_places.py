"""Places of the largest stress of a pin's rows, for its drawing."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

from reports.data.decision import worst_first
from reports.data.results import Results

PLACE_TOLERANCE = 0.01  # of the pin's length; nearer places share a mark
MAX_DRAWN_PLACES = 4  # the worst; more marks would overlap
MAX_NAMED_CASES = 2  # cases of a place


@dataclass(frozen=True)
class PlaceMark:
    """The place of the largest stress of some cases.

    r: distance from the axis; None for a section.
    """

    z: float
    r: float | None
    cases: tuple[str, ...]

    @property
    def words(self) -> str:
        few = len(self.cases) <= MAX_NAMED_CASES
        return f"max ({', '.join(self.cases) if few else f'{len(self.cases)} cases'})"


def place_marks(results: Results, pin: str, length: float) -> list[PlaceMark]:
    """Return the marks of a pin, the worst cases first."""
    marks: list[PlaceMark] = []
    for row in worst_first(results):
        if row.pin != pin or row.location is None:
            continue
        x, y, z = row.location
        by_section = row.places is not None and row.places.governs == "section"
        r = None if by_section else hypot(x, y)
        for k, mark in enumerate(marks):
            near = abs(mark.z - z) <= PLACE_TOLERANCE * length and (mark.r is None) == (r is None)
            if near and abs((mark.r or 0.0) - (r or 0.0)) <= PLACE_TOLERANCE * length:
                marks[k] = PlaceMark(mark.z, mark.r, (*mark.cases, row.case))
                break
        else:
            marks.append(PlaceMark(z, r, (row.case,)))
    return marks[:MAX_DRAWN_PLACES]

"""A study before anything is solved: what it describes and what would be solved."""

from __future__ import annotations

from dataclasses import dataclass

from pinbase.dimensions import Force
from reports.data.motion import LinkageMotion
from reports.data.results import PinShape
from reports.data.row import Units
from reports.data.skeleton import Skeleton, planar_skeleton


@dataclass(frozen=True)
class CheckedPin:
    """A pin with what supports it, in words, where it has no lugs."""

    shape: PinShape
    support: str


@dataclass(frozen=True)
class PlannedRow:
    """A row that a run would have.

    instants: of the case. largest: force of a link on the pin, None where only a run finds it, as
    after a drop. at: its connection.
    """

    pin: str
    case: str
    support: str
    model: str
    instants: int
    largest: Force | None
    at: str


@dataclass(frozen=True)
class CheckedStudy:
    """A valid study.

    summary: sentences on the study, its mechanism and its cases. problems: what a run would not
    solve, and what may be wrong.
    motions, space: of the linkage, by case, in the plane and in space.
    by_run: cases whose forces only a run finds.
    """

    title: str
    study: str
    units: Units
    summary: tuple[str, ...]
    problems: tuple[str, ...]
    motions: tuple[LinkageMotion, ...]
    pins: tuple[CheckedPin, ...]
    rows: tuple[PlannedRow, ...]
    space: tuple[Skeleton, ...] = ()
    by_run: frozenset[str] = frozenset()

    @property
    def skeletons(self) -> tuple[Skeleton, ...]:
        """The parts of every motion that are drawn."""
        return (*map(planar_skeleton, self.motions), *self.space)

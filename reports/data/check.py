"""A study before anything is solved: what the study describes and what a run would solve."""

from __future__ import annotations

from dataclasses import dataclass

from pinbase.dimensions import Force
from reports.data.motion import LinkageMotion
from reports.data.results import PinShape
from reports.data.row import Units
from reports.data.skeleton import Skeleton, planar_skeleton


@dataclass(frozen=True)
class CheckedPin:
    """A pin and its support. support: in words, for a pin without lugs."""

    shape: PinShape
    support: str


@dataclass(frozen=True)
class PlannedRow:
    """A row of results that a run would produce.

    instants: the number of instants of the case.
    largest: the largest force of a link on the pin; None where only a run finds it, as after a
    drop.
    at: the connection of this force.
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

    summary: sentences on the study, its mechanism and its cases.
    problems: what a run would not solve, and possible mistakes.
    motions, space: the motions of the linkage by case, in the plane and in space.
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
        """The parts to draw of every motion."""
        return (*map(planar_skeleton, self.motions), *self.space)

"""The interface of supports: the loads of a pin's links, as loads on its surface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from fea.core.material import Material
from fea.core.over_time import Between
from fea.core.peak import Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.solution import StressField
from fea.core.verdict import Evidence
from fea.support.cell_pressure import CellPressure
from fea.support.lugs.lug import Lug
from fea.support.records import JointResult
from geometry import Pin, PinLike, body_of_revolution
from pinbase.memo import Memo

Progress = Callable[[str], None]


def silent(_: str) -> None:
    """Report no progress."""


@dataclass(frozen=True)
class PinProblem:
    """A pin to be solved under the loads of its links.

    lugs: those that hold it in contact; without any it has clamps (surfaces by the pin's names) and
    prescribed loads.
    cases: loads of the links.
    between: for the cases that are motions, the loads at any times; in others only the given
    instants count.
    also: by case, other loads under which its stress will be requested.
    memo: of flexibilities, meshes and unit fields, shared with other problems.
    """

    pin: PinLike
    material: Material
    lugs: tuple[Lug, ...]
    cases: tuple[PinLoads, ...]
    between: Mapping[str, Between] = field(default_factory=dict)
    also: Mapping[str, PinLoads] = field(default_factory=dict)
    clamps: tuple[str, ...] = ()
    memo: Memo | None = None


class HeldPin(Protocol):
    """A pin held in one way, ready for any loads of its links. It lives in one process."""

    @property
    def pin(self) -> PinLike:
        """The pin that is meshed: bands are cut into rings where pressure varies along them."""
        ...

    @property
    def clamps(self) -> tuple[str, ...]:
        """Constrained surfaces, by the pin's names."""
        ...

    @property
    def failures(self) -> Mapping[str, Maximum]:
        """The cases that cannot be held, with the verdict "rigid" or "failed" and its reason."""
        ...

    @property
    def notes(self) -> Mapping[str, Reason]:
        """The notes on the support, by case, that belong to the maximum."""
        ...

    @property
    def finest(self) -> bool:
        """Whether no finer resolution may follow."""
        ...

    def start(self, case: str) -> PinLoads:
        """The loads on the pin at the instants from which the solution of a case starts."""
        ...

    def press(self, links: PinLoads) -> PinLoads:
        """The loads on the pin under loads of its links.

        Raises: SolveError.
        """
        ...

    def resolved(self, case: str, requirement: Requirement) -> bool:
        """Return whether a finer resolution could not change the answer, before stress is
        refined.
        """
        ...

    def of_meshes(self, requirement: Requirement) -> Requirement:
        """The requirement on the meshes, given the support's own error."""
        ...

    def finished(self, reading: StressReading, requirement: Requirement) -> Solution:
        """The solution of a case, judged once, with the results of the support.

        These are its part of the error, sections, contact, and the range over the uncertain
        properties of the joint. All of them follow from the loads at one instant, which are found
        once.
        """
        ...


class Support(Protocol):
    """An interface that turns the loads of a pin's links into loads on its surface."""

    def hold(
        self,
        problem: PinProblem,
        requirement: Requirement,
        coarser: HeldPin | None = None,
        progress: Progress = silent,
    ) -> HeldPin:
        """Hold the pin.

        coarser: the same pin on the resolution before, whose candidates for the governing instant
        are kept.

        Raises: ArgumentError for lugs that do not fit; MeshError, SolveError where no case can be
        held.
        """
        ...


@dataclass(frozen=True)
class StressReading:
    """The answer of a model to a case: evidence that has not been judged yet.

    answer: the stress on the last mesh.
    loads: on the pin, with the instants added to find the maximum.
    instant: index of the governing one.
    coarser: the stress on the mesh before the last, None where only one was solved.
    mesh_ratio: element size of that mesh over that of the last.
    """

    evidence: Evidence
    answer: StressField
    loads: PinLoads
    instant: int
    coarser: StressField | None = None
    mesh_ratio: float = 2.0


@dataclass(frozen=True)
class Solution:
    """A case: its maximum and the stress behind it, None for a pin that cannot be solved.

    loads: on the pin, with the instants added to find the maximum.
    instant: index of the governing one.
    held: the held pin.
    joint, pressure: the results of contact at the governing instant.
    """

    peak: Maximum
    answer: StressField | None
    loads: PinLoads
    instant: int = 0
    held: HeldPin | None = None
    joint: JointResult | None = None
    pressure: CellPressure | None = None

    def pressed(self, links: PinLoads) -> PinLoads:
        """The loads on the pin under other loads of its links."""
        return links if self.held is None else self.held.press(links)

    @property
    def rings(self) -> Pin | None:
        """The body of revolution on which the loads of lugs act, its bands cut; None without lugs,
        and of pins with cuts.
        """
        if self.held is None or self.pressure is None:
            return None
        return body_of_revolution(self.held.pin)

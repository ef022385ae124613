"""The interface of supports: the loads of a pin's links, as loads on its surface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Protocol

import numpy as np

from fea.core.material import Material
from fea.core.over_time import Between, changed
from fea.core.peak import Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.solution import StressField
from fea.core.verdict import Evidence
from fea.support.cell_pressure import CellPressure
from fea.support.lugs.axial import axial_seats, pulled, structure_reacts
from fea.support.lugs.lug import Lug
from fea.support.records import JointResult
from geometry import Pin, PinLike, body_of_revolution
from pinbase.memo import Memo

Progress = Callable[[str], None]
LoadsChange = Callable[[PinLoads], PinLoads]


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

    def __post_init__(self) -> None:
        # Where a structure reacts along the axis in any case, it is among the surfaces in all.
        mass = (self.material.density or 0.0) * self.pin.volume
        every = (*self.cases, *self.also.values())
        if any(pulled(self.pin, self.lugs, x, mass) for x in every):
            whole = partial(structure_reacts, self.pin, self.lugs, mass)
            self._change({x.case: whole for x in self.cases}, whole)
        # A link states moments in a whole case, also where these pass through zero. Loads of all
        # cases have the same seats, so that they can be solved together; and what acts under any of
        # them is solved for all.
        length, seats, pulls = self.pin.length, self._seats(), self._pulls()
        tilting = {case.case: case.tilting_links(length) for case in self.cases}
        prescribed = () if self.lugs else tuple(self.also.values())
        units = {x.case: tuple(x.coefficients()) for x in prescribed}
        known = {
            case: partial(
                replace, tilting=of_case, seats=seats, pulls=pulls, always=units.get(case, ())
            )
            for case, of_case in tilting.items()
        }
        self._change(known, partial(replace, seats=seats, pulls=pulls))

    def _change(self, of: Mapping[str, LoadsChange], other: LoadsChange) -> None:
        """Change the loads of each case in its own way, and those of other cases (`also`)."""
        cases = tuple(of[x.case](x) for x in self.cases)
        also = {case: of.get(case, other)(x) for case, x in self.also.items()}
        between = {c: partial(changed, of[c], x) for c, x in self.between.items() if c in of}
        for name, value in (("cases", cases), ("also", also), ("between", between)):
            object.__setattr__(self, name, value)

    def completed(self, links: PinLoads) -> PinLoads:
        """Other loads of a case, with what is known of them in the whole case."""
        like = next((x for x in self.cases if x.case == links.case), None)
        if like is None:
            return links
        if not set(like.surfaces) <= set(links.surfaces):
            mass = (self.material.density or 0.0) * self.pin.volume
            links = structure_reacts(self.pin, self.lugs, mass, links)
        return replace(
            links, tilting=like.tilting, seats=like.seats, pulls=like.pulls, always=like.always
        )

    def _pulls(self) -> tuple[tuple[str, int], ...]:
        """The forces along the axis, by sense, and torques of links in lugs, in any loads."""
        out = dict[tuple[str, int], None]()
        for x in (*self.cases, *self.also.values()) if self.lugs else ():
            torques = np.broadcast_to(x.moments, x.forces.shape)[..., 2]
            senses = x.forces[..., 2] < 0.0, x.forces[..., 2] > 0.0, torques != 0.0
            for side, acts in enumerate(senses):
                out |= {(x.surfaces[c], side): None for c in np.flatnonzero(acts.any(axis=0))}
        return tuple(out)

    def _seats(self) -> dict[str, tuple[str, str]]:
        """The seats at which axial forces of links in lugs enter, by the links that exert some; a
        pin with cuts takes them on the bands alone.
        """
        pin = body_of_revolution(self.pin)
        if pin is None or not self.lugs:
            return {}
        every = (*self.cases, *self.also.values())
        pulling = {
            s for x in every for s in x.surfaces if x.forces[:, x.surfaces.index(s), 2].any()
        }
        return {s: x for s, x in axial_seats(pin, self.lugs).items() if s in pulling}


class HeldPin(Protocol):
    """A pin held in one way, ready for any loads of its links. It lives in one process."""

    @property
    def problem(self) -> PinProblem:
        """The pin, its lugs and its cases."""

    @property
    def pin(self) -> PinLike:
        """The pin that is meshed: bands are cut into rings where pressure varies along them."""

    @property
    def clamps(self) -> tuple[str, ...]:
        """Constrained surfaces, by the pin's names."""

    @property
    def failures(self) -> Mapping[str, Maximum]:
        """The cases that cannot be held, with the verdict "rigid" or "failed" and its reason."""

    @property
    def notes(self) -> Mapping[str, Reason]:
        """The notes on the support, by case, that belong to the maximum."""

    @property
    def finest(self) -> bool:
        """Whether no finer resolution may follow."""

    def start(self, case: str) -> PinLoads:
        """The loads on the pin at the instants from which the solution of a case starts."""

    def press(self, links: PinLoads) -> PinLoads:
        """The loads on the pin under loads of its links.

        Raises: SolveError.
        """

    def resolved(self, case: str, requirement: Requirement) -> bool:
        """Return whether a finer resolution could not change the answer, before stress is
        refined.
        """

    def of_meshes(self, requirement: Requirement) -> Requirement:
        """The requirement on the meshes, given the support's own error."""

    def finished(self, reading: StressReading, requirement: Requirement) -> Solution:
        """The solution of a case, judged once, with the results of the support.

        These are its part of the error, sections, contact, and the range over the uncertain
        properties of the joint. All of them follow from the loads at one instant, which are found
        once.
        """


class UnderLinkLoads:
    """The part of a held pin on which the loads of the links act as they are."""

    problem: PinProblem
    finest = True

    @property
    def pin(self) -> PinLike:
        """The pin itself."""
        return self.problem.pin

    def start(self, case: str) -> PinLoads:
        """The loads of the links."""
        (loads,) = (loads for loads in self.problem.cases if loads.case == case)
        return loads

    def press(self, links: PinLoads) -> PinLoads:
        """The loads of the links themselves."""
        return links

    def resolved(self, case: str, requirement: Requirement) -> bool:
        """Return True, since nothing is discretised."""
        return True

    def of_meshes(self, requirement: Requirement) -> Requirement:
        """The whole requirement, since the loads have no error."""
        return requirement


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
        if self.held is None:
            return links
        return self.held.press(self.held.problem.completed(links))

    @property
    def rings(self) -> Pin | None:
        """The body of revolution on which the loads of lugs act, its bands cut; None without lugs,
        and of pins with cuts.
        """
        if self.held is None or self.pressure is None:
            return None
        return body_of_revolution(self.held.pin)

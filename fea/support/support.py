"""The interface of supports, which turn the loads of a pin's links into loads on its surface."""

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

    lugs: the lugs that hold the pin; without lugs it has clamps and prescribed loads.
    cases: loads of the links, one item for each load case.
    between: for each case that is a motion, the loads at any times; in other cases only the given
    instants count.
    also: for each case, other loads under which stress will be requested.
    clamps: clamped surfaces, by the pin's names.
    memo: flexibilities, meshes and unit fields, shared with other problems.
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
        # If a structure reacts axial loads in any case, it is among the surfaces in all cases.
        mass = (self.material.density or 0.0) * self.pin.volume
        every = (*self.cases, *self.also.values())
        if any(pulled(self.pin, self.lugs, x, mass) for x in every):
            whole = partial(structure_reacts, self.pin, self.lugs, mass)
            self._change({x.case: whole for x in self.cases}, whole)
        # A link states moments in a whole case, also at instants at which they pass through zero.
        # The loads of all cases have the same seats, so that they can be solved together. Unit
        # loads that act in any case are solved for all.
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
        """Change the loads of each case.

        of: for each case, its change. other: the change for loads of other cases in `also`.
        """
        cases = tuple(of[x.case](x) for x in self.cases)
        also = {case: of.get(case, other)(x) for case, x in self.also.items()}
        between = {c: partial(changed, of[c], x) for c, x in self.between.items() if c in of}
        for name, value in (("cases", cases), ("also", also), ("between", between)):
            object.__setattr__(self, name, value)

    def completed(self, links: PinLoads) -> PinLoads:
        """Other loads of a case, with the attributes that the whole case determines."""
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
        """The axial forces, by sense, and the torques that links in lugs exert in any of the loads
        (PinLoads.pulls).
        """
        out = dict[tuple[str, int], None]()
        for x in (*self.cases, *self.also.values()) if self.lugs else ():
            torques = np.broadcast_to(x.moments, x.forces.shape)[..., 2]
            senses = x.forces[..., 2] < 0.0, x.forces[..., 2] > 0.0, torques != 0.0
            for side, acts in enumerate(senses):
                out |= {(x.surfaces[c], side): None for c in np.flatnonzero(acts.any(axis=0))}
        return tuple(out)

    def _seats(self) -> dict[str, tuple[str, str]]:
        """The seats of axial forces, for each link in a lug that exerts any.

        The result is empty for a pin with cuts, which takes axial forces only on its bands.
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
    """A pin held by one support, ready for any loads of its links. It stays in one process."""

    @property
    def problem(self) -> PinProblem:
        """The pin, its lugs and its cases."""

    @property
    def pin(self) -> PinLike:
        """The pin that is meshed: bands are cut into rings where pressure varies along them."""

    @property
    def clamps(self) -> tuple[str, ...]:
        """The constrained surfaces, by the pin's names."""

    @property
    def failures(self) -> Mapping[str, Maximum]:
        """The cases that cannot be held, with the verdict "rigid" or "failed" and its reason."""

    @property
    def notes(self) -> Mapping[str, Reason]:
        """The notes on the support for each case, which are appended to the note of the maximum."""

    @property
    def finest(self) -> bool:
        """Whether no finer resolution follows."""

    def start(self, case: str) -> PinLoads:
        """The loads on the pin at the initial instants of a case."""

    def press(self, links: PinLoads) -> PinLoads:
        """The loads on the pin under loads of its links.

        Raises: SolveError.
        """

    def resolved(self, case: str, requirement: Requirement) -> bool:
        """Return whether the resolution of the support is fine enough for a case, or the last.

        This is known before meshes are refined.
        """

    def of_meshes(self, requirement: Requirement) -> Requirement:
        """The requirement on the meshes, which takes the support's own error into account."""

    def finished(self, reading: StressReading, requirement: Requirement) -> Solution:
        """The judged solution of a case, with the results of the support.

        These are the support's part of the error, sections, contact, and the range over the
        uncertain properties of the joint.
        """


class UnderLinkLoads:
    """The common part of held pins on which the links' loads act unchanged."""

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
        """Return True, since the support has no discretisation."""
        return True

    def of_meshes(self, requirement: Requirement) -> Requirement:
        """The whole requirement, since the loads have no error."""
        return requirement


class Support(Protocol):
    """A way to hold a pin, which turns the loads of its links into loads on its surface."""

    def hold(
        self,
        problem: PinProblem,
        requirement: Requirement,
        coarser: HeldPin | None = None,
        progress: Progress = silent,
    ) -> HeldPin:
        """Hold the pin.

        coarser: the same pin held on the resolution before, whose candidates for the governing
        instant are kept.

        Raises: ArgumentError for lugs that do not fit; MeshError, SolveError where no case can be
        held.
        """


@dataclass(frozen=True)
class StressReading:
    """The result of a model for a case, before it is judged.

    answer: stress on the last mesh.
    loads: on the pin, with the instants that were added to find the maximum.
    instant: number of the governing instant.
    coarser: stress on the mesh before the last; it is given only for a hardened surface and after
    more than one mesh.
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
    """The solution of a case: its maximum, and the stress field.

    answer: stress field; None where the case could not be solved.
    loads: on the pin, with the instants that were added to find the maximum.
    instant: number of the governing instant.
    held: the held pin.
    joint: results of the joint at the governing instant.
    pressure: contact pressure at the governing instant.
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
        """The body of revolution with its bands cut into rings, on which contact pressures act;
        None without contact, and for pins with cuts.
        """
        if self.held is None or self.pressure is None:
            return None
        return body_of_revolution(self.held.pin)

"""The support of a pin by lugs in contact.

Stress under the contact pressures is computed as under any loads of an unclamped pin
(fea.solve.solve). The error of the cells adds to that of meshes and instants. To estimate it,
contact at the instant that governs on the first mesh is solved again on cells twice as large. The
error follows from the difference, by the order of convergence of the cells. The cells are refined
until their error is a set part of the tolerance. Where only a required factor is to be decided,
larger cells come first, which take a third of the time. They are enough if they decide the factor
in spite of their error, also for the stress beneath contact.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal

from fea.core.equilibrium import centre_of_volume
from fea.core.linear_solver import SolveError
from fea.core.peak import NO_REASON, Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.cut.region import refusal
from fea.support.contact.held import HeldContact
from fea.support.contact.pressed_cases import Candidates, PressedCases
from fea.support.contact.resolution import MAX_CELLS, ROUGH, Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.contact.unit_pressures import unit_model, unit_patterns
from fea.support.lugs.axial import seats_note
from fea.support.lugs.fit import fitted, on_structure
from fea.support.lugs.links import link_forces, link_moments
from fea.support.prescribed import balanced
from fea.support.support import HeldPin, PinProblem, Progress, silent
from fea.support.unheld import unheld, unsolved
from geometry import CutPin, Pin, PinLike
from pinbase.memo import Memo

Alone = Literal["unit", "alone"]
Arcs = Literal["wide", "narrow"]


class ContactSupport:
    """A support by lugs in contact, on cells of one resolution (fea.support.support.Support).

    cells: the resolution.
    finer: the next resolution, None for the last.
    alone: None: with the error of the cells. "alone": without it. "unit": without it, by unit
    pressures of the rings, which a memo keeps (fea.support.contact.unit_pressures).
    arcs: the cases that are held: "wide", those whose arcs of contact the usual cells follow;
    "narrow", all that are left, on cells that follow their arcs; None, all on these cells.
    """

    def __init__(
        self,
        cells: Resolution,
        finer: Resolution | None = None,
        alone: Alone | None = None,
        arcs: Arcs | None = None,
    ) -> None:
        self.cells, self.finer, self.alone, self.arcs = cells, finer, alone, arcs

    def hold(
        self,
        problem: PinProblem,
        requirement: Requirement,
        coarser: HeldPin | None = None,
        progress: Progress = silent,
    ) -> HeldContact:
        """Hold the pin as every support does; a case whose loads no contact can carry fails before
        anything is meshed.
        """
        refused: dict[str, Maximum] = {}
        near: Mapping[str, Candidates] = {}
        cells, finer, left = self.cells, self.finer, problem.cases
        if isinstance(coarser, HeldContact):
            near = coarser.candidates
            if self.arcs == "wide":
                # Cells that follow narrow arcs have many harmonics and few rings. They do not suit
                # a case with wide arcs, and would cost too much for it.
                left = tuple(case for case in left if not coarser.narrow(case))
            if not left:
                return replace(coarser, starts={})  # none is held
            cells, finer = self._cells(coarser, left, requirement)
        else:
            refused = _refused(problem)
            left = tuple(case for case in left if case.case not in refused)
        model, contact = self._pressed(problem, cells, left, progress)
        if self.alone and not requirement.varied:
            near = contact.all_instants()
        elif not contact.instants.keys() <= near.keys():
            near = contact.near(requirement)
        contact.follow(near)
        # These cells are the last if finer ones do not exist or exceed the allowed number of cells.
        # On the last cells all cases are answered.
        finest = finer in (None, cells)
        if finer is not None:
            finest |= model.ring_count(finer.rings) * finer.sectors > MAX_CELLS
        if self.alone:
            compared = contact.uncompared(near, requirement)
        else:
            compared = contact.compared(near, requirement, finest)
        if isinstance(coarser, HeldContact):  # which has cases that later cells hold
            compared = {**coarser.compared, **compared}
        starts = {case: contact.press(links) for case, links in contact.instants.items()}
        held = HeldContact(
            problem, contact, starts, near, compared, finest, refused,
            alone=self.alone is not None, rough=self.cells is ROUGH,
        )  # fmt: skip
        trial = finer is not None and self.cells is ROUGH  # which fails no case
        return _with_failures(held, problem, left, {} if trial else contact.failed)

    def _pressed(
        self,
        problem: PinProblem,
        cells: Resolution,
        cases: tuple[PinLoads, ...],
        progress: Progress,
    ) -> tuple[ContactModel, PressedCases]:
        """The contact model on these cells, and the pressures of the cases."""
        name, cut = problem.pin.name, isinstance(problem.pin, CutPin)
        progress(f"pin {name}, flexibility of {cells.rings} rings of each lug")
        of = profile_of(problem.pin), problem.material, problem.lugs
        if self.alone:
            unit, memo = self.alone == "unit", problem.memo or Memo()
            model = _seeing(unit_model(*of, cells, memo, together=not unit), problem.pin)
            patterns = unit_patterns(model) if unit else None
            return model, PressedCases(model, cases, problem.between, {}, cut, patterns)
        model = _seeing(ContactModel(*of, cells, problem.memo), problem.pin)
        progress(f"pin {name}, contact")
        return model, PressedCases(model, cases, problem.between, problem.also, cut)

    def _cells(
        self, coarser: HeldContact, cases: Sequence[PinLoads], requirement: Requirement
    ) -> tuple[Resolution, Resolution | None]:
        """The resolution on which some cases are held after a coarser one, and the next finer one.

        coarser: the pin held on the coarser resolution.
        """
        if self.arcs == "narrow":
            finer = self.finer and coarser.for_arcs(self.finer, cases)
            return coarser.for_arcs(self.cells, cases), finer
        if self.finer is not None and coarser.far_from(cases, requirement):
            return self.finer, None
        return self.cells, self.finer


def _with_failures(
    held: HeldContact,
    problem: PinProblem,
    cases: Sequence[PinLoads],
    failed: Mapping[str, SolveError],
) -> HeldContact:
    """The held pin with the cases that have no solution, and notes on the others.

    cases: those held on these cells.
    failed: for each case without contact, the error.
    """
    starts = tuple(held.starts.values())
    rigid, _, notes = balanced(held.pin, problem.material, starts, "harmonic")
    for links in cases:
        if (said := seats_note(links, problem.lugs)) is not None:
            notes[links.case] = said + notes.get(links.case, NO_REASON)
    name = problem.pin.name
    without = {case: unsolved(name, case, "harmonic", error) for case, error in failed.items()}
    return replace(held, failures=held.failures | without | rigid, notes=notes)


def _seeing(model: ContactModel, pin: PinLike) -> ContactModel:
    """The model, seeing the pin's cuts if the pin has cuts for which stress can be solved.

    Other cuts are refused when stress is solved.
    """
    if not isinstance(pin, CutPin) or refusal(pin, (), pin.connections) is not None:
        return model
    return model.seeing(pin)


def profile_of(pin: PinLike) -> Pin:
    """The pin without its cuts, for which contact is solved."""
    profile = pin.profile if isinstance(pin, CutPin) else pin
    assert isinstance(profile, Pin)
    return profile


def _refused(problem: PinProblem) -> dict[str, Maximum]:
    """The results of cases whose loads no contact can carry, found before anything is meshed.

    Raises: ArgumentError for lugs that do not fit.
    """
    pin, lugs = profile_of(problem.pin), problem.lugs
    whole = on_structure(pin, lugs)
    inside = fitted(whole, problem.material, lugs)
    structure = len(lugs) > len(pin.connections)
    mass, out = (problem.material.density or 0.0) * whole.volume, unheld(problem, "harmonic")
    for case in problem.cases:
        if case.case in out:
            continue
        try:
            forces = link_forces(pin, mass, case, structure)
            link_moments((pin, whole), inside, case, forces, (mass, centre_of_volume(whole)))
        except SolveError as error:
            out[case.case] = unsolved(pin.name, case.case, "harmonic", error)
    return out

"""Contact in changed joints: stress and forces across the pin, relative to the joint as given.

Contact is solved again with the known flexibilities. All pressures act on one mesh, the first,
whose error is nearly the same in all maxima, so that the ratios of maxima are used.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.core.zone import Zone
from fea.harmonic.beneath import maxima_beneath
from fea.harmonic.field import HarmonicField
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.section.section_stress import SectionField
from fea.singular.singularities import singularities_of
from fea.support.contact.bending import LoadedJoint, growth_across, growth_of_lugs
from fea.support.contact.cell_error import (
    MIN_HARMONICS_PER_ARC,
    NOWHERE,
    AtPlaces,
    by_cells,
)
from fea.support.contact.coarser_cells import on_coarser_cells
from fea.support.contact.contact import ContactProblem
from fea.support.contact.contact_state import ContactState
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import (
    PressureLoads,
    PressureModes,
    resultants,
    stacked,
)
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.changes import JointChange
from fea.support.lugs.lug import Lug
from fea.support.records import Variation
from pinbase.arrays import Mask

# A pattern whose amplitude in the pressures of varied joints is below this fraction of the largest
# is left out. Chosen by judgement, coarser than MODE_TOLERANCE since only ratios of maxima depend
# on it.
VARIATION_MODE_TOLERANCE = 1e-2


@dataclass(frozen=True)
class VariedPressures:
    """The pressures of a varied joint at one instant.

    lugs: with the varied clearance and tilt.
    waves: harmonics of the pressures, (N + 1, 1, R, 2) Pa.
    """

    lugs: tuple[Lug, ...]
    waves: Floats


@dataclass(frozen=True)
class PressedJoint:
    """The contact of a joint at one instant.

    waves: harmonics of the pressures, (N + 1, 1, R, 2) Pa.
    states: the contact on the cells.
    per_arc: number of harmonics that the cells follow, times the half angle of contact in rad.
    lugs: of a varied joint.
    """

    waves: Floats
    states: list[ContactState]
    per_arc: float = math.inf
    lugs: tuple[Lug, ...] = ()

    @property
    def with_rougher(self) -> tuple[PressedJoint, ...]:
        """This joint; on narrow arcs also the joint with half the harmonics, which shows the error
        of the cells.
        """
        narrow = self.per_arc < MIN_HARMONICS_PER_ARC
        return (self, in_half_the_harmonics(self)) if narrow else (self,)


@dataclass(frozen=True)
class ChangedContact:
    """A contact under some changes of the joint.

    over: stress ratios for the changes that could be solved.
    missing: the other changes, each with its reason.
    """

    over: tuple[Variation, ...] = ()
    missing: tuple[str, ...] = ()


# The joint of a contact under each change that could be solved, and the other changes with reasons.
JointsUnderChanges = tuple[list[tuple[JointChange, PressedJoint]], list[str]]


# The joint as given on the cells of the varied joints: stress, relative error from the cells, and
# contact.
AsGiven = tuple[AtPlaces, AtPlaces, PressedJoint]


@dataclass(frozen=True)
class JointChanges:
    """Contacts, each at one instant, whose joint is changed.

    at: the contacts with the joint as given.
    as_given: the joints as given on the cells of the varied joints (AsGiven).
    own_cells: whether varied joints are solved on the model's own cells instead of cells twice as
    large.
    """

    model: ContactModel
    at: Sequence[JointContact]
    requirement: Requirement
    as_given: Sequence[AsGiven]
    own_cells: bool

    def by(
        self, changes: Sequence[Sequence[JointChange]], known: PressureModes
    ) -> tuple[list[ChangedContact], PressureModes]:
        """Return each contact under its own changes, and the patterns of all pressures.

        known: existing patterns, which come first.
        """
        model = self.model
        every = self.joints(changes)
        joints = [[joint for _, joint in solved] for solved, _ in every]
        parts = [(x.waves, VARIATION_MODE_TOLERANCE) for x in itertools.chain(*joints)]
        patterns = model.patterns(parts, known) if parts else known
        loads = [
            [
                loads_of(model, patterns, one, contact)
                for one in itertools.chain(*(x.with_rougher for x in of_contact))
            ]
            for contact, of_contact in zip(self.at, joints, strict=True)
        ]
        stress = iter(at_places(model, self.requirement, loads) if any(loads) else [])
        out = []
        for contact, like, (solved, missing) in zip(self.at, self.as_given, every, strict=True):
            over = [self._variation(contact, like, *one, stress) for one in solved]
            out.append(ChangedContact(tuple(over), tuple(missing)))
        return out, patterns

    def _variation(
        self,
        contact: JointContact,
        like: AsGiven,
        change: JointChange,
        joint: PressedJoint,
        stress: Iterator[AtPlaces],
    ) -> Variation:
        """The stress and force ratios of a contact under a change, relative to the joint as given.

        stress: iterator whose next items belong to this joint (PressedJoint.with_rougher).
        """
        (*stress_given, given), model = like, self.model
        here = [next(stress) for _ in joint.with_rougher]
        own, other = (loaded(model, x, contact) for x in (given, joint))
        name = Variation(change.what, change.value, 1.0, change.length)
        return replace(
            _ratio(name, here, stress_given, model.cells.rings, joint.per_arc),
            across=growth_across(other, own),
            lugs=growth_of_lugs(other, own),
        )

    def joints(self, changes: Sequence[Sequence[JointChange]]) -> list[JointsUnderChanges]:
        """The joint of each contact under its changes, and the changes that could not be solved.

        A change may have no solution: lugs that are free to tilt may leave a couple on the pin, and
        contact may be lost in a large clearance.
        """
        out: list[JointsUnderChanges] = [([], []) for _ in self.at]
        wanted: dict[str, list[tuple[int, JointChange]]] = {}
        for k, of_contact in enumerate(changes):
            for change in of_contact:  # the same change of several contacts needs one model
                wanted.setdefault(f"{change.what} {change.value}", []).append((k, change))
        highest = self.model.cells.highest * (1.0 if self.own_cells else 0.5)
        # Joints with the same gaps touch nearly the same cells, so that each starts from the cells
        # of the first. For other gaps the usual first guess, which estimates the width of contact,
        # is nearer.
        gaps = self.model.bands.gap.tobytes()
        touching = {(k, gaps): self._given(k) for k in range(len(self.at))}
        for name, of_change in wanted.items():
            _, change = of_change[0]
            other = self.model.varied(change.lugs, change.softness)
            cells = _own_cells(other) if self.own_cells else on_coarser_cells(other)
            for k, _ in of_change:
                contact, (solved, missing) = self.at[k], out[k]
                like = k, other.bands.gap.tobytes()
                try:
                    joint = on_cells(other, contact.loads.links, *cells, touching.get(like))
                    touching.setdefault(like, joint.states[0].active)
                    per_arc = highest * contact.half_angle(other.bands, other.tail)
                    solved.append((change, replace(joint, per_arc=per_arc, lugs=other.lugs)))
                except SolveError as error:
                    missing.append(f"{name} ({error})")
        return out

    def _given(self, k: int) -> Mask:
        """The cells in contact in the joint as given."""
        states = self.at[k].contact if self.own_cells else self.as_given[k][2].states
        return states[0].active


def loaded(model: ContactModel, joint: PressedJoint, contact: JointContact) -> LoadedJoint:
    """A joint with the resultants of its pressures on the rings."""
    loads = resultants(model.pin, model.rings, joint.waves, contact.loads.links)
    return LoadedJoint(model.pin, model.lugs, model.bands, loads, contact.mass)


def _ratio(
    change: Variation,
    stress: Sequence[AtPlaces],
    given: Sequence[AtPlaces],
    rings: int,
    per_arc: float,
) -> Variation:
    """The variation with its stresses relative to those of the joint as given.

    The variation has an error of its own where the row's error from the cells does not cover it: on
    narrow arcs, and where the surface governs instead of a section, whose stress hardly depends on
    the cells.
    stress: with the variation; on narrow arcs also with half the harmonics.
    given: stress of the joint as given, on the same cells, and its relative error.
    rings, per_arc: as in cell_error.by_cells.
    """
    (varied, *half), (like, like_error) = stress, given
    row, interval = like.row or 1.0, None
    error = by_cells(varied, half[0], rings, per_arc) if half else NOWHERE
    if varied.surface > varied.section and like.section >= like.surface:
        error = replace(error, surface=error.surface + like_error.surface)
    above, below = 1.0 + error.surface, 1.0 + error.section
    if error != NOWHERE:
        low = max(varied.surface / above, varied.section / below)
        high = max(varied.surface * above, varied.section * below)
        interval = low / row, high / row
    return replace(
        change,
        max_von_mises=varied.row / row,
        interval=interval,
        beneath=varied.beneath * (1.0 + error.beneath) / (like.beneath or 1.0),
        surface=varied.surface * above / (like.surface or 1.0),
    )


def loads_of(
    model: ContactModel, patterns: PressureModes, one: PressedJoint, contact: JointContact
) -> PressureLoads:
    return patterns.loads(one.waves, contact.loads.links, model.arcs(one.states))


def at_places(
    model: ContactModel,
    requirement: Requirement,
    every: Sequence[Sequence[PressureLoads]],
    unread: tuple[Zone, ...] = (),
) -> list[AtPlaces]:
    """The stress at the places on the first mesh, for each of the loads, which have one instant
    each.

    unread: further zones that are not read, but near which the mesh is not refined.
    """
    whole = stacked(list(itertools.chain(*every)))
    singular = singularities_of(model.pin, model.material, (), (whole,), requirement.distance)
    problem = SectionProblem(model.pin, model.material, (), (whole,), singular, model.first)
    section = harmonic_solution(problem, 0, 1.0)
    in_sections = whole.in_sections
    zones = tuple(dict.fromkeys((*singular, *unread)))
    places = (
        HarmonicField(section, zones).maxima(whole),
        SectionField(model.pin, model.material, (), (in_sections,)).maxima(in_sections),
        maxima_beneath(section.fields, whole, zones),
    )
    return [AtPlaces(*stress) for stress in zip(*(x.tolist() for x in places), strict=True)]


def on_cells(
    model: ContactModel,
    links: PinLoads,
    problem: ContactProblem,
    belongs: Floats,
    start: Mask | None = None,
) -> PressedJoint:
    """The contact on other cells, expressed on the rings of the model.

    problem, belongs: as from `on_coarser_cells`. links, start: as in ContactModel.pressed.
    """
    states = model.pressed(links, problem, start)
    states = [replace(x, pressure=belongs @ x.pressure) for x in states]
    return PressedJoint(model.waves(states), states)


def in_half_the_harmonics(joint: PressedJoint) -> PressedJoint:
    """The joint with only the lower half of its harmonics, which half the sectors would resolve."""
    waves = joint.waves.copy()
    waves[(len(waves) + 1) // 2 :] = 0.0
    return replace(joint, waves=waves)


def _own_cells(model: ContactModel) -> tuple[ContactProblem, Floats]:
    return model.contact, np.eye(len(model.rings))

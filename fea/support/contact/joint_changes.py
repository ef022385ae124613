"""Contact in changed joints: stress and forces across the pin, relative to the joint as given.

Contact is solved again with the known flexibilities. All pressures act on one mesh, the first,
whose error is nearly the same in all maxima, so that the ratios of maxima are used.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Literal

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
    MIN_HARMONICS_OF_ORDER,
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

Cells = Literal["own", "large"]  # the cells of the model, or cells twice as large


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
    cells: on which the contact is solved.
    large: the same contact on large cells, if the arcs of contact are narrow.
    """

    waves: Floats
    states: list[ContactState]
    per_arc: float = math.inf
    lugs: tuple[Lug, ...] = ()
    cells: Cells = "own"
    large: PressedJoint | None = None

    @property
    def with_rougher(self) -> tuple[PressedJoint, ...]:
        """This joint; on narrow arcs also the joint with half the harmonics, which shows the error
        of the cells. It is that on large cells, if it was solved on these.
        """
        if self.large is not None:
            return self, in_half_the_harmonics(self.large)
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


# The cells in contact with which the search starts, by number of the contact, cells and gaps.
Touching = dict[tuple[int, Cells, bytes], Mask]
# A function that returns the contact problem on some cells, and which rings belong to its rings.
Problems = Callable[[Cells], tuple[ContactProblem, Floats]]
# The joint as given on the cells of the varied joints: stress, relative error from the cells, and
# contact.
AsGiven = tuple[AtPlaces, AtPlaces, PressedJoint]


@dataclass(frozen=True)
class JointChanges:
    """Contacts, each at one instant, whose joint is changed.

    at: the contacts with the joint as given.
    as_given: for each contact, the joint as given on these cells.
    cells: on which changed joints are solved. Second cells, if there are any, are used where the
    arcs of contact are too narrow for the first.
    """

    model: ContactModel
    at: Sequence[JointContact]
    requirement: Requirement
    as_given: Sequence[Mapping[Cells, AsGiven]]
    cells: tuple[Cells, ...]

    def by(
        self, changes: Sequence[Sequence[JointChange]], known: PressureModes
    ) -> tuple[list[ChangedContact], PressureModes]:
        """Return each contact under its own changes, and the patterns of all pressures.

        known: existing patterns, which come first.
        """
        model = self.model
        every = self.joints(changes)
        joints = [[x for _, one in solved for x in one.with_rougher] for solved, _ in every]
        parts = [(x.waves, VARIATION_MODE_TOLERANCE) for x in itertools.chain(*joints)]
        patterns = model.patterns(parts, known) if parts else known
        loads = [
            [loads_of(model, patterns, one, contact) for one in of_contact]
            for contact, of_contact in zip(self.at, joints, strict=True)
        ]
        stress = iter(at_places(model, self.requirement, loads) if any(loads) else [])
        out = []
        for contact, like, (solved, missing) in zip(self.at, self.as_given, every, strict=True):
            over = [self._variation(contact, like[one.cells], change, one, stress)
                    for change, one in solved]  # fmt: skip
            out.append(ChangedContact(largest_of(over, low=min), tuple(missing)))
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
        # Joints with the same gaps touch nearly the same cells, so that each starts from the cells
        # of the first. For other gaps the usual first guess, which estimates the width of contact,
        # is nearer.
        gaps = self.model.bands.gap.tobytes()
        touching = {
            (k, on, gaps): self._given(k, on) for k in range(len(self.at)) for on in self.cells
        }
        for name, of_change in wanted.items():
            _, change = of_change[0]
            other = self.model.varied(change.lugs, change.softness)
            problems = cache(partial(_problem, other))
            for k, _ in of_change:
                solved, missing = out[k]
                try:
                    joints = self._on_cells_that_follow(k, other, problems, touching)
                    solved += [(change, joint) for joint in joints]
                except SolveError as error:
                    missing.append(f"{name} ({error})")
        return out

    def _on_cells_that_follow(
        self, k: int, other: ContactModel, problems: Problems, touching: Touching
    ) -> list[PressedJoint]:
        """The contact in another joint, on the cells that follow its arcs of contact.

        These are the first cells if they follow the arcs, otherwise the model's own cells. If the
        own cells do not follow them either, both contacts count, since the error of either may be
        estimated too small. The arguments are those of `_joint`.
        """
        first, *more = self.cells
        joint = self._joint(k, other, first, problems, touching)
        if joint.per_arc >= MIN_HARMONICS_PER_ARC or not more:
            return [joint]
        second = self._joint(k, other, more[0], problems, touching)
        own, large = (joint, second) if first == "own" else (second, joint)
        own = replace(own, large=large)
        return [large, own] if own.per_arc < MIN_HARMONICS_OF_ORDER else [own]

    def _joint(
        self, k: int, other: ContactModel, cells: Cells, problems: Problems, touching: Touching
    ) -> PressedJoint:
        """The contact in another joint on some cells.

        k: number of the contact.
        other: model of the other joint.
        problems: returns the contact problem of the other joint on cells.
        touching: cells in contact with which the search starts; the first result for other gaps is
        added.
        """
        contact, like = self.at[k], (k, cells, other.bands.gap.tobytes())
        joint = on_cells(other, contact.loads.links, *problems(cells), touching.get(like))
        touching.setdefault(like, joint.states[0].active)
        highest = self.model.cells.highest * (1.0 if cells == "own" else 0.5)
        per_arc = highest * contact.half_angle(other.bands, other.tail)
        return replace(joint, per_arc=per_arc, lugs=other.lugs, cells=cells)

    def _given(self, k: int, cells: Cells) -> Mask:
        """The cells in contact in the joint as given, on own cells or on cells twice as large."""
        states = self.at[k].contact if cells == "own" else self.as_given[k][cells][2].states
        return states[0].active


def largest_of(
    every: Iterable[Variation], low: Callable[[Iterable[float]], float] = max
) -> tuple[Variation, ...]:
    """The variations of a case whose joint is varied more than once: for each change the largest
    stress and forces.

    every: all variations, relative to the same stress.
    low: combines the lower ends of intervals. At several instants it is `max`, since the largest
    stress is at least that of any instant; for several sets of cells at one instant it is `min`,
    since any of them may be right.
    """
    of = dict[tuple[str, str], list[Variation]]()
    for x in every:
        of.setdefault((x.what, x.value), []).append(x)
    return tuple(_largest(alike, low) for alike in of.values())


def _largest(alike: Sequence[Variation], low: Callable[[Iterable[float]], float]) -> Variation:
    ends = [x.interval or (x.max_von_mises, x.max_von_mises) for x in alike]
    least, most = low(end for end, _ in ends), max(end for _, end in ends)
    # A variation without an interval of its own has the error of the row.
    plain = max((x.max_von_mises for x in alike if x.interval is None), default=0.0)
    lugs = dict[str, float]()
    for name, ratio in (pair for x in alike for pair in x.lugs):
        lugs[name] = max(ratio, lugs.get(name, ratio))
    return replace(
        alike[0],
        max_von_mises=max(x.max_von_mises for x in alike),
        interval=(least, most) if most > plain else None,
        beneath=max(x.beneath or 0.0 for x in alike),
        across=max(x.across for x in alike),
        surface=max(x.surface for x in alike),
        lugs=tuple(lugs.items()),
    )


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


def _problem(model: ContactModel, cells: Cells) -> tuple[ContactProblem, Floats]:
    return (model.contact, np.eye(len(model.rings))) if cells == "own" else on_coarser_cells(model)

"""Contact in joints that are changed: stress, and forces across the pin, relative to the joint as
given.

Contact is solved again with the flexibilities at hand, and all pressures act on one mesh, the
first: its error is in all maxima alike, so that their ratios are compared.
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

# Of the largest amplitude: what a pattern must add to the pressures of a varied joint. Chosen by
# judgement, coarser than MODE_TOLERANCE since only ratios of maxima follow from it.
VARIATION_MODE_TOLERANCE = 1e-2

Cells = Literal["own", "large"]  # those of the model, or twice as large


@dataclass(frozen=True)
class VariedPressures:
    """The pressures of a varied joint at an instant.

    lugs: with their clearance and tilt. waves: harmonics, (N + 1, 1, R, 2) Pa.
    """

    lugs: tuple[Lug, ...]
    waves: Floats


@dataclass(frozen=True)
class PressedJoint:
    """The contact at an instant with something changed: the harmonics of its pressures, and the
    cells.

    per_arc: harmonics that the cells follow, times the half angle of contact in rad.
    lugs: of a varied joint.
    cells: on which it is solved.
    large: the same contact on large cells, where the arcs are too narrow for these.
    """

    waves: Floats
    states: list[ContactState]
    per_arc: float = math.inf
    lugs: tuple[Lug, ...] = ()
    cells: Cells = "own"
    large: PressedJoint | None = None

    @property
    def with_rougher(self) -> tuple[PressedJoint, ...]:
        """This joint, and on narrow arcs the one from which the error of the cells follows: on
        large cells, if it is known on these, with half the harmonics.
        """
        if self.large is not None:
            return self, in_half_the_harmonics(self.large)
        narrow = self.per_arc < MIN_HARMONICS_PER_ARC
        return (self, in_half_the_harmonics(self)) if narrow else (self,)


@dataclass(frozen=True)
class ChangedContact:
    """A contact under some changes of the joint.

    over: the ratios of those that could be solved. missing: the others, and why.
    """

    over: tuple[Variation, ...] = ()
    missing: tuple[str, ...] = ()


# The joint of a contact under each change that could be solved, and the others with the reasons.
JointsUnderChanges = tuple[list[tuple[JointChange, PressedJoint]], list[str]]


# By contact, cells and gaps: the cells in contact of a joint, from which others begin.
Touching = dict[tuple[int, Cells, bytes], Mask]
Problems = Callable[[Cells], tuple[ContactProblem, Floats]]
# The joint as given on the cells of varied ones: its stress, the relative error, and the contact.
LikeGiven = tuple[AtPlaces, AtPlaces, PressedJoint]


@dataclass(frozen=True)
class JointChanges:
    """Contacts, each at one instant, whose joint is changed.

    likes: for each contact, the joint as given on these cells.
    cells: on which joints are solved. The second, if there are two, follow where the arcs of
    contact are too narrow for the first.
    """

    model: ContactModel
    at: Sequence[JointContact]
    requirement: Requirement
    likes: Sequence[Mapping[Cells, LikeGiven]]
    cells: tuple[Cells, ...]

    def by(
        self, changes: Sequence[Sequence[JointChange]], known: PressureModes
    ) -> tuple[list[ChangedContact], PressureModes]:
        """Each contact under changes of its own, and the patterns of the pressures, with those that
        are known.
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
        for contact, like, (solved, missing) in zip(self.at, self.likes, every, strict=True):
            over = [self._variation(contact, like[one.cells], change, one, stress)
                    for change, one in solved]  # fmt: skip
            out.append(ChangedContact(largest_of(over, low=min), tuple(missing)))
        return out, patterns

    def _variation(
        self,
        contact: JointContact,
        like: LikeGiven,
        change: JointChange,
        joint: PressedJoint,
        stress: Iterator[AtPlaces],
    ) -> Variation:
        """The ratios of a contact under a change to that as given.

        stress: of this joint and those with rougher cells comes next.
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
        """The joint of each contact under its changes, and those that could not be solved.

        Lugs that are free to tilt may leave a couple on the pin, and contact may be lost in a large
        clearance.
        """
        out: list[JointsUnderChanges] = [([], []) for _ in self.at]
        wanted: dict[str, list[tuple[int, JointChange]]] = {}
        for k, of_contact in enumerate(changes):
            for change in of_contact:  # each is one joint for all contacts
                wanted.setdefault(f"{change.what} {change.value}", []).append((k, change))
        # Joints of the same gaps touch nearly the same cells, from which the next of them begins.
        # For other gaps the usual first guess is nearer: it knows the width of contact.
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
        """A contact in another joint, on the first cells if they follow the arcs of contact, else
        on the model's own. Where these do not follow either, both count, since either error may be
        too small. The arguments are as of `_joint`.
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
        """A contact in another joint on some cells.

        problems: gives the contact problem of the other joint on cells, as `on_coarser_cells`.
        touching: the cells in contact from which the search begins; the first result of other gaps
        is added.
        """
        contact, like = self.at[k], (k, cells, other.bands.gap.tobytes())
        joint = on_cells(other, contact.loads.links, *problems(cells), touching.get(like))
        touching.setdefault(like, joint.states[0].active)
        highest = self.model.cells.highest * (1.0 if cells == "own" else 0.5)
        per_arc = highest * contact.half_angle(other.bands, other.tail)
        return replace(joint, per_arc=per_arc, lugs=other.lugs, cells=cells)

    def _given(self, k: int, cells: Cells) -> Mask:
        """The cells in contact in the joint as given."""
        states = self.at[k].contact if cells == "own" else self.likes[k][cells][2].states
        return states[0].active


def largest_of(
    every: Iterable[Variation], low: Callable[[Iterable[float]], float] = max
) -> tuple[Variation, ...]:
    """The variations of a case whose joint is varied more than once: of each change the largest
    stress and forces.

    every: relative to the same stress.
    low: the low end of an interval from those of all: at several instants the largest of these is
    at least `max`, on several sets of cells at one instant `min`.
    """
    of = dict[tuple[str, str], list[Variation]]()
    for x in every:
        of.setdefault((x.what, x.value), []).append(x)
    return tuple(_largest(alike, low) for alike in of.values())


def _largest(alike: Sequence[Variation], low: Callable[[Iterable[float]], float]) -> Variation:
    ends = [x.interval or (x.max_von_mises, x.max_von_mises) for x in alike]
    least, most = low(end for end, _ in ends), max(end for _, end in ends)
    # Without an interval of its own the largest has the error of the row.
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
    """A varied joint with the resultants of its pressures on the rings."""
    loads = resultants(model.pin, model.rings, joint.waves, contact.loads.links)
    return LoadedJoint(model.pin, model.lugs, model.bands, loads, contact.mass)


def _ratio(
    change: Variation,
    stress: Sequence[AtPlaces],
    given: Sequence[AtPlaces],
    rings: int,
    per_arc: float,
) -> Variation:
    """The variation with its stresses relative to those of the joint as given, and with the error
    of the cells where that of the row as given does not hold: on narrow arcs, and where the surface
    governs instead of a section, which the cells hardly change.

    stress: with the variation; on narrow arcs also with half the harmonics.
    given: of the joint as given, on the same cells, and its relative error.
    rings, per_arc: as of `_by_cells`.
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
    """The stress at the places on the first mesh, of loads of one instant each.

    unread: zones that are not read, about which the mesh is no finer.
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
    """The contact on other cells; the arguments as of `on_coarser_cells` and `pressed`."""
    states = model.pressed(links, problem, start)
    states = [replace(x, pressure=belongs @ x.pressure) for x in states]
    return PressedJoint(model.waves(states), states)


def in_half_the_harmonics(joint: PressedJoint) -> PressedJoint:
    """The joint with the lower half of its harmonics alone, as many as half the sectors resolve."""
    waves = joint.waves.copy()
    waves[(len(waves) + 1) // 2 :] = 0.0
    return replace(joint, waves=waves)


def _problem(model: ContactModel, cells: Cells) -> tuple[ContactProblem, Floats]:
    return (model.contact, np.eye(len(model.rings))) if cells == "own" else on_coarser_cells(model)

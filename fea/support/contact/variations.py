"""The change of a pin's stress with its joint: with the cells of contact, with clearance, and with
the stiffness of lugs.

Contact is solved again at the governing instants with the flexibilities at hand, and all pressures
act on one mesh, the first: its error is in all maxima alike, so that their ratios are compared.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
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
from fea.singular.singularities import edges_of_loads, singularities_of
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
from fea.support.contact.friction import friction_variations, rubbed, rubbed_across, rubs
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import (
    MODE_TOLERANCE,
    PressureLoads,
    PressureModes,
    resultants,
    stacked,
)
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.changes import joint_variations
from fea.support.lugs.lug import Lug
from fea.support.records import JointRange, Variation, range_ends
from geometry.shape.rings import USUAL_RING_COUNT

# Of the largest amplitude: what a pattern must add to the pressures of a varied joint. Chosen by
# judgement, coarser than MODE_TOLERANCE since only ratios of maxima follow from it.
VARIATION_MODE_TOLERANCE = 1e-2


@dataclass(frozen=True)
class VariedPressures:
    """The pressures of a varied joint at an instant.

    lugs: with their clearance and tilt. waves: harmonics, (N + 1, 1, R, 2) Pa.
    """

    lugs: tuple[Lug, ...]
    waves: Floats


@dataclass(frozen=True)
class ResolutionComparison:
    """The stress at one instant on the first mesh, and its relative error from the cells.

    links: the loads.
    over: variations of the joint, with the larger of surface and section, and the stress beneath
    contact, relative to those of the joint as given.
    left_out: the variations that could not be solved, and why.
    half_angle: of contact where a lug presses most, rad (JointContact.half_angle).
    pressures: of the joint as given and of each variation but those by friction, on the same cells.
    """

    stress: AtPlaces
    cells: AtPlaces
    links: PinLoads
    over: tuple[Variation, ...]
    left_out: str = ""
    half_angle: float = 0.5 * math.pi
    pressures: tuple[VariedPressures, ...] = ()

    def range(self, largest: float, below: float = 0.0) -> JointRange:
        """The range over the joint of a maximum and of the stress beneath contact, Pa."""
        over = tuple(
            replace(
                x,
                max_von_mises=largest * x.max_von_mises,
                interval=x.interval and (largest * x.interval[0], largest * x.interval[1]),
                beneath=below * (x.beneath or 0.0),
            )
            for x in self.over
        )
        return JointRange(range_ends(largest, over), over)

    def is_at(self, links: PinLoads, case: PinLoads) -> bool:
        """Return whether an instant is this one, or no farther from it than two of the case's are
        apart.
        """
        if links.times is None or self.links.times is None or case.times is None:
            return np.array_equal(links.forces, self.links.forces)
        apart = float(np.abs(links.times - self.links.times)[0])
        return apart <= float(np.diff(case.times).max(initial=0.0))


# Tells, from the comparisons of cells at some instants, at which the joint is varied.
WhichVaried = Callable[[Sequence[ResolutionComparison]], Sequence[bool]]


def nowhere(compared: Sequence[ResolutionComparison]) -> Sequence[bool]:
    """The joint is varied at no instant (WhichVaried)."""
    return (False,) * len(compared)


@dataclass(frozen=True)
class _Joint:
    """The contact at an instant with something changed: the harmonics of its pressures, and the
    cells.

    per_arc: harmonics that the cells follow, times the half angle of contact in rad.
    lugs: of a varied joint.
    """

    waves: Floats
    states: list[ContactState]
    per_arc: float = math.inf
    lugs: tuple[Lug, ...] = ()

    @property
    def with_rougher(self) -> tuple[_Joint, ...]:
        """This joint, and on narrow arcs the one from which the error of the cells follows."""
        narrow = self.per_arc < MIN_HARMONICS_PER_ARC
        return (self, _in_half_the_harmonics(self)) if narrow else (self,)


def compare(
    model: ContactModel,
    at: Sequence[JointContact],
    requirement: Requirement,
    known: PressureModes | None = None,
    vary: WhichVaried | None = None,
) -> tuple[ResolutionComparison, ...]:
    """Compare joints in contact, each at one instant, with coarser cells and with a varied joint.

    known: patterns of the pressures on them.
    vary: tells from the comparisons of cells at which instants the joint is varied, by default at
    all.
    """
    if not at:
        return ()
    exact = _on_both_cells(model, at)
    parts = [(one.waves, MODE_TOLERANCE) for both in exact for one in both]
    # One set of patterns for all, so that all stress comes from one solution on the first mesh.
    patterns = model.patterns(parts, known)
    every = [
        [_loads(model, patterns, x, contact) for x in (*both, _in_half_the_harmonics(both[1]))]
        for contact, both in zip(at, exact, strict=True)
    ]
    stress, out, likes = _at_places(model, requirement, every), [], []
    for contact, both in zip(at, exact, strict=True):
        first, twice, roughest = (stress.pop(0) for _ in range(3))
        arc = contact.half_angle(model.bands, model.tail)
        cells = by_cells(first, roughest, model.cells.rings, arc * model.cells.highest)
        out.append(ResolutionComparison(first, cells, contact.loads.links, (), half_angle=arc))
        # The joint as given on the cells of varied joints.
        likes.append((first, both[0]) if _large_cells(model) else (twice, both[1]))
    which = (True,) * len(at) if vary is None else vary(out)
    if any(which):
        ratios = _over_joint(model, at, requirement, patterns, likes, which)
        pairs = zip(out, ratios, strict=True)
        out = [replace(x, over=a, left_out=b, pressures=c) for x, (a, b, c) in pairs]
    return tuple(out)


def _large_cells(model: ContactModel) -> bool:
    """Whether the model's own cells are so large that varied joints are solved on them.

    Otherwise they are solved on cells twice as large, which cost less.
    """
    return model.cells.rings < USUAL_RING_COUNT


def _over_joint(
    model: ContactModel,
    at: Sequence[JointContact],
    requirement: Requirement,
    known: PressureModes,
    likes: Sequence[tuple[AtPlaces, _Joint]],
    vary: Sequence[bool],
) -> list[tuple[tuple[Variation, ...], str, tuple[VariedPressures, ...]]]:
    """The variations of each contact, what is not included in them, and the pressures
    (ResolutionComparison).

    likes: the joints as given on the same cells, with their stress.
    vary: the contacts whose joint is varied.
    """
    over, varied, missing = _varied(model, at, _large_cells(model), vary)
    parts = [(one.waves, VARIATION_MODE_TOLERANCE) for one in itertools.chain(*varied)]
    patterns = model.patterns(parts, known) if parts else known
    every = [
        [
            _loads(model, patterns, one, contact)
            for one in itertools.chain(*(x.with_rougher for x in others))
        ]
        for contact, others in zip(at, varied, strict=True)
    ]
    stress = _at_places(model, requirement, every) if any(every) else []
    by_friction = _by_friction(model, requirement, patterns, at, vary)
    out = []
    of_contacts = zip(at, likes, over, varied, missing, by_friction, strict=True)
    for contact, (like, given), names, joints, why, more in of_contacts:
        own = _loaded(model, given, contact)
        every_loaded = [_loaded(model, x, contact) for x in joints]
        ratios = [
            replace(
                _ratio(
                    x, [stress.pop(0) for _ in y.with_rougher], like, model.cells.rings, y.per_arc
                ),
                across=growth_across(loaded, own),
                lugs=growth_of_lugs(loaded, own),
            )
            for x, y, loaded in zip(names, joints, every_loaded, strict=True)
        ]
        left_out = f"not included: {'; '.join(why)}" if why else ""
        pressures = tuple(VariedPressures(x.lugs or model.lugs, x.waves) for x in (given, *joints))
        out.append(((*ratios, *more), left_out, pressures))
    return out


def _loaded(model: ContactModel, joint: _Joint, contact: JointContact) -> LoadedJoint:
    """A varied joint with the resultants of its pressures on the rings."""
    loads = resultants(model.pin, model.rings, joint.waves, contact.loads.links)
    return LoadedJoint(model.pin, model.lugs, model.bands, loads, contact.mass)


def _ratio(
    change: Variation,
    stress: Sequence[AtPlaces],
    like: AtPlaces,
    rings: int,
    per_arc: float,
) -> Variation:
    """The variation with its stresses relative to those of the joint as given, and with the error
    of the cells on narrow arcs.

    stress: with the variation; on narrow arcs also with half the harmonics.
    like: of the joint as given, on the same cells.
    rings, per_arc: as of `_by_cells`.
    """
    varied, *half = stress
    row, deep, interval = varied.row, varied.beneath, None
    if half:
        error = by_cells(varied, half[0], rings, per_arc)
        above, below = 1.0 + error.surface, 1.0 + error.section
        low = max(varied.surface / above, varied.section / below)
        high = max(varied.surface * above, varied.section * below)
        interval = low / (like.row or 1.0), high / (like.row or 1.0)
        deep *= 1.0 + error.beneath
    return replace(
        change,
        max_von_mises=row / (like.row or 1.0),
        interval=interval,
        beneath=deep / (like.beneath or 1.0),
    )


def _by_friction(
    model: ContactModel,
    requirement: Requirement,
    known: PressureModes,
    at: Sequence[JointContact],
    vary: Sequence[bool],
) -> list[tuple[Variation, ...]]:
    """The variations of each contact by the friction of lugs, relative to those without.

    known: patterns of the pressures that have been solved.
    """
    if not rubs(model.lugs):
        return [()] * len(at)
    out: list[tuple[Variation, ...]] = []
    # Friction is even on every ring, and its step at the edges a singularity of that alone.
    edges = edges_of_loads(model.pin, model.rings, model.material, requirement.distance)
    for contact, so in zip(at, vary, strict=True):
        if not so:
            out.append(())
            continue
        without, changed = rubbed(model, contact, known)
        plain, *stress = _at_places(model, requirement, [[without], *changed.values()], edges)
        pairs = [(x.row / (plain.row or 1.0), x.beneath / (plain.beneath or 1.0)) for x in stress]
        ratios = {name: [pairs.pop(0) for _ in loads] for name, loads in changed.items()}
        own = _Joint(model.waves(contact.contact), list(contact.contact))
        across = rubbed_across(model, contact, _loaded(model, own, contact))
        out.append(tuple(friction_variations(model.lugs, ratios, across)))
    return out


def uncompared(contact: JointContact) -> ResolutionComparison:
    """A comparison without content, where none was made."""
    return ResolutionComparison(NOWHERE, NOWHERE, contact.loads.links, ())


def _loads(
    model: ContactModel, patterns: PressureModes, one: _Joint, contact: JointContact
) -> PressureLoads:
    return patterns.loads(one.waves, contact.loads.links, model.arcs(one.states))


def _at_places(
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


def _on_both_cells(model: ContactModel, at: Sequence[JointContact]) -> list[tuple[_Joint, _Joint]]:
    """Each contact, and the same on cells twice as large."""
    cells = on_coarser_cells(model)
    return [
        (
            _Joint(model.waves(contact.contact), list(contact.contact)),
            _coarse(model, contact.loads.links, *cells),
        )
        for contact in at
    ]


def _coarse(
    model: ContactModel, links: PinLoads, problem: ContactProblem, belongs: Floats
) -> _Joint:
    states = model.pressed(links, problem)
    states = [replace(x, pressure=belongs @ x.pressure) for x in states]
    return _Joint(model.waves(states), states)


def _in_half_the_harmonics(joint: _Joint) -> _Joint:
    """The joint with the lower half of its harmonics alone, as many as half the sectors resolve."""
    waves = joint.waves.copy()
    waves[(len(waves) + 1) // 2 :] = 0.0
    return replace(joint, waves=waves)


def _own_cells(model: ContactModel) -> tuple[ContactProblem, Floats]:
    return model.contact, np.eye(len(model.rings))


def _varied(
    model: ContactModel, at: Sequence[JointContact], own_cells: bool, vary: Sequence[bool]
) -> tuple[list[list[Variation]], list[list[_Joint]], list[list[str]]]:
    """The variations of the joint for each contact, the contact under each, and those that could
    not be solved.

    Lugs that are free to tilt may leave a couple on the pin, and contact may be lost in a large
    clearance.
    own_cells: whether to use the model's own cells, instead of cells twice as large.
    vary: the contacts for which the joint is varied.
    """
    names: list[list[Variation]] = [[] for _ in at]
    varied: list[list[_Joint]] = [[] for _ in at]
    missing: list[list[str]] = [[] for _ in at]
    highest = model.cells.highest * (1.0 if own_cells else 0.5)
    for change in joint_variations(model.whole, model.lugs) if any(vary) else ():
        other = model.varied(change.lugs, change.softness)
        cells = _own_cells(other) if own_cells else on_coarser_cells(other)
        for contact, over, changed, why, so in zip(at, names, varied, missing, vary, strict=True):
            if not so:
                continue
            try:
                joint = _coarse(other, contact.loads.links, *cells)
                per_arc = highest * contact.half_angle(other.bands, other.tail)
                changed.append(replace(joint, per_arc=per_arc, lugs=other.lugs))
            except SolveError as error:
                why.append(f"{change.what} {change.value} ({error})")
                continue
            over.append(Variation(change.what, change.value, 1.0, change.length))
    return names, varied, missing

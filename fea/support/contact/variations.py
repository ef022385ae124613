"""The change of a pin's stress with the cells of contact and with the properties of the joint.

Contact is solved again at the governing instants with the known flexibilities. All pressures act on
one mesh, the first, whose error is nearly the same in all maxima, so that the ratios of maxima are
used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.singular.singularities import edges_of_loads
from fea.support.contact.cell_error import (
    NOWHERE,
    AtPlaces,
    by_cells,
)
from fea.support.contact.coarser_cells import on_coarser_cells
from fea.support.contact.friction import friction_variations, rubbed, rubbed_across, rubs
from fea.support.contact.joint_changes import (
    AsGiven,
    Cells,
    JointChanges,
    PressedJoint,
    VariedPressures,
    at_places,
    in_half_the_harmonics,
    loaded,
    loads_of,
    on_cells,
)
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import (
    MODE_TOLERANCE,
    PressureModes,
)
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.changes import joint_variations
from fea.support.records import JointRange, Variation, range_ends
from geometry.shape.rings import USUAL_RING_COUNT


@dataclass(frozen=True)
class ResolutionComparison:
    """The stress at one instant on the first mesh, and its relative error from the cells.

    stress, cells: the stress, Pa, and the error.
    links: loads of the links at the instant.
    over: variations of the joint, with the larger of surface and section, and the stress beneath
    contact, relative to those of the joint as given.
    left_out: the variations that could not be solved, and why.
    half_angle: half angle of contact where a lug presses most, rad (JointContact.half_angle).
    """

    stress: AtPlaces
    cells: AtPlaces
    links: PinLoads
    over: tuple[Variation, ...]
    left_out: str = ""
    half_angle: float = 0.5 * math.pi

    def ratios(self, case: AtPlaces) -> tuple[Variation, ...]:
        """The variations relative to the largest stress of a case instead of that at the instant.

        case: the largest stress of the case with the joint as given, on the first mesh.
        """
        own = self.stress
        row, deep = own.row / (case.row or 1.0), own.beneath / (case.beneath or 1.0)
        on_surface = own.surface / (case.surface or 1.0)
        return tuple(
            replace(scaled(x, row, deep), surface=on_surface * x.surface) for x in self.over
        )

    def is_at(self, links: PinLoads, case: PinLoads) -> bool:
        """Return whether the instant of the given loads is this one, or away from it by at most the
        longest interval of the case.
        """
        if links.times is None or self.links.times is None or case.times is None:
            return np.array_equal(links.forces, self.links.forces)
        apart = float(np.abs(links.times - self.links.times)[0])
        return apart <= float(np.diff(case.times).max(initial=0.0))


def scaled(x: Variation, row: float, below: float) -> Variation:
    """The variation with its stress times `row` and its stress beneath contact times `below`."""
    interval = x.interval and (row * x.interval[0], row * x.interval[1])
    deep = below * (x.beneath or 0.0)
    return replace(x, max_von_mises=row * x.max_von_mises, interval=interval, beneath=deep)


def joint_range(over: Sequence[Variation], largest: float, below: float = 0.0) -> JointRange:
    """The range over the joint of a maximum and of the stress beneath contact.

    over: the variations, relative to the joint as given.
    largest, below: the maximum and the stress beneath contact with the joint as given, Pa.
    """
    over = tuple(scaled(x, largest, below) for x in over)
    return JointRange(range_ends(largest, over), over)


# A function that returns, from the comparisons of cells at some instants, at which of these the
# joint is varied.
WhichVaried = Callable[[Sequence[ResolutionComparison]], Sequence[bool]]


def nowhere(compared: Sequence[ResolutionComparison]) -> Sequence[bool]:
    """Return False for every instant, so that no joint is varied (WhichVaried)."""
    return (False,) * len(compared)


def compare(
    model: ContactModel,
    at: Sequence[JointContact],
    requirement: Requirement,
    known: PressureModes | None = None,
    vary: WhichVaried | None = None,
) -> tuple[ResolutionComparison, ...]:
    """Compare contacts, each at one instant, with those on coarser cells and in varied joints.

    known: existing patterns of pressures.
    vary: decides from the comparisons of cells at which instants the joint is varied; by default at
    all.
    """
    if not at:
        return ()
    exact = _on_both_cells(model, at)
    parts = [(one.waves, MODE_TOLERANCE) for both in exact for one in both]
    # One set of patterns for all, so that all stress comes from one solution on the first mesh.
    patterns = model.patterns(parts, known)
    every = [
        [loads_of(model, patterns, x, contact) for x in (*both, in_half_the_harmonics(both[1]))]
        for contact, both in zip(at, exact, strict=True)
    ]
    as_given: list[Mapping[Cells, AsGiven]] = []
    stress, out = at_places(model, requirement, every), []
    for contact, (own, large) in zip(at, exact, strict=True):
        first, twice, roughest = (stress.pop(0) for _ in range(3))
        arc = contact.half_angle(model.bands, model.tail)
        cells = by_cells(first, roughest, model.cells.rings, arc * model.cells.highest)
        out.append(ResolutionComparison(first, cells, contact.loads.links, (), half_angle=arc))
        as_given.append({"own": (first, cells, own), "large": (twice, cells, large)})
    which = (True,) * len(at) if vary is None else vary(out)
    if any(which):
        ratios = _over_joint(model, at, requirement, patterns, as_given, which)
        out = [replace(x, over=a, left_out=b) for x, (a, b) in zip(out, ratios, strict=True)]
    return tuple(out)


def _over_joint(
    model: ContactModel,
    at: Sequence[JointContact],
    requirement: Requirement,
    known: PressureModes,
    as_given: Sequence[Mapping[Cells, AsGiven]],
    vary: Sequence[bool],
) -> list[tuple[tuple[Variation, ...], str]]:
    """The variations of each contact, and a remark on those that are not included.

    known: existing patterns of pressures.
    as_given: for each contact, the joint as given on both kinds of cells.
    vary: for each contact, whether its joint is varied.
    """
    changes = tuple(joint_variations(model.whole, model.lugs)) if any(vary) else ()
    # Cells larger than rough ones serve only to show the error.
    rough = model.cells.rings < USUAL_RING_COUNT
    cells: tuple[Cells, ...] = ("own", "large") if rough else ("large", "own")
    joints = JointChanges(model, at, requirement, as_given, cells)
    changed, known = joints.by([changes if varied else () for varied in vary], known)
    by_friction = _by_friction(model, requirement, known, at, vary)
    out = []
    for contact, friction in zip(changed, by_friction, strict=True):
        left_out = f"not included: {'; '.join(contact.missing)}" if contact.missing else ""
        out.append(((*contact.over, *friction), left_out))
    return out


def varied_pressures(model: ContactModel, contact: JointContact) -> tuple[VariedPressures, ...]:
    """The pressures of a contact at one instant, first with the joint as given, then under each
    change of the joint that can be solved, without friction; all on the model's own cells.
    """
    joints = JointChanges(model, [contact], Requirement(), (), ("own",))
    ((solved, _),) = joints.joints([tuple(joint_variations(model.whole, model.lugs))])
    varied = (VariedPressures(x.lugs, x.waves) for _, x in solved)
    return (VariedPressures(model.lugs, model.waves(contact.contact)), *varied)


def _by_friction(
    model: ContactModel,
    requirement: Requirement,
    known: PressureModes,
    at: Sequence[JointContact],
    vary: Sequence[bool],
) -> list[tuple[Variation, ...]]:
    """The variations of each contact by the friction of lugs, relative to no friction.

    known: existing patterns of pressures.
    """
    if not rubs(model.lugs):
        return [()] * len(at)
    out: list[tuple[Variation, ...]] = []
    # The traction of friction is uniform along each ring. Its steps at the edges would be
    # singularities that exist only for that reason, so that they are not read.
    edges = edges_of_loads(model.pin, model.rings, model.material, requirement.distance)
    for contact, varied in zip(at, vary, strict=True):
        if not varied:
            out.append(())
            continue
        without, changed = rubbed(model, contact, known)
        plain, *stress = at_places(model, requirement, [[without], *changed.values()], edges)
        every = [x.over(plain) for x in stress]
        ratios = {name: [every.pop(0) for _ in loads] for name, loads in changed.items()}
        own = PressedJoint(model.waves(contact.contact), list(contact.contact))
        across = rubbed_across(model, contact, loaded(model, own, contact))
        out.append(tuple(friction_variations(model.lugs, ratios, across)))
    return out


def uncompared(
    model: ContactModel,
    at: Sequence[JointContact],
    requirement: Requirement,
    known: PressureModes,
) -> tuple[ResolutionComparison, ...]:
    """Return the contacts, each at one instant, without a comparison of cells.

    Their joints are varied if the requirement asks for it.
    known: patterns that reproduce all pressures.
    """
    if not requirement.varied:
        return tuple(ResolutionComparison(NOWHERE, NOWHERE, x.loads.links, ()) for x in at)
    both = _on_both_cells(model, at)
    loads = [[loads_of(model, known, x, one) for x in of] for one, of in zip(at, both, strict=True)]
    stress = at_places(model, requirement, loads)
    as_given: list[Mapping[Cells, AsGiven]] = [
        {"own": (stress[2 * k], NOWHERE, own), "large": (stress[2 * k + 1], NOWHERE, large)}
        for k, (own, large) in enumerate(both)
    ]
    over = _over_joint(model, at, requirement, known, as_given, (True,) * len(at))
    every = zip(at, stress[::2], over, strict=True)
    return tuple(ResolutionComparison(x, NOWHERE, one.loads.links, *y) for one, x, y in every)


def _on_both_cells(
    model: ContactModel, at: Sequence[JointContact]
) -> list[tuple[PressedJoint, PressedJoint]]:
    """Each contact, and the same contact on cells twice as large."""
    cells = on_coarser_cells(model)
    return [
        (
            PressedJoint(model.waves(contact.contact), list(contact.contact)),
            on_cells(model, contact.loads.links, *cells),
        )
        for contact in at
    ]

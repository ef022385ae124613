"""The range of a pin's maximum over uncertain properties of its joint, by beams on foundations.

The joint is varied as in fea.support.contact.variations, which takes milliseconds here: other
clearances, lugs half and twice as stiff, tilt free and guided. A beam's maximum is only as accurate
as its bounds, so that the range extends from the least lower bound to the largest upper bound.
Clearance affects nothing but the bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.contact.bending import growth_across, growth_of_lugs
from fea.support.foundation.bounds import StressBounds, band_forces, stress_bounds
from fea.support.foundation.foundation_model import FoundationModel, JointFoundation
from fea.support.foundation.stress import FoundationStress
from fea.support.lugs.changes import JointChange, joint_variations, pressed_in, softened
from fea.support.lugs.fit import beyond_foundations
from fea.support.lugs.lug import Lug
from fea.support.records import JointRange, JointResult, Variation
from geometry import ArgumentError, Pin
from pinbase.arrays import Ints


class FoundationRange:
    """The range of a pin's maximum over its joint, for all cases.

    distance: excluded at sharp corners, as a fraction of the local diameter.
    assumed: whether the lugs are assumed.

    Raises: ArgumentError for lugs that do not fit; SolveError for a joint that a beam on
    foundations cannot represent.
    """

    def __init__(
        self, pin: Pin, material: Material, lugs: Sequence[Lug], distance: float, assumed: bool
    ) -> None:
        if reason := beyond_foundations(pin, lugs):
            raise SolveError(reason, "beyond-foundations")
        self.assumed = assumed
        self.own = FoundationStress.of(FoundationModel(pin, material, lugs), distance)
        self._in_lugs: dict[str, FoundationStress | None] = {}  # for each change of the joint

    def at(
        self, loads: PinLoads, own: JointFoundation | None = None
    ) -> tuple[JointRange | None, str]:
        """Return the range over all instants with a remark on the variations that it leaves out; if
        there is no range, None and the reason.

        own: the joint as given under these loads, where it is known.

        Raises: SolveError as FoundationModel.solve.
        """
        own = own or self.own.model.solve(loads)
        if len(loads) > 1:
            loads = loads.at(_governing_candidates(self.own, own))
            own = self.own.model.solve(loads)
        given = stress_bounds(self.own, own)
        if given.bounds is None:
            return None, given.why
        over, left_out, unheld = [], [], []
        for change in joint_variations(self.own.model.whole, self.own.model.lugs):
            name = f"{change.what} {change.value}"
            if name not in self._in_lugs:
                self._in_lugs[name] = _changed(self.own, change)
            if (stress := self._in_lugs[name]) is None:
                left_out.append(name)
                continue
            held, errors = _held(stress.model, loads)
            unheld += [f"{name} ({error})" for error in errors[:1]]
            if held is None:
                continue
            of_joint = stress_bounds(stress, held)
            if of_joint.bounds is None:
                left_out.append(name)
            else:
                over.append(_variation(change, (held, own), (of_joint, given)))
        bounds = [given.bounds, *(v.interval for v in over if v.interval)]
        ends = min(low for low, _ in bounds), max(high for _, high in bounds)
        beyond = f"beyond the range of the measurements, and not included: {', '.join(left_out)}"
        none = f"not included: {'; '.join(unheld)}"
        remarks = [text for text, of in ((beyond, left_out), (none, unheld)) if of]
        return JointRange(ends, tuple(over), "foundation", self.assumed), "; ".join(remarks)


def _variation(
    change: JointChange,
    joints: tuple[JointFoundation, JointFoundation],
    stress: tuple[StressBounds, StressBounds],
) -> Variation:
    """The maximum with the joint changed.

    joints: the changed joint and the joint as given. stress: the bounds of both.
    """
    (held, own), (of_joint, given) = joints, stress
    return Variation(
        change.what,
        change.value,
        of_joint.maximum,
        change.length,
        of_joint.bounds,
        across=growth_across(held, own),
        surface=of_joint.surface / (given.surface or 1.0),
        lugs=growth_of_lugs(held, own),
    )


def _held(
    model: FoundationModel, loads: PinLoads
) -> tuple[JointFoundation | None, list[SolveError]]:
    """Return the joint at the instants at which its lugs hold the pin, None if there are none, and
    the errors at the other instants.

    Lugs that are free to tilt may leave a couple on the pin.
    """
    try:
        return model.solve(loads), []
    except SolveError as error:
        if len(loads) == 1:
            return None, [error]
    each = [_held(model, loads.at(np.array([t]))) for t in range(len(loads))]
    held = np.flatnonzero([joint is not None for joint, _ in each])
    errors = [error for _, of in each for error in of]
    return (model.solve(loads.at(held)) if len(held) else None), errors


def _governing_candidates(stress: FoundationStress, joint: JointFoundation) -> Ints:
    """The instants that may govern in a varied joint.

    They are those of the largest stress of the surface and on the axis, of the largest bending
    moment, and of the largest force of each lug: a value that is smaller with the joint as given
    may grow more.
    """
    von_mises, on_axis = stress.von_mises(joint).von_mises, stress.r == 0.0
    moment = np.linalg.norm(joint.bending_moment(np.unique(stress.z)), axis=2).max(axis=1)
    both = [von_mises[at].max(axis=0) for at in (on_axis, ~on_axis) if at.any()]
    return np.unique([x.argmax() for x in (*both, moment, *band_forces(joint).T)])


def prescribed_ranges(
    pin: Pin,
    material: Material,
    lugs: Sequence[Lug],
    loads: Sequence[PinLoads | None],
    how: tuple[float, bool],
) -> tuple[JointResult | None, ...]:
    """The ranges of a pin with prescribed loads, as if lugs held it.

    loads: at the governing instant of each case, None where there is none.
    how: `distance` and `assumed` of FoundationRange.
    """
    try:
        over = FoundationRange(pin, material, lugs, *how)
    except (ArgumentError, SolveError) as error:
        none = JointResult("prescribed", remark=str(error))
        return tuple(None if here is None else none for here in loads)
    return tuple(None if here is None else _prescribed(over, here) for here in loads)


def _prescribed(over: FoundationRange, loads: PinLoads) -> JointResult:
    try:
        joint_range, remark = over.at(loads)
    except SolveError as error:
        return JointResult("prescribed", remark=str(error))
    return JointResult("prescribed", range=joint_range, remark=remark)


def _changed(given: FoundationStress, change: JointChange) -> FoundationStress | None:
    """The stress in the changed joint; None where the pin is pressed into a lug, since a beam does
    not have the stress of a press fit.
    """
    if pressed_in(change):
        return None
    if change.length is not None:
        other = given.model.with_clearances(list(change.lugs))
    else:
        both = zip(change.lugs, change.softness, strict=True)
        lugs = [softened(*x) for x in both]
        other = FoundationModel(given.model.given, given.model.material, lugs)
    return replace(given, model=other)

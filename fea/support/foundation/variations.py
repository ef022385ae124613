"""The range of a pin's maximum over uncertain properties of its joint, by beams on foundations.

At one instant, as fea.support.contact.variations has it by contact: other clearances, lugs half
and twice as stiff, tilt free and guided, all in milliseconds. A beam's maximum is only as good as
its bounds, so that the range reaches from the least lower to the largest upper one. Of clearance
the beam knows no more than these.
"""

from __future__ import annotations

from collections.abc import Sequence

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.contact.bending import growth_across, growth_of_lugs
from fea.support.foundation.bounds import stress_bounds
from fea.support.foundation.foundation_model import FoundationModel, JointFoundation
from fea.support.foundation.stress import FoundationStress
from fea.support.lugs.changes import (
    JointChange,
    joint_variations,
    pressed_in,
    with_stiffness,
)
from fea.support.lugs.fit import beyond_foundations
from fea.support.lugs.lug import Lug
from fea.support.records import JointRange, JointResult, Variation
from geometry import ArgumentError, Pin


class FoundationRange:
    """The range of a pin's maximum over its joint, for all cases.

    assumed: whether its lugs are assumed.

    Raises: ValueError for lugs that do not fit; SolveError for lugs that it cannot answer.
    """

    def __init__(
        self, pin: Pin, material: Material, lugs: Sequence[Lug], distance: float, assumed: bool
    ) -> None:
        if reason := beyond_foundations(pin, lugs):
            raise SolveError(reason, "beyond-foundations")
        self.assumed = assumed
        self.own = FoundationStress.of(FoundationModel(pin, material, lugs), distance)
        self._in_lugs: dict[str, FoundationStress | None] = {}  # of joints that were changed

    def at(self, loads: PinLoads) -> tuple[JointRange | None, str]:
        """The range at a single instant, and the variations it leaves out, or the reason why there
        is none.

        Raises: SolveError as FoundationModel.solve.
        """
        own = self.own.model.solve(loads)
        given = stress_bounds(self.own, own)
        if given.bounds is None:
            return None, given.why
        over, left_out, unheld = [], [], []
        for change in joint_variations(self.own.model.whole, self.own.model.lugs):
            name = f"{change.what} {change.value}"
            try:
                varied = self._variation(name, change, loads, own)
            except SolveError as error:  # lugs free to tilt may leave a couple on the pin
                unheld.append(f"{name} ({error})")
                continue
            if varied is None:
                left_out.append(name)
            else:
                over.append(varied)
        bounds = [given.bounds, *(v.interval for v in over if v.interval)]
        ends = min(low for low, _ in bounds), max(high for _, high in bounds)
        beyond = f"beyond the range of the measurements, and not included: {', '.join(left_out)}"
        none = f"not included: {'; '.join(unheld)}"
        remarks = [text for text, of in ((beyond, left_out), (none, unheld)) if of]
        return JointRange(ends, tuple(over), "foundation", self.assumed), "; ".join(remarks)

    def _variation(
        self, name: str, change: JointChange, loads: PinLoads, own: JointFoundation
    ) -> Variation | None:
        """The maximum with the joint changed; None beyond what a beam knows.

        own: of the joint as given. Raises: SolveError.
        """
        if name not in self._in_lugs:
            self._in_lugs[name] = _changed(self.own, change)
        if (stress := self._in_lugs[name]) is None:
            return None
        varied = stress.model.solve(loads)
        of_joint = stress_bounds(stress, varied)
        if of_joint.bounds is None:
            return None
        return Variation(
            change.what,
            change.value,
            of_joint.maximum,
            change.length,
            of_joint.bounds,
            across=growth_across(varied, own),
            surface=_on_surface(stress, varied) / (_on_surface(self.own, own) or 1.0),
            lugs=growth_of_lugs(varied, own),
        )


def _on_surface(stress: FoundationStress, joint: JointFoundation) -> float:
    return float(stress.on_surface.von_mises(joint).von_mises.max())


def prescribed_ranges(
    pin: Pin,
    material: Material,
    lugs: Sequence[Lug],
    loads: Sequence[PinLoads | None],
    how: tuple[float, bool],
) -> tuple[JointResult | None, ...]:
    """The ranges of a pin with another support, as if it sat in these lugs.

    loads: at the governing instants of its cases, None where there is none.
    how: distance and assumed, as of FoundationRange.
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
    """The stress in lugs that are changed; None where the pin is pressed into one, whose stress a
    beam does not know.
    """
    if pressed_in(change):
        return None
    if change.length is not None:
        other = given.model.with_clearances(list(change.lugs))
    else:
        both = zip(change.lugs, change.softness, strict=True)
        lugs = [with_stiffness(*x) for x in both]
        other = FoundationModel(given.model.given, given.model.material, lugs)
    return given.in_lugs(other)

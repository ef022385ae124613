"""The range of a pin's maximum over uncertain properties of its joint, by beams on foundations.

At one instant, as fea.support.contact.variations has it by contact: other clearances, lugs half
and twice as stiff, tilt free and guided, all in milliseconds. A beam's maximum is only as good as
its bounds, so that the range reaches from the least lower to the largest upper one. Of clearance
the beam knows no more than these.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.contact.bending import growth_across, growth_of_lugs
from fea.support.foundation.bounds import stress_bounds
from fea.support.foundation.foundation_model import FoundationModel
from fea.support.foundation.stress import FoundationStress
from fea.support.lugs.changes import joint_variations, pressed_in, with_stiffness
from fea.support.lugs.fit import beyond_foundations
from fea.support.lugs.lug import Lug
from fea.support.records import JointRange, JointResult, Variation
from geometry import ArgumentError, Pin


@dataclass(frozen=True)
class Varied:
    """A joint with one property changed.

    what, value: the property, and its value in words.
    length: the value, m, if it is a length.
    stress: None where the pin is pressed into a lug, whose stress a beam does not know.
    """

    what: str
    value: str
    length: float | None
    stress: FoundationStress | None


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
        self.varied = tuple(_varied(self.own))

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
        for joint in self.varied:
            if joint.stress is None:
                left_out.append(f"{joint.what} {joint.value}")
                continue
            try:
                varied = joint.stress.model.solve(loads)
            except SolveError as error:  # lugs that are free to tilt may leave a couple on the pin
                unheld.append(f"{joint.what} {joint.value} ({error})")
                continue
            varied_bounds = stress_bounds(joint.stress, varied)
            if varied_bounds.bounds is None:
                left_out.append(f"{joint.what} {joint.value}")
                continue
            size = varied_bounds.maximum
            over.append(
                Variation(
                    joint.what,
                    joint.value,
                    size,
                    joint.length,
                    varied_bounds.bounds,
                    across=growth_across(varied, own),
                    lugs=growth_of_lugs(varied, own),
                )
            )
        bounds = [given.bounds, *(v.interval for v in over if v.interval)]
        ends = min(low for low, _ in bounds), max(high for _, high in bounds)
        beyond = f"beyond the range of the measurements, and not included: {', '.join(left_out)}"
        none = f"not included: {'; '.join(unheld)}"
        remarks = [text for text, of in ((beyond, left_out), (none, unheld)) if of]
        return JointRange(ends, tuple(over), "foundation", self.assumed), "; ".join(remarks)


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


def _varied(given: FoundationStress) -> Iterator[Varied]:
    model = given.model
    for change in joint_variations(model.whole, model.lugs):
        if pressed_in(change):
            yield Varied(change.what, change.value, change.length, None)
            continue
        if change.length is not None:
            other = model.with_clearances(list(change.lugs))
        else:
            both = zip(change.lugs, change.softness, strict=True)
            other = FoundationModel(model.given, model.material, [with_stiffness(*x) for x in both])
        yield Varied(change.what, change.value, change.length, given.in_lugs(other))

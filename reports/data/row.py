"""Rows of results: one pin in one case."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Annotated

from assess.diameter_law import BENDING_EXPONENT
from assess.judgement import BELOW_YIELD, DEPENDS, SAFE, Judgement
from assess.margin import Margin
from assess.opinion.opinions import Opinion
from assess.plastic.records import LimitLoad, LugCollapse
from assess.strength.bending_arms import BendingArms
from fea.core.peak import Maximum, Refinement, SingularZone
from fea.core.places import Places
from fea.core.requirement import MINOR_CASE
from fea.support.records import JointResult, LostFit
from pinbase.dimensions import (
    Floats,
    Forces,
    Length,
    Moments,
    Stress,
    Stresses,
    Time,
    Times,
    Velocities,
    Velocity,
)
from reports.data.mechanics import DrivePosition, shown_position


@dataclass(frozen=True)
class Units:
    """The names of the units of results."""

    length: str
    force: str
    stress: str
    time: str


SI = Units("m", "N", "Pa", "s")


@dataclass(frozen=True)
class GoverningLoad:
    """The load of a body on the pin at a connection at the governing instant.

    force, moment: (3,), world axes.
    """

    connection: str
    body: str
    force: Forces
    moment: Moments


@dataclass(frozen=True)
class Dependence:
    """A value that is given as a range, or seldom known, and changes the outcome of a row.

    what: "clearance", "impulse time", "beneath".
    value: in words where it is not a number ("guided"); the variation ("clearance") for the stress
    beneath contact over a range; the lugs for a pin that comes loose.
    over: the owner of the range: "joint", "landing", "links" (their stiffness) or "strength"
    (yield); several of these if only together they change the outcome ("joint and links");
    "beneath" for the stress beneath contact as described; "press fit" for a pin that comes loose.
    factor: the safety factor at this value.
    given, at, flips_at: the value of the study, a value at which the outcome differs, and the
    interpolated value at which it changes, of `dimension`; None where it is not a number.
    reach: depth below pressed cells to which the stress exceeds the permitted one.
    """

    what: str
    value: str
    over: str
    factor: float
    given: Annotated[float, "own"] | None = None
    at: Annotated[float, "own"] | None = None
    flips_at: Annotated[float, "own"] | None = None
    dimension: str = "1"
    reach: Length | None = None


@dataclass(frozen=True)
class LandingRange:
    """The results of one pin over the ranges of a landing's impulse, at P points.

    impulse_time, velocity_change, force, max_von_mises: (P,). pulses: (P,).
    safety_factor: (P,), None without a yield strength.
    nominal, nominal_pulse: of the case itself.
    verdict: of the case, valid for all points.
    spread: for a `singular` verdict the ends of the interval of the factor, over the factor.
    largest_load: the largest ratio by which a demand (a force on a band, or the stress) grows, at
    least 1.
    """

    pin: str
    case: str
    impulse_time: Times
    velocity_change: Velocities
    force: Forces
    max_von_mises: Stresses
    safety_factor: Floats | None
    nominal: tuple[Time, Velocity]
    verdict: str
    spread: tuple[float, float] | None = None
    pulses: tuple[str, ...] = ()
    nominal_pulse: str = ""
    error: float = 0.0
    largest_load: float = 1.0


@dataclass(frozen=True)
class SharingRange:
    """The range of a maximum over the stiffness of links in a statically indeterminate linkage.

    max_von_mises: the two ends.
    lowest, highest: what differs from the study there; empty where the end is the row's own value.
    largest_load: as in LandingRange.
    """

    max_von_mises: tuple[Stress, Stress]
    lowest: str
    highest: str
    largest_load: float = 1.0


@dataclass(frozen=True, repr=False)
class PinResult:
    """A row of the results: one pin in one case. Numbers are None for `rigid` and `failed`.

    maximum: the maximum stress, with its error and verdict.
    judgement: of this maximum against yield.
    joint: contact with the lugs at the governing instant, if lugs support the pin.
    limit_load: of the pin past yield, if requested. lug_collapses: of lugs, if requested.
    landing: the results over the ranges of a landing's impulse, if it has any.
    sharing: the range over the stiffness of links, if the linkage is statically indeterminate.
    strength_range: the ends of the yield strength, where the study states them.
    margins: of every check at every place and level. worst: the worst place of each that counts.
    arms: of the bending moment; None where the formulas do not apply.
    second_opinion: of CalculiX, if any.
    held: the supports of the pin, in words.
    left_out: given forces that were not applied because their band is clamped.
    position: of the drive. position_unit: as in ReactionTable.
    loads: at the governing instant.
    shank_angles: of its lugs at the governing instant, by connection, degrees from x.
    exponent: of the diameters in the safety factor, by the law of the section
    (assess.diameter_law).
    depends_on: values within the study's ranges that change whether the maximum is permitted.
    lost_fits: lugs into which the pin is no longer pressed at the temperature of the case.
    published_*: the publication's value, in the study's units.
    units: of the numbers.
    """

    maximum: Maximum
    judgement: Judgement = field(default_factory=Judgement)
    joint: JointResult | None = None
    limit_load: LimitLoad | None = None
    lug_collapses: tuple[LugCollapse, ...] = ()
    landing: LandingRange | None = None
    sharing: SharingRange | None = None
    strength_range: tuple[Stress, Stress] | None = None
    margins: tuple[Margin, ...] = ()
    worst: tuple[Margin, ...] = ()
    arms: BendingArms | None = None
    second_opinion: Opinion | None = None
    held: str = ""
    left_out: tuple[str, ...] = ()
    position: DrivePosition | None = None
    position_unit: str = ""
    loads: tuple[GoverningLoad, ...] = ()
    shank_angles: tuple[tuple[str, float], ...] = ()
    exponent: float = BENDING_EXPONENT
    depends_on: tuple[Dependence, ...] = ()
    lost_fits: tuple[LostFit, ...] = ()
    published_max_von_mises: float | None = None
    published_safety_factor: float | None = None
    units: Units = field(default=SI, compare=False)

    @property
    def joint_growth(self) -> float:
        """The largest ratio by which the stress of the pin grows over the range of the joint."""
        over = self.joint.range if self.joint else None
        return 1.0 if over is None else over.growth(self.max_von_mises)

    @property
    def surface_growth(self) -> float:
        """The same ratio, including the stress of the surface where a section governs."""
        over = self.joint.range if self.joint else None
        return 1.0 if over is None else max(self.joint_growth, over.surface)

    @property
    def most_loads(self) -> dict[str, float]:
        """The largest ratios by which a demand grows over a landing and over the stiffness of
        links.
        """
        over = {"landing": self.landing, "links": self.sharing}
        return {what: x.largest_load for what, x in over.items() if x is not None}

    def __repr__(self) -> str:
        """The row in brief: <E landing: fails, factor 1.15 ± 1.8 %, 195,000 psi at z = 6.26 in>."""
        parts = [self.outcome if self.max_von_mises else f"{self.outcome}, {self.verdict}"]
        if self.max_von_mises and self.location is not None:
            error = 100.0 * (self.error_estimate or 0.0) / self.max_von_mises
            known = self.max_von_mises_interval is None and self.maximum.bounded
            within = f" ± {error:.2g} %" * known
            if self.safety_factor is not None:
                parts.append(f"factor {_brief(self.safety_factor)}{within}")
            place = f"{self.places.governing} " if self.places else ""
            stress, z = _brief(self.max_von_mises), _brief(self.location[2])
            parts.append(f"{stress} {self.units.stress} at {place}z = {z} {self.units.length}")
        return f"<{self.pin} {self.case}: {', '.join(parts)}>"

    @property
    def pin(self) -> str:
        """The name of the pin."""
        return self.maximum.pin

    @property
    def case(self) -> str:
        """The name of the case."""
        return self.maximum.case

    @property
    def model(self) -> str:
        """The model that gave the maximum."""
        return self.maximum.model

    @property
    def why(self) -> str:
        """The model that was used, and the reason."""
        return self.maximum.why

    @property
    def verdict(self) -> str:
        """The verdict on the accuracy of the maximum."""
        return self.maximum.verdict

    @property
    def note(self) -> str:
        """A sentence on the verdict."""
        return self.maximum.note

    @property
    def max_von_mises(self) -> float | None:
        """The largest von Mises stress of surface and section, outside the excluded zones."""
        return self.maximum.max_von_mises

    @property
    def error_estimate(self) -> float | None:
        """The error of the maximum, as a stress."""
        return self.maximum.error_estimate

    @property
    def max_von_mises_interval(self) -> tuple[float, float] | None:
        """The maximum over half and twice the distance excluded at a singularity that governs."""
        return self.maximum.interval

    @property
    def error_parts(self) -> dict[str, float]:
        """The stresses whose sum is the error, by source: mesh, time, ..."""
        return {} if self.maximum.parts is None else asdict(self.maximum.parts)

    @property
    def location(self) -> tuple[float, float, float] | None:
        """The point (x, y, z) of the maximum in the pin's own axes; None without stress."""
        return self.maximum.location if self.maximum.max_von_mises else None

    @property
    def time(self) -> float | None:
        """The governing instant; None without a motion or a maximum."""
        return self.maximum.time if self.location else None

    @property
    def singular_at(self) -> tuple[SingularZone, ...]:
        """The singularities of stress; where one governs (`singular`), all are excluded."""
        return self.maximum.singular_at

    @property
    def places(self) -> Places | None:
        """The stress of surface, section and contact; None where the model has none."""
        return self.maximum.places

    @property
    def history(self) -> tuple[Refinement, ...]:
        """The meshes that were solved."""
        return self.maximum.history

    @property
    def dofs(self) -> int:
        """The number of unknowns of the finest mesh."""
        return self.maximum.dofs

    @property
    def seconds(self) -> float:
        """The solution time of all meshes, s."""
        return self.maximum.seconds

    @property
    def safety_factor(self) -> float | None:
        """The safety factor against yield; None without a yield strength or a stress."""
        return self.judgement.safety_factor

    @property
    def safety_factor_interval(self) -> tuple[float, float | None] | None:
        """The safety factors over the interval of the maximum; the upper one is None if it has no
        bound.
        """
        return self.judgement.interval

    @property
    def yields(self) -> bool | None:
        """Whether the maximum exceeds the yield strength."""
        return self.judgement.yields

    @property
    def required(self) -> float | None:
        """The required safety factor; None where none is required."""
        return self.judgement.required

    @property
    def decided(self) -> bool | None:
        """Whether the pin as described meets the required factor, or if none is required does not
        yield; None where the error leaves that open.
        """
        return self.judgement.decided

    @property
    def minor(self) -> bool:
        """Whether another case governs the pin by far, so that this one was only decided."""
        return MINOR_CASE in self.maximum.reasons

    @property
    def as_described(self) -> str:
        """The outcome for a pin that is exactly as its study describes it (assess.judgement)."""
        return self.judgement.outcome

    @property
    def outcome(self) -> str:
        """The outcome: whether the pin meets its required factor, or depends on what is open."""
        described = self.as_described
        return DEPENDS if described in (SAFE, BELOW_YIELD) and self.depends_on else described

    @property
    def hand_checks(self) -> tuple[Margin, ...]:
        """The hand checks of nominal stress against yield, each at all of its places."""
        return tuple(margin for margin in self.margins if margin.listed_by_hand)

    @property
    def yield_strength(self) -> float | None:
        """The yield strength of the material; None if it has none, or the row has no stress."""
        if self.safety_factor is None or not self.max_von_mises:
            return None
        return self.safety_factor * self.max_von_mises

    @property
    def meets_required(self) -> bool | None:
        """Whether the row is safe over all that is known to be uncertain.

        None where no factor is required, or the error leaves it open.
        """
        if self.required is None:
            return None
        return False if self.decided and self.depends_on else self.decided

    @property
    def dimension_of(self) -> dict[str, str]:
        """The dimension of the position (pinbase.records.in_units)."""
        return shown_position(self.position_unit)


def _brief(value: float) -> str:
    """Return a number with four digits, and commas at thousands."""
    rounded = float(f"{value:.4g}")
    return f"{rounded:,.10g}" if 1e-4 <= abs(rounded) < 1e9 else f"{rounded:.4g}"

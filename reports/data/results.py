"""Results of a run, from which all reports are made.

They are computed once, in SI; `Results.in_units` converts them to the units of a study, from which
tables and pages are written.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Literal, Self

from assess.fatigue.records import PointFatigue, PointHistory
from assess.margin import Margin, PinMargin
from assess.opinion.opinions import Opinion
from assess.opinion.records import BeamCheck
from assess.plastic.records import LimitLoad
from assess.strength.bending_arms import BendingArms
from fea.core.peak import Refinement, SingularZone
from fea.core.places import Places
from fea.support.records import JointResult
from pinbase.dimensions import (
    Floats,
    Force,
    Forces,
    Length,
    Moments,
    Point,
    Stress,
    Stresses,
    Time,
    Times,
    Velocities,
    Velocity,
)
from reports.data.changes import Remedy
from reports.data.drop import DropPeak, DropRecord
from reports.data.fields import BandLoad, Field, Still, Volume
from reports.data.in_units import Unit, in_units
from reports.data.mechanics import (
    Dimensioned,
    DriveEffort,
    DrivePosition,
    DriveTable,
    Extremes,
    GuideForces,
    LegTable,
    LinkageMotion,
    MotionCheck,
    PeakReaction,
    PitchCurve,
    PointPath,
    PowerLedger,
    PublishedValue,
    ReactionTable,
    shown_position,
)
from reports.data.sensitivities import PinSensitivities, Sensitivity
from reports.data.surface import Surface

__all__ = [
    "BandLoad",
    "BeamCheck",
    "Dependence",
    "Dimensioned",
    "DriveEffort",
    "DriveTable",
    "DropPeak",
    "DropRecord",
    "Extremes",
    "Fatigue",
    "Field",
    "Floats",
    "GoverningLoad",
    "GuideForces",
    "LandingRange",
    "LegTable",
    "LinkageMotion",
    "MotionCheck",
    "PeakReaction",
    "PinResult",
    "PinSensitivities",
    "PinShape",
    "PitchCurve",
    "PointPath",
    "PowerLedger",
    "Provenance",
    "PublishedValue",
    "ReactionTable",
    "Refinement",
    "Remedy",
    "Results",
    "Sensitivity",
    "SingularZone",
    "Still",
    "Surface",
    "TitleBlock",
    "Units",
    "Volume",
]  # fmt: skip


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
    """A value given as a range or seldom known that changes the outcome of a row.

    what: "clearance", "impulse time", "beneath". value: in words where it is not a number
    ("guided").
    over: the owner of the range, or "beneath" for the stress beneath contact as the study has it;
    for that stress over a range, `value` is what changes ("clearance").
    factor: of safety at that value.
    given, at, flips_at: the study's value, one at which the outcome differs, and the interpolated
    one at which it changes, of `dimension`; None where it is not a number.
    reach: depth below pressed cells at which the stress exceeds the permitted one.
    """

    what: str
    value: str
    over: Literal["joint", "landing", "beneath"]
    factor: float
    given: Annotated[float, "own"] | None = None
    at: Annotated[float, "own"] | None = None
    flips_at: Annotated[float, "own"] | None = None
    dimension: str = "1"
    reach: Length | None = None

    @property
    def instead(self) -> dict[str, str]:
        return {"own": self.dimension}


@dataclass(frozen=True)
class PinResult:
    """The result of one pin in one case; numbers are None for `rigid` and `failed`.

    time: None without a motion. location: x, y, z in the pin's own axes.
    decided: whether the maximum with its error stays below what the `required` factor permits (1
    where none is required), for the pin as described; None where that is open.
    depends_on: values within the study's ranges that change that outcome.
    held: the supports of the pin, in words.
    left_out: given forces that were not applied because their band is clamped.
    published_*: the publication's value, in the study's units.
    position_unit: as in ReactionTable. why: which model answered and why it was sufficient.
    singular_at: stress singularities. If one governs (verdict `singular`), maximum, factor and
    history exclude all of them; the intervals are those over half and twice the excluded distance,
    and error_estimate reaches both ends.
    error_parts: stresses by source of error (mesh, time, ..). loads: at the governing instant.
    joint: contact with the lugs at that instant, if lugs support the pin.
    places: surface, section and contact; the maximum is the larger of the first two; None where the
    model has none.
    second_opinion: of CalculiX, if any. limit_load: past yield, if requested.
    """

    pin: str
    case: str
    model: str
    verdict: str
    note: str
    max_von_mises: Stress | None
    error_estimate: Stress | None
    location: Point | None
    time: Time | None
    position: DrivePosition | None
    safety_factor: float | None
    yields: bool | None
    decided: bool | None
    dofs: int
    seconds: float
    history: tuple[Refinement, ...]
    held: str
    left_out: tuple[str, ...] = ()
    published_max_von_mises: float | None = None
    published_safety_factor: float | None = None
    why: str = ""
    singular_at: tuple[SingularZone, ...] = ()
    margins: tuple[Margin, ...] = ()
    max_von_mises_interval: tuple[Stress, Stress] | None = None
    safety_factor_interval: tuple[float, float | None] | None = None
    error_parts: Mapping[str, Stress] = field(default_factory=dict)
    loads: tuple[GoverningLoad, ...] = ()
    position_unit: str = ""
    joint: JointResult | None = None
    second_opinion: Opinion | None = None
    limit_load: LimitLoad | None = None
    required: float | None = None
    depends_on: tuple[Dependence, ...] = ()
    places: Places | None = None

    @property
    def hand_checks(self) -> tuple[Margin, ...]:
        """The nominal stresses by hand against yield, each at all of its places."""
        return tuple(margin for margin in self.margins if margin.listed_by_hand)

    @property
    def yield_strength(self) -> float | None:
        """The yield strength of the material; None where it has none, or the row has no stress."""
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
    def instead(self) -> dict[str, str]:
        return shown_position(self.position_unit)


@dataclass(frozen=True)
class LandingRange:
    """The results of one pin over the ranges of a landing's impulse, at P points.

    impulse_time, velocity_change, force, max_von_mises: (P,). pulses: (P,).
    safety_factor: (P,), None without a yield strength.
    nominal, nominal_pulse: of the case itself. verdict: of the case, valid for all points.
    spread: for a `singular` verdict the ends of the interval of the factor, over the factor.
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


@dataclass(frozen=True)
class CutShape:
    """The shape of a cut for drawing; its name is, for instance, "hole 1".

    z: its ends; of a hole its middle, twice. size: diameter or width; of a flat its distance from
    the axis. offset: of a passage from the axis. depth: None through the pin and for flats.
    angle: from x, degrees. lines: points (z, x) of edges in the view from y, and whether hidden.
    notches: (z, x) of two opposite corners of each piece cut from the silhouette.
    """

    name: str
    z: tuple[Length, Length]
    size: Length
    offset: Length
    depth: Length | None
    angle: float
    lines: tuple[tuple[tuple[tuple[Length, Length], ...], bool], ...]
    notches: tuple[tuple[Length, Length, Length, Length], ...]


@dataclass(frozen=True)
class PinShape:
    """The profile of a pin for drawing.

    segments: (length, diameter, bore, label, kind) in order; kind is "band", "held" or "plain".
    weight: None without a density.
    far_ends: diameter and bore at the segments' far ends, where any is a cone.
    solids: the ranges of z of local solids about cuts.
    """

    pin: str
    segments: tuple[tuple[Length, Length, Length, str, str], ...]
    material: str
    weight: Force | None
    far_ends: tuple[tuple[Length, Length], ...] = ()
    cuts: tuple[CutShape, ...] = ()
    solids: tuple[tuple[Length, Length], ...] = ()


@dataclass(frozen=True)
class Provenance:
    """The source of a number of the study: given, derived, fitted or assumed.

    value: as the study writes it, in the study's units where it has none.
    """

    key: str
    kind: str
    note: str
    value: str = ""


@dataclass(frozen=True)
class Fatigue:
    """The fatigue under a spectrum that states how often each case occurs per `unit`.

    points: the worst first. probability: of failure, None for that of the S-N data.
    life: for which pins are designed. left_out: sentences on what was not assessed.
    not_decided: by pin, the reason why its damage is not known although its material has the data;
    its points, if any, have at least their damage.
    """

    unit: str
    occurrences: dict[str, float]
    method: str
    probability: float | None
    life: float | None
    points: tuple[PointFatigue, ...]
    left_out: tuple[str, ...] = ()
    not_decided: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class TitleBlock:
    """The title block of the study's report; empty texts are filled in by hand. date: ISO 8601."""

    revision: str = ""
    date: str = ""
    prepared: str = ""
    checked: str = ""
    approved: str = ""


@dataclass(frozen=True)
class Results:
    """All results of a run, without the fields inside pins (those are written pin by pin)."""

    title: str
    study: str
    study_sha256: str
    units: Units
    required_safety_factor: float | None
    tolerance: float
    pins: tuple[PinResult, ...]
    shapes: tuple[PinShape, ...] = ()
    reactions: tuple[ReactionTable, ...] = ()
    drive: tuple[DriveTable, ...] = ()
    motion: tuple[LinkageMotion, ...] = ()
    beam_check: BeamCheck | None = None
    motion_check: MotionCheck | None = None
    published: tuple[PublishedValue, ...] = ()
    legs: tuple[LegTable, ...] = ()
    landing: tuple[LandingRange, ...] = ()
    drops: tuple[DropRecord, ...] = ()
    surfaces: tuple[Surface, ...] = ()
    changes: tuple[Remedy, ...] = ()
    sensitivities: tuple[PinSensitivities, ...] = ()
    margins: tuple[PinMargin, ...] = ()
    arms: tuple[BendingArms, ...] = ()
    histories: tuple[PointHistory, ...] = ()
    fatigue: Fatigue | None = None
    provenance: tuple[Provenance, ...] = ()
    published_source: str = ""
    assumptions: tuple[str, ...] = ()
    versions: dict[str, str] = field(default_factory=dict)
    study_text: str = ""
    inputs: dict[str, str] = field(default_factory=dict)
    title_block: TitleBlock = field(default_factory=TitleBlock)

    def __getitem__(self, row: tuple[str, str]) -> PinResult:
        """Return the result of a pin in a case: results["E", "landing"].

        Raises: KeyError.
        """
        matches = [p for p in self.pins if (p.pin, p.case) == row]
        if not matches:
            known_rows = ", ".join(f'["{p.pin}", "{p.case}"]' for p in self.pins)
            raise KeyError(f"no row {row!r}; there are {known_rows}")
        return matches[0]

    def in_units(self, units: Units, unit: Unit) -> Self:
        """Return the same results in other units.

        unit: their values in SI, by dimension.
        """
        return in_units(replace(self, units=units), unit)

"""What a run found: all that reports are made from. Made once, in SI; `Results.in_units` gives the
same in the units of a study, from which tables and pages are written.
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
    """Names of the units of results."""

    length: str
    force: str
    stress: str
    time: str


SI = Units("m", "N", "Pa", "s")


@dataclass(frozen=True)
class GoverningLoad:
    """What a body does to the pin at a connection at the governing instant: force and moment (3,),
    world axes.
    """

    connection: str
    body: str
    force: Forces
    moment: Moments


@dataclass(frozen=True)
class Dependence:
    """Something that the study gives as a range, or that is seldom known, and that changes the
    outcome of a row.

    what: "clearance", "impulse time", "beneath"; value: in words where it is not a number
    ("guided"). over: whose range, or "beneath" of what lies beneath contact as the study has it;
    of what lies beneath over a range, value is what changes ("clearance"). factor: of safety
    there. given, at, flips_at: as the study has it, where the outcome is another, and between them
    where it changes (interpolated), of `dimension`; None where it is not a number. reach: how far
    from pressed cells stress beneath contact exceeds what is permitted.
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
    """One pin in one case. Numbers are None for `rigid` and `failed`, time without a motion.

    decided: whether the maximum with its error stays below what the `required` factor permits (1
    where none is required), as the study describes the pin; None where that is open. depends_on:
    what within its range changes that. location: x, y, z in the pin's own axes. held: the supports
    of the pin, in words. left_out: given forces that were not applied because their band is
    clamped. published_*: the publication's value, in the study's units. position_unit: as a
    ReactionTable's.
    why: which model answered and why it was enough. singular_at: stress singularities; where one
    governs (verdict `singular`) maximum and factor are those outside all of them, as are those of
    the history; the intervals are those over half and twice the excluded distance, and
    error_estimate reaches both ends. error_parts: stresses by what they come from (mesh, time,
    ..). loads: at the governing instant. joint: contact with the lugs there, if that holds the pin.
    places: surface, section and contact, of which the maximum is the larger of the first two; None
    where the model has none. second_opinion: that of CalculiX, if there is one. limit_load: past
    yield, if requested.
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
        """Of the material; None where it has none, or the row has no stress."""
        if self.safety_factor is None or not self.max_von_mises:
            return None
        return self.safety_factor * self.max_von_mises

    @property
    def meets_required(self) -> bool | None:
        """True exactly where the row is safe over all that is known to be uncertain; None where
        nothing is required, or the error leaves it open.
        """
        if self.required is None:
            return None
        return False if self.decided and self.depends_on else self.decided

    @property
    def instead(self) -> dict[str, str]:
        return shown_position(self.position_unit)


@dataclass(frozen=True)
class LandingRange:
    """One pin over the ranges of a landing's impulse, at (P,) points each: impulse time, velocity
    change, pulse, force, maximum von Mises and factor of safety (None without a yield strength).
    nominal, nominal_pulse: those of the case itself. verdict: of the case, which holds for all
    points. spread: of a `singular` one the ends of its interval of the factor, over the factor.
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
    """A cut by its name, "hole 1", for drawing. z: its ends, of a hole its middle twice; size:
    diameter or width, of a flat its distance from the axis; offset: of a passage from the axis;
    depth: None through the pin and of flats; angle: from x, degrees; lines: points (z, x) of edges
    in the view from y, and whether they are hidden; notches: (z, x) of two opposite corners of what
    is cut from the silhouette.
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
    """A pin's profile for drawing: segments (length, diameter, bore, label, kind) in order, where
    kind is "band", "held" or "plain"; its weight (None without a density). far_ends: diameter and
    bore at the segments' far ends, where any is a cone. solids: between which z local solids are
    about cuts.
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
    """Where a number of the study comes from: given, derived, fitted or assumed. value: as the
    study writes it, in the study's units where it has none.
    """

    key: str
    kind: str
    note: str
    value: str = ""


@dataclass(frozen=True)
class Fatigue:
    """Fatigue under a spectrum, by how often each case occurs per `unit`. points: the worst first.
    probability: of failure, None for that of the S-N data. life: for which pins are designed.
    left_out: what was not assessed, in sentences. not_decided: by pin, why its damage is not known,
    though its material has the data; points of it, if there are any, have at least their damage.
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
    """What the study says of its report; empty texts are filled in by hand. date: ISO 8601."""

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
        """A pin in a case: results["E", "landing"]. Raises: KeyError."""
        found = [p for p in self.pins if (p.pin, p.case) == row]
        if not found:
            there = ", ".join(f'["{p.pin}", "{p.case}"]' for p in self.pins)
            raise KeyError(f"no row {row!r}; there are {there}")
        return found[0]

    def in_units(self, units: Units, unit: Unit) -> Self:
        """The same in other units; unit: their values in SI, by dimension."""
        return in_units(replace(self, units=units), unit)

"""Results of a run, from which all reports are made.

They are computed once, in SI; `Results.in_units` converts them to the units of a study, from which
tables and pages are written.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

from assess.fatigue.records import PointFatigue, PointHistory
from assess.margin import PinMargin
from assess.opinion.records import BeamCheck
from assess.requirement import StatedRequirement
from assess.strength.bending_arms import BendingArms
from pinbase.dimensions import Force, Length
from pinbase.records import Unit, in_units
from reports.data.changes import Remedy
from reports.data.drop import DropRecord
from reports.data.mechanics import DriveTable, PublishedValue, ReactionTable
from reports.data.motion import BodyMotion, LinkageMotion, MotionCheck, SpacePosture
from reports.data.row import LandingRange, PinResult, Units
from reports.data.sensitivities import PinSensitivities
from reports.data.skeleton import Skeleton, planar_skeleton
from reports.data.surface import Surface
from reports.data.wear import BandWear


@dataclass(frozen=True)
class CutShape:
    """The shape of a cut for drawing; its name is, for instance, "hole 1".

    z: its ends; of a hole its middle, twice. size: diameter or width; of a flat its distance from
    the axis. offset: of a passage or hole from the axis. depth: None through the pin and for flats.
    angle: from x, degrees. lines: points (z, x) of edges in the view from y, and whether hidden.
    notches: (z, x) of two opposite corners of each piece cut from the silhouette. tilt: of a hole
    towards z, degrees.
    """

    name: str
    z: tuple[Length, Length]
    size: Length
    offset: Length
    depth: Length | None
    angle: float
    lines: tuple[tuple[tuple[tuple[Length, Length], ...], bool], ...]
    notches: tuple[tuple[Length, Length, Length, Length], ...]
    tilt: float = 0.0


@dataclass(frozen=True)
class ShankSketch:
    """The outline of a lug beyond its eye; names as in fea.support.lugs.lug.Shank."""

    shape: str
    width: Length
    length: Length
    end: Length


@dataclass(frozen=True)
class LugSketch:
    """A lug about a band of a pin, as it is drawn: from z to z, with its outer diameter.

    clearance: of the diameters. edge_radius: of the bore's edges.
    bushing: its thickness, 0 without one; interference: with which it was pressed in.
    """

    connection: str
    z: tuple[Length, Length]
    outer_diameter: Length
    clearance: Length
    material: str
    edge_radius: Length = 0.0
    bushing: Length = 0.0
    interference: Length = 0.0
    shank: ShankSketch | None = None


@dataclass(frozen=True)
class PinShape:
    """The profile of a pin for drawing.

    segments: (length, diameter, bore, label, kind) in order; kind is "band", "held" or "plain".
    weight: None without a density.
    far_ends: diameter and bore at the segments' far ends, where any is a cone.
    solids: the ranges of z of local solids about cuts.
    lugs: that support the pin, in the order of z.
    """

    pin: str
    segments: tuple[tuple[Length, Length, Length, str, str], ...]
    material: str
    weight: Force | None
    far_ends: tuple[tuple[Length, Length], ...] = ()
    cuts: tuple[CutShape, ...] = ()
    solids: tuple[tuple[Length, Length], ...] = ()
    lugs: tuple[LugSketch, ...] = ()


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


class NoSuchRow(KeyError):
    """A pin or case without results; the message says which there are."""

    def __str__(self) -> str:
        return str(self.args[0])  # that of KeyError is in quotes


@dataclass(frozen=True)
class Results:
    """All results of a run, without the fields inside pins (those are written pin by pin).

    pins: the rows. stated: the requirements of [[require]].
    space, space_postures: motions of linkages in space, and how well they transmit.
    spectrum_margins: of checks over all cases of a pin, as fatigue.
    """

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
    space: tuple[Skeleton, ...] = ()
    space_postures: tuple[SpacePosture, ...] = ()
    beam_check: BeamCheck | None = None
    motion_check: MotionCheck | None = None
    published: tuple[PublishedValue, ...] = ()
    bodies: tuple[BodyMotion, ...] = ()
    drops: tuple[DropRecord, ...] = ()
    wear: tuple[BandWear, ...] = ()
    surfaces: tuple[Surface, ...] = ()
    changes: tuple[Remedy, ...] = ()
    sensitivities: tuple[PinSensitivities, ...] = ()
    stated: tuple[StatedRequirement, ...] = ()
    spectrum_margins: tuple[PinMargin, ...] = ()
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
            raise NoSuchRow(self._missing(row))
        return matches[0]

    def __contains__(self, row: object) -> bool:
        """Return whether a row, or a pin in a case, is there: ("E", "landing") in results."""
        pair = (row.pin, row.case) if isinstance(row, PinResult) else row
        return any((p.pin, p.case) == pair for p in self.pins)

    def _missing(self, row: object) -> str:
        """Return which row is missing, and the pins and cases that there are."""
        pins = ", ".join(dict.fromkeys(p.pin for p in self.pins))
        if not isinstance(row, tuple) or len(row) != 2:
            return f"results[{row!r}]: give a pin and a case; the pins are {pins}"
        cases = ", ".join(p.case for p in self.pins if p.pin == row[0])
        if cases:
            return f"pin {row[0]} has no case {row[1]!r}; its cases are {cases}"
        return f"no pin {row[0]!r}; the pins are {pins}"

    @property
    def skeletons(self) -> tuple[Skeleton, ...]:
        """The parts of every motion that are drawn, planar or in space."""
        return (*map(planar_skeleton, self.motion), *self.space)

    @property
    def postures(self) -> tuple[LinkageMotion | SpacePosture, ...]:
        """The transmission of every linkage, planar or in space."""
        return (*self.motion, *self.space_postures)

    @property
    def margins(self) -> tuple[PinMargin, ...]:
        """The worst place of each check of every row, and the checks over all cases."""
        of_rows = (PinMargin(p.pin, p.case, margin) for p in self.pins for margin in p.worst)
        return (*of_rows, *self.spectrum_margins)

    @property
    def arms(self) -> tuple[BendingArms, ...]:
        """The arms of the bending moments of the rows that have them."""
        return tuple(p.arms for p in self.pins if p.arms)

    @property
    def landing(self) -> tuple[LandingRange, ...]:
        """The results over the ranges of a landing's impulse of the rows that have them."""
        return tuple(p.landing for p in self.pins if p.landing)

    def in_units(self, units: Units, unit: Unit) -> Self:
        """Return the same results in other units.

        unit: their values in SI, by dimension.
        """
        pins = tuple(replace(pin, units=units) for pin in self.pins)
        return in_units(replace(self, units=units, pins=pins), unit)

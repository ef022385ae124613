"""Results of a run, from which all reports are made.

Results are computed once, in SI units; `Results.in_units` converts them to the units of a study for
tables and pages.
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
    """The shape of a cut for drawing.

    name: "hole 1", for instance.
    z: the two ends; for a hole its middle, twice.
    size: diameter or width; for a flat its distance from the axis.
    offset: of a passage or hole from the axis.
    depth: None for a cut through the pin and for flats.
    angle: from x, degrees.
    lines: points (z, x) of edges in the view from y, and whether hidden.
    notches: (z, x) of two opposite corners of each piece cut from the silhouette.
    tilt: of a hole towards z, degrees.
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
    """The outline of a lug beyond its eye; fields as in fea.support.lugs.lug.Shank."""

    shape: str
    width: Length
    length: Length
    end: Length


@dataclass(frozen=True)
class LugSketch:
    """A lug on a band of a pin, for drawing.

    z: the two ends.
    clearance: the difference of the diameters.
    edge_radius: of the bore's edges.
    bushing: thickness, 0 without a bushing.
    interference: with which the bushing was pressed in.
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
    far_ends: diameter and bore at the segments' far ends, if any segment is a cone.
    solids: the ranges of z of local solids about cuts.
    lugs: the lugs that support the pin, in the order of z.
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
    """The source of a number of the study.

    kind: given, derived, fitted or assumed.
    value: as the study writes it; in the study's units where it has no unit of its own.
    """

    key: str
    kind: str
    note: str
    value: str = ""


@dataclass(frozen=True)
class Fatigue:
    """The fatigue under a spectrum that states how often each case occurs per `unit`.

    points: the worst first.
    probability: of failure; None for that of the S-N data.
    life: the life for which pins are designed.
    left_out: sentences on what was not assessed.
    not_decided: by pin, the reason why its damage is not known although its material has the data;
    its points, if any, have at least the damage listed.
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
    """A pin or case without results; the message lists those with results."""

    def __str__(self) -> str:
        return str(self.args[0])  # KeyError would put the message in quotes


@dataclass(frozen=True)
class Results:
    """All results of a run except the fields inside pins, which are written pin by pin.

    pins: the rows.
    stated: the requirements of [[require]].
    space, space_postures: the motions of linkages in space, and their postures.
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

        Raises: KeyError if there is none.
        """
        matches = [p for p in self.pins if (p.pin, p.case) == row]
        if not matches:
            raise NoSuchRow(self._missing(row))
        return matches[0]

    def __contains__(self, row: object) -> bool:
        """Return whether the results contain a row, or a pin in a case: ("E", "landing") in
        results.
        """
        pair = (row.pin, row.case) if isinstance(row, PinResult) else row
        return any((p.pin, p.case) == pair for p in self.pins)

    def _missing(self, row: object) -> str:
        """Return a message on the missing row, with the pins and cases that have results."""
        pins = ", ".join(dict.fromkeys(p.pin for p in self.pins))
        if not isinstance(row, tuple) or len(row) != 2:
            return f"results[{row!r}]: give a pin and a case; the pins are {pins}"
        cases = ", ".join(p.case for p in self.pins if p.pin == row[0])
        if cases:
            return f"pin {row[0]} has no case {row[1]!r}; its cases are {cases}"
        return f"no pin {row[0]!r}; the pins are {pins}"

    @property
    def skeletons(self) -> tuple[Skeleton, ...]:
        """The parts to draw of every motion, planar or in space."""
        return (*map(planar_skeleton, self.motion), *self.space)

    @property
    def postures(self) -> tuple[LinkageMotion | SpacePosture, ...]:
        """The postures of every linkage, planar or in space."""
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
        """The landing ranges of the rows that have one."""
        return tuple(p.landing for p in self.pins if p.landing)

    def in_units(self, units: Units, unit: Unit) -> Self:
        """Return the same results in other units.

        unit: the SI value of each unit, by dimension.
        """
        pins = tuple(replace(pin, units=units) for pin in self.pins)
        return in_units(replace(self, units=units, pins=pins), unit)

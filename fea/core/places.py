"""The places where a pin's stress is read and judged: surface, section and contact.

surface    The largest von Mises stress over the pin's surface, without the area on which edges of
           lugs press: fillets, grooves, gaps, the free side of bands. Judged by yield and in
           fatigue.
section    sqrt(s^2 + 3 t^2) by axial force, bending, shear and torsion, the largest over all
           sections. Judged by yield.
contact    Stress that only contact causes: at the edges of lugs, and beneath the pressure.

A row's number is the larger of surface and section; for a pin with a hardened surface it is that of
the part with the least factor (fea.core.hardened). A row is safe only if the stress beneath
contact, farther than BENEATH_DISTANCE from it, meets the required factor, too.

Source: ASME BPVC VIII-2, part 5, for judging kinds of stress apart (membrane, bending, peak;
bearing by itself).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from pinbase.dimensions import Force, Length, Moment, Point, Stress

Place = Literal["surface", "section", "core"]

# Distance from every pressed cell, in diameters, beyond which stress counts as beneath contact.
BENEATH_DISTANCE = 0.1


@dataclass(frozen=True)
class SurfacePlace:
    """The largest stress of the surface with its error.

    location: (x, y, z).
    time: s.
    verdict: as in fea.core.peak.Maximum.
    strength: for a pin with a hardened surface, the yield strength there; None for others.
    """

    max_von_mises: Stress
    error_estimate: Stress
    verdict: str
    location: Point
    time: float | None = None
    strength: Stress | None = None


@dataclass(frozen=True)
class SectionPlace:
    """The largest stress of a section with its error, its z, and the section forces there.

    Forces and moments are magnitudes, except the axial force.
    plastic_utilisation: fraction used of the resistance of the fully plastic section
    (assess.plastic.hinge); None without a yield strength.
    course: pairs of z and the largest stress of the section there, along the pin at that instant.
    strength: as in SurfacePlace.
    """

    max_von_mises: Stress
    error_estimate: Stress
    verdict: str
    z: Length
    time: float | None
    axial_force: Force
    shear_force: Force
    bending_moment: Moment
    torque: Moment
    plastic_utilisation: float | None = None
    course: tuple[tuple[Length, Stress], ...] = ()
    strength: Stress | None = None


@dataclass(frozen=True)
class ContactEdge:
    """The edge of a lug, at the start or the end of its band, and the pressure towards it.

    K, exponent: the pressure is K distance^-exponent.
    yield_distance: distance at which this pressure falls to the yield strength.
    max_pressure, max_von_mises: of the pin at a rounded edge; None at a sharp edge, where pressure
    is unbounded.
    error_estimate: of the largest pressure; None at a sharp edge.
    """

    band: str
    end: Literal["start", "end"]
    K: Annotated[float, "strength"]
    exponent: float
    yield_distance: Length | None
    max_pressure: Stress | None
    max_von_mises: Stress | None
    error_estimate: Stress | None

    @property
    def dimension_of(self) -> dict[str, str]:
        """The dimension of K, which depends on the exponent (pinbase.records.in_units)."""
        return {"strength": f"stress length^{self.exponent!r}"}


PressedCell = tuple[Length, Length, float, float]  # z from and to, angle from and to in degrees


@dataclass(frozen=True)
class BandPressure:
    """A band under its lug.

    mean_pressure: force over diameter and length.
    bearing_share: mean pressure over the bearing strength; None without a bearing strength.
    pressed: the cells with pressure.
    """

    name: str
    mean_pressure: Stress
    bearing_share: float | None
    pressed: tuple[PressedCell, ...]


@dataclass(frozen=True)
class CaseCrushing:
    """The largest von Mises stress in the core by the pressure on a band alone, as in a half-plane
    (fea.support.contact.case_crushing).

    band, z: location of the stress.
    depth: of the stress, beneath the surface.
    max_pressure: largest pressure on the ring there.
    strength: yield strength of the core.
    """

    band: str
    z: Length
    max_von_mises: Stress
    depth: Length
    max_pressure: Stress
    strength: Stress


@dataclass(frozen=True)
class ContactPlace:
    """The stress beneath contact, the reach of high stress, and the pressures of a pin's lugs.

    beneath: largest von Mises stress farther than BENEATH_DISTANCE diameters from every pressed
    cell, with its error, location and time.
    reach: distance from pressed cells up to which stress exceeds the yield strength, at the
    governing instants; None without a strength.
    reach_required: the same for the yield strength over the required factor; None without one.
    edges, bands: at the row's instant.
    depths: pairs of a stress and the distance from pressed cells that it reaches, with decreasing
    stress and increasing distance, down to the least stress that an outcome may need.
    strength: as in SurfacePlace; in a pin with a hardened surface, `beneath` is in the core or in
    an unhardened part.
    crushing: case crushing of such a pin.
    """

    beneath: Stress
    beneath_error: Stress
    beneath_location: Point
    beneath_time: float | None
    reach: Length | None
    reach_required: Length | None
    edges: tuple[ContactEdge, ...]
    bands: tuple[BandPressure, ...]
    depths: tuple[tuple[Stress, Length], ...] = ()
    strength: Stress | None = None
    crushing: CaseCrushing | None = None

    @property
    def upper_end(self) -> float:
        """The stress beneath contact plus its error, Pa."""
        return self.beneath + self.beneath_error

    def depth(self, limit: float) -> float:
        """The distance from every pressed cell up to which stress exceeds a limit, Pa, in m."""
        return max((depth for stress, depth in self.depths if stress > limit), default=0.0)


@dataclass(frozen=True)
class PartPlace:
    """The largest stress of a part of a pin with a hardened surface; a part has one yield strength.

    part: the case, the core, or an unhardened part.
    place: "surface" for a stress of the field, "section" for one of a section.
    depth: of the stress, beneath the hardened surface; None for an unhardened part.
    """

    part: Literal["case", "core", "unhardened"]
    strength: Stress
    place: Literal["surface", "section"]
    max_von_mises: Stress
    error_estimate: Stress
    location: Point
    depth: Length | None = None
    time: float | None = None

    @property
    def safety_factor(self) -> float:
        """Yield strength over the largest stress."""
        return self.strength / self.max_von_mises if self.max_von_mises else math.inf


@dataclass(frozen=True)
class Places:
    """The three places of a pin in a case, each at its own governing instant.

    section: None for a body that is no beam.
    contact: None where no lugs press on the pin.
    hardened: the parts of a pin with a hardened surface, the one with the least factor first.
    """

    governs: Place
    surface: SurfacePlace
    section: SectionPlace | None = None
    contact: ContactPlace | None = None
    hardened: tuple[PartPlace, ...] = ()

    @property
    def governing(self) -> str:
        """The place that governs; for a pin with a hardened surface its case or core if that part
        governs.
        """
        part = self.hardened[0].part if self.hardened else "unhardened"
        return self.governs if part == "unhardened" else part

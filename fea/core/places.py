"""Where a pin's stress is read, and by what each place is judged: surface, section and contact.

surface    The largest von Mises stress over the pin's surface but for what lugs press on at their
           edges: fillets, grooves, gaps, the free side of bands. Judged by yield, and in fatigue.
section    sqrt(s^2 + 3 t^2) by axial force, bending, shear and torsion, the largest over all
           sections. Judged by yield.
contact    What only contact has: the field of a lug's edge, and what lies beneath the pressure.

A row's number is the larger of surface and section; of a pin with a hardened surface that of the
part with the least factor (fea.core.hardened). It is safe only if what lies beneath the
contact, farther than BENEATH_DISTANCE from it, meets the required factor too.

Source: ASME BPVC VIII-2, part 5, for judging kinds of stress apart (membrane, bending, peak;
bearing by itself).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from pinbase.dimensions import Force, Length, Moment, Point, Stress

Place = Literal["surface", "section", "core"]

# Of the diameter: farther from every pressed cell a point lies beneath the contact
BENEATH_DISTANCE = 0.1


@dataclass(frozen=True)
class SurfacePlace:
    """The largest stress of the surface with its error.

    location: (x, y, z).
    time: s.
    verdict: as that of fea.core.peak.Maximum.
    strength: yield strength there, of a pin with a hardened surface; None elsewhere.
    """

    max_von_mises: Stress
    error_estimate: Stress
    verdict: str
    location: Point
    time: float | None = None
    strength: Stress | None = None


@dataclass(frozen=True)
class SectionPlace:
    """The largest stress of a section with its error, its z, and the internal forces there.

    Forces and moments are positive but for the axial force.
    plastic_utilisation: the used part of what a fully plastic section carries
    (assess.plastic.hinge); None without a yield strength.
    course: pairs of z and the largest stress of the section there, along the pin at that instant.
    strength: as of SurfacePlace.
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

    K, exponent: pressure is K distance^-exponent.
    yield_distance: at which that falls to yield.
    max_pressure, max_von_mises: of the pin at a rounded edge; None at a sharp one, where pressure
    has no bound.
    error_estimate: of that pressure; None likewise.
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
    bearing_share: its part of the bearing strength, None without one.
    pressed: the cells with pressure.
    """

    name: str
    mean_pressure: Stress
    bearing_share: float | None
    pressed: tuple[PressedCell, ...]


@dataclass(frozen=True)
class CaseCrushing:
    """The largest von Mises stress in the core beneath the pressure of a band alone, as if on a
    half-space (fea.support.contact.case_crushing).

    band, z: where.
    depth: of that stress, beneath the surface.
    max_pressure: of the ring there.
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

    beneath: the largest von Mises stress farther than BENEATH_DISTANCE diameters from every pressed
    cell, with its error, where and when.
    reach: distance from pressed cells up to which stress exceeds yield, at the governing instants;
    reach_required: the same for yield over the required factor; None without one.
    edges, bands: at the row's instant.
    depths: pairs of a stress and the distance from pressed cells that it reaches, stresses falling
    and distances growing, down to the least stress for which an outcome may ask.
    strength: as of SurfacePlace; of a pin with a hardened surface `beneath` is in its core.
    crushing: of the case of such a pin.
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
        """Distance, m, from every pressed cell up to which stress exceeds a limit, Pa."""
        return max((depth for stress, depth in self.depths if stress > limit), default=0.0)


@dataclass(frozen=True)
class PartPlace:
    """The largest stress of a part of one yield strength of a pin with a hardened surface.

    part: its case, its core, or what is not hardened.
    place: whether it is of the stress field ("surface") or of a section ("section").
    depth: at which it is, beneath the hardened surface; None for what is not hardened.
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
        """The place that governs; of a pin with a hardened surface its case or core."""
        part = self.hardened[0].part if self.hardened else "unhardened"
        return self.governs if part == "unhardened" else part

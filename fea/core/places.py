"""Where a pin's stress is read, and by what each place is judged: surface, section and contact.

surface    The largest von Mises stress over the pin's surface but for what lugs press on at their
           edges: fillets, grooves, gaps, the free side of bands. Judged by yield, and in fatigue.
section    sqrt(s^2 + 3 t^2) by axial force, bending, shear and torsion, the largest over all
           sections. Judged by yield.
contact    What only contact has: the field of a lug's edge, and what lies beneath the pressure.

A row's number is the larger of surface and section. It is safe only if what lies beneath the
contact, farther than BENEATH_DISTANCE from it, meets the required factor too.

Source: ASME BPVC VIII-2, part 5, for judging kinds of stress apart (membrane, bending, peak;
bearing by itself).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pinbase.dimensions import Force, Length, Moment, Point, Stress

Place = Literal["surface", "section"]

BENEATH_DISTANCE = (
    0.1  # of the diameter: farther from every pressed cell a point lies beneath the contact
)


@dataclass(frozen=True)
class SurfacePlace:
    """The largest stress of the surface, with its error; location (x, y, z); time: s. verdict: as
    that of fea.core.peak.Maximum.
    """

    max_von_mises: Stress
    error_estimate: Stress
    verdict: str
    location: Point
    time: float | None = None


@dataclass(frozen=True)
class SectionPlace:
    """The largest stress of a section, with its error, at z; what acts there, positive but for the
    axial force. plastic_utilisation: which part of what a fully plastic section carries, None
    without a yield strength (assess.plastic.hinge).
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


@dataclass(frozen=True)
class ContactEdge:
    """The edge of a lug, at the start or the end of its band. K, exponent: of the pressure that
    rises towards it as K distance^-exponent; yield_distance: at which that falls to yield.
    max_pressure, max_von_mises: of the pin at a rounded edge, with error_estimate of the pressure;
    None at a sharp one, where pressure has no bound.
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
    def instead(self) -> dict[str, str]:
        """The dimension of K (reports.data.in_units)."""
        return {"strength": f"stress length^{self.exponent!r}"}


PressedCell = tuple[Length, Length, float, float]  # z from and to, angle from and to in degrees


@dataclass(frozen=True)
class BandPressure:
    """A band under its lug: force over diameter and length, its part of the bearing strength (None
    without one), and the cells with pressure.
    """

    name: str
    mean_pressure: Stress
    bearing_share: float | None
    pressed: tuple[PressedCell, ...]


@dataclass(frozen=True)
class ContactPlace:
    """beneath: the largest von Mises stress farther than BENEATH_DISTANCE diameters from every
    pressed cell, with its error, where and when. reach: how far from pressed cells stress exceeds
    yield, at the governing instants; reach_required: the same of yield over the required factor;
    None without one. edges, bands: at the row's instant. depths: pairs of a stress and how far
    from pressed cells it is, falling stresses and growing distances, down to the least stress for
    which an outcome may ask.
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

    @property
    def upper_end(self) -> float:
        """What lies beneath, with its error, Pa."""
        return self.beneath + self.beneath_error

    def depth(self, limit: float) -> float:
        """How far, m, from every pressed cell stress exceeds a limit, Pa."""
        return max((depth for stress, depth in self.depths if stress > limit), default=0.0)


@dataclass(frozen=True)
class Places:
    """Of a pin in a case, at its own instants. section: None of a body that is no beam; contact:
    None where no lugs press on the pin.
    """

    governs: Place
    surface: SurfacePlace
    section: SectionPlace | None = None
    contact: ContactPlace | None = None

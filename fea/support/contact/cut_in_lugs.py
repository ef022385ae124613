"""Pins with cuts in their lugs: what contact that is solved for the pin without cuts leaves out.

Contact pressures are those of the pin without its cuts. What presses on a cut's mouth is taken by
the rest of the band about it (fea.cut.lost_loads). Three things are neglected, which the error
includes:

compliance      Cuts make the pin softer, so that pressures move towards the faces of the lugs. By
                how much its bending compliance grows follows from the turns of the ends of local
                solids; by how much stress depends on it, from the variation of the lugs' stiffness,
                since a softer pin is one in stiffer lugs.
ovalisation     A hole makes the section that it crosses softer across the pin too, so that pressure
                on it moves to both sides. At most the load on its length does so, in proportion to
                its diameter over the pin's.
redistribution  What presses on a mouth comes back as pressure near it, at most about as large as
                that: stress there changes by so much, elsewhere as the part of the force that is
                lost.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fea.core.material import Material
from fea.core.peak import Reason
from fea.core.verdict import Evidence
from fea.cut.field import CutField
from fea.cut.region import zone
from fea.support.cell_pressure import CellPressure
from fea.support.contact.bending import stations
from fea.support.contact.solve_joint import JointContact
from fea.support.records import Variation
from geometry import Cut, CutPin, Pin
from pinbase.arrays import Floats

AXIAL_POINTS, ANGULAR_POINTS = 24, 720  # points of a band between the ends of a cut
STIFFNESS_VARIATION = "stiffness of the lugs"
LOG_2 = math.log(2.0)
MIN_REPORTED_LOSS = 5e-4  # of a lug's force: what is lost of it is reported


@dataclass(frozen=True)
class NeglectedCuts:
    """The effects of cuts in lugs that contact neglects.

    softer: relative increase of the pin's bending compliance by cuts.
    pressed: the largest pressure on a mouth, Pa.
    lost: the largest part of a lug's force that acts on mouths.
    moved: the largest part that may move away from holes.
    bands: those with cuts, by their names.
    """

    softer: float
    pressed: float
    lost: float
    moved: float
    bands: dict[str, str]

    @property
    def note(self) -> Reason:
        """The note about the cuts in lugs."""
        if not self.bands:
            return Reason()
        where = ", ".join(f"{cut} in lug {name}" for cut, name in self.bands.items())
        it, its = ("it", "its") if len(self.bands) == 1 else ("them", "their")
        lost = f" ({self.lost:.1%} of the force of a lug presses there)" * (
            self.lost >= MIN_REPORTED_LOSS
        )
        return Reason(
            f"; {where}: contact is that of the pin without {it}{lost}, and pressure at {its} "
            "edges is not resolved",
            ("cut-in-lug",),
        )

    def error(self, largest: float, at_cut: bool, over: tuple[Variation, ...]) -> float:
        """The error of a maximum, Pa, given the maxima of the varied joint."""
        factors = [v.max_von_mises / largest for v in over if v.what == STIFFNESS_VARIATION]
        most = max((abs(math.log(x)) for x in factors if x > 0.0), default=LOG_2)
        relative = self.softer * most / LOG_2 + max(self.lost, self.moved)
        return relative * largest + at_cut * self.pressed


def neglected(
    cut: CutPin, material: Material, contact: JointContact, pressure: CellPressure, of: CutField
) -> NeglectedCuts:
    """The neglected effects of cuts at the single instant of a contact."""
    pressed, lost, bands = 0.0, dict[int, float](), dict[str, str]()
    for name, one in cut.cuts.items():
        for band, lug in enumerate(contact.lugs):
            points, area = _mouth(cut, one, lug.connection)
            if not len(points):
                continue
            at_mouth = pressure.at(points)
            bands[name] = lug.connection
            pressed = max(pressed, float(at_mouth.max()))
            lost[band] = lost.get(band, 0.0) + float(at_mouth.sum()) * area
    ring_band, forces = contact.bands.band, contact.loads.forces[0, :, :2]
    force = {b: float(np.linalg.norm(forces[ring_band == b].sum(axis=0))) for b in lost}
    share = max((part / force[b] for b, part in lost.items() if force[b] > 0.0), default=0.0)
    softer, moved = _softer(cut, material, contact, of), _moved(cut, contact)
    return NeglectedCuts(softer, pressed, share, moved, bands)


def _moved(cut: CutPin, contact: JointContact) -> float:
    """The largest part of a lug's force that acts at a hole, times the hole's diameter over the
    pin's.
    """
    bands, most = contact.bands, 0.0
    force = np.linalg.norm(contact.loads.forces[0, :, :2], axis=1)
    low, high = bands.z - 0.5 * bands.length, bands.z + 0.5 * bands.length
    for hole in cut.holes:
        start, end = hole.opens
        overlap = np.maximum(np.minimum(high, end) - np.maximum(low, start), 0.0) / bands.length
        across = np.minimum(0.5 * hole.diameter / bands.radius, 1.0)
        for b in range(len(contact.lugs)):
            on_band = bands.band == b
            if whole := float(force[on_band].sum()):
                most = max(most, float((force * overlap * across)[on_band].sum()) / whole)
    return most


def _mouth(cut: CutPin, one: Cut, band: str) -> tuple[Floats, float]:
    """The points (P, 3), m, of a band that a cut takes away, and the area of each, m^2."""
    on = cut.profile.band(band)
    low, high = max(one.opens[0], on.z0), min(one.opens[1], on.z1)
    if low >= high:
        return np.zeros((0, 3)), 0.0
    z = low + (np.arange(AXIAL_POINTS) + 0.5) * (high - low) / AXIAL_POINTS
    angle = (np.arange(ANGULAR_POINTS) + 0.5) * 2.0 * math.pi / ANGULAR_POINTS
    angle, z = (x.ravel() for x in np.meshgrid(angle, z))
    points = np.stack([on.radius * np.cos(angle), on.radius * np.sin(angle), z], axis=1)
    point_area = (high - low) / AXIAL_POINTS * on.radius * 2.0 * math.pi / ANGULAR_POINTS
    return points[one.takes(points, on.radius)], point_area


def _softer(cut: CutPin, material: Material, contact: JointContact, of: CutField) -> float:
    """The relative increase of the pin's bending compliance by its cuts.

    It is the work of the bending moment at the cuts, where it is largest, on the turns that these
    add, over that of the whole pin; for passages at least that on the net section.
    """
    z = stations(contact.pin)
    moment = np.linalg.norm(contact.bending_moment(z)[0], axis=1)
    stiffness = np.array([_inertia(contact.pin, x) for x in z.tolist()]) * material.youngs_modulus
    whole = float(np.trapezoid(moment**2 / stiffness, z))
    turned = 0.0
    for piece in of.solution.pieces:
        turn = (piece.moved[1] - piece.moved[0])[3:5] @ piece.coefficients(contact.loads)[0]
        low, high = zone(piece.piece)
        middle = contact.bending_moment(np.array([0.5 * (low + high)]))[0, 0]
        here = moment[(z >= low) & (z <= high)].max(initial=float(np.linalg.norm(middle)))
        turned += float(here * np.linalg.norm(turn))
    along = 0.0
    for passage in cut.passages:
        area, d = math.pi * passage.diameter**2 / 4.0, passage.diameter
        gone = material.youngs_modulus * area * (passage.offset**2 + d**2 / 16.0)
        on = (z >= passage.extent[0]) & (z <= passage.extent[1])
        more = 1.0 / np.maximum(stiffness - gone, 0.1 * stiffness) - 1.0 / stiffness
        along += float(np.trapezoid(moment**2 * more * on, z))
    return max(turned, along) / whole if whole else 0.0


def _inertia(pin: Pin, z: float) -> float:
    bore, shaft = pin.radii(z)
    return math.pi * (shaft**4 - bore**4) / 4.0


def with_neglected(
    evidence: Evidence, cuts: NeglectedCuts, of: CutField, over: tuple[Variation, ...]
) -> Evidence:
    """The evidence with the neglected effects among the parts of its error, and a remark on
    them.
    """
    error = cuts.error(evidence.value, _at_a_cut(evidence.location, of), over)
    return evidence.with_parts(model=error).remarked(cuts.note)


def _at_a_cut(location: tuple[float, float, float], of: CutField) -> bool:
    ends = [zone(piece.piece) for piece in of.solution.pieces]
    return any(low <= location[2] <= high for low, high in ends)

"""Pins with cuts in their lugs: what contact that is solved for the pin without cuts leaves out.

Contact pressures are those of the pin without its cuts. What presses on a cut's mouth is taken by
the rest of the band about it (fea.cut.lost_loads). Two things are neglected and go into the error:

compliance      Cuts make the pin softer, so that pressures move towards the faces of the lugs. By
                how much its bending compliance grows follows from the turns of the ends of local
                solids; by how much stress depends on it, from the variation of the lugs' stiffness,
                since a softer pin is one in stiffer lugs.
redistribution  What presses on a mouth comes back as pressure near it, at most about as large as
                that: stress there changes by so much, elsewhere as the part of the force that is
                lost.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fea.asked import Asked
from fea.core.material import Material
from fea.core.peak import Note, Peak
from fea.cut.evaluate import CutAnswer
from fea.cut.region import zone
from fea.joint.bending import stations
from fea.joint.cell_pressure import CellPressure
from fea.joint.error_parts import with_parts
from fea.joint.records import Variation
from fea.joint.solve_joint import JointContact
from geometry import CutPin, Pin

SAMPLES = 7  # points over a mouth, each way
STIFFNESS = "stiffness of the lugs"
TWICE = math.log(2.0)


@dataclass(frozen=True)
class Neglected:
    """softer: by how much, relative, cuts raise the pin's bending compliance; pressed: the largest
    pressure on a mouth, Pa; lost: the largest part of a lug's force that acts on mouths; bands:
    those on which they are, by the numbers of the cuts.
    """

    softer: float
    pressed: float
    lost: float
    bands: dict[int, str]

    @property
    def note(self) -> Note:
        """Of the cuts in lugs."""
        if not self.bands:
            return Note()
        where = ", ".join(f"hole {i} in lug {name}" for i, name in self.bands.items())
        return Note(
            f"; {where}: contact is that of the pin without it, and pressure at the edge of its "
            "mouth is not resolved",
            ("hole-in-lug",),
        )

    def error(self, largest: float, at_cut: bool, over: tuple[Variation, ...]) -> float:
        """Of a maximum, Pa, with the maxima of the joint varied."""
        factors = [v.max_von_mises / largest for v in over if v.what == STIFFNESS]
        most = max((abs(math.log(x)) for x in factors if x > 0.0), default=TWICE)
        relative = self.softer * most / TWICE + self.lost
        return relative * largest + at_cut * self.pressed


def neglected(
    cut: CutPin, material: Material, contact: JointContact, pressure: CellPressure, of: CutAnswer
) -> Neglected:
    """At the single instant of a contact."""
    pressed, lost, bands = 0.0, dict[int, float](), dict[int, str]()
    for i, hole in enumerate(cut.holes, 1):
        radius = cut.profile.radii(hole.z)[1]
        x = np.linspace(-0.5, 0.5, SAMPLES) * hole.diameter
        y, z = (a.ravel() for a in np.meshgrid(x, x))
        inside = np.hypot(y, z) <= 0.5 * hole.diameter
        y, z = y[inside], z[inside]
        for side in (0.0, math.pi) if hole.depth is None else (0.0,):
            angle = hole.angle + side + np.arcsin(y / radius)
            points = np.stack([radius * np.cos(angle), radius * np.sin(angle), hole.z + z], axis=1)
            number = pressure.rings(points)
            on = number[number >= 0]
            if not len(on):
                continue
            found = pressure.at(points)
            band = int(contact.bands.band[on[0]])
            bands[i] = contact.lugs[band].connection
            pressed = max(pressed, float(found.max()))
            part = float(found.mean()) * math.pi * hole.diameter**2 / 4.0
            lost[band] = lost.get(band, 0.0) + part
    own, forces = contact.bands.band, contact.loads.forces[0, :, :2]
    force = {b: float(np.linalg.norm(forces[own == b].sum(axis=0))) for b in lost}
    share = max((part / force[b] for b, part in lost.items() if force[b] > 0.0), default=0.0)
    return Neglected(_softer(material, contact, of), pressed, share, bands)


def _softer(material: Material, contact: JointContact, of: CutAnswer) -> float:
    """The work of the bending moment at the cuts on the turns that these add, over that of the
    whole pin.
    """
    z = stations(contact.pin)
    moment = contact.bending_moment(z)[0]
    stiffness = np.array([_inertia(contact.pin, x) for x in z.tolist()]) * material.youngs_modulus
    whole = float(np.trapezoid(np.sum(moment**2, axis=1) / stiffness, z))
    added = 0.0
    for piece in of.solution.pieces:
        turn = (piece.moved[1] - piece.moved[0])[3:5] @ piece.coefficients(contact.loads)[0]
        low, high = zone(piece.piece)
        here = contact.bending_moment(np.array([0.5 * (low + high)]))[0, 0]
        added += float(np.linalg.norm(here) * np.linalg.norm(turn))
    return added / whole if whole else 0.0


def _inertia(pin: Pin, z: float) -> float:
    bore, shaft = pin.radii(z)
    return math.pi * (shaft**4 - bore**4) / 4.0


def at_a_cut(peak: Peak, of: CutAnswer) -> bool:
    """Whether a maximum is about a cut."""
    ends = [zone(piece.piece) for piece in of.solution.pieces]
    where = peak.location
    return where is not None and any(low <= where[2] <= high for low, high in ends)


def with_neglected(
    peak: Peak, left: Neglected, of: CutAnswer, over: tuple[Variation, ...], asked: Asked
) -> Peak:
    """With what is neglected among the parts of its error, and a note about it."""
    if not peak.max_von_mises or peak.parts is None:
        return peak
    more = left.error(peak.max_von_mises, at_a_cut(peak, of), over)
    found = with_parts(peak, replace(peak.parts, model=more), asked)
    note = left.note
    return replace(found, note=found.note + note.text, reasons=found.reasons + note.codes)

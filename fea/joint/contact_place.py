"""What only contact has, of a pin in its lugs: edges, mean pressures, and what lies beneath."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.places import BandPressure, ContactPlace, PressedCell
from fea.cut.evaluate import CutAnswer
from fea.harmonic.beneath import Beneath, beneath, reach
from fea.harmonic.evaluate import HarmonicAnswer
from fea.joint.edge_peak import contact_edges
from fea.joint.solve_joint import JointContact
from geometry.arrays import Ints


def contact_place(
    contact: JointContact,
    material: Material,
    answer: HarmonicAnswer | CutAnswer,
    loads: PinLoads,
    required: float | None,
    error: float,
) -> ContactPlace:
    """contact: at the row's instant. loads: on the rings at all instants of the case; error: of
    what lies beneath, relative.
    """
    under = answer if isinstance(answer, CutAnswer) else _Plain(answer)
    found = under.beneath(loads)
    limits = reached(material, required)
    instants = dict.fromkeys((found.instant, _instant(loads, contact)))
    each = [under.reach(loads, t, limits) for t in instants] if limits else []
    most = [max(values) for values in zip(*each, strict=True)]
    return ContactPlace(
        found.value,
        error * found.value,
        found.location,
        _time(loads, found),
        most[0] if most else None,
        most[1] if len(most) > 1 else None,
        contact_edges(contact, material),
        tuple(_band(contact, b, material) for b in range(len(contact.lugs))),
    )


@dataclass(frozen=True)
class _Plain:
    """A pin without cuts, asked as one with them is."""

    answer: HarmonicAnswer

    def beneath(self, loads: PinLoads) -> Beneath:
        return beneath(self.answer.fields, loads, self.answer.singularities)

    def reach(self, loads: PinLoads, instant: int, limits: tuple[float, ...]) -> tuple[float, ...]:
        return reach(self.answer.fields, loads, instant, self.answer.singularities, limits)


def reached(material: Material, required: float | None) -> tuple[float, ...]:
    """The stresses, Pa, of which it is said how far from contact they reach."""
    strength = material.yield_strength
    if strength is None:
        return ()
    return (strength,) if required is None else (strength, strength / required)


def _time(loads: PinLoads, found: Beneath) -> float | None:
    return None if loads.times is None else float(loads.times[found.instant])


def _instant(loads: PinLoads, contact: JointContact) -> int:
    """The number of the row's instant."""
    here = contact.loads.times
    if loads.times is None or here is None:
        return 0
    return int(np.abs(loads.times - here[0]).argmin())


def _band(contact: JointContact, b: int, material: Material) -> BandPressure:
    lug, bands = contact.lugs[b], contact.bands
    own = np.flatnonzero(bands.band == b)
    force = np.linalg.norm(contact.line_load[0, own].T @ bands.length[own])
    mean = float(force / (2.0 * bands.radius[own[0]] * bands.length[own].sum()))
    strengths = [m.bearing_strength for m in (material, lug.bearing) if m.bearing_strength]
    share = mean / min(strengths) if strengths else None
    return BandPressure(lug.connection, mean, share, _cells(contact, own))


def _cells(contact: JointContact, own: Ints) -> tuple[PressedCell, ...]:
    (pressed,), bands = contact.contact, contact.bands
    half = np.degrees(np.pi / pressed.pressure.shape[1])
    out = []
    for ring in own:
        z0, z1 = (float(bands.z[ring] + s * bands.length[ring] / 2.0) for s in (-1.0, 1.0))
        for sector in np.flatnonzero(pressed.pressure[ring] > 0.0):
            angle = float(np.degrees(contact.angles[sector] + pressed.angle))
            angle = (angle + 180.0) % 360.0 - 180.0
            out.append((z0, z1, angle - half, angle + half))
    return tuple(out)

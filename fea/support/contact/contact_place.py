"""The results that only contact gives: edges of lugs, mean pressures, stress beneath contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.places import BandPressure, ContactPlace, PressedCell
from fea.cut.field import CutField
from fea.harmonic.beneath import stairs
from fea.harmonic.field import HarmonicField
from fea.support.contact.edge_peak import contact_edges
from fea.support.contact.joint_contact import JointContact
from pinbase.arrays import Ints


def contact_place(
    contact: JointContact,
    material: Material,
    answer: HarmonicField | CutField,
    loads: PinLoads,
    required: float | None,
    error: float,
    row: float,
    deep: bool = True,
) -> ContactPlace:
    """The results of contact at the row's instant.

    loads: on the rings at all instants of the case.
    required: required safety factor, if there is one.
    error: relative error of the stress beneath contact.
    row: maximum of surface and section, Pa. The depth of smaller stresses is needed only down to
    the stresses whose reach is stated.
    deep: whether depths of stress are wanted at all.
    """
    deepest = answer.beneath(loads)
    limits = reached(material, required)
    instants = dict.fromkeys((deepest.instant, _instant(loads, contact)) if deep else ())
    least = min(row, *limits) if limits else row
    steps = [x for t in instants for x in answer.depths(loads, t, least)]
    known = stairs(*np.array(steps).reshape(-1, 2).T)
    place = ContactPlace(
        deepest.value,
        error * deepest.value,
        deepest.location,
        loads.time(deepest.instant),
        None,
        None,
        contact_edges(contact, material),
        tuple(_band(contact, b, material) for b in range(len(contact.lugs))),
        known,
    )
    reach, required_too = (*(place.depth(x) for x in limits), None, None)[:2]
    return replace(place, reach=reach, reach_required=required_too)


def reached(material: Material, required: float | None) -> tuple[float, ...]:
    """The stresses, Pa, whose reach from contact is stated: yield, and yield over the required
    factor.
    """
    strength = material.yield_strength
    if strength is None:
        return ()
    return (strength,) if required is None else (strength, strength / required)


def _instant(loads: PinLoads, contact: JointContact) -> int:
    """The number of the contact's instant among those of the loads."""
    here = contact.loads.times
    if loads.times is None or here is None:
        return 0
    return int(np.abs(loads.times - here[0]).argmin())


def _band(contact: JointContact, b: int, material: Material) -> BandPressure:
    lug, bands = contact.lugs[b], contact.bands
    ring_rows = np.flatnonzero(bands.band == b)
    force = np.linalg.norm(contact.line_load[0, ring_rows].T @ bands.length[ring_rows])
    mean = float(force / (2.0 * bands.radius[ring_rows[0]] * bands.length[ring_rows].sum()))
    strengths = [m.bearing_strength for m in (material, lug.bearing) if m.bearing_strength]
    share = mean / min(strengths) if strengths else None
    return BandPressure(lug.connection, mean, share, _cells(contact, ring_rows))


def _cells(contact: JointContact, ring_rows: Ints) -> tuple[PressedCell, ...]:
    (pressed,), bands = contact.contact, contact.bands
    half = np.degrees(np.pi / pressed.pressure.shape[1])
    out = []
    for ring in ring_rows:
        z0, z1 = (float(bands.z[ring] + s * bands.length[ring] / 2.0) for s in (-1.0, 1.0))
        for sector in np.flatnonzero(pressed.pressure[ring] > 0.0):
            angle = float(np.degrees(contact.angles[sector] + pressed.angle))
            angle = (angle + 180.0) % 360.0 - 180.0
            out.append((z0, z1, angle - half, angle + half))
    return tuple(out)

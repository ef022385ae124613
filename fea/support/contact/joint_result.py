"""The line loads, moments and contact of a pin's bands at one instant, in the form of results."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.support.contact.bending import LoadedJoint, stations
from fea.support.contact.joint_contact import JointContact
from fea.support.records import BandContact, JointRange, JointResult


def contact_result(
    contact: JointContact,
    over: JointRange | None,
    case: PinLoads,
    remark: str,
    torques: Floats | None,
) -> JointResult:
    """The joint result of a contact at a single instant.

    over: range over the joint.
    case: loads on the rings at all instants.
    remark: variations that the range leaves out.
    torques: largest friction torque of each lug over all instants, (B,) N m; None without friction.
    """
    bands = []
    for b, lug in enumerate(contact.lugs):
        band = band_contact(contact, b, float(np.degrees(contact.contact_angle[0, b])))
        torque = None if torques is None or not lug.friction else float(torques[b])
        bands.append(replace(band, friction=lug.friction, friction_torque=torque))
    whole = LoadedJoint(contact.pin, contact.lugs, contact.bands, case, contact.mass)
    result = joint_result("contact", contact, bands, over, remark)
    return replace(result, along=whole.section_forces())


def joint_result(
    model: str,
    joint: LoadedJoint,
    bands: list[BandContact],
    over: JointRange | None,
    remark: str,
) -> JointResult:
    """The result of a joint at a single instant, with the bending moment along the pin."""
    z = stations(joint.pin)
    moment = np.linalg.norm(joint.bending_moment(z)[0], axis=1)
    moments = tuple(zip(z.tolist(), moment.tolist(), strict=True))
    return JointResult(model, tuple(bands), float(moment.max()), moments, over, remark)


def band_contact(
    joint: LoadedJoint, b: int, contact_angle: float, turning: Floats | float = 0.0
) -> BandContact:
    """The contact of band number b at the single instant of a joint, without friction.

    contact_angle: half angle of contact, degrees.
    turning: couple of loads that vary along rings, (2,) N m.
    """
    lug, bands = joint.lugs[b], joint.bands
    on_band = bands.band == b
    z, length, line = bands.z[on_band], bands.length[on_band], joint.line_load[0, on_band]
    force = length @ line
    size = float(np.linalg.norm(force))
    along = force / size if size else np.array([1.0, 0.0])
    return BandContact(
        name=lug.connection,
        force=size,
        contact_angle=contact_angle,
        mean_pressure=size / (2.0 * float(bands.radius[on_band][0]) * float(length.sum())),
        line_load=tuple(zip(z.tolist(), (line @ along).tolist(), strict=True)),
        couple=float(np.linalg.norm((length * (z - bands.middles[b])) @ line + turning)),
        clearance=lug.clearance,
        outer_diameter=lug.outer_diameter,
        ends=(*(z - length / 2.0).tolist(), float((z + length / 2.0)[-1])),
    )

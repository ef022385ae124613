"""Load per length, moments and contact of a pin's bands at one instant, as results show them."""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.support.contact.bending import joint_forces, stations
from fea.support.contact.solve_joint import JointContact
from fea.support.records import BandContact, JointRange, JointResult


def contact_result(
    contact: JointContact,
    over: JointRange | None,
    case: PinLoads,
    remark: str = "",
    torques: Floats | None = None,
) -> JointResult:
    """The joint result of a contact at a single instant.

    case: loads of the rings on the pin at all instants.
    remark: what the range leaves out.
    torques: the largest of friction over all instants, by lug, (B,) N m.
    """
    z = stations(contact.pin)
    moment = np.linalg.norm(contact.bending_moment(z)[0], axis=1)
    return JointResult(
        model="contact",
        bands=tuple(
            _band(contact, b, None if torques is None else float(torques[b]))
            for b in range(len(contact.lugs))
        ),
        bending_moment=float(moment.max()),
        bending_moments=tuple(zip(z.tolist(), moment.tolist(), strict=True)),
        range=over,
        remark=remark,
        along=joint_forces(contact.pin, contact.mass, contact.bands, case, contact.lugs),
    )


def _band(contact: JointContact, b: int, torque: float | None) -> BandContact:
    lug, bands = contact.lugs[b], contact.bands
    on_band = bands.band == b
    line = contact.line_load[0, on_band]
    force = bands.length[on_band] @ line
    size = float(np.linalg.norm(force))
    along = force / size if size else np.array([1.0, 0.0])
    arm = bands.z[on_band] - bands.middles[b]
    couple = np.linalg.norm((bands.length[on_band] * arm) @ line)
    half = bands.length[on_band] / 2.0
    ends = [*(bands.z[on_band] - half).tolist(), float((bands.z[on_band] + half)[-1])]
    pairs = zip(bands.z[on_band].tolist(), (line @ along).tolist(), strict=True)
    return BandContact(
        name=lug.connection,
        force=size,
        contact_angle=float(np.degrees(contact.contact_angle[0, b])),
        mean_pressure=size
        / (2.0 * float(bands.radius[on_band][0]) * float(bands.length[on_band].sum())),
        line_load=tuple(pairs),
        couple=float(couple),
        clearance=lug.clearance,
        outer_diameter=lug.outer_diameter,
        ends=tuple(ends),
        friction=lug.friction,
        friction_torque=torque if lug.friction else None,
    )

"""The directions in which the shanks of lugs point, as their links move."""

from __future__ import annotations

import numpy as np

from fea.lug.in_joint import ShankAngle
from loads import GROUND, Dynamics, Joint
from pinbase.keys import lug_key
from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.file import Study
from pinstress.study.schema.lugs import ShankTable
from pinstress.study.schema.mechanism import MechanismTable
from pinstress.study.schema.pins import PinTable
from pinstress.study.schema.shown import listed


def shank_angles(study: Study, pin: str, case: CaseLoads) -> dict[str, ShankAngle]:
    """Return the angles of a pin's shanks in a case, by connection.

    Shanks whose angle neither the study nor the mechanism gives are left out.

    Raises: InputError for a joint that does not exist or is not in a planar linkage, and if the
    middle of the other joints of a body is at the lug.
    """
    out, mechanism, table = {}, study.table.mechanism, study.table.pin[pin]
    links = {ear: connection for connection, ear in table.ears.items()}
    for name, lug in table.lug.items():
        if lug.shank is None:
            continue
        at = lug_key(pin, name, "shank")
        if lug.shank.angle is not None:
            out[name] = ShankAngle(np.array([lug.shank.angle]))
        elif lug.shank.toward is not None and not isinstance(mechanism, MechanismTable):
            raise study.error(
                f"{at}.toward: needs the joints of a linkage in the plane; give angle",
                f"{at}.toward",
                "direction-unknown",
            )
        elif (
            case.dynamics is not None
            and (link := _link(case, links.get(name, name), lug.shank, table))
            and (others := _others(study, at, case.dynamics, link, lug.shank.toward))
        ):
            out[name] = _toward(study, at, link, others, case)
    return out


def _link(case: CaseLoads, connection: str, shank: ShankTable, pin: PinTable) -> str | None:
    """Return the connection from which the mechanism gives a shank's direction.

    None for a lug of the ground or of the structure, unless the direction is stated.

    connection: of the link to which the lug belongs; both ears of a link have the same.
    """
    r = case.reactions
    if shank.toward is None:
        known = connection in r.connections
        return connection if known and r.bodies[r.connections.index(connection)] != GROUND else None
    at_pin = (connection, *(name for _, name in pin.connections))  # all at one point, in pin axes
    return next((name for name in at_pin if name in r.connections), None)


def _toward(
    study: Study, at: str, connection: str, others: list[str], case: CaseLoads
) -> ShankAngle:
    """Return the angles towards the mean position of other joints."""
    dynamics, times = case.dynamics, None
    assert dynamics is not None
    if case.moving is not None and case.solve is not None:
        times = case.moving.instants
        dynamics = case.solve(times)
    here = _joint_of(dynamics, connection)
    places = [dynamics.motion.joint(name)[0] for name in others]
    x, y = (np.mean(places, axis=0) - dynamics.motion.joint(here.name)[0]).T
    if not np.hypot(x, y).all():
        raise study.error(
            f"the shank's direction is not known: {listed(others)} lie about {here.name}; give "
            "toward, the name of a joint, or angle",
            at,
            "direction-unknown",
        )
    turn = dynamics.reactions.turn[:, dynamics.reactions.connections.index(connection)]
    assumed = f"shank towards the middle of {listed(others)}" if len(others) > 1 else ""
    return ShankAngle(np.arctan2(y, x) - turn, times, assumed)


def _joint_of(dynamics: Dynamics, connection: str) -> Joint:
    joints = dynamics.motion.linkage.connections
    return next(joint for joint, known in joints if known.name == connection)


def _others(
    study: Study, at: str, dynamics: Dynamics, connection: str, toward: str | None
) -> list[str]:
    """Return the names of the joints towards which a shank points."""
    linkage, here = dynamics.motion.linkage, _joint_of(dynamics, connection).name
    names = [joint.name for joint in linkage.joints if joint.name != here]
    if toward is not None:
        if toward not in names:
            raise study.error(
                f"there is no other joint {toward!r}; give one of {listed(names)}",
                f"{at}.toward",
                "unknown-name",
            )
        return [toward]
    body = next(c.body for _, c in linkage.connections if c.name == connection)
    sliding = {
        s.base if s.moving == body else s.moving
        for s in linkage.sliders
        if body in (s.base, s.moving)
    }
    for bodies in ({body}, sliding):  # a piston points towards the joint of its cylinder
        known = (j.name for j, c in linkage.connections if c.body in bodies and j.name != here)
        if others := list(dict.fromkeys(known)):
            return others
    return []

"""The direction in which the shanks of lugs point, as their links move."""

from __future__ import annotations

import numpy as np

from fea.lug.in_joint import ShankAngle
from loads import GROUND, Dynamics, Joint
from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.file import Study
from pinstress.study.schema.lugs import ShankTable


def shank_angles(study: Study, pin: str, case: CaseLoads) -> dict[str, ShankAngle]:
    """Return the angles of a pin's shanks in a case, by connection; those that neither the study
    nor the mechanism gives are left out.

    Raises: InputError for a joint that does not exist, and for a body with more than two joints
    whose shank has no direction.
    """
    out = {}
    for name, lug in study.table.pin[pin].lug.items():
        if lug.shank is None:
            continue
        if lug.shank.angle is not None:
            out[name] = ShankAngle(np.array([lug.shank.angle]))
        elif case.dynamics is not None and _turns(case, name, lug.shank):
            out[name] = _toward(study, f"pin.{pin}.lug.{name}.shank", name, lug.shank, case)
    return out


def _turns(case: CaseLoads, connection: str, shank: ShankTable) -> bool:
    """Return whether the mechanism gives a shank's direction: not that of a lug of the ground,
    unless it is stated.
    """
    r = case.reactions
    if connection not in r.connections:
        return False
    return shank.toward is not None or r.bodies[r.connections.index(connection)] != GROUND


def _toward(
    study: Study, at: str, connection: str, shank: ShankTable, case: CaseLoads
) -> ShankAngle:
    dynamics, times = case.dynamics, None
    assert dynamics is not None
    if case.moving is not None and case.solve is not None:
        times = case.moving.instants
        dynamics = case.solve(times)
    here = _joint_of(dynamics, connection)
    there = _other(study, at, dynamics, connection, shank.toward)
    x, y = (dynamics.motion.joint(there)[0] - dynamics.motion.joint(here.name)[0]).T
    turn = dynamics.reactions.turn[:, dynamics.reactions.connections.index(connection)]
    return ShankAngle(np.arctan2(y, x) - turn, times)


def _joint_of(dynamics: Dynamics, connection: str) -> Joint:
    joints = dynamics.motion.linkage.connections
    return next(joint for joint, known in joints if known.name == connection)


def _other(study: Study, at: str, dynamics: Dynamics, connection: str, toward: str | None) -> str:
    """Return the name of the joint towards which a shank points."""
    linkage, here = dynamics.motion.linkage, _joint_of(dynamics, connection).name
    names = [joint.name for joint in linkage.joints]
    if toward is not None:
        if toward not in names or toward == here:
            raise study.error(
                f"there is no other joint {toward!r}; give one of "
                f"{', '.join(x for x in names if x != here)}",
                f"{at}.toward",
                "unknown-name",
            )
        return toward
    body = next(c.body for _, c in linkage.connections if c.name == connection)
    others = dict.fromkeys(
        joint.name for joint, c in linkage.connections if c.body == body and joint.name != here
    )
    if len(others) != 1:
        many = f"has the joints {', '.join(others)}" if others else "has no other joint"
        raise study.error(
            f"the shank's direction is not known: body {body} {many}; give toward, the name of a "
            "joint, or angle",
            at,
            "direction-unknown",
        )
    return next(iter(others))

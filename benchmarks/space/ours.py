"""A machine of plain data as our linkage, and our result for it."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from benchmarks.space.machines import Machine
from benchmarks.space.peer_forces import PeerForces
from loads import CycloidalDrive
from loads.space.acting import SpaceForce
from loads.space.dynamics import space_reactions
from loads.space.kinds import Kind
from loads.space.linkage import JointAngle, JointTravel, RigidBody, SpaceJoint, SpaceLinkage
from loads.space.motion import space_move
from pinbase.arrays import Floats


def space_linkage(machine: Machine) -> SpaceLinkage:
    """Return the linkage of a machine."""
    measured: list[JointAngle | JointTravel] = []
    for name, drive in machine["drives"].items():
        kind = JointAngle if drive["measures"] == "angle" else JointTravel
        measured.append(kind(name, drive["joint"]))
    return SpaceLinkage(
        bodies=tuple(RigidBody(name, **body) for name, body in machine["bodies"].items()),
        joints=tuple(_joint(name, cast(Any, j)) for name, j in machine["joints"].items()),
        measured=tuple(measured),
        driven=tuple(machine["drives"]),
        gravity=machine["gravity"],
    )


def _joint(name: str, data: dict[str, Any]) -> SpaceJoint:
    """Return a joint whose directions have unit length."""
    unit: dict[str, Any] = {
        key: tuple(np.array(data[key]) / np.linalg.norm(data[key]))
        for key in ("axis", "second_axis")
        if key in data
    }
    kind = cast(Kind, data["kind"])
    return SpaceJoint(name, kind, data["base"], data["moving"], data["at"], **unit)


def ours(machine: Machine, times: Floats) -> PeerForces:
    """Return our result at times (T,), s."""
    linkage = space_linkage(machine)
    laws = [CycloidalDrive(0.0, d["to"], machine["duration"]) for d in machine["drives"].values()]
    motion = space_move(linkage, laws, times)
    loads = [SpaceForce(body, at, force) for body, at, force in machine["forces"]]
    dynamics = space_reactions("machine", motion, loads)
    points = np.stack([motion.point(j.moving, j.at)[0] for j in linkage.joints], axis=1)
    reactions = dynamics.reactions
    return PeerForces(points, reactions.forces, reactions.moments, dynamics.drive)

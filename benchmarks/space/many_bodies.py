"""The cost of motion and forces in space by the number of bodies: RSUR four-bars in series."""

from __future__ import annotations

import resource
import time

import numpy as np

from benchmarks.space.bodies import Vector, rod, square, vector
from benchmarks.timing import table
from loads import GROUND, CycloidalDrive
from loads.space.dynamics import space_reactions
from loads.space.linkage import JointAngle, RigidBody, SpaceJoint, SpaceLinkage
from loads.space.motion import SpaceCourse
from pinbase.arrays import Floats

SPACING, RADIUS, TILT = 1.0, 0.3, 0.1  # distance and radius of cranks, m; tilt of their axes, rad
SWING, SPAN = 0.3, 4.0  # rad of the first crank, s
CASES = ((5, 2_000), (20, 2_000), (50, 20_000))  # stages (2 bodies each), instants
TARGET = "Target: 100 bodies x 20,000 instants in 300 s and 2,000 MB."


def train(stages: int) -> SpaceLinkage:
    """Return a crank and `stages` couplers and rockers, whose axes are tilted in different
    directions.
    """
    bodies, joints, axes, pins = [], [], [], []
    for k in range(stages + 1):
        tilt = TILT * np.array([np.cos(2.0 * k), np.sin(2.0 * k), 0.0])
        axes.append(vector(np.array([0.0, 0.0, 1.0]) + tilt))
        foot: Vector = (SPACING * k, 0.0, 0.0)
        pins.append(vector(np.add(foot, RADIUS * _unit(square((0.5, 1.0, 0.2), axes[k])))))
        bodies.append(RigidBody(f"crank{k}", **rod(3.0, foot, pins[k])))
        joints.append(SpaceJoint(f"O{k}", "revolute", GROUND, f"crank{k}", foot, _axis(axes[k])))
        if k:
            bodies.append(RigidBody(f"coupler{k}", **rod(2.0, pins[k - 1], pins[k])))
            joints.append(
                SpaceJoint(f"S{k}", "spherical", f"crank{k - 1}", f"coupler{k}", pins[k - 1])
            )
            across = _axis(square((0.0, 1.0, 0.0), axes[k]))
            joints.append(
                SpaceJoint(
                    f"U{k}",
                    "universal",
                    f"crank{k}",
                    f"coupler{k}",
                    pins[k],
                    _axis(axes[k]),
                    across,
                )
            )
    return SpaceLinkage(
        tuple(bodies),
        tuple(joints),
        measured=(JointAngle("turn", "O0"),),
        driven=("turn",),
        gravity=(0.0, 0.0, -9.81),
    )


def _unit(v: Vector) -> Floats:
    return np.asarray(np.array(v) / np.linalg.norm(v))


def _axis(v: Vector) -> Vector:
    return vector(_unit(v))


def space() -> str:
    """Return the processor times of the path and of motion and forces, the largest memory, and the
    error of the power balance.
    """
    head = ("bodies", "instants", "path, s", "motion and forces, s", "ms an instant", "memory, MB")
    rows = [_row(*case) for case in CASES]
    return f"{TARGET}\n\n{table((*head, 'power amiss'), rows)}"


def _row(stages: int, instants: int) -> tuple[object, ...]:
    linkage = train(stages)
    marks = [time.process_time()]
    course = SpaceCourse(linkage, [CycloidalDrive(0.0, SWING, SPAN)], 0.0, SPAN)
    marks.append(time.process_time())
    motion = course.at(np.linspace(0.0, SPAN, instants))
    space_reactions("train", motion)
    marks.append(time.process_time())
    path, solved = np.diff(marks).tolist()
    memory = f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0:.0f}"
    found = space_reactions("train", motion[:: instants // 100])
    amiss = float(np.abs(found.imbalance).max() / np.abs(found.power).max())
    each = 1e3 * solved / instants
    return len(linkage.bodies), f"{instants:,}", path, solved, each, memory, amiss

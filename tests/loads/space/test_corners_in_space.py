"""Times at which forces jump or have a kink, of a planar linkage and of the same one in space."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from loads import Applied, Clock, ConstantDrive, Course, ForceLaw, ForceTable, Spring, Varying
from loads.forces.corners import corners_of
from loads.forces.measures import Distance
from loads.space.motion import SpaceCourse
from tests.support.mechanism.lift import lift
from tests.support.mechanism.mechanisms import four_bar


def test_the_same_corners_in_the_plane_and_in_space() -> None:
    """A load that begins and varies, a spring with a table, and friction that turns back."""
    linkage = four_bar()
    rubbing = tuple(
        replace(j, connections=(replace(j.connections[0], friction=0.01),)) if j.fixed_in else j
        for j in linkage.joints
    )
    linkage = replace(linkage, joints=rubbing)
    ends = linkage.joints[1], linkage.joints[3]
    between = Distance((linkage.carrier(ends[0]), "ground"), (ends[0].at, ends[1].at))
    d = math.dist(ends[0].at, ends[1].at)
    table = ForceTable((0.2 * d, 0.97 * d, 4.0 * d), (0.0, 50.0, 0.0), outside="hold")
    spring = Spring("s", between, ForceLaw(table=table))
    pulse = ForceTable((0.0, 0.35, 1.0), (0.0, 1.0, 0.5))
    body = linkage.bodies[1]
    load = Applied(body.name, body.centre, (5.0, 0.0), times=Varying(Clock(), pulse), begin=0.2)
    start = linkage.drives[0].drawn
    law = ConstantDrive(start, start + 7.0, 1.0)
    lifted, loads = lift(linkage, [spring, load])
    plane, space = Course(linkage, [law], 0.0, 1.0), SpaceCourse(lifted, [law], 0.0, 1.0)
    nodes = np.linspace(0.0, 1.0, 40)
    ours = corners_of(plane, [spring, load], nodes)
    assert {0.2, 0.35} <= set(ours.round(9))
    assert len(ours) > 4
    assert corners_of(space, loads, nodes) == pytest.approx(ours, abs=1e-9)

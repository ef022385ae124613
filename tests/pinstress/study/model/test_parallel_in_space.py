"""Actuators in parallel in space: how they divide the force of one degree of freedom."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.pinstress.study.model.test_space import edited, message, solved

# A second actuator of the linkage: between the ground and the rocker.
JACK = """
[mechanism.stop.jack]
bodies = ["ground", "rocker"]
between = [[0.5, 0.1, 0.3], "C"]
[[mechanism.sharing]]
parallel = ["A", "jack"]
"""
GROUND = np.array([0.5, 0.1, 0.3])


def test_a_crank_and_a_jack_divide_the_load_by_stiffness(tmp_path: Path) -> None:
    """A motor on the crank and a jack on the rocker of an RSSR linkage: as springs on rigid links
    their forces are stiffness times what the other moves them, and their powers add up to that of
    the motor alone.
    """
    alone = solved(tmp_path, edited())["turn"].space
    both = solved(tmp_path, edited(("[case.turn]", f"{JACK}stiffness = [3, 4000]\n[case.turn]")))
    found = both["turn"].space
    assert alone is not None
    assert found is not None
    assert found.dynamics.motion.equations.actuators == ("A", "jack")
    torque, force = found.dynamics.drive.T
    motion = found.dynamics.motion
    speeds = motion.actuated[1]
    # Independent: the jack's length per crank angle, from the ball's place.
    place, velocity, _ = motion.point("rocker", (0.3, 0.25, 0.2))
    along = place - GROUND
    rate = np.sum(along * velocity, axis=1) / np.linalg.norm(along, axis=1)
    assert speeds[:, 1] == pytest.approx(rate, abs=1e-12)
    moving = np.abs(speeds[:, 0]) > 1e-6
    slope = rate[moving] / speeds[moving, 0]
    assert force[moving] * 3.0 == pytest.approx(4000.0 * slope * torque[moving], rel=1e-7)
    power = found.dynamics.power.sum(axis=1)
    assert power == pytest.approx(alone.dynamics.power[:, 0], abs=1e-9 * np.abs(power).max())
    assert found.violation is not None
    assert found.violation < 1e-10
    assert found.efforts is not None
    assert len(found.efforts) == 2
    assert np.abs(force).max() > 1.0


def test_equal_areas_give_equal_forces(tmp_path: Path) -> None:
    """Two jacks on one platform in a static case, held against virtual work."""
    jacks = """
[[mechanism.drive]]
name = "one"
bodies = ["ground", "rocker"]
between = [[0.5, 0.1, 0.3], "C"]
[mechanism.stop.two]
bodies = ["ground", "rocker"]
between = [[0.1, 0.1, 0.1], "C"]
[[mechanism.sharing]]
parallel = ["one", "two"]
areas = [2, 2]
"""
    text = edited(
        ('[mechanism.drive]\njoint = "A"\nlaw = "cycloidal"\nstart = "0 deg"\nend = "90 deg"\n'
         "duration = 0.5\n[case.turn]\nkind = \"motion\"\nsamples = 21\n", jacks),
        ('position = "30 deg"\n', 'hold = ["one", "two"]\n'),
    )  # fmt: skip
    found = solved(tmp_path, text)["rest"].space
    assert found is not None
    one, two = found.dynamics.drive[0]
    assert one == pytest.approx(two, rel=1e-12)
    # Virtual work of a turn of the rocker about D (along x): load, weight and jacks do none.
    axis, hinge, ball = (
        np.array([1.0, 0, 0]),
        np.array([0.3, 0.25, 0.0]),
        np.array([0.3, 0.25, 0.2]),
    )
    path = np.cross(axis, ball - hinge)
    units = [ball - np.array(p) for p in ((0.5, 0.1, 0.3), (0.1, 0.1, 0.1))]
    by_jacks = sum(one * (u / np.linalg.norm(u)) @ path for u in units)
    r = found.reactions
    rod = r.forces[0, r.connections.index("C1")]  # of the coupler on the rocker
    weight = -9.81 * 0.03 * 0.02 * 0.2 * 7850.0
    others = (np.array([0, 1000.0, 300.0]) + rod) @ path + 0.5 * weight * path[2]
    assert by_jacks + others == pytest.approx(0.0, abs=1e-9 * abs(by_jacks))


def test_rules_that_cannot_hold_are_said(tmp_path: Path) -> None:
    none = JACK.replace('["A", "jack"]', '["A", "jill"]') + "areas = [1, 1]\n"
    assert "no drive or stop 'jill'" in message(
        tmp_path, edited(("[case.turn]", f"{none}[case.turn]"))
    )
    two = JACK.replace('"A", "jack"', '"jack", "jack"') + "areas = [1, 1]\n"
    assert "exactly one of them must be driven" in message(
        tmp_path, edited(("[case.turn]", f"{two}[case.turn]"))
    )
    odd = JACK.replace('bodies = ["ground", "rocker"]\n', "") + "areas = [1, 1]\n"
    assert "bodies" in message(tmp_path, edited(("[case.turn]", f"{odd}[case.turn]")))

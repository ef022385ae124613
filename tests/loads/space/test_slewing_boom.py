"""A boom that slews and luffs under a skew load, by Newton and Euler's equations by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import StateDrive
from loads.space.acting import SpaceForce
from loads.space.dynamics import SpaceDynamics, space_reactions
from loads.space.linkage import JointAngle, PointDistance, RigidBody, SpaceLinkage, Vector
from loads.space.motion import space_move
from pinbase.arrays import Floats
from tests.support.mechanism.space import grounded, joint, tensor, turned, unit, vector

UP, LUFF = (0.0, 0.0, 1.0), unit((0.1, 1.0, 0.05))
HEEL, TIP, CENTRE = np.array([0.4, 0.1, 2.0]), np.array([6.0, 0.3, 4.0]), np.array([3.0, 0.2, 3.1])
JACK = np.array([[0.9, 0.0, 0.8], [2.0, 0.1, 3.0]])  # on the tower and on the boom
MASS, INERTIA = 120.0, np.array([[30.0, 3.0, -40.0], [3.0, 200.0, 2.0], [-40.0, 2.0, 190.0]])
FORCE, COUPLE = np.array([400.0, -900.0, -3000.0]), np.array([50.0, 80.0, -20.0])
G = np.array([0.0, 0.0, -9.81])
SLEW, LIFT = (0.6, 0.5, -0.3), (-0.4, -0.2, 0.7)  # angle, rate and second rate
ROUND_OFF = 1e-12


def _solved(driven: tuple[str, str], *states: StateDrive) -> SpaceDynamics:
    linkage = SpaceLinkage(
        bodies=(
            RigidBody("tower", 0.0, (0.1, 0.1, 1.0)),
            RigidBody("boom", MASS, vector(CENTRE), tensor(INERTIA)),
        ),
        joints=(
            grounded("Z", "revolute", "tower", (0.0, 0.0, 0.0), UP),
            joint("Y", "revolute", "tower", "boom", vector(HEEL), LUFF),
        ),
        measured=(
            JointAngle("slew", "Z"),
            JointAngle("luff", "Y"),
            PointDistance("jack", ("tower", "boom"), (vector(JACK[0]), vector(JACK[1]))),
        ),
        driven=driven,
        gravity=vector(G),
    )
    load = SpaceForce("boom", vector(TIP), vector(FORCE), vector(COUPLE))
    return space_reactions("skew", space_move(linkage, states, np.zeros(1)), [load])


def _slewed(v: Floats | Vector) -> Floats:
    return np.asarray(turned(UP, SLEW[0], vector(np.asarray(v)))[0])


def _of_boom(v: Floats) -> Floats:
    """A vector of the boom as drawn, after luffing and slewing."""
    return _slewed(turned(LUFF, LIFT[0], vector(v))[0])


def _wrench_at_heel(rates: float) -> tuple[Floats, Floats]:
    """Force and moment of the tower on the boom, about its heel. rates: 1, or 0 at rest."""
    (_, w, w_rate), (_, u, u_rate) = SLEW, LIFT
    e, up, heel, arm = _slewed(LUFF), np.array(UP), _slewed(HEEL), _of_boom(CENTRE - HEEL)
    spin = rates * (w * up + u * e)
    spin_rate = rates * (w_rate * up + u_rate * e + np.cross(w * up, u * e))
    a = rates * (w_rate * np.cross(up, heel) + w**2 * np.cross(up, np.cross(up, heel)))
    a = a + np.cross(spin_rate, arm) + np.cross(spin, np.cross(spin, arm))
    turn = np.stack([_of_boom(v) for v in np.eye(3)], axis=1)
    inertia = turn @ INERTIA @ turn.T
    inertial = MASS * (a - G)
    moment = np.cross(arm, inertial) + inertia @ spin_rate + np.cross(spin, inertia @ spin)
    return inertial - FORCE, moment - np.cross(_of_boom(TIP - HEEL), FORCE) - COUPLE


def test_a_boom_driven_by_its_angles() -> None:
    solved = _solved(("slew", "luff"), StateDrive(*SLEW), StateDrive(*LIFT))
    force, moment = _wrench_at_heel(1.0)
    e, at_foot = _slewed(LUFF), moment + np.cross(_slewed(HEEL), force)
    size = float(np.abs(at_foot).max())
    assert solved.drive[0] == pytest.approx([at_foot[2], moment @ e], abs=ROUND_OFF * size)
    r = solved.reactions
    carried = moment - (moment @ e) * e, at_foot * (1.0, 1.0, 0.0)
    for name, couple in zip("YZ", carried, strict=True):
        assert -r.force(name)[0] == pytest.approx(force, abs=ROUND_OFF * size)
        k = r.connections.index(name)
        assert -r.moments[0, k] == pytest.approx(couple, abs=ROUND_OFF * size)


def test_a_boom_held_by_a_jack() -> None:
    """The jack has no mass: its force is along it, and the pin at the heel bears the rest."""
    along = HEEL + turned(LUFF, LIFT[0], vector(JACK[1] - HEEL))[0] - JACK[0]
    length = float(np.linalg.norm(along))
    still = replace(StateDrive(*SLEW), rate=0.0, second=0.0)
    solved = _solved(("slew", "jack"), still, StateDrive(length))
    force, moment = _wrench_at_heel(0.0)
    push, arm, e = _slewed(along / length), _of_boom(JACK[1] - HEEL), _slewed(LUFF)
    thrust = float((moment @ e) / (e @ np.cross(arm, push)))
    size = abs(thrust) * length
    assert solved.drive[0, 1] == pytest.approx(thrust, rel=ROUND_OFF)
    r = solved.reactions
    assert -r.force("Y")[0] == pytest.approx(force - thrust * push, abs=ROUND_OFF * size)
    couple = moment - thrust * np.cross(arm, push)
    assert -r.moments[0, 1] == pytest.approx(couple, abs=ROUND_OFF * size)

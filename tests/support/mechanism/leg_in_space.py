"""The leg of `leg_of_particles` as a linkage in space on a moving ground, solved by loads.space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from loads import StateDrive
from loads.space.dynamics import SpaceDynamics, space_reactions
from loads.space.ground import BodyMomenta, GroundInertia, GroundState, body_momenta
from loads.space.linkage import Inertia, JointAngle, RigidBody, SpaceJoint, SpaceLinkage
from loads.space.motion import space_move
from tests.support.mechanism.leg_of_particles import (
    Complex,
    Floats,
    Leg,
    Particles,
    Wave,
    derivative,
)

Y, SPIN_AXIS = (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0)


def leg_linkage(leg: Leg) -> SpaceLinkage:
    """Return the leg and its wheel as drawn at beta = 0 on the aircraft, whose axes are the
    ground's.
    """
    hinge = np.array([leg.l1, 0.0, leg.l2])
    wheel = tuple((hinge - [leg.l4, 0.0, leg.l3]).tolist())
    centre = tuple((hinge - [0.25 * leg.l4, 0.0, 0.75 * leg.l3]).tolist())
    transverse = leg.wheel_transverse
    inertia = np.diag([leg.wheel_axial, transverse, transverse])
    weight = leg.gravity * np.array([0.0, -np.sin(leg.slope), -np.cos(leg.slope)])
    return SpaceLinkage(
        (
            RigidBody("leg", leg.leg_mass, centre, _rows(leg.leg_inertia)),
            RigidBody("wheel", leg.wheel_mass, wheel, _rows(inertia)),
        ),
        (
            SpaceJoint("B", "revolute", "ground", "leg", tuple(hinge.tolist()), Y),
            SpaceJoint("C", "revolute", "leg", "wheel", wheel, SPIN_AXIS),
        ),
        (JointAngle("fold", "B"), JointAngle("spin", "C")),
        ("fold", "spin"),
        tuple(weight.tolist()),
    )


def _rows(tensor: Floats) -> Inertia:
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = np.asarray(tensor).tolist()
    return (xx, xy, xz), (yx, yy, yz), (zx, zy, zz)


def solved(
    leg: Leg, drives: Sequence[tuple[float, float, float]], ground: GroundState
) -> tuple[SpaceDynamics, BodyMomenta]:
    """Return the dynamics and momenta at one instant.

    drives: value and rates of fold angle and spin. ground: its state, T = 1.
    """
    motion = space_move(leg_linkage(leg), [StateDrive(*d) for d in drives], np.zeros(1))
    dynamics = space_reactions("leg", motion, [GroundInertia(lambda times: ground)], timed=False)
    return dynamics, body_momenta(motion, lambda times: ground)


def quantities(particles: Particles, now: float) -> tuple[dict[str, Floats], Floats]:
    """Return every quantity at one instant in primed axes, and the matrix from these to the
    world's.
    """
    leg, t = particles.leg, np.array([now + 0j])
    state = ground_of(particles, now)
    drives = [_rates(wave, t) for wave in (particles.beta, particles.spin)]
    dynamics, bodies = solved(leg, drives, state)
    reactions, motion = dynamics.reactions, dynamics.motion
    found: dict[str, Floats] = {}
    for k, (body, point) in enumerate((("leg", "D"), ("wheel", "C"))):
        found |= {
            f"v_{point}": bodies.velocity[0, k],
            f"a_{point}": bodies.acceleration[0, k],
            f"r_{point}": bodies.centre[0, k],
            f"coriolis_{point}": bodies.coriolis[0, k],
            f"omega {body}": bodies.spin[0, k],
            f"alpha {body}": bodies.spin_rate[0, k],
            f"p {body}": bodies.momentum[0, k],
            f"p rate {body}": bodies.momentum_rate[0, k],
            f"L {body}": bodies.angular_momentum[0, k],
            f"L rate {body}": bodies.angular_momentum_rate[0, k],
        }
    # The study's drive turns the leg about y' at B: its reaction is part of the moment at B.
    actuator, spin_moment = dynamics.drive[0]
    found["F_B"] = reactions.forces[0, 0]
    found["M_B"] = reactions.moments[0, 0] - actuator * np.array(Y)
    found["actuator"], found["spin moment"] = np.array([actuator]), np.array([spin_moment])
    found["kinetic energy"] = bodies.kinetic_energy.sum(axis=1)
    hinge = np.array([leg.l1, 0.0, leg.l2])
    found["r_BC"], found["r_BD"] = found["r_C"] - hinge, found["r_D"] - hinge
    assert np.abs(motion.point("leg", tuple(hinge.tolist()))[0] - hinge).max() < 1e-9
    return found, particles.aircraft(t)[0].real


def ground_of(particles: Particles, now: float) -> GroundState:
    """Return the aircraft's motion at one instant, by differentiating its position and
    its matrix.
    """
    t = np.array([now + 0j])
    origin, axes = particles.a(now), particles.aircraft
    R, rate, second = (x[0].real for x in (axes(t), derivative(axes, t), derivative(axes, t, 2)))
    velocity, acceleration = (derivative(origin, t, n)[0].real for n in (1, 2))
    spin, spin_rate = _axial(rate @ R.T), _axial(second @ R.T + rate @ rate.T)
    slope = particles.leg.slope
    c, s = np.cos(slope), np.sin(slope)
    on_slope = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    v, a, w, rate = ((R.T @ x)[None] for x in (velocity, acceleration, spin, spin_rate))
    return GroundState(v, a, w, rate, (on_slope.T @ R)[None])


def _axial(skew: Floats) -> Floats:
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])


def _rates(wave: Wave, t: Complex) -> tuple[float, float, float]:
    value, rate, second = (
        float(x[0].real) for x in (wave(t), *(derivative(wave, t, n) for n in (1, 2)))
    )
    return value, rate, second

"""A linkage in space on a moving ground: against particles carried by matrices, balances, and by
hand.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loads import ConstantDrive
from loads.space.dynamics import space_reactions
from loads.space.ground import GroundInertia, GroundState, TurningGround, rotation_about
from loads.space.linkage import JointAngle, RigidBody, SpaceJoint, SpaceLinkage
from loads.space.motion import space_move
from tests.support.each import each
from tests.support.mechanism.leg_in_space import quantities, solved
from tests.support.mechanism.leg_of_particles import (
    Complex,
    Floats,
    Function,
    Leg,
    Particles,
    derivative,
    random_particles,
)

TIMES = (0.4, 1.3)
SEEDS = range(3)
G = 9.80665
FINITE = st.floats(-3.0, 3.0, allow_nan=False)
LEG = Leg(
    l1=1.0,
    l2=0.2,
    l3=1.2,
    l4=0.3,
    leg_mass=40.0,
    wheel_mass=25.0,
    leg_inertia=np.array([[5.0, 0.1, 0.3], [0.1, 5.2, -0.2], [0.3, -0.2, 0.4]]),
    wheel_axial=1.5,
    wheel_transverse=0.9,
    slope=0.0,
    gravity=G,
)


# Particles of a seed at one instant.
INSTANTS = each(("seed", "now"), list(product(SEEDS, TIMES)))


@cache
def at_instant(seed: int, now: float) -> tuple[Particles, dict[str, Floats], Floats]:
    """Particles, every quantity of the leg that they are along the aircraft's axes, and the matrix
    from these to the world's. The aircraft's course is straight, follows the yaw, or is between.
    """
    particles = random_particles(seed, (0.0, 1.0, None)[seed % 3])
    return particles, *quantities(particles, now)


def agree(found: Floats, wanted: Floats, rel: float = 1e-9) -> None:
    """Every component to `rel` of the largest."""
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=rel * np.abs(wanted).max())


def near(wanted: object) -> object:
    """Forces and moments of hundreds of N and N m, to round-off."""
    return pytest.approx(wanted, abs=1e-9)


NO_TURN = TurningGround()


def at(
    leg: Leg = LEG,
    ground: TurningGround | GroundState = NO_TURN,
    fold: tuple[float, float, float] = (0.0, 0.0, 0.0),
    spin: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> tuple[Floats, Floats, float, float]:
    """Force and moment on the hinge, the moments of the fold and the spin, at one instant."""
    state = ground(np.zeros(1)) if isinstance(ground, TurningGround) else ground
    dynamics, _ = solved(leg, (fold, spin), state)
    actuator, spin_moment = dynamics.drive[0].tolist()
    moment = dynamics.reactions.moments[0, 0] - [0.0, actuator, 0.0]
    return dynamics.reactions.forces[0, 0], moment, actuator, spin_moment


@INSTANTS
def test_motions_and_momenta_are_those_of_the_particles(seed: int, now: float) -> None:
    particles, found, R = at_instant(seed, now)
    times = np.array([now])
    for body, point, masses in (
        ("leg", "D", particles.leg_masses),
        ("wheel", "C", particles.wheel_masses),
    ):
        _, v, a = (x[0, 0] for x in particles.state(times, point))
        agree(R @ found[f"v_{point}"], v)
        agree(R @ found[f"a_{point}"], a)
        r, v, a = (x[0] for x in particles.state(times, body))
        centre = particles.state(times, point)[0][0, 0]
        mv, ma, arm = masses[:, None] * v, masses[:, None] * a, r - centre
        agree(R @ found[f"p {body}"], mv.sum(axis=0))
        agree(R @ found[f"p rate {body}"], ma.sum(axis=0))
        agree(R @ found[f"L {body}"], np.cross(arm, mv).sum(axis=0))
        agree(R @ found[f"L rate {body}"], np.cross(arm, ma).sum(axis=0))


def whole(particles: Particles, now: float) -> Function:
    """Of leg and wheel together, in the world, (T, 7): linear momentum, angular momentum about the
    moving B, kinetic energy.
    """
    hinge = particles.carried(now, "B")

    def state(t: Complex) -> Complex:
        total = np.zeros((len(t), 7), dtype=complex)
        for body, masses in (("leg", particles.leg_masses), ("wheel", particles.wheel_masses)):
            f = particles.carried(now, body)
            r, v = f(t), derivative(f, t)
            momentum = masses[:, None] * v
            total[:, :3] += momentum.sum(axis=1)
            total[:, 3:6] += np.cross(r - hinge(t), momentum).sum(axis=1)
            total[:, 6] += 0.5 * np.sum(momentum * v, axis=(1, 2))
        return total

    return state


@INSTANTS
def test_force_moment_and_power_by_the_momentum_of_the_whole(seed: int, now: float) -> None:
    """dp/dt = -F_B + weight; dH_B/dt + v_B x p = -M_B + moment of the weight about B; and the power
    of all these and of the spin moment is the rate of the kinetic energy.
    """
    particles, found, R = at_instant(seed, now)
    F, M, t = R @ found["F_B"], R @ found["M_B"], np.array([now + 0j])
    state = whole(particles, now)
    value, rate = state(t)[0].real, derivative(state, t)[0].real
    hinge = particles.carried(now, "B")
    v_B = derivative(hinge, t)[0, 0].real
    weight, moment, power = np.zeros(3), np.zeros(3), 0.0
    for body, masses in (("leg", particles.leg_masses), ("wheel", particles.wheel_masses)):
        arm = (particles.carried(now, body)(t) - hinge(t))[0].real
        down = np.array([0.0, 0.0, -particles.leg.gravity])
        weight = weight + masses.sum() * down
        moment = moment + np.cross(masses @ arm, down)
        power += float(down @ (R @ found[f"p {body}"]))
    agree(F, weight - rate[:3])
    agree(M, moment - rate[3:6] - np.cross(v_B, value[:3]))
    assert found["kinetic energy"][0] == pytest.approx(value[6], rel=1e-9)
    spin_rate = float(derivative(particles.spin, t)[0].real)
    terms = (-F @ v_B, -M @ (R @ found["omega leg"]), power, found["spin moment"][0] * spin_rate)
    assert sum(terms) == pytest.approx(rate[6], abs=1e-9 * max(map(abs, terms)))


@INSTANTS
def test_the_actuator_by_virtual_work(seed: int, now: float) -> None:
    """d'Alembert: the actuator's work over a small turn of beta is that of all particles' inertia
    and weight over the displacements it makes (a complex step of beta).
    """
    particles, found, _ = at_instant(seed, now)
    step, beta, t = 1e-30, particles.beta, np.array([now + 0j])
    tilted = replace(particles, beta=replace(beta, offset=beta.offset + step * 1j))
    work = 0.0
    for body, masses in (("leg", particles.leg_masses), ("wheel", particles.wheel_masses)):
        inertia = derivative(particles.carried(now, body), t, 2)[0].real
        inertia[:, 2] += particles.leg.gravity
        displacement = tilted.carried(now, body)(t)[0].imag / step
        work += float(np.sum(masses[:, None] * inertia * displacement))
    assert found["actuator"][0] == pytest.approx(work, rel=1e-8)


def test_a_still_ground_adds_nothing() -> None:
    force, moment, actuator, spin_moment = at()
    weight = (LEG.leg_mass + LEG.wheel_mass) * G
    assert force == near([0.0, 0.0, -weight])
    # At beta = 0 C and D lie l4 and l4/4 to the left of B: their weight turns the leg about -y'.
    sag = -G * (LEG.leg_mass * 0.25 * LEG.l4 + LEG.wheel_mass * LEG.l4)
    assert moment == near([0.0, sag, 0.0])
    assert actuator == near(-sag)
    assert spin_moment == near(0.0)


def test_on_a_slope_the_weight_stays_vertical_as_the_ground_turns() -> None:
    """At 1.1 rad of heading on a slope of 0.2 rad, the weight along the aircraft's axes."""
    leg = replace(LEG, slope=0.2)
    t = np.array([2.0])
    state = TurningGround(rate=0.3, rate_change=0.25)(t)  # 0.6 + 0.5 rad
    force = at(leg, replace(NO_TURN(np.zeros(1)), turn=state.turn))[0]
    weight = (LEG.leg_mass + LEG.wheel_mass) * G
    ahead = np.array([-np.sin(1.1), np.cos(1.1)])  # y' of the slope's x and y
    uphill = np.array([ahead @ [0.0, 1.0], np.array([np.cos(1.1), np.sin(1.1)]) @ [0.0, 1.0]])
    wanted = [-np.sin(0.2) * uphill[1], -np.sin(0.2) * uphill[0], -np.cos(0.2)]
    assert force == near(weight * np.array(wanted))


def test_pure_yaw_is_centripetal() -> None:
    """A stands; C and D circle about z' through A, the leg pulls B outwards."""
    force, moment, *_ = at(replace(LEG, gravity=0.0), TurningGround(rate=2.0))
    x_C, x_D = LEG.l1 - LEG.l4, LEG.l1 - 0.25 * LEG.l4
    pull = 4.0 * (LEG.wheel_mass * x_C + LEG.leg_mass * x_D)
    assert force == near([pull, 0.0, 0.0])
    # The pull acts below B; the product of inertia and the tilted axes add the rest.
    below = 4.0 * (
        LEG.wheel_mass * x_C * -LEG.l3 + LEG.leg_mass * x_D * -0.75 * LEG.l3 - LEG.leg_inertia[0, 2]
    )
    assert moment[1] == near(below)
    assert moment[0] == near(4.0 * LEG.leg_inertia[1, 2])


def test_a_course_that_follows_the_yaw_pulls_outwards() -> None:
    """Driving round a circle with A on it: v omega towards the centre, left of the aircraft."""
    ahead = TurningGround(velocity=(0.0, 8.0, 0.0), rate=0.5)
    straight, turning = at(LEG, replace(ahead, straight=True))[0], at(LEG, ahead)[0]
    assert turning - straight == near([4.0 * (LEG.leg_mass + LEG.wheel_mass), 0.0, 0.0])


@each("fold", [0.0, 0.7, np.pi / 2])
def test_the_gyroscopic_couple(fold: float) -> None:
    """Folding tips the spin vector -omega_w x''' towards +z''', so the leg turns B about -z'''."""
    spinning, stopped = (at(fold=(fold, 0.5, 0.0), spin=(0.0, x, 0.0)) for x in (60.0, 0.0))
    c, s = np.cos(fold), np.sin(fold)
    couple = -LEG.wheel_axial * 60.0 * 0.5 * np.array([s, 0.0, c])  # z''' is (sin, 0, cos)
    assert spinning[1] - stopped[1] == near(couple)
    assert spinning[2] == near(stopped[2])


def test_yaw_of_a_spinning_wheel_loads_the_actuator() -> None:
    """Wheel hanging, yaw to the left: the spin vector along -x' moves towards -y'."""
    spinning, stopped = (at(LEG, TurningGround(rate=0.3), spin=(0.0, x, 0.0)) for x in (60.0, 0.0))
    couple = LEG.wheel_axial * 60.0 * 0.3
    assert spinning[1] - stopped[1] == near([0.0, couple, 0.0])
    assert spinning[2] - stopped[2] == near(-couple)


def test_braking_the_wheel_turns_the_leg_with_it() -> None:
    """A wheel that rolls ahead and is braked drags the leg about its own spin, -x'''."""
    _, moment, _, spin_moment = at(replace(LEG, gravity=0.0), spin=(0.0, 60.0, -20.0))
    assert spin_moment == near(-20.0 * LEG.wheel_axial)
    assert moment == near([-20.0 * LEG.wheel_axial, 0.0, 0.0])


@settings(max_examples=8, deadline=None)
@given(st.lists(FINITE, min_size=3, max_size=3), st.lists(FINITE, min_size=3, max_size=3))
def test_gravity_and_acceleration_are_the_same(up: list[float], also: list[float]) -> None:
    """A ground that speeds up is one on which gravity is less by its acceleration."""
    body = RigidBody("b", 2.0, (0.3, 0.1, -0.4), ((1.0, 0.1, 0.0), (0.1, 1.2, 0.2), (0, 0.2, 0.9)))
    joint = SpaceJoint("J", "revolute", "ground", "b", (0.0, 0.0, 0.0), (0.2, 1.0, 0.3))

    def solve(gravity: Floats, speed_up: list[float]) -> Floats:
        angle = (JointAngle("a", "J"),)
        linkage = SpaceLinkage((body,), (joint,), angle, ("a",), tuple(gravity.tolist()))
        motion = space_move(linkage, [ConstantDrive(0.0, 2.0, 1.0)], np.linspace(0.0, 1.0, 4))
        x, y, z = speed_up
        load = GroundInertia(TurningGround(speed_up=(x, y, z)))
        dynamics = space_reactions("x", motion, [load])
        r = dynamics.reactions
        assert np.abs(dynamics.imbalance).max() < 1e-9
        return np.concatenate([r.forces[:, 0], r.moments[:, 0], dynamics.drive], axis=1)

    gravity = np.array(also)
    there, here = solve(gravity, up), solve(gravity - up, [0.0, 0.0, 0.0])
    np.testing.assert_allclose(there, here, atol=1e-9)


def test_a_turntable_is_one_more_joint() -> None:
    """A pendulum on a ground that turns faster and faster about a skew axis has the forces of one
    on a body that a drive turns so; along the axes of that body.
    """
    axis, end = np.array([0.2, -0.5, 1.0]), 1.2
    unit = axis / np.linalg.norm(axis)
    inertia = ((0.5, 0.05, 0.0), (0.05, 0.8, 0.1), (0.0, 0.1, 0.6))
    arm = RigidBody("arm", 3.0, (0.7, 0.2, -0.5), inertia)
    hinge = SpaceJoint("H", "revolute", "ground", "arm", (0.6, 0.1, 0.0), (1.0, 0.3, 0.0))
    gravity, swing = (0.5, -1.0, -9.0), ConstantDrive(0.0, 1.5, end)
    times, rate, change = np.linspace(0.0, end, 7), 0.9, 1.4

    class Turn:
        """rate t + change t^2 / 2."""

        @property
        def pieces(self) -> tuple[float, ...]:
            return 0.0, end

        corners = pieces

        def __call__(self, times: Floats) -> tuple[Floats, Floats, Floats]:
            speed = rate + change * times
            return rate * times + 0.5 * change * times**2, speed, change + 0.0 * times

    alone = SpaceLinkage((arm,), (hinge,), (JointAngle("s", "H"),), ("s",), gravity)
    load = GroundInertia(TurningGround(axis=tuple(axis), rate=rate, rate_change=change))
    ours = space_reactions("ground", space_move(alone, [swing], times), [load])
    table = RigidBody("table", 1.0, (0.0, 0.0, 0.0))
    shaft = SpaceJoint("T", "revolute", "ground", "table", (0.0, 0.0, 0.0), tuple(axis))
    both = SpaceLinkage(
        (table, arm),
        (shaft, replace(hinge, base="table")),
        (JointAngle("t", "T"), JointAngle("s", "H")),
        ("t", "s"),
        gravity,
    )
    whole_ = space_reactions("table", space_move(both, [Turn(), swing], times))
    turn = rotation_about(unit, Turn()(times)[0])
    for key in ("forces", "moments"):
        seen = np.einsum("tji,tj->ti", turn, getattr(whole_.reactions, key)[:, 1])
        agree(getattr(ours.reactions, key)[:, 0], seen)
    agree(ours.drive[:, 0], whole_.drive[:, 1])


def test_the_course_that_turns_is_the_path_of_its_velocity() -> None:
    """Velocity and turn of TurningGround along its path in the world, differentiated."""
    ground = TurningGround((1.0, 8.0, 0.5), (0.2, 1.5, -0.1), (0.0, 0.3, 1.0), 0.3, 0.05)
    t, h = np.array([0.7]), 1e-5
    now, before, after = (ground(t + dt) for dt in (0.0, -h, h))
    world = [(s.turn @ s.velocity[..., None])[..., 0] for s in (before, after)]
    acceleration = (now.turn @ now.acceleration[..., None])[..., 0]
    np.testing.assert_allclose(acceleration, (world[1] - world[0]) / (2 * h), atol=1e-8)
    rate = (after.turn - before.turn) / (2 * h) @ np.swapaxes(now.turn, -1, -2)
    spin = (now.turn @ now.spin[..., None])[0, :, 0]
    np.testing.assert_allclose([rate[0, 2, 1], rate[0, 0, 2], rate[0, 1, 0]], spin, atol=1e-8)
    np.testing.assert_allclose((after.spin - before.spin) / (2 * h), now.spin_rate, atol=1e-9)

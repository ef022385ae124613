"""The spatial leg: against particles carried by matrices, against balances, and by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loads import ArgumentError, Contact, LegDynamics, LegMotion, SpatialLeg, leg_dynamics
from loads.forces.spatial_leg import t1, t2
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.leg_of_particles import (
    Complex,
    Floats,
    Function,
    Particles,
    derivative,
    random_particles,
    turn,
)

TIMES = np.array([0.0, 0.4, 1.3])
SEEDS = range(6)
G = 9.80665
NAMES = ("v_v", "a_v", "omega_g", "alpha_g", "beta", "omega_i", "alpha_i", "omega_w", "alpha_w")
FINITE = st.floats(-3.0, 3.0, allow_nan=False)

LEG = SpatialLeg(
    l1=1.0,
    l2=0.2,
    l3=1.2,
    l4=0.3,
    leg_mass=40.0,
    wheel_mass=25.0,
    leg_inertia=np.array([[5.0, 0.1, 0.3], [0.1, 5.2, -0.2], [0.3, -0.2, 0.4]]),
    wheel_axial=1.5,
    wheel_transverse=0.9,
    gravity=G,
)


def still(**rates: float) -> LegMotion:
    """One instant at rest but for the named rates; A's path straight."""
    return LegMotion(**{name: np.array([rates.get(name, 0.0)]) for name in (*NAMES, "course_rate")})


@pytest.fixture(params=SEEDS)
def particles(request: pytest.FixtureRequest) -> Particles:
    """One per seed; A's course straight, following the yaw, or between."""
    seed: int = request.param
    return random_particles(seed, (0.0, 1.0, None)[seed % 3])


@pytest.fixture
def ours(particles: Particles) -> LegDynamics:
    return leg_dynamics(particles.leg, particles.motion(TIMES))


def agree(found: Floats, wanted: Floats, rel: float = 1e-9) -> None:
    """Every component to `rel` of the largest."""
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=rel * np.abs(wanted).max())


def angular_rates(particles: Particles, wheel: bool) -> tuple[Floats, Floats]:
    """Rotation in the world and its rate from the orientation: R' R^T and its derivative."""

    def orientation(t: Complex) -> Complex:
        matrix = particles.aircraft(t) @ turn(1, particles.beta(t))
        return np.asarray(matrix @ turn(0, -particles.spin(t))) if wheel else np.asarray(matrix)

    t = TIMES.astype(complex)
    r, r1, r2 = orientation(t), derivative(orientation, t), derivative(orientation, t, 2)
    back = np.swapaxes(r, 1, 2)
    skew = (r1 @ back, r2 @ back + r1 @ np.swapaxes(r1, 1, 2))
    omega, alpha = (np.stack([m[:, 2, 1], m[:, 0, 2], m[:, 1, 0]], axis=1).real for m in skew)
    return omega, alpha


def test_rotations_are_those_of_the_matrices(particles: Particles, ours: LegDynamics) -> None:
    omega, alpha = angular_rates(particles, wheel=False)
    agree(ours.to_world(ours.leg_omega), omega)
    agree(ours.to_world(ours.leg_alpha), alpha)
    omega, alpha = angular_rates(particles, wheel=True)
    agree(ours.to_world(ours.wheel_omega), omega)
    agree(ours.to_world(ours.wheel_alpha), alpha)


@each("point", ["B", "C", "D"])
def test_points_move_as_the_matrices_carry_them(
    particles: Particles, ours: LegDynamics, point: str
) -> None:
    _, v, a = particles.state(TIMES, point)
    agree(ours.to_world(getattr(ours, f"v_{point}")), v[:, 0])
    agree(ours.to_world(getattr(ours, f"a_{point}")), a[:, 0])


def test_arms(particles: Particles, ours: LegDynamics) -> None:
    r_B, r_C, r_D = (particles.state(TIMES, point)[0][:, 0] for point in "BCD")
    agree(ours.to_world(ours.r_BC), r_C - r_B)
    agree(ours.to_world(ours.r_BD), r_D - r_B)


def test_the_coriolis_part(ours: LegDynamics) -> None:
    """What is left of a_C without a_B, the turning axes' own part and the folding seen from them.
    Their derivative in x''y''z'' is that of the components.
    """
    motion = ours.motion
    r, yaw = ours.r_BC, np.zeros_like(ours.r_BC)
    fold, yaw_rate, fold_rate = yaw.copy(), yaw.copy(), yaw.copy()
    yaw[:, 2], yaw_rate[:, 2] = motion.omega_g, motion.alpha_g
    fold[:, 1], fold_rate[:, 1] = motion.omega_i, motion.alpha_i
    seen = np.cross(fold_rate, r) + np.cross(fold, np.cross(fold, r))
    carried = ours.a_B + np.cross(yaw_rate, r) + np.cross(yaw, np.cross(yaw, r))
    agree(ours.coriolis_C, ours.a_C - carried - seen)
    agree(ours.coriolis_C, 2.0 * np.cross(yaw, np.cross(fold, r)))


@each("body", ["leg", "wheel"])
def test_momenta_are_those_of_the_particles(
    particles: Particles, ours: LegDynamics, body: str
) -> None:
    masses = getattr(particles, f"{body}_masses")[:, None]
    r, v, a = particles.state(TIMES, body)
    centre = particles.state(TIMES, "D" if body == "leg" else "C")[0]
    agree(ours.to_world(getattr(ours, f"p_{body}")), np.sum(masses * v, axis=1))
    agree(ours.to_world(getattr(ours, f"p_{body}_rate")), np.sum(masses * a, axis=1))
    arm = r - centre
    agree(ours.to_world(getattr(ours, f"L_{body}")), np.sum(np.cross(arm, masses * v), axis=1))
    agree(ours.to_world(getattr(ours, f"L_{body}_rate")), np.sum(np.cross(arm, masses * a), axis=1))


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


def test_force_moment_and_power_by_the_momentum_of_the_whole(
    particles: Particles, ours: LegDynamics
) -> None:
    """dp/dt = -F_B + weight; dH_B/dt + v_B x p = -M_B + moment of the weight about B; and the power
    of all these and of the spin moment is the rate of the kinetic energy.
    """
    F_B, M_B = ours.to_world(ours.F_B), ours.to_world(ours.M_B)
    down = np.array([0.0, 0.0, -particles.leg.gravity])
    power = (
        -ours.F_B * ours.v_B
        - ours.M_B * ours.leg_omega
        + ours.weight_leg * ours.v_D
        + ours.weight_wheel * ours.v_C
    ).sum(axis=1) + ours.spin_moment * ours.motion.omega_w
    for i, now in enumerate(TIMES):
        t = np.array([now + 0j])
        state = whole(particles, now)
        value, rate = state(t)[0].real, derivative(state, t)[0].real
        hinge = particles.carried(now, "B")
        v_B = derivative(hinge, t)[0, 0].real
        weight, moment = np.zeros(3), np.zeros(3)
        for body, masses in (("leg", particles.leg_masses), ("wheel", particles.wheel_masses)):
            arm = (particles.carried(now, body)(t) - hinge(t))[0].real
            weight = weight + masses.sum() * down
            moment = moment + np.cross(masses @ arm, down)
        agree(F_B[i], weight - rate[:3])
        agree(M_B[i], moment - rate[3:6] - np.cross(v_B, value[:3]))
        assert ours.kinetic_energy[i] == pytest.approx(value[6], rel=1e-10)
        assert power[i] == pytest.approx(rate[6], rel=1e-9, abs=1e-9 * np.abs(power).max())


def test_ground_and_brake_share_the_spin(particles: Particles, ours: LegDynamics) -> None:
    """The ground's force adds to F_B, its moment to M_B; and the power still balances with the
    force acting on the tyre's point.
    """
    rng = np.random.default_rng(1)
    contact = Contact(rng.normal(size=(3, 3)) * 1e3, rng.normal(size=(3, 3)))
    on_ground = leg_dynamics(particles.leg, particles.motion(TIMES), contact)
    agree(on_ground.F_B - ours.F_B, contact.force)
    agree(on_ground.M_B - ours.M_B, np.cross(ours.r_BC + contact.arm, contact.force))
    tyre = ours.v_C + np.cross(ours.wheel_omega, contact.arm)
    change = (
        -(on_ground.F_B - ours.F_B) * ours.v_B
        - (on_ground.M_B - ours.M_B) * ours.leg_omega
        + contact.force * tyre
    ).sum(axis=1)
    agree(change, -(on_ground.spin_moment - ours.spin_moment) * ours.motion.omega_w)


def test_the_actuator_by_virtual_work(particles: Particles, ours: LegDynamics) -> None:
    """d'Alembert: the actuator's work over a small turn of beta is that of all particles' inertia
    and weight over the displacements it makes (a complex step of beta).
    """
    step = 1e-30
    beta = particles.beta
    tilted = replace(particles, beta=replace(beta, offset=beta.offset + step * 1j))
    for i, now in enumerate(TIMES):
        t = np.array([now + 0j])
        work = 0.0
        for body, masses in (("leg", particles.leg_masses), ("wheel", particles.wheel_masses)):
            inertia = derivative(particles.carried(now, body), t, 2)[0].real
            inertia[:, 2] += particles.leg.gravity
            displacement = tilted.carried(now, body)(t)[0].imag / step
            work += float(np.sum(masses[:, None] * inertia * displacement))
        assert ours.actuator[i] == pytest.approx(work, rel=1e-9)


def test_at_rest_the_leg_hangs_its_weight() -> None:
    ours = leg_dynamics(LEG, still())
    weight = (LEG.leg_mass + LEG.wheel_mass) * G
    assert ours.F_B[0] == pytest.approx([0.0, 0.0, -weight])
    # At beta = 0 C and D lie l4 and l4/4 to the left of B: their weight turns the leg about -y'.
    sag = -G * (LEG.leg_mass * 0.25 * LEG.l4 + LEG.wheel_mass * LEG.l4)
    assert ours.M_B[0] == pytest.approx([0.0, sag, 0.0])
    assert ours.actuator[0] == pytest.approx(-sag)
    assert ours.spin_moment[0] == 0.0
    assert ours.kinetic_energy[0] == 0.0


def test_on_a_slope_the_weight_stays_vertical() -> None:
    leg = replace(LEG, slope=0.2)
    for heading in (0.0, 1.1):
        ours = leg_dynamics(leg, replace(still(), heading=np.array([heading])))
        weight = (LEG.leg_mass + LEG.wheel_mass) * G
        assert ours.to_world(ours.F_B)[0] == pytest.approx([0.0, 0.0, -weight])
    level = leg_dynamics(leg, still())
    assert level.F_B[0] == pytest.approx(weight * np.array([0.0, -np.sin(0.2), -np.cos(0.2)]))


def test_pure_yaw_is_centripetal() -> None:
    """A stands; C and D circle about z' through A, the leg pulls B outwards."""
    ours = leg_dynamics(replace(LEG, gravity=0.0), still(omega_g=2.0))
    x_C, x_D = LEG.l1 - LEG.l4, LEG.l1 - 0.25 * LEG.l4
    pull = 4.0 * (LEG.wheel_mass * x_C + LEG.leg_mass * x_D)
    assert ours.F_B[0] == pytest.approx([pull, 0.0, 0.0])
    # The pull acts below B; the product of inertia and the tilted axes add the rest.
    below = 4.0 * (
        LEG.wheel_mass * x_C * -LEG.l3 + LEG.leg_mass * x_D * -0.75 * LEG.l3 - LEG.leg_inertia[0, 2]
    )
    assert ours.M_B[0, 1] == pytest.approx(below)
    assert ours.M_B[0, 0] == pytest.approx(4.0 * LEG.leg_inertia[1, 2])


def test_a_course_that_follows_the_yaw_pulls_outwards() -> None:
    """Driving round a circle with A on it: v_v omega_g towards the centre, left of the aircraft."""
    straight = leg_dynamics(LEG, still(v_v=8.0, omega_g=0.5))
    round_ = leg_dynamics(LEG, still(v_v=8.0, omega_g=0.5, course_rate=0.5))
    mass = LEG.leg_mass + LEG.wheel_mass
    assert (round_.a_C - straight.a_C)[0] == pytest.approx([-4.0, 0.0, 0.0])
    assert (round_.F_B - straight.F_B)[0] == pytest.approx([4.0 * mass, 0.0, 0.0])


@each("beta", [0.0, 0.7, np.pi / 2])
def test_the_gyroscopic_couple(beta: float) -> None:
    """Folding tips the spin vector -omega_w x''' towards +z''', so the leg turns B about -z'''."""
    spinning = leg_dynamics(LEG, still(beta=beta, omega_i=0.5, omega_w=60.0))
    stopped = leg_dynamics(LEG, still(beta=beta, omega_i=0.5))
    couple = spinning.to_leg(spinning.M_B - stopped.M_B)[0]
    assert couple == pytest.approx([0.0, 0.0, -LEG.wheel_axial * 60.0 * 0.5])
    assert spinning.actuator == pytest.approx(stopped.actuator)


def test_yaw_of_a_spinning_wheel_loads_the_actuator() -> None:
    """Wheel hanging, yaw to the left: the spin vector along -x' moves towards -y'."""
    spinning = leg_dynamics(LEG, still(omega_g=0.3, omega_w=60.0))
    stopped = leg_dynamics(LEG, still(omega_g=0.3))
    couple = LEG.wheel_axial * 60.0 * 0.3
    assert (spinning.M_B - stopped.M_B)[0] == pytest.approx([0.0, couple, 0.0])
    assert spinning.actuator - stopped.actuator == pytest.approx(-couple)


def test_braking_the_wheel_turns_the_leg_with_it() -> None:
    """A wheel that rolls ahead and is braked drags the leg about its own spin, -x'''."""
    ours = leg_dynamics(replace(LEG, gravity=0.0), still(omega_w=60.0, alpha_w=-20.0))
    assert ours.spin_moment[0] == pytest.approx(-20.0 * LEG.wheel_axial)
    assert ours.M_B[0] == pytest.approx([-20.0 * LEG.wheel_axial, 0.0, 0.0])


def test_a_rolling_wheel_does_not_slip() -> None:
    """omega_w = v / R rolls ahead: the tyre's lowest point stands still."""
    ours = leg_dynamics(LEG, still(v_v=9.0, omega_w=30.0))
    assert (ours.v_C + np.cross(ours.wheel_omega, [[0.0, 0.0, -0.3]]))[0] == pytest.approx(
        [0.0, 0.0, 0.0]
    )


RATES = st.fixed_dictionaries(dict.fromkeys(NAMES, FINITE))


@settings(max_examples=50)
@given(RATES, FINITE)
def test_run_backwards_the_forces_are_the_same(rates: dict[str, float], course: float) -> None:
    """Speeds change sign with time, accelerations and forces do not."""
    back = {k: -v if k[:5] in ("v_v", "omega") else v for k, v in rates.items()}
    ahead = leg_dynamics(LEG, still(**rates, course_rate=course))
    behind = leg_dynamics(LEG, still(**back, course_rate=-course))
    np.testing.assert_allclose(behind.F_B, ahead.F_B, atol=1e-9)
    np.testing.assert_allclose(behind.M_B, ahead.M_B, atol=1e-9)
    np.testing.assert_allclose(behind.spin_moment, ahead.spin_moment, atol=1e-9)


@settings(max_examples=50)
@given(RATES, FINITE)
def test_gravity_and_acceleration_are_the_same(rates: dict[str, float], gravity: float) -> None:
    """The part of gravity along the slope is as good as driving harder up a level."""
    slope = 0.4
    inclined = leg_dynamics(replace(LEG, slope=slope, gravity=gravity), still(**rates))
    rates["a_v"] += gravity * np.sin(slope)
    pushed = leg_dynamics(replace(LEG, gravity=gravity * np.cos(slope)), still(**rates))
    np.testing.assert_allclose(inclined.F_B, pushed.F_B, atol=1e-9)
    np.testing.assert_allclose(inclined.M_B, pushed.M_B, atol=1e-9)


@given(FINITE, FINITE)
def test_axes_are_rotations(slope: float, beta: float) -> None:
    for matrix in (t1(slope), t2(np.array([beta]))[0]):
        np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-15)
        assert np.linalg.det(matrix) == pytest.approx(1.0)


def test_an_instant_does_not_depend_on_the_others() -> None:
    particles = random_particles(7)
    together = leg_dynamics(particles.leg, particles.motion(TIMES))
    alone = leg_dynamics(particles.leg, particles.motion(TIMES[1:2]))
    assert together.M_B[1] == pytest.approx(alone.M_B[0], rel=1e-12)


def test_a_diagonal_inertia_is_three_numbers() -> None:
    leg = replace(LEG, leg_inertia=np.array([5.0, 5.2, 0.4]))
    assert leg.leg_inertia.tolist() == np.diag([5.0, 5.2, 0.4]).tolist()


@each(
    ("change", "code"),
    [
        ({"leg_inertia": np.ones((2, 2))}, "bad-shape"),
        ({"leg_inertia": np.triu(np.ones((3, 3)))}, "bad-shape"),
        ({"leg_mass": -1.0}, "negative"),
        ({"wheel_axial": -1.0}, "negative"),
        ({"l1": np.nan}, "not-finite"),
    ],
)
def test_an_impossible_leg_is_refused(change: dict[str, float], code: str) -> None:
    with raises(ArgumentError, code):
        replace(LEG, **change)  # type: ignore[arg-type]


def test_an_unusable_motion_is_refused() -> None:
    with raises(ArgumentError, "bad-shape", "beta"):
        replace(still(), beta=np.zeros(2))
    with raises(ArgumentError, "not-finite", "omega_w"):
        replace(still(), omega_w=np.array([np.inf]))

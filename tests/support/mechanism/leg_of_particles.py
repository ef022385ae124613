"""The spatial leg and its wheel as particles carried by rotation matrices.

No formula of velocity, acceleration, inertia or rate of momentum is used here: positions are
products of matrices, and everything else is their numerical derivative over a circle of complex
times (Cauchy's integral), which is exact to rounding for these analytic motions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Function = Callable[[Complex], Complex]

CIRCLE = 32
RADIUS = 0.25  # s; the motions below stay moderate this far from the real times


def derivative(f: Function, t: Complex, order: int = 1) -> Complex:
    """Return the derivative at complex times t (T,) of f: (T,) -> (T, ...)."""
    turn = np.exp(2j * np.pi * np.arange(CIRCLE) / CIRCLE)
    values = f((t[:, None] + RADIUS * turn).ravel())
    values = values.reshape(len(t), CIRCLE, *values.shape[1:])
    weights = turn ** (-order) * np.prod(np.arange(1, order + 1)) / RADIUS**order / CIRCLE
    return np.asarray(np.moveaxis(values, 1, -1) @ weights)


@dataclass(frozen=True)
class Wave:
    """The function offset + rate t + sum of amplitude sin(frequency t + phase)."""

    offset: complex
    rate: float
    amplitude: Floats
    frequency: Floats
    phase: Floats

    def __call__(self, t: Complex) -> Complex:
        angle = self.frequency * t[:, None] + self.phase
        return np.asarray(self.offset + self.rate * t + np.sin(angle) @ self.amplitude)


def turn(axis: int, angle: Complex) -> Complex:
    """Return rotation matrices about a coordinate axis, (T, 3, 3)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.zeros((len(angle), 3, 3), dtype=complex)
    matrix[:, axis, axis] = 1.0
    matrix[:, i, i] = matrix[:, j, j] = np.cos(angle)
    matrix[:, j, i] = np.sin(angle)
    matrix[:, i, j] = -matrix[:, j, i]
    return matrix


def cloud_inertia(mass: Floats, at: Floats) -> Floats:
    """Return the inertia tensor (3, 3) about the origin, of particles with masses (N,) at
    (N, 3).
    """
    square = np.sum(at**2, axis=1)
    return np.asarray(np.sum(mass * square) * np.eye(3) - (at.T * mass) @ at)


@dataclass(frozen=True)
class Leg:
    """Geometry, masses and inertia of leg and wheel, in the symbols of Appeltans et al. (2014).

    Frames: xyz of the world, z up; x'y'z' of the aircraft, x' to its right, y' ahead;
    x'''y'''z''' of the leg, turned by beta about y' at the hinge B. The wheel spins about -x'''.
    l1, l2: B from the aircraft's point A along x' and z', m.
    l3, l4: the wheel's centre C from B along -z''' and -x''', m; the leg's centre D is at 3/4 of l3
    and 1/4 of l4.
    leg_inertia: (3, 3) about D, leg axes. wheel_axial, wheel_transverse: about C, kg m^2.
    slope: of the ground about x', rad. gravity: m/s^2.
    """

    l1: float
    l2: float
    l3: float
    l4: float
    leg_mass: float
    wheel_mass: float
    leg_inertia: Floats
    wheel_axial: float
    wheel_transverse: float
    slope: float
    gravity: float


@dataclass(frozen=True)
class LegMotion:
    """Motion at T instants: speed of A, yaw rate, fold angle, spin of the wheel, and their rates,
    (T,).
    """

    v_v: Floats
    a_v: Floats
    omega_g: Floats
    alpha_g: Floats
    beta: Floats
    omega_i: Floats
    alpha_i: Floats
    omega_w: Floats
    alpha_w: Floats


@dataclass(frozen=True)
class Particles:
    """A leg and its motion, as particles.

    masses: (N,) kg. offsets: (N, 3) m from D or C.
    follow: how far the direction of A's velocity follows the yaw: 1 entirely, 0 not at all.
    """

    leg: Leg
    leg_masses: Floats
    leg_offsets: Floats
    wheel_masses: Floats
    wheel_offsets: Floats
    speed: Wave
    heading: Wave
    beta: Wave
    spin: Wave
    follow: float

    def motion(self, times: Floats) -> LegMotion:
        """Return the motion as numbers at these times."""
        t = times.astype(complex)

        def rates(wave: Wave) -> tuple[Floats, Floats, Floats]:
            return wave(t).real, derivative(wave, t).real, derivative(wave, t, 2).real

        v_v, a_v, _ = rates(self.speed)
        _, omega_g, alpha_g = rates(self.heading)
        beta, omega_i, alpha_i = rates(self.beta)
        _, omega_w, alpha_w = rates(self.spin)
        return LegMotion(
            v_v=v_v,
            a_v=a_v,
            omega_g=omega_g,
            alpha_g=alpha_g,
            beta=beta,
            omega_i=omega_i,
            alpha_i=alpha_i,
            omega_w=omega_w,
            alpha_w=alpha_w,
        )

    def aircraft(self, t: Complex) -> Complex:
        """Return the matrices from primed axes to the world's, (T, 3, 3)."""
        return turn(0, np.full_like(t, self.leg.slope)) @ turn(2, self.heading(t))

    def a(self, now: float) -> Function:
        """Return the world position of A as a function of time; at `now` A moves along y'."""

        def position(t: Complex) -> Complex:
            # Gauss-Legendre over the straight line from 0 to the complex time.
            node, weight = np.polynomial.legendre.leggauss(20)
            instants = (0.5 * (1.0 + node) * t[:, None]).ravel()
            base = self.heading(np.array([now + 0j]))[0]
            course = base + self.follow * (self.heading(instants) - base)
            velocity = self.speed(instants)[:, None] * turn(2, course)[:, :, 1]
            path = 0.5 * np.einsum("tkc,k->tc", velocity.reshape(len(t), -1, 3), weight)
            return np.asarray(
                (turn(0, np.full_like(t, self.leg.slope)) @ (t[:, None] * path)[..., None])[..., 0]
            )

        return position

    def carried(self, now: float, body: str) -> Function:
        """Return the world positions (T, N, 3) of a body, as a function of time.

        body: "B", "C", "D", "leg" or "wheel"
        """
        leg = self.leg
        hinge = np.array([leg.l1, 0.0, leg.l2])
        wheel_centre = np.array([-leg.l4, 0.0, -leg.l3])
        leg_centre = np.array([-0.25 * leg.l4, 0.0, -0.75 * leg.l3])
        fixed = {
            "B": np.zeros((1, 3)),
            "C": wheel_centre[None],
            "D": leg_centre[None],
            "leg": leg_centre + self.leg_offsets,
        }
        origin = self.a(now)

        def position(t: Complex) -> Complex:
            aircraft = self.aircraft(t)
            fold = turn(1, self.beta(t))
            arms: Complex
            if body == "wheel":
                spun = np.einsum("tij,nj->tni", turn(0, -self.spin(t)), self.wheel_offsets)
                arms = wheel_centre + spun
            else:
                arms = np.tile(fixed[body], (len(t), 1, 1))
            in_primed = hinge + np.einsum("tij,tnj->tni", fold, arms)
            return np.asarray(origin(t)[:, None] + np.einsum("tij,tnj->tni", aircraft, in_primed))

        return position

    def state(self, times: Floats, body: str) -> tuple[Floats, Floats, Floats]:
        """Return position, velocity and acceleration in the world's axes, (T, N, 3) each."""
        found = []
        for time in times:
            f, t = self.carried(float(time), body), np.array([time + 0j])
            found.append((f(t)[0].real, derivative(f, t)[0].real, derivative(f, t, 2)[0].real))
        r, v, a = (np.stack(part) for part in zip(*found, strict=True))
        return r, v, a


def random_particles(seed: int, follow: float | None = None) -> Particles:
    """Return a random leg, not symmetric, with a wheel of three rings and a hub, in a random
    motion.
    """
    rng = np.random.default_rng(seed)

    def wave(offset: float, rate: float, size: float) -> Wave:
        return Wave(
            offset,
            rate,
            size * rng.uniform(-1.0, 1.0, 3),
            rng.uniform(0.5, 2.0, 3),
            rng.uniform(0.0, 6.0, 3),
        )

    leg_masses = rng.uniform(1.0, 9.0, 9)
    leg_offsets = rng.uniform(-0.5, 0.5, (9, 3))
    leg_offsets -= leg_masses @ leg_offsets / leg_masses.sum()
    ring = 2.0 * np.pi * np.arange(5) / 5.0
    around = np.stack([0.0 * ring, np.cos(ring), np.sin(ring)], axis=1)
    width, radius = rng.uniform(0.05, 0.3, 2)
    rings = [0.3 * around + [x, 0.0, 0.0] for x in (-width, width)]
    wheel_offsets = np.concatenate([*rings, radius * around, np.zeros((1, 3))])
    wheel_masses = np.repeat(rng.uniform(0.5, 3.0, 3), [10, 5, 1])
    axial, transverse = np.diag(cloud_inertia(wheel_masses, wheel_offsets))[:2]
    l1, l2, l3, l4 = rng.uniform(-1.5, 1.5, 4)
    leg = Leg(
        l1=l1,
        l2=l2,
        l3=l3,
        l4=l4,
        leg_mass=float(leg_masses.sum()),
        wheel_mass=float(wheel_masses.sum()),
        leg_inertia=_symmetric(cloud_inertia(leg_masses, leg_offsets)),
        wheel_axial=float(axial),
        wheel_transverse=float(transverse),
        slope=rng.uniform(-0.6, 0.6),
        gravity=rng.uniform(1.0, 20.0),
    )
    return Particles(
        leg=leg,
        leg_masses=leg_masses,
        leg_offsets=leg_offsets,
        wheel_masses=wheel_masses,
        wheel_offsets=wheel_offsets,
        speed=wave(6.0, 1.0, 2.0),
        heading=wave(rng.uniform(0.0, 6.0), 0.5, 0.5),
        beta=wave(rng.uniform(0.0, 6.0), 0.7, 0.6),
        spin=wave(0.0, rng.uniform(5.0, 15.0), 1.0),
        follow=float(rng.uniform(0.0, 1.0)) if follow is None else follow,
    )


def _symmetric(matrix: Floats) -> Floats:
    return np.asarray(0.5 * (matrix + matrix.T))

"""A leg that folds in space, with a spinning wheel, on an aircraft that drives and yaws.

Frames, all right-handed:
xyz: world, z up.
x'y'z': aircraft, x' to its right, y' ahead, z' up from the slope. World = T1 Rz(heading) primed.
x''y''z'': at the hinge B, parallel to x'y'z'.
x'''y'''z''': on the leg, turned by beta about y''; x'''y'''z''' to x''y''z'' is T2(beta).

The wheel spins about -x''', so that it rolls ahead for omega_w > 0. A is the aircraft's reference
point, C the centre of mass of the wheel, D that of the leg without its wheel. Vectors are (T, 3) in
primed axes unless said otherwise: rates of vectors are rates seen from the world, of which the
primed components are given, so the rotation of the axes is already in them.

Source of the mechanism: Appeltans, Beerden, De Winter, Dhont, Case studie dynamica, KU Leuven
(2014); some of its formulas are wrong (studies/kuleuven2014/errors.csv), so all are derived here.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from pinbase.arrays import Floats
from pinbase.errors import ArgumentError


@dataclass(frozen=True)
class SpatialLeg:
    """Geometry and mass of leg and wheel.

    l1, l2: B from A along x' and z', m.
    l3, l4: C from B along -z''' and -x''', m; D lies at 3/4 of l3 and 1/4 of l4.
    leg_mass, wheel_mass: kg.
    leg_inertia: about D in leg axes, (3, 3) or its diagonal (3,), kg m^2.
    wheel_axial, wheel_transverse: inertia about C, along x''' and across it, kg m^2.
    slope: alpha of T1, rad.
    gravity: along -z of the world, m/s^2.

    Raises: ArgumentError for a wrong shape, a number that is not finite, or a negative mass.
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
    slope: float = 0.0
    gravity: float = 9.80665

    def __post_init__(self) -> None:
        stated = np.asarray(self.leg_inertia, dtype=float)
        inertia = np.diag(stated) if stated.shape == (3,) else stated
        if inertia.shape != (3, 3) or not np.array_equal(inertia, inertia.T):
            raise ArgumentError(
                "leg_inertia must be three moments or a symmetric 3 x 3 matrix", "bad-shape"
            )
        object.__setattr__(self, "leg_inertia", inertia)
        numbers = [getattr(self, f.name) for f in fields(self) if f.name != "leg_inertia"]
        if not np.isfinite(numbers).all() or not np.isfinite(inertia).all():
            raise ArgumentError("every number of the leg must be finite", "not-finite")
        moments = [self.wheel_axial, self.wheel_transverse, *np.linalg.eigvalsh(inertia)]
        # Rounding may leave a slender body's smallest moment just below zero.
        if min(moments) < -1e-12 * max(moments) or min(self.leg_mass, self.wheel_mass) < 0.0:
            raise ArgumentError("masses and moments of inertia must not be negative", "negative")

    @property
    def wheel_inertia(self) -> Floats:
        """Inertia about C in leg axes, (3, 3) kg m^2; constant, as the wheel is axisymmetric."""
        return np.diag([self.wheel_axial, self.wheel_transverse, self.wheel_transverse])


@dataclass(frozen=True)
class LegMotion:
    """Motion at T instants; every array is (T,).

    v_v, a_v: speed of A along y' and its rate, m/s and m/s^2.
    omega_g, alpha_g: yaw rate about z' and its rate, rad/s and rad/s^2.
    beta, omega_i, alpha_i: fold angle about y'' and its rates, rad, rad/s and rad/s^2.
    omega_w, alpha_w: spin of the wheel relative to the leg about -x''' and its rate.
    course_rate: rate at which the direction of A's velocity turns about z', rad/s. Equal to omega_g
    A keeps moving along y', as with tyres that do not slip; with 0 its path is straight at that
    instant, as in the publication, which over a history is a skid.
    heading: yaw angle, rad, which matters only on a slope; None: 0 at every instant, with x' along
    x, as in the publication.

    Raises: ArgumentError for arrays of different lengths or that are not finite.
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
    course_rate: Floats
    heading: Floats | None = None

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if value is None:
                continue
            array = np.asarray(value, dtype=float)
            if array.ndim != 1 or array.shape != np.shape(self.v_v):
                raise ArgumentError(
                    f"{field.name} has shape {array.shape}; it must be that of v_v, (T,)",
                    "bad-shape",
                )
            if not np.isfinite(array).all():
                raise ArgumentError(f"{field.name} must be finite", "not-finite")
            object.__setattr__(self, field.name, array)

    def __len__(self) -> int:
        return len(self.v_v)

    @property
    def yaw(self) -> Floats:
        """Heading, (T,) rad, 0 where none is stated."""
        return np.zeros(len(self)) if self.heading is None else self.heading


@dataclass(frozen=True)
class Contact:
    """Force of the ground on the tyre, primed axes.

    force: (T, 3) N.
    arm: (T, 3) m, from C to the point of contact.
    """

    force: Floats
    arm: Floats


@dataclass(frozen=True)
class LegDynamics:
    """Motion, momenta, and required forces; (T, 3) arrays in primed axes, see `to_world`, `to_leg`.

    leg_omega, wheel_omega: rad/s; leg_alpha, wheel_alpha: their rates, rad/s^2.
    r_BC, r_BD: m. v_B, v_C, v_D: m/s. a_B, a_C, a_D: m/s^2. coriolis_C: the part of a_C that an
    observer in x''y''z'' adds for the turning of those axes under a moving point, m/s^2.
    p_leg, p_wheel: linear momentum, kg m/s; p_leg_rate, p_wheel_rate: N.
    L_leg, L_wheel: angular momentum about D and about C, kg m^2/s; L_leg_rate, L_wheel_rate: N m.
    weight_leg, weight_wheel: N.
    F_B, M_B: force (N) and moment (N m) at B, by the leg on its attachment.
    actuator: (T,) N m about y'', on the leg, positive towards larger beta; all of -M_B along y''.
    spin_moment: (T,) N m, by the leg on the wheel about -x''' (a brake, or a motor): positive where
    it drives omega_w > 0.
    kinetic_energy: (T,) J, of leg and wheel.
    """

    leg: SpatialLeg
    motion: LegMotion
    leg_omega: Floats
    leg_alpha: Floats
    wheel_omega: Floats
    wheel_alpha: Floats
    r_BC: Floats
    r_BD: Floats
    v_B: Floats
    a_B: Floats
    v_C: Floats
    a_C: Floats
    v_D: Floats
    a_D: Floats
    coriolis_C: Floats
    p_leg: Floats
    p_leg_rate: Floats
    p_wheel: Floats
    p_wheel_rate: Floats
    L_leg: Floats
    L_leg_rate: Floats
    L_wheel: Floats
    L_wheel_rate: Floats
    weight_leg: Floats
    weight_wheel: Floats
    F_B: Floats
    M_B: Floats
    actuator: Floats
    spin_moment: Floats
    kinetic_energy: Floats

    def to_world(self, vector: Floats) -> Floats:
        """World components, (T, 3), of a vector with primed components (T, 3)."""
        return _times(t1(self.leg.slope) @ turn_z(self.motion.yaw), vector)

    def to_leg(self, vector: Floats) -> Floats:
        """Components in leg axes x'''y'''z''', (T, 3), of a vector in primed axes (T, 3)."""
        return _times(np.swapaxes(t2(self.motion.beta), -1, -2), vector)


def t1(slope: float) -> Floats:
    """Matrix (3, 3) from components along the slope's axes (x'y'z' at heading 0) to the world's."""
    c, s = np.cos(slope), np.sin(slope)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def turn_z(heading: Floats) -> Floats:
    """Matrices (T, 3, 3) from primed components to components along the slope's axes."""
    c, s, o = np.cos(heading), np.sin(heading), np.zeros_like(heading)
    return np.stack([_row(c, -s, o), _row(s, c, o), _row(o, o, o + 1.0)], axis=-2)


def t2(beta: Floats) -> Floats:
    """Matrices (T, 3, 3) from components in leg axes to primed components."""
    c, s, o = np.cos(beta), np.sin(beta), np.zeros_like(beta)
    return np.stack([_row(c, o, s), _row(o, o + 1.0, o), _row(-s, o, c)], axis=-2)


def leg_dynamics(leg: SpatialLeg, motion: LegMotion, contact: Contact | None = None) -> LegDynamics:
    """Kinematics, momenta, and the forces that they require, at all instants at once.

    contact: None when the wheel is off the ground.
    """
    moved, momenta = _kinematics(leg, motion), _angular_momenta(leg, motion)
    p = {
        "p_leg": leg.leg_mass * moved["v_D"],
        "p_leg_rate": leg.leg_mass * moved["a_D"],
        "p_wheel": leg.wheel_mass * moved["v_C"],
        "p_wheel_rate": leg.wheel_mass * moved["a_C"],
    }
    energy = _dot(p["p_leg"], moved["v_D"]) + _dot(p["p_wheel"], moved["v_C"])
    energy += _dot(momenta["L_leg"], moved["leg_omega"])
    energy += _dot(momenta["L_wheel"], moved["wheel_omega"])
    borne = _at_hinge(leg, motion, moved, p | momenta, contact)
    return LegDynamics(
        leg=leg, motion=motion, **moved, **p, **momenta, **borne, kinetic_energy=0.5 * energy
    )


def _kinematics(leg: SpatialLeg, motion: LegMotion) -> dict[str, Floats]:
    """Rotation of leg and wheel and motion of B, C and D, by their names, primed axes.

    The products of rates arise as the axis e_y'' yaws, and e_x''' yaws and folds.
    """
    c, s = np.cos(motion.beta), np.sin(motion.beta)
    o = np.zeros_like(c)
    w_g, w_i, w_w = motion.omega_g, motion.omega_i, motion.omega_w
    a_g, a_i, a_w = motion.alpha_g, motion.alpha_i, motion.alpha_w
    leg_omega = _row(o, w_i, w_g)
    leg_alpha = _row(-w_g * w_i, a_i, a_g)
    spin_rate = _row(-a_w * c + w_i * w_w * s, -w_g * w_w * c, a_w * s + w_i * w_w * c)
    r_BC = _row(-leg.l3 * s - leg.l4 * c, o, -leg.l3 * c + leg.l4 * s)
    r_BD = _row(-0.75 * leg.l3 * s - 0.25 * leg.l4 * c, o, -0.75 * leg.l3 * c + 0.25 * leg.l4 * s)
    moved = {}
    for point, r in (("B", np.zeros_like(r_BC)), ("D", r_BD), ("C", r_BC)):
        moved[f"v_{point}"], moved[f"a_{point}"], coriolis = _point(leg, motion, r)
    return moved | {
        "leg_omega": leg_omega,
        "leg_alpha": leg_alpha,
        "wheel_omega": leg_omega + _row(-w_w * c, o, w_w * s),
        "wheel_alpha": leg_alpha + spin_rate,
        "r_BC": r_BC,
        "r_BD": r_BD,
        "coriolis_C": coriolis,
    }


def _angular_momenta(leg: SpatialLeg, motion: LegMotion) -> dict[str, Floats]:
    """Angular momenta of leg and wheel about their centres, and their rates, primed axes.

    They are computed in leg axes, in which the inertia is constant, also that of the spinning
    wheel, since it is axisymmetric: rate in the world = rate in leg axes + leg's rotation x L.
    """
    c, s = np.cos(motion.beta), np.sin(motion.beta)
    o = np.zeros_like(c)
    w_g, w_i, w_w = motion.omega_g, motion.omega_i, motion.omega_w
    a_g, a_i, a_w = motion.alpha_g, motion.alpha_i, motion.alpha_w
    omega = _row(-w_g * s, w_i, w_g * c)
    omega_rate = _row(-a_g * s - w_g * w_i * c, a_i, a_g * c - w_g * w_i * s)
    L_leg, L_leg_rate = _spin(leg.leg_inertia, omega, omega_rate, omega)
    L_wheel, L_wheel_rate = _spin(
        leg.wheel_inertia, omega - _row(w_w, o, o), omega_rate - _row(a_w, o, o), omega
    )
    momenta = {"L_leg": L_leg, "L_leg_rate": L_leg_rate}
    momenta |= {"L_wheel": L_wheel, "L_wheel_rate": L_wheel_rate}
    to_primed = t2(motion.beta)
    return {name: _times(to_primed, v) for name, v in momenta.items()}


def _at_hinge(
    leg: SpatialLeg,
    motion: LegMotion,
    moved: dict[str, Floats],
    momenta: dict[str, Floats],
    contact: Contact | None,
) -> dict[str, Floats]:
    """Weights, and force, moment and actuator torque at the hinge, by their names.

    Newton-Euler equations of leg and wheel as one system about B: the attachment supplies what
    gravity and ground do not; F_B and M_B, of the leg on the attachment, are the opposite.
    """
    c, s = np.cos(motion.beta), np.sin(motion.beta)
    o = np.zeros_like(c)
    down = _times(
        np.swapaxes(t1(leg.slope) @ turn_z(motion.yaw), -1, -2), _row(o, o, o - leg.gravity)
    )
    weight_leg, weight_wheel = leg.leg_mass * down, leg.wheel_mass * down
    on_leg = weight_leg - momenta["p_leg_rate"]
    on_wheel = weight_wheel - momenta["p_wheel_rate"]
    F_B = on_leg + on_wheel
    M_B = np.cross(moved["r_BD"], on_leg) - momenta["L_leg_rate"]
    M_B += np.cross(moved["r_BC"], on_wheel) - momenta["L_wheel_rate"]
    axle = _row(c, o, -s)
    spin_moment = -_dot(momenta["L_wheel_rate"], axle)
    if contact is not None:
        F_B = F_B + contact.force
        M_B = M_B + np.cross(moved["r_BC"] + contact.arm, contact.force)
        spin_moment = spin_moment + _dot(np.cross(contact.arm, contact.force), axle)
    return {
        "weight_leg": weight_leg,
        "weight_wheel": weight_wheel,
        "F_B": F_B,
        "M_B": M_B,
        "actuator": -M_B[:, 1],
        "spin_moment": spin_moment,
    }


def _point(leg: SpatialLeg, motion: LegMotion, r: Floats) -> tuple[Floats, Floats, Floats]:
    """Velocity, acceleration and its Coriolis part, (T, 3) each, of a point of the leg.

    r: (T, 3) m, from B; it has no y component, so folding moves the point by omega_i (z, 0, -x).
    """
    x, z = r[:, 0], r[:, 2]
    w_g, w_i = motion.omega_g, motion.omega_i
    radius = leg.l1 + x  # from the yaw axis
    o = np.zeros_like(x)
    velocity = _row(w_i * z, motion.v_v + w_g * radius, -w_i * x)
    coriolis = _row(o, 2.0 * w_g * w_i * z, o)
    acceleration = coriolis + _row(
        motion.alpha_i * z - w_i**2 * x - w_g**2 * radius - motion.course_rate * motion.v_v,
        motion.a_v + motion.alpha_g * radius,
        -motion.alpha_i * x - w_i**2 * z,
    )
    return velocity, acceleration, coriolis


def _spin(inertia: Floats, omega: Floats, rate: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """Angular momentum and its rate seen from the world, leg axes, (T, 3) each.

    omega, rate: (T, 3) rotation of the body and rates of its components.
    axes: (T, 3) rotation of the leg axes.
    """
    momentum = omega @ inertia
    return momentum, rate @ inertia + np.cross(axes, momentum)


def _row(x: Floats, y: Floats, z: Floats) -> Floats:
    """Vectors (T, 3) from three components (T,)."""
    return np.stack([x, y, z], axis=-1)


def _times(matrix: Floats, vector: Floats) -> Floats:
    """Product of matrices (T, 3, 3) and vectors (T, 3)."""
    return np.asarray((matrix @ vector[..., None])[..., 0])


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.sum(a * b, axis=-1))

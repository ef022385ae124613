"""The leg of Appeltans et al. (2014) as a cloud of particles, carried by rotation matrices and
differentiated numerically: what the formulas should give.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from tests.support.mechanism.leg_in_space import quantities
from tests.support.mechanism.leg_of_particles import (
    Complex,
    Floats,
    Particles,
    cloud_inertia,
    derivative,
    random_particles,
    turn,
)

NOW = 0.6


@cache
def publications_instant(seed: int) -> Particles:
    """A random motion whose axes at NOW are those of the publication: heading 0, A's path straight;
    and a leg with principal axes along x'''y'''z'''.
    """
    particles = random_particles(100 + seed, follow=0.0)
    heading = particles.heading
    offset = heading.offset - heading(np.array([NOW + 0j]))[0]
    masses = np.repeat([4.0, 3.0, 6.0], 2)
    half = np.diag([0.5, 0.3, 0.8])
    arms = np.stack([half, -half], axis=1).reshape(6, 3)
    leg = replace(
        particles.leg,
        leg_mass=float(masses.sum()),
        leg_inertia=np.diag(np.diag(cloud_inertia(masses, arms))),
    )
    return replace(
        particles,
        leg=leg,
        leg_masses=masses,
        leg_offsets=arms,
        heading=replace(heading, offset=offset),
    )


@cache
def ours(seed: int) -> tuple[dict[str, Floats], Floats]:
    """Our quantities along primed axes, and the matrix from these to the world's."""
    return quantities(publications_instant(seed), NOW)


@cache
def truth(seed: int) -> dict[str, Floats]:
    """Every quantity by numerical differentiation. Vectors in world axes unless their name says
    otherwise.
    """
    particles = publications_instant(seed)
    now, t = np.array([NOW]), np.array([NOW + 0j])
    aircraft = particles.aircraft(t)[0].real
    found: dict[str, Floats] = {}
    for point in "BCD":
        r, v, a = (part[0, 0] for part in particles.state(now, point))
        found |= {f"r_{point}": r, f"v_{point}": v, f"a_{point}": a}
    origin = particles.a(NOW)
    found["r_A"] = origin(t)[0].real
    found["v_A"] = derivative(origin, t)[0].real
    found["a_A"] = derivative(origin, t, 2)[0].real
    for point in "CD":
        found[f"r_B{point}"] = found[f"r_{point}"] - found["r_B"]
    found["r_AC"] = found["r_C"] - found["r_A"]

    def leg_axes(s: Complex) -> Complex:
        return np.asarray(particles.aircraft(s) @ turn(1, particles.beta(s)))

    def wheel_axes(s: Complex) -> Complex:
        return np.asarray(leg_axes(s) @ turn(0, -particles.spin(s)))

    found["leg axes"] = leg_axes(t)[0].real
    found["rate of e_x'''"] = derivative(leg_axes, t)[0, :, 0].real
    for name, axes in (
        ("aircraft", particles.aircraft),
        ("leg", leg_axes),
        ("wheel", wheel_axes),
    ):
        R, R1, R2 = (
            f.real for f in (axes(t)[0], derivative(axes, t)[0], derivative(axes, t, 2)[0])
        )
        found[f"omega {name}"] = axial(R1 @ R.T)
        found[f"alpha {name}"] = axial(R2 @ R.T + R1 @ R1.T)

    # As an observer on x''y''z'' sees them: rates of the components in those axes.
    def seen(point: str) -> Floats:
        at, hinge = particles.carried(NOW, point), particles.carried(NOW, "B")

        def components(s: Complex) -> Complex:
            arm = (at(s) - hinge(s))[:, 0]
            return np.asarray(np.einsum("tij,ti->tj", particles.aircraft(s), arm))

        return np.asarray(aircraft @ derivative(components, t, 2)[0].real)

    found["a_D seen"] = seen("D")
    yaw, r_BC = found["omega aircraft"], found["r_BC"]
    found["Coriolis"] = (
        found["a_C"]
        - found["a_B"]
        - np.cross(found["alpha aircraft"], r_BC)
        - np.cross(yaw, np.cross(yaw, r_BC))
        - seen("C")
    )
    found["F_B"], found["M_B"] = np.zeros((2, 3))
    for body, masses in (("leg", particles.leg_masses), ("wheel", particles.wheel_masses)):
        r, v, a = (part[0] for part in particles.state(now, body))
        centre = found["r_D"] if body == "leg" else found["r_C"]
        momentum, push = masses[:, None] * v, masses[:, None] * a
        found[f"p {body}"] = momentum.sum(axis=0)
        found[f"L {body}"] = np.cross(r - centre, momentum).sum(axis=0)
        found[f"L rate {body}"] = np.cross(r - centre, push).sum(axis=0)
        weight = masses[:, None] * [0.0, 0.0, -particles.leg.gravity]
        found[f"weight {body}"] = weight.sum(axis=0)
        found["F_B"] = found["F_B"] + (weight - push).sum(axis=0)
        found["M_B"] = found["M_B"] + np.cross(r - found["r_B"], weight - push).sum(axis=0)

    leg_particles, hinge = particles.carried(NOW, "leg"), particles.carried(NOW, "B")

    def about_hinge(s: Complex) -> Complex:
        momentum = particles.leg_masses[:, None] * derivative(leg_particles, s)
        return np.asarray(np.cross(leg_particles(s) - hinge(s), momentum).sum(axis=1))

    found["L_B rate"] = derivative(about_hinge, t)[0].real
    return found


def axial(skew: Floats) -> Floats:
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])


def quantity(seed: int, name: str) -> Floats:
    """The true value of what the table calls `name`."""
    particles, found = publications_instant(seed), truth(seed)
    aircraft = particles.aircraft(np.array([NOW + 0j]))[0].real
    axes = found["leg axes"]
    if name.startswith("matrix"):
        return axes.T if "world to leg" in name else axes
    whole = {"F_B": "F_B", "M_B": "M_B", "rate of L_B of the leg": "L_B rate"}
    if name in whole:
        return found[whole[name]]
    what, component = name.rsplit(", ", 1)
    omega_w = particles.motion(np.array([NOW])).omega_w[0]
    world = {
        "omega of the wheel": found["omega wheel"],
        "alpha of the wheel": found["alpha wheel"],
        "rate of e_x''' times -omega_w": -omega_w * found["rate of e_x'''"],
        "Coriolis part of a_C": found["Coriolis"],
        "a_D seen from x''y''z''": found["a_D seen"],
        "p_D": found["p leg"],
        "v_C - v_A": found["v_C"] - found["v_A"],
        "L of the wheel": found["L wheel"],
        "L of the leg": found["L leg"],
        "Omega x L of the wheel": np.cross(found["omega wheel"], found["L wheel"]),
        "Omega x L of the leg": np.cross(found["omega leg"], found["L leg"]),
        "rate of omega of the wheel": found["alpha wheel"],
        "rate of L of the wheel": found["L rate wheel"],
        "rate of L of the leg": found["L rate leg"],
    }
    vector = world[what] if what in world else found[what]
    if component.startswith("world "):
        return np.asarray(vector["xyz".index(component[-1])])
    turned = axes.T @ vector if component.endswith("'''") else aircraft.T @ vector
    return np.asarray(turned["xyz".index(component[0])])


def symbols(seed: int, primed: bool) -> dict[str, Any]:
    """What the formulas are written in; vectors in primed or in world axes."""
    particles, found = publications_instant(seed), truth(seed)
    leg, motion = particles.leg, particles.motion(np.array([NOW]))
    c, s = np.cos(leg.slope), np.sin(leg.slope)
    T1 = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    beta = motion.beta[0]
    c, s = np.cos(beta), np.sin(beta)
    T2 = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    L = (T1 @ T2).T @ found["L wheel"]
    inertia = np.diag(leg.leg_inertia)
    given = {
        "sin": np.sin,
        "cos": np.cos,
        "cross": np.cross,
        "inv": np.linalg.inv,
        "T1": T1,
        "T2": T2,
        "alpha": leg.slope,
        **{n: getattr(leg, n) for n in ("l1", "l2", "l3", "l4")},
        **{
            n: getattr(motion, n)[0]
            for n in ("v_v", "a_v", "omega_g", "alpha_g", "beta", "omega_i", "alpha_i")
        },
        "omega_w": motion.omega_w[0],
        "alpha_w": motion.alpha_w[0],
        "m_D": leg.leg_mass,
        "m_C": leg.wheel_mass,
        **dict(zip(("J_x", "J_y", "J_z"), inertia, strict=True)),
        "I_x": leg.wheel_axial,
        "I_y": leg.wheel_transverse,
        "I_z": leg.wheel_transverse,
        **dict(zip(("L_x", "L_y", "L_z"), L, strict=True)),
    }
    fold_axis = T1[:, 1]
    vectors = {
        **{n: found[n] for n in ("r_AC", "r_BC", "r_BD", "v_A", "v_B", "v_C", "v_D")},
        **{n: found[n] for n in ("a_A", "a_C", "a_D")},
        "yaw": found["omega aircraft"],
        "yaw_rate": found["alpha aircraft"],
        "fold": motion.omega_i[0] * fold_axis,
        "fold_rate": motion.alpha_i[0] * fold_axis,
        "dL_D": found["L rate leg"],
        "dL_C": found["L rate wheel"],
        "G_D": found["weight leg"],
        "G_C": found["weight wheel"],
    }
    turned = {n: T1.T @ v if primed else v for n, v in vectors.items()}
    return given | turned

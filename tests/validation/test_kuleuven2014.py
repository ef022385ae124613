"""P. Appeltans, P. Beerden, B. De Winter, J. Dhont, Case studie dynamica, KU Leuven (2014).

Their formulas for a spatial retracting leg, against the motion of particles carried by rotation
matrices and differentiated numerically. studies/kuleuven2014/errors.csv names the term in which
each formula is wrong; the whole formula, as printed, stands here. Both are plain text in the same
symbols: T1, T2, vectors and cross products as in the publication; m_D, J_x, J_y, J_z and m_C, I_x,
I_y, I_z the masses and principal moments of leg and wheel; L_x, L_y, L_z of the wheel, leg axes;
G_D, G_C the weights; dL_D, dL_C the rates of angular momentum. @ multiplies matrices.
"""

from __future__ import annotations

import csv
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from loads import LegDynamics, leg_dynamics
from tests.conftest import ROOT
from tests.leg_of_particles import (
    Complex,
    Floats,
    Particles,
    cloud_inertia,
    derivative,
    random_particles,
    turn,
)

NOW = 0.6
SEEDS = range(3)
TABLE = ROOT / "studies" / "kuleuven2014" / "errors.csv"

# As printed: (equation, quantity) -> the whole formula, of which the table quotes the wrong term.
X_C, Z_C = "(-l3*sin(beta) - l4*cos(beta))", "(-l3*cos(beta) + l4*sin(beta))"
X_D, Z_D = "(-l4*cos(beta)/4 - 3*l3*sin(beta)/4)", "(l4*sin(beta)/4 - 3*l3*cos(beta)/4)"
OUT = "(l1 - l3*sin(beta) - l4*cos(beta))"
SPINNING = "rate of omega of the wheel"
PRINTED = {
    ("1", "omega of the wheel, z'"): "omega_g - omega_w*sin(beta)",
    (
        "2",
        "alpha of the wheel, x'",
    ): "-omega_g*omega_i + alpha_w*cos(beta) + omega_i*omega_w*sin(beta)",
    (
        "2",
        "alpha of the wheel, z'",
    ): "alpha_g - alpha_w*sin(beta) + omega_i*omega_w*cos(beta)",
    (
        "2",
        "alpha of the wheel, world z",
    ): "(alpha_i - omega_g*omega_w*cos(beta)*sin(alpha))"
    " + (alpha_g - alpha_w*sin(beta) + omega_i*omega_w*cos(beta))*cos(alpha)",
    ("below 2", "rate of e_x''' times -omega_w, y'"): "omega_g*omega_w*cos(beta)",
    ("5", "r_AC, z'"): "l2 - l3*cos(beta) + l4*cos(beta)",
    ("13", "a_C, y'"): "(a_A + cross(yaw_rate, r_AC) + cross(fold_rate, r_BC)"
    " + cross(yaw, v_C - v_A) + cross(fold, v_C - v_B))[1]",
    ("24", "a_C, world y"): f"alpha_g*cos(alpha)*{OUT} + alpha_i*sin(alpha)*{X_C}"
    f" + a_v*cos(alpha) + omega_g*omega_i*cos(alpha)*{Z_C} + omega_i**2*sin(alpha)*{Z_C}",
    ("24", "a_C, world z"): f"alpha_g*sin(alpha)*{OUT} - alpha_i*cos(alpha)*{X_C}"
    f" + a_v*sin(alpha) - omega_g*omega_i*sin(alpha)*{Z_C} - omega_i**2*cos(alpha)*{Z_C}",
    ("26", "Coriolis part of a_C, y'"): f"-2*omega_g*omega_i*{Z_C}",
    ("26", "Coriolis part of a_C, world y"): f"-2*omega_g*omega_i*{Z_C}*cos(beta)",
    ("26", "Coriolis part of a_C, world z"): f"-2*omega_g*omega_i*{Z_C}*cos(beta)",
    ("38", "a_D seen from x''y''z'', y''"): f"omega_g*omega_i*{Z_D}",
    ("38", "a_D seen from x''y''z'', z''"): f"-alpha_i*{X_D} + omega_i**2*{X_D}",
    ("40", "a_D, x'"): f"-omega_g**2*l1 + omega_g**2*{X_D} + alpha_i*{Z_D} - omega_i**2*{X_D}",
    (
        "40",
        "a_D, y'",
    ): f"a_v + alpha_g*l1 + alpha_g*{X_D} + 3*omega_g*omega_i*{Z_D}",
    ("40", "a_D, z'"): f"-alpha_i*{X_D} + omega_i**2*{X_D}",
    ("42", "p_D, world z"): f"m_D*((v_v + omega_g*l1 + omega_g*{X_D})*sin(alpha)"
    f" + cos(alpha)*omega_i*{X_D})",
    ("46", "matrix from world to leg axes"): "inv(T1) @ inv(T2)",
    ("47 and 55", "matrix from leg axes to world"): "T2 @ T1",
    (
        "49",
        "Omega x L of the wheel, y'''",
    ): "omega_g*cos(beta)*L_x + (omega_w + omega_g)*L_z",
    (
        "49",
        "Omega x L of the wheel, z'''",
    ): "-(omega_w + omega_g*sin(beta))*L_y + omega_i*L_x",
    ("50", f"{SPINNING}, x'''"): "alpha_w - alpha_g*sin(beta) - omega_i*omega_g*cos(beta)",
    ("50", f"{SPINNING}, y'''"): "alpha_i + omega_g*omega_w*cos(beta)",
    (
        "50",
        f"{SPINNING}, z'''",
    ): "alpha_g*cos(beta) - omega_i*omega_g*sin(beta) - omega_i*omega_w",
    ("51", f"{SPINNING}, x'''"): "alpha_w - alpha_g - omega_i*omega_g*cos(beta)",
    ("51", f"{SPINNING}, y'''"): "alpha_i + cos(beta)*omega_g*omega_w",
    (
        "51",
        f"{SPINNING}, z'''",
    ): "alpha_g*cos(beta) - omega_i*omega_g*sin(beta) - omega_i*omega_g",
    ("52", "rate of L of the wheel, x'''"): "omega_i*omega_g*cos(beta)*(I_z - I_y)"
    " + I_x*(alpha_w - alpha_g*sin(beta) - omega_i*omega_g)*cos(beta)",
    (
        "52",
        "rate of L of the wheel, y'''",
    ): "omega_g*cos(beta)*(omega_w + omega_g*sin(beta))*(I_z - I_x)"
    " + I_y*(alpha_i + omega_g*omega_w*cos(beta))",
    (
        "52",
        "rate of L of the wheel, z'''",
    ): "(omega_i + omega_g*sin(beta))*omega_i*(I_x - I_y)"
    " + I_z*(alpha_g*cos(beta) - omega_i*omega_g*sin(beta) - omega_i*omega_w)",
    ("58", "Omega x L of the leg, y'''"): "omega_g*cos(beta)*sin(beta)*(J_z - J_x)",
    (
        "59",
        "rate of L of the leg, y'''",
    ): "omega_g*cos(beta)*sin(beta)*(J_z - J_x) + alpha_i*J_y",
    ("64", "F_B"): "m_D*a_D + m_C*a_C - G_D - G_C",
    ("65", "rate of L_B of the leg"): "dL_D + cross(r_BD, m_D*a_D)",
    ("66", "r_BD, world x"): "cos(beta)*(3*l3*sin(beta)/4 - l4*cos(beta)/4)"
    " + cos(alpha)*sin(beta)*(-3*l3*cos(beta)/4 + l4*sin(beta)/4)",
    ("66", "r_BD, world y"): "-sin(alpha)*(-3*l3*sin(beta)/4 + l4*cos(beta)/4)",
    ("66", "r_BD, world z"): "sin(beta)*(-3*l3*sin(beta)/4 + l4*cos(beta)/4)"
    " + cos(alpha)*cos(beta)*(-3*l3*sin(beta)/4 + l4*cos(beta)/4)",
    ("67", "r_BC, world x"): "cos(beta)*(l3*sin(beta) - l4*cos(beta))"
    " + cos(alpha)*sin(beta)*(-l3*cos(beta) + l4*sin(beta))",
    ("67", "r_BC, world z"): "sin(beta)*(-l3*sin(beta) + l4*cos(beta))"
    " + cos(alpha)*cos(beta)*(-l3*cos(beta) + l4*sin(beta))",
    ("68", "M_B"): "dL_D + cross(r_BD, m_D*a_D) + cross(r_BC, m_C*a_C) + dL_C"
    " + cross(r_BD, G_D) + cross(r_BC, G_C)",
}


def errors() -> list[dict[str, str]]:
    return list(csv.DictReader(TABLE.read_text().splitlines()))


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
def dynamics(seed: int) -> LegDynamics:
    particles = publications_instant(seed)
    return leg_dynamics(particles.leg, particles.motion(np.array([NOW])))


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


def value(formula: str, seed: int, name: str) -> Floats:
    """A formula of the table or of PRINTED as a number."""
    return np.asarray(eval(formula, symbols(seed, primed="'" in name)))


# As printed, and right: (equation, quantity) -> the whole.
HOLD = {
    ("1", "omega of the wheel, world y"): "-omega_g*sin(alpha) + omega_i*cos(alpha)"
    " - omega_w*sin(alpha)*sin(beta)",
    ("1", "omega of the wheel, world z"): "omega_g*cos(alpha) + omega_i*sin(alpha)"
    " + omega_w*cos(alpha)*sin(beta)",
    ("2", "alpha of the wheel, y'"): "alpha_i - omega_g*omega_w*cos(beta)",
    ("3", "r_AC, z'"): "l2 - l3*cos(beta) + l4*sin(beta)",
    ("4", "r_BC, x'"): X_C,
    ("19", "v_C - v_A, world y"): f"cos(alpha)*omega_g*{OUT} + sin(alpha)*omega_i*{X_C}",
    ("19", "v_C - v_A, world z"): f"sin(alpha)*omega_g*{OUT} - cos(alpha)*omega_i*{X_C}",
    ("22", "v_B, world z"): "sin(alpha)*(v_v + l1*omega_g)",
    ("24", "a_C, world x"): f"alpha_i*{Z_C} - omega_g**2*{OUT} - omega_i**2*{X_C}",
    ("33", "v_D, world x"): f"omega_i*{Z_D}",
    ("33", "v_D, world y"): f"(v_v + omega_g*(l1 + {X_D}))*cos(alpha) + sin(alpha)*omega_i*{X_D}",
    ("33", "v_D, world z"): f"(v_v + omega_g*(l1 + {X_D}))*sin(alpha) - cos(alpha)*omega_i*{X_D}",
    ("35", "a_B, x'"): "-omega_g**2*l1",
    ("35", "a_B, y'"): "a_v + alpha_g*l1",
    ("38", "a_D seen from x''y''z'', x''"): f"alpha_i*{Z_D} - omega_i**2*{X_D}",
    ("42", "p_D, world y"): f"m_D*((v_v + omega_g*(l1 + {X_D}))*cos(alpha)"
    f" + sin(alpha)*omega_i*{X_D})",
    ("47", "L of the wheel, x'''"): "I_x*(-omega_w - omega_g*sin(beta))",
    ("49", "Omega x L of the wheel, x'''"): "omega_i*L_z - omega_g*cos(beta)*L_y",
    ("55", "L of the leg, x'''"): "-J_x*omega_g*sin(beta)",
    ("58", "Omega x L of the leg, x'''"): "omega_i*omega_g*cos(beta)*(J_z - J_y)",
    ("58", "Omega x L of the leg, z'''"): "omega_i*omega_g*sin(beta)*(J_x - J_y)",
    ("59", "rate of L of the leg, x'''"): "omega_i*omega_g*cos(beta)*(J_z - J_y)"
    " + J_x*(-alpha_g*sin(beta) - omega_i*omega_g*cos(beta))",
    ("59", "rate of L of the leg, z'''"): "omega_i*omega_g*sin(beta)*(J_x - J_y)"
    " + J_z*(alpha_g*cos(beta) - omega_i*omega_g*sin(beta))",
    ("67", "r_BC, world y"): f"-sin(alpha)*{Z_C}",
}


def test_the_list_is_complete() -> None:
    """One whole formula for every row, and no row twice."""
    keys = [(row["equation"], row["quantity"]) for row in errors()]
    assert sorted(keys) == sorted(PRINTED)
    assert all(row["why"] for row in errors())


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("row", errors(), ids=lambda row: f"{row['equation']}: {row['quantity']}")
def test_the_printed_formula_is_off_by_the_named_term(row: dict[str, str], seed: int) -> None:
    name = row["quantity"]
    whole = value(PRINTED[row["equation"], name], seed, name)
    true = quantity(seed, name)
    wrong, right = value(row["printed"], seed, name), value(row["right"], seed, name)
    size = max(np.abs(true).max(), np.abs(whole).max())
    assert np.abs(whole - true).max() > 1e-4 * size
    np.testing.assert_allclose(whole - true, wrong - right, rtol=0.0, atol=1e-9 * size)


@pytest.mark.parametrize("seed", SEEDS)
def test_ours_are_the_true_ones(seed: int) -> None:
    """At the publication's own instant: world axes, heading 0, A's path straight."""
    ours, found = dynamics(seed), truth(seed)
    for mine, true in (
        (ours.wheel_omega, "omega wheel"),
        (ours.wheel_alpha, "alpha wheel"),
        (ours.leg_omega, "omega leg"),
        (ours.leg_alpha, "alpha leg"),
        (ours.r_BC, "r_BC"),
        (ours.r_BD, "r_BD"),
        (ours.v_B, "v_B"),
        (ours.v_C, "v_C"),
        (ours.v_D, "v_D"),
        (ours.a_C, "a_C"),
        (ours.a_D, "a_D"),
        (ours.coriolis_C, "Coriolis"),
        (ours.p_leg, "p leg"),
        (ours.p_wheel, "p wheel"),
        (ours.L_leg, "L leg"),
        (ours.L_wheel, "L wheel"),
        (ours.L_leg_rate, "L rate leg"),
        (ours.L_wheel_rate, "L rate wheel"),
        (ours.F_B, "F_B"),
        (ours.M_B, "M_B"),
    ):
        size = np.abs(found[true]).max()
        np.testing.assert_allclose(
            ours.to_world(mine)[0], found[true], rtol=0.0, atol=1e-9 * size, err_msg=true
        )


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("key", HOLD, ids=": ".join)
def test_the_rest_of_the_printed_formulas_holds(key: tuple[str, str], seed: int) -> None:
    true = quantity(seed, key[1])
    assert value(HOLD[key], seed, key[1]) == pytest.approx(true, rel=1e-9)


RIGHT = {
    "v_C": f"(omega_i*{Z_C}, v_v + omega_g*{OUT}, -omega_i*{X_C})",
    "a_C": f"(alpha_i*{Z_C} - omega_g**2*{OUT} - omega_i**2*{X_C},"
    f" a_v + alpha_g*{OUT} + 2*omega_g*omega_i*{Z_C}, -alpha_i*{X_C} - omega_i**2*{Z_C})",
    "v_D": f"(omega_i*{Z_D}, v_v + omega_g*(l1 + {X_D}), -omega_i*{X_D})",
    "wheel_omega": "(-omega_w*cos(beta), omega_i, omega_g + omega_w*sin(beta))",
}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", RIGHT)
def test_closed_forms(name: str, seed: int) -> None:
    """Those of the publication that hold, put right; primed axes."""
    ours = getattr(dynamics(seed), name)[0]
    np.testing.assert_allclose(ours, value(RIGHT[name], seed, "'"), rtol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_following_the_yaw_changes_what_the_publication_has(seed: int) -> None:
    """Not counted as an error, since its A may move straight: an aircraft that rolls where it
    points has -omega_g v_v along x' in every acceleration as well.
    """
    particles = publications_instant(seed)
    motion = particles.motion(np.array([NOW]))
    rolling = leg_dynamics(particles.leg, replace(motion, course_rate=motion.omega_g))
    extra = np.array([-motion.omega_g[0] * motion.v_v[0], 0.0, 0.0])
    for point in "BCD":
        change = getattr(rolling, f"a_{point}") - getattr(dynamics(seed), f"a_{point}")
        assert change[0] == pytest.approx(extra, abs=1e-12)

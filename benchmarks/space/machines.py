"""Ten driven machines in space as plain data, from which our linkages and those of other codes are
built.

Every machine starts at rest as drawn and is moved by cycloidal drives. None has a redundant joint,
so that statics determines every component in every joint. All values are in SI units and world
axes.
"""

from __future__ import annotations

from typing import Any, TypedDict

import numpy as np

from benchmarks.space.bodies import BodyData, Vector, bennett_frames, block, rod, square, vector


class JointData(TypedDict, total=False):
    """A joint: its kind, bodies, point and directions as drawn."""

    kind: str
    base: str
    moving: str
    at: Vector
    axis: Vector
    second_axis: Vector


class DriveData(TypedDict):
    """A drive of the angle (rad) or travel (m) of a joint, from 0 as drawn to `to`."""

    joint: str
    measures: str
    to: float


class Machine(TypedDict):
    """A machine, the time its drives take, s, and loads that act all the time.

    forces: (body, point as drawn, force in world axes) of each load.
    """

    bodies: dict[str, BodyData]
    joints: dict[str, JointData]
    drives: dict[str, DriveData]
    forces: list[tuple[str, Vector, Vector]]
    gravity: Vector
    duration: float


WEIGHT: Vector = (0.0, 0.0, -9.81)


def _joint(kind: str, base: str, moving: str, at: Vector, *axes: Vector) -> JointData:
    joint: JointData = {"kind": kind, "base": base, "moving": moving, "at": at}
    if axes:
        joint["axis"] = axes[0]
    if len(axes) > 1:
        joint["second_axis"] = axes[1]
    return joint


def rssr() -> Machine:
    """Return a four-bar in space; a universal joint at one end keeps its coupler from spinning."""
    a, b, d = (0.25, 0.1, 0.35), (0.9, 0.75, 0.3), (1.0, 0.2, 0.1)
    rocker = (0.0, 0.3, 1.0)
    return {
        "bodies": {
            "crank": rod(3.0, (0.0, 0.1, 0.2), a),
            "coupler": rod(5.0, a, b),
            "rocker": rod(4.0, d, b),
        },
        "joints": {
            "O": _joint("revolute", "ground", "crank", (0.0, 0.1, 0.2), (0.2, 1.0, 0.1)),
            "A": _joint("spherical", "crank", "coupler", a),
            "B": _joint("universal", "rocker", "coupler", b, rocker, square((1, 0, 0), rocker)),
            "D": _joint("revolute", "ground", "rocker", d, (0.3, 0.1, 1.0)),
        },
        "drives": {"turn": {"joint": "O", "measures": "angle", "to": 1.1}},
        "forces": [("rocker", b, (40.0, -25.0, 60.0))],
        "gravity": WEIGHT,
        "duration": 0.8,
    }


def slider_crank() -> Machine:
    """Return a spatial slider-crank: the axes of crank and slider do not meet."""
    a, b = (0.0, 0.12, 0.16), (0.75, 0.15, -0.1)
    along = (1.0, 0.1, 0.05)
    return {
        "bodies": {
            "crank": block(2.5, (0.0, 0.05, 0.06), (0.02, 0.012, 0.011), (0.0, 0.0, -0.004)),
            "rod": rod(3.0, a, b, 0.02),
            "piston": block(4.0, (0.8, 0.16, -0.08), (0.01, 0.03, 0.028), (0.002, 0.001, 0.0)),
        },
        "joints": {
            "O": _joint("revolute", "ground", "crank", (0.05, 0.0, 0.0), (1.0, 0.0, 0.2)),
            "A": _joint("spherical", "crank", "rod", a),
            "B": _joint("universal", "piston", "rod", b, (0, 0, 1), (0, 1, 0)),
            "S": _joint("prismatic", "ground", "piston", (0.85, 0.14, -0.09), along),
        },
        "drives": {"turn": {"joint": "O", "measures": "angle", "to": 6.0}},
        "forces": [("piston", (0.9, 0.15, -0.1), (-300.0, 20.0, 0.0))],
        "gravity": WEIGHT,
        "duration": 1.5,
    }


def hooke() -> Machine:
    """Return two shafts at 35 degrees with a universal joint; a point on its axis guides the
    second.
    """
    out = vector((np.cos(np.radians(35.0)), np.sin(np.radians(35.0)), 0.0))
    end, across = vector(0.8 * np.array(out)), square((0, 1, 0), out)
    return {
        "bodies": {
            "input": block(6.0, (-0.3, 0.0, 0.0), (0.05, 0.2, 0.19), (0.01, 0.0, 0.02)),
            "output": block(9.0, vector(0.4 * np.array(out)), (0.2, 0.3, 0.4), (-0.05, 0.0, 0.0)),
        },
        "joints": {
            "I": _joint("revolute", "ground", "input", (-0.5, 0.0, 0.0), (1.0, 0.0, 0.0)),
            "U": _joint("universal", "input", "output", (0, 0, 0), (0, 0, 1), across),
            "E": _joint("point-on-line", "ground", "output", end, out),
        },
        "drives": {"turn": {"joint": "I", "measures": "angle", "to": 8.0}},
        "forces": [("output", (0.5, 0.5, 0.1), (20.0, 10.0, -30.0))],
        "gravity": WEIGHT,
        "duration": 1.0,
    }


def gyroscope() -> Machine:
    """Return a rotor that spins up in two gimbals, which are turned meanwhile: an open chain of
    hinges.
    """
    at = (0.0, 0.0, 0.0)
    return {
        "bodies": {
            "outer": block(3.0, (0.0, 0.0, 0.01), (0.05, 0.06, 0.04), (0.001, 0.0, 0.002)),
            "inner": block(2.0, (0.01, 0.0, 0.0), (0.02, 0.03, 0.025), (0.0, 0.001, 0.0)),
            "rotor": block(8.0, (0.0, 0.02, 0.002), (0.05, 0.09, 0.052), (0.002, 0.0, 0.003)),
        },
        "joints": {
            "Z": _joint("revolute", "ground", "outer", (0.0, 0.0, -0.3), (0.0, 0.0, 1.0)),
            "X": _joint("revolute", "outer", "inner", (0.2, 0.0, 0.0), (1.0, 0.0, 0.0)),
            "Y": _joint("revolute", "inner", "rotor", at, (0.0, 1.0, 0.0)),
        },
        "drives": {
            "yaw": {"joint": "Z", "measures": "angle", "to": 1.5},
            "pitch": {"joint": "X", "measures": "angle", "to": -0.9},
            "spin": {"joint": "Y", "measures": "angle", "to": 40.0},
        },
        "forces": [],
        "gravity": WEIGHT,
        "duration": 1.2,
    }


def crane() -> Machine:
    """Return a slewing crane: a jack with a universal and a spherical end lifts the boom and a
    fixed payload.
    """
    jack, eye, tip = (0.6, 0.1, 0.5), (1.6, 0.05, 1.9), (4.0, -0.1, 3.2)
    way = (1.0, -0.05, 1.4)
    return {
        "bodies": {
            "tower": block(900.0, (0.0, 0.0, 0.8), (400.0, 420.0, 150.0), (5.0, 12.0, -8.0)),
            "boom": rod(300.0, (0.2, 0.0, 1.5), tip, 0.15),
            "barrel": rod(40.0, jack, (1.1, 0.075, 1.2), 0.08),
            "rod": rod(25.0, (1.0, 0.08, 1.06), eye, 0.05),
            "load": block(500.0, (4.1, -0.2, 2.7), (80.0, 90.0, 60.0), (10.0, -5.0, 4.0)),
        },
        "joints": {
            "slew": _joint("revolute", "ground", "tower", (0.0, 0.0, 0.0), (0.0, 0.02, 1.0)),
            "hinge": _joint("revolute", "tower", "boom", (0.2, 0.0, 1.5), (0.0, 1.0, 0.0)),
            "foot": _joint(
                "universal", "tower", "barrel", jack, (0, 1, 0), square((1, 0, 0), (0, 1, 0))
            ),
            "gland": _joint("prismatic", "barrel", "rod", (1.1, 0.075, 1.2), way),
            "eye": _joint("spherical", "boom", "rod", eye),
            "grip": _joint("fixed", "boom", "load", tip),
        },
        "drives": {
            "slewing": {"joint": "slew", "measures": "angle", "to": 1.2},
            "lifting": {"joint": "gland", "measures": "travel", "to": 0.35},
        },
        "forces": [("load", (4.1, -0.2, 2.4), (150.0, 400.0, -900.0))],
        "gravity": WEIGHT,
        "duration": 4.0,
    }


def landing_gear() -> Machine:
    """Return a leg that folds about a skewed hinge, held by a folding stay out of its plane."""
    knee, eye = (0.55, 0.45, -0.45), (0.05, 0.1, -0.9)
    return {
        "bodies": {
            "leg": rod(80.0, (0.0, 0.0, 0.0), (-0.05, 0.1, -1.8), 0.08),
            "wheel": block(60.0, (-0.15, 0.1, -1.8), (4.0, 2.3, 2.3), (0.05, 0.0, -0.02)),
            "upper": rod(12.0, (1.0, 0.6, 0.0), knee, 0.03),
            "lower": rod(10.0, eye, knee, 0.03),
        },
        "joints": {
            "hinge": _joint("revolute", "ground", "leg", (0.0, 0.0, 0.0), (0.3, 1.0, 0.1)),
            "axle": _joint("revolute", "leg", "wheel", (-0.1, 0.1, -1.8), (1.0, 0.0, 0.0)),
            "stay": _joint("universal", "ground", "upper", (1.0, 0.6, 0.0), (0, 1, 0), (1, 0, 0)),
            "knee": _joint("revolute", "upper", "lower", knee, (-0.4, 1.0, 0.1)),
            "eye": _joint("spherical", "leg", "lower", eye),
        },
        "drives": {
            "fold": {"joint": "hinge", "measures": "angle", "to": -0.4},
            "roll": {"joint": "axle", "measures": "angle", "to": 30.0},
        },
        "forces": [("leg", (-0.2, 0.1, -2.2), (500.0, 300.0, 2000.0))],
        "gravity": WEIGHT,
        "duration": 2.0,
    }


def table() -> Machine:
    """Return a table on a tilted plane, moved by two cranks whose pins engage it along
    its normal.
    """
    n, u, v = _plane()

    def at(x: float, y: float, z: float) -> Vector:
        return vector(x * u + y * v + z * n)

    normal = vector(n)
    cranks = {
        name: rod(2.0, at(x, 0.0, -0.1), at(x + 0.15, y, -0.05))
        for name, x, y in (("first", 0.0, 0.2), ("second", 0.8, 0.25))
    }
    plate = block(15.0, at(0.5, 0.3, 0.05), (1.2, 1.5, 2.4), (0.1, -0.05, 0.2))
    return {
        "bodies": cranks | {"plate": plate},
        "joints": {
            "P": _joint("planar", "ground", "plate", at(0.4, 0.2, 0.0), normal),
            "O1": _joint("revolute", "ground", "first", at(0.0, 0.0, -0.1), normal),
            "O2": _joint("revolute", "ground", "second", at(0.8, 0.0, -0.1), normal),
            "A1": _joint("point-on-line", "plate", "first", at(0.15, 0.2, -0.05), normal),
            "A2": _joint("point-on-line", "plate", "second", at(0.95, 0.25, -0.05), normal),
        },
        "drives": {"turn": {"joint": "O1", "measures": "angle", "to": 0.9}},
        "forces": [("plate", at(0.6, 0.1, 0.1), (30.0, -60.0, -100.0))],
        "gravity": WEIGHT,
        "duration": 0.9,
    }


def _plane() -> Any:
    """Return the normal of a tilted plane, and two directions in it."""
    n = np.array([0.2, -0.3, 1.0]) / np.linalg.norm([0.2, -0.3, 1.0])
    u = np.cross([0.0, 1.0, 0.0], n)
    u = u / np.linalg.norm(u)
    return n, u, np.cross(n, u)


def quill() -> Machine:
    """Return a heavy quill that turns and slides on a tilted cylinder, with a skewed rotor at its
    end.
    """
    return {
        "bodies": {
            "quill": block(20.0, (0.1, 0.05, 0.4), (0.9, 0.8, 0.2), (0.05, 0.1, -0.04)),
            "rotor": block(5.0, (0.3, 0.1, 0.9), (0.06, 0.05, 0.08), (0.01, 0.015, -0.01)),
        },
        "joints": {
            "C": _joint("cylindrical", "ground", "quill", (0.0, 0.0, 0.0), (0.1, -0.2, 1.0)),
            "R": _joint("revolute", "quill", "rotor", (0.25, 0.1, 0.85), (1.0, 0.3, 0.4)),
        },
        "drives": {
            "turn": {"joint": "C", "measures": "angle", "to": 2.5},
            "feed": {"joint": "C", "measures": "travel", "to": -0.4},
            "spin": {"joint": "R", "measures": "angle", "to": 15.0},
        },
        "forces": [("rotor", (0.3, 0.1, 1.0), (12.0, -7.0, 5.0))],
        "gravity": WEIGHT,
        "duration": 0.7,
    }


def two_stage() -> Machine:
    """Return two RSUR four-bars in series: the rocker of the first is the crank of the second."""
    first = rssr()
    c, e, f = (1.1, 0.8, -0.1), (1.6, 0.5, 0.6), (1.8, -0.1, 0.4)
    follower = (1.0, 0.2, 0.5)
    across = square((0, 1, 0), follower)
    first["bodies"] |= {"second coupler": rod(4.0, c, e), "follower": rod(3.0, f, e)}
    first["joints"] |= {
        "C": _joint("spherical", "rocker", "second coupler", c),
        "E": _joint("universal", "follower", "second coupler", e, follower, across),
        "F": _joint("revolute", "ground", "follower", f, (0.2, 0.1, 1.0)),
    }
    first["drives"]["turn"]["to"] = 0.7
    return first


def bennett() -> Machine:
    """Return Bennett's linkage, two of whose hinges are relieved: one is spherical, one
    cylindrical.

    Links a = 0.5 m twisted by 40 degrees, and b with the same sin(twist) / b.
    """
    a, alpha = 0.5, np.radians(40.0)
    beta = np.radians(70.0)
    b = a * np.sin(beta) / np.sin(alpha)
    points, axes = bennett_frames(a, b, alpha, beta, 0.7)
    p, w = [vector(x) for x in points], [vector(x) for x in axes]
    return {
        "bodies": {
            "crank": rod(4.0, p[0], p[1]),
            "coupler": rod(6.0, p[1], p[2]),
            "rocker": rod(4.0, p[3], p[2]),
        },
        "joints": {
            "J0": _joint("revolute", "ground", "crank", p[0], w[0]),
            "J1": _joint("revolute", "crank", "coupler", p[1], w[1]),
            "J2": _joint("spherical", "coupler", "rocker", p[2]),
            "J3": _joint("cylindrical", "ground", "rocker", p[3], w[3]),
        },
        "drives": {"turn": {"joint": "J0", "measures": "angle", "to": 1.6}},
        "forces": [("rocker", p[2], (30.0, 50.0, -80.0))],
        "gravity": WEIGHT,
        "duration": 1.0,
    }


MACHINES = {
    "rssr": rssr,
    "slider-crank": slider_crank,
    "hooke": hooke,
    "gyroscope": gyroscope,
    "crane": crane,
    "landing-gear": landing_gear,
    "table": table,
    "quill": quill,
    "two-stage": two_stage,
    "bennett": bennett,
}

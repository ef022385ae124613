"""Valid linkages in space drawn at random: cranes, telescopes, and cranks that swing a jib."""

from __future__ import annotations

import math
import random

import numpy as np

from pinbase.arrays import Floats
from tests.fuzz.draw_mechanism import GROUND, Drawn
from tests.fuzz.quantity import Quantity, Tree, angle, force, length

# Where the joints of a jib swung by a crank are drawn, of a crank of length 1: the crank's shaft,
# the cross and the ball of the rod, and the foot of the jib.
CRANK_POINTS = {
    "A": (0.0, 0.0, 0.0),
    "B": (1.0, 0.0, 0.0),
    "C": (3.0, 2.5, 2.0),
    "D": (3.0, 2.5, 0.0),
}


class Frame:
    """Where a linkage is drawn: turned, shifted and scaled at random."""

    def __init__(self, rng: random.Random) -> None:
        self.size = math.exp(rng.uniform(math.log(0.05), math.log(1.5)))
        turn, _ = np.linalg.qr(np.array([[rng.gauss(0.0, 1.0) for _ in "xyz"] for _ in "xyz"]))
        self.turn: Floats = turn * np.sign(np.linalg.det(turn))
        self.shift = np.array([rng.uniform(-1.0, 1.0) for _ in "xyz"])

    def point(self, at: tuple[float, float, float]) -> list[Quantity]:
        """[x, y, z], m, of a point of the unit drawing."""
        return [length(float(x)) for x in self.size * (self.turn @ at) + self.shift]

    def axis(self, along: tuple[float, float, float]) -> list[float]:
        """A direction."""
        return [float(x) for x in self.turn @ along]


def spatial(rng: random.Random) -> Drawn:
    """One of the kinds, with a motion, a case at rest, or both."""
    frame = Frame(rng)
    table, tip, classes = rng.choice((_crane, _telescope, _swung))(rng, frame)
    table |= {"dimension": 3}
    if rng.random() < 0.4:
        table["gravity"] = [Quantity(0.0, "acceleration")] * 3
    if rng.random() < 0.3:
        table["torsion_spring"] = {"t": {"joint": "A", "stiffness": Quantity(
            rng.uniform(0.1, 50.0), "torsional stiffness")}}  # fmt: skip
        classes.add("springs")
    load: Tree = {"body": tip, "force": [force(rng.uniform(-3e3, 3e3)) for _ in "xyz"]}
    if rng.random() < 0.3:
        load["follows"] = True
    cases: Tree = {}
    for kind in rng.sample(("motion", "static"), rng.choice((1, 1, 2))):
        spread = rng.choice(("uniform", "cosine"))
        cases[kind] = {"kind": kind, "apply": [load], "distribution": spread}
        cases[kind] |= {"samples": rng.choice((5, 11))} if kind == "motion" else {}
    joints = {k: (tuple(j["connections"]), False) for k, j in table["joint"].items()}
    if rng.random() < 0.3 and len(cases) == 2:
        classes.add("sequence")
    return Drawn(table, cases, joints, frozenset(classes | {"space"}))


def _drive(rng: random.Random, **what: str) -> Tree:
    law, still = rng.choice(("cosine", "cycloidal", "constant")), "slide" in what
    end = length(rng.uniform(0.02, 0.1)) if still else angle(rng.uniform(-1.0, 1.0))
    start = length(0.0) if still else angle(0.0)
    return {**what, "law": law, "start": start, "end": end, "duration": Quantity(2.0, "time")}


def _body(rng: random.Random, frame: Frame, centre: tuple[float, float, float]) -> Tree:
    mass = rng.uniform(0.5, 20.0)
    turning = [Quantity(0.1 * mass * frame.size**2, "inertia")] * 3
    return {"mass": Quantity(mass, "mass"), "centre": frame.point(centre)} | (
        {"inertia": turning} if rng.random() < 0.7 else {}
    )


def _joint(frame: Frame, at: tuple[float, float, float], name: str, ends: str) -> Tree:
    """ends: the body that carries the pin, and that on it, with a space between."""
    carrier, moving = ends.split()
    return {"at": frame.point(at), "fixed_in": carrier, "connections": {f"{name}1": moving}}


def _crane(rng: random.Random, frame: Frame) -> tuple[Tree, str, set[str]]:
    """A mast that slews and a boom that luffs, about any two axes."""
    skew = (rng.uniform(-0.5, 0.5), 1.0, rng.uniform(-0.5, 0.5))
    joints = {
        "A": _joint(frame, (0.0, 0.0, 0.0), "A", f"{GROUND} mast")
        | {"axis": frame.axis((0, 0, 1))},
        "B": _joint(frame, (0.2, 0.0, 1.0), "B", "mast boom") | {"axis": frame.axis(skew)},
    }
    bodies = {
        "mast": _body(rng, frame, (0.0, 0.1, 0.5)),
        "boom": _body(rng, frame, (1.0, 0.0, 1.2)),
    }
    drives = [_drive(rng, joint="A", name="slew"), _drive(rng, joint="B", name="luff")]
    return {"joint": joints, "body": bodies, "drive": drives}, "boom", {"crane in space"}


def _telescope(rng: random.Random, frame: Frame) -> tuple[Tree, str, set[str]]:
    """A boom about a skew hinge with an extension that slides or also turns in it."""
    kind = rng.choice(("prismatic", "cylindrical"))
    joints = {
        "A": _joint(frame, (0.0, 0.0, 0.0), "A", f"{GROUND} boom")
        | {"axis": frame.axis((0.0, 1.0, 0.3))},
        "B": _joint(frame, (1.0, 0.0, 0.1), "B", "boom tip")
        | {"axis": frame.axis((1.0, 0.0, 0.1)), "kind": kind, "pin_axis": frame.axis((0, 0, 1))},
    }
    bodies = {"boom": _body(rng, frame, (0.5, 0.0, 0.0)), "tip": _body(rng, frame, (1.5, 0.0, 0.2))}
    drives = [_drive(rng, joint="A", name="hinge"), _drive(rng, slide="B", name="reach")]
    if kind == "cylindrical":
        drives.append(_drive(rng, joint="B", name="roll"))
    return {"joint": joints, "body": bodies, "drive": drives}, "tip", {kind}


def _swung(rng: random.Random, frame: Frame) -> tuple[Tree, str, set[str]]:
    """A crank about one axis that swings a jib about another, through a cross and a ball."""
    carriers = {"A": f"{GROUND} crank", "B": "crank rod", "C": "jib rod", "D": f"{GROUND} jib"}
    joints = {k: _joint(frame, CRANK_POINTS[k], k, ends) for k, ends in carriers.items()}
    joints["A"]["axis"] = frame.axis((0, 0, 1))
    joints["B"] |= {"kind": "universal", "axis": frame.axis((0, 0, 1)),
                    "second_axis": frame.axis((0, 1, 0))}  # fmt: skip
    joints["C"] |= {"kind": "spherical", "pin_axis": frame.axis((1, 0, 0))}
    joints["D"]["axis"] = frame.axis((1, 0, 0))
    rod: Tree = {"joints": ["B", "C"], "density": Quantity(7850.0, "density")}
    rod |= (
        {"diameter": length(0.1 * frame.size)}
        if rng.random() < 0.5
        else {"section": [length(0.1 * frame.size), length(0.05 * frame.size)],
              "depth_along": frame.axis((0, 0, 1))}
    )  # fmt: skip
    bodies = {"crank": _body(rng, frame, (0.5, 0.0, 0.0)), "rod": {"bar": rod},
              "jib": _body(rng, frame, (3.0, 2.5, 1.0))}  # fmt: skip
    drive = _drive(rng, joint="A") | {"end": angle(rng.uniform(0.2, 1.5))}
    if rng.random() < 0.3:
        joints["A"] |= {"friction": 0.1, "diameter": length(0.1 * frame.size)}
        return {"joint": joints, "body": bodies, "drive": drive}, "jib", {"swung jib", "friction"}
    return {"joint": joints, "body": bodies, "drive": drive}, "jib", {"swung jib"}

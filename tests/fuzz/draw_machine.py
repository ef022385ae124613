"""Valid machines drawn at random: gears, booms on two cylinders, trusses, welds, springs."""

from __future__ import annotations

import math
import random

from tests.fuzz.draw_mechanism import GROUND, Drawn, dyad, mechanism, point
from tests.fuzz.quantity import Quantity, Tree, angle, force, length, moment

UNIFORM = {"distribution": "uniform"}


def machine(rng: random.Random) -> Drawn:
    """One of the kinds."""
    return rng.choice((gears, boom, truss, truss, welded, sprung))(rng)


def _mass(rng: random.Random, size: float) -> Tree:
    mass = rng.uniform(0.1, 20.0)
    return {"mass": Quantity(mass, "mass"), "inertia": Quantity(0.1 * mass * size**2, "inertia")}


def _free(drawn: Tree) -> dict[str, tuple[tuple[str, ...], bool]]:
    """Connections by joint, and whether its pin floats."""
    return {k: (tuple(j["connections"]), "fixed_in" not in j) for k, j in drawn["joint"].items()}


def gears(rng: random.Random) -> Drawn:
    """A pinion and a wheel on the ground: driven, or locked without a drive."""
    size = math.exp(rng.uniform(-3.0, 0.0))
    teeth = [rng.choice((17, 20, 25)), rng.choice((30, 41, 60))]
    load = {"body": "wheel", "couple": moment(rng.uniform(-500.0, 500.0) * size)}
    table: Tree = {
        "joint": {
            "A": {"at": point(0j), "fixed_in": GROUND, "connections": {"A": "pinion"}},
            "B": {"at": point(complex(size)), "fixed_in": GROUND, "connections": {"B": "wheel"}},
        },
        "body": {"pinion": _mass(rng, 0.2 * size), "wheel": _mass(rng, 0.5 * size)},
        "gear": {"teeth": {"bodies": ["pinion", "wheel"], "joints": ["A", "B"], "teeth": teeth}},
    }
    if rng.random() < 0.5:
        table["stop"] = {"lock": {"bodies": [GROUND, rng.choice(("pinion", "wheel"))]}}
        case: Tree = {"kind": "static", "hold": ["lock"], "apply": [load]} | UNIFORM
        return Drawn(table, {"locked": case}, _free(table), frozenset({"gears", "locked"}))
    table["drive"] = {
        "body": "pinion",
        "law": "cosine",
        "start": angle(0.0),
        "end": angle(rng.uniform(1.0, 30.0)),
        "duration": Quantity(1.0, "time"),
    }
    cases: Tree = {
        "turn": {"kind": "motion", "samples": 9, "apply": [load]} | UNIFORM,
        "stand": {"kind": "static", "apply": [load]} | UNIFORM,
    }
    return Drawn(table, cases, _free(table), frozenset({"gears", "sequence"}))


def boom(rng: random.Random) -> Drawn:
    """A boom lifted by two cylinders side by side, of which one is driven."""
    size = math.exp(rng.uniform(-2.0, 1.0))
    foot, eye = size * complex(0.4, -0.6), size * complex(0.9, 0.1)
    long = abs(eye - foot)
    joints: Tree = {"O": {"at": point(0j), "fixed_in": GROUND, "connections": {"O": "boom"}}}
    bodies: Tree = {"boom": _mass(rng, size) | {"centre": point(size * complex(1.0, 0.1))}}
    sliders: Tree = {}
    for side in ("left", "right"):
        bodies |= {f"{side} barrel": _mass(rng, 0.3 * long) | {"centre": point(foot)},
                   f"{side} rod": _mass(rng, 0.3 * long) | {"centre": point(eye)}}  # fmt: skip
        joints |= {
            f"{side} foot": {"at": point(foot), "fixed_in": GROUND,
                             "connections": {f"{side[0]}f": f"{side} barrel"}},
            f"{side} eye": {"at": point(eye), "fixed_in": "boom",
                            "connections": {f"{side[0]}e": f"{side} rod"}},
        }  # fmt: skip
        sliders[side] = {"bodies": [f"{side} barrel", f"{side} rod"],
                         "joints": [f"{side} foot", f"{side} eye"]}  # fmt: skip
    shares = rng.choice(("areas", "stiffness"))
    table: Tree = {
        "joint": joints, "body": bodies, "slider": sliders,
        "drive": {"slider": "left", "law": "cosine", "start": length(long),
                  "end": length(1.1 * long), "duration": Quantity(2.0, "time")},
        "sharing": [{"parallel": ["left", "right"], shares: [1.0, rng.uniform(0.5, 2.0)]}],
    }  # fmt: skip
    load = {"body": "boom", "at": point(size * complex(1.6, 0.2)),
            "force": [force(rng.uniform(-1e3, 1e3)), force(rng.uniform(-5e3, 0.0))]}  # fmt: skip
    cases: Tree = {
        "lift": {"kind": "motion", "samples": 7, "apply": [load]} | UNIFORM,
        "stand": {"kind": "static", "apply": [load]} | UNIFORM,
    }
    return Drawn(table, cases, _free(table), frozenset({"parallel drives", "sequence"}))


def truss(rng: random.Random) -> Drawn:
    """Triangles on a pin and a roller, or on two pins; now and then braced twice, with a rule."""
    size, panels = math.exp(rng.uniform(-2.0, 2.0)), rng.choice((1, 1, 2, 3))
    nodes = {"A": 0j, "B": size * complex(1.0, rng.uniform(-0.1, 0.1))}
    names, bars = "ABCDE", ["AB"]
    for k in range(panels):  # the next node stands on the last two
        one, other = names[k], names[k + 1]
        a, b = (size * rng.uniform(0.7, 1.2) for _ in range(2))
        nodes[names[k + 2]] = dyad(nodes[one], nodes[other], a, b, left=k % 2 == 0)
        bars += [one + names[k + 2], other + names[k + 2]]
    fixed = rng.random() < 0.4
    joints: Tree = {}
    for name, at in nodes.items():
        turning = {f"{bar} {name}": bar for bar in bars if name in bar}
        joints[name] = {"at": point(at), "connections": turning}
        if name == "A" or (name == "B" and fixed):
            joints[name]["fixed_in"] = GROUND
    bodies: Tree = {
        bar: {"bar": {"joints": [bar[0], bar[1]], "diameter": length(0.03 * size),
                      "density": Quantity(7850.0, "density")}} for bar in bars
    }  # fmt: skip
    table: Tree = {"joint": joints, "body": bodies}
    classes = {"truss"}
    if fixed:  # the bar between two pins of the ground is redundant along itself
        table["sharing"] = [{"connections": ["AB A", "AB B"], "stiffness": [1.0, 1.0]}]
        classes.add("redundant")
    else:
        bodies["roller"] = {"mass": Quantity(0.0, "mass")}
        joints["B"]["connections"]["roller"] = "roller"
        table["slider"] = {"rail": {"bodies": [GROUND, "roller"], "joints": [point(0j), "B"],
                                    "direction": [1.0, 0.0]}}  # fmt: skip
    top = names[panels + 1]
    load = {"body": bars[-1], "at": top, "force": [force(rng.uniform(-5e3, 5e3)) for _ in "xy"]}
    kinds = rng.sample(("static", "instant"), rng.choice((1, 2)))
    cases = {kind: {"kind": kind, "apply": [load]} | UNIFORM for kind in kinds}
    return Drawn(table, cases, _free(table), frozenset(classes))


def welded(rng: random.Random) -> Drawn:
    """A linkage whose last link carries a bracket, on which the loads act."""
    drawn = mechanism(rng)
    last = [*drawn.mechanism["body"]][0 if "slider" in drawn.mechanism else 2]
    at = next(iter(drawn.mechanism["joint"].values()))["at"]
    bracket = _mass(rng, 0.1) | {"centre": at, "welded_to": last}
    bodies = drawn.mechanism["body"] | {"bracket": bracket}
    cases = {
        name: case | {"apply": [*case["apply"], {"body": "bracket", "at": at,
                                                 "force": [force(300.0), force(-200.0)]}]}
        for name, case in drawn.cases.items()
    }  # fmt: skip
    table = drawn.mechanism | {"body": bodies}
    return Drawn(table, cases, drawn.joints, drawn.classes | {"welded"})


def sprung(rng: random.Random) -> Drawn:
    """A linkage with a spring and a damper on its crank."""
    drawn = mechanism(rng)
    spring: Tree = {"bodies": [GROUND, "crank"], "joints": [point(complex(5.0, 5.0)), "A"],
                    "stiffness": Quantity(rng.uniform(10.0, 1e4), "stiffness"),
                    "preload": force(rng.uniform(-100.0, 100.0)),
                    "damping": Quantity(rng.uniform(0.0, 50.0), "damping")}  # fmt: skip
    turning: Tree = {
        "bodies": [GROUND, "crank"],
        "preload": moment(rng.uniform(-5.0, 5.0)),
        "stiffness": Quantity(rng.uniform(0.1, 50.0), "torsional stiffness"),
    }
    table = drawn.mechanism | {"spring": {"s": spring}, "torsion_spring": {"t": turning}}
    return Drawn(table, drawn.cases, drawn.joints, drawn.classes | {"springs"})

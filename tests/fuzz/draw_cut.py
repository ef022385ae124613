"""Valid pins with cuts and cones, drawn at random: holes, flats, slots, passages, tapers."""

from __future__ import annotations

import math
import random

from tests.fuzz.draw_pin import rounded
from tests.fuzz.quantity import INCH, Tree, angle, force, length


def pin(rng: random.Random, name: str) -> tuple[Tree, Tree, set[str]]:
    """A cantilever of three segments, the last with a link, and a cut or a cone in the middle.

    Returns its table, the forces by connection, and the classes to which it belongs.
    """
    unit = rng.choice((1e-3, INCH))
    d = rounded(math.exp(rng.uniform(math.log(6e-3), math.log(0.1))) / unit, 2) * unit
    long = [d * rounded(rng.uniform(0.6, 2.5), 2) for _ in range(3)]
    profile: list[Tree] = [
        {"length": length(long[0]), "diameter": length(d), "name": "root"},
        {"length": length(long[1]), "diameter": length(d), "name": "middle"},
        {"length": length(long[2]), "diameter": length(d), "connection": f"{name}0"},
    ]
    kind = rng.choice(("cone", "chamfer", "hole", "flat", "slot", "passage"))
    table: Tree = {"material": "steel", "clamp": [rng.choice(("start", "root"))]}
    if kind == "cone":
        end = d * rounded(rng.uniform(0.6, 0.95), 2)
        profile[1]["diameter"] = [length(d), length(end)]
        profile[2]["diameter"] = length(end)
    elif kind == "chamfer":
        tip = d * 0.06
        ends = [length(d), length(d - 2.0 * tip)]
        profile.append({"length": length(tip), "diameter": ends, "name": "tip"})
    else:
        table |= {kind: [_CUTS[kind](rng, d, long)]}
    size = 10.0 ** rng.uniform(5.5, 7.0) * d**2
    pull = [size * rng.uniform(-1.0, 1.0) for _ in range(2)]
    return table | {"profile": profile}, {f"{name}0": [force(x) for x in pull]}, {"cut", kind}


def _hole(rng: random.Random, d: float, long: list[float]) -> Tree:
    z, bore = long[0] + 0.5 * long[1], rounded(rng.uniform(0.1, 0.3), 2) * d
    hole: Tree = {"z": length(z), "diameter": length(bore), "angle": angle(rng.uniform(-3.0, 3.0))}
    if rng.random() < 0.4:
        hole["mouth_radius"] = length(0.15 * bore)
    elif rng.random() < 0.4:
        hole["chamfer"] = length(0.15 * bore)
    if rng.random() < 0.3:
        hole |= {"depth": length(rng.uniform(0.3, 0.45) * d), "bottom_radius": length(0.1 * bore)}
    return hole if len(hole) > 3 else hole | aslant(f"{z} {bore}", d, bore, 0.9)


def aslant(dice: str, d: float, bore: float, most: float) -> Tree:
    """Offset, tilt, both or neither of a hole through a pin; by dice of their own, so that all else
    of a study falls as it does without them.

    d, bore: diameters of pin and hole, m. most: largest tilt, rad.
    """
    rng = random.Random(f"aslant {dice}")
    room = 0.45 * d - 0.5 * bore
    offset = {"offset": length(room * rounded(rng.uniform(-1.0, 1.0), 2))}
    tilt = {"tilt": angle(rounded(rng.uniform(-most, most), 2))}
    return rng.choice(({}, offset, tilt, offset | tilt))


def _flat(rng: random.Random, d: float, long: list[float]) -> Tree:
    z = [length(long[0] + 0.25 * long[1]), length(long[0] + 0.75 * long[1])]
    flat: Tree = {"z": z, "distance": length(d * rounded(rng.uniform(0.36, 0.46), 2)),
                  "angle": angle(rng.uniform(-3.0, 3.0))}  # fmt: skip
    return flat | ({"radius": length(0.03 * d)} if rng.random() < 0.6 else {})


def _slot(rng: random.Random, d: float, long: list[float]) -> Tree:
    width = rounded(rng.uniform(0.12, 0.25), 2) * d
    z = [length(long[0] + 0.1 * long[1]), length(long[0] + 0.9 * long[1])]
    slot: Tree = {"z": z, "width": length(min(width, 0.6 * long[1])),
                  "depth": length(rounded(rng.uniform(0.1, 0.2), 2) * d),
                  "angle": angle(rng.uniform(-3.0, 3.0))}  # fmt: skip
    slot |= {"radius": length(0.02 * d)} if rng.random() < 0.6 else {}
    return slot | ({"ends": "square"} if rng.random() < 0.2 else {})


def _passage(rng: random.Random, d: float, long: list[float]) -> Tree:
    passage: Tree = {"offset": length(0.2 * d), "diameter": length(0.15 * d), "end": "end",
                     "angle": angle(rng.uniform(-3.0, 3.0))}  # fmt: skip
    deep = {"depth": length(long[2] + 0.5 * long[1]), "bottom_radius": length(0.02 * d)}
    return passage | (deep if rng.random() < 0.5 else {})


_CUTS = {"hole": _hole, "flat": _flat, "slot": _slot, "passage": _passage}

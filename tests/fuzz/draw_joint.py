"""Valid pins in lugs drawn at random: fits, edges, bushings, shanks, tilts, and forces of links."""

from __future__ import annotations

import math
import random

from tests.fuzz.draw_pin import rounded
from tests.fuzz.quantity import INCH, Quantity, Tree, angle, force, length

FITS = ("H7/f7", "H7/g6", "H8/f7", "H9/d9", "H7/h6")  # of ISO 286 up to 500 mm
BRONZE: Tree = {
    "youngs_modulus": Quantity(110e9, "stress"),
    "poisson_ratio": 0.34,
    "yield_strength": Quantity(250e6, "stress"),
}


def joint(rng: random.Random, name: str) -> tuple[Tree, Tree, set[str]]:
    """A pin's table, the forces of its links by connection, and the classes to which it belongs.

    Two links pull against each other, or three as a fork and an eye; one or two pull against lugs
    of the structure.
    """
    unit = rng.choice((1e-3, INCH))
    diameter = rounded(math.exp(rng.uniform(math.log(6e-3), math.log(0.1))) / unit, 2) * unit
    layout = rng.choice(("LL", "LLL", "LLL", "LLL", "SLS", "SLLS", "LS"))
    classes = {"lugs", f"lugs {layout}"}
    profile: list[Tree] = []
    middles, widths, z = [], [], 0.0
    for i, kind in enumerate(layout):
        gap = diameter * rng.choice((0.0, 0.02, 0.1, 0.5))
        if gap:
            z += _add(profile, gap, diameter, {})
        width = diameter * rounded(rng.uniform(0.3, 1.5), 2)
        key = {"connection": f"{name}{i}"} if kind == "L" else {"name": f"{name} wall {i}"}
        middles.append(z + 0.5 * width)
        widths.append(width)
        z += _add(profile, width, diameter, key)
    if rng.random() < 0.7:
        _add(profile, diameter * 0.1, diameter, {})
    if rng.random() < 0.3:
        bore = length(diameter * rounded(rng.uniform(0.1, 0.6), 2))
        profile = [{**segment, "bore": bore} for segment in profile]
        classes.add("bored")
    names = [s.get("connection", s.get("name")) for s in profile]
    bands = [n for n in names if n is not None]
    couple = len(layout) == 2  # which two lugs carry by what resists their tilting
    lugs = {band: _lug(rng, diameter, couple, classes) for band in bands}
    table: Tree = {"material": "steel", "profile": profile, "lug": lugs}
    linked = [(band, at) for band, at, k in zip(bands, middles, layout, strict=True) if k == "L"]
    return table, _forces(rng, diameter, linked, "S" in layout), classes


def _add(profile: list[Tree], long: float, diameter: float, key: Tree) -> float:
    """Add a segment; its length, m."""
    profile.append({"length": length(long), "diameter": length(diameter), **key})
    return long


def _lug(rng: random.Random, diameter: float, couple: bool, classes: set[str]) -> Tree:
    """A lug of a band of this diameter, m; couple: whether it must resist tilting."""
    outer = rounded(rng.uniform(1.7, 3.5), 2)
    lug: Tree = {"outer_diameter": length(outer * diameter)} if rng.random() < 0.7 else {}
    kind = rng.choice(("fit", "clearance", "none"))
    if kind == "fit":
        lug["fit"] = rng.choice(FITS)
    elif kind == "clearance":
        lug["clearance"] = length(diameter * rng.choice((0.0, 0.0005, 0.002, 0.005, -0.0003)))
    if rng.random() < 0.5:
        lug["edge_radius"] = length(diameter * rng.choice((0.01, 0.03, 0.05)))
    ways = ["guided", None, None] if couple else ["guided", "free", None, None]
    if (tilt := rng.choice(ways)) is not None:
        lug["tilt"] = tilt
    if rng.random() < 0.25:
        lug["bushing"] = {"thickness": length(diameter * rng.uniform(0.06, 0.15)),
                          "material": "bronze"}  # fmt: skip
        if rng.random() < 0.5:
            lug["bushing"]["interference"] = length(diameter * rng.uniform(0.0002, 0.001))
    if rng.random() < 0.25:
        lug["shank"] = {"shape": rng.choice(("round", "tapered", "square"))}
        if rng.random() < 0.5:
            lug["shank"]["angle"] = angle(rng.uniform(-math.pi, math.pi))
    classes |= {key for key in ("fit", "tilt", "bushing", "shank", "edge_radius") if key in lug}
    return lug


def _forces(
    rng: random.Random, diameter: float, linked: list[tuple[str, float]], walls: bool
) -> Tree:
    """Forces of links at z (m) in balance, unless walls hold the pin."""
    size = 10.0 ** rng.uniform(6.0, 7.5) * diameter**2
    pulls = [[size * rng.uniform(-1.0, 1.0) for _ in range(2)] for _ in linked]
    if not walls and len(linked) == 2:
        pulls[1] = [-f for f in pulls[0]]
    elif not walls:
        (_, a), (_, b), (_, c) = linked
        share = (c - b) / (c - a)  # of a beam on two supports
        pulls = [[-f * part for f in pulls[1]] for part in (share, -1.0, 1.0 - share)]
    return {band: [force(x) for x in pull] for (band, _), pull in zip(linked, pulls, strict=True)}

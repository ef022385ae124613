"""Valid pins in lugs drawn at random: fits, edges, bushings, shanks, friction, tilts, holes and
heads, and forces of links.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from tests.fuzz.draw_cut import aslant
from tests.fuzz.draw_pin import rounded
from tests.fuzz.quantity import INCH, Quantity, Tree, angle, force, length

FITS = ("H7/f7", "H7/g6", "H8/f7", "H9/d9", "H7/h6")  # of ISO 286 up to 500 mm
CLASSES = ("fit", "tilt", "bushing", "shank", "edge_radius", "friction", "range")
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
    layout = rng.choice(("LL", "LLL", "LLL", "LLL", "SLS", "SLLS", "LS"))
    seat = Seat(rng, name, layout, [f"{name}{i}" for i, kind in enumerate(layout) if kind == "L"])
    return seat.table, _forces(rng, seat, "S" in layout), seat.classes


class Seat:
    """A pin in lugs of links (L) and of the structure (S), side by side as `layout` says.

    linked: the connections with the z of their bands' middles, m. connections: of the links, from
    the start.
    """

    def __init__(
        self, rng: random.Random, name: str, layout: str, connections: Sequence[str]
    ) -> None:
        unit, links = rng.choice((1e-3, INCH)), iter(connections)
        drawn = math.exp(rng.uniform(math.log(6e-3), math.log(0.1)))
        self.diameter = diameter = rounded(drawn / unit, 2) * unit
        self.classes = {"lugs", f"lugs {layout}"}
        self.linked: list[tuple[str, float]] = []
        profile: list[Tree] = []
        bands, z, widest = [], 0.0, (0.0, 0.0)
        for i, kind in enumerate(layout):
            gap = diameter * rng.choice((0.0, 0.02, 0.1, 0.5))
            z += _add(profile, gap, diameter, {}) if gap else 0.0
            width = diameter * rounded(rng.uniform(0.3, 1.5), 2)
            bands.append(next(links) if kind == "L" else f"{name} wall {i}")
            if kind == "L":
                self.linked.append((bands[-1], z + 0.5 * width))
            widest = max(widest, (width, z + 0.5 * width))
            key = "connection" if kind == "L" else "name"
            z += _add(profile, width, diameter, {key: bands[-1]})
        if rng.random() < 0.7:
            _add(profile, diameter * 0.1, diameter, {})
            _maybe_head(rng, profile, diameter, self.classes)
        bored = rng.random() < 0.3
        if bored:
            bore = length(diameter * rounded(rng.uniform(0.1, 0.6), 2))
            profile = [{**segment, "bore": bore} for segment in profile]
            self.classes.add("bored")
        couple = len(layout) == 2  # which two lugs carry by what resists their tilting
        lugs = {band: _lug(rng, diameter, couple, self.classes) for band in bands}
        self.table: Tree = {"material": "steel", "profile": profile, "lug": lugs}
        if rng.random() < 0.15 and not bored and widest[0] > 0.6 * diameter:
            across = 0.15 * diameter
            hole = {"z": length(widest[1]), "diameter": length(across),
                    "angle": angle(rng.uniform(-3.0, 3.0))}  # fmt: skip
            self.table["hole"] = [hole | aslant(f"{widest[1]} {across}", diameter, across, 0.35)]
            self.classes.add("hole in a lug")


def _maybe_head(
    rng: random.Random, profile: list[Tree], diameter: float, classes: set[str]
) -> None:
    """Add a head behind the last segment, now and then, with a fillet or a sharp corner."""
    if rng.random() < 0.3:
        profile[-1] |= {"fillet": length(0.03 * diameter)} if rng.random() < 0.7 else {}
        _add(profile, diameter * 0.3, diameter * 1.3, {"name": "head"})
        classes.add("head")


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
    elif kind == "clearance" and rng.random() < 0.3:
        lug["clearance"] = length(diameter * 0.002)
        lug["range"] = {"clearance": [length(diameter * 0.001), length(diameter * 0.004)]}
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
    if rng.random() < 0.25:
        lug["friction"] = rng.choice((0.1, 0.3))
    if rng.random() < 0.15:
        lug["range"] = lug.get("range", {}) | {"stiffness": [0.8, 1.25], "tilt": ["free", "guided"]}
    classes |= {key for key in CLASSES if key in lug}
    return lug


def _forces(rng: random.Random, seat: Seat, walls: bool) -> Tree:
    """Forces of the links in balance, unless walls hold the pin; now and then along it, too."""
    size = 10.0 ** rng.uniform(6.0, 7.5) * seat.diameter**2
    axes = 3 if rng.random() < 0.2 else 2
    pulls = [[size * rng.uniform(-1.0, 1.0) for _ in range(axes)] for _ in seat.linked]
    if axes == 3:
        seat.classes.add("axial")
    if not walls and len(pulls) == 2:
        pulls[1] = [-f for f in pulls[0]]
    elif not walls:
        (_, a), (_, b), (_, c) = seat.linked
        share = (c - b) / (c - a)  # of a beam on two supports
        pulls = [[-f * part for f in pulls[1]] for part in (share, -1.0, 1.0 - share)]
    return {n: [force(x) for x in pull] for (n, _), pull in zip(seat.linked, pulls, strict=True)}

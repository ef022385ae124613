"""Valid linkages drawn at random: four-bars and slider-cranks, their drives and cases."""

from __future__ import annotations

import cmath
import math
import random
from dataclasses import dataclass

from tests.fuzz.quantity import Csv, Quantity, Tree, angle, force, length, moment

GROUND = "ground"


@dataclass(frozen=True)
class Drawn:
    """A mechanism's table and its cases; joints: the connections by joint, and whether its pin
    floats. classes: to which it belongs.
    """

    mechanism: Tree
    cases: Tree
    joints: dict[str, tuple[tuple[str, ...], bool]]
    classes: frozenset[str]


@dataclass(frozen=True)
class Skeleton:
    """Points as complex numbers, m; links by name with their two joints; the crank first. sweep: of
    the drive from where it is drawn, rad, or lengths (m) of the guide where its piston drives.
    """

    points: dict[str, complex]
    links: dict[str, tuple[str, str]]
    sweep: float
    kind: str
    guide: tuple[complex, complex] | None = None
    pushes: bool = False

    @property
    def start(self) -> float:
        """The driven angle or length as drawn."""
        if self.pushes and self.guide is not None:
            at, way = self.guide
            return ((self.points["C"] - at) * way.conjugate()).real
        return cmath.phase(self.points["A"] - self.points["O"])

    def position(self, value: float) -> Quantity:
        """Of the drive."""
        return length(value) if self.pushes else angle(value)


def mechanism(rng: random.Random) -> Drawn:
    """A linkage with one drive and one case or several."""
    skeleton = four_bar(rng) if rng.random() < 0.5 else slider_crank(rng)
    classes = {skeleton.kind}
    joints = {name: _joint(rng, name, skeleton, classes) for name in skeleton.points}
    table: Tree = {
        "gravity": rng.choice(
            [None, [Quantity(0.0, "acceleration"), Quantity(0.0, "acceleration")]]
        ),
        "joint": joints,
        "body": {name: _body(rng, ends, skeleton) for name, ends in skeleton.links.items()},
        "drive": _drive(rng, skeleton, classes),
    }
    classes.add("gravity" if table["gravity"] is None else "no gravity")
    if skeleton.guide is not None:
        table["body"]["piston"] = {"mass": Quantity(rng.uniform(0.1, 20.0), "mass")}
        table["slider"] = {"guide": _guide(rng, skeleton, classes)}
    found = {name: (tuple(j["connections"]), "fixed_in" not in j) for name, j in joints.items()}
    return Drawn(table, _cases(rng, skeleton, classes), found, frozenset(classes))


def _placed(rng: random.Random, points: dict[str, complex]) -> dict[str, complex]:
    """Anywhere, turned and of any size."""
    size = math.exp(rng.uniform(math.log(0.05), math.log(2.0)))
    turn, shift = cmath.rect(size, rng.uniform(-math.pi, math.pi)), complex(rng.random(), -1.0)
    return {name: turn * p + shift for name, p in points.items()}


def dyad(a: complex, b: complex, ra: float, rb: float, left: bool) -> complex:
    """The point at distances ra, rb from a and b, left or right of the line from a to b."""
    d = abs(b - a)
    along = (ra**2 - rb**2 + d**2) / (2.0 * d)
    off = math.sqrt(max(ra**2 - along**2, 0.0)) * (1.0 if left else -1.0)
    return a + (along + 1j * off) * (b - a) / d


def four_bar(rng: random.Random) -> Skeleton:
    """A crank that turns right round (Grashof, with a margin), or a rocker that swings a little."""
    turns = rng.random() < 0.7
    while True:
        crank, coupler, rocker = (rng.uniform(0.2, 0.5) if turns else rng.uniform(0.5, 1.4),
                                  rng.uniform(0.6, 1.6), rng.uniform(0.6, 1.6))  # fmt: skip
        sizes = sorted((crank, coupler, rocker, 1.0))
        if turns == (sizes[0] == crank and sizes[0] + sizes[3] < 0.92 * (sizes[1] + sizes[2])):
            at = rng.uniform(-math.pi, math.pi)
            a = cmath.rect(crank, at)
            gap = abs(1.0 - a)
            if abs(coupler - rocker) * 1.1 < gap < 0.9 * (coupler + rocker):
                break
    points = {"O": 0j, "A": a, "Q": 1.0 + 0j}
    points["B"] = dyad(a, points["Q"], coupler, rocker, rng.random() < 0.5)
    sweep = (rng.choice((0.5, 2.0, 6.28)) if turns else 0.4) * rng.choice((1.0, -1.0))
    links = {"crank": ("O", "A"), "coupler": ("A", "B"), "rocker": ("Q", "B")}
    kind = "four-bar, crank" if turns else "four-bar, double rocker"
    return Skeleton(_placed(rng, points), links, sweep, kind)


def slider_crank(rng: random.Random) -> Skeleton:
    """On or off its guide's line, with a rod long enough to go right round."""
    crank, off = 1.0, rng.choice((0.0, 0.0, rng.uniform(-0.8, 0.8)))
    rod = (crank + abs(off)) * rng.uniform(1.3, 4.0)
    side, pushes = rng.choice((1.0, -1.0)), rng.random() < 0.3
    # far from the dead centres, which are within 0.25 of 0 and 0.65 of pi
    at, to = (side * rng.uniform(0.5, 2.3) for _ in range(2))
    a, b = (cmath.rect(crank, x) for x in (at, to))
    c, d = (complex(p.real + math.sqrt(rod**2 - (p.imag - off) ** 2), off) for p in (a, b))
    points = _placed(rng, {"O": 0j, "A": a, "C": c, "guide": complex(0.0, off), "way": 1 + 0j})
    guide, way = points.pop("guide"), points.pop("way") - points["O"]
    sweep = rng.choice((0.3, 2.0, 6.28)) * rng.choice((1.0, -1.0))
    if pushes:
        sweep = (d - c).real * abs(points["A"] - points["O"])
    links = {"crank": ("O", "A"), "rod": ("A", "C")}
    kind = "slider-crank, pushed" if pushes else "slider-crank, turned"
    return Skeleton(points, links, sweep, kind, (guide, way / abs(way)), pushes)


def _joint(rng: random.Random, name: str, skeleton: Skeleton, classes: set[str]) -> Tree:
    """A pin that is part of the ground or of a link, or floats."""
    on = [link for link, ends in skeleton.links.items() if name in ends]
    on.append("piston" if name == "C" else GROUND if name in ("O", "Q") else "")
    on = [body for body in on if body]
    table: Tree = {"at": point(skeleton.points[name])}
    carrier = rng.choice(on) if rng.random() < 0.75 else None
    if carrier is None:
        classes.add("floating pin")
    else:
        table["fixed_in"] = carrier
        if rng.random() < 0.15:
            classes.add("friction in pins")
            size = abs(skeleton.points["A"] - skeleton.points["O"])
            table |= {"friction": rng.uniform(0.02, 0.2), "diameter": length(0.05 * size)}
    table["connections"] = {f"{name}{i}": body for i, body in enumerate(on) if body != carrier}
    return table


def point(at: complex) -> list[Quantity]:
    """[x, y]."""
    return [length(at.real), length(at.imag)]


def _body(rng: random.Random, ends: tuple[str, str], skeleton: Skeleton) -> Tree:
    a, b = (skeleton.points[j] for j in ends)
    size = abs(b - a)
    if rng.random() < 0.5:
        bar: Tree = {"joints": list(ends), "density": Quantity(7850.0, "density")}
        if rng.random() < 0.5:
            bar["diameter"] = length(size * rng.uniform(0.02, 0.2))
        else:
            bar["section"] = [length(size * rng.uniform(0.02, 0.2)) for _ in range(2)]
        return {"bar": bar}
    mass = rng.uniform(0.1, 50.0)
    body: Tree = {
        "mass": Quantity(mass, "mass"),
        "inertia": Quantity(mass * size**2 * rng.uniform(0.05, 0.3), "inertia"),
    }
    if rng.random() < 0.5:
        body["centre"] = point(a + (b - a) * complex(rng.random(), 0.3 * rng.random()))
    return body


def _guide(rng: random.Random, skeleton: Skeleton, classes: set[str]) -> Tree:
    assert skeleton.guide is not None
    at, way = skeleton.guide
    table: Tree = {
        "bodies": [GROUND, "piston"],
        "joints": [point(at), "C"],
        "direction": [way.real, way.imag],
    }
    if rng.random() < 0.4:
        classes.add("friction")
        table["friction"] = rng.uniform(0.02, 0.2)
    return table


def _drive(rng: random.Random, skeleton: Skeleton, classes: set[str]) -> Tree:
    """From where it is drawn."""
    start = skeleton.start
    law = rng.choice(("cosine", "cycloidal", "constant", "table"))
    classes.add(f"law {law}")
    drive: Tree = {"body": "crank", "line": ["O", "A"]}
    drive = ({"slider": "guide"} if skeleton.pushes else drive) | {"law": law}
    end, duration = start + skeleton.sweep, rng.choice((0.1, 1.0, 4.0))
    if law != "table":
        lasts = Quantity(duration, "time")
        course = {"start": skeleton.position(start), "end": skeleton.position(end)}
        return drive | course | {"duration": lasts}
    rows = []
    for i in range(9):
        x = i / 8.0
        at = start + (end - start) * x * x * (3.0 - 2.0 * x)
        row = {"position": length(at)} if skeleton.pushes else {"position_deg": math.degrees(at)}
        rows.append({"time": Quantity(duration * x, "time")} | row)
    return drive | {"table": Csv("drive.csv", tuple(rows))}


def _cases(rng: random.Random, skeleton: Skeleton, classes: set[str]) -> Tree:
    found: Tree = {}
    for kind in rng.sample(("motion", "static", "instant"), rng.choice((1, 1, 2))):
        classes.add(kind)
        case: Tree = {"kind": kind, "distribution": rng.choice(("uniform", "cosine"))}
        if kind == "motion":
            case["samples"] = rng.choice((5, 12, 25))
        else:
            at = skeleton.start + rng.uniform(0.0, 1.0) * skeleton.sweep
            case["position"] = skeleton.position(at)
        if kind == "instant":
            angular = "" if skeleton.pushes else "angular "
            case["velocity"] = Quantity(rng.uniform(-20.0, 20.0), f"{angular}velocity")
            case["acceleration"] = Quantity(rng.uniform(-50.0, 50.0), f"{angular}acceleration")
        case["apply"] = [_load(rng, skeleton, classes) for _ in range(rng.choice((1, 1, 2)))]
        found[kind] = case
    return found


def _load(rng: random.Random, skeleton: Skeleton, classes: set[str]) -> Tree:
    """On a body that the drive moves, so that every joint has something to carry."""
    last = [*skeleton.links][-1]
    body = "piston" if skeleton.guide is not None and rng.random() < 0.5 else last
    load: Tree = {"body": body, "force": [force(rng.uniform(-5e3, 5e3)) for _ in range(2)]}
    if body != "piston" and rng.random() < 0.3:
        load["couple"] = moment(rng.uniform(-50.0, 50.0))
    if rng.random() < 0.3:
        load["follows"] = True
    if rng.random() < 0.15:
        classes.add("side force")
        load["force"].append(force(rng.uniform(-1e3, 1e3)))
    return load

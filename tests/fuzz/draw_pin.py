"""Valid pins drawn at random: profiles, materials, what holds them, and stated loads on them."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from tests.fuzz.quantity import INCH, Csv, Quantity, Tree, force, length, moment

MATERIALS: Tree = {
    "steel": {
        "youngs_modulus": Quantity(210e9, "stress"),
        "poisson_ratio": 0.3,
        "density": Quantity(7850.0, "density"),
        "yield_strength": Quantity(600e6, "stress"),
    },
    "rubber": {"youngs_modulus": Quantity(5e6, "stress"), "poisson_ratio": 0.47},
    "cork": {"youngs_modulus": Quantity(30e6, "stress"), "poisson_ratio": 0.0},
}


@dataclass(frozen=True)
class Cylinder:
    """A segment, m. band: whether a link bears on it."""

    length: float
    diameter: float
    bore: float = 0.0
    fillet: float = 0.0
    band: bool = False


@dataclass(frozen=True)
class Shape:
    """A profile, and the classes of shapes to which it belongs."""

    segments: tuple[Cylinder, ...]
    classes: frozenset[str]


def rounded(value: float, digits: int = 3) -> float:
    """To so many digits of mm, or of in, whichever was meant."""
    return float(f"{value:.{digits}g}")


def profile(rng: random.Random, bands: int) -> Shape:
    """Segments, of which `bands` carry links: at least as many, at most eight."""
    unit = rng.choice((1e-3, INCH))
    most = max(bands, rng.choice((1, 1, 2, 2, 3, 3, 4, 5, 6, 8)))
    classes = {"1 segment" if most == 1 else "2 to 4 segments" if most < 5 else "5 to 8 segments"}
    base = rounded(math.exp(rng.uniform(math.log(3e-3), math.log(0.2))) / unit, 2)
    diameters = [base]
    while len(diameters) < most:
        diameters.append(_next(rng, base, diameters[-1], classes))
    lengths = _lengths(rng, diameters, classes)
    bores = _bores(rng, diameters, classes)
    segments = [
        Cylinder(a * unit, b * unit, c * unit)
        for a, b, c in zip(lengths, diameters, bores, strict=True)
    ]
    segments = _filleted(rng, segments, unit, classes)
    for i in rng.sample(range(most), bands):
        segments[i] = replace(segments[i], band=True)
    return Shape(tuple(segments), frozenset(classes))


def _next(rng: random.Random, base: float, last: float, classes: set[str]) -> float:
    """The next diameter: the same again, a little off, or another."""
    kind = rng.random()
    if kind < 0.3:
        classes.add("equal neighbours")
        return last
    if kind < 0.42:
        classes.add("tiny step")
        return rounded(last * (1.0 + rng.choice((-1.0, 1.0)) * rng.uniform(0.002, 0.02)), 5)
    return rounded(base * math.exp(rng.uniform(math.log(0.5), math.log(2.5))), 2)


def _lengths(rng: random.Random, diameters: list[float], classes: set[str]) -> list[float]:
    kind, least, most = rng.choice(
        (("stubby", 0.3, 1.0), ("ordinary", 1.0, 8.0), ("ordinary", 1.0, 8.0), ("slender", 15, 50))
    )
    classes.add(kind)
    whole = min(diameters) * math.exp(rng.uniform(math.log(least), math.log(most)))
    shares = [rng.uniform(0.3, 1.0) for _ in diameters]
    return [rounded(whole * share / sum(shares)) for share in shares]


def _bores(rng: random.Random, diameters: list[float], classes: set[str]) -> list[float]:
    kind = rng.random()
    if kind < 0.6:
        return [0.0] * len(diameters)
    classes.add("bored")
    if kind < 0.85:
        return [rounded(min(diameters) * rng.uniform(0.05, 0.85), 2)] * len(diameters)
    bores = []
    for i in range(len(diameters)):
        least = min(diameters[max(0, i - 1) : i + 2])
        bores.append(rng.choice((0.0, rounded(least * rng.uniform(0.1, 0.8), 2))))
    return bores


def _filleted(
    rng: random.Random, segments: list[Cylinder], unit: float, classes: set[str]
) -> list[Cylinder]:
    """Fillets as the shoulders and the thinner shafts have room for them."""
    out, kind = list(segments), rng.random()
    for i, (a, b) in enumerate(pairwise(segments)):
        step = 0.5 * abs(a.diameter - b.diameter)
        if step < 1e-9:
            continue
        if kind < 0.35 or (kind < 0.55 and rng.random() < 0.5):
            classes.add("sharp step")
            continue
        classes.add("fillet")
        room = min(step, 0.35 * min((a, b), key=lambda s: s.diameter).length)
        radius = room / unit * rng.choice((rng.uniform(0.1, 0.95), rng.uniform(0.5, 0.95)))
        out[i] = replace(a, fillet=float(f"{radius:.2g}") * 0.99 * unit)
    return out


def clamps(rng: random.Random, shape: Shape) -> list[str]:
    """What may hold a pin so that a load on a band remains; nothing for a pin in balance."""
    bands = sum(s.band for s in shape.segments)
    ways = [["start"], ["end"], ["start", "end"]]
    free = [f"plain{i}" for i, s in enumerate(shape.segments) if not s.band]
    ways += [[name] for name in free[:2]] + ([[]] * 2 if bands > 1 else [])
    if bands > 1:
        ways.append([next(f"{i}" for i, s in enumerate(shape.segments) if s.band)])
    return rng.choice(ways)


def table(shape: Shape, clamp: list[str], connections: list[str], material: str = "steel") -> Tree:
    """The pin's table; connections: of its bands from the start."""
    names, made = iter(connections), []
    for i, s in enumerate(shape.segments):
        segment: Tree = {"length": length(s.length), "diameter": length(s.diameter)}
        if s.bore:
            segment["bore"] = length(s.bore)
        if s.fillet:
            segment["fillet"] = length(s.fillet)
        if s.band:
            segment["connection"] = next(names)
        else:
            segment["name"] = f"plain{i}"
        made.append(segment)
    index = {f"{i}": s.get("connection") for i, s in enumerate(made)}
    return {"material": material, "clamp": [index.get(c) or c for c in clamp], "profile": made}


def given(rng: random.Random, pins: Tree, name: str) -> tuple[Tree, set[str]]:
    """A case of stated forces on all the pins."""
    steps = rng.choice((0, 0, 0, 1, 2, 5, 8))  # 0: no table, 1: a table without time
    classes = {"forces in the study" if steps == 0 else "table" if steps == 1 else "sweep"}
    distribution = rng.choice(("uniform", "cosine"))
    axial = rng.random() < 0.4
    couples = rng.random() < 0.2 and all(pin["clamp"] for pin in pins.values())
    classes |= {distribution} | ({"moments"} if couples else set())
    course = [instant(rng, pins, axial, couples) for _ in range(max(steps, 1))]
    case: Tree = {"kind": "given", "distribution": distribution}
    if steps == 0:
        case |= {key: part for key, part in course[0].items() if part}
        return case, classes
    rows = []
    for i, now in enumerate(course):
        for connection, f in now["forces"].items():
            row: Tree = {"connection": connection}
            row |= dict(zip(("fx", "fy", "fz"), f, strict=False))
            if now["moments"]:
                m = now["moments"].get(connection, [moment(0.0)] * 3)
                row |= dict(zip(("mx", "my", "mz"), m, strict=True))
            if steps > 1:
                row["time"] = Quantity(0.25 * i, "time")
            rows.append(row)
    return case | {"table": Csv(f"{name}.csv", tuple(rows))}, classes


def instant(rng: random.Random, pins: Tree, axial: bool, couples: bool) -> dict[str, Any]:
    """Forces and moments by connection; of a pin that nothing holds in balance."""
    forces: dict[str, list[Quantity]] = {}
    moments: dict[str, list[Quantity]] = {}
    for pin in pins.values():
        thin = min(s["diameter"].value for s in pin["profile"])
        size = 10.0 ** rng.uniform(4.0, 7.0) * thin**2
        bands = [s["connection"] for s in pin["profile"] if "connection" in s]
        drawn = [[size * rng.uniform(-1.0, 1.0) for _ in range(2 + axial)] for _ in bands]
        if not pin["clamp"]:
            drawn[-1] = [-sum(f[k] for f in drawn[:-1]) for k in range(2 + axial)]
        forces |= {c: [force(x) for x in f] for c, f in zip(bands, drawn, strict=True)}
        if couples:
            moments |= {
                c: [moment(size * thin * rng.uniform(-1.0, 1.0)) for _ in range(3)] for c in bands
            }
        if not pin["clamp"]:  # the last band takes the couple that the forces leave over
            z = _middles(pin)
            mx = sum(at * f[1] for at, f in zip(z, drawn, strict=True))
            my = -sum(at * f[0] for at, f in zip(z, drawn, strict=True))
            moments |= {c: [moment(0.0)] * 3 for c in bands[:-1]}
            moments[bands[-1]] = [moment(mx), moment(my), moment(0.0)]
    return {"forces": forces, "moments": moments}


def _middles(pin: Tree) -> list[float]:
    """z of its bands' middles, m."""
    z, out = 0.0, []
    for s in pin["profile"]:
        if "connection" in s:
            out.append(z + s["length"].value / 2.0)
        z += s["length"].value
    return out

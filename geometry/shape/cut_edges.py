"""Edges of cuts in a drawing, the view of a pin from y, with x upwards and z to the right.

Edges on the side of y are visible; edges inside or behind the pin are hidden. Notches are the
rectangles that cuts remove from the pin's silhouette, or from its section with the plane y = 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from geometry.shape.features import Cut, outer_radius, radii
from geometry.shape.hole import Hole
from geometry.shape.milled import Flat, Slot
from geometry.shape.passage import Passage
from geometry.shape.pin import Pin
from geometry.shape.recess import Recess
from pinbase.arrays import Floats

CIRCLE_ANGLES = np.linspace(0.0, 2.0 * np.pi, 73)
UPRIGHT_TOLERANCE = 1e-3  # rad: a cut milled from a direction this close to x is seen from its side
FRONT_TOLERANCE = 1e-9  # of the pin's radius: points up to this far behind y = 0 count as in front


@dataclass(frozen=True)
class DrawnCut:
    """The edges of a cut in a drawing.

    lines: points (P, 2), z and x in m, of each line, and whether the line is hidden.
    notches: z and x of two opposite corners of each rectangle, the second on the silhouette, m; the
    edges of the rectangles are among the lines.
    """

    lines: tuple[tuple[Floats, bool], ...]
    notches: tuple[tuple[float, float, float, float], ...] = ()


def drawn(cut: Cut, pin: Pin) -> DrawnCut:
    """The edges of a cut in a profile."""
    if isinstance(cut, Hole):
        return DrawnCut(tuple(_hole(cut, pin)))
    if isinstance(cut, Passage):
        return DrawnCut(tuple(_passage(cut, pin)))
    if isinstance(cut, Recess):
        return DrawnCut(tuple(_recess(cut)))
    assert isinstance(cut, Flat | Slot)
    z0, z1 = max(cut.z0, 0.0), min(cut.z1, pin.length)
    return _flat(cut, pin, z0, z1) if isinstance(cut, Flat) else _slot(cut, pin, z0, z1)


def _bore(pin: Pin, z: float) -> float:
    """Radius of the bore at z, m; 0 beyond the pin."""
    return pin.radii(z)[0] if 0.0 <= z <= pin.length else 0.0


def _placed(angle: float, u: Floats, aside: Floats, z: Floats) -> Floats:
    """Points (P, 3), m, in a frame that is rotated about the pin's axis.

    angle: direction of u, rad from x. u, aside: distances along and across this direction, m.
    """
    c, s = math.cos(angle), math.sin(angle)
    u, aside, z = np.broadcast_arrays(u, aside, z)
    return np.stack([c * u - s * aside, s * u + c * aside, z], axis=1)


def _seen(points: Floats) -> list[tuple[Floats, bool]]:
    """The visible and hidden parts of a line on the outside of a pin. points: (P, 3)."""
    front = points[:, 1] >= -FRONT_TOLERANCE * np.abs(points[:, :2]).max()
    changes = np.flatnonzero(front[1:] != front[:-1]) + 1
    out = []
    for rows in np.split(np.arange(len(points)), changes):
        if rows[0] > 0:  # neighbouring parts share an end point
            rows = np.concatenate([[rows[0] - 1], rows])
        out.append((_flat_view(points[rows]), not bool(front[rows[-1]])))
    return [(x, hidden) for x, hidden in out if len(x) > 1]


def _flat_view(points: Floats) -> Floats:
    """Points (P, 2), z and x, of points (P, 3)."""
    return np.asarray(points[:, [2, 0]])


def _inside(points: Floats) -> list[tuple[Floats, bool]]:
    """A hidden line inside a pin, or none where it appears as a point. points: (P, 3)."""
    x = _flat_view(points)
    return [(x, True)] if np.ptp(x, axis=0).max() > 1e-6 * np.abs(points).max() else []


def _mouth(hole: Hole, a: float, r: float, side: float) -> Floats:
    """The mouth of a hole, with radius a, on a cylinder of radius r, (P, 3). side: 1 or -1."""
    aside = hole.offset + a * np.cos(CIRCLE_ANGLES)
    u = side * np.sqrt(np.maximum(r**2 - aside**2, 0.0))
    return _placed(hole.angle, u, aside, hole.z + _along(hole, u, a * np.sin(CIRCLE_ANGLES)))


def _along(hole: Hole, u: Floats, up: Floats) -> Floats:
    """The z relative to a hole's z, of points at u from the pin's axis and `up` from the hole's."""
    return np.asarray(u * math.tan(hole.tilt) + up / math.cos(hole.tilt))


def _hole(hole: Hole, pin: Pin) -> list[tuple[Floats, bool]]:
    """The edges of a hole across the pin: mouths, walls and bottom."""
    r, a, out = outer_radius(pin, hole.z), hole.diameter / 2.0, []
    bore, wide = _bore(pin, hole.z), hole.chamfer + hole.mouth_radius
    sides = (1.0, -1.0) if hole.depth is None else (1.0,)
    floor = bore if hole.depth is None else max(r - hole.depth, -r)
    low = floor if hole.depth is None or floor > bore else bore
    for side in sides:
        for radius in dict.fromkeys((a, a + wide)):
            out += _seen(_mouth(hole, min(radius, r), r, side))
        for direction in (-1.0, 1.0):
            walls = [(a, low, r - wide), (a + wide, r - wide, r)] if wide else [(a, low, r)]
            line = [(w, u) for w, first, last in walls for u in (first, last)]
            w, u = np.array(line).T
            z = hole.z + _along(hole, side * u, direction * w)
            out += _inside(_placed(hole.angle, side * u, np.full(len(u), hole.offset), z))
    if hole.depth is not None and floor <= -bore and bore:  # through the bore into the other wall
        ends = np.array([-bore, floor])
        for direction in (-1.0, 1.0):
            out += _inside(
                _placed(hole.angle, ends, np.zeros(2), np.full(2, hole.z + direction * a))
            )
    if hole.depth is not None and not -bore < floor < bore:
        tip = floor - hole.bottom.height(hole.diameter)
        out += _bottom(hole.angle, hole.z, a, floor, tip)
    return out


def _bottom(
    angle: float, z: float, a: float, floor: float, tip: float
) -> list[tuple[Floats, bool]]:
    """The bottom of a blind hole across the pin: its edge, and the cone below it."""
    edge = _placed(
        angle,
        np.full(len(CIRCLE_ANGLES), floor),
        a * np.cos(CIRCLE_ANGLES),
        z + a * np.sin(CIRCLE_ANGLES),
    )
    cone = _placed(angle, np.array([floor, tip, floor]), np.zeros(3), z + a * np.array([-1, 0, 1]))
    return _inside(edge) + (_inside(cone) if tip < floor else [])


def _passage(passage: Passage, pin: Pin) -> list[tuple[Floats, bool]]:
    """The edges of a hole along the pin: its walls and bottom."""
    x, a = passage.offset * math.cos(passage.angle), passage.diameter / 2.0
    z0, z1 = max(passage.z0, 0.0), min(passage.z1, pin.length)
    out = [(np.array([[z0, x + w], [z1, x + w]]), True) for w in (-a, a)]
    if passage.mouth != "both":
        at = z1 if passage.mouth == "start" else z0
        tip = passage.extent[1] if passage.mouth == "start" else passage.extent[0]
        out.append((np.array([[at, x - a], [at, x + a]]), True))
        if tip != at:
            out.append((np.array([[at, x - a], [tip, x], [at, x + a]]), True))
    return out


def _recess(recess: Recess) -> list[tuple[Floats, bool]]:
    """The edges of a recess: its mouth, and its inner edges."""
    mouth = [part for line in recess.lines(recess.solid.mouth) for part in _seen(line)]
    return mouth + [part for line in recess.lines(recess.solid.inner) for part in _inside(line)]


def _steps(pin: Pin, z0: float, z1: float) -> list[tuple[float, float, float]]:
    """Parts of a pin between two z, as (z, z, outer radius) in m; a cone has its largest radius."""
    marks = [z0, *(z for z in pin.stations if z0 < z < z1), z1]
    return [(a, b, radii(pin, a, b)[1]) for a, b in pairwise(marks)]


def _flat(flat: Flat, pin: Pin, z0: float, z1: float) -> DrawnCut:
    """The edges of a flat between z0 and z1."""
    lines: list[tuple[Floats, bool]] = []
    notches = []
    cut = [(a, b, r) for a, b, r in _steps(pin, z0, z1) if r > flat.distance]
    for a, b, r in cut:
        half = math.sqrt(r**2 - flat.distance**2)
        for side in (-half, half):
            ends = _placed(
                flat.angle, np.full(2, flat.distance), np.full(2, side), np.array([a, b])
            )
            lines += _seen(ends)
        for top in (1.0, -1.0):
            if top * math.cos(flat.angle) * r > flat.distance:
                corners = _placed(flat.angle, np.full(2, flat.distance),
                                  np.array([-half, half]), np.full(2, a))[:, 0]  # fmt: skip
                low = float(top * (top * corners).max())
                notches.append((a, low, b, top * r))
                lines += _notch(pin, a, low, b, top * r, a > z0, b < z1)
    for z, r in _rims([(a, r) for a, _, r in cut], [(b, r) for _, b, r in cut], z0, z1, pin.length):
        half = math.sqrt(r**2 - flat.distance**2)
        aside = np.linspace(-half, half, 49)
        lines += _seen(_placed(flat.angle, np.sqrt(r**2 - aside**2), aside, np.full(49, z)))
        lines += _seen(_placed(flat.angle, np.full(49, flat.distance), aside, np.full(49, z)))
    if abs(math.sin(flat.angle)) < UPRIGHT_TOLERANCE:  # edges behind coincide with those in front
        lines = [(x, hidden) for x, hidden in lines if not hidden]
    return DrawnCut(tuple(lines), tuple(notches))


def _notch(
    pin: Pin, z0: float, low: float, z1: float, high: float, on: bool = False, goes_on: bool = False
) -> list[tuple[Floats, bool]]:
    """The edges of a notch: its bottom, and its ends within the pin.

    on, goes_on: whether the cut continues before z0 and beyond z1.
    """
    out = [(np.array([[z0, low], [z1, low]]), False)]
    ends = ((z0, not on and z0 > 0.0), (z1, not goes_on and z1 < pin.length))
    return out + [(np.array([[z, low], [z, high]]), False) for z, is_end in ends if is_end]


def _rims(
    first: Sequence[tuple[float, float]], last: Sequence[tuple[float, float]],
    z0: float, z1: float, length: float,
) -> list[tuple[float, float]]:  # fmt: skip
    """Positions z and radii at which a cut ends before the pin does, m."""
    ends = [(z, r) for z, r in first if z == z0 and z > 0.0]
    return ends + [(z, r) for z, r in last if z == z1 and z < length]


def _slot(slot: Slot, pin: Pin, z0: float, z1: float) -> DrawnCut:
    """The edges of a slot between z0 and z1."""
    r = radii(pin, z0, z1)[1]
    floor = slot.floor(pin)
    through = slot.depth is None
    lines: list[tuple[Floats, bool]] = []
    aside, z = _plan(slot, z0, z1)
    for side in (1.0, -1.0) if through else (1.0,):
        u = side * np.sqrt(np.maximum(r**2 - aside**2, 0.0))
        lines += _seen(_placed(slot.angle, u, aside, z))
    bore = _bore(pin, 0.5 * (z0 + z1))
    if not through and abs(math.sin(slot.angle)) < UPRIGHT_TOLERANCE:
        up = math.copysign(1.0, math.cos(slot.angle))
        notch = z0, up * max(floor, bore), z1, up * r
        edges = [(x, False) for x, hidden in lines if not hidden] + _notch(pin, *notch)
        return DrawnCut(tuple(edges), (notch,))
    if not through:
        lines += _inside(_placed(slot.angle, np.full(len(z), max(floor, bore)), aside, z))
    for side in (1.0, -1.0) if through else (1.0,):
        low = bore if through else max(floor, bore)
        for end in (z0, z1):
            if 0.0 < end < pin.length:
                u = side * np.array([low, r])
                lines += _inside(_placed(slot.angle, u, np.zeros(2), np.full(2, end)))
    return DrawnCut(tuple(lines))


def _plan(slot: Slot, z0: float, z1: float) -> tuple[Floats, Floats]:
    """The outline of a slot in plan: distance aside and z of its points, (P,) m each."""
    half = slot.width / 2.0
    if not slot.round_ends:
        side = np.linspace(-half, half, 25)
        aside = np.concatenate([side, side[::-1], side[:1]])
        return aside, np.concatenate([np.full(25, z1), np.full(25, z0), [z1]])
    turn = np.linspace(0.0, math.pi, 37)
    high = half * np.cos(turn), slot.z1 - half + half * np.sin(turn)
    low = -half * np.cos(turn), slot.z0 + half - half * np.sin(turn)
    aside, z = (np.concatenate([a, b, a[:1]]) for a, b in zip(high, low, strict=True))
    return aside, np.clip(z, z0, z1)

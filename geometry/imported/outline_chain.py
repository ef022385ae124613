"""The outlines of a section by corners and radii, from the sides recognised face by face."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from geometry.imported.sampled_face import FACE_TOLERANCE, SampledFace
from geometry.shape.polygon import RZ, cross
from geometry.shape.polyline import Bend
from pinbase.arrays import Floats

QUARTER_TURN = math.pi / 2.0 * (1.0 + 1e-9)


@dataclass(frozen=True)
class MeridianSide:
    """A straight or circular part of the outline.

    start, end: positions (r, z).
    centre: centre of a circular part; None for a straight part.
    turn: angle by which a circular part turns to the left from start to end, rad.
    name: name of the face.
    """

    start: RZ
    end: RZ
    centre: RZ | None = None
    turn: float = 0.0
    name: str = ""

    @staticmethod
    def of(face: SampledFace, to_axis: bool, size: float) -> MeridianSide | None:
        """The side of a face of revolution about the z-axis; None if not straight or circular.

        to_axis: whether a plane face reaches the axis.
        size: size of the body.
        """
        r, z = np.hypot(face.points[:, 0], face.points[:, 1]), face.points[:, 2]
        out = np.sum(face.points[:, :2] * face.normals[:, :2], axis=1)
        normals = np.stack([out / np.maximum(r, FACE_TOLERANCE * size), face.normals[:, 2]], axis=1)
        off_axis = r > 1e-3 * size * FACE_TOLERANCE
        rz, normals = np.stack([r, z], axis=1)[off_axis], normals[off_axis]
        rim = np.stack([np.hypot(face.rim[:, 0], face.rim[:, 1]), face.rim[:, 2]], axis=1)
        if np.ptp(normals, axis=0).max() < 10.0 * FACE_TOLERANCE:
            return _straight(face, rz, rim, normals[0], to_axis)
        return _circular(np.vstack([np.stack([r, z], axis=1), rim]), rz, normals, size, face.name)

    @property
    def cylinder(self) -> bool:
        """Whether the side is parallel to the axis."""
        (r0, z0), (r1, z1) = self.start, self.end
        return self.centre is None and abs(r1 - r0) <= FACE_TOLERANCE * abs(z1 - z0)

    def passes(self, at: RZ, near: float) -> bool:
        """Whether the side is perpendicular to the axis and passes through a point off its ends."""
        (r0, z0), (r1, z1) = sorted((self.start, self.end))
        level = self.centre is None and max(abs(z0 - z1), abs(z0 - at[1])) <= near
        return level and r0 + near < at[0] < r1 - near

    @property
    def radius(self) -> float:
        """Radius of a circular side; 0 for a straight one."""
        return math.dist(self.start, self.centre) if self.centre else 0.0

    def reversed(self) -> MeridianSide:
        """The same side from its end to its start."""
        return replace(self, start=self.end, end=self.start, turn=-self.turn)

    def quarters(self) -> Iterator[MeridianSide]:
        """The same side in parts that turn by at most a right angle."""
        if self.centre is None:
            yield self
            return
        count = math.ceil(abs(self.turn) / QUARTER_TURN)
        at = [self.start]
        for k in range(1, count):
            at.append(_rotated(self.centre, self.start, self.turn * k / count))
        for a, b in zip(at, [*at[1:], self.end], strict=True):
            yield replace(self, start=a, end=b, turn=self.turn / count)

    def tangent(self) -> RZ:
        """Unit tangent at the start of the side."""
        if self.centre is None:
            length = math.dist(self.start, self.end)
            return (self.end[0] - self.start[0]) / length, (self.end[1] - self.start[1]) / length
        side = math.copysign(1.0 / self.radius, self.turn)
        r, z = self.start[0] - self.centre[0], self.start[1] - self.centre[1]
        return -side * z, side * r


def _straight(
    face: SampledFace, rz: Floats, rim: Floats, normal: Floats, to_axis: bool
) -> MeridianSide:
    """A straight side through points rz and rim (P, 2) with a normal (2,).

    to_axis: whether a plane face reaches the axis.
    """
    points = rim if face.plane else np.vstack([rz, rim])
    along = np.array([-normal[1], normal[0]])
    at = points @ along
    low, high = points[int(at.argmin())], points[int(at.argmax())]
    if face.plane and to_axis:
        outer = max(_pair(low), _pair(high))
        return MeridianSide((0.0, outer[1]), outer, None, 0.0, face.name)
    return MeridianSide(_pair(low), _pair(high), None, 0.0, face.name)


def _circular(
    points: Floats, rz: Floats, normals: Floats, size: float, name: str
) -> MeridianSide | None:
    """A circular side through points, or None, by least squares p = c + rho n.

    points: (P, 2) points that the side covers.
    rz, normals: (Q, 2) points and normals to which the circle is fitted.
    """
    count = len(rz)
    rows = np.zeros((2 * count, 3))
    rows[:count, 0], rows[count:, 1] = 1.0, 1.0
    rows[:, 2] = normals.T.ravel()
    solution, *_ = np.linalg.lstsq(rows, rz.T.ravel(), rcond=None)
    if np.abs(rows @ solution - rz.T.ravel()).max() > 10.0 * FACE_TOLERANCE * size:
        return None
    centre = solution[:2]
    arm = points - centre
    middle = (rz - centre).mean(axis=0)
    angle = np.arctan2(middle[0] * arm[:, 1] - middle[1] * arm[:, 0], arm @ middle)
    low, high = int(angle.argmin()), int(angle.argmax())
    turn = float(angle[high] - angle[low])
    start, end = _pair(points[low]), _pair(points[high])
    return MeridianSide(start, end, (float(centre[0]), float(centre[1])), turn, name)


def _pair(point: Floats) -> RZ:
    return float(point[0]), float(point[1])


def _rotated(centre: RZ, at: RZ, angle: float) -> RZ:
    """A point rotated about a centre."""
    c, s = math.cos(angle), math.sin(angle)
    r, z = at[0] - centre[0], at[1] - centre[1]
    return centre[0] + c * r - s * z, centre[1] + s * r + c * z


def outlines(sides: Sequence[MeridianSide], near: float) -> tuple[list[Bend], list[Bend]]:
    """Corners of the outer surface and of the bore (empty for a solid body), in order of z.

    near: distance within which two points coincide.

    Raises: ValueError where the sides do not form one outline.
    """
    # The outer surface runs between the outermost points of both end faces.
    chain = _chain(_connected(_without_overhang(sides, near), near))
    places = [chain[0].start, *(side.end for side in chain)]
    low, high = min(z for _, z in places), max(z for _, z in places)
    first = max((p for p in places if p[1] - low <= near), key=lambda p: p[0])
    last = max((p for p in places if high - p[1] <= near), key=lambda p: p[0])
    i, j = places.index(first), places.index(last)
    if i > j:
        chain = [side.reversed() for side in reversed(chain)]
        count = len(places) - 1
        i, j = count - i, count - j
    # In a closed chain the pin has a through bore, which is the route between the two points that
    # encloses the smaller area.
    if chain[0].start == chain[-1].end:
        routes = [chain[i:j], _reversed([*chain[j:], *chain[:i]])]
        core, shaft = sorted(routes, key=_area_below)
        return _bends(shaft, near), _bends(_without_end_faces(core, low, high, near), near)
    before, after = _reversed(chain[:i]), _reversed(chain[j:])
    return _bends(chain[i:j], near), _blind(before, after, low, high, near)


def _without_overhang(sides: Sequence[MeridianSide], near: float) -> list[MeridianSide]:
    """The sides, with plane faces trimmed to the ends of other sides.

    Next to a flat on a thinner part, the face of the shoulder extends farther in; next to a keyway
    in a bore, a face extends farther out.
    """

    def shared(at: RZ, among: Iterable[RZ]) -> bool:
        return any(math.dist(at, other) <= 10.0 * near for other in among)

    out = []
    for side in sides:
        ends = [p for other in sides if other is not side for p in (other.start, other.end)]
        between = [p for p in ends if side.passes(p, 10.0 * near)]
        start, end = (
            min(between, key=lambda p: math.dist(p, at), default=at)
            if at[0] > near and not shared(at, ends)
            else at
            for at in (side.start, side.end)
        )
        out.append(replace(side, start=start, end=end))
    return out


def _reversed(sides: Sequence[MeridianSide]) -> list[MeridianSide]:
    """A chain of sides in the other direction."""
    return [side.reversed() for side in reversed(sides)]


def _area_below(sides: Sequence[MeridianSide]) -> float:
    """Approximate area between the axis and a chain of sides, times 2."""
    return sum((s.start[0] + s.end[0]) * (s.end[1] - s.start[1]) for s in sides)


def _connected(sides: Sequence[MeridianSide], near: float) -> list[MeridianSide]:
    """The sides without duplicates and dead ends, with exactly equal ends where they meet."""
    places: list[RZ] = []

    def place(at: RZ) -> RZ:
        for known in places:
            if math.dist(known, at) <= 10.0 * near:
                return known
        at = (0.0 if at[0] <= near else at[0], at[1])
        places.append(at)
        return at

    unique: list[MeridianSide] = []
    for side in sides:
        start, end = place(side.start), place(side.end)
        if start == end and abs(side.turn) < math.pi:
            continue
        joined = replace(side, start=start, end=end)
        if not any(_same(joined, other, near) for other in unique):
            unique.append(joined)
    # Drop sides with an end at which no other side begins (unless on the axis), until none is left.
    while True:
        ends = [p for s in unique for p in (s.start, s.end)]
        leading = [
            s for s in unique if all(p[0] == 0.0 or ends.count(p) > 1 for p in (s.start, s.end))
        ]
        if len(leading) == len(unique):
            return unique
        unique = leading


def _same(a: MeridianSide, b: MeridianSide, near: float) -> bool:
    """Whether two sides are the same, in either direction."""
    if {a.start, a.end} != {b.start, b.end}:
        return False
    if a.centre is None or b.centre is None:
        return a.centre is b.centre
    return (
        math.dist(a.centre, b.centre) <= 100.0 * near
        and abs(abs(a.turn) - abs(b.turn)) < FACE_TOLERANCE
    )


def _chain(sides: list[MeridianSide]) -> list[MeridianSide]:
    """The sides in order, from axis to axis or around a closed outline.

    Raises: ValueError where they do not form one chain.
    """
    if not sides:
        raise ValueError("its faces of revolution form no outline")
    starts = [s for s in sides if s.start[0] == 0.0 or s.end[0] == 0.0]
    first = starts[0] if starts else sides[0]
    chain = [first if not starts or first.start[0] == 0.0 else first.reversed()]
    remaining = [s for s in sides if s is not first]
    while remaining and chain[-1].end[0] != 0.0:
        at = chain[-1].end
        following = [s for s in remaining if at in (s.start, s.end)]
        if len(following) > 1:
            raise ValueError("more than two of its faces of revolution meet in a circle")
        if not following:
            break
        remaining.remove(following[0])
        chain.append(following[0] if following[0].start == at else following[0].reversed())
    closed = chain[0].start == chain[-1].end
    if remaining or not (closed or chain[0].start[0] == chain[-1].end[0] == 0.0):
        raise ValueError("its faces of revolution do not form one closed outline")
    return chain


def _bends(sides: Sequence[MeridianSide], near: float) -> list[Bend]:
    """The corners of a chain; a circular side becomes a rounded corner between its end tangents."""
    if not sides:
        return []
    out = [Bend(sides[0].start[1], sides[0].start[0])]
    for side in (part for whole in sides for part in whole.quarters()):
        if side.centre is not None:
            taken = side.radius * math.tan(abs(side.turn) / 2.0)
            along = side.tangent()
            at = side.start[0] + taken * along[0], side.start[1] + taken * along[1]
            out.append(Bend(at[1], at[0], side.radius))
        out.append(Bend(side.end[1], side.end[0]))
    return _without_faces(_without_straight(out, near), near)


def _without_straight(bends: list[Bend], near: float) -> list[Bend]:
    """The corners without those at which the outline continues straight."""
    out = bends[:1]
    for bend, after in pairwise(bends[1:]):
        before = out[-1]
        one, two = (bend.r - before.r, bend.z - before.z), (after.r - bend.r, after.z - bend.z)
        length = math.hypot(*one) * math.hypot(*two)
        is_corner = abs(cross(one, two)) > 10.0 * FACE_TOLERANCE * length
        if bend.radius or (is_corner and math.hypot(*one) > near):
            out.append(bend)
    return [*out, bends[-1]]


def _without_faces(bends: list[Bend], near: float) -> list[Bend]:
    """The corners without those in the end faces."""
    while len(bends) > 2 and abs(bends[0].z - bends[1].z) <= near and not bends[0].radius:
        bends = bends[1:]
    while len(bends) > 2 and abs(bends[-1].z - bends[-2].z) <= near and not bends[-1].radius:
        bends = bends[:-1]
    return bends


def _without_end_faces(
    sides: Sequence[MeridianSide], low: float, high: float, near: float
) -> list[MeridianSide]:
    """The sides without the end faces, at z = low and z = high."""

    def is_end_face(side: MeridianSide) -> bool:
        z0, z1 = side.start[1], side.end[1]
        flat = side.centre is None and abs(z0 - z1) <= near
        return flat and (abs(z0 - low) <= near or abs(z0 - high) <= near)

    return [side for side in sides if not is_end_face(side)]


def _blind(
    before: Sequence[MeridianSide],
    after: Sequence[MeridianSide],
    low: float,
    high: float,
    near: float,
) -> list[Bend]:
    """The corners of bores that end on the axis, from the start face and from the end face."""
    first = _without_end_faces(before, low, high, near)
    last = _without_end_faces(after, low, high, near)
    if not (first or last):
        return []
    start = _bends(first, near) if first else [Bend(low, 0.0)]
    end = _bends(last, near) if last else [Bend(high, 0.0)]
    return _without_straight([*start, *end], near)

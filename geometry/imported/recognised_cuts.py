"""Recognition of cuts from the faces of a CAD body that are not of revolution about its axis.

Cylinders across the axis are holes, or ends of slots where planes continue beside them. Cylinders
along the axis are passages. Cones, tori and planes belong to the cylinder about whose axis they are
surfaces of revolution. All other planes are flats. The remaining faces round the mouths of holes,
or are cylinders of holes that are oblique or off the axis.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from geometry.imported.drilled_faces import (
    DrilledFaces,
    cylinder,
    holes_aslant,
    join,
    near,
    rounds_mouth,
)
from geometry.imported.prisms import Z_AXIS, prisms
from geometry.imported.sampled_face import FACE_TOLERANCE, Axis, SampledFace
from geometry.shape.drill import FLAT_TIP_ANGLE, Bottom
from geometry.shape.features import Cut, outer_radius, radii
from geometry.shape.hole import Hole
from geometry.shape.milled import Flat, Slot
from geometry.shape.passage import Passage
from geometry.shape.pin import Pin


@dataclass(frozen=True)
class CutFaces:
    """The faces of cuts, in a frame whose z-axis is the pin's. Lengths are in the file's unit.

    size: size of the body.
    """

    faces: Sequence[SampledFace]
    size: float

    def cuts(self, pin: Pin) -> tuple[Cut, ...]:
        """The cuts in a profile.

        Raises: ValueError with the name of a face that belongs to no known cut.
        """
        of_prisms = [p.face for prism in prisms(self.faces, self.near) for p in prism]
        sides, _ = self._flats(of_prisms, ())
        taken = {f.tag for f in of_prisms}
        planes = [f for f in self.faces if f.plane and f.tag not in taken]
        # First cylinders; then slots, which use some of the cylinders. Each remaining face may
        # belong to a cylinder. All others must be flats with their fillets, rounded mouths, or
        # holes that are oblique or off the axis.
        across, along, bent = self._cylinders([f for f in self.faces if not f.plane])
        slots, used = self._slots(pin, planes, across)
        planes = [f for f in planes if f.tag not in used]
        across = [c for c in across if not any(f.tag in used for f in c.faces)]
        along = [c for c in along if not any(f.tag in used for f in c.faces)]
        for face in [*bent, *planes]:
            owner = self._owner(face, [*across, *along])
            if owner is not None:
                owner.faces.append(face)
                used.add(face.tag)
        flats, rounded = self._flats([f for f in planes if f.tag not in used], bent)
        used |= rounded
        holes = [self._hole(pin, c) for c in across]
        remaining = [f for f in bent if f.tag not in used and not rounds_mouth(pin, f, holes)]
        passages = [self._passage(pin, c) for c in along]
        return _once(
            [*holes, *holes_aslant(remaining, self.size), *sides, *flats, *slots, *passages]
        )

    @property
    def near(self) -> float:
        """Distance within which two points coincide."""
        return near(self.size)

    def _cylinders(
        self, faces: Sequence[SampledFace]
    ) -> tuple[list[DrilledFaces], list[DrilledFaces], list[SampledFace]]:
        """Cylinders whose axes cross the pin's at a right angle, those along it, other faces."""
        across: list[DrilledFaces] = []
        along: list[DrilledFaces] = []
        bent = []
        for face in faces:
            axis = face.axis(np.zeros(3), self.size)
            place = None if axis is None else self._placed(axis)
            if place is None:
                bent.append(face)
                continue
            drilled = cylinder(face, place, self.size)
            if drilled is None:
                bent.append(face)
                continue
            join(across if abs(place.along[2]) < 0.5 else along, drilled, self.near)
        return across, along, bent

    def _placed(self, axis: Axis) -> Axis | None:
        """An axis with its point nearest to the pin's axis; None unless along or across that axis.

        An axis across must intersect the pin's axis. It points to positive x, or to positive y.
        """
        along = axis.along / np.linalg.norm(axis.along)
        if abs(abs(along[2]) - 1.0) < FACE_TOLERANCE:
            return Axis(axis.point * [1.0, 1.0, 0.0], Z_AXIS)
        if abs(along[2]) > FACE_TOLERANCE:
            return None
        if abs(along[0] * axis.point[1] - along[1] * axis.point[0]) > FACE_TOLERANCE * self.size:
            return None
        along = along * (
            1.0
            if along[0] > FACE_TOLERANCE or (abs(along[0]) <= FACE_TOLERANCE and along[1] > 0.0)
            else -1.0
        )
        return Axis(axis.point * [0.0, 0.0, 1.0], along)

    def _owner(self, face: SampledFace, drilled: Sequence[DrilledFaces]) -> DrilledFaces | None:
        """The cylinder near a face about whose axis the face is of revolution, or None."""
        for c in drilled:
            s, _ = c.local(face.rim)
            normal_along = (
                not face.plane or abs(abs(face.normals[0] @ c.axis.along) - 1.0) < FACE_TOLERANCE
            )
            inside = (
                s.max() <= 2.0 * c.radius if not face.plane else s.max() <= c.radius + self.near
            )
            if normal_along and inside and face.revolved(c.axis, self.size):
                return c
        return None

    def _slots(
        self, pin: Pin, planes: Sequence[SampledFace], across: Sequence[DrilledFaces]
    ) -> tuple[list[Slot], set[int]]:
        """Slots, between parallel planes on both sides of the axis, and the tags of their faces."""
        out, used = [], set[int]()
        # The narrowest slot comes first, because the floors of two opposite slots are also such a
        # pair of planes.
        for h, one, other in sorted(self._facing(planes), key=lambda pair: pair[0]):
            if not {one.tag, other.tag} & used:
                slot = self._slot(pin, (one, other), h, planes, across)
                if slot is not None:
                    out.append(slot[0])
                    used |= slot[1]
        return out, used

    def _facing(
        self, planes: Sequence[SampledFace]
    ) -> Iterator[tuple[float, SampledFace, SampledFace]]:
        """Pairs of parallel planes at the same distance on both sides of the axis.

        Returns the distance and the two planes. Pairs that lie on opposite sides of the axis in the
        direction along the planes are left out, because they are walls of two different slots.
        """
        for one, other in combinations(planes, 2):
            m = one.normals[0]
            h = float(one.points[0] @ m)
            if abs(abs(m @ other.normals[0]) - 1.0) > FACE_TOLERANCE or abs(h) < self.near:
                continue
            if abs(float(other.points[0] @ m) + h) > self.near:
                continue
            sides = [float((f.rim @ np.cross(m, Z_AXIS)).mean()) for f in (one, other)]
            if min(sides) > -self.near or max(sides) < self.near:
                yield abs(h), one, other

    def _slot(
        self,
        pin: Pin,
        walls: tuple[SampledFace, SampledFace],
        h: float,
        planes: Sequence[SampledFace],
        across: Sequence[DrilledFaces],
    ) -> tuple[Slot, set[int]] | None:
        """The slot between two walls, with the tags of its faces; None without round ends or floor.

        h: half of the slot's width.
        """
        k = np.cross(walls[0].normals[0], Z_AXIS)
        rim = np.concatenate([wall.rim for wall in walls])
        k = k * math.copysign(1.0, float((rim @ k).mean()))
        z0, z1 = float(rim[:, 2].min()), float(rim[:, 2].max())
        # Round ends are half cylinders of the slot's width at the ends of its walls. The floor is a
        # plane between the walls.
        ends = [
            c
            for c in across
            if abs(c.radius - h) < self.near
            and abs(abs(c.axis.along @ k) - 1.0) < FACE_TOLERANCE
            and min(abs(c.axis.point[2] - z) for z in (z0, z1)) < self.near
        ]
        floors = [
            f
            for f in planes
            if abs(abs(f.normals[0] @ k) - 1.0) < FACE_TOLERANCE
            and self.near < float((f.points @ k).mean()) < float((rim @ k).max()) - self.near
            and np.abs(f.rim @ walls[0].normals[0]).max() <= h + self.near
            and f.rim[:, 2].max() > z0 + self.near
            and f.rim[:, 2].min() < z1 - self.near
        ]
        if not ends and not floors:
            return None
        for c in ends:
            low = abs(c.axis.point[2] - z0) < self.near
            z0, z1 = (z0 - h, z1) if low else (z0, z1 + h)
        floors = sorted(floors, key=lambda f: -float((f.points @ k).mean()))[:1]
        tags = {f.tag for f in (*walls, *floors)} | {f.tag for c in ends for f in c.faces}
        angle, depth, radius = math.atan2(k[1], k[0]), None, 0.0
        if floors:
            floor = float(floors[0].points[0] @ k)
            depth = radii(pin, z0, z1)[1] - floor
            radius = max(0.0, float((rim @ k).min()) - floor)
            radius = 0.0 if radius < self.near else radius
        if radius:
            reach = [z0 - self.near, z1 + self.near]
            for f in self.faces:
                inside = reach[0] <= f.rim[:, 2].min() and f.rim[:, 2].max() <= reach[1]
                level = f.rim @ k
                corner = (
                    level.max() < floor + radius + self.near and level.min() > floor - self.near
                )
                if not f.plane and inside and corner:
                    tags.add(f.tag)
        return Slot(z0, z1, 2.0 * h, depth, angle, radius, bool(ends)), tags

    def _flats(
        self, planes: Sequence[SampledFace], bent: Sequence[SampledFace]
    ) -> tuple[list[Flat], set[int]]:
        """Flats, and the tags of the cylinders that round the corners at their ends.

        Raises: ValueError with the name of a plane that is not parallel to the axis.
        """
        out, used = [], set()
        for face in planes:
            normal = face.normals[0]
            if abs(normal[2]) > FACE_TOLERANCE:
                raise ValueError(face.name)
            distance = float(face.points[0] @ normal)
            normal = normal * math.copysign(1.0, distance)
            z0, z1 = float(face.rim[:, 2].min()), float(face.rim[:, 2].max())
            radius = 0.0
            for other in bent:
                level, z = other.points @ normal, other.rim[:, 2]
                axis = other.axis(np.zeros(3), self.size)
                touches = min(abs(z.max() - z0), abs(z.min() - z1)) < self.near
                if axis is None or not touches or level.min() < abs(distance) - self.near:
                    continue
                if abs(abs(axis.along @ np.cross(normal, Z_AXIS)) - 1.0) < FACE_TOLERANCE:
                    radius = float(
                        np.linalg.norm(np.cross(other.points[0] - axis.point, axis.along))
                    )
                    z0, z1 = min(z0, float(z.min())), max(z1, float(z.max()))
                    used.add(other.tag)
            angle = math.atan2(normal[1], normal[0])
            out.append(Flat(z0, z1, abs(distance), angle, radius))
        return out, used

    def _bottom_faces(self, c: DrilledFaces) -> list[SampledFace]:
        """The faces at the bottom of a hole."""
        out = []
        for face in c.faces:
            s, _ = c.local(face.points)
            # Sample points of a plane may lie beyond its rim, where the rim is not a full circle.
            most = float(c.local(face.rim)[0].max() if face.plane else s.max())
            if np.ptp(s) >= self.near and most <= c.radius + self.near:
                out.append(face)
        return out

    def _bottom(self, c: DrilledFaces, end: float, outward: float) -> tuple[float, Bottom]:
        """The position at which the full diameter would end without rounding, and the bottom.

        end: end of the wall along the axis. outward: direction out of the hole, 1 or -1.
        """
        tip, top, curved = FLAT_TIP_ANGLE, end, False
        for face in self._bottom_faces(c):
            s, t = c.local(face.points)
            if face.plane:
                top = float(t.mean())
                continue
            slope = np.abs(face.normals @ c.axis.along)
            if np.ptp(slope) < 10.0 * FACE_TOLERANCE:
                tip = 2.0 * math.asin(min(1.0, float(slope.mean())))
                apex = t - outward * s / math.tan(tip / 2.0)
                top = float(apex.mean()) + outward * c.radius / math.tan(tip / 2.0)
            else:
                curved = True
        if curved and tip == FLAT_TIP_ANGLE:
            rims = [outward * c.local(face.rim)[1].min() for face in self._bottom_faces(c)]
            ends = [outward * c.local(face.rim)[1].max() for face in self._bottom_faces(c)]
            top = outward * min(*rims, *ends)
        radius = abs(end - top) / math.tan(tip / 4.0) if curved else 0.0
        return top, Bottom(tip, radius)

    def _hole(self, pin: Pin, c: DrilledFaces) -> Hole:
        """The hole of a cylinder across the pin."""
        z = float(c.axis.point[2])
        outer, angle = outer_radius(pin, z), math.atan2(c.axis.along[1], c.axis.along[0])
        chamfer = 0.0
        for face in c.faces:
            s, t = c.local(face.points)
            if not face.plane and s.max() > c.radius + self.near:
                chamfer = float((s + outer - np.abs(t)).mean()) - c.radius
        blind = bool(self._bottom_faces(c))
        if c.low < 0.0 < c.high and not blind:
            angle = 0.0 if math.pi - angle % math.pi < FACE_TOLERANCE else angle % math.pi
            return Hole(z, 2.0 * c.radius, angle, chamfer=chamfer)
        outward = 1.0 if c.high > -c.low else -1.0
        end = c.low if outward > 0.0 else c.high
        # A hole without a bottom ends in the bore; its depth may end anywhere within the bore.
        floor, bottom = self._bottom(c, end, outward) if blind else (end / 2.0, Bottom())
        angle = angle if outward > 0.0 else angle + math.pi
        angle = math.atan2(math.sin(angle), math.cos(angle))
        return Hole(z, 2.0 * c.radius, angle, outer - outward * floor, bottom, chamfer)

    def _passage(self, pin: Pin, c: DrilledFaces) -> Passage:
        """The passage of a cylinder along the pin."""
        x, y, _ = c.axis.point
        place = 2.0 * c.radius, math.hypot(x, y), math.atan2(y, x)
        first, last = c.low < self.near, c.high > pin.length - self.near
        if first and last:
            return Passage(0.0, pin.length, *place)
        if first:
            floor, bottom = self._bottom(c, c.high, -1.0)
            return Passage(0.0, floor, *place, "start", bottom)
        floor, bottom = self._bottom(c, c.low, 1.0)
        return Passage(floor, pin.length, *place, "end", bottom)


def _once(cuts: Sequence[Cut]) -> tuple[Cut, ...]:
    """The cuts without duplicates."""
    out: list[Cut] = []
    for cut in cuts:
        if not any(cut.like(other, 1e-6 * max(1e-300, abs(cut.extent[1]))) for other in out):
            out.append(cut)
    return tuple(out)

"""Recesses, which are volumes of any shape, from a CAD file, that are removed from a profile."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from geometry.shape.features import Cut, Off, SmoothPart, outer_radius
from geometry.shape.pin import Pin
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

if TYPE_CHECKING:
    from scipy.spatial import KDTree

Line = tuple[tuple[float, float, float], ...]  # points in the unit of the removed solid

POINTS_AT_ONCE = 4096
ALL_AROUND = 1e-3  # of a solid's radius: if its middle is closer to the axis, it has no direction
MOUTH_TOLERANCE = 1e-4  # of the radius: points this close to the outer surface are on it


@dataclass(frozen=True)
class RemovedFace:
    """A smooth face of a removed solid that is within the profile.

    part: name of the face.
    radius: radius of the inner corner that the face rounds, 0 where it rounds none.
    points: points on the face; any other point of it is at most `spacing` from one of them.
    """

    part: str
    radius: float
    points: Line
    spacing: float

    @cached_property
    def _tree(self) -> KDTree:
        from scipy.spatial import KDTree  # here, so that pins without recesses need not load it

        return KDTree(np.array(self.points))

    def distance(self, x: Floats) -> Floats:
        """Distance of points x (P, 3) from the nearest point of the face, (P,)."""
        return np.asarray(self._tree.query(x)[0])


@dataclass(frozen=True)
class RemovedSolid:
    """A solid that is removed, in the axes of the profile.

    text: the solid in OpenCASCADE's BREP format.
    mouth: lines in which the solid's faces meet the outer surface of the profile.
    inner: other edges of its faces.
    ends: names of the end faces of the profile that the solid cuts.
    """

    text: str
    faces: tuple[RemovedFace, ...]
    mouth: tuple[Line, ...]
    inner: tuple[Line, ...]
    ends: tuple[str, ...]


@dataclass(frozen=True)
class Recess(Cut):
    """A removed solid of any shape.

    z0, z1: axial positions of its ends, m.
    width: size across, m.
    angle: direction of its middle, rad from x.
    nearest: least distance from the axis, m.
    unit: m per unit of the solid.
    at: z of the solid's origin, m.
    spun: rotation of the solid about the axis, rad.
    """

    z0: float
    z1: float
    width: float
    angle: float
    nearest: float
    solid: RemovedSolid
    unit: float = 1.0
    at: float = 0.0
    spun: float = 0.0

    what: ClassVar[str] = "recess"
    lengths: ClassVar[tuple[str, ...]] = ("z0", "z1", "width", "nearest", "unit", "at")

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest z, m."""
        return self.z0, self.z1

    @property
    def size(self) -> float:
        """The width, m."""
        return self.width

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the end faces that the recess cuts."""
        return self.solid.ends

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """The smooth parts of the recess's surface; distances from them are approximate."""
        del pin
        return tuple(
            SmoothPart(face.part, "", self._off(face), face.radius * self.unit)
            for face in self.solid.faces
        )

    def _off(self, face: RemovedFace) -> Off:
        def off(x: Floats) -> Floats:
            return np.maximum(face.distance(self._local(x)) - face.spacing, 0.0) * self.unit

        return off

    def nearest_part(self, x: Floats) -> tuple[float, str]:
        """The mean distance (m) of points x (P, 3) from the nearest face, and the face's name."""
        local = self._local(x)
        return min((float(f.distance(local).mean()) * self.unit, f.part) for f in self.solid.faces)

    def _local(self, x: Floats) -> Floats:
        """Points (P, 3), m, in the axes and the unit of the solid."""
        c, s = math.cos(self.spun), math.sin(self.spun)
        turned = np.stack([c * x[:, 0] + s * x[:, 1], c * x[:, 1] - s * x[:, 0]], axis=1)
        return np.column_stack([turned, x[:, 2] - self.at]) / self.unit

    def lines(self, of: tuple[Line, ...]) -> list[Floats]:
        """Edges of the solid as points (P, 3), m, in the pin's axes."""
        c, s = math.cos(self.spun), math.sin(self.spun)
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        return [np.array(line) @ turn * self.unit + [0.0, 0.0, self.at] for line in of]

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Do nothing: the recess was made from a profile, which it fits."""

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Self:
        """The same recess, moved in z. change: from old to new (z0, z1), m."""
        z0, z1 = change(self.z0, self.z1)
        return self._with({"z0": z0, "z1": z1, "at": self.at + z0 - self.z0})

    def turned(self, angle: float) -> Self:
        """The same recess in another direction. angle: rad from x."""
        return self._with({"angle": angle, "spun": self.spun + angle - self.angle})

    def mirrored(self, plane: str) -> Self:
        """The recess itself, because its symmetries are unknown (see `like`)."""
        del plane
        return self

    def like(self, other: Cut, tolerance: float) -> bool:
        """Always false, because the symmetries of a recess are unknown."""
        del other, tolerance
        return False

    def takes(self, x: Floats, radius: float) -> Mask:
        """Mask (P,) of the points x (P, 3), m, of an outer cylinder that are inside the mouth.

        A line parallel to the axis from such a point to the uncut part of the pin crosses the edge
        of the mouth an odd number of times.
        """
        del radius
        local, inside = self._local(x), np.zeros(len(x), dtype=bool)
        if not self.solid.mouth:
            return inside
        first, last = (
            np.concatenate([np.array(line)[part] for line in self.solid.mouth])
            for part in (slice(None, -1), slice(1, None))
        )
        angles = [np.arctan2(p[:, 1], p[:, 0]) for p in (local, first, last)]
        way = -1.0 if "end" in self.solid.ends else 1.0
        for rows in np.array_split(np.arange(len(x)), len(x) // POINTS_AT_ONCE + 1):
            here = angles[0][rows, None]
            # Angles from -pi to pi about each point. An edge that crosses the angle opposite to the
            # point then jumps by more than pi, and is not counted.
            one, two = (
                np.remainder(a - here + math.pi, 2.0 * math.pi) - math.pi for a in angles[1:]
            )
            crossed = ((one > 0.0) != (two > 0.0)) & (np.abs(one - two) < math.pi)
            part = one / np.where(crossed, one - two, 1.0)
            above = way * (first[:, 2] + part * (last - first)[:, 2] - local[rows, 2, None]) > 0.0
            inside[rows] = (crossed & above).sum(axis=1) % 2 == 1
        return inside


def is_on_outside(pin: Pin, line: Floats) -> bool:
    """Whether points (P, 3), m, are on the outer surface of a profile."""
    radius = np.array([outer_radius(pin, float(np.clip(z, 0.0, pin.length))) for z in line[:, 2]])
    r = np.hypot(line[:, 0], line[:, 1])
    return bool((np.abs(r - radius) < MOUTH_TOLERANCE * radius).all())


def of_solid(solid: RemovedSolid, width: float) -> Recess:
    """The recess of a removed solid, in the solid's unit. width: size across."""
    x = np.array([p for face in solid.faces for p in face.points])
    edges = np.array([p for line in (*solid.mouth, *solid.inner) for p in line] or x)
    every = np.concatenate([x, edges])
    middle = every[:, :2].mean(axis=0)
    if np.hypot(*middle) < ALL_AROUND * np.hypot(every[:, 0], every[:, 1]).max():
        middle = np.array([1.0, 0.0])
    return Recess(
        float(every[:, 2].min()),
        float(every[:, 2].max()),
        width,
        math.atan2(middle[1], middle[0]),
        float(np.hypot(every[:, 0], every[:, 1]).min()),
        solid,
    )

"""Recesses: volumes of any shape that are removed from a profile, as a CAD file has them."""

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

Line = tuple[tuple[float, float, float], ...]  # points, in the unit of the removed solid

POINTS_AT_ONCE = 4096
ALL_AROUND = 1e-3  # of its radius: a solid with its middle closer to the axis has no direction
MOUTH_TOLERANCE = 1e-4  # of the radius: points this close to the outer surface are on it


@dataclass(frozen=True)
class RemovedFace:
    """A smooth face of a removed solid that is within the profile.

    part: its name. radius: of the inner corner that it rounds, 0 where it rounds none.
    points: on it, at most `spacing` from any other point of it.
    """

    part: str
    radius: float
    points: Line
    spacing: float

    @cached_property
    def _tree(self) -> KDTree:
        from scipy.spatial import KDTree  # which pins without recesses do not wait for

        return KDTree(np.array(self.points))

    def distance(self, x: Floats) -> Floats:
        """Distance of points x (P, 3) from the nearest of its points, (P,)."""
        return np.asarray(self._tree.query(x)[0])


@dataclass(frozen=True)
class RemovedSolid:
    """A solid that is removed, in the axes of the profile.

    text: the solid in OpenCASCADE's BREP format.
    mouth: the lines in which its faces meet the outer surface. inner: their other edges.
    ends: names of the end faces of the profile that it cuts.
    """

    text: str
    faces: tuple[RemovedFace, ...]
    mouth: tuple[Line, ...]
    inner: tuple[Line, ...]
    ends: tuple[str, ...]


@dataclass(frozen=True)
class Recess(Cut):
    """A removed solid of any shape.

    z0, z1: its ends, m. width: its size across, m. angle: of its middle, rad from x.
    nearest: its least distance from the axis, m.
    unit: m per unit of the solid. at: z of the solid's origin, m. spun: rotation of the solid, rad.
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
        """Names of the end faces that it cuts."""
        return self.solid.ends

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """The smooth parts of its surface; distances from them are approximate."""
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
        """The mean distance (m) of points x (P, 3) from the face that is nearest to them, and the
        name of that.
        """
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
        """Nothing: it was made from a profile."""

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Self:
        """The same cut, moved in z."""
        z0, z1 = change(self.z0, self.z1)
        return self._with({"z0": z0, "z1": z1, "at": self.at + z0 - self.z0})

    def turned(self, angle: float) -> Self:
        """The same cut in another direction. angle: rad from x."""
        return self._with({"angle": angle, "spun": self.spun + angle - self.angle})

    def mirrored(self, plane: str) -> Self:
        """Itself, which is `like` nothing: its symmetries are not known."""
        del plane
        return self

    def like(self, other: Cut, tolerance: float) -> bool:
        """False: its symmetries are not known."""
        del other, tolerance
        return False

    def takes(self, x: Floats, radius: float) -> Mask:
        """Mask (P,) of the points x (P, 3), m, of an outer cylinder that are inside of its mouth.

        A line along the axis from such a point to where the pin is whole crosses the edge of the
        mouth an odd number of times.
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
            # From -pi to pi about each point, so that a line behind it goes from one to the other.
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
    """The recess of a removed solid, in its unit. width: its size across."""
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

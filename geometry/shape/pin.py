"""A pin as a body of revolution, with segments along z, bands on which links bear, exact volume."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from types import MappingProxyType
from typing import ClassVar, Never

import numpy as np

from geometry.shape.band import END_FACES, SHOULDER, Band, GeometryError
from geometry.shape.polygon import Leg, Rounding, bore_turn_at, corners, legs, roundings, turn_at
from geometry.shape.profile import meridian, volume_within
from geometry.shape.segment import Segment, merged_segments
from geometry.shape.tolerance import LENGTH_TOLERANCE, snapped
from pinbase.arrays import Floats

__all__ = ["END_FACES", "SHOULDER", "Band", "GeometryError", "Pin"]


@dataclass(frozen=True)
class Pin:
    """A pin as a body of revolution, from z = 0 on.

    fillet: radius at inner corners whose segment states no fillet, m.
    source: origin of the shape, for people.
    merged: largest difference between diameters (or bores) that were made equal because they differ
    by less than `tolerance`, m; 0 where it was no more than round-off.

    Raises: GeometryError when a dimension is impossible or a fillet does not fit.
    """

    name: str
    segments: tuple[Segment, ...]
    fillet: float = 0.0
    source: str = field(default="", compare=False)
    merged: float = field(init=False, default=0.0, compare=False)

    revolved: ClassVar[bool] = True
    meshed: ClassVar[bool] = False
    cuts: ClassVar[Mapping[str, Never]] = MappingProxyType({})

    def __post_init__(self) -> None:
        _check_dimensions(self)
        segments, difference = merged_segments(self.segments, self.tolerance)
        object.__setattr__(self, "segments", segments)
        object.__setattr__(self, "merged", difference)
        _check(self)

    @property
    def profile(self) -> Pin:
        """The pin itself, which has no cuts (geometry.shape.pin_like)."""
        return self

    @cached_property
    def tolerance(self) -> float:
        """Difference below which two dimensions are equal, m."""
        return LENGTH_TOLERANCE * self.smallest_diameter

    @cached_property
    def stations(self) -> tuple[float, ...]:
        """Positions z of the ends of all segments, m."""
        z = [0.0]
        for s in self.segments:
            z.append(z[-1] + s.length)
        return tuple(z)

    @property
    def length(self) -> float:
        """Overall length, m."""
        return self.stations[-1]

    @property
    def ends(self) -> tuple[float, float]:
        """Least and greatest z, m."""
        return 0.0, self.length

    @property
    def smallest_diameter(self) -> float:
        """Smallest outer diameter, m."""
        return min(d for s in self.segments for d in s.diameters)

    @property
    def largest_diameter(self) -> float:
        """Largest outer diameter, m."""
        return max(d for s in self.segments for d in s.diameters)

    @property
    def stepped(self) -> bool:
        """Whether the pin consists of cylinders only, without rounded edges."""
        return all(s.cylindrical for s in self.segments)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """The name of each segment's outer surface: its connection, its name, or its number."""
        return tuple(
            s.connection or s.name or f"segment {i}" for i, s in enumerate(self.segments, 1)
        )

    def radii(self, z: float) -> tuple[float, float]:
        """Radius of the bore and of the shaft at z without roundings, m.

        At a station they are the radii of the segment before it.
        """
        i = min(max(bisect_left(self.stations, z) - 1, 0), len(self.segments) - 1)
        return self.segments[i].radii(z - self.stations[i])

    def radii_at(self, z: Floats) -> tuple[Floats, Floats]:
        """The result of `radii` at many z (P,) m, (P,) m each."""
        i = np.clip(np.searchsorted(self.stations, z) - 1, 0, len(self.segments) - 1)
        dimensions = [(*s.bores, *s.diameters, s.length) for s in self.segments]
        b0, b1, d0, d1, length = np.array(dimensions)[i].T
        x = (z - np.array(self.stations)[i]) / length
        return (b0 + x * (b1 - b0)) / 2.0, (d0 + x * (d1 - d0)) / 2.0

    def fillet_at(self, corner: int) -> float:
        """Fillet radius between segments `corner` and `corner` + 1 (from 0), m.

        It is 0 where there is no inner corner.
        """
        left, right = self.segments[corner], self.segments[corner + 1]
        turn = turn_at(left, right)
        rho = self.fillet if left.fillet is None else left.fillet
        if turn == "step":
            step = 0.5 * abs(left.diameters[1] - right.diameter)
            return snapped(rho, (step,), min(self.tolerance, 1e-3 * step))
        return rho if turn == "inner" else 0.0

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        """The sides of the pin's section, from `geometry.shape.polygon.legs`."""
        return legs(corners(self), self.tolerance)

    @cached_property
    def roundings(self) -> tuple[Rounding, ...]:
        """The fillets and rounded edges of the pin's section."""
        return roundings(corners(self), self.legs)

    @cached_property
    def bands(self) -> tuple[Band, ...]:
        """The outer surface of every segment between fillets and rounded edges."""
        sides = iter(self.legs[1:])
        bands = []
        for label, s in zip(self.labels, self.segments, strict=True):
            leg = next(leg for leg in sides if leg.name == label)
            bands.append(Band(label, leg.start[1], leg.end[1], 0.25 * sum(s.diameters)))
        return tuple(bands)

    @property
    def connections(self) -> tuple[str, ...]:
        """Connections that bear on this pin, in the order of the profile."""
        return tuple(s.connection for s in self.segments if s.connection)

    def band(self, name: str) -> Band:
        """The surface called `name`.

        An outer surface is named by its segment's connection, name or number, the surface of its
        bore by the same name after "bore ". The face of a shoulder is replaced by a cylinder of the
        same area on the thicker segment, through which an axial force on the shoulder enters.

        Raises: GeometryError for an unknown name, with a list of all names.
        """
        if (face := self.shoulder(name)) is not None:
            return face
        if name.startswith("bore ") and name[5:] in self.labels:
            i = self.labels.index(name[5:])
            if radius := 0.25 * sum(self.segments[i].bores):
                return Band(name, self.stations[i], self.stations[i + 1], radius)
        return self.bands[self._position(name)]

    def shoulder(self, name: str) -> Band | None:
        """The face of this name as `band` returns it; None where there is no such face."""
        if not name.startswith(SHOULDER):
            return None
        face = next((leg for leg in self.legs if leg.name == name), None)
        if face is None or face.start == face.end:
            return None
        k = int(name[len(SHOULDER) :])
        thick = max(k - 1, k, key=lambda i: self.segments[i].diameters[i == k - 1])
        band = self.bands[thick]
        radius = abs(face.end[0] ** 2 - face.start[0] ** 2) / (2.0 * band.length)
        return Band(name, band.z0, band.z1, radius)

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study.

        The name is "start", "end", that of a segment, or that of the face of a shoulder.

        Raises: GeometryError for an unknown name, with a list of all names.
        """
        if name in END_FACES and any(
            leg.name == name and leg.start != leg.end for leg in self.legs
        ):
            return name
        if self.shoulder(name) is not None:
            return name
        return self.labels[self._position(name)]

    @cached_property
    def _numbers(self) -> dict[str | None, int]:
        """The number of the first segment with each connection, name or label."""
        out: dict[str | None, int] = {}
        for i, (s, label) in enumerate(zip(self.segments, self.labels, strict=True)):
            for name in (s.connection, s.name, label):
                out.setdefault(name, i)
        return out

    def _position(self, name: str) -> int:
        """Number (from 0) of the segment with this connection, name or label."""
        if (number := self._numbers.get(name)) is not None:
            return number
        known = ", ".join((*END_FACES, *self.labels))
        raise GeometryError(
            f"pin {self.name} has no surface {name!r}; its surfaces are {known}", "unknown-surface"
        )

    @cached_property
    def volume(self) -> float:
        """Exact volume, m^3."""
        return volume_within(meridian(self))

    def scaled(self, factor: float) -> Pin:
        """The same pin in another unit of length: all lengths times `factor`."""
        segments = tuple(s.scaled(factor) for s in self.segments)
        return replace(self, segments=segments, fillet=self.fillet * factor)

    def with_bore(self, connection: str, bore: float) -> Pin:
        """The same pin with a bore (m) through the segment on which `connection` bears."""
        i = self._position(connection)
        segments = list(self.segments)
        segments[i] = replace(segments[i], bore=bore)
        return replace(self, segments=tuple(segments))


def _check_dimensions(pin: Pin) -> None:
    """Raise GeometryError for a dimension that is impossible by itself."""
    where = f"pin {pin.name}"
    if not pin.segments:
        raise GeometryError(f"{where}: the profile has no segments", "no-segments")
    for i, s in enumerate(pin.segments, 1):
        what, at = f"{where}, segment {i}", ("segment", i)
        if not (math.isfinite(s.length) and s.length > 0.0):
            raise GeometryError(f"{what}: the length must be positive", "not-positive", at)
        if not all(math.isfinite(d) and d > 0.0 for d in s.diameters):
            raise GeometryError(f"{what}: the diameter must be positive", "not-positive", at)
        if not all(0.0 <= b < d for b, d in zip(s.bores, s.diameters, strict=True)):
            raise _bore_too_large(what, i)
        if s.fillet is not None and not s.fillet >= 0.0:
            raise GeometryError(f"{what}: the fillet must not be negative", "negative", at)
        if not all(radius >= 0.0 for radius in (*s.edge_radii, *s.bore_radii)):
            raise GeometryError(f"{what}: a radius must not be negative", "negative", at)
        if s.cone and s.connection:
            raise GeometryError(
                f"{what}: a link cannot bear on a cone, as {s.connection} does; give it a segment "
                "of one diameter",
                "band-on-cone",
                at,
            )
    if not pin.fillet >= 0.0:
        raise GeometryError(f"{where}: the fillet must not be negative", "negative")


def _bore_too_large(what: str, i: int) -> GeometryError:
    """The error for segment i (from 1), whose bore is not less than its diameter."""
    at = ("segment", i)
    return GeometryError(f"{what}: the bore must be less than the diameter", "bore-too-large", at)


def _check(pin: Pin) -> None:
    """Raise GeometryError for dimensions that do not fit together, or names used twice."""
    where, least = f"pin {pin.name}", pin.tolerance
    for i, s in enumerate(pin.segments, 1):
        if min(s.walls) <= least:
            raise _bore_too_large(f"{where}, segment {i}", i)
        if s.length <= least:
            raise GeometryError(
                f"{where}, segment {i}: its length is {s.length / pin.smallest_diameter:.2g} times "
                "the pin's smallest diameter, too short to model; lengthen it or leave it out",
                "segment-too-short",
                ("segment", i),
            )
    for i, (a, b) in enumerate(pairwise(pin.segments), 1):
        if min(a.diameters[1], b.diameter) - max(a.bores[1], b.bore) <= least:
            raise GeometryError(
                f"{where}: the bore separates segment {i} from segment {i + 1}; it must be less "
                "than the smaller of their diameters",
                "segments-separate",
                ("segment", i),
            )
    names = [n for s in pin.segments for n in {s.connection, s.name} if n] + list(END_FACES)
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise GeometryError(
            f"{where}: two surfaces are named {twice[0]!r}; names must be unique", "duplicate-name"
        )
    _check_edges(pin)
    _check_fillets(pin)
    _check_own_names(pin)


def _check_own_names(pin: Pin) -> None:
    """Raise GeometryError for a segment whose name is the default name of another surface.

    Such names are "segment 3" or "shoulder 1".
    """
    own = [leg.name for leg in pin.legs] + [rounding.name for rounding in pin.roundings]
    for s, label in zip(pin.segments, pin.labels, strict=True):
        if s.connection or s.name:
            own.remove(label)
    for i, s in enumerate(pin.segments, 1):
        for name in (s.connection, s.name):
            if name and name in own:
                raise GeometryError(
                    f"pin {pin.name}, segment {i}: {name!r} is the name that another surface has "
                    "of itself; choose another name",
                    "duplicate-name",
                    ("segment", i),
                )


def _check_edges(pin: Pin) -> None:
    """Raise GeometryError for an edge radius where there is no edge."""
    turns = [turn_at(a, b) for a, b in pairwise(pin.segments)]
    inside = [bore_turn_at(a, b) for a, b in pairwise(pin.segments)]
    for i, s in enumerate(pin.segments):
        for end, k in ((0, i - 1), (1, i)):
            within, what = 0 <= k < len(turns), f"pin {pin.name}, segment {i + 1}"
            if s.edge_radii[end] and within:
                other = pin.segments[i + 2 * end - 1].diameters[1 - end]
                if turns[k] != "edge" and not (turns[k] == "step" and s.diameters[end] > other):
                    raise GeometryError(
                        f"{what}: its outer surface has no edge at its {END_FACES[end]} for "
                        "edge_radius to round; set edge_radius to 0 (an inner corner is rounded by "
                        "fillet)",
                        "no-edge",
                        ("segment", i + 1),
                    )
            if s.bore_radii[end] and (not s.bores[end] or (within and inside[k] == "smooth")):
                raise GeometryError(
                    f"{what}: its bore has no corner at its {END_FACES[end]} for bore_radius to "
                    "round; set bore_radius to 0",
                    "no-edge",
                    ("segment", i + 1),
                )


def _check_fillets(pin: Pin) -> None:
    """Raise GeometryError for fillets that do not fit their step or their segment."""
    for i, (left, right) in enumerate(pairwise(pin.segments)):
        rho = pin.fillet_at(i)
        step = 0.5 * abs(left.diameters[1] - right.diameter)
        if step and rho > step and not (left.cone or right.cone):
            raise GeometryError(
                f"pin {pin.name}: the fillet between segments {i + 1} and {i + 2} is "
                f"{rho / step:.4g} times as large as the step; reduce it to at most half the "
                f"difference of the diameters, or give segment {i + 1} a fillet of its own",
                "fillet-too-large",
                ("segment", i + 1),
            )
    bearing = {s.connection for s in pin.segments if s.connection}
    for leg in pin.legs:
        if leg.short > pin.tolerance or (leg.name in bearing and leg.start == leg.end):
            raise _overlapping(pin, leg)


def _overlapping(pin: Pin, leg: Leg) -> GeometryError:
    """The error for roundings that take up more than the length of a side."""
    taken, name = sum(leg.taken) / leg.length if leg.length else math.inf, leg.name or "the axis"
    if leg.name in pin.labels:
        i = pin.labels.index(leg.name) + 1
        return GeometryError(
            f"pin {pin.name}, segment {i}: the fillets at its ends take up its whole length "
            f"({taken:.4g} times); reduce them or lengthen the segment",
            "fillets-overlap",
            ("segment", i),
        )
    return GeometryError(
        f"pin {pin.name}: the radii at the ends of {name} take up more than its length "
        f"({taken:.4g} times); reduce them",
        "fillets-overlap",
    )

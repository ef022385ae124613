"""A segment of a pin's profile, which is a cylinder or a cone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from geometry.shape.tolerance import DIMENSION_ROUND_OFF, merged

Pair = tuple[float, float]


@dataclass(frozen=True)
class Segment:
    """A cylinder or cone of the profile. All lengths are in m.

    diameter, bore: outer and inner diameter at the near end; bore 0 for a solid segment.
    name, connection: name of the outer surface, and the connection whose link bears on it.
    fillet: radius of the inner corner at the far end; None for the pin's fillet.
    end_diameter, end_bore: outer and inner diameter at the far end; None: as at the near end.
    edge_radii: radii of the edges of the outer surface at the two ends.
    bore_radii: radii of the corners of the bore at the two ends.
    """

    length: float
    diameter: float
    bore: float = 0.0
    name: str | None = None
    connection: str | None = None
    fillet: float | None = None
    end_diameter: float | None = None
    end_bore: float | None = None
    edge_radii: Pair = (0.0, 0.0)
    bore_radii: Pair = (0.0, 0.0)

    @property
    def diameters(self) -> Pair:
        """Outer diameters at the two ends, m."""
        return self.diameter, self.diameter if self.end_diameter is None else self.end_diameter

    @property
    def bores(self) -> Pair:
        """Inner diameters at the two ends, m."""
        return self.bore, self.bore if self.end_bore is None else self.end_bore

    @property
    def walls(self) -> Pair:
        """Difference of diameter and bore at the two ends, m: twice the wall."""
        (d0, d1), (b0, b1) = self.diameters, self.bores
        return d0 - b0, d1 - b1

    @property
    def mean_area(self) -> float:
        """Mean cross-sectional area without roundings, times 4 / pi, m^2."""
        (d0, d1), (b0, b1) = self.diameters, self.bores
        return (d0 * d0 + d0 * d1 + d1 * d1 - b0 * b0 - b0 * b1 - b1 * b1) / 3.0

    def radii(self, z: float) -> Pair:
        """Radii of bore and shaft, m, at z (m) from the start of the segment."""
        (d0, d1), (b0, b1), x = self.diameters, self.bores, z / self.length
        return (b0 + x * (b1 - b0)) / 2.0, (d0 + x * (d1 - d0)) / 2.0

    @property
    def cone(self) -> bool:
        """Whether the outer surface is a cone."""
        return self.diameters[0] != self.diameters[1]

    @property
    def cylindrical(self) -> bool:
        """Whether the segment has no cones and no rounded edges."""
        tapered = self.cone or self.bores[0] != self.bores[1]
        return not (tapered or any((*self.edge_radii, *self.bore_radii)))

    def widened(self, change: Callable[[float], float]) -> Segment:
        """The same segment with every transverse dimension changed: diameters, bores and radii."""
        return replace(
            self,
            diameter=change(self.diameter),
            bore=change(self.bore),
            fillet=None if self.fillet is None else change(self.fillet),
            end_diameter=None if self.end_diameter is None else change(self.end_diameter),
            end_bore=None if self.end_bore is None else change(self.end_bore),
            edge_radii=_both(self.edge_radii, change),
            bore_radii=_both(self.bore_radii, change),
        )

    def cut(self, ends: Sequence[float]) -> tuple[Segment, ...]:
        """The parts of the segment between `ends` (m), which run from 0 to its length, unnamed.

        The first and the last part keep the radii at the segment's ends, the last also its fillet.
        """
        parts = []
        for a, b in pairwise(ends):
            (b0, r0), (b1, r1) = self.radii(a), self.radii(b)
            plain = Segment(float(b - a), self.diameter, self.bore, fillet=0.0)
            if not self.cylindrical:
                plain = plain.with_diameters((2.0 * r0, 2.0 * r1), (2.0 * b0, 2.0 * b1))
            parts.append(plain)
        (edge, last), (mouth, far) = self.edge_radii, self.bore_radii
        parts[0] = replace(parts[0], edge_radii=(edge, 0.0), bore_radii=(mouth, 0.0))
        near_radii = parts[-1].edge_radii[0], parts[-1].bore_radii[0]
        parts[-1] = replace(
            parts[-1],
            fillet=self.fillet,
            edge_radii=(near_radii[0], last),
            bore_radii=(near_radii[1], far),
        )
        return tuple(parts)

    def scaled(self, factor: float) -> Segment:
        """The same segment in another unit of length: all lengths times `factor`."""
        return replace(self.widened(lambda x: x * factor), length=self.length * factor)

    def with_diameters(self, outer: Pair, inner: Pair) -> Segment:
        """The same segment with other diameters and bores at its two ends, m."""
        return replace(
            self,
            diameter=outer[0],
            end_diameter=None if outer[1] == outer[0] else outer[1],
            bore=inner[0],
            end_bore=None if inner[1] == inner[0] else inner[1],
        )


def _both(pair: Pair, change: Callable[[float], float]) -> Pair:
    return change(pair[0]), change(pair[1])


def merged_segments(
    segments: tuple[Segment, ...], tolerance: float
) -> tuple[tuple[Segment, ...], float]:
    """Segments whose diameters and bores are equal or differ by more than the tolerance (m).

    Returns also the largest change of a dimension, m; 0 if no change exceeds round-off.
    """
    outer = merged((d for s in segments for d in s.diameters), tolerance)
    inner = merged((0.0, *(d for s in segments for d in s.bores)), tolerance)
    changes = [*outer.items(), *inner.items()]
    difference = max(
        (old - new for old, new in changes if old - new > DIMENSION_ROUND_OFF * old), default=0.0
    )
    unified = (
        s.with_diameters(
            (outer[s.diameters[0]], outer[s.diameters[1]]), (inner[s.bores[0]], inner[s.bores[1]])
        )
        for s in segments
    )
    return tuple(unified), difference

"""The variable dimensions of a pin, its geometric limits and its volume, for the least weight.

All diameters, bores and fillets of a body of revolution are linear in the values of its dimensions.
Limits and volume therefore have closed forms, with their gradients.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from geometry import Pin, PinLike, body_of_revolution
from geometry.shape.dimensions import Dimension
from geometry.shape.polygon import turn_at
from pinbase.arrays import Floats
from pinstress.analysis.remedies.dimensions import dimensions_of
from pinstress.study.reading.file import Study

DIMENSION_KINDS = "diameters", "bores", "fillets"
MAX_FACE_SHARE = 0.6  # largest share of a step's height that its fillet may take
MAX_BAND_SHARE = 0.25  # largest share of a segment's length that fillets may take
MAX_DIMENSION_RATIO = 50.0  # largest factor by which a dimension may grow or shrink
SHAPE_STEP = 1e-3  # relative step to find the rates of a shape, which is linear in a dimension
# Area between a fillet and its corner, over the radius squared
FILLET_AREA_FACTOR = 1.0 - math.pi / 4.0
# Distance of the centroid of this area from the sides, over the radius
FILLET_CENTROID_FACTOR = (10.0 - 3.0 * math.pi) / (12.0 - 3.0 * math.pi)


@dataclass(frozen=True)
class Proportions:
    """The proportions that a shape must keep; if it violates one now, the present value counts.

    wall: smallest wall thickness over the diameter.
    shoulder: smallest ratio of the diameters of a step.
    """

    wall: float = 0.1
    shoulder: float = 1.2


@dataclass(frozen=True)
class Limit:
    """A linear function of the dimensions, relative to its length scale, that must not be negative.

    text: a description. constant, slope: value at the present dimensions, and gradient (n,), 1/m.
    instead: another limit that may hold instead, if any.
    """

    text: str
    constant: float
    slope: Floats
    instead: Limit | None = None

    def at(self, growth: Floats) -> tuple[float, Floats]:
        """Return the value and the gradient for dimensions that are larger by `growth` (n,), m."""
        value = self.constant + float(self.slope @ growth)
        if self.instead is not None:
            other, slope = self.instead.at(growth)
            if other > value:
                return other, slope
        return value, self.slope


@dataclass(frozen=True)
class _Ends:
    """The diameters and bores (S, 2) at the ends of S segments, and the fillets (S - 1,) between
    the segments, m.
    """

    outer: Floats
    inner: Floats
    fillets: Floats

    @classmethod
    def of(cls, pin: Pin) -> _Ends:
        fillets = [_fillet(pin, k) for k in range(len(pin.segments) - 1)]
        outer, inner = ([list(x) for x in y] for y in zip(*_across(pin), strict=True))
        return cls(np.array(outer), np.array(inner), np.array(fillets, dtype=np.float64))


def _across(pin: Pin) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
    yield from ((s.diameters, s.bores) for s in pin.segments)


def _fillet(pin: Pin, corner: int) -> float:
    """Return the radius of a step's fillet, m; 0 at other corners."""
    left, right = pin.segments[corner], pin.segments[corner + 1]
    return pin.fillet_at(corner) if turn_at(left, right) == "step" else 0.0


class VariedShape:
    """A pin of the study whose dimensions of the given `kinds` vary; values (n,), m.

    Adjacent segments of equal diameter or bore remain equal. The limits refer to the pin as given.
    """

    def __init__(
        self, study: Study, pin: PinLike, kinds: Iterable[str], limits: Proportions
    ) -> None:
        self.whole, self.limits = pin, limits
        chosen = tuple(kinds)
        self.dimensions = tuple(d for d in dimensions_of(study, pin) if kind_of(d.key) in chosen)
        self.values = np.array([d.value for d in self.dimensions])

    @property
    def pin(self) -> Pin:
        """The pin as given, which must be a body of revolution; others have no dimensions."""
        pin = body_of_revolution(self.whole)
        assert pin is not None
        return pin

    @property
    def keys(self) -> tuple[str, ...]:
        return tuple(d.key for d in self.dimensions)

    @cached_property
    def _now(self) -> _Ends:
        return _Ends.of(self.pin)

    @cached_property
    def _rates(self) -> tuple[Floats, Floats, Floats]:
        """The derivatives of diameters (S, 2, n), bores (S, 2, n) and fillets (S - 1, n) by the
        dimensions.
        """
        rates = [self._rate(d) for d in self.dimensions]
        return tuple(np.stack([rate[k] for rate in rates], axis=-1) for k in range(3))  # type: ignore

    def _rate(self, dimension: Dimension) -> tuple[Floats, Floats, Floats]:
        less = dimension.changed(dimension.value * (1.0 - SHAPE_STEP))
        other, now, size = _Ends.of(less), self._now, SHAPE_STEP * dimension.value
        return (
            (now.outer - other.outer) / size,
            (now.inner - other.inner) / size,
            (now.fillets - other.fillets) / size,
        )

    def _ends(self, values: Floats) -> _Ends:
        growth, now = values - self.values, self._now
        outer, inner, fillets = self._rates
        return _Ends(
            now.outer + outer @ growth, now.inner + inner @ growth, now.fillets + fillets @ growth
        )

    @cached_property
    def _rest(self) -> float:
        """The part of the present volume that `_plain` does not include, m^3."""
        return self.pin.volume - self._plain(self.values)[0]

    def part_of_diameter(self, segment: int) -> Floats:
        """Return the relative change (n,) of a segment's mean diameter per relative change of each
        dimension.
        """
        rate = self._rates[0][segment].sum(axis=0) * self.values
        return np.asarray(rate / self._now.outer[segment].sum())

    def volume(self, values: Floats) -> tuple[float, Floats]:
        """Return the volume, m^3, and its gradient (n,), m^2.

        They are exact except for rounded edges and fillets at cones, whose share of the volume is
        constant here.
        """
        value, slope = self._plain(values)
        return value + self._rest, slope

    def _plain(self, values: Floats) -> tuple[float, Floats]:
        ends = self._ends(values)
        outer, inner, fillets = self._rates
        length = math.pi / 12.0 * np.array([s.length for s in self.pin.segments])
        total, slope = 0.0, np.zeros(len(values))
        for sign, d, rate in ((1.0, ends.outer, outer), (-1.0, ends.inner, inner)):
            a, b = d.T
            total += sign * float(length @ (a * a + a * b + b * b))
            slope += sign * (length * (2.0 * a + b)) @ rate[:, 0]
            slope += sign * (length * (2.0 * b + a)) @ rate[:, 1]
        for k, rho in enumerate(ends.fillets):
            end = self._thinner(k)
            radius, by = ends.outer[end] / 2.0, outer[end] / 2.0
            times = 2.0 * math.pi * FILLET_AREA_FACTOR
            total += times * rho * rho * (radius + FILLET_CENTROID_FACTOR * rho)
            slope += times * rho * rho * by
            slope += times * rho * (2.0 * radius + 3.0 * FILLET_CENTROID_FACTOR * rho) * fillets[k]
        return total, slope

    def _thinner(self, corner: int) -> tuple[int, int]:
        """Return the segment and its end that have the smaller present diameter at a corner."""
        left, right = self._now.outer[corner, 1], self._now.outer[corner + 1, 0]
        return (corner, 1) if left <= right else (corner + 1, 0)

    @cached_property
    def geometric(self) -> tuple[Limit, ...]:
        """All geometric limits, without the bounds of single dimensions."""
        limits = [*self._steps(), *self._walls(), *self._along()]
        return tuple(x for x in limits if np.abs(x.slope).max(initial=0.0) > 1e-9)

    def at_limits(self, values: Floats) -> tuple[Floats, Floats]:
        """Return all relative limits (m,), negative where violated, and their gradients (m, n),
        1/m.
        """
        limits = [limit.at(values - self.values) for limit in self.geometric]
        slopes = np.array([slope for _, slope in limits]).reshape(-1, len(values))
        return np.array([value for value, _ in limits]), slopes

    def _limit(self, text: str, *parts: tuple[float, float, Floats]) -> Limit:
        """Return the limit that a sum of parts must not be negative, relative to its largest part.

        parts: factor, present value and rates (n,) of each dimension in the sum.
        """
        size = max(abs(factor * value) for factor, value, _ in parts)
        value = sum(factor * value for factor, value, _ in parts) / size
        slope = sum(factor * rate for factor, _, rate in parts) / size
        return Limit(text, max(float(value), 0.0), np.asarray(slope))

    def _steps(self) -> Iterator[Limit]:
        now, (outer, _, fillets) = self._now, self._rates
        for k, rho in enumerate(now.fillets):
            small = self._thinner(k)
            large = (k + 1, 0) if small == (k, 1) else (k, 1)
            d, D = float(now.outer[small]), float(now.outer[large])
            if d == D:
                continue
            ratio = min(self.limits.shoulder, D / d)
            name = f"step {k + 1}-{k + 2}"
            yield self._limit(
                f"{name}: diameters at least {ratio:.4g} apart",
                (1.0, D, outer[large]), (-ratio, d, outer[small]),
            )  # fmt: skip
            if not rho:
                continue
            face = max(MAX_FACE_SHARE, rho / ((D - d) / 2.0))
            yield self._limit(
                f"{name}: fillet at most {face:.4g} of its height",
                (face / 2.0, D, outer[large]), (-face / 2.0, d, outer[small]),
                (-1.0, rho, fillets[k]),
            )  # fmt: skip
            if np.any(fillets[k]):
                text = f"{name}: fillet not smaller than it is, or {rho / d:.4g} of the diameter"
                still = Limit(text, 0.0, fillets[k] / rho)
                as_wide = self._limit(text, (1.0, rho, fillets[k]), (-rho / d, d, outer[small]))
                yield replace(as_wide, instead=still)

    def _walls(self) -> Iterator[Limit]:
        """Yield the limits of the walls at every segment's ends, and of each bore within the
        diameter on the other side of a corner.
        """
        now, (outer, inner, _) = self._now, self._rates
        pairs = [((k, e), (k, e)) for k in range(len(now.outer)) for e in (0, 1)]
        for k in range(len(now.outer) - 1):
            pairs += [((k, 1), (k + 1, 0)), ((k + 1, 0), (k, 1))]
        known: set[tuple[bytes, bytes]] = set()
        for shaft, bore in pairs:
            D, b = float(now.outer[shaft]), float(now.inner[bore])
            same = outer[shaft].tobytes(), inner[bore].tobytes()
            if not b or same in known:
                continue
            known.add(same)
            most = max(1.0 - 2.0 * self.limits.wall, b / D)
            yield self._limit(
                f"bore of segment {bore[0] + 1} at most {most:.4g} of the diameter",
                (most, D, outer[shaft]), (-1.0, b, inner[bore]),
            )  # fmt: skip

    def _along(self) -> Iterator[Limit]:
        """Yield the limits of the part of a segment's length that fillets take."""
        now, rates = self._now, self._rates[2]
        for k, segment in enumerate(self.pin.segments):
            here = [c for c in (k - 1, k) if 0 <= c < len(now.fillets)]
            corners = [c for c in here if now.fillets[c] and self._thinner(c)[0] == k]
            if not corners:
                continue
            taken = float(now.fillets[corners].sum())
            most = max(MAX_BAND_SHARE, taken / segment.length)
            still = np.zeros(len(self.values))
            yield self._limit(
                f"fillets at most {most:.4g} of segment {k + 1}",
                (most, segment.length, still), (-1.0, taken, rates[corners].sum(axis=0)),
            )  # fmt: skip


def kind_of(key: str) -> str:
    """Return the kind of a dimension by its key; empty for lengths and other radii."""
    last = key.rpartition(".")[2]
    if key.startswith("meridian["):
        return "diameters" if key.endswith("][2]") else ""
    if key.startswith("bore_meridian["):
        return "bores" if key.endswith("][2]") else ""
    named = {"diameter": "diameters", "bore": "bores", "fillet": "fillets"}
    return named.get(last.partition("[")[0], "")

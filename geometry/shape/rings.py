"""Rings into which bands of a pin and bores of its lugs are cut; each has a uniform pressure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from geometry.shape.band import SHOULDER, Band
from geometry.shape.pin import Pin
from geometry.shape.segment import Segment
from pinbase.arrays import Floats

USUAL_RING_COUNT = 8  # rings of a band with sharp edges, if it is not long
MAX_RING_LENGTH = 0.25  # largest length of a ring over the diameter, for the usual count
# An outermost ring may be cut into parts; each part ends at most this many times farther from the
# edge than the part before it.
RING_PART_RATIO = 2.5
# Distance of a fillet's largest stress from the start of the fillet, at least, over its radius.
FILLET_PEAK_OFFSET = 0.25
MIN_RING_LENGTH = 1e-3  # least length of a ring over the diameter
# Resolution of the peak of pressure at a rounded edge. Over these lengths from the start of the
# rounding, relative to its radius, rings have equal length: outwards, where contact ends, and
# inwards, where the peak is. Beyond them each ring is longer than the one before by the factor
# RING_GROWTH. Rings that grow from the start of the rounding on give errors of up to 13 %.
OUTWARD_EVEN_LENGTH, INWARD_EVEN_LENGTH, RING_GROWTH = 0.08, 0.03, 1.6


def ring_ends(
    band: Band,
    edge_radius: float,
    count: int,
    beside: float | None = None,
    longest_last: tuple[float, float] = (math.inf, math.inf),
) -> Floats:
    """The ends of the rings of a band, (R + 1,) m from the start of the band.

    Where the lug's edges are rounded, the first rings of the rounding are so short that contact may
    end in them.
    edge_radius: radius of the rounded edges of the lug's bore, m; 0 for sharp edges.
    count: number of rings where the bore is straight; long bands get more.
    beside: length of the rings at the start of the rounding over its radius, for the usual count,
    to resolve the peak of pressure there. Rings then grow towards the middle. None: do not resolve
    the peak.
    longest_last: largest lengths, m, of the outermost rings at both ends. Where edges are sharp,
    outermost rings are cut into parts to meet them; where edges are rounded, contact ends in short
    rings anyway.
    """
    coarser = USUAL_RING_COUNT / count
    longest = 2.0 * MAX_RING_LENGTH * band.radius * coarser
    if beside is not None and edge_radius:
        return _to_the_peak(
            band.length, edge_radius, beside * coarser, RING_GROWTH**coarser, longest
        )
    # Rings of the straight part, graded towards its ends.
    flat = band.length - 2.0 * edge_radius
    inner = np.zeros(1)
    if flat > 1e-9 * band.length:
        inner = graded(flat, max(count, math.ceil(0.5 * math.pi * flat / longest - 1e-9)))
    # Sharp edges: cut the outermost rings into parts.
    if not edge_radius:
        first, last = (_parts(float(inner[1]), most) for most in longest_last)
        return np.concatenate([first, inner[1:-1], flat - last[::-1]])
    # Rounded edges: rings whose distances from the start of the rounding grow as squares.
    rounded = max(2, count // 4, math.ceil(2.0 * edge_radius / longest))
    outer = edge_radius * (np.arange(1, rounded + 1) / rounded) ** 2
    return np.concatenate(
        [edge_radius - outer[::-1], edge_radius + inner, band.length - edge_radius + outer]
    )


def _parts(length: float, most: float) -> Floats:
    """The ends of the parts of an outermost ring, m from the edge, without the far end of the ring.

    The first part is no longer than `most`, m. The distances of the ends grow by a constant factor
    of at most RING_PART_RATIO.
    """
    count = 0 if length <= most else math.ceil(math.log(length / most) / math.log(RING_PART_RATIO))
    return np.asarray(
        [0.0, *(length * (most / length) ** (k / (count or 1)) for k in range(count, 0, -1))]
    )


def beside_fillets(pin: Pin, band: Band) -> tuple[float, float]:
    """The largest length, m, of the outermost rings of a band at both ends.

    It is so short that a fillet's largest stress lies outside the zone next to the rings in which
    stress is not read (fea.core.pressed).
    """
    near = [
        min(
            (
                max(math.dist(x.at, (band.radius, z)) - x.reach, 0.0)
                + FILLET_PEAK_OFFSET * x.radius
                for x in pin.roundings
                if x.inner
            ),
            default=math.inf,
        )
        for z in (band.z0, band.z1)
    ]
    least = MIN_RING_LENGTH * 2.0 * band.radius
    return max(near[0], least), max(near[1], least)


def _to_the_peak(
    length: float, radius: float, beside: float, growth: float, longest: float
) -> Floats:
    first = beside * radius
    outside = _from_edge(radius, OUTWARD_EVEN_LENGTH * radius, first, growth, longest)[::-1]
    flat = _from_edge(length / 2.0 - radius, INWARD_EVEN_LENGTH * radius, first, growth, longest)
    ends = np.cumsum([0.0, *outside, *flat])
    return np.concatenate([ends[:-1], [length / 2.0], length - ends[-2::-1]])


def _from_edge(length: float, even: float, first: float, growth: float, longest: float) -> Floats:
    """Lengths of rings that add up to `length`, m: equal over the length `even`, then growing.

    first, growth, longest: as for `_growing`.
    """
    even = min(even, length)
    count = math.ceil(even / first - 1e-9)
    alike = np.full(count, even / max(count, 1))
    return np.concatenate([alike, _growing(length - even, first, growth, longest)])


def graded(length: float, count: int) -> Floats:
    """The ends of rings, (count + 1,) m from 0, shorter towards both ends, where pressure rises."""
    return np.asarray(length * (1.0 - np.cos(np.linspace(0.0, np.pi, count + 1))) / 2.0)


def _growing(length: float, first: float, growth: float, longest: float) -> Floats:
    """Lengths of rings that add up to `length`, m.

    They begin at about `first`, and each is `growth` times the one before, up to `longest`, m.
    """
    most = math.ceil(length / longest) + math.ceil(
        max(0.0, math.log(longest / first) / math.log(growth))
    )
    parts = np.minimum(first * growth ** np.arange(most + 1), longest)
    parts = parts[: int(np.searchsorted(np.cumsum(parts), length * (1.0 - 1e-9))) + 1]
    return np.asarray(parts * (length / parts.sum())) if length > 0.0 else np.zeros(0)


def ring(connection: str, i: int) -> str:
    """The name of a ring's surface, i from 0 on."""
    return f"{connection} ring {i + 1}"


def rings(connection: str, ends: Floats) -> list[str]:
    """The names of all rings with these ends."""
    return [ring(connection, i) for i in range(len(ends) - 1)]


def ringed(pin: Pin, ends: Mapping[str, Floats]) -> Pin:
    """The same shape with the bands of some connections cut into rings.

    Only the band itself is cut, between its fillets; the segments of the first and the last ring
    include the parts that fillets take.
    ends: ends (R + 1,) of the rings of each connection, m from the start of its band.
    """
    segments: list[Segment] = []
    for i, (s, band) in enumerate(zip(pin.segments, pin.bands, strict=True)):
        if s.connection is None or s.connection not in ends:
            segments.append(s)
            continue
        inner = (band.z0 + ends[s.connection])[1:-1]
        parts = s.cut([0.0, *(inner - pin.stations[i]), s.length])
        segments += [
            replace(part, connection=ring(s.connection, k)) for k, part in enumerate(parts)
        ]
    return replace(pin, segments=tuple(segments))


def ringed_name(pin: Pin, name: str) -> str:
    """The name that a surface of the whole pin has in the pin cut into rings.

    The number of a segment or of a shoulder changes.
    pin: the pin cut into rings.
    """
    kind, _, number = name.rpartition(" ")
    if kind not in ("segment", SHOULDER.strip()):
        return name
    of_whole = np.cumsum([" ring " not in x or x.endswith(" ring 1") for x in pin.labels])
    return f"{kind} {1 + int(np.flatnonzero(of_whole == int(number))[-1])}"


def whole_names(pin: Pin, ends: Mapping[str, Floats]) -> dict[str, str]:
    """The names of surfaces in the whole pin, by their names in the `ringed` pin."""
    cut, k, names = ringed(pin, ends), 0, {}
    for i, s in enumerate(pin.segments):
        band_ends = ends.get(s.connection or "")
        for _ in range(1 if band_ends is None else len(band_ends) - 1):
            for bore in ("", "bore "):
                names[f"{bore}{cut.labels[k]}"] = f"{bore}{pin.labels[i]}"
            k += 1
        for corner in ("shoulder", "bore step"):
            names[f"{corner} {k}"] = f"{corner} {i + 1}"
    return names


def annulus(pin: Pin, connection: str, outer_diameter: float, ends: Floats) -> Pin:
    """A lug's eye as a body of revolution from z = 0, whose bore has the rings of its band.

    connection: connection whose band the lug bears on. outer_diameter: m.
    ends: ends (R + 1,) of the rings, m.
    """
    band = pin.band(connection)
    segments = tuple(
        Segment(float(b - a), outer_diameter, 2.0 * band.radius, connection=ring(connection, k))
        for k, (a, b) in enumerate(pairwise(ends))
    )
    return Pin(f"lug {connection}", segments)

"""Rings into which bands of a pin and bores of its lugs are cut; pressure is even along each."""

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
MAX_RING_LENGTH = 0.25  # ring, of the diameter, if there are so many
# Length of each part of an outermost ring that is cut, over that of the part before it.
RING_PART_RATIO = 2.5
# Of a fillet's radius: its largest stress is at least this far from where the fillet begins.
FILLET_PEAK_OFFSET = 0.25
MIN_RING_LENGTH = 1e-3  # ring, of the diameter
# Where the peak at a rounded edge is resolved: rings of one length lie this far from where rounding
# begins, of its radius, outwards (where contact ends) and inwards (where the peak is); from there
# on each is so many times longer. Rings that grow from the start on are up to 13 % off.
OUTWARD_EVEN_LENGTH, INWARD_EVEN_LENGTH, RING_GROWTH = 0.08, 0.03, 1.6


def ring_ends(
    band: Band,
    edge_radius: float,
    count: int,
    beside: float | None = None,
    longest_last: tuple[float, float] = (math.inf, math.inf),
) -> Floats:
    """The ends of the rings of a band, (R + 1,) m from its start on.

    Where its edges are rounded, the first rings of the rounding are so short that contact may end
    in them.
    count: number of rings where the bore is straight; more for long bands.
    beside: to resolve the peak of pressure where rounding begins, rings of `beside` times the
    radius there, for the usual count, and as many as lead from them to the middle.
    longest_last: the largest length, m, of the outermost rings at both ends, which are cut in parts
    for it where edges are sharp; where they are rounded contact ends in short ones anyway.
    """
    coarser = USUAL_RING_COUNT / count
    longest = 2.0 * MAX_RING_LENGTH * band.radius * coarser
    if beside is not None and edge_radius:
        return _to_the_peak(
            band.length, edge_radius, beside * coarser, RING_GROWTH**coarser, longest
        )
    flat = band.length - 2.0 * edge_radius
    inner = np.zeros(1)
    if flat > 1e-9 * band.length:
        inner = graded(flat, max(count, math.ceil(0.5 * math.pi * flat / longest - 1e-9)))
    if not edge_radius:
        first, last = (_parts(float(inner[1]), most) for most in longest_last)
        return np.concatenate([first, inner[1:-1], flat - last[::-1]])
    rounded = max(2, count // 4, math.ceil(2.0 * edge_radius / longest))
    outer = edge_radius * (np.arange(1, rounded + 1) / rounded) ** 2
    return np.concatenate(
        [edge_radius - outer[::-1], edge_radius + inner, band.length - edge_radius + outer]
    )


def _parts(length: float, most: float) -> Floats:
    """The ends, except the far one, of the parts of an outermost ring, from the edge on.

    The first part is no longer than `most`; each is so many times as long as those before it
    together.
    """
    count = 0 if length <= most else math.ceil(math.log(length / most) / math.log(RING_PART_RATIO))
    return np.asarray(
        [0.0, *(length * (most / length) ** (k / (count or 1)) for k in range(count, 0, -1))]
    )


def beside_fillets(pin: Pin, band: Band) -> tuple[float, float]:
    """The largest length, m, of the outermost rings of a band at both ends.

    It is such that a fillet's largest stress is beyond what is not read beside the rings
    (fea.core.pressed).
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
    """Lengths that add up to `length`, m: equal over `even`, then growing."""
    even = min(even, length)
    count = math.ceil(even / first - 1e-9)
    alike = np.full(count, even / max(count, 1))
    return np.concatenate([alike, _growing(length - even, first, growth, longest)])


def graded(length: float, count: int) -> Floats:
    """The ends of rings, (count + 1,) m from 0 on, shorter towards both ends, where pressure
    rises.
    """
    return np.asarray(length * (1.0 - np.cos(np.linspace(0.0, np.pi, count + 1))) / 2.0)


def _growing(length: float, first: float, growth: float, longest: float) -> Floats:
    """Lengths that add up to `length`, m, from about `first` on each `growth` times the one before,
    up to `longest`.
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
    """The same shape with the bands of some connections cut into rings, whose ends (R + 1,) are in
    m from the band's start.

    A ring is cut where the band is, between its fillets: what a fillet takes stays plain.
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
    """The name in a pin cut into rings of a surface of the whole pin: the number of a segment or of
    a shoulder changes.

    pin: cut into rings.
    """
    kind, _, number = name.rpartition(" ")
    if kind not in ("segment", SHOULDER.strip()):
        return name
    of_whole = np.cumsum([" ring " not in x or x.endswith(" ring 1") for x in pin.labels])
    return f"{kind} {1 + int(np.flatnonzero(of_whole == int(number))[-1])}"


def whole_names(pin: Pin, ends: Mapping[str, Floats]) -> dict[str, str]:
    """The pin's own names of the surfaces of `ringed`, by the names there."""
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
    """A lug's eye, as a body of revolution from z = 0 on, whose bore has the rings of the band on
    which it bears.
    """
    band = pin.band(connection)
    segments = tuple(
        Segment(float(b - a), outer_diameter, 2.0 * band.radius, connection=ring(connection, k))
        for k, (a, b) in enumerate(pairwise(ends))
    )
    return Pin(f"lug {connection}", segments)

"""Rings into which bands of a pin and bores of its lugs are cut; pressure is even along each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from fea.core.pin_loads import Floats
from geometry import Pin, Segment


def graded(length: float, count: int) -> Floats:
    """Ends of rings, (count + 1,) m from 0 on, shorter towards both ends, where pressure rises."""
    return np.asarray(length * (1.0 - np.cos(np.linspace(0.0, np.pi, count + 1))) / 2.0)


def ring(connection: str, i: int) -> str:
    """Name of a ring's surface, i from 0 on."""
    return f"{connection} ring {i + 1}"


def ringed(pin: Pin, connections: Iterable[str], count: int) -> Pin:
    """The same shape with the bands of some connections cut into `count` rings each.

    A ring is cut where the band is, between its fillets: what a fillet takes stays plain.
    """
    wanted = set(connections)
    segments: list[Segment] = []
    for i, (s, band) in enumerate(zip(pin.segments, pin.bands, strict=True)):
        if s.connection not in wanted:
            segments.append(s)
            continue
        ends = [pin.stations[i], *(band.z0 + graded(band.length, count))[1:-1], pin.stations[i + 1]]
        parts = [
            replace(s, length=float(b - a), name=None, connection=ring(s.connection, k), fillet=0.0)
            for k, (a, b) in enumerate(pairwise(ends))
        ]
        parts[-1] = replace(parts[-1], fillet=s.fillet)
        segments += parts
    return replace(pin, segments=tuple(segments))


def annulus(pin: Pin, connection: str, outer_diameter: float, count: int) -> Pin:
    """A lug's eye, as a body of revolution from z = 0 on, whose bore has the rings of the band on
    which it bears.
    """
    band = pin.band(connection)
    segments = tuple(
        Segment(float(b - a), outer_diameter, 2.0 * band.radius, connection=ring(connection, k))
        for k, (a, b) in enumerate(pairwise(graded(band.length, count)))
    )
    return Pin(f"lug {connection}", segments)

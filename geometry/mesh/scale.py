"""The unit of length of a pin in gmsh and OpenCASCADE, whose tolerances are lengths.

Both merge points closer than 1e-7, in whatever unit, so that nothing would be left of a pin of one
micrometre. The unit is a power of two, so that scaling changes no digit of any dimension.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise

from geometry.shape.features import Cut
from geometry.shape.pin import Pin
from geometry.shape.recess import Recess

MIN_DIMENSION = 1e-4  # m; far enough above the tolerances of gmsh and OpenCASCADE
MAX_DIAMETER = 100.0  # m; up to this size they compute volumes to 1e-6


def unit_of(pin: Pin) -> float:
    """The unit (m) in which a pin's smallest diameter is about 1."""
    return float(2.0 ** round(math.log2(pin.smallest_diameter)))


def unit_of_solid(pin: Pin, cuts: Iterable[Cut] = ()) -> float:
    """The unit (m) for the solid of a pin with cuts.

    It is 1 where all dimensions suit metres, otherwise `unit_of`. Rounded mouths always use
    `unit_of`, because in metres OpenCASCADE succeeds only for every third. A pin with a recess uses
    the unit of the recess's solid.
    """
    small = [x for s in pin.segments for x in (s.length, *s.bores, *(w / 2 for w in s.walls))]
    small += [rounding.radius for rounding in pin.roundings]
    for left, right in pairwise(pin.segments):
        step, step_inside = left.diameters[1] - right.diameter, left.bores[1] - right.bore
        small += [abs(step) / 2, abs(step_inside) / 2]
    every = list(cuts)
    for cut in every:
        if isinstance(cut, Recess):
            return cut.unit
    for cut in every:
        if cut.undivided:
            return unit_of(pin)
        small += [cut.size, *(part.radius for part in cut.surfaces(pin))]
    fits = min(x for x in small if x) >= MIN_DIMENSION and pin.smallest_diameter <= MAX_DIAMETER
    return 1.0 if fits else unit_of(pin)

"""The bending moment by the formulas, compared with that of the joint model at the same instant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assess.situation import Situation
from assess.strength.section_forces import section_forces
from fea.beam.round_section import Circle, thinnest_section
from fea.support.records import Couple
from geometry import Band, Pin
from pinbase.dimensions import Time

MAX_OPPOSED_COSINE = -0.99  # largest cosine between the force of an outer and the middle lug
DOUBLE_SHEAR = "double shear"
LAYOUT_TOLERANCE = 0.05  # relative difference of the outer lugs in force, width and gap


@dataclass(frozen=True)
class BendingArms:
    """The largest bending moments along a pin at the governing instant.

    even, concentrated: with evenly distributed and with concentrated loads on the bands.
    joint: by the joint model `model` ("contact", "foundation"), if the pin is supported by one.
    layout: the layout of the bands, in words.
    """

    pin: str
    case: str
    time: Time | None
    layout: str
    even: Couple
    concentrated: Couple
    joint: Couple | None = None
    model: str = ""


def bending_arms(s: Situation, joint: Couple | None, model: str) -> BendingArms:
    """Return the bending moments of a situation with a single instant.

    joint: the moment by the joint model; None if there is none. model: the name of that model.
    """
    even, concentrated = section_forces(s)
    return BendingArms(
        s.pin.name,
        s.loads.case,
        s.loads.time(),
        layout(s),
        float(even.moment.max()),
        float(concentrated.moment.max()),
        joint,
        model,
    )


def in_double_shear(s: Situation) -> bool:
    """Whether the pin is in symmetrical double shear at every instant with a notable force."""
    size = s.across.max(axis=1)
    loaded = np.flatnonzero(size > LAYOUT_TOLERANCE * size.max())
    return all(layout(s, int(t)) == DOUBLE_SHEAR for t in loaded)


def sections_between(pin: Pin, first: Band, last: Band) -> set[Circle]:
    """Return the sections of a pin from one band to another, both included; the thinnest section of
    a cone.
    """
    stations = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
    return {
        thinnest_section(segment, 0.0, segment.length)
        for segment, z0, z1 in stations
        if z1 > first.z0 and z0 < last.z1
    }


def outer_and_gap(first: Band, middle: Band, last: Band) -> tuple[float, float]:
    """Return the thickness of the thicker outer lug and the wider gap in double shear, m."""
    gap = max(middle.z0 - first.z1, last.z0 - middle.z1)
    return max(first.length, last.length), gap


def layout(s: Situation, instant: int = 0) -> str:
    """Return the layout of the bands at an instant, in words. instant: its number.

    The layout is DOUBLE_SHEAR where the moment with even loads is that of EN 1993-1-8, figure 3.11.
    """
    if s.clamps:
        return "clamped"
    bands = sorted((s.pin.band(n) for n in s.loads.surfaces), key=lambda b: b.z0)
    order = [s.loads.surfaces.index(b.name) for b in bands]
    force = s.loads.forces[instant, order, :2]
    if len(bands) == 2:
        return "single shear"
    if len(bands) != 3 or not _opposed(force):
        return f"{len(bands)} bands"
    left, middle, right = bands
    size = np.hypot(*force.T)
    pairs = (
        (size[0], size[2]),
        (left.length, right.length),
        (middle.z0 - left.z1, right.z0 - middle.z1),
    )
    same = all(abs(a - b) <= LAYOUT_TOLERANCE * max(a, b) for a, b in pairs)
    return DOUBLE_SHEAR if same else f"{DOUBLE_SHEAR}, not symmetrical"


def _opposed(force: np.ndarray) -> bool:
    """Whether the middle one of three forces (3, 2) opposes both others."""
    size = np.hypot(*force.T)
    if not size.all():
        return False
    along = force / size[:, None]
    return bool(max(along[0] @ along[1], along[2] @ along[1]) <= MAX_OPPOSED_COSINE)

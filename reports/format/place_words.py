"""The place of the largest stress of a pin, and the internal force that governs there, in words."""

from __future__ import annotations

import math
from itertools import pairwise

from assess.diameter_law import BENDING_EXPONENT, SHEAR_EXPONENT
from reports.data.results import CutShape, PinShape
from reports.data.row import PinResult

NEAR_STEP = 0.1  # of the diameter; places nearer to a step or a cut are named after it
OFF_SURFACE = 1e-3  # of the radius; deeper points are on the wall of a cut


def action(row: PinResult) -> str:
    """Return the internal force that causes most of the stress of the governing section.

    The text is empty for a pin without sections, or without stress in them.
    """
    section = row.places.section if row.places else None
    if section is None or not section.max_von_mises:
        return ""
    if section.torque > max(section.bending_moment, 0.0) and section.torque > 0.0:
        return "torsion"
    middle = 0.5 * (BENDING_EXPONENT + SHEAR_EXPONENT)
    if row.exponent > middle:
        return "bending"
    return "shear" if section.shear_force > abs(section.axial_force) else "axial force"


def place_words(row: PinResult, shape: PinShape | None) -> str:
    """Return the place of a row's maximum: "shear between F1 and F2", "surface, step beside E2",
    "surface, hole 1".

    The text is empty for a row without stress.
    """
    if row.places is None or row.location is None or not row.max_von_mises:
        return ""
    section = row.places.section
    governs = row.places.governs
    z = section.z if governs == "section" and section else row.location[2]
    kind = row.places.governing
    kind = action(row) if kind == "section" else kind
    if kind == "surface" and shape is not None and (cut := cut_at(shape, row.location)):
        return f"surface, {cut}"
    where = "" if shape is None else along_words(shape, z)
    comma = "," if where.startswith(("step", "a step")) else ""
    return f"{kind}{comma} {where}".strip()


def cut_at(shape: PinShape, location: tuple[float, ...]) -> str:
    """Return the name of the cut on whose wall, or beside whose mouth, a point of the surface lies;
    empty if there is none.
    """
    x, y, z = location
    outer, bore = _radii(shape, z)
    reach = 2.0 * NEAR_STEP * outer
    away = dict[str, float]()  # distances from the mouths, along the circumference
    for cut in shape.cuts:
        (low, high), half = cut.z, _half_width(cut, outer)
        ends = half if low == high else 0.0
        if low - ends - reach <= z <= high + ends + reach:
            turn = math.degrees(math.atan2(y, x)) - cut.angle
            period = 180.0 if cut.depth is None and cut.name.startswith(("hole", "slot")) else 360.0
            away[cut.name] = math.radians(abs(math.remainder(turn, period))) * outer - half
    if not away:
        return ""
    name = min(away, key=lambda each: away[each])
    r = math.hypot(x, y)
    on_wall = bore * (1.0 + OFF_SURFACE) < r < outer * (1.0 - OFF_SURFACE)
    return name if on_wall or away[name] <= reach else ""


def _radii(shape: PinShape, z: float) -> tuple[float, float]:
    """Return the outer radius of a pin at z, and that of its bore."""
    start, at = 0.0, (0.0, 0.0)
    for k, (length, diameter, bore, *_) in enumerate(shape.segments):
        if start <= z or not k:
            far = shape.far_ends[k] if shape.far_ends else (diameter, bore)
            part = min(max((z - start) / length, 0.0), 1.0)
            at = diameter + part * (far[0] - diameter), bore + part * (far[1] - bore)
        start += length
    return at[0] / 2.0, at[1] / 2.0


def _half_width(cut: CutShape, outer: float) -> float:
    """Return half of the width of a cut's mouth along the circumference."""
    if cut.name.startswith("flat"):
        return outer * math.acos(min(cut.size / outer, 1.0))
    return cut.size / 2.0


def along_words(shape: PinShape, z: float) -> str:
    """Return the position of z along a pin: "step beside E2", "under E2", "between E1 and E2",
    "beside root".
    """
    ends, start = [], 0.0
    for length, *_ in shape.segments:
        ends.append((start, start + length))
        start += length
    named = [
        (low, high, label)
        for (low, high), (_, _, _, label, kind) in zip(ends, shape.segments, strict=True)
        if kind in ("band", "held") and label
    ]
    for (_, high), (one, other) in zip(ends, pairwise(shape.segments), strict=False):
        thin = min(one[1], other[1])
        if one[1] != other[1] and abs(z - high) <= NEAR_STEP * thin:
            beside = [label for low, top, label in named if high in (low, top)]
            nearest = beside or [min(named, key=lambda n: min(abs(n[0] - z), abs(n[1] - z)))[2]]
            return f"step beside {nearest[0]}" if named else "a step"
    for low, high, label in named:
        if low < z < high:
            return f"under {label}"
    before = [label for _, high, label in named if high <= z]
    after = [label for low, _, label in named if low >= z]
    if before and after:
        return f"between {before[-1]} and {after[0]}"
    return f"beside {(before[-1:] or after[:1])[0]}" if named else ""

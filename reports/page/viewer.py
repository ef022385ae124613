"""The data of the interactive 3D view of a pin."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from markupsafe import Markup

from pinbase.dimensions import Floats
from reports.data.decision import common_factor
from reports.data.results import PinShape, Results
from reports.data.row import PinResult
from reports.data.surface import SURFACE_SECTORS, HalfSection, LoadCourse, Surface, SurfaceCase
from reports.format.drawing.camera import View
from reports.format.numbers import DASH, engineering
from reports.format.packed import packed
from reports.format.ranges import error_words, factor_range
from reports.format.script_json import script_json
from reports.format.words import verdict_words
from reports.tables.column import Column, Grid, Table, read_only

MAX_LOAD_INTEGER = 32767  # loads are stored as integers up to this, scaled by the largest
# The same for stresses, scaled by the largest at a point; thinning has an error of 8e-3 of it.
MAX_STRESS_INTEGER = 4095
# The same for displacements, which only the deformed shape shows.
MAX_DISPLACEMENT_INTEGER = 127
MAX_SECTION_INTEGER = 4095  # the same for stresses on a section, scaled by their maximum
PRESSURE_PERCENTILE = 90.0  # per cent of the pressed cells are within the range of colours
# Of the maximum; if the whole surface is below this share, the maximum is inside the pin.
SURFACE_MAXIMUM_SHARE = 0.999
Segment = tuple[str, float, float]  # name, start z, end z


@dataclass(frozen=True)
class PinView:
    """A 3D view of a pin.

    opens: index of the case shown first.
    moving: whether any case has a motion.
    factors: whether there is a yield strength.
    pressed, sections: whether any case has contact pressure, or a section.
    along: the maxima along the pin.
    """

    pin: str
    cases: tuple[str, ...]
    opens: int
    moving: bool
    factors: bool
    pressed: bool
    sections: bool
    data: Markup
    along: Grid | None


def pin_views(results: Results, pin: str) -> list[PinView]:
    """Return the 3D view of a pin in all its cases; empty where no model has fields."""
    surfaces = [s for s in results.surfaces if s.pin == pin]
    if not surfaces:
        return []
    results_by_case = {p.case: p for p in results.pins if p.pin == pin}
    order = {case: k for k, case in enumerate(results_by_case)}
    shown = sorted(
        ((c, k, s) for k, s in enumerate(surfaces) for c in s.cases), key=lambda x: order[x[0].case]
    )
    cases = [c for c, _, _ in shown]
    shape = next((s for s in results.shapes if s.pin == pin), None)
    opens = _governing([results_by_case[c.case] for c in cases])
    box = _box(surfaces[0])
    data = {
        "units": vars(results.units),
        "strength": surfaces[0].yield_strength,
        "required": common_factor(results_by_case.values()),
        "surfaces": [_surface(s) for s in surfaces],
        "cases": [
            _case(c, results_by_case[c.case], k, s) | _row(results_by_case[c.case], results)
            for c, k, s in shown
        ],
        "opens": opens,
        "box": box.tolist(),
        "centre": (0.5 * (box[0] + box[-1])).tolist(),
        "size": float(np.ptp(box, axis=0).max()),
    }
    return [
        PinView(
            pin=pin,
            cases=tuple(c.case for c in cases),
            opens=opens,
            moving=any(c.times is not None for c in cases),
            factors=surfaces[0].yield_strength is not None,
            pressed=any(c.pressure is not None for c in cases),
            sections=any(c.section is not None for c in cases),
            data=script_json(data),
            along=None if shape is None else _along(results, shape, shown),
        )
    ]


def _governing(pins: list[PinResult]) -> int:
    """Return the index of the case with the lowest safety factor, or else the largest stress."""
    factors = [inf if p.safety_factor is None else p.safety_factor for p in pins]
    return min(range(len(pins)), key=lambda k: (factors[k], -(pins[k].max_von_mises or 0.0)))


def _surface(surface: Surface) -> dict[str, Any]:
    largest = _largest(surface)
    # Scaled to stress, so that rounding is relative to the stress of each point, not of the pin.
    stress, moved = surface.stress * largest, surface.displacement * largest
    peaks = np.abs(stress).max(axis=(1, 2), initial=0.0)
    longest = np.abs(moved).max(axis=(0, 1), initial=0.0)
    return {
        "sectors": SURFACE_SECTORS if surface.revolved else 1,
        "points": packed(surface.points, "<f4"),
        "triangles": None if surface.revolved else packed(surface.triangles, "<u4"),
        "n": surface.n.tolist(),
        "even": [int(e) for e in surface.even],
        "stress": packed(
            np.rint(_parts(stress, peaks[:, None, None], MAX_STRESS_INTEGER)).T, "<i2"
        ),
        "stress_scale": packed(peaks / MAX_STRESS_INTEGER, "<f4"),
        "moved": packed(np.rint(_parts(moved, longest, MAX_DISPLACEMENT_INTEGER)).T, "<i1"),
        "moved_scale": packed(longest / MAX_DISPLACEMENT_INTEGER, "<f4"),
    }


def _largest(surface: Surface) -> Floats:
    """Return the largest amount of each unit load (K,) over all cases; 1 for a load that never
    acts.
    """
    every = np.concatenate([c.amounts for c in surface.cases])
    largest = np.abs(every).max(axis=(0, 2), initial=0.0)
    return np.where(largest > 0.0, largest, 1.0)


def _case(case: SurfaceCase, pin: PinResult, number: int, surface: Surface) -> dict[str, Any]:
    on_surface = float(case.largest[~case.excluded].max(initial=0.0))
    # The maximum of the solid model is a mean over rotations of the loads.
    error = sum(pin.error_parts.values())
    most = float(case.maxima[case.instant]) if surface.revolved else (pin.max_von_mises or 0.0)
    least = SURFACE_MAXIMUM_SHARE * most - (0.0 if surface.revolved else error)
    location = case.location or pin.maximum.location
    amounts = case.amounts / _largest(surface)[:, None]
    scale = np.abs(amounts).max(axis=(0, 2), initial=0.0)
    return {
        "name": case.case,
        "surface": number,
        "times": None if case.times is None else [float(f"{t:.7g}") for t in case.times],
        "instant": case.instant,
        "maxima": _short(case.maxima, case.instant),
        "verdict": verdict_words(pin.verdict, pin.yields),
        "location": location,
        "beneath": on_surface < least and case.unread is None,
        "zoned": bool(case.excluded.any() or len(case.zones)),
        "zones": case.zones.tolist(),
        "excluded": None if surface.revolved else packed(case.excluded, "u1"),
        "unread": None if case.unread is None else packed(np.packbits(case.unread), "u1"),
        "pressure": _pressure(case),
        "loads": [_load(load) for load in case.loads],
        "section": None if case.section is None else _section(case.section),
        "turn": _turn(_box(surface), location),
        "amounts": packed(np.rint(_parts(amounts, scale[:, None], MAX_LOAD_INTEGER)).T, "<i2"),
        "amounts_scale": (scale / MAX_LOAD_INTEGER).tolist(),
    }


def _row(pin: PinResult, results: Results) -> dict[str, str]:
    """Return the error and factor of the surface's largest stress at the row's instant.

    If section or core governs, a sentence states this instead of the factor.
    """
    places = pin.places
    if places is None or places.section is None or places.governs == "surface":
        return {"error": error_words(pin), "factor": factor_range(pin), "row": ""}
    units, surface, by_section = results.units, places.surface, places.section
    place = f"section at z = {engineering(by_section.z)} {units.length}"
    if places.governs == "core":
        depth = places.hardened[0].depth
        place = f"core, {engineering(depth, 2)} {units.length} beneath the surface,"
    return {
        "error": f"± {engineering(surface.error_estimate, 2)}",
        "factor": "",
        "row": f"The {place} governs: "
        f"{engineering(pin.max_von_mises)} {units.stress} ({error_words(pin)}), "
        f"safety factor {factor_range(pin)}.",
    }


def _short(maxima: Floats, instant: int) -> list[float]:
    """Return the maxima with seven digits, the governing one with all digits."""
    rounded = [float(f"{value:.7g}") for value in maxima]
    rounded[instant] = float(maxima[instant])
    return rounded


def _load(load: LoadCourse) -> dict[str, Any]:
    scale = float(np.abs(load.forces).max(initial=0.0)) / MAX_LOAD_INTEGER or 1.0
    return {
        "name": load.connection,
        "z": load.z,
        "radius": load.radius,
        "held": load.held,
        "forces": packed(np.rint(load.forces / scale), "<i2"),
        "scale": scale,
    }


def _section(section: HalfSection) -> dict[str, Any]:
    largest = float(section.von_mises.max())
    return {
        "angle": section.angle,
        "z": packed(section.z, "<f4"),
        "inner": packed(section.inner, "<f4"),
        "outer": packed(section.outer, "<f4"),
        "part": packed(section.part, "<f4"),
        "values": packed(
            np.rint(_parts(section.von_mises, np.asarray(largest), MAX_SECTION_INTEGER)), "<u2"
        ),
        "scale": largest / MAX_SECTION_INTEGER,
    }


def _pressure(case: SurfaceCase) -> dict[str, Any] | None:
    if case.pressure is None or case.rings is None:
        return None
    return {
        "sectors": case.pressure.shape[1],
        "first": case.first,
        "top": _top(case.pressure),
        "rings": packed(case.rings, "<i2"),
        "cells": packed(case.pressure, "<f4"),
    }


def _top(pressure: Floats) -> float:
    """Return the pressure at the end of the colour scale.

    Higher pressures are in cells at the edges of lugs, where pressure depends on the size of the
    cells.
    """
    some = pressure[pressure > 0.0]
    return float(np.percentile(some, PRESSURE_PERCENTILE)) if len(some) else 0.0


def _turn(box: Floats, location: tuple[float, ...] | None) -> list[list[float]]:
    """Return three rows: right, up and towards the viewer, who faces the maximum."""
    view = View.of(box, np.asarray(location))
    towards = view.eye - view.centre
    towards /= np.linalg.norm(towards)
    rows: list[list[float]] = np.stack([np.cross(view.up, towards), view.up, towards]).tolist()
    return rows


def _box(surface: Surface) -> Floats:
    """Return the corners (8, 3) of the box around the surface."""
    low, high = surface.points.min(axis=0), surface.points.max(axis=0)
    if surface.revolved:
        r = high[0]
        low, high = np.array([-r, -r, low[2]]), np.array([r, r, high[2]])
    both = np.stack([low, high])
    return np.array([[both[i, 0], both[j, 1], both[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])


def _along(
    results: Results, shape: PinShape, shown: list[tuple[SurfaceCase, int, Surface]]
) -> Grid:
    """Return the largest stress on each segment's surface outside excluded zones, and its place,
    for every case at its governing instant.
    """
    columns: list[Column[Segment]] = [
        read_only("segment", lambda row: row[0] or DASH, numeric=False),
        read_only("z from", lambda row: row[1], "length"),
        read_only("to", lambda row: row[2], "length"),
    ]

    def most(case: SurfaceCase, surface: Surface, k: int) -> Callable[[Segment], float | None]:
        return lambda row: _most(case, surface.points[:, 2], *row[1:])[k]

    for case, _, surface in shown:
        columns += [
            read_only(f"{case.case}: maximum", most(case, surface, 0), "stress"),
            read_only("at z", most(case, surface, 1), "length"),
        ]
    rows, at = [], float(shown[0][2].points[:, 2].min())
    for length, _, _, label, _ in shape.segments:
        rows.append((label, at, at + length))
        at += length
    return Table("along", columns, rows).grid(results.units)


def _most(
    case: SurfaceCase, z: Floats, low: float, high: float
) -> tuple[float | None, float | None]:
    """Return the largest stress between two values of z, and its z."""
    little = 1e-6 * float(np.ptp(z))
    here = np.flatnonzero((z >= low - little) & (z <= high + little) & ~case.excluded)
    if not len(here):
        return None, None
    most = here[case.largest[here].argmax()]
    return float(case.largest[most]), float(z[most])


def _parts(values: Floats, largest: Floats, whole: int) -> Floats:
    """Return the values scaled to `whole` at `largest`, not rounded."""
    return np.asarray(whole * values / np.where(largest > 0.0, largest, 1.0))

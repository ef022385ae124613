"""The interactive 3D view of a pin: its data for the page."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup

from reports.animation.player_data import script_json
from reports.data.results import Floats, PinResult, Results
from reports.data.surface import Surface, SurfaceCase
from reports.format.camera import View
from reports.format.ranges import error_words, factor_range
from reports.format.words import verdict_words

SECTORS = 72  # of a body of revolution
WHOLE = 32767  # fields are integers up to this, scaled by the largest value at a point
BENEATH = 0.999  # of the maximum; if the whole surface is below it, the maximum is inside


@dataclass(frozen=True)
class PinView:
    """A 3D view: its cases, whether any has a motion, whether there is a yield strength, whether
    any case has contact pressure.
    """

    pin: str
    cases: tuple[str, ...]
    moving: bool
    factors: bool
    pressed: bool
    data: Markup


def pin_views(results: Results, pin: str) -> list[PinView]:
    """The 3D views of a pin, one for each mesh on which its cases were solved."""
    found = {p.case: p for p in results.pins if p.pin == pin}
    return [
        PinView(
            pin=pin,
            cases=tuple(c.case for c in surface.cases),
            moving=any(c.times is not None for c in surface.cases),
            factors=surface.yield_strength is not None,
            pressed=any(c.pressure is not None for c in surface.cases),
            data=script_json(_data(surface, found, results)),
        )
        for surface in results.surfaces
        if surface.pin == pin
    ]


def _data(surface: Surface, found: dict[str, PinResult], results: Results) -> dict[str, Any]:
    every = np.concatenate([c.amounts for c in surface.cases])
    largest = np.abs(every).max(axis=(0, 2), initial=0.0)
    largest[largest == 0.0] = 1.0
    # In units of stress: a point's error is a part of the point's own stress, not of the pin's.
    stress, moved = surface.stress * largest, surface.displacement * largest
    each = np.abs(stress).max(axis=(1, 2), initial=0.0)
    longest = np.asarray(np.abs(moved).max(initial=0.0))
    box = _box(surface)
    return {
        "units": {"stress": results.units.stress, "time": results.units.time},
        "strength": surface.yield_strength,
        "sectors": SECTORS if surface.revolved else 1,
        "points": _packed(surface.points, "<f4"),
        "triangles": None if surface.revolved else _packed(surface.triangles, "<u4"),
        "n": surface.n.tolist(),
        "even": [int(e) for e in surface.even],
        "stress": _packed(np.rint(_parts(stress, each[:, None, None])), "<i2"),
        "stress_scale": _packed(each / WHOLE, "<f4"),
        "moved": _packed(np.rint(_parts(moved, longest)), "<i2"),
        "moved_scale": float(longest) / WHOLE,
        "cases": [
            {
                **_case(c, found[c.case], surface.revolved),
                "turn": _turn(box, found[c.case]),
                "amounts": _packed(c.amounts / largest[:, None], "<f4"),
            }
            for c in surface.cases
        ],
        "box": box.tolist(),
        "centre": (0.5 * (box[0] + box[-1])).tolist(),
        "size": float(np.ptp(box, axis=0).max()),
    }


def _case(case: SurfaceCase, pin: PinResult, revolved: bool) -> dict[str, Any]:
    on_surface = float(case.largest[~case.excluded].max(initial=0.0))
    # The solid model's maximum is a mean over directions of the loads.
    error = sum(pin.error_parts.values())
    least = BENEATH * (pin.max_von_mises or 0.0) - (0.0 if revolved else error)
    return {
        "name": case.case,
        "times": None if case.times is None else case.times.tolist(),
        "instant": case.instant,
        "maxima": case.maxima.tolist(),
        "error": error_words(pin),
        "factor": factor_range(pin),
        "verdict": verdict_words(pin.verdict, pin.yields),
        "location": pin.location,
        "beneath": on_surface < least,
        "zoned": bool(case.excluded.any()),
        "excluded": _packed(case.excluded, "u1"),
        "pressure": _pressure(case),
    }


def _pressure(case: SurfaceCase) -> dict[str, Any] | None:
    if case.pressure is None or case.rings is None:
        return None
    return {
        "sectors": case.pressure.shape[1],
        "largest": float(case.pressure.max()),
        "rings": _packed(case.rings, "<i2"),
        "cells": _packed(case.pressure, "<f4"),
    }


def _turn(box: Floats, pin: PinResult) -> list[list[float]]:
    """Rows right, up and towards the viewer; the maximum faces the viewer."""
    view = View.of(box, np.asarray(pin.location))
    towards = view.eye - view.centre
    towards /= np.linalg.norm(towards)
    rows: list[list[float]] = np.stack([np.cross(view.up, towards), view.up, towards]).tolist()
    return rows


def _box(surface: Surface) -> Floats:
    """Corners (8, 3) around the surface."""
    low, high = surface.points.min(axis=0), surface.points.max(axis=0)
    if surface.revolved:
        r = high[0]
        low, high = np.array([-r, -r, low[2]]), np.array([r, r, high[2]])
    both = np.stack([low, high])
    return np.array([[both[i, 0], both[j, 1], both[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])


def _parts(values: Floats, largest: Floats) -> Floats:
    """Values scaled to `WHOLE` at `largest`, not rounded."""
    return np.asarray(WHOLE * values / np.where(largest > 0.0, largest, 1.0))


def _packed(values: np.ndarray[Any, Any], kind: str) -> str:
    return b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")

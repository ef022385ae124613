"""A made-up pin in contact with three lugs, for all tests of its tables and drawings."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from fea.support.records import BandContact, JointRange, JointResult, Variation
from reports.data.results import Results
from reports.data.surface import Surface, SurfaceCase
from tests.support.results.rows import with_values

RANGE = (1100.0, 1900.0)


def make_joint(over: bool = True) -> JointResult:
    """Return a contact with two rings in each band; the left lug also presses on the other side."""
    starts = {"left": 0.0, "middle": 1.25, "right": 3.5}
    bands = tuple(
        BandContact(
            name=name,
            force=400.0 if name == "middle" else 200.0,
            contact_angle=81.25,
            mean_pressure=987.6,
            line_load=((z + 0.25, 300.0), (z + 0.75, -100.0 if name == "left" else 100.0)),
            couple=12.5,
            clearance=0.0015,
            outer_diameter=2.5,
            ends=(z, z + 0.5, z + 1.0),
        )
        for name, z in starts.items()
    )
    moments = ((0.0, 0.0), (1.5, 80.0), (2.0, 123.4), (4.5, 0.0))
    return JointResult("contact", bands, 123.4, moments, joint_range() if over else None)


def joint_range() -> JointRange:
    return JointRange(
        RANGE,
        (
            Variation("clearance", "none", 1100.0, 0.0),
            Variation("clearance", "twice the given", 1500.0, 0.003),
            Variation("tilt", "guided", 1900.0),
        ),
    )


def in_lugs(results: Results, joint: JointResult, **changes: object) -> Results:
    """Return the results with this contact, and other changes, in the first pin's row."""
    changes |= {"error_parts": {"mesh": 5.0, "time": 0.0, "cells": 1.0}}
    first = with_values(results.pins[0], joint=joint, **changes)
    return replace(results, pins=(first, *results.pins[1:]))


def surface_in(case: str, pressure: tuple[Any, Any] = (None, None)) -> Surface:
    """Return a meridian of three points with one unit load."""
    one = SurfaceCase(
        case, None, 0, np.ones((1, 1, 2)), np.ones(1), np.zeros(3, bool), np.ones(3), *pressure
    )
    even = (True, True, True, False, False, True, False, True)
    return Surface(
        "A", np.array([[1.0, 0, 0], [1, 0, 1], [1, 0, 2]]), np.zeros((0, 3), np.int64),
        np.zeros(1, np.int64), even, np.ones((3, 5, 1)), np.ones((3, 3, 1)), None, (one,),
    )  # fmt: skip

"""Rows of results with any values, including combinations that no run has."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from assess.judgement import Judgement
from fea.core.peak import ErrorParts, Maximum
from fea.core.pin_loads import PinLoads
from reports.data.results import Results
from reports.data.row import LandingRange, PinResult

MAXIMUM_NAMES = {f.name: f.name for f in fields(Maximum)} | {"max_von_mises_interval": "interval"}
JUDGEMENT_NAMES = {f.name: f.name for f in fields(Judgement)} | {
    "safety_factor_interval": "interval"
}


def with_values(row: PinResult, **values: Any) -> PinResult:
    """Return the row with other values of its fields, or of the properties taken from its maximum
    or judgement.
    """
    if "time" in values:
        time = values.pop("time")
        at = None if time is None else np.array([time])
        values["governing"] = PinLoads("", (), np.zeros((1, 0, 3)), times=at)
    if "error_parts" in values:
        values["parts"] = ErrorParts(**values.pop("error_parts"))
    of_maximum = {MAXIMUM_NAMES[k]: values.pop(k) for k in [*values] if k in MAXIMUM_NAMES}
    of_judgement = {JUDGEMENT_NAMES[k]: values.pop(k) for k in [*values] if k in JUDGEMENT_NAMES}
    return replace(
        row,
        maximum=replace(row.maximum, **of_maximum),
        judgement=replace(row.judgement, **of_judgement),
        **values,
    )


def row_with(pin: str, case: str, **values: Any) -> PinResult:
    """Return a row with these values of its fields and properties."""
    return with_values(PinResult(Maximum(pin, case, "solid", "converged", "")), **values)


def with_landing(results: Results, *ranges: LandingRange) -> Results:
    """Return the results with the ranges of a landing in the rows of their pins and cases; a row
    that does not exist is appended.
    """
    rows = {(p.pin, p.case): p for p in results.pins}
    for r in ranges:
        required = results.required_safety_factor
        row = rows.get((r.pin, r.case)) or row_with(r.pin, r.case, required=required)
        rows[r.pin, r.case] = replace(row, landing=r)
    return replace(results, pins=tuple(rows.values()))

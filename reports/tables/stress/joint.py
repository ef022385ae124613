"""Pins in their lugs: tables, JSON, and the range of the maximum over the joint."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fea.support.records import JointRange, JointResult
from reports.data.results import PinResult, Results
from reports.format.files.csv import Cell
from reports.format.numbers import finite
from reports.tables.table import Table

BAND_COLUMNS = (
    *("pin", "case", "connection", "force", "contact_angle", "mean_pressure", "couple"),
    *("clearance", "outer_diameter", "length_unit", "force_unit", "stress_unit"),
    "bearing_share",
)
LINE_LOAD_COLUMNS = (
    *("pin", "case", "connection", "z", "line_load", "length_unit", "force_unit"),
    *("z_start", "z_end"),
)
RANGE_COLUMNS = (
    *("pin", "case", "what", "value", "max_von_mises", "stress_unit"),
    *("length", "length_unit", "model", "lugs", "max_von_mises_low", "max_von_mises_high"),
    "beneath",
)


def joint_tables(results: Results) -> list[Table]:
    """Of all pins in lugs: their bands, the load per length along these, and the maximum with the
    joint changed.
    """
    return [
        Table.of("joint_bands", BAND_COLUMNS, _bands(results)),
        Table.of("line_loads", LINE_LOAD_COLUMNS, _lines(results)),
        Table.of("joint_range", RANGE_COLUMNS, _ranges(results)),
    ]


def joint_json(joint: JointResult | None) -> dict[str, Any] | None:
    """As results.json has it."""
    if joint is None:
        return None
    over = joint.range
    return {
        "model": joint.model,
        "bands": [
            {
                "name": band.name,
                "force": finite(band.force),
                "contact_angle": finite(band.contact_angle),
                "mean_pressure": finite(band.mean_pressure),
                "couple": finite(band.couple),
                "clearance": finite(band.clearance),
                "outer_diameter": finite(band.outer_diameter),
                "line_load": [[finite(z), finite(load)] for z, load in band.line_load],
                "ends": [finite(z) for z in band.ends],
            }
            for band in joint.bands
        ],
        "bending_moment": finite(joint.bending_moment),
        "bending_moments": [[finite(z), finite(m)] for z, m in joint.bending_moments],
        "remark": joint.remark,
        "range": over
        and {
            "max_von_mises": [finite(x) for x in over.max_von_mises],
            "model": over.model,
            "lugs": lugs_word(over),
            "over": [
                {
                    "what": v.what,
                    "value": v.value,
                    "length": finite(v.length),
                    "max_von_mises": finite(v.max_von_mises),
                    "max_von_mises_interval": v.interval and [finite(x) for x in v.interval],
                    "beneath": finite(v.beneath),
                }
                for v in over.variations
            ],
        },
    }


def lugs_word(over: JointRange) -> str:
    """Whose the lugs of a range are."""
    return "assumed" if over.assumed else "study"


def _joined(results: Results) -> Iterator[tuple[PinResult, JointResult]]:
    return ((pin, pin.joint) for pin in results.pins if pin.joint is not None)


def _bands(results: Results) -> Iterator[list[Cell]]:
    u = results.units
    for pin, joint in _joined(results):
        contact = pin.places.contact if pin.places else None
        shares = {b.name: b.bearing_share for b in contact.bands} if contact else {}
        for b in joint.bands:
            yield [
                *(pin.pin, pin.case, b.name, b.force, b.contact_angle, b.mean_pressure),
                *(b.couple, b.clearance, b.outer_diameter, u.length, u.force, u.stress),
                shares.get(b.name),
            ]


def _lines(results: Results) -> Iterator[list[Cell]]:
    u = results.units
    for pin, joint in _joined(results):
        for band in joint.bands:
            none = (None,) * len(band.line_load)
            rings = zip(band.line_load, band.ends[:-1] or none, band.ends[1:] or none, strict=True)
            for (z, load), start, end in rings:
                yield [pin.pin, pin.case, band.name, z, load, u.length, u.force, start, end]


def _ranges(results: Results) -> Iterator[list[Cell]]:
    u = results.units
    for pin, joint in _joined(results):
        if joint.range is None:
            continue
        by = joint.range.model, lugs_word(joint.range)
        for v in joint.range.variations:
            unit = None if v.length is None else u.length
            yield [
                *(pin.pin, pin.case, v.what, v.value, v.max_von_mises, u.stress, v.length, unit),
                *(*by, *(v.interval or (None, None)), v.beneath),
            ]

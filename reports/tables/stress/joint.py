"""Pins in their lugs: tables, JSON, and the range of the maximum over the joint."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from fea.support.records import BandContact, JointRange, JointResult, LugStress, Variation
from reports.data.results import Results
from reports.format.numbers import short
from reports.format.ranges import used_text
from reports.tables.column import (
    PIN_AND_CASE,
    Column,
    PinRow,
    Table,
    digits,
    fields,
    headed,
    json_of,
    texts,
    unit_columns,
)


@dataclass(frozen=True)
class LoadStep:
    """The load per length of a band at z.

    z_start, z_end: the ends of its ring; None for models without rings.
    """

    band: str
    z: float
    line_load: float
    z_start: float | None
    z_end: float | None


def bearing_share(row: PinRow[BandContact]) -> float | None:
    """Return the fraction of its bearing strength that a band uses."""
    contact = row.pin.places.contact if row.pin.places else None
    shares = {b.name: b.bearing_share for b in contact.bands} if contact else {}
    return shares.get(row.of.name)


def carrying_share(row: PinRow[BandContact]) -> float | None:
    """Return the fraction of a band's length along which the lug pushes in the direction of its
    force.

    The result is None where the load is not given by rings, or there is no force.
    """
    band = row.of
    if not band.ends or not band.force:
        return None
    rings = zip(band.ends, band.ends[1:], band.line_load, strict=False)
    return sum(b - a for a, b, (_, q) in rings if q > 0.0) / (band.ends[-1] - band.ends[0])


def _range(row: PinRow[Variation]) -> JointRange:
    assert row.pin.joint is not None
    assert row.pin.joint.range is not None
    return row.pin.joint.range


SHARE_SHOWN: dict[str, Any] = {"show": used_text, "drop_if_empty": True}  # options of columns
BAND_COLUMNS: list[Column[PinRow[BandContact]]] = [
    *PIN_AND_CASE,
    *texts("connection=of.name"),
    *headed("of.force", "force"),
    *fields("of.contact_angle", "degrees", heading="half contact angle", show=digits(3)),
    *headed("of.mean_pressure", "stress"),
    *fields("of.couple", "moment", heading="couple on the link"),
    *headed("of.clearance of.outer_diameter", "length", show=short),
    *unit_columns("length force stress"),
    Column("friction", lambda row: row.of.friction or None, "", "friction", drop_if_empty=True),
    *fields("of.friction_torque", "moment", heading="torque by friction", drop_if_empty=True),
    Column("carrying_share", carrying_share, heading="carries over", **SHARE_SHOWN),
    Column("bearing_share", bearing_share, heading="of bearing strength", **SHARE_SHOWN),
]
LINE_LOAD_COLUMNS: list[Column[PinRow[LoadStep]]] = [
    *PIN_AND_CASE,
    *fields("connection=of.band"),
    *fields("of.z", "length"),
    *fields("of.line_load", "force per length"),
    *unit_columns("length force"),
    *fields("of.z_start of.z_end", "length"),
]
RANGE_COLUMNS: list[Column[PinRow[Variation]]] = [
    *PIN_AND_CASE,
    *fields("of.what of.value"),
    *fields("of.max_von_mises", "stress"),
    *unit_columns("stress"),
    *fields("of.length", "length"),
    Column("length_unit", lambda row: None if row.of.length is None else row.pin.units.length),
    Column("model", lambda row: _range(row).model),
    Column("lugs", lambda row: lugs_word(_range(row))),
    *fields("max_von_mises_low=of.interval?.0 max_von_mises_high=of.interval?.1", "stress"),
    *fields("of.beneath", "stress"),
]


def _limit_load(row: PinRow[LugStress]) -> float | None:
    """Return the lower end of the limit load of a row's lug, a force, if it was computed."""
    lug = row.of.connection
    return next((x.lower for x in row.pin.lug_collapses if x.connection == lug), None)


LUG_COLUMNS: list[Column[PinRow[LugStress]]] = [
    *PIN_AND_CASE,
    *texts("connection=of.connection wall=of.wall place=of.place"),
    *fields("of.max_von_mises", "stress", heading="max von Mises"),
    *fields("of.error_estimate", "stress", heading="±"),
    *fields("of.max_hoop_stress", "stress", heading="hoop stress"),
    *fields("of.angle", "degrees", heading="angle from the shank"),
    *headed("of.z", "length"),
    *headed("of.time", "time", drop_if_empty=True),
    *fields("of.safety_factor", heading="factor of safety"),
    Column("interface", lambda row: row.of.interface or None, "", "interface", drop_if_empty=True),
    *fields("of.other_interface", "stress", heading="with the other interface", drop_if_empty=True),
    *headed("of.interference", "length", drop_if_empty=True),
    *unit_columns("length stress time"),
    *fields("of.mesh of.rings of.sampling", "stress"),
    *fields("of.material of.assumed"),
    Column("limit_load", _limit_load, "force", "limit load, at least", drop_if_empty=True),
    *unit_columns("force"),
]
# Keys of results.json.
JOINT = fields("model bands bending_moment bending_moments remark")
VARIATION = fields("what value length max_von_mises max_von_mises_interval=interval beneath")


def joint_tables(results: Results) -> list[Table[Any]]:
    """Return the tables of all pins in lugs.

    These are the bands, the loads per length along them, the maxima over the range of the joint,
    and the stress of lugs.
    """
    joints = [(pin, pin.joint) for pin in results.pins if pin.joint is not None]
    bands = [PinRow(pin, band) for pin, joint in joints for band in joint.bands]
    steps = [PinRow(row.pin, step) for row in bands for step in _steps(row.of)]
    ranges = [(pin, joint.range) for pin, joint in joints if joint.range]
    variations = [PinRow(pin, v) for pin, over in ranges for v in over.variations]
    return [
        Table("joint_bands", BAND_COLUMNS, bands),
        Table("line_loads", LINE_LOAD_COLUMNS, steps),
        Table("joint_range", RANGE_COLUMNS, variations),
        lugs_table(results),
    ]


def lugs_table(results: Results) -> Table[PinRow[LugStress]]:
    """Return the stress of the lugs whose shank is known."""
    joints = [(pin, pin.joint) for pin in results.pins if pin.joint is not None]
    rows = [PinRow(pin, lug) for pin, joint in joints for lug in joint.lugs]
    return Table("lugs", LUG_COLUMNS, rows)


def _steps(band: BandContact) -> Iterator[LoadStep]:
    none = (None,) * len(band.line_load)
    rings = zip(band.line_load, band.ends[:-1] or none, band.ends[1:] or none, strict=True)
    for (z, load), start, end in rings:
        yield LoadStep(band.name, z, load, start, end)


def joint_json(joint: JointResult | None) -> dict[str, Any] | None:
    """Return the joint for results.json."""
    if joint is None:
        return None
    over = joint.range
    return {
        **json_of(JOINT, joint),
        "range": over
        and {
            **json_of(fields("max_von_mises model"), over),
            "lugs": lugs_word(over),
            "over": [json_of(VARIATION, variation) for variation in over.variations],
        },
    }


def lugs_word(over: JointRange) -> str:
    """Return whether the lugs of a range are "assumed" or those of the "study"."""
    return "assumed" if over.assumed else "study"

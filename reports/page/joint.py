"""The page's part on a pin in its lugs."""

from __future__ import annotations

from dataclasses import dataclass

from fea.support.records import BandContact, JointResult, LugStress, Variation
from reports.data.row import PinResult, Units
from reports.format.numbers import DASH, engineering, short
from reports.format.ranges import END_DIGITS, part_words, variation_range
from reports.tables.column import Column, Grid, PinRow, Table, grid_of, in_order, read_only, texts
from reports.tables.stress.joint import BAND_COLUMNS, LUG_COLUMNS

JOINT_TITLES = {"contact": "Contact with the lugs", "foundation": "Load from the lugs"}
BAND_ORDER = "connection force contact_angle mean_pressure bearing_share carrying_share"
BANDS_NOTE = (
    "The force is that of the link on the pin. Half contact angle: half of the arc of the bore "
    "that carries, where it is widest. Carries over: the part of the lug's thickness along "
    "which it pushes the pin in the direction of the force; beyond, it does not touch, or holds "
    "back. Couple on the link: the moment with which the lug's resistance to tilting acts on its "
    "link. Mean pressure: the force over diameter and length of the band. Torque by friction: the "
    "largest between pin and lug over all instants. The plot has the load "
    "per length in the direction of each link's force (negative: the opposite side of the bore "
    "carries), and the size of the bending moment."
)
LUG_ORDER = (
    "connection wall place max_von_mises error_estimate interface other_interface interference "
    "max_hoop_stress angle time safety_factor limit_load"
)
LUGS_NOTE = (
    "Stress of a lug: the largest about its bore over all instants. Free: where the pin does not "
    "touch; beneath: where it presses. The angle is from the shank, as seen from the bore. ±: "
    "mesh, rings through the thickness and sampling in time. Not in it: the lug is plane, but for "
    "what uneven pressure through the thickness adds."
)
RANGE_NOTE = (
    "Range over the joint: the maximum with one property of the joint changed in all lugs at once, "
    "all else as the study describes or assumes it."
)
FOUNDATION_NOTE = (
    "Where a beam on elastic foundations gives the load, contact angles are those of plane contact "
    "at the largest load per length."
)


@dataclass(frozen=True)
class JointPart:
    """The page's part on the joint of a pin.

    sentence: on the error and range of the maximum.
    bands: of the lugs that support the pin; None without any.
    lugs: the stress of the lugs; None if their shanks are not known.
    range: the maxima over the joint; None if not computed.
    assumed: whether the lugs were assumed.
    """

    title: str
    sentence: str
    bands: Grid | None
    lugs: Grid | None
    range: Grid | None
    assumed: bool


def joint_part(pin: PinResult, units: Units) -> JointPart | None:
    """Return the part on a pin's joint; None for a row without a joint."""
    joint = pin.joint
    if joint is None:
        return None
    title = JOINT_TITLES.get(joint.model, "Range over the joint")
    bands = grid_of(_bands(pin, joint, units), units)
    assumed = joint.range is not None and joint.range.assumed
    parts = bands, grid_of(_lugs(pin, joint, units), units), _range(joint, units)
    return JointPart(title, _sentence(pin, joint, units), *parts, assumed)


def _sentence(pin: PinResult, joint: JointResult, units: Units) -> str:
    parts = part_words(pin)
    error = f"errors of {parts}" if parts else ""
    over = "" if joint.bands else "no range over the joint"
    if joint.range:
        low_to_high = f"{variation_range(joint.range)} {units.stress}"
        over = f"the maximum is {low_to_high} over what is not known of the joint"
        if joint.range.model == "foundation":
            lugs = "assumed lugs" if joint.range.assumed else "its lugs"
            over += f" (beam on foundations in {lugs}, its error included)"
    said = "; ".join(filter(None, (error, over)))
    why = f"{';' if joint.range else ':'} {joint.remark}" if joint.remark else ""
    text = f"{said[:1].upper()}{said[1:]}{why}."
    return text.lstrip(".: ")


def _bands(pin: PinResult, joint: JointResult, units: Units) -> Table[PinRow[BandContact]]:
    rows = [PinRow(pin, band) for band in joint.bands]
    return Table("joint_bands", in_order(BAND_COLUMNS, BAND_ORDER), rows)


def _lugs(pin: PinResult, joint: JointResult, units: Units) -> Table[PinRow[LugStress]]:
    rows = [PinRow(pin, lug) for lug in joint.lugs]
    return Table("lugs", in_order(LUG_COLUMNS, LUG_ORDER), rows)


def _range(joint: JointResult, units: Units) -> Grid | None:
    over = joint.range
    if over is None:
        return None
    last = "beneath contact" if over.model == "contact" else "with error"
    columns: list[Column[Variation]] = [
        *texts("changed=what"),
        read_only("to", lambda v: value_words(v, units), numeric=False),
        read_only("max von Mises", lambda v: v.max_von_mises, "stress"),
        read_only(last, _interval_or_beneath),
    ]
    return grid_of(Table("joint_range", columns, over.variations), units)


def _interval_or_beneath(variation: Variation) -> str:
    """Return the range of a maximum if it has one, otherwise the stress beneath contact."""
    if variation.interval is None:
        return engineering(variation.beneath)
    return " to ".join(engineering(end, END_DIGITS) for end in variation.interval)


def value_words(variation: Variation, units: Units) -> str:
    """Return the varied value: a length with its description, or words."""
    if not variation.length:
        return variation.value or DASH
    return f"{short(variation.length)} {units.length} ({variation.value})"

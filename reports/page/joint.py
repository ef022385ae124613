"""What the page says of a pin's contact with its lugs."""

from __future__ import annotations

from dataclasses import dataclass

from fea.joint.records import JointResult, Variation
from reports.data.results import PinResult, Units
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, short
from reports.format.ranges import error_words, joint_range, part_words


@dataclass(frozen=True)
class JointPart:
    """A sentence on the maximum, the bands, and the maximum with the joint changed, if it was."""

    sentence: str
    bands: Grid
    range: Grid | None


def joint_part(pin: PinResult, units: Units) -> JointPart | None:
    """None where nothing is in contact."""
    if pin.joint is None:
        return None
    return JointPart(_sentence(pin, units), _bands(pin.joint, units), _range(pin.joint, units))


def _sentence(pin: PinResult, units: Units) -> str:
    outside = " outside the excluded zones" if pin.verdict == "singular" else ""
    largest = f"{engineering(pin.max_von_mises)} {units.stress}"
    parts = part_words(pin)
    error = f"{error_words(pin)}; errors of {parts}" if parts else error_words(pin)
    over = ""
    if pin.joint and pin.joint.range:
        over = f"; {joint_range(pin)} {units.stress} over what is not known of the joint"
    return f"Maximum von Mises stress{outside} {largest} ({error}){over}."


def _bands(joint: JointResult, units: Units) -> Grid:
    head = [
        "connection", f"force [{units.force}]", "half contact angle [°]",
        f"largest pressure [{units.stress}]", f"couple on the link [{units.force}·{units.length}]",
        f"clearance [{units.length}]", f"outer diameter [{units.length}]",
    ]  # fmt: skip
    body = [
        [
            band.name,
            engineering(band.force),
            engineering(band.contact_angle, 3),
            engineering(band.largest_pressure),
            engineering(band.couple),
            short(band.clearance),
            short(band.outer_diameter),
        ]
        for band in joint.bands
    ]
    return Grid(head, body, [False, *[True] * 6])


def _range(joint: JointResult, units: Units) -> Grid | None:
    if joint.range is None or not joint.range.variations:
        return None
    body = [
        [v.what, value_words(v, units), engineering(v.max_von_mises)]
        for v in joint.range.variations
    ]
    head = ["changed", "to", f"max von Mises [{units.stress}]"]
    return Grid(head, body, [False, False, True])


def value_words(variation: Variation, units: Units) -> str:
    """What was changed to: a length with how it came about, or words."""
    if not variation.length:
        return variation.value or DASH
    return f"{short(variation.length)} {units.length} ({variation.value})"

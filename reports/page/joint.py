"""The page's part on a pin in its lugs."""

from __future__ import annotations

from dataclasses import dataclass

from fea.support.records import JointResult, Variation
from reports.data.results import PinResult, Units
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, short
from reports.format.ranges import END_DIGITS, joint_range, part_words

JOINT_TITLES = {"contact": "Contact with the lugs", "foundation": "Load from the lugs"}
FOUNDATION_NOTE = (
    "By a beam on foundations; contact angles are those of plane contact at the largest load per "
    "length."
)


@dataclass(frozen=True)
class JointPart:
    """A sentence on the error and range of the maximum, the bands if lugs support the pin, and the
    maximum with the joint changed, if it was; assumed: in lugs that were not given.
    """

    title: str
    sentence: str
    bands: Grid | None
    range: Grid | None
    assumed: bool


def joint_part(pin: PinResult, units: Units) -> JointPart | None:
    """None where nothing is known of the joint."""
    joint = pin.joint
    if joint is None:
        return None
    title = JOINT_TITLES.get(joint.model, "Range over the joint")
    bands = _bands(pin, joint, units) if joint.bands else None
    assumed = joint.range is not None and joint.range.assumed
    return JointPart(title, _sentence(pin, joint, units), bands, _range(joint, units), assumed)


def _sentence(pin: PinResult, joint: JointResult, units: Units) -> str:
    parts = part_words(pin)
    error = f"errors of {parts}" if parts else ""
    over = "" if joint.bands else "no range over the joint"
    if joint.range:
        over = (
            f"the maximum is {joint_range(pin)} {units.stress} over what is not known of the joint"
        )
        if joint.range.model == "foundation":
            lugs = "assumed lugs" if joint.range.assumed else "its lugs"
            over += f" (beam on foundations in {lugs}, its error included)"
    said = "; ".join(filter(None, (error, over)))
    why = f"{';' if joint.range else ':'} {joint.remark}" if joint.remark else ""
    more = f" {FOUNDATION_NOTE}" if joint.model == "foundation" else ""
    text = f"{said[:1].upper()}{said[1:]}{why}."
    return f"{text}{more}".lstrip(".: ").strip()


def _bands(pin: PinResult, joint: JointResult, units: Units) -> Grid:
    head = [
        "connection", f"force [{units.force}]", "half contact angle [°]",
        f"mean pressure [{units.stress}]", f"couple on the link [{units.force}·{units.length}]",
        f"clearance [{units.length}]", f"outer diameter [{units.length}]",
    ]  # fmt: skip
    contact = pin.places.contact if pin.places else None
    shares = {band.name: band.bearing_share for band in (contact.bands if contact else ())}
    judged = any(share is not None for share in shares.values())
    if judged:
        head.insert(4, "of bearing strength")
    body = [
        [
            band.name,
            engineering(band.force),
            engineering(band.contact_angle, 3),
            engineering(band.mean_pressure),
            *([_per_cent(shares.get(band.name))] if judged else []),
            engineering(band.couple),
            short(band.clearance),
            short(band.outer_diameter),
        ]
        for band in joint.bands
    ]
    return Grid(head, body, [False, *[True] * (len(head) - 1)])


def _per_cent(share: float | None) -> str:
    return DASH if share is None else f"{engineering(100.0 * share, 3)} %"


def _range(joint: JointResult, units: Units) -> Grid | None:
    if joint.range is None or not joint.range.variations:
        return None
    body = [[v.what, value_words(v, units), *_maximum(v)] for v in joint.range.variations]
    last = "beneath contact" if joint.range.model == "contact" else "with error"
    head = ["changed", "to", f"max von Mises [{units.stress}]", last]
    return Grid(head, body, [False, False, *[True] * (len(head) - 2)])


def _maximum(variation: Variation) -> list[str]:
    """With its range, where it has one, otherwise with what lies beneath contact."""
    size = engineering(variation.max_von_mises)
    if variation.interval is None:
        return [size, engineering(variation.beneath)]
    return [size, " to ".join(engineering(end, END_DIGITS) for end in variation.interval)]


def value_words(variation: Variation, units: Units) -> str:
    """What was changed to: a length with how it came about, or words."""
    if not variation.length:
        return variation.value or DASH
    return f"{short(variation.length)} {units.length} ({variation.value})"

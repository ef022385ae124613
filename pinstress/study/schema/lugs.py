"""Keys of the lugs in which pins sit in a study file, and their common defaults."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, Tag

from pinstress.study.schema.iso286 import classes_of
from pinstress.study.schema.rules import at_most_one
from pinstress.study.schema.types import (
    ONE_OR_BOTH,
    Angle,
    Length,
    Name,
    NotNegativeLength,
    Number,
    PositiveLength,
    StrictTable,
    Tilt,
)


def _included(fit: str) -> str:
    classes_of(fit)
    return fit


Fit = Annotated[str, AfterValidator(_included)]


class BushingTable(StrictTable):
    """A ring of another material in the bore of a lug: bonded, or pressed in."""

    thickness: PositiveLength
    """Wall thickness."""
    material: str
    """Name of a `[material]`."""
    interference: NotNegativeLength | None = None
    """Outer diameter of the bushing minus the diameter of the hole into which it was pressed.
    Default: the middle of the `fit` or of `range.interference`; otherwise it is bonded."""
    fit: Fit | None = None
    """Tolerance classes of hole and bushing by ISO 286-1, as "H7/s6", at the diameter of the hole.
    Not with `interference`."""

    _one_interference = at_most_one("fit", "interference")


class ShankTable(StrictTable):
    """The outline of a lug: its head and the shank that holds it. With it, the stress of the lug
    itself is computed.
    """

    shape: Literal["round", "tapered", "square"] = "round"
    """"round": a round head and a shank of parallel sides; "tapered": a round head whose sides run
    to the shank as tangents; "square": a plate with a straight end."""
    width: PositiveLength | None = None
    """Width of the shank where it is held; for a square plate, its width throughout. Default: the
    outer diameter."""
    length: PositiveLength | None = None
    """Distance from the centre of the bore to where the shank is held. Default: 2 outer
    diameters."""
    end: PositiveLength | None = None
    """Distance from the centre of the bore to the end of the head. Default: half of the outer
    diameter."""
    angle: Angle | None = None
    """Direction from the bore to the shank, as an angle from the pin's x axis. Default: towards the
    middle of the body's other joints; without a mechanism that gives it, against the largest force
    on the lug."""
    toward: Name | None = None
    """Name of the joint, of a linkage in the plane, towards which the shank points. Not with
    `angle`."""

    _one_direction = at_most_one("angle", "toward")


Friction = Annotated[Number, Field(ge=0.0, le=1.0)]
Times = Annotated[Number, Field(gt=0.0)]
PositiveShare = Annotated[Number, Field(gt=0.0, le=1.0)]


class LugFactorsTable(StrictTable):
    """Factors of a lug for the code "aircraft": efficiencies read off the figures of its source,
    and the special factor in bearing.
    """

    K: Times | None = None
    """Bearing: AFFDL-TR-69-42, figure 9-2."""
    K_n: Times | None = None
    """Net section: AFFDL-TR-69-42, figure 9-4."""
    k_br: Times | None = None
    """Shear-bearing by Melcon and Hoblit, instead of K."""
    k_t: Times | None = None
    """Tension by Melcon and Hoblit, instead of K_n."""
    C: Times | None = None
    """Yield by Melcon and Hoblit."""
    k_tru: Times | None = None
    """Transverse load, ultimate, by Melcon and Hoblit."""
    k_try: Times | None = None
    """Transverse load, yield, by Melcon and Hoblit."""
    gamma: PositiveShare | None = None
    """For the middle lug in double shear: the fraction of a quarter of its thickness that remains
    in the arm of the pin's bending moment, since pressure peaks at the faces, by Melcon and
    Hoblit."""
    bearing: Annotated[Number, Field(ge=1.0)] | None = None
    """Special factor on the ultimate load in bearing, instead of a lower fitting factor: 14 CFR
    25.623, for a clearance that pounds or vibrates; 25.693, 3.33 in joints of control systems, 2 in
    cable systems."""


class LugRangeTable(StrictTable):
    """Ranges of uncertain properties of a lug: [lower, upper]."""

    clearance: tuple[Length, Length] | None = None
    """Range of the clearance. Default: that of the `fit`; otherwise from zero to twice the given
    clearance (0.002 of the diameter if none is given)."""
    stiffness: tuple[Times, Times] | None = None
    """Range of the stiffness, relative to that of the lug as described. Default: [0.5, 2]."""
    tilt: tuple[Tilt, Tilt] | None = None
    """Range of the resistance to tilting. Default: ["free", "guided"]."""
    interference: tuple[PositiveLength, PositiveLength] | None = None
    """Range of the interference of the bushing; stresses of bushing and lug are the largest over
    it. Default: that of the bushing's `fit`."""


class LugTable(StrictTable):
    """The eye in which a band of the pin sits: of the link at the connection of this name, or of
    the surrounding structure, which does not move, at the segment of this name.
    """

    outer_diameter: PositiveLength | None = None
    """Outer diameter of the eye. Default: 2.5 times the diameter of the band."""
    material: str | None = None
    """Name of a `[material]`. Default: the pin's material."""
    clearance: Length | None = None
    """Diameter of the bore minus that of the pin; negative for interference. Default: the middle of
    the `fit`, or of a `range.clearance` that leaves 0 out, else 0."""
    fit: Fit | None = None
    """Tolerance classes of bore and pin by ISO 286-1, as "H7/f7", at the diameter of the band. Not
    with `clearance`."""
    edge_radius: NotNegativeLength = 0.0
    """Radius of the edges of the bore. 0 is a sharp edge, where pressure is unbounded, so results
    give no peak pressure there."""
    tilt: Tilt | None = None
    """Resistance of the link to tilting of its eye: "guided" (rigid), "free", or a stiffness.
    Default: the bending stiffness of the lug over its `shank.length`; without one, that of an eye
    clamped at a distance of 0.8 outer diameters."""
    bushing: BushingTable | None = None
    """A bushing in the eye."""
    friction: Friction = 0.0
    """Coefficient of Coulomb friction between pin and bore, for bounds of the torque and of the
    stress. It does not act on the mechanism, as `friction` of a joint does."""
    axial: (
        Annotated[
            Annotated[str, Tag("<one>")] | Annotated[tuple[str, str], Tag("<both>")], ONE_OR_BOTH
        ]
        | None
    ) = None
    """Segment of the pin, by its name, that takes the link's force along the axis both ways; or
    two: [towards the start of the pin, towards its end], as a head and a nut. Default: the next
    shoulder on that side, if no other lug is between, else the band itself."""
    shank: ShankTable | None = None
    """The outline of the lug in its plane, which its own stress requires."""
    factors: LugFactorsTable = LugFactorsTable()
    """Efficiency factors of the lug, which only figures give, and its special factor in bearing."""
    range: LugRangeTable = LugRangeTable()
    """Ranges of uncertain properties of the lug, for the range of the maximum over the joint
    (`joint.range`)."""

    _one_clearance = at_most_one("fit", "clearance")


def with_lug_defaults(raw: dict[str, Any]) -> dict[str, Any]:
    """Return a study's content in which every lug has the keys of `lug_defaults` that it omits, and
    pins that are not clamped have a lug at every connection.

    raw: the content, of which only `lug_defaults` is validated.
    """
    defaults, pins, cases = raw.get("lug_defaults"), raw.get("pin"), raw.get("case")
    if not isinstance(defaults, dict) or not isinstance(pins, dict):
        return raw
    tables = cases.values() if isinstance(cases, dict) else ()
    clamps = [table.get("clamp") for table in tables if isinstance(table, dict)]
    clamped = {name for c in clamps if isinstance(c, dict) for name, at in c.items() if at}
    return {
        **raw,
        "pin": {
            name: _in_lugs(pin, defaults, name in clamped) if isinstance(pin, dict) else pin
            for name, pin in pins.items()
        },
    }


def _in_lugs(pin: dict[str, Any], defaults: dict[str, Any], clamped: bool) -> dict[str, Any]:
    given = pin.get("lug", {})
    if "geometry" in pin or not isinstance(given, dict) or not pin.get("lugs", True):
        return pin
    names = [*given, *(() if clamped or pin.get("clamp") else _connections(pin))]
    return {**pin, "lug": {name: _completed(given.get(name, {}), defaults) for name in names}}


def _connections(pin: dict[str, Any]) -> Iterator[str]:
    """Yield the connections of a pin that is not validated, in their order along the pin."""
    segments, bands = pin.get("profile"), pin.get("band")
    for segment in segments if isinstance(segments, list) else ():
        if isinstance(segment, dict) and isinstance(segment.get("connection"), str):
            yield segment["connection"]
    for name, band in bands.items() if isinstance(bands, dict) else ():
        if isinstance(band, dict) and band.get("connection", True):
            yield name


def _completed(lug: Any, defaults: dict[str, Any]) -> Any:
    """Return a lug with the keys of the defaults that it omits, including keys of its inner tables.

    Its own fit or clearance replaces the clearance of the defaults, and the fit or interference of
    its own bushing that of the defaults.
    """
    if not isinstance(lug, dict):
        return lug
    defaults = _without_replaced(defaults, lug, "clearance")
    if isinstance(lug.get("bushing"), dict) and isinstance(defaults.get("bushing"), dict):
        defaults = _without_replaced(defaults, lug, "interference", "bushing")
    inner = {
        key: {**defaults[key], **value}
        for key, value in lug.items()
        if isinstance(value, dict) and isinstance(defaults.get(key), dict)
    }
    return {**defaults, **lug, **inner}


def _without_replaced(
    defaults: dict[str, Any], lug: dict[str, Any], key: str, table: str = ""
) -> dict[str, Any]:
    """Return the defaults without the fit, and without the values that follow from a fit, that a
    lug states itself.

    key: the value that a fit gives. table: the inner table that has both keys.
    """
    given, common = (x[table] if table else x for x in (lug, defaults))
    if "fit" in given or key in given:
        kept = {k: v for k, v in common.items() if k not in ("fit", key)}
        defaults = {**defaults, table: kept} if table else kept
    if "fit" in given and isinstance(defaults.get("range"), dict):
        known = {k: v for k, v in defaults["range"].items() if k != key}
        defaults = {**defaults, "range": known}
    return defaults

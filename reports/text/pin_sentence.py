"""The result of a pin in a case, and the caption of its drawing, in sentences."""

from __future__ import annotations

from assess.judgement import DEPENDS
from reports.data.results import PinShape
from reports.data.row import PinResult, Units
from reports.format.numbers import components, engineering, short
from reports.format.ranges import error_words, factor_range
from reports.format.words import but_words, verdict_words


def pin_sentence(pin: PinResult, units: Units) -> str:
    """Return the result of a pin as text: maximum, error, place, factor, dependences, verdict."""
    verdict = pin.verdict.capitalize() + (f": {pin.note}" if pin.note else "") + "."
    if pin.max_von_mises is None:
        return verdict
    outside = " outside the excluded zones" if pin.verdict == "singular" else ""
    where = f" of its {pin.places.governing}" if pin.places and pin.places.section else ""
    text = f"Maximum von Mises stress{where}{outside} {engineering(pin.max_von_mises)} "
    text += f"{units.stress}"
    text += f" ({error_words(pin)})"
    if pin.time is not None:
        text += f", at t = {short(pin.time)} {units.time}"
    if pin.position is not None:
        unit = pin.position_unit or units.length
        text += f" (drive position {engineering(pin.position)} {unit})"
    if pin.location is not None:
        place = ", ".join(components(pin.location, max(map(abs, pin.location))))
        text += f", at x, y, z = {place} {units.length} in pin axes"
    factor = f"{factor_range(pin)} ({verdict_words(pin.verdict, pin.yields)})"
    return f"{text}. Safety factor {factor}.{_depends(pin, units)} {verdict}"


def _depends(pin: PinResult, units: Units) -> str:
    if pin.outcome != DEPENDS:
        return ""
    state, fails = ("Safe", "fails") if pin.required else ("Below yield", "yields")
    return f" {state} as described, {but_words(pin.depends_on, units, fails)}."


def drawing_caption(shape: PinShape, units: Units, zoned: bool = True) -> str:
    """Return the caption of the drawing of a pin.

    zoned: whether the drawing shows excluded zones.
    """
    zones = (
        " Numbered red rings: stress singularities, filled where one governs; red stripes: the "
        "excluded zones about them."
    )
    solids = " Dashed green boxes: local solids about cuts."
    cuts = " Cuts in the view with x upwards, from which their angles count; dashed: hidden edges."
    stress = (
        " Arrows and curves: forces of the links, and stress along the pin, in its worst case; "
        "dotted: the stress that the required factor permits."
    )
    more = zones * zoned + cuts * bool(shape.cuts) + solids * bool(shape.solids)
    return (
        f"Profile, lengths and diameters (⌀ outer / bore) in {units.length}. Blue: bearing bands; "
        f"hatched: clamped; grey: free. Red dots: the surface's largest stress; a red line across: "
        f"the section that governs instead.{stress}{more} {material_words(shape, units)}."
    )


def material_words(shape: PinShape, units: Units) -> str:
    """Return the material and the weight of a pin."""
    weight = "" if shape.weight is None else f", weight {engineering(shape.weight)} {units.force}"
    return f"Material {shape.material}{weight}"

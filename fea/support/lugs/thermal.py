"""The fits of a pin in its lug and of a bushing in the lug at another temperature.

Pin, bushing and lug have the same, uniform temperature. Each alone would expand freely: the pin by
alpha_pin d per kelvin, the bore of a lug by alpha_lug d. A bushing of outer diameter h would
outgrow its hole by (alpha_bushing - alpha_lug) h per kelvin. This is added to its interference and
presses its bore inwards, as in two Lame tubes inside each other (fea.support.lugs.fit). If it is
negative, a bonded bushing is pulled outwards, and a pressed bushing becomes loose where its
interference is used up.
"""

from __future__ import annotations

from dataclasses import replace

from fea.core.material import Material
from fea.support.lugs.fit import bushing_press_fit, widening
from fea.support.lugs.lug import Lug
from geometry import ArgumentError


def at_temperature(lug: Lug, pin: Material, radius: float, rise: float) -> Lug:
    """The lug at another temperature, with the clearance and the bushing's interference changed.

    pin: material of the pin.
    radius: of the pin's band, m.
    rise: above the temperature at which the dimensions hold, K.

    Raises: ArgumentError for a material without thermal expansion.
    """
    if not rise:
        return lug
    alpha = {m.name: _expansion(m, lug) for m in (pin, lug.material, lug.bearing)}
    d, bushing = 2.0 * radius, lug.bushing
    growth = (alpha[lug.bearing.name] - alpha[pin.name]) * d * rise
    if bushing is not None:
        hole = d + 2.0 * bushing.thickness
        outgrown = (alpha[lug.bearing.name] - alpha[lug.material.name]) * hole * rise
        bushing = replace(bushing, outgrown=outgrown)
        growth += bore_widening(lug, radius) * outgrown
    known = lug.range.clearance
    ends = None if known is None else (known[0] + growth, known[1] + growth)
    return replace(
        lug,
        clearance=lug.clearance + growth,
        growth=growth,
        bushing=bushing,
        range=replace(lug.range, clearance=ends),
    )


def bore_widening(lug: Lug, radius: float) -> float:
    """The change of the bore's diameter per interference on the diameter of a bushing in its lug, a
    negative number.
    """
    assert lug.bushing is not None
    constants = bushing_press_fit(lug, radius)[0]
    return 2.0 * float(widening(radius, lug.bushing.material) @ constants)


def bushing_opening_rise(lug: Lug, rise: float) -> float | None:
    """The temperature rise, K, at which a pressed bushing with the least of its interferences
    becomes loose; None where it is not loose.

    lug: at the temperature of a case.
    rise: of that temperature above the temperature of the dimensions, K.
    """
    if lug.bushing is None:
        return None
    bushing = min(lug.pressed_bushings(), key=lambda x: x.interference)
    if not bushing.pressed or bushing.misfit > 0.0:
        return None
    return -rise * bushing.interference / bushing.outgrown


def _expansion(material: Material, lug: Lug) -> float:
    if material.thermal_expansion is None:
        raise ArgumentError(
            f"material {material.name} has no thermal_expansion, which the fit in lug "
            f"{lug.connection} needs at another temperature",
            "no-expansion",
        )
    return material.thermal_expansion

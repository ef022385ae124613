"""The stress of press fits alone, by Lame's thick tubes: of a pin in the bore of a lug, and of a
bushing in its hole.

The check needs neither loads nor a shank. The solved stress of a lug already includes the press
fit, and so does the stress of a pin whose contact is solved.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from assess.check import CheckText, WorstPlace, check
from assess.margin import Margin
from assess.situation import Situation
from assess.work import WorkQuantity
from fea.support.lugs.fit import on_structure, press_fit_stresses
from fea.support.lugs.lug import Lug

METHOD = "press fit"


@check(
    METHOD,
    "AFFDL-TR-69-42, 9.16",
    kind="model",
    takes="loads",
    omits="Not covered: the loads, which a lug with a shank has in its stress; eyes but rings.",
)
def press_fit(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of pin, bushing and eye for fits with an interference, where the stress of
    the lug is not solved.
    """
    solved = {stress.connection for stress in s.lug_stresses}
    lugs = (lug for lug in s.lugs if lug.connection not in solved)
    return [margin for lug in lugs for margin in _margins(text, s, lug)]


def _margins(text: CheckText, s: Situation, lug: Lug) -> Iterator[Margin]:
    pin = on_structure(s.pin, s.lugs)
    band = pin.band(lug.connection)
    bore = max(max(x.bores) for x in pin.segments if x.connection == lug.connection)
    place = WorstPlace(lug.connection, band.middle)
    stresses = press_fit_stresses(lug, band.radius, bore / 2.0, s.material)
    required = s.row.required if s.row else None
    walls = "pin", *["bushing"] * (lug.bushing is not None), "eye"
    for wall, (material, stress) in zip(walls, stresses, strict=True):
        if stress > 0.0 and (wall != "pin" or s.joint is None):
            named = replace(text, method=f"{text.method}, {wall}")
            (margin,) = named.at_levels(s, stress, place, material, material.yield_strength)
            margin = replace(margin, factor=max(margin.factor, required or 0.0))
            yield replace(margin, passing=_passing(lug, margin.used))


def _passing(lug: Lug, used: float) -> WorkQuantity | None:
    """Return the interference that would just pass, as the largest of its range and at the
    temperature at which the study states dimensions.

    None if both pin and bushing are pressed in, or if no interference passes.
    """
    of_pin = max(-x for x in (lug.clearance, *(lug.range.clearance or ())))
    if lug.bushing is None:
        now, grown = of_pin, -lug.growth
    else:
        now, grown = max(x.misfit for x in lug.pressed_bushings()), lug.bushing.outgrown
    passes = now / used - grown if used > 0.0 else 0.0
    both = lug.bushing is not None and of_pin > 0.0
    return WorkQuantity("interference", passes, "length") if passes > 0.0 and not both else None

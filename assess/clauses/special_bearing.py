"""The special factor on the bearing of a lug: 14 CFR 25.619, 25.623 and 25.693.

    P_bru = F_bru d t       at the ultimate factor times the special factor

F_bru is the lowest ultimate bearing strength of the materials in contact: the pin, and the lug or
its bushing. Only the highest of the special factor and the fitting factor applies (25.619). The
study states the special factor: 25.623 gives no number for parts with clearance that are subject to
pounding or vibration; 25.693 requires 3.33 in joints of control systems with angular motion and 2.0
in cable systems, except in ball and roller bearings.

Source: 14 CFR 25.619, 25.623 and 25.693. Readers differ whether the 3.33 of 25.693 multiplies the
1.5 of 25.303, as 25.619 says of special factors, or is the only factor on limit load. Here it
multiplies, which is on the safe side.
"""

from __future__ import annotations

from dataclasses import replace

from assess.check import CheckText, WorstPlace, check
from assess.margin import Margin, strength_key
from assess.situation import Situation
from assess.work import scaled, work
from fea.support.lugs.lug import Lug

SPECIAL_OMITS = (
    "Not covered: wear, ball and roller bearings. The factor multiplies the ultimate factor, as "
    "25.619 says; whoever reads 25.693 as a factor on limit load divides it by that."
)


@check("special factor in bearing", "14 CFR 25.619, 25.623, 25.693", kind="clause", takes="loads",
       level="ultimate", dimension="force",
       omits=SPECIAL_OMITS)  # fmt: skip
def special_bearing(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins in bearing of every lug whose special factor is given."""
    of_lugs = ((lug, s.factors_of(lug.connection).bearing) for lug in s.lugs)
    known = ((lug, x) for lug, x in of_lugs if x and lug.connection in s.loads.surfaces)
    return [_margin(text, s, lug, x) for lug, x in known]


def _margin(text: CheckText, s: Situation, lug: Lug, special: float) -> Margin:
    factor = s.factors.ultimate * max(special, s.factors.fitting)
    bear = [s.material, lug.bearing]
    if missing := [strength_key(m.name, "bearing") for m in bear if m.bearing_strength is None]:
        return replace(text.lacks(s, *dict.fromkeys(missing)), factor=factor)
    softest = min(bear, key=lambda m: m.bearing_strength or 0.0)
    band, force = s.pin.band(lug.connection), s.across[:, s.loads.surfaces.index(lug.connection)]
    t, strength = int(force.argmax()), softest.bearing_strength or 0.0
    d = 2.0 * band.radius
    borne = work(
        "P_bru", strength * d * band.length, "force", "{F_bru} × {d} × {t}",
        F_bru=(strength, "stress"), d=(d, "length"), t=(band.length, "length"),
    )  # fmt: skip
    place = WorstPlace.at_band(band, s.loads, t)
    margin = text.margin(s, float(force[t]), borne.result.value, place, softest.name, work=(borne,))
    margin = replace(margin, factor=factor)
    return replace(margin, passing=scaled("thickness", band.length, margin.used, 1.0))

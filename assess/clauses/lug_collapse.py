"""Margins of the limit load and the ultimate load of lugs: no collapse by plastic flow, and no
rupture, at ultimate load.

The allowable limit load is the lower end of the bracket at the yield strength; all of twenty bars
tested to failure exceeded it (docs/evidence.md). The allowable ultimate load is the largest load in
finite strain up to the failure strain that the study states. The demand is the largest pull along
the shank.

Source: 14 CFR 25.305(b) (no failure at ultimate load).
"""

from __future__ import annotations

from assess.check import CheckText, check
from assess.clauses.eye import LoadedEye, loaded_eyes, place_of
from assess.clauses.eye_margin import not_axial
from assess.margin import Margin
from assess.plastic.records import LugCollapse
from assess.situation import Situation

COLLAPSE_OMITS = (
    "Not covered: loads across the shank, hardening, fracture, thin lugs in which metal escapes "
    "across."
)
ULTIMATE_OMITS = (
    "Not covered: loads across the shank, pins that bend, thin lugs in which metal escapes across, "
    "cracks and flaws."
)
ULTIMATE_SCATTER = (
    "20 bars of aluminium, failure strain ln(1 + A): test over prediction 1.052 in the mean, "
    "standard deviation 0.049, least 0.956"
)
ENDS = {
    "strain": "it breaks where the failure strain is reached",
    "shape": "it gives way before the failure strain is reached",
}


@check("lug, limit load", "14 CFR 25.305", kind="collapse", takes="loads", level="ultimate",
       dimension="force", omits=COLLAPSE_OMITS)  # fmt: skip
def lug_collapse(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the pull on every lug whose limit load was requested."""
    limits = {limit.connection: limit for limit in s.lug_collapses}
    return [
        margin
        for loaded in loaded_eyes(s)
        if loaded.connection in limits
        for margin in _of_lug(text, s, loaded, limits[loaded.connection])
    ]


@check("lug, ultimate load", "14 CFR 25.305", kind="collapse", takes="loads", level="ultimate",
       dimension="force", scatter=ULTIMATE_SCATTER, omits=ULTIMATE_OMITS)  # fmt: skip
def lug_rupture(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of the pull against the ultimate load, for every lug whose metal has a
    failure strain and whose limit load was requested.
    """
    limits = {limit.connection: limit for limit in s.lug_collapses if limit.breaks_by}
    margins = []
    for loaded in loaded_eyes(s):
        limit = limits.get(loaded.connection)
        if limit is None:
            continue
        if across := not_axial(text, s, loaded):
            margins.append(across)
        elif limit.ultimate is None:
            margins.append(text.lacks(s, limit.breaks_by))
        else:
            basis = ENDS[limit.breaks_by]
            margins.append(_against(text, s, loaded, limit.ultimate, basis))
    return margins


def _of_lug(text: CheckText, s: Situation, loaded: LoadedEye, limit: LugCollapse) -> list[Margin]:
    if across := not_axial(text, s, loaded):
        return [across]
    if limit.lower is None or limit.upper is None:
        return [text.lacks(s, limit.needs)]
    bracket = f"collapse at 1 to {limit.upper / limit.lower:.3f} times what is allowed"
    return [_against(text, s, loaded, limit.lower, bracket)]


def _against(
    text: CheckText, s: Situation, loaded: LoadedEye, allowable: float, basis: str
) -> Margin:
    """Return the margin of the largest pull along a shank against an allowable load, N."""
    instant = int(loaded.axial.argmax())
    force, place = float(loaded.axial[instant]), place_of(s, loaded, instant)
    basis = "; ".join(x for x in (loaded.basis, basis) if x)
    return text.margin(s, force, allowable, place, loaded.lug.name, basis)

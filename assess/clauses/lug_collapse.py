"""The limit load of lugs as a margin: no collapse by plastic flow at ultimate load.

The allowable is the lower end of the bracket at the yield strength, which all of twenty bars that
broke exceeded (docs/past-yield.md); the demand the largest force along the shank.

Source: 14 CFR 25.305(b) (no failure at ultimate load).
"""

from __future__ import annotations

from assess.check import CheckText, check
from assess.clauses.eye import LoadedEye, loaded_eyes, place_of
from assess.clauses.eye_margin import not_axial
from assess.margin import Margin
from assess.plastic.records import LugCollapse
from assess.situation import Situation

OMITS = (
    "Not covered: loads across the shank, hardening, fracture, thin lugs in which metal escapes "
    "across."
)


@check("lug, limit load", "14 CFR 25.305", kind="collapse", takes="loads", level="ultimate",
       dimension="force", omits=OMITS)  # fmt: skip
def lug_collapse(text: CheckText, s: Situation) -> list[Margin]:
    """The largest force on every lug whose limit load was requested against that."""
    limits = {limit.connection: limit for limit in s.lug_collapses}
    return [
        margin
        for loaded in loaded_eyes(s)
        if loaded.connection in limits
        for margin in _of_lug(text, s, loaded, limits[loaded.connection])
    ]


def _of_lug(text: CheckText, s: Situation, loaded: LoadedEye, limit: LugCollapse) -> list[Margin]:
    if across := not_axial(text, s, loaded):
        return [across]
    if limit.lower is None or limit.upper is None:
        return [text.lacks(s, limit.needs)]
    if not loaded.axial.any():
        return []
    instant = int(loaded.axial.argmax())
    place = place_of(s, loaded, instant)
    bracket = f"collapse at 1 to {limit.upper / limit.lower:.3f} times what is allowed"
    return [
        Margin(
            text.method, text.clause, text.kind, text.level, s.factors.at(text.level),
            float(loaded.axial[instant]), limit.lower, text.dimension, place.at, place.z,
            place.time, loaded.lug.name, "; ".join(x for x in (loaded.basis, bracket) if x),
            omits=text.omits,
        )
    ]  # fmt: skip

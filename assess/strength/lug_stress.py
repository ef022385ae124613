"""Margins of the stress of lugs: the largest von Mises stress at the bore with its error (fea.lug),
against yield and rupture. The safety factor that the study requires of the pin is also required of
its lugs.

Where the pin presses on the bore, the stress is a contact stress. Beyond yield it levels off; the
bearing checks judge it. Its margin is therefore for comparison only.
"""

from __future__ import annotations

from dataclasses import replace

from assess.check import CheckText, WorstPlace, check
from assess.margin import Margin, for_comparison
from assess.situation import Situation
from assess.strength.model_stress import CLAUSE
from fea.core.material import Material
from fea.support.lugs.lug import Lug
from fea.support.records import LugStress
from pinbase.keys import lug_key

CONTACT_NEED = "the contact of the pin with its lugs, solved in full"
METHOD = "lug, von Mises stress at the bore"


@check(METHOD, CLAUSE, kind="model", takes="results")
def lug_stress(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of every wall of the lugs whose shank is known; for the other lugs, what
    is missing.
    """
    by_name = {lug.connection: lug for lug in s.lugs}
    margins = [
        margin
        for stress in s.lug_stresses
        for margin in _margins(text, s, stress, by_name[stress.connection])
    ]
    lacking = [lug_key(s.pin.name, lug.connection, "shank") for lug in s.sized if lug.shank is None]
    if lacking and s.joint is not None:
        margins.append(text.lacks(s, *lacking))
    if not s.lug_stresses and any(lug.shank for lug in s.lugs) and s.loaded_across:
        margins.append(text.lacks(s, CONTACT_NEED))
    return margins


def _margins(text: CheckText, s: Situation, stress: LugStress, lug: Lug) -> list[Margin]:
    material = _material(stress, lug)
    place = WorstPlace(stress.connection, stress.z, stress.time)
    named = text if stress.wall == "bore" else replace(text, method=f"{text.method}, {stress.wall}")
    over = "" if stress.interference is None else " over the range of the bushing's interference"
    margins = named.at_levels(
        s, stress.max_von_mises + stress.error_estimate, place, material, material.yield_strength,
        "ultimate", basis=f"maximum with its error{over}",
    )  # fmt: skip
    margins = [replace(m, over_joint=stress.over_joint) for m in margins]
    if stress.place == "beneath":
        return [for_comparison(replace(m, method=f"{m.method}, beneath the pin")) for m in margins]
    required = s.row.required if s.row else None
    return [
        replace(m, factor=max(m.factor, required or 0.0)) if m.level == "limit" else m
        for m in margins
    ]


def _material(stress: LugStress, lug: Lug) -> Material:
    """Return the material of a wall of a lug."""
    return lug.bearing if stress.wall in ("bore", "bushing") else lug.material

"""All checks of a pin by formula."""

from __future__ import annotations

from collections.abc import Iterable

from fea.checks.records import HandCheck
from fea.strength.bending_stress import bending_margin
from fea.strength.eurocode_pins import eurocode_margins
from fea.strength.margin import Margin
from fea.strength.nominal_stress import nominal_margins
from fea.strength.plastic_bending import plastic_margin
from fea.strength.section_forces import section_forces
from fea.strength.situation import Situation


def formula_margins(s: Situation, checks: Iterable[HandCheck]) -> list[Margin]:
    """Over all instants of a case; checks: hand checks of the pin and its lugs. None where no force
    acts across the pin.

    Raises: as `section_forces`.
    """
    if not s.across.any():
        return []
    even, concentrated = section_forces(s)
    materials = {m.name: m for m in (s.material, *(lug.material for lug in s.lugs))}
    return [
        *nominal_margins(checks, materials, s.factors),
        bending_margin(s, concentrated),
        plastic_margin(s, even),
        *eurocode_margins(s, even),
    ]

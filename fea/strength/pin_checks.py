"""All checks of a pin by formula.

Bending and shear of a pin whose joint was solved are checked with the section forces of the joint
model; the same checks with the even loads of the formulas are there for comparison, or the other
way round. Concentrated forces are a comparison in both cases. Of other pins all checks govern.
"""

from __future__ import annotations

from collections.abc import Iterable

from fea.checks.hand_checks import BENDING
from fea.checks.records import HandCheck
from fea.strength.bending_stress import CONCENTRATED, OF_JOINT, bending_margin
from fea.strength.eurocode_pins import eurocode_bearing, eurocode_bending
from fea.strength.margin import Margin, compared
from fea.strength.nominal_stress import nominal_margins
from fea.strength.plastic_bending import plastic_margin
from fea.strength.section_forces import SectionForces, of_joint, section_forces
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
    nominal = nominal_margins(checks, materials, s.factors)
    bending = [m for m in nominal if m.method == BENDING]
    others = [m for m in nominal if m.method != BENDING] + eurocode_bearing(s)
    even_ones = [*bending, *_along(s, even)]
    practice = bending_margin(s, CONCENTRATED, concentrated)
    if s.joint is None:
        return [*others, *even_ones, practice]
    joint = of_joint(s, s.joint)
    joint_ones = [bending_margin(s, OF_JOINT, joint), *_along(s, joint)]
    both = (even_ones, joint_ones) if s.even_governs else (joint_ones, even_ones)
    return [*others, *both[0], *map(compared, (*both[1], practice))]


def _along(s: Situation, forces: SectionForces) -> list[Margin]:
    """Those with section forces."""
    return [plastic_margin(s, forces), *eurocode_bending(s, forces)]

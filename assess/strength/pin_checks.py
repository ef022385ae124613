"""All checks of a pin by formula.

Bending and shear of a pin whose joint was solved are checked with the section forces of the joint
model; the same checks with the even loads of the formulas are there for comparison, or the other
way round. Concentrated forces are a comparison in both cases. Of other pins all checks govern.

Even loads that leave a couple over are no complete statics: the lugs carry it, and only the joint
model knows which. There its section forces govern in any case.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from assess.strength.eurocode_pins import eurocode_bearing, eurocode_bending
from assess.strength.hand_checks import (
    BENDING_METHOD,
    MEAN_SHEAR_METHOD,
    NEUTRAL_AXIS_METHOD,
    hand_checks,
)
from assess.strength.margin import Margin, for_comparison
from assess.strength.nominal_stress import nominal_margins
from assess.strength.plastic_bending import plastic_margin
from assess.strength.records import HandCheck
from assess.strength.section_forces import SectionForces, of_joint, section_forces
from assess.strength.section_stress import (
    CONCENTRATED_BENDING,
    JOINT_MODEL_BENDING,
    bending_check,
    shear_checks,
)
from assess.strength.situation import Situation
from fea.core.pin_loads import PinLoads

SECTION_METHODS = MEAN_SHEAR_METHOD, NEUTRAL_AXIS_METHOD, BENDING_METHOD


def pin_checks(s: Situation) -> tuple[HandCheck, ...]:
    """Nominal stresses of the pin, with the section forces that govern and, for comparison, the
    bending by the others.

    Raises: as `section_forces`.
    """
    even, concentrated = section_forces(s)
    by_formula = _named(s, s.by_formula, even.basis)
    practice = bending_check(s, concentrated, CONCENTRATED_BENDING)
    if s.joint is None:
        return *by_formula, practice
    joint = of_joint(s, s.joint)
    solved = bending_check(s, joint, JOINT_MODEL_BENDING)
    if s.even_governs:
        beside = solved if s.joint_governs else solved.compared
        return *by_formula, beside, practice.compared
    of_bands = by_formula if s.simple is None else _named(s, s.loads, even.basis)
    others = [check for check in of_bands if check.name not in SECTION_METHODS]
    bending = next(check for check in by_formula if check.name == BENDING_METHOD)
    return *shear_checks(s, joint), *others, solved, bending.compared, practice.compared


def formula_margins(s: Situation, checks: Iterable[HandCheck]) -> list[Margin]:
    """Over all instants of a case; checks: `pin_checks`, and those of its lugs. None where no force
    acts across the pin.

    Raises: as `section_forces`.
    """
    if not s.across.any():
        return []
    materials = {m.name: m for m in (s.material, *(lug.material for lug in s.lugs))}
    nominal = nominal_margins(checks, materials, s.factors)
    found = [*nominal, *eurocode_bearing(s)]
    even = _along(s, section_forces(s)[0])
    if s.joint is None:
        return [*found, *even]
    solved = _along(s, of_joint(s, s.joint))
    if not s.joint_governs:
        return [*found, *even, *map(for_comparison, solved)]
    return [*found, *solved, *(even if s.even_governs else map(for_comparison, even))]


def _named(s: Situation, loads: PinLoads, basis: str) -> list[HandCheck]:
    """Hand checks with loads of the formulas, and where their section forces are from."""
    made = hand_checks(s.pin, s.material, loads, s.clamps)
    return [replace(x, basis=basis) if x.name in SECTION_METHODS else x for x in made]


def _along(s: Situation, forces: SectionForces) -> list[Margin]:
    """Those with section forces."""
    return [plastic_margin(s, forces), *eurocode_bending(s, forces)]

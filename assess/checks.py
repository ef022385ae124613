"""All strength checks, and the margins that they give.

A new check is a file with an `assess.check.Check`, its line in CHECKS, and its test. All outputs
then include the check. The order of CHECKS is the order of margins.csv.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import groupby
from types import MappingProxyType

from assess.check import Check, Scope
from assess.clauses import (
    affdl_joint,
    affdl_lugs,
    affdl_pins,
    aisc_d5,
    bth1,
    ekvall,
    eurocode_sections,
    melcon_hoblit,
    melcon_hoblit_pin,
    special_bearing,
)
from assess.clauses.lug_checks import lug_checks, required_lug_checks
from assess.clauses.lug_collapse import lug_collapse, lug_rupture
from assess.clauses.lug_out_of_plane import lug_out_of_plane
from assess.codes import DEFAULT_CODES, Code
from assess.margin import Margin, for_comparison
from assess.situation import Situation
from assess.strength import eurocode_pins
from assess.strength.case_crushing import crushed_case
from assess.strength.collapse import collapse
from assess.strength.fatigue_life import fatigue_life
from assess.strength.hand_checks import (
    bearing,
    bending,
    double_shear,
    mean_shear,
    neutral_axis_shear,
)
from assess.strength.lug_stress import lug_stress
from assess.strength.model_stress import model_rupture, model_yield
from assess.strength.plastic_bending import plastic_bending
from assess.strength.press_fit import press_fit
from assess.strength.section_forces import with_section_forces

CHECKS: tuple[Check, ...] = (
    model_yield,
    model_rupture,
    crushed_case,
    lug_stress,
    press_fit,
    lug_out_of_plane,
    collapse,
    lug_collapse,
    lug_rupture,
    mean_shear,
    neutral_axis_shear,
    double_shear,
    bearing,
    bending,
    lug_checks,
    eurocode_pins.eurocode_bearing,
    eurocode_pins.eurocode_bearing_replaceable,
    eurocode_pins.eurocode_contact_replaceable,
    plastic_bending,
    eurocode_pins.eurocode_shear,
    eurocode_pins.eurocode_bending,
    eurocode_pins.eurocode_shear_and_bending,
    eurocode_pins.eurocode_bending_replaceable,
    fatigue_life,
)
EVERYWHERE = tuple(
    check for check in CHECKS
    if check.kind in ("model", "collapse", "fatigue", "hand") and check is not lug_checks
)  # fmt: skip
AIRCRAFT: tuple[Check, ...] = (
    affdl_lugs.affdl_bearing,
    affdl_lugs.affdl_net_section,
    affdl_lugs.affdl_bushing,
    melcon_hoblit.shear_bearing,
    melcon_hoblit.tension,
    melcon_hoblit.lug_yield,
    melcon_hoblit.bushing_yield,
    melcon_hoblit.transverse,
    melcon_hoblit.transverse_yield,
    melcon_hoblit.oblique,
    melcon_hoblit.oblique_yield,
    special_bearing.special_bearing,
    ekvall.ekvall_transverse,
    ekvall.ekvall_bore_stress,
    affdl_joint.affdl_joint,
    affdl_pins.pin_shear,
    affdl_pins.pin_bending,
    melcon_hoblit_pin.peaked_bending,
)
LIFTING: tuple[Check, ...] = (
    bth1.bth1_tension,
    bth1.bth1_fracture,
    bth1.bth1_shear,
    bth1.bth1_bearing,
)
CIVIL: tuple[Check, ...] = (
    *(check for check in CHECKS if check.kind == "clause"),
    eurocode_sections.eurocode_section,
    aisc_d5.aisc_member,
)
SETS: Mapping[Code, tuple[Check, ...]] = MappingProxyType(
    {
        "general": CHECKS,
        "aircraft": (*EVERYWHERE, *AIRCRAFT),
        "lifting": (*EVERYWHERE, *LIFTING),
        "civil": (*EVERYWHERE, *CIVIL),
    }
)


def margins_of(s: Situation, scope: Scope = "case") -> list[Margin]:
    """Return all margins of a situation, at every place and level, in the order of the checks.

    A check that belongs to several of the chosen codes is made once, with the largest of their
    fitting factors.

    scope: only checks of this scope are made.

    Raises: as `with_section_forces`.
    """
    chosen = dict.fromkeys(check for code in s.codes for check in SETS[code])
    if lug_checks not in chosen:
        chosen[required_lug_checks] = None
    made = [check for check in chosen if check.scope == scope and _can_be_made(check, s)]
    every = list(with_section_forces(s)) if any(map(_takes_forces, made)) else []
    # Consecutive checks that take section forces form a group; the whole group is made once with
    # each kind of section forces.
    return [
        margin
        for repeated, together in groupby(made, _takes_forces)
        for margin in _together(list(together), every if repeated else [s])
    ]


def _takes_forces(check: Check) -> bool:
    return check.takes == "section forces"


def _can_be_made(check: Check, s: Situation) -> bool:
    """Whether the situation has the data that a check takes."""
    if check.takes == "results":
        return True
    return s.profile is not None and (s.complete or check.takes == "loads")


def _together(checks: list[Check], situations: Iterable[Situation]) -> Iterator[Margin]:
    for s in situations:
        for check in checks:
            margins = _with_code(check, s)
            if s.section_forces is not None and s.section_forces.kind == "joint":
                margins = [replace(m, over_joint=s.over_joint) for m in margins]
            elif check.takes in ("loads", "statics") and s.lug_growth:
                grown = ((m, s.lug_growth.get(m.at, m.over_joint)) for m in margins)
                margins = [replace(m, over_joint=ratio) for m, ratio in grown]
            yield from margins if s.governs else map(for_comparison, margins)


def _with_code(check: Check, s: Situation) -> Iterable[Margin]:
    """Return the margins of a check with the largest fitting factor of the codes to which it
    belongs, and with the names of these codes.

    A check that the study requires although no chosen code has it takes the largest fitting factor
    of all chosen codes.
    """
    if s.codes == DEFAULT_CODES:
        return check(s)
    codes = [code for code in s.codes if check in SETS[code]]
    factors = max((s.factors.of_code(code) for code in codes or s.codes), key=lambda f: f.fitting)
    name = ", ".join(codes)
    return [replace(m, code=name) for m in check(replace(s, factors=factors))]

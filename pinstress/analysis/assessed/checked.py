"""A pin in a case, checked: hand checks, margins of safety, bending arms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from assess.plastic.records import LimitLoad
from assess.strength.bending_arms import BendingArms, bending_arms
from assess.strength.collapse import collapse_margin
from assess.strength.lug_checks import lug_checks
from assess.strength.margin import PinMargin, skipped
from assess.strength.model_stress import model_margins
from assess.strength.nominal_stress import nominal_margins
from assess.strength.pin_checks import formula_margins, pin_checks
from assess.strength.records import HandCheck
from assess.strength.situation import LoadFactors, Situation, with_solved, with_supports
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.support.lugs.fit import on_structure
from fea.support.lugs.lug import Lug
from fea.support.records import JointResult
from geometry import CutPin, Pin
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study

FORMULA_CHECKS = "checks by formula"
LOAD_FACTOR_KEYS = ("limit_factor", "ultimate_factor", "fitting_factor")


@dataclass(frozen=True)
class Checked:
    """What was found of one pin in one case; arms: None where formulas do not apply."""

    hand_checks: tuple[HandCheck, ...]
    margins: tuple[PinMargin, ...]
    arms: BendingArms | None = None


def checked(
    study: Study,
    task: Task,
    peak: Maximum,
    joint: JointResult | None,
    limit: LimitLoad | None = None,
) -> Checked:
    """By formula and by the model. A pin that is cut is checked as if it were not."""
    factors = load_factors(study)
    required = study.table.analysis.required_safety_factor
    margins = model_margins(peak, task.material, factors, required)
    if limit is not None:
        margins.append(collapse_margin(limit, factors, peak.time))
    loads = next(x for x in task.loads if x.case == peak.case)
    profile = task.pin.profile if isinstance(task.pin, CutPin) else task.pin
    checks: tuple[HandCheck, ...] = ()
    arms = None
    if not isinstance(profile, Pin):
        why = "a profile, which a pin from a file does not have"
    else:
        s, why = _situation(study, task, profile, loads, joint)
        if s is None:
            checks = _lugs_checked(study, task, profile, loads)
            made_of = {lug.material.name: lug.material for lug in task.given}
            margins += nominal_margins(checks, made_of, factors)
        else:
            checks = pin_checks(s) + _lugs_checked(study, task, s.pin, s.loads)
            if peak.verdict == "rigid":
                why = "supports of the pin, or loads in equilibrium"
            else:
                margins += formula_margins(s, checks)
                arms = _arms(s, task, peak, joint)
    lacking = {FORMULA_CHECKS: why} if why else {}
    if isinstance(profile, Pin):
        lacking |= _held_lugs(study, task)
    for method, needs in lacking.items():
        margins.append(skipped(method, "", "limit", factors.at("limit"), needs))
    return Checked(checks, tuple(PinMargin(peak.pin, peak.case, m) for m in margins), arms)


def load_factors(study: Study) -> LoadFactors:
    """Those of a study."""
    a = study.table.analysis
    return LoadFactors(a.limit_factor, a.ultimate_factor, a.fitting_factor)


def factor_assumption(study: Study, found: Sequence[Checked]) -> tuple[str, ...]:
    """A sentence on the factors that the study does not give, if any margin depends on them."""
    table = study.table.analysis
    assumed = [key for key in LOAD_FACTOR_KEYS if key not in table.model_fields_set]
    if not assumed or not any(x.margins for x in found):
        return ()
    values = ", ".join(f"{key} {getattr(table, key):g}" for key in assumed)
    return (f"Margins of safety take the loads of the study as limit loads, with {values}.",)


def _situation(
    study: Study, task: Task, profile: Pin, loads: PinLoads, joint: JointResult | None
) -> tuple[Situation | None, str]:
    """None, and why, where neither the joint nor equilibrium gives all forces."""
    along = joint.along if joint else None
    if along is not None and along.times is not None and len(along.times) != len(loads):
        loads = task.between[loads.case](along.times)
    structure = [x.connection for x in task.lugs if x.connection not in profile.connections]
    simple = with_supports(profile, loads, structure)
    whole = with_solved(loads, structure, along) if structure and along else simple
    if whole is None:
        names = ", ".join(structure)
        return None, f"the forces of the structure's lugs {names}, which equilibrium does not give"
    table = study.table.pin[profile.name]
    pin = on_structure(profile, task.lugs) if structure else profile
    factors = load_factors(study)
    made_of, clamps = task.material, task.clamps
    even = study.table.analysis.bending_moment == "formula"
    return Situation(
        pin, made_of, whole, clamps, task.given, factors, table.replaceable,
        along, even, None if simple is whole else simple,
    ), ""  # fmt: skip


def _lugs_checked(study: Study, task: Task, pin: Pin, loads: PinLoads) -> tuple[HandCheck, ...]:
    """Of the lugs whose size is given."""
    sized = _sized(study, task)
    bores = {
        lug.connection: 2.0 * (pin.band(lug.connection).radius + lug.bushing.thickness)
        for lug in sized
        if lug.bushing is not None
    }
    return lug_checks(pin, sized, loads, bores)


def _sized(study: Study, task: Task) -> list[Lug]:
    given = study.table.pin[task.pin.name].lug
    return [lug for lug in task.given if given[lug.connection].outer_diameter]


def _held_lugs(study: Study, task: Task) -> dict[str, str]:
    """Checks that lugs at clamps lack, and what."""
    clamped = {task.pin.surface(name) for name in task.clamps}
    names = [x.connection for x in _sized(study, task) if x.connection in clamped]
    why = "the force that a clamp takes, which contact with the lug instead of the clamp gives"
    return {f"lug of {name}: net section, shear-out, bearing": why for name in names}


def _arms(s: Situation, task: Task, peak: Maximum, joint: JointResult | None) -> BendingArms:
    """At the governing instant, which is one of the joint's."""
    now = s.by_formula.at(np.array([0]))
    if peak.time is not None and s.joint is None and peak.case in task.between:
        now = task.between[peak.case](np.array([peak.time]))
    elif peak.time is not None and s.by_formula.times is not None:
        now = s.by_formula.at(np.array([np.abs(s.by_formula.times - peak.time).argmin()]))
    moment, model = (joint.bending_moment, joint.model) if joint else (None, "")
    return bending_arms(replace(s, loads=now, simple=None), moment, model)

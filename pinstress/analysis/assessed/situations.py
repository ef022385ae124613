"""The situation of each row, its margins of safety, and the arms of its bending moment."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from assess.checks import margins_of
from assess.codes import DEFAULT_CODES, FITTING_FACTORS, PartialFactors
from assess.judgement import against_yield
from assess.lug_factors import LugFactors
from assess.margin import (
    CLAMPED_LUG_PREFIX,
    COMPARISON_SUFFIX,
    FORMULA_CHECKS,
    OMITS_CUTS,
    Margin,
    skipped,
    worst_places,
)
from assess.plastic.records import LimitLoad, LugCollapse
from assess.situation import LoadFactors, Situation, SolvedRow, with_solved, with_supports
from assess.strength.bending_arms import BendingArms, bending_arms
from assess.strength.hand_checks import BEARING_METHODS, BENDING_METHODS
from assess.strength.model_stress import YIELD_METHOD
from assess.strength.plastic_bending import PLASTIC_METHOD
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.fit import on_structure
from fea.support.records import JointResult
from geometry import PinLike
from pinbase.keys import lug_key
from pinstress.study.model.lost_fits import lost_fits
from pinstress.study.model.requirements import required_by_formula, required_factor
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from reports.data.lug_modes import BEARING, PIN_AND_LUGS, lug_mode
from reports.data.row import PinResult

L = TypeVar("L", LimitLoad | None, LugCollapse)
FORMULA_KINDS = "hand", "clause"
RANGE_BASES = tuple(
    f"with the {end} end of the range of the yield strength" for end in ("lower", "upper")
)
# The yield strength of a pin with a hardened surface that checks by formula use.
CORE_BASIS, CASED_BASIS = "with the core's yield strength", "with the strengths of case and core"
CASED_METHODS = BENDING_METHODS | {PLASTIC_METHOD}
FORCE_OF_CLAMP = (
    "the force that a clamp takes, which contact with the lug instead of the clamp gives"
)
LOAD_FACTOR_KEYS = ("limit_factor", "ultimate_factor", "fitting_factor")


def assessed(study: Study, task: Task, row: PinResult) -> PinResult:
    """Return a row with its judgement against yield and its margins by formula and by the model.

    A pin with cuts is checked as if it had none, and its margins say so.
    """
    loads = next(x for x in task.loads if x.case == row.case)
    required = required_factor(study, row.pin, row.case)
    s, why = _situation(study, task, loads, row.joint)
    solved = SolvedRow(row.maximum, row.limit_load, required, row.joint_growth)
    by_formula = required_by_formula(study, row.pin, row.case)
    s = replace(s, row=solved, lug_collapses=row.lug_collapses, required=by_formula)
    rigid = row.verdict == "rigid"
    if s.complete and rigid and not why:
        why = "supports of the pin or loads in equilibrium"
    margins = [_of_core(s, margin) for margin in _with_ranges(s, margins_of(s))]
    margins = _without_cuts(task.pin, margins)
    counted = margins
    if s.complete and (rigid or not s.loaded_across):
        counted = [m for m in margins if m.kind not in FORMULA_KINDS]
    return replace(
        row,
        judgement=against_yield(row.maximum, task.material.yield_strength, required),
        strength_range=task.material.strength_range,
        margins=tuple(margins),
        worst=tuple(worst_places([*counted, *_skipped_checks(s, why)])),
        arms=None if why else _arms(s, task, row),
        lost_fits=lost_fits(study, task, row.case),
    )


def _with_ranges(s: Situation, margins: Sequence[Margin]) -> list[Margin]:
    """Return margins that hold over the ranges of yield strengths: each margin at its worse end.

    The worse end is the upper one where a check uses F_u / F_y (the effective width of a net
    section). The margin of the model against yield stays as it is, since the range is part of the
    outcome of its row (reports.data.dependence).
    """
    made_of = [s.material, *(m for x in s.lugs for m in x.materials)]
    if all(m.strength_range is None for m in made_of):
        return list(margins)
    ends = [[replace(m, basis=_joined(m.basis, basis)) if m not in margins else m
             for m in margins_of(_at_end(s, end)) if m.method != YIELD_METHOD]
            for end, basis in enumerate(RANGE_BASES)]  # fmt: skip
    low, high = ends
    # A check whose number of margins changes with the strength has those of both ends.
    alike = [m.method for m in low] == [m.method for m in high]
    pairs = zip(low, high, strict=True) if alike else ((m,) for m in low + high)
    worse = [m for pair in pairs for m in _worse(pair)]
    return [m for m in margins if m.method == YIELD_METHOD] + worse


def _worse(ends: tuple[Margin, ...]) -> tuple[Margin, ...]:
    """Return the worse of one margin at both ends of a range, or both if only one could be made:
    the missing one may have been the worse.
    """
    made = [not m.needs for m in ends]
    return (max(ends, key=lambda m: m.used),) if all(made) or not any(made) else ends


def _at_end(s: Situation, end: int) -> Situation:
    """Return a situation with yield strengths at the lower (0) or upper (1) ends of their
    ranges.
    """
    lugs, sized = (
        tuple(x.with_materials(lambda m: m.at_end(end)) for x in some) for some in (s.lugs, s.sized)
    )
    of_lugs = {lug.connection: lug.material for lug in s.lugs}
    return replace(
        s, material=s.material.at_end(end), lugs=lugs, sized=sized,
        row=s.row and replace(s.row, limit_load=_limit_at_end(s.row.limit_load, s.material, end)),
        lug_collapses=tuple(
            _ultimate_at_end(_limit_at_end(x, of_lugs[x.connection], end), end)
            for x in s.lug_collapses
        ),
    )  # fmt: skip


def _limit_at_end(limit: L, material: Material, end: int) -> L:
    """Return a limit load at an end of the range of the yield strength.

    The limit load is proportional to the yield strength; the hardening of the material is, too.
    """
    if limit is None or material.strength_range is None:
        return limit
    ratio = material.strength_range[end] / (material.yield_strength or 1.0)
    lower, upper = (None if x is None else ratio * x for x in (limit.lower, limit.upper))
    return replace(limit, lower=lower, upper=upper)


def _ultimate_at_end(limit: LugCollapse, end: int) -> LugCollapse:
    """Return the limit load of a lug with its ultimate load at an end of the range of the yield
    strength.
    """
    if not limit.ultimate_ends:
        return limit
    ultimate, breaks_by = limit.ultimate_ends[end]
    return replace(limit, ultimate=ultimate, breaks_by=breaks_by)


def _joined(*texts: str) -> str:
    return "; ".join(filter(None, texts))


def _of_core(s: Situation, margin: Margin) -> Margin:
    """Return a margin by formula with a remark on the yield strength that it uses for a hardened
    pin.
    """
    made_of_pin = margin.material in ("", s.material.name)
    if not s.material.hardened or margin.kind not in FORMULA_KINDS or not made_of_pin:
        return margin
    method = margin.method.removesuffix(f", {COMPARISON_SUFFIX}")
    known = CASED_BASIS if method in CASED_METHODS else CORE_BASIS
    return replace(margin, basis=_joined(margin.basis, known))


def _without_cuts(pin: PinLike, margins: Sequence[Margin]) -> list[Margin]:
    """Return margins in which those by formula state that they omit the cuts of the pin, where the
    cuts may matter.

    Any cut matters to checks along the pin. To the pressure on bands, of which only the worst is
    reported, cuts matter that open into any of the bands.
    """
    if not pin.cuts:
        return list(margins)
    made = [m for m in margins if m.kind in FORMULA_KINDS and m.demand is not None]
    bands = [pin.band(name) for name in {m.at for m in made if _on_bands(m)}]
    openings = [cut.opens for cut in pin.cuts.values()]
    open_ = any(low < band.z1 and band.z0 < high for band in bands for low, high in openings)

    def matter(m: Margin) -> bool:
        if m.kind not in FORMULA_KINDS or m.demand is None:
            return False
        return open_ if _on_bands(m) else lug_mode(m.method) in (None, PIN_AND_LUGS)

    def omitting(m: Margin) -> Margin:
        return replace(m, omits=" ".join(filter(None, (m.omits, OMITS_CUTS))))

    return [omitting(m) if matter(m) else m for m in margins]


def _on_bands(margin: Margin) -> bool:
    """Return whether a margin concerns the pressure on a band."""
    method = margin.method.removesuffix(f", {COMPARISON_SUFFIX}")
    return method in BEARING_METHODS or lug_mode(method) == BEARING


def load_factors(study: Study) -> LoadFactors:
    """Return the load factors of a study; assess.checks adds the fitting factor that a code demands
    if the study states none.
    """
    a = study.table.analysis
    stated = "fitting_factor" in a.model_fields_set
    return LoadFactors(a.limit_factor, a.ultimate_factor, a.fitting_factor, stated)


def factor_assumption(study: Study, rows: Iterable[PinResult]) -> tuple[str, ...]:
    """Return a sentence on the factors that the study omits, if any margin depends on them."""
    table = study.table.analysis
    assumed = [key for key in LOAD_FACTOR_KEYS if key not in table.model_fields_set]
    if not assumed or not any(row.worst for row in rows):
        return ()
    values = ", ".join(f"{key} {getattr(table, key):g}" for key in assumed)
    if "fitting_factor" in assumed:
        fitting = {code: f for code, f in FITTING_FACTORS.items() if code in table.codes}
        values += "".join(f" ({f:g} for the code {code})" for code, f in fitting.items())
    return (f"Margins of safety take the loads of the study as limit loads, with {values}.",)


def _situation(
    study: Study, task: Task, loads: PinLoads, joint: JointResult | None
) -> tuple[Situation, str]:
    """Return the situation of a row and the reason why it is incomplete.

    The reason states that the pin has no profile, that a clamp is in a cut, or that neither the
    joint nor equilibrium gives all forces. It is empty for a complete situation.
    """
    table = study.table.pin[task.pin.name]
    sized = tuple(x for x in task.given if table.lug[x.connection].outer_diameter)
    even, codes = study.table.analysis.bending_moment == "formula", study.table.analysis.codes
    profile = task.pin.profile
    if profile is None:
        s = Situation(None, task.material, loads, factors=load_factors(study), codes=codes)
        return s, "a profile, which a pin from a file does not have"
    s = Situation(
        profile, task.material, loads, task.clamps, task.given, load_factors(study),
        table.replaceable, even_governs=even, sized=sized, codes=codes,
        design_factor=study.table.analysis.design_factor, bending_factor=table.bending_factor,
        partial=PartialFactors(**dict(study.table.analysis.partial_factors)),
        aisc=study.table.analysis.aisc,
        lug_factors={name: LugFactors(**dict(lug.factors)) for name, lug in table.lug.items()},
        lug_stresses=joint.lugs if joint else (), shank_angles=task.shanks.get(loads.case, {}),
    )  # fmt: skip
    in_cuts = [name for name in task.clamps if name in task.pin.cuts]
    if in_cuts:  # the profile has no cuts
        on_profile = tuple(name for name in task.clamps if name not in in_cuts)
        why = f"the force that the clamp takes in {', '.join(in_cuts)}, which no formula gives"
        return replace(s, clamps=on_profile, complete=False), why
    along = joint.along if joint else None
    now = loads
    if along is not None and along.times is not None and len(along.times) != len(loads):
        now = task.between[loads.case](along.times)
    structure = [x.connection for x in task.lugs if x.connection not in profile.connections]
    simple = with_supports(profile, now, structure)
    whole = with_solved(now, structure, along) if structure and along else simple
    if whole is None:
        names = ", ".join(structure)
        why = f"the forces of the structure's lugs {names}, which equilibrium does not give"
        return replace(s, complete=False), why
    pin = on_structure(profile, task.lugs) if structure else profile
    simple = None if simple is whole else simple
    s = replace(s, profile=pin, loads=whole, joint=along, simple=simple)
    if joint is None or joint.range is None:
        return s, ""
    shared = {x: ratio for x, ratio in joint.range.lugs.items() if x in structure}
    return replace(s, over_joint=joint.range.across, lug_growth=shared), ""


def _skipped_checks(s: Situation, why: str) -> Iterable[Margin]:
    """Return, as skipped margins, the checks that a situation does not allow.

    These are the checks by formula if they lack something (`why`); checks of lugs at clamps, whose
    force no formula gives; checks that are required of lugs of unknown size; and clauses of chosen
    codes for such lugs.
    """
    lacking = {FORMULA_CHECKS: why} if why else {}
    if s.profile is not None:
        clamped = {s.profile.surface(name) for name in s.clamps}
        lacking |= {
            f"{CLAMPED_LUG_PREFIX}{lug.connection}: net section, shear-out, bearing": FORCE_OF_CLAMP
            for lug in s.sized
            if lug.connection in clamped
        }
        sized = {lug.connection for lug in s.sized}
        if s.required:
            lacking |= {
                f"{CLAMPED_LUG_PREFIX}{lug.connection}: shear-out, bearing": lug_key(
                    s.profile.name, lug.connection, "outer_diameter"
                )
                for lug in s.lugs
                if lug.connection in s.loads.surfaces and lug.connection not in sized
            }
        if s.codes != DEFAULT_CODES:
            lacking |= {
                f"clauses for the lug of {name}": lug_key(s.profile.name, name, "outer_diameter")
                for name in s.loads.surfaces
                if name not in sized
            }
    factor = s.factors.at("limit")
    return [skipped(name, "", "hand", "limit", factor, needs) for name, needs in lacking.items()]


def _arms(s: Situation, task: Task, row: PinResult) -> BendingArms:
    """Return the arms of the bending moment at the governing instant, including the arm from the
    joint's solution.
    """
    peak, joint = row.maximum, row.joint
    now = s.by_formula.at(np.array([0]))
    if peak.time is not None and s.joint is None and peak.case in task.between:
        now = task.between[peak.case](np.array([peak.time]))
    elif peak.time is not None and s.by_formula.times is not None:
        now = s.by_formula.at(np.array([np.abs(s.by_formula.times - peak.time).argmin()]))
    moment, model = (joint.bending_moment, joint.model) if joint else (None, "")
    return bending_arms(replace(s, loads=now, simple=None), moment, model)

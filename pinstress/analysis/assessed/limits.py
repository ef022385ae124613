"""Limit loads of the rows of a task that the study or `--limit-load` requests.

Limit loads of lugs are computed only if the study or the run requests more than "auto".

A factor that [[require]] states for the limit load counts as a request, unless the study excludes
the pin or the elastic stress already meets the factor. Without a request, the limit load of a row
that yields is computed if it takes at most UNASKED_LIMIT_LOAD_SECONDS of processor time. So the
computer may decide whether a limit load is computed, but never its value.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from assess.margin import strength_key
from assess.plastic.records import LimitLoad, LugCollapse
from assess.requirement import LEVELS_OF_CHECK
from fea.core.material import Material
from fea.core.peak import Maximum, meets_limit
from fea.core.pin_loads import PinLoads
from fea.support.lugs.fit import on_structure
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, Pin, PinLike, body_of_revolution
from geometry.shape.lug_outline import LugOutline
from pinbase.keys import lug_key
from pinbase.memo import Memo
from pinbase.processes.pool import Tell
from pinstress.analysis.plan import Plan
from pinstress.study.model.requirements import stated_factor
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study

if TYPE_CHECKING:
    from assess.plastic.lug.ultimate import LugUltimate
    from assess.plastic.solve import Rung
    from fea.support.support import Solution

NOT_HARDENED_NOTE = "not for a pin with a hardened surface, which has two yield strengths"
NOT_ON_FOUNDATIONS_NOTE = 'not for a pin on elastic foundations: use joints = "contact"'

BOUNDS_BATCH = 64  # instants whose bounds as a beam are computed at once: limits memory
SAME_BOUND = 0.01  # relative: up to this difference of bounds the instant of largest stress is kept
UNASKED_LIMIT_LOAD_SECONDS = 20.0  # s of processor time of a limit load that was not requested


def limit_rung(study: Study, pin: str) -> Rung | None:
    """Return the model for the limit loads of a pin, or None if they are not requested."""
    requested = study.table.analysis.limit_load
    if isinstance(requested, list):
        return "solid" if pin in requested else None
    rungs: dict[str, Rung | None] = {"auto": "auto", "always": "solid", "never": None}
    return rungs[requested]


def rung_of(plan: Plan, pin: str) -> Rung | None:
    """Return the model for the limit loads of a pin in a run, which may request more than the
    study.

    Coarse solutions, of which only ratios are taken, need no limit load.
    """
    if plan.requirement.for_ratio:
        return None
    return limit_rung(plan.study, pin) or ("auto" if plan.limit_load else None)


def limit_seconds(plan: Plan) -> float:
    """Return the processor time, s, that a limit load may take; infinite if it was requested."""
    requested = plan.limit_load or plan.study.table.analysis.limit_load != "auto"
    return inf if requested else UNASKED_LIMIT_LOAD_SECONDS


def limit_loads(
    plan: Plan, task: Task, solutions: Iterable[Solution], tell: Tell
) -> tuple[LimitLoad | None, ...]:
    """Return the limit load of each case of a task, None where it is not requested."""
    rung = rung_of(plan, task.pin.name)
    return tuple(_limit_load(plan, task, solved, rung, tell) for solved in solutions)


def collapse_factors(study: Study, task: Task) -> dict[str, float]:
    """Return for each case the largest factor against collapse that [[require]] states."""
    factors = {}
    for loads in task.loads:
        stated = (
            stated_factor(study, task.pin.name, loads.case, "limit load", level)
            for level in LEVELS_OF_CHECK["limit load"]
        )
        if largest := max(filter(None, stated), default=None):
            factors[loads.case] = largest
    return factors


def _limit_load(
    plan: Plan, task: Task, solved: Solution, rung: Rung | None, tell: Tell
) -> LimitLoad | None:
    peak, seconds = solved.peak, limit_seconds(plan)
    required = collapse_factors(plan.study, task).get(peak.case)
    strength = peak.yield_strength(task.material.yield_strength)
    if rung and required and strength and not meets_limit(peak, strength / required):
        rung, seconds = "solid", inf  # the limit load decides whether the requirement is met
    if rung is None or not limit_asked(peak, task, rung):
        return None
    if task.material.hardened:
        return LimitLoad("none", note=NOT_HARDENED_NOTE)
    from assess.plastic.solve import limit_load  # imports a model

    tell(f"pin {task.pin.name}, limit load in {peak.case}")
    pin, in_lugs = task.pin, bool(task.lugs) and task.pin.revolved
    if in_lugs:
        if solved.rings is None:
            return LimitLoad("none", note=NOT_ON_FOUNDATIONS_NOTE)
        pin = solved.rings
    clamps = tuple(pin.surface(name) for name in task.clamps)
    try:
        links = nearest_to_collapse(solved, pin, task.material, clamps)
        loads = solved.pressed(links) if in_lugs else links
        memory = plan.requirement.memory
        limit = limit_load(pin, task.material, clamps, loads, rung, memory, seconds)
    except ArithmeticError as error:  # the elastic result is still valid
        return LimitLoad("none", note=str(error))
    return replace(limit, time=links.time())


def nearest_to_collapse(
    solved: Solution, pin: PinLike, material: Material, clamps: tuple[str, ...]
) -> PinLoads:
    """Return the loads of the links at the instant at which the pin, as a beam, has the lowest
    factor against collapse.

    This need not be the instant of the largest stress, since a notch raises stress but not the risk
    of collapse. pin: the pin on which the loads act.
    """
    from assess.plastic.hinge import beam_bounds  # imports a model

    governing, every, profile = solved.peak.governing, solved.loads, body_of_revolution(pin)
    assert governing is not None
    if profile is None or not profile.stepped or every.times is None or governing.times is None:
        return governing
    rings, instants = every.on_rings, np.arange(len(every))
    lower = np.concatenate([
        beam_bounds(profile, material, clamps, rings.at(instants[k : k + BOUNDS_BATCH])).lower
        for k in range(0, len(every), BOUNDS_BATCH)
    ])  # fmt: skip
    at_largest = int(np.abs(every.times - governing.times[0]).argmin())
    least = int(lower.argmin())
    if lower[at_largest] <= (1.0 + SAME_BOUND) * lower[least]:
        return governing
    return every.links.at(np.array([least]))


def limit_asked(peak: Maximum, task: Task, rung: Rung) -> bool:
    """Return whether the limit load of a row is computed."""
    factor = peak.safety_factor(task.material.yield_strength)
    if factor is None or peak.governing is None:
        return False
    return rung == "solid" or factor < 1.0


def lugs_asked(plan: Plan, task: Task) -> bool:
    """Return whether the limit loads of the lugs of a task are requested."""
    rung = rung_of(plan, task.pin.name)
    return bool(task.given) and (rung == "solid" or (rung is not None and plan.limit_load))


def lug_collapses(plan: Plan, task: Task, tell: Tell) -> tuple[LugCollapse, ...]:
    """Return the limit loads of the lugs that the study gives for a pin, pulled along their shanks;
    empty unless the study or the run requests them (`lugs_asked`).
    """
    profile = task.pin.profile
    if profile is None or not lugs_asked(plan, task):
        return ()
    tell(f"pin {task.pin.name}, limit loads of lugs")
    pin, same = on_structure(profile, task.given), Memo()
    return tuple(_lug_collapse(pin, lug, same) for lug in task.given)


def _lug_collapse(pin: Pin, lug: Lug, same: Memo) -> LugCollapse:
    """Return the limit load of a lug, whose thickness is the length of its band of the pin.

    same: the limit loads of outlines that were solved before.
    """
    strength = lug.material.yield_strength
    if lug.shank is None:
        return LugCollapse(lug.connection, needs=lug_key(pin.name, lug.connection, "shank"))
    if strength is None:
        return LugCollapse(lug.connection, needs=strength_key(lug.material.name, "yield"))
    from assess.plastic.lug.limit_load import lug_limit_load  # imports solvers

    band = pin.band(lug.connection)
    try:
        outline = lug.outline(band.radius)
        limit = same.get((outline, strength), lambda: lug_limit_load(outline, strength))
    except (ArgumentError, ArithmeticError) as error:  # the margin says why
        return LugCollapse(lug.connection, needs=f"a limit load: {error}")
    lower, upper = band.length * limit.lower, band.length * limit.upper
    metals = [lug.material]
    if lug.material.strength_range is not None and lug.material.failure_strain is not None:
        metals += [lug.material.at_end(end) for end in (0, 1)]
    given, *ends = (_lug_ultimate(outline, band.length, metal, same) for metal in metals)
    return LugCollapse(lug.connection, lower, upper, "", *given, ultimate_ends=tuple(ends))


def _lug_ultimate(
    outline: LugOutline, thickness: float, metal: Material, same: Memo
) -> tuple[float | None, str]:
    """Return the load, N, at which a lug breaks, and what ends it; or None and what is missing.

    thickness: of the lug, m. A material without a failure strain gives None and an empty text.
    """
    if metal.failure_strain is None:
        return None, ""
    if metal.ultimate_strength is None and not metal.hardening:
        return None, strength_key(metal.name, "ultimate")
    from assess.plastic.lug.true_curve import true_curve  # imports solvers
    from assess.plastic.lug.ultimate import lug_ultimate

    def pulled() -> LugUltimate:
        hardens = metal if metal.hardening else true_curve(metal)
        return lug_ultimate(outline, hardens, metal.failure_strain)

    try:
        broken = same.get((outline, metal), pulled)
    except (ArgumentError, ArithmeticError) as error:  # the margin says why
        return None, f"an ultimate load: {error}"
    return thickness * broken.load, broken.ended_by

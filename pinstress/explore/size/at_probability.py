"""The least weight at which the probability of missing a factor stays within a limit.

Two searches alternate. The first finds the least weight of the study as it is, with a raised factor
for each row. The second finds, for this result, the factor of each row that is missed with the
given probability, by a first-order approximation (pinstress.explore.reliability.form). The ratio of
the row's own factor to it raises the factor of the next search.

Source: Du & Chen, J. Mech. Des. 126 (2004) 225 (sequential optimisation and assessment).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from scipy.special import ndtri

from pinbase.keys import key_part
from pinbase.processes.pool import Progress
from pinstress.analysis.remedies.secant import FACTOR_TOLERANCE
from pinstress.explore.reliability.designs import SolvedDesigns, for_values, random_numbers
from pinstress.explore.reliability.form import (
    NOISY_CLOSENESS,
    SMOOTH_CLOSENESS,
    Array,
    Closeness,
    form_quantile,
)
from pinstress.explore.reliability.open_ranges import without_strength_ranges
from pinstress.explore.size.least_weight import LightStudy, lighten
from pinstress.explore.size.pin_shape import kind_of
from pinstress.explore.size.search_log import SearchLog
from pinstress.explore.size.weight_search import WeightGoal
from pinstress.explore.sweep.batches import shapes
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.study.reading.file import Study
from reports.data.decision import low_factor

MAX_ROUNDS = 5
UNCHANGED_SHARE = 1e-12  # relative: a value that changes by less does not depend on the variables
MAX_FACTOR_EXCESS = 2.0 * FACTOR_TOLERANCE  # largest relative excess at which a search ends

Row = tuple[str, str]  # pin and case


def require_laws(study: Study, aim: WeightGoal, pins: Iterable[str] | None) -> None:
    """Check that a study has laws that permit this search.

    Raises: InputError for a study without laws, and for the law of a dimension that the search
    varies if the law does not move with the dimension.
    """
    parameters, _ = random_numbers(study)
    vary = study.table.vary
    assert vary is not None
    chosen = set(study.table.pin if pins is None else pins)
    for parameter in parameters:
        table, *inner = parameter.number.path
        if table != "pin" or inner[0] not in chosen:
            continue
        kind = kind_of(parameter.key.partition(f"pin.{key_part(inner[0])}.")[2])
        if kind in aim.vary and vary.parameters[parameter.key].tolerance is None:
            raise study.error(
                f"vary.parameters.{key_part(parameter.key)}: its law stays where it is when the "
                "dimension changes; give it a tolerance, which moves with it, or leave its kind "
                "out of --vary",
                code="law-of-a-dimension",
            )


def factors_at(
    study: Study, pins: Iterable[str], probability: float, progress: Progress
) -> dict[Row, float]:
    """Return for each row the factor that is missed with a given probability (factor_at).

    Raises: InputError.
    """
    parameters, space = random_numbers(study)
    laws = {path for p in parameters for path in p.number.paths}
    described = without_strength_ranges(for_values(study), laws)
    out: dict[Row, float] = {}
    for pin in pins:
        progress(f"pin {pin}, factor at {probability:g}", 0.95)
        evaluator = Evaluator(described, parameters, [pin])
        designs = SolvedDesigns(evaluator, space, 1, progress)
        close = NOISY_CLOSENESS if any(map(shapes, evaluator.numbers)) else SMOOTH_CLOSENESS
        for k, row in enumerate(evaluator.table):
            out[row] = factor_at(designs, k, probability, close)
    return out


def factor_at(designs: SolvedDesigns, row: int, probability: float, close: Closeness) -> float:
    """Return the factor of a row that is missed with a given probability, by a first-order
    approximation; NaN if it is not found, or if the stress is unbounded at that design.
    """

    def unused(u: Array) -> Array:
        return -designs.at(u, "FORM").used[:, row]

    size = designs.space.size
    estimate = form_quantile(unused, probability, size, close)
    at = estimate.u
    if estimate.why:
        # A row that no random number affects has no search direction, but it has a single value.
        at = np.zeros(size)
        around = float(ndtri(probability)) * np.eye(size)
        values = unused(np.concatenate([at[None, :], around, -around]))
        if not np.ptp(values) <= UNCHANGED_SHARE * abs(values[0]):
            return np.nan
    answers = designs.at(at[None, :], "FORM")
    return np.nan if answers.unbounded[0, row] else float(answers.factors[0, row])


def lighten_at(
    study: Study,
    aim: WeightGoal,
    probability: float,
    pins: list[str] | None,
    jobs: int,
    progress: Progress,
    log: SearchLog | None = None,
) -> LightStudy:
    """Find every pin's least weight at which the factor is missed with at most a given probability.

    log: as in `lighten`.

    Raises: InputError.
    """
    require_laws(study, aim, pins)
    log = SearchLog() if log is None else log
    design = lighten(study, aim, pins, jobs, progress, log)
    before = {pin.pin: pin.before for pin in design.pins}
    for _ in range(MAX_ROUNDS):
        names = [pin.pin for pin in design.pins]
        at = factors_at(design.study, names, probability, progress)
        design = replace(design, at=at, settled=design.settled and _reached(design, at, aim))
        if design.settled:
            break
        extra = {
            (p.pin, p.case): p.safety_factor / at[p.pin, p.case]
            for p in design.results.pins
            if p.safety_factor and np.isfinite(at.get((p.pin, p.case), np.nan))
        }
        design = lighten(study, replace(aim, extra_multiples=extra), pins, jobs, progress, log)
    else:
        at = factors_at(design.study, [pin.pin for pin in design.pins], probability, progress)
        design = replace(design, at=at, settled=design.settled and _reached(design, at, aim))
    updated = tuple(replace(pin, before=before[pin.pin]) for pin in design.pins)
    return replace(design, pins=updated)


def _reached(design: LightStudy, at: dict[Row, float], aim: WeightGoal) -> bool:
    """Whether every pin for which a result was found reaches the factor, with little excess."""
    for pin in design.pins:
        rows = [
            p
            for p in design.results.pins
            if p.pin == pin.pin and p.safety_factor and np.isfinite(p.safety_factor)
        ]
        low = [
            (low_factor(p) or 0.0) * at.get((p.pin, p.case), np.nan) / (p.safety_factor or 1.0) / x
            for p in rows
            if (x := aim.multiples.get((p.pin, p.case), 1.0))
        ]
        if pin.factor is None or not low:
            continue
        least = float(np.nanmin(low)) if np.isfinite(low).any() else np.inf
        if not aim.required <= least * (1.0 + 1e-9) <= aim.required * (1.0 + MAX_FACTOR_EXCESS):
            return False
    return True

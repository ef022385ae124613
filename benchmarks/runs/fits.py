"""The cost of fits: pins of the landing gear in lugs of H7/f7, whose lightly loaded motion has
narrow arcs of contact, in contrast to a heavy landing.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from benchmarks import ROOT
from benchmarks.timing import table
from fea.support.support import Solution
from pinstress import load_study
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.solve import solutions
from pinstress.study.reading.file import Study
from pinstress.study.schema.lugs import LugRangeTable, LugTable

FIT = "H7/f7"
PINS = "C", "E", "H"
WAYS = ("a range of clearance", "the fit", "the fit, every case to the tolerance")


def fits() -> str:
    """Return the table of processor times of each pin, s, both cases, and of the error of the minor
    case.
    """
    study = load_study(ROOT / "studies" / "landing_gear.toml")
    given, fitted = (prepare(x, pins=PINS) for x in (study, _fitted(study)))
    every = replace(fitted, requirement=replace(fitted.requirement, every=True))
    rows = list[tuple[object, ...]]()
    for pin in PINS:
        spent, found = zip(*(_solved(plan, pin) for plan in (given, fitted, every)), strict=True)
        told = [[_stress(x) for x in of_way] for of_way in found[1:]]
        for (case, value, error), (_, best, _) in zip(*told, strict=True):
            off = f"{100.0 * (best / value - 1.0):+.1f} ({100.0 * error / value:.1f})"
            rows.append((pin, case, *(f"{s:.1f}" for s in spent), off))
    head = ("pin", "case of both", *(f"{way} [s]" for way in WAYS), "off, stated [%]")
    return table(head, rows)


def _fitted(study: Study) -> Study:
    """Return the study with a fit instead of clearances and their range."""

    def fitted(lug: LugTable) -> LugTable:
        return lug.model_copy(update={"fit": FIT, "clearance": None, "range": LugRangeTable()})

    pins = {
        name: pin.model_copy(update={"lug": {k: fitted(lug) for k, lug in pin.lug.items()}})
        for name, pin in study.table.pin.items()
    }
    return replace(study, table=study.table.model_copy(update={"pin": pins}))


def _solved(plan: Plan, pin: str) -> tuple[float, Sequence[Solution]]:
    (task,) = (task for task in plan.tasks if task.pin.name == pin)
    start = time.process_time()
    found = solutions(plan.study, task, plan.requirement, lambda _: None)
    return time.process_time() - start, found


def _stress(solution: Solution) -> tuple[str, float, float]:
    peak = solution.peak
    assert peak.max_von_mises is not None
    return peak.case, peak.max_von_mises, peak.error_estimate or 0.0

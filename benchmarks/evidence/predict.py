"""The predictions: from studies, run as a user runs them, and from public functions where no study
exists.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import pinstress
from assess.margin import Margin
from benchmarks.evidence.comparison import (
    STUDIES,
    Comparison,
    Printed,
    printed_numbers,
    records,
    sources,
)
from benchmarks.evidence.plane import plane_predictions
from pinstress import changed_study, load_study
from reports.data.results import Results

IN_CONTACT, AT_ULTIMATE = " in contact", " at ultimate load"
# Changes of a study that prescribes its loads, by which its joint is solved, as is the default.
CONTACT = {
    "analysis.joints": "contact",
    "analysis.model": "auto",
    "analysis.code": "aircraft",
    "analysis.tolerance": 0.1,
}
SLOW_STUDIES = "round_head", f"affdl_joint{IN_CONTACT}", f"niu_axial{IN_CONTACT}"
RATIOS = 1.5, 2.0  # e/D of the bars
BORE, THICKNESS, KSI_AREA = 0.5, 0.25, 125.0  # in; force of 1 ksi on the bearing area, lbf
LIMIT, ULTIMATE = "lug, limit load", "lug, ultimate load"
Tell = Callable[[str], object]


def everything(tell: Tell) -> list[Comparison]:
    """Return all comparisons, which takes six minutes."""
    return [*broken_bars(tell), *in_print(tell=tell)]


def in_print(slow: bool = True, tell: Tell = lambda _: None) -> list[Comparison]:
    """Return the comparisons with printed and exact numbers.

    slow: whether to include studies that take more than a second.
    """
    wanted = [p for p in printed_numbers() if slow or p.study not in SLOW_STUDIES]
    plane = plane_predictions()
    wanted += [p for p in plane if p.source == "persson"]
    out = []
    for printed in wanted:
        tell(f"{printed.source}: {printed.quantity}")
        value = plane[printed] if printed in plane else _read(_run(printed.study), printed)
        out.append(Comparison(sources()[printed.source].kind, printed, value * printed.times))
    return out


def broken_bars(tell: Tell = lambda _: None, every: int = 1) -> list[Comparison]:
    """Return the limit load at yield and the ultimate load of Moore's bars over the loads that
    broke them.

    every: n, to take every n-th bar only.
    """
    study = load_study(STUDIES / "moore1948.toml")
    cases = [(row, ratio) for row in records("moore1948.csv") for ratio in RATIOS]
    out = []
    for row, ratio in cases[::every]:
        tell(f"{row['report']}: {row['bar']}, e/D {ratio:g}")
        changes = {
            "material.bar.ultimate_strength": f"{row['ultimate_ksi']} ksi",
            "material.bar.yield_strength": f"{row['yield_ksi']} ksi",
            "material.bar.failure_strain": math.log(1.0 + float(row["elongation"])),
            "pin.P.lug.B.shank.end": ratio * BORE,
        }
        results = pinstress.run(changed_study(study, changes), limit_load=True)
        for kind, check in (("limit", LIMIT), ("ultimate", ULTIMATE)):
            printed = Printed(
                "moore", "moore1948", f"{row['report']}: {row['bar']}, e/D {ratio:g}", check, "B",
                "allowable", 1.0 / KSI_AREA, row[f"bearing_ksi_{ratio}"], "ksi", "model",
            )  # fmt: skip
            out.append(Comparison(kind, printed, _read(results, printed) * printed.times))
    return out


@cache
def _run(study: str) -> Results:
    """Return the results of a study of studies/evidence, which is run once."""
    name = study.removesuffix(IN_CONTACT)
    loaded = load_study(STUDIES / f"{name}.toml")
    if name != study:
        loaded = changed_study(loaded, CONTACT)
    return pinstress.run(loaded, limit_load=study in SLOW_STUDIES)


def _read(results: Results, printed: Printed) -> float:
    """Return the number that is compared with a printed one, in the study's units.

    Raises: LookupError if the study has no such check.
    """
    every = [m.margin for m in results.margins]
    every += [check for pin in results.pins for check in pin.hand_checks]
    governing = (m for m in every if (m.method, m.at) == (printed.check, printed.at) and m.governs)
    read = printed.read.removesuffix(AT_ULTIMATE)
    levels = ("ultimate",) if read != printed.read else ("limit", "ultimate")
    margin = next((m for m in governing if not m.needs and m.level in levels), None)
    if margin is None:
        raise LookupError(f"{printed.study} has no check {printed.check!r} at {printed.at!r}")
    if read.startswith("work "):
        return _of_work(margin, read.removeprefix("work "))
    if read == "1 + margin":
        return 1.0 / margin.used
    return float(getattr(margin, read))


def _of_work(margin: Margin, symbol: str) -> float:
    """Return a quantity of the printed working of a check, by its symbol."""
    quantities = (q for w in margin.work for q in (w.result, *w.quantities))
    return next(q.value for q in quantities if q.symbol == symbol)

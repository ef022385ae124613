"""Limit and ultimate loads of lugs, compared with those of twenty bars that broke.

R. L. Moore, NACA TN 1503 and TN 1502 (1948): a steel pin of 0.5 in in bars 2 in wide and 0.25 in
thick with square ends; the tables give the tensile test and the bearing ultimate.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from assess.plastic.lug.limit_load import LugLimitLoad, lug_limit_load
from assess.plastic.lug.true_curve import true_curve
from assess.plastic.lug.ultimate import MESH_SIZES, PullCurve, pull
from benchmarks import ROOT
from benchmarks.timing import Floats, table
from fea.core.material import Material
from geometry.shape.lug_outline import LugOutline

TESTS = ROOT / "studies" / "evidence" / "moore1948.csv"
INCH, KSI, LBF = 0.0254, 6.894757e6, 4.4482216
BORE, WIDTH = 0.5 * INCH, 2.0 * INCH
FITTED_ON = "TN 1503"
HEAD = (
    "report", "bar", "e/D", "measured, ksi", "Fty", "(Fty + Ftu)/2", "Ftu", "shape", "ln(1 + A)",
    "fitted",
)  # fmt: skip
NOTES = """Bearing ultimates predicted over measured. *Fty*, *(Fty + Ftu)/2*, *Ftu*: perfectly
plastic limit load at that flow stress, middle of the strict bracket ({brackets}). *Shape*: finite
strain, the true curve of Fty and Ftu, no failure strain. *ln(1 + A)*: broken when the equivalent
plastic strain reaches that of the elongation in 2 in. *Fitted*: broken at {multiple:.2f}
ln(1 + A), which gives the bars of TN 1503 the least mean square; TN 1502 are predictions."""
PUBLISHED = """An open lug solver (plane strain, rigid pin) on TN 1503: perfectly plastic,
(Fty + Ftu)/2 9 to 28 % low, Ftu 1 to 17 % low; finite strain with failure at ln(1 + A) for 75S
and twice that for the others -2.9 to +1.8 %, on TN 1502 -8.5 to +2.8 % (ours {theirs}).
Its collapse of a round head, 0.5 / 1.5 / 0.25 in, 60 ksi: 9842 lbf in finite strain,
ours {finite:.0f}; 9485 in small strain, ours {lower:.0f} to {upper:.0f}, by elements
of displacement {small:.0f}."""


@dataclass(frozen=True)
class BrokenBar:
    """A test: strengths and bearing ultimate in ksi; e/D (`ratio`); the curve of the pulled lug."""

    report: str
    name: str
    ratio: float
    ultimate: float
    yield_strength: float
    elongation: float
    measured: float
    curve: PullCurve

    def by_strain(self, multiple: float | None) -> float:
        """Return predicted over measured load, with failure at a multiple of ln(1 + A); None: no
        failure strain.
        """
        limit = None if multiple is None else multiple * math.log(1.0 + self.elongation)
        return self.curve.largest(limit)[0] / (BORE * KSI) / self.measured


def lugs() -> str:
    """Return the table, with mean and standard deviation of each report, and the
    published results.
    """
    limits = {ratio: lug_limit_load(_bar(ratio), KSI) for ratio in (1.5, 2.0)}
    bars = _bars()
    multiple = _fitted([b for b in bars if b.report == FITTED_ON])
    values = np.array([_predictions(b, limits[b.ratio], multiple) for b in bars])
    rows: list[tuple[object, ...]] = [
        (b.report, b.name, f"{b.ratio:g}", f"{b.measured:.1f}", *_texts(v))
        for b, v in zip(bars, values, strict=True)
    ]
    statistics: tuple[tuple[str, Callable[[Floats], Floats]], ...] = (
        ("mean", lambda v: v.mean(axis=0)),
        ("standard deviation", lambda v: v.std(axis=0, ddof=1)),
        ("least", lambda v: v.min(axis=0)),
        ("largest", lambda v: v.max(axis=0)),
    )
    for report in dict.fromkeys(b.report for b in bars):
        of_report = values[[b.report == report for b in bars]]
        rows += [(report, f"*{n}*", "", "", *_texts(f(of_report))) for n, f in statistics]
    brackets = ", ".join(f"e/D {r:g}: ± {m.half_width:.1%}" for r, m in limits.items())
    notes = NOTES.format(brackets=brackets, multiple=multiple)
    return "\n\n".join([table(HEAD, rows), notes, _published(bars)])


def _bars() -> list[BrokenBar]:
    out = []
    with TESTS.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            high, low = float(row["ultimate_ksi"]), float(row["yield_ksi"])
            metal = Material(row["bar"], 10.4e3 * KSI, 0.33, None, low * KSI, high * KSI)
            for ratio in (1.5, 2.0):
                curve = pull(_bar(ratio), true_curve(metal), MESH_SIZES[0])
                measured = float(row[f"bearing_ksi_{ratio}"])
                elongation = float(row["elongation"])
                out.append(
                    BrokenBar(
                        row["report"], row["bar"], ratio, high, low, elongation, measured, curve
                    )
                )
    return out


def _bar(ratio: float) -> LugOutline:
    """Return the end of a bar, by e/D; farther from the bore the bar does not yield."""
    return LugOutline("square", BORE, 0.0, WIDTH, WIDTH, ratio * BORE)


def _predictions(bar: BrokenBar, limit: LugLimitLoad, multiple: float) -> list[float]:
    per_flow = limit.load / (BORE * KSI) / bar.measured
    low, high = bar.yield_strength, bar.ultimate
    perfect = [per_flow * flow for flow in (low, (low + high) / 2.0, high)]
    return perfect + [bar.by_strain(m) for m in (None, 1.0, multiple)]


def _fitted(bars: list[BrokenBar]) -> float:
    """Return the multiple of ln(1 + A) with the least mean square of the errors."""

    def error(multiple: float) -> float:
        return sum((b.by_strain(multiple) - 1.0) ** 2 for b in bars)

    return float(minimize_scalar(error, bounds=(0.3, 6.0), method="bounded").x)


def _published(bars: list[BrokenBar]) -> str:
    """Return the results of another solver for these tests and for the collapse of a round head,
    with ours.
    """
    ranges = []
    for report in dict.fromkeys(b.report for b in bars):
        errors = [
            b.by_strain(1.0 if b.name.startswith("75S") else 2.0) - 1.0
            for b in bars
            if b.report == report
        ]
        ranges.append(f"{min(errors):+.1%} to {max(errors):+.1%}")
    head = LugOutline("round", 0.5 * INCH, 1.5 * INCH, 1.5 * INCH, 1.5 * INCH, 0.75 * INCH)
    metal = Material("perfect", 10.3e3 * KSI, 0.33, None, 60.0 * KSI)
    limit = lug_limit_load(head, 60.0 * KSI)
    finite = pull(head, metal, MESH_SIZES[0]).largest()[0]
    small = pull(head, metal, MESH_SIZES[0], finite=False, max_travel=0.5).largest()[0]
    loads = {"finite": finite, "small": small, "lower": limit.lower, "upper": limit.upper}
    force = 0.25 * INCH / LBF
    numbers = {name: load * force for name, load in loads.items()}
    return PUBLISHED.format(theirs=" and ".join(ranges), **numbers)


def _texts(values: list[float] | Floats) -> list[str]:
    return [f"{v:.3f}" for v in values]

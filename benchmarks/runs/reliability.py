"""Probabilities of failure with exact values: the accuracy of the methods that find them, the
number of designs, and how often their 95 % intervals contain the exact value.

The designs here are formulas, of which thousands are solved at once; they are sampled by the code
that `pinstress reliability` uses.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.special import ndtr
from scipy.stats import binom, chi2, norm

from pinstress.explore.reliability.assess import first_order, starts_of, weighted_sample
from pinstress.explore.reliability.designs import Answers, Marginal, NormalSpace, SolvedDesigns
from pinstress.explore.reliability.risk import AssessedRow, RiskColumn, Sample, risk_of
from pinstress.explore.reliability.sampling import plain_draws
from pinstress.study.schema.vary import ReliabilityTable
from reports.data.reliability import Risk

Array = NDArray[np.float64]

SEEDS = 200
TABLE = ReliabilityTable(samples=2_000, importance_samples=1_000)
TAIL = 0.0005  # probability of more, and of fewer, exact values in the intervals than stated


@dataclass(frozen=True)
class Exact:
    """A case with a known probability of failure.

    space: the random numbers.
    used: the used fraction of the strength as a function of them.
    probability: the exact probability that this fraction exceeds one.
    """

    name: str
    space: NormalSpace
    used: Callable[[Array], Array]
    probability: float


class Formula(SolvedDesigns):
    """Designs that a formula solves."""

    def __init__(self, case: Exact) -> None:
        self.case, self.space, self.count = case, case.space, 0
        self.evaluator = _Smooth()  # type: ignore[assignment]

    def at(self, u: Array, purpose: str) -> Answers:
        """Return the answers at u, as SolvedDesigns.at does."""
        self.count += len(u)
        used = self.case.used(self.space.physical(u))[:, None]
        never = np.zeros(used.shape, dtype=bool)
        return Answers(used, np.zeros_like(used), used, never, never)


class _Smooth:
    numbers = ()  # no parameter changes a mesh


def normal(mean: float, deviation: float) -> Marginal:
    """Return a normal number as a function of its standard normal deviate."""
    return lambda z: mean + deviation * z


def lognormal(mean: float, deviation: float) -> Marginal:
    """Return a lognormal number as a function of its standard normal deviate; mean and deviation
    are its own.
    """
    variance = math.log1p((deviation / mean) ** 2)
    return lambda z: mean * np.exp(math.sqrt(variance) * z - 0.5 * variance)


def cases() -> list[Exact]:
    """Return the cases, each with its probability in closed form or by an integral over
    one number.
    """
    same = normal(0.0, 1.0)
    return [
        _bar(),
        _ratio(),
        _cantilever(),
        _correlated(),
        Exact(
            "twenty loads: sum of normal numbers",
            NormalSpace((same,) * 20),
            lambda x: 1.0 + (x.sum(axis=1) / math.sqrt(20.0) - 3.0) / 6.0,
            float(ndtr(-3.0)),
        ),
        Exact(
            "either of two (series): beyond 3, or below −3.2",
            NormalSpace((same, same)),
            lambda x: 1.0 + (np.maximum(x[:, 0] - 3.0, -x[:, 0] - 3.2)) / 6.0,
            float(ndtr(-3.0) + ndtr(-3.2)),
        ),
        Exact(
            "both of two (parallel): each beyond 2",
            NormalSpace((same, same)),
            lambda x: 1.0 + (x.min(axis=1) - 2.0) / 6.0,
            float(ndtr(-2.0)) ** 2,
        ),
        _parabola("bent away from the mean (κ = +0.5)", 0.5),
        _parabola("bent towards the mean (κ = −0.2)", -0.2),
        Exact(
            "outside of a circle of 3.5, failure in all directions",
            NormalSpace((same, same)),
            lambda x: np.asarray(np.hypot(x[:, 0], x[:, 1]) / 3.5),
            float(chi2.sf(3.5**2, 2)),
        ),
    ]


def _bar() -> Exact:
    area = math.pi / 4.0 * 20.0**2
    space = NormalSpace((lognormal(300.0, 30.0), normal(75_000.0, 5_000.0)))

    def at(z: float) -> float:
        strength = float(space.marginals[0](np.array([z]))[0])
        return float(norm.pdf(z) * ndtr((75_000.0 - strength * area) / 5_000.0))

    exact = quad(at, -10.0, 10.0, epsabs=1e-14)[0]
    return Exact("bar in tension", space, lambda x: x[:, 1] / area / x[:, 0], exact)


def _ratio() -> Exact:
    """Return the case of two lognormal numbers, whose logarithms differ by a normal number."""
    space = NormalSpace((lognormal(400.0, 32.0), lognormal(220.0, 33.0)))
    spreads = [math.log1p(0.08**2), math.log1p(0.15**2)]
    centre = math.log(400.0 / 220.0) - 0.5 * spreads[0] + 0.5 * spreads[1]
    exact = float(ndtr(-centre / math.sqrt(sum(spreads))))
    return Exact("strength and stress lognormal", space, lambda x: x[:, 1] / x[:, 0], exact)


def _cantilever() -> Exact:
    """Return the cantilever of Wu et al. (2001), w = 2.4484 in, t = 3.8884 in."""
    w, t = 2.4484, 3.8884
    by_y, by_x = 600.0 / (w * t**2), 600.0 / (w**2 * t)
    space = NormalSpace((normal(500.0, 100.0), normal(1000.0, 100.0), normal(40_000.0, 2_000.0)))
    margin = 40_000.0 - by_y * 1000.0 - by_x * 500.0
    index = margin / math.hypot(100.0 * by_y, 100.0 * by_x, 2_000.0)
    return Exact(
        f"cantilever of Wu et al., index {index:.4f}",
        space,
        lambda x: (by_y * x[:, 1] + by_x * x[:, 0]) / x[:, 2],
        float(ndtr(-index)),
    )


def _correlated() -> Exact:
    lower = np.linalg.cholesky(np.array([[1.0, 0.5], [0.5, 1.0]])).astype(float)
    space = NormalSpace((normal(100.0, 10.0), normal(70.0, 8.0)), lower)
    index = 30.0 / math.sqrt(100.0 + 64.0 - 80.0)
    return Exact(
        "strength and stress normal, correlated 0.5",
        space,
        lambda x: x[:, 1] / x[:, 0],
        float(ndtr(-index)),
    )


def _parabola(name: str, curvature: float) -> Exact:
    """Return the case of failure beyond 3 + curvature / 2 times the square of another number."""

    def at(z: float) -> float:
        return float(norm.pdf(z) * ndtr(-3.0 - 0.5 * curvature * z * z))

    return Exact(
        name,
        NormalSpace((normal(0.0, 1.0), normal(0.0, 1.0))),
        lambda x: 1.0 + (x[:, 0] - 3.0 - 0.5 * curvature * x[:, 1] ** 2) / 6.0,
        quad(at, -12.0, 12.0, epsabs=1e-14)[0],
    )


def assessed(case: Exact, seed: int, table: ReliabilityTable = TABLE) -> tuple[Risk, int, int]:
    """Return the result with a seed, and the numbers of designs solved by FORM and by importance
    sampling.
    """
    settings = table.model_copy(update={"seed": seed})
    designs = Formula(case)
    draws = plain_draws(settings.samples, case.space.size, seed)
    sampled = Sample(draws, designs.at(draws.u, "plain sampling"))
    form = first_order(designs, 0, starts_of(sampled, 0, settings.factor), settings)
    by_form = designs.count - settings.samples
    weighted = weighted_sample(designs, list(form.centres), settings)
    row = AssessedRow("", "", RiskColumn(0), None, form.result, ())
    by_weights = designs.count - settings.samples - by_form
    return risk_of(row, sampled, weighted, settings), by_form, by_weights


def reliability() -> str:
    """Return the table of all cases."""
    lines = [
        f"| case | exact | FORM | plain, {TABLE.samples:,} designs | importance sampling | designs "
        "of FORM, importance | plain contains | importance contains | reported contains |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for case in cases():
        found = [assessed(case, seed) for seed in range(1, SEEDS + 1)]
        risk, by_form, by_weights = found[0]
        assert risk.form is not None
        risks = [each for each, _, _ in found]
        ways = [
            [r.sampled for r in risks],
            [r.weighted for r in risks if r.weighted is not None],
            [r.probability for r in risks],
        ]
        within = (
            f"{sum(s.low <= case.probability <= s.high for s in each)} of {len(each)}"
            for each in ways
        )
        form = "–" if math.isnan(risk.form.probability) else f"{risk.form.probability:.3g}"
        cells = [
            case.name,
            f"{case.probability:.4g}",
            form + f" ({risk.form.points} points)" * (risk.form.points > 1),
            *(
                "–" if s is None else f"{s.value:.3g} ({s.low:.3g} to {s.high:.3g})"
                for s in (risk.sampled, risk.weighted)
            ),
            f"{by_form}, {by_weights:,}",
            *within,
        ]
        lines.append(f"| {' | '.join(cells)} |")
    low, high = (int(binom.ppf(p, SEEDS, 0.95)) for p in (TAIL, 1.0 - TAIL))
    lines += [
        "",
        f"The values are those of seed 1. Of {SEEDS} intervals of 95 %, {low} to {high} contain "
        f"the exact value with probability {1.0 - 2.0 * TAIL:g}; those of plain sampling (Clopper "
        "and Pearson) contain it at least as often as they say.",
    ]
    return "\n".join(lines)

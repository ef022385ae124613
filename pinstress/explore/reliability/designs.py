"""The safety factors of many designs of a study with random numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from pinbase.processes.pool import Job, ProcessDied, Progress, in_parallel
from pinstress.explore.reliability.form import LimitState
from pinstress.explore.sweep.correlations import correlations_of, root_of
from pinstress.explore.sweep.evaluate import DesignRow, Evaluator
from pinstress.explore.sweep.parameters import Parameter, parameters_of, require_laws
from pinstress.study.reading.file import Study

Array = NDArray[np.float64]

MAX_JOB_DESIGNS = 100
JOBS_PER_PROCESS = 4  # so that all processes end at about the same time
# Up to so many designs are solved in this process, such as those of one FORM iteration
MAX_SERIAL_DESIGNS = 30


Marginal = Callable[[Array], Array]  # from standard normal deviates to values of a variable
Elsewhere = Callable[[Array, Callable[[int], None]], list[list[DesignRow]]]


@dataclass(frozen=True)
class NormalSpace:
    """A space of d random variables, each a function of its own standard normal deviate.

    Normal variables may be correlated; they are a linear map of independent deviates (the Nataf
    transformation, which is exact for normal variables). All other variables are independent.

    lower: L (d, d) with L L^T the correlation matrix of the deviates; None if all are independent.
    """

    marginals: tuple[Marginal, ...]
    lower: Array | None = None

    @property
    def size(self) -> int:
        return len(self.marginals)

    def physical(self, u: Array) -> Array:
        """Return values (n, d) of the variables at independent standard normal u (n, d)."""
        z = u if self.lower is None else u @ self.lower.T
        return np.stack([at(z[:, i]) for i, at in enumerate(self.marginals)], axis=1)

    def importance(self, direction: Array) -> Array:
        """Return the importance (d,) of each variable for a design point in a unit direction.

        The importances are squared direction cosines with a sum of 1. With correlation they refer
        to the variables' own deviates (Der Kiureghian's gamma).
        """
        if self.lower is not None:
            direction = np.linalg.lstsq(self.lower.T, direction)[0].astype(np.float64)
        squares: Array = direction**2
        part: Array = squares / squares.sum()
        return part


@dataclass(frozen=True)
class Answers:
    """The results of n designs for each of r rows.

    used: (n, r) utilisation, the reciprocal of the safety factor; NaN where there is no result.
    errors: (n, r) relative error of the stress.
    beneath: (n, r) utilisation by the stress beneath contact with its error; 0 without contact. If
    it is larger than `used`, the outcome of the row depends on it.
    unbounded: (n, r) whether the governing stress is unbounded; `used` is then that outside the
    singular zones.
    loose: (n, r) whether the pin comes loose at the temperature of the case.
    """

    used: Array
    errors: Array
    beneath: Array
    unbounded: NDArray[np.bool_]
    loose: NDArray[np.bool_]

    @property
    def factors(self) -> Array:
        """The safety factors (n, r), infinite without stress."""
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / self.used)

    @property
    def system(self) -> Answers:
        """The results of the system, (n, 1): those of the row with the largest utilisation. They
        are unknown, unbounded or loose if those of any row are.
        """
        worst = np.argmax(np.where(np.isnan(self.used), np.inf, self.used), axis=1)[:, None]
        used, errors = (np.take_along_axis(x, worst, axis=1) for x in (self.used, self.errors))
        unbounded, loose = (
            np.asarray(x.any(axis=1))[:, None] for x in (self.unbounded, self.loose)
        )
        return Answers(used, errors, self.beneath.max(axis=1)[:, None], unbounded, loose)

    @property
    def deep(self) -> Array:
        """The larger (n, r) of the utilisation and that by the stress beneath contact."""
        return np.maximum(self.used, self.beneath)

    @property
    def depends(self) -> NDArray[np.bool_]:
        """Whether the stress beneath contact governs in any design, for each row, (r,)."""
        return np.asarray((self.deep > self.used).any(axis=0))


def for_values(study: Study) -> Study:
    """Return the study with the goal "value". With the goal to decide the required factor the
    stress itself remains inaccurate, but probabilities need its value.
    """
    if study.table.analysis.goal == "value":
        return study
    from pinstress.study.reading.in_python import changed_study  # imports tomlkit

    return changed_study(study, {"analysis.goal": "value"})


def random_numbers(study: Study) -> tuple[tuple[Parameter, ...], NormalSpace]:
    """Return the random numbers of a study.

    Raises: InputError, also for numbers without a law.
    """
    parameters, vary = parameters_of(study, sampled=False), study.table.vary
    assert vary is not None
    require_laws(study)
    matrix = correlations_of(study, parameters, sampled=False)
    lower = None if matrix is None else root_of(matrix)
    return parameters, NormalSpace(tuple(p.of_normal for p in parameters), lower)


class SolvedDesigns:
    """The solver of a study's designs at points in standard normal space.

    jobs: number of parallel processes.
    elsewhere: a function that solves many designs on other computers and returns their rows. Its
    arguments are the values (n, d), SI, and a function that it calls with the number of designs
    solved so far.
    solved: number of solved designs by purpose.
    reasons: number of designs by the reason why a row has no result.
    """

    def __init__(
        self,
        evaluator: Evaluator,
        space: NormalSpace,
        jobs: int,
        progress: Progress,
        elsewhere: Elsewhere | None = None,
    ) -> None:
        self.evaluator, self.space = evaluator, space
        self.solved, self.reasons = Counter[str](), Counter[str]()
        self._jobs, self._progress, self._elsewhere = jobs, progress, elsewhere

    def of_pin(self, evaluator: Evaluator) -> SolvedDesigns:
        """Return a solver for the rows of one pin that shares the counts with this one."""
        designs = SolvedDesigns(evaluator, self.space, 1, self._progress)
        designs.solved, designs.reasons = self.solved, self.reasons
        return designs

    def at(self, u: Array, purpose: str) -> Answers:
        """Solve the designs at u (n, d) and return their results.

        purpose: the name under which the designs are counted.
        """
        self.solved[purpose] += len(u)
        values = self.space.physical(u)
        if self._elsewhere is not None and len(u) > MAX_SERIAL_DESIGNS:
            return self._answers(self._elsewhere(values, partial(self._report, purpose, len(u))))
        jobs = self._jobs if len(u) > MAX_SERIAL_DESIGNS else 1
        size = min(MAX_JOB_DESIGNS, -(-len(u) // (JOBS_PER_PROCESS * jobs)))
        parts = [values[k : k + size] for k in range(0, len(values), size)]
        work = [
            Job(_name(purpose, min((k + 1) * size, len(u)), len(u)), part)
            for k, part in enumerate(partial(_solved, self.evaluator, p) for p in parts)
        ]
        progress = self._progress if len(u) > MAX_SERIAL_DESIGNS else (lambda _, __: None)
        results: list[list[list[DesignRow]]] = []
        for part, result in zip(parts, in_parallel(work, jobs, progress), strict=True):
            results.append(
                [_lost(self.evaluator, result)] * len(part)
                if isinstance(result, ProcessDied)
                else result
            )
        return self._answers([rows for part in results for rows in part])

    def _report(self, purpose: str, total: int, count: int) -> None:
        self._progress(_name(purpose, count, total), count / total)

    def limit(self, row: int, factor: float, deep: bool = False) -> LimitState:
        """Return the limit state of a row: 1 - factor * utilisation, negative where it fails.

        deep: whether the stress beneath contact counts as well.
        """

        def at(u: Array) -> Array:
            answers = self.at(u, "FORM")
            return np.asarray(1.0 - factor * (answers.deep if deep else answers.used)[:, row])

        return at

    def _answers(self, designs: list[list[DesignRow]]) -> Answers:
        used = np.array([[_used(row) for row in rows] for rows in designs])
        errors = np.array([[_error(row) for row in rows] for rows in designs])
        below = np.array([[_beneath(row) for row in rows] for rows in designs])
        for rows in designs:
            for reason in {row.reason for row in rows if np.isnan(_used(row))}:
                self.reasons[reason or "no result"] += 1
        singular = np.array([[row.verdict == "singular" for row in rows] for rows in designs])
        loose = np.array([[row.loose for row in rows] for rows in designs])
        return Answers(used, errors, used * below, singular, loose)


def _name(purpose: str, count: int, total: int) -> str:
    return f"{purpose}, {count:,} of {total:,} designs"


def _solved(evaluator: Evaluator, values: Array, _: object) -> list[list[DesignRow]]:
    return evaluator.rows_of(values)


def _lost(evaluator: Evaluator, died: ProcessDied) -> list[DesignRow]:
    return [
        DesignRow(pin, case, None, None, None, "failed", reason=died.reason)
        for pin, case in evaluator.table
    ]


def _used(row: DesignRow) -> float:
    if row.verdict in ("rigid", "failed") or row.max_von_mises is None:
        return np.nan
    if row.max_von_mises == 0.0:
        return 0.0
    return 1.0 / row.safety_factor if row.safety_factor else np.nan


def _beneath(row: DesignRow) -> float:
    """Return the ratio of the stress beneath contact, with its error, to the row's stress; 0
    without contact.
    """
    if row.beneath is None or not row.max_von_mises:
        return 0.0
    return (row.beneath + (row.beneath_error or 0.0)) / row.max_von_mises


def _error(row: DesignRow) -> float:
    if not row.max_von_mises or row.error_estimate is None:
        return 0.0
    return row.error_estimate / row.max_von_mises

"""The factors of safety of many designs of a study with random numbers."""

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
JOBS_PER_PROCESS = 4  # for each process, so that all end at about the same time
# Designs that this process solves itself, as FORM's, one step after another
MAX_SERIAL_DESIGNS = 30


Marginal = Callable[[Array], Array]  # values at standard normal deviates
Elsewhere = Callable[[Array, Callable[[int], None]], list[list[DesignRow]]]


@dataclass(frozen=True)
class NormalSpace:
    """A space of d random variables, each a function of its own standard normal deviate.

    Normal variables may be correlated: a linear map of independent ones (the Nataf transformation,
    which is exact for normal variables). All others are independent.

    lower: L (d, d) with L L^T the correlation of the deviates; None where all are independent.
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
        """Return the importance of each variable for a design point in this unit direction.

        They are squares (d,) of sum one; with correlation, of the variables' own deviates (Der
        Kiureghian's gamma).
        """
        if self.lower is not None:
            direction = np.linalg.lstsq(self.lower.T, direction)[0].astype(np.float64)
        squares: Array = direction**2
        part: Array = squares / squares.sum()
        return part


@dataclass(frozen=True)
class Answers:
    """Answers of n designs for each of r rows.

    used: (n, r), one over the factor of safety, NaN where there is no result.
    errors: (n, r) of the stress, relative.
    deep: (n, r), as `used`, or the value for the stress beneath contact with its error, if that is
    larger, on which a row then depends.
    unbounded: (n, r) whether the stress is unbounded where it governs; `used` is then that outside
    the singular zones.
    loose: (n, r) whether the pin comes loose at the temperature of the case.
    """

    used: Array
    errors: Array
    deep: Array
    unbounded: NDArray[np.bool_]
    loose: NDArray[np.bool_]

    @property
    def factors(self) -> Array:
        """Return the factors of safety (n, r), infinite without stress."""
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / self.used)

    @property
    def system(self) -> Answers:
        """Return the answers of the row with the largest use, as (n, 1); unknown, unbounded, or
        loose where any row is.
        """
        worst = np.argmax(np.where(np.isnan(self.used), np.inf, self.used), axis=1)[:, None]
        used, errors = (np.take_along_axis(x, worst, axis=1) for x in (self.used, self.errors))
        unbounded, loose = (
            np.asarray(x.any(axis=1))[:, None] for x in (self.unbounded, self.loose)
        )
        return Answers(used, errors, self.deep.max(axis=1)[:, None], unbounded, loose)

    @property
    def depends(self) -> NDArray[np.bool_]:
        """Return for each row (r,) whether the stress beneath contact ever governs."""
        return np.asarray((self.deep > self.used).any(axis=0))


def for_values(study: Study) -> Study:
    """Return the study with the goal "value": deciding the required factor says little of stress
    itself, and probabilities need numbers.
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
    """Solve the designs of a study at standard normal u.

    jobs: number of parallel processes.
    elsewhere: solves many designs on other computers instead, as their rows, from their values
    (n, d) in SI; it is given a function to call with the number of designs that are solved.
    solved: number of designs by purpose.
    reasons: why rows have no result, with their number.
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
        """Return the same for the rows of one pin, counted together."""
        designs = SolvedDesigns(evaluator, self.space, 1, self._progress)
        designs.solved, designs.reasons = self.solved, self.reasons
        return designs

    def at(self, u: Array, purpose: str) -> Answers:
        """Solve designs u (n, d) and return their answers."""
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
        """Return the limit state of a row: one less factor times use, negative where it fails.

        deep: whether it is negative also where the row depends on stress beneath contact.
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
        return Answers(used, errors, used * np.maximum(1.0, below), singular, loose)


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
    """Return the stress beneath contact, with its error, over the row's stress; 0 without any."""
    if row.beneath is None or not row.max_von_mises:
        return 0.0
    return (row.beneath + (row.beneath_error or 0.0)) / row.max_von_mises


def _error(row: DesignRow) -> float:
    if not row.max_von_mises or row.error_estimate is None:
        return 0.0
    return row.error_estimate / row.max_von_mises

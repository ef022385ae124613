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

MAX_JOB_DESIGNS = 100  # designs in a job
JOBS_PER_PROCESS = 4  # for each process, so that all end at about the same time
# Designs that this process solves itself, as FORM's, one step after another
MAX_SERIAL_DESIGNS = 30


Marginal = Callable[[Array], Array]  # values at standard normal deviates


@dataclass(frozen=True)
class NormalSpace:
    """d random variables: each a function of its own standard normal deviate. Normal variables may
    be correlated: a linear map of independent ones (the Nataf transformation, which is exact for
    normal variables). All others are independent.

    lower: L (d, d) with L L^T the correlation of the deviates; None where all are independent.
    """

    marginals: tuple[Marginal, ...]
    lower: Array | None = None

    @property
    def size(self) -> int:
        return len(self.marginals)

    def physical(self, u: Array) -> Array:
        """Values (n, d) of the variables at independent standard normal u (n, d)."""
        z = u if self.lower is None else u @ self.lower.T
        return np.stack([at(z[:, i]) for i, at in enumerate(self.marginals)], axis=1)

    def importance(self, direction: Array) -> Array:
        """Squares (d,), of sum one, of the importance of each variable for a design point in this
        unit direction; with correlation, of the variables' own deviates (Der Kiureghian's gamma).
        """
        if self.lower is not None:
            direction = np.linalg.lstsq(self.lower.T, direction)[0].astype(np.float64)
        squares: Array = direction**2
        part: Array = squares / squares.sum()
        return part


@dataclass(frozen=True)
class Answers:
    """Of n designs, for each of r rows: used (n, r), one over the factor of safety, NaN where there
    is no result; errors (n, r) of the stress, relative; deep (n, r): as used, or as much as what
    lies beneath contact uses with its error, if that is more, on which a row then depends.
    """

    used: Array
    errors: Array
    deep: Array

    @property
    def factors(self) -> Array:
        """The factors of safety (n, r), infinite without stress."""
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / self.used)

    @property
    def system(self) -> Answers:
        """Of the row that is used most, as (n, 1); unknown where any row is."""
        worst, deepest = (
            np.argmax(np.where(np.isnan(x), np.inf, x), axis=1)[:, None]
            for x in (self.used, self.deep)
        )
        used, errors = (np.take_along_axis(x, worst, axis=1) for x in (self.used, self.errors))
        return Answers(used, errors, np.take_along_axis(self.deep, deepest, axis=1))

    @property
    def depends(self) -> NDArray[np.bool_]:
        """Of which rows (r,) what lies beneath contact ever is the most."""
        return np.asarray((self.deep > self.used).any(axis=0))


def for_values(study: Study) -> Study:
    """The study with the goal "value": to decide the required factor says little of stress itself,
    and probabilities need numbers.
    """
    if study.table.analysis.goal == "value":
        return study
    from pinstress.study.reading.in_python import changed_study  # imports tomlkit

    return changed_study(study, {"analysis.goal": "value"})


def random_numbers(study: Study) -> tuple[tuple[Parameter, ...], NormalSpace]:
    """The random numbers of a study. Raises: InputError, also for numbers without a law."""
    parameters, vary = parameters_of(study, sampled=False), study.table.vary
    assert vary is not None
    require_laws(study)
    matrix = correlations_of(study, parameters, sampled=False)
    lower = None if matrix is None else root_of(matrix)
    return parameters, NormalSpace(tuple(p.of_normal for p in parameters), lower)


class SolvedDesigns:
    """The designs of a study at standard normal u, solved. jobs: number of parallel processes.

    solved: how many designs by what for; reasons: why rows have no result, with how many.
    """

    def __init__(
        self, evaluator: Evaluator, space: NormalSpace, jobs: int, progress: Progress
    ) -> None:
        self.evaluator, self.space = evaluator, space
        self.solved, self.reasons = Counter[str](), Counter[str]()
        self._jobs, self._progress = jobs, progress

    def of_pin(self, evaluator: Evaluator) -> SolvedDesigns:
        """The same with the rows of one pin, counted together."""
        mine = SolvedDesigns(evaluator, self.space, 1, self._progress)
        mine.solved, mine.reasons = self.solved, self.reasons
        return mine

    def at(self, u: Array, purpose: str) -> Answers:
        """Of designs u (n, d)."""
        self.solved[purpose] += len(u)
        values = self.space.physical(u)
        jobs = self._jobs if len(u) > MAX_SERIAL_DESIGNS else 1
        size = min(MAX_JOB_DESIGNS, -(-len(u) // (JOBS_PER_PROCESS * jobs)))
        parts = [values[k : k + size] for k in range(0, len(values), size)]
        work = [
            Job(f"{purpose}, {min((k + 1) * size, len(u)):,} of {len(u):,} designs", part)
            for k, part in enumerate(partial(_solved, self.evaluator, p) for p in parts)
        ]
        progress = self._progress if len(u) > MAX_SERIAL_DESIGNS else (lambda _, __: None)
        found: list[list[list[DesignRow]]] = []
        for part, made in zip(parts, in_parallel(work, jobs, progress), strict=True):
            found.append(
                [_lost(self.evaluator, made)] * len(part) if isinstance(made, ProcessDied) else made
            )
        return self._answers([rows for part in found for rows in part])

    def limit(self, row: int, factor: float, deep: bool = False) -> LimitState:
        """Of a row: one less factor times what is used, negative where it fails; deep: where it
        fails or depends on what lies beneath contact.
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
        return Answers(used, errors, used * np.maximum(1.0, below))


def _solved(evaluator: Evaluator, values: Array, _: object) -> list[list[DesignRow]]:
    return [evaluator.rows(each) for each in values]


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
    """What lies beneath contact, with its error, over the row's stress; 0 where nothing does."""
    if row.beneath is None or not row.max_von_mises:
        return 0.0
    return (row.beneath + (row.beneath_error or 0.0)) / row.max_von_mises


def _error(row: DesignRow) -> float:
    if not row.max_von_mises or row.error_estimate is None:
        return 0.0
    return row.error_estimate / row.max_von_mises

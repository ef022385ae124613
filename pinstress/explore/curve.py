"""Factors of safety against one number of a study, each design solved as a run solves it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np

from pinbase.errors import ArgumentError
from pinbase.processes.pool import Job, ProcessDied, Progress, Tell, in_parallel
from pinstress.explore.sweep.evaluate import (
    STRENGTH_KEYS,
    DesignRow,
    Evaluator,
    rows_without_maximum,
)
from pinstress.explore.sweep.laws import Floats
from pinstress.explore.sweep.number import Number, number_at, si_value
from pinstress.explore.sweep.workers import PROCESS_DIED
from pinstress.study.model.lugs import with_given_lugs
from pinstress.study.model.requirements import checks_besides_yield, common_required_factor
from pinstress.study.reading.file import Study
from pinstress.study.reading.inputs import inputs, require_unchanged
from reports.data.curve import CurvePoint, FactorCurve

USUAL_RANGE = 0.5, 2.0  # default ends, relative to the number in the study
SAME_VALUE = 1e-9  # relative to the range: a value closer to the nominal one equals it
STRESS = "stress"

Ends = tuple[float | str | None, float | str | None]


def curve(
    study: Study,
    key: str,
    ends: Ends = (None, None),
    points: int = 9,
    pins: Sequence[str] | None = None,
    jobs: int = 1,
    progress: Progress = lambda _, __: None,
) -> FactorCurve:
    """Solve a study at evenly spaced values of one of its numbers, and at its nominal value.

    key: the number, as in messages and [vary]: "pin.E.profile[2].diameter".
    ends: the first and the last value, in the study's units or as text with a unit; by default half
    and twice the number in the study or, for a temperature, half and twice its rise.
    pins: names; by default the pin to which the key belongs, else all pins.
    jobs: number of processes.

    A design that cannot be built or solved gives a point without numbers, with the reason.
    Raises: InputError for a key that is not a number of the study, for an empty range, and if a
    file of the study changes meanwhile.
    """
    before, number = inputs(study), _number(study, key)
    low, high = _range(study, number, ends)
    if pins is None and number.path[0] == "pin":
        pins = [str(number.path[1])]
    # A strength changes no stress, which all points share if it is known in every case.
    evaluator = Evaluator(study, [number], pins, every=number.path[-1] in STRENGTH_KEYS)
    values = values_between(low, high, number.nominal, points)
    # Each process takes values from the whole range, since those at one end may take far longer.
    parts = [values[k::jobs] for k in range(min(jobs, len(values)))]
    work = [Job(key, partial(_solved, evaluator, part)) for part in parts]
    outcomes = in_parallel(work, jobs, progress)
    require_unchanged(study, before)
    rows: dict[float, list[DesignRow]] = {}
    for part, designs in zip(parts, outcomes, strict=True):
        if isinstance(designs, ProcessDied):
            failed = rows_without_maximum(evaluator.table, designs.reason, PROCESS_DIED)
            designs = [failed for _ in part]
        rows |= dict(zip(part.tolist(), designs, strict=True))
    solved = [_point(study, number, x, row) for x in values.tolist() for row in rows[x]]
    names = tuple(dict.fromkeys(row.pin for row in solved))
    required = None if _is_required(number) else common_required_factor(study, names)
    return FactorCurve(
        study.name, key, number.unit, number.shown(number.nominal), required,
        study.system.stress, tuple(solved), with_given_lugs(study, names),
        checks_besides_yield(study),
    )  # fmt: skip


def values_between(low: float, high: float, nominal: float, points: int) -> Floats:
    """Return evenly spaced values, with the nominal value added if it lies between the ends."""
    values = np.linspace(low, high, points)
    if not low < nominal < high:
        return values
    same = np.abs(values - nominal) <= SAME_VALUE * (high - low)
    return np.union1d(np.where(same, nominal, values), nominal)


def _number(study: Study, key: str) -> Number:
    try:
        return number_at(study, key)
    except ArgumentError as error:
        raise study.error(f"{key}: {error}", code=error.code) from None


def _is_required(number: Number) -> bool:
    """Whether the number is itself a required factor."""
    return number.path[0] == "require" or number.path[-1] == "required_safety_factor"


def _range(study: Study, number: Number, ends: Ends) -> tuple[float, float]:
    zero = _zero_of_range(study, number)
    usual = sorted(zero + share * (number.nominal - zero) for share in USUAL_RANGE)
    values = []
    for name, end, default in zip(("--from", "--to"), ends, usual, strict=True):
        try:
            values.append(default if end is None else si_value(study.system, number, end))
        except ArgumentError as error:
            raise study.error(f"{name}: {error}", at=number.key, code=error.code) from None
    low, high = values
    if low < high:
        return low, high
    if number.nominal == zero and None in ends:
        text = (
            f"is {number.text(zero)} in the study, so there is no usual range: give --from and --to"
        )
    else:
        shown = [number.text(x) for x in values]
        text = f"the range from {shown[0]} to {shown[1]} is empty: --to must exceed --from"
    raise study.error(f"{number.key}: {text}", code="limits-out-of-order")


def _zero_of_range(study: Study, number: Number) -> float:
    """Return the zero point of the usual range: 0 or, for a temperature, the reference temperature
    of the study's dimensions, because only the rise above it has an effect.
    """
    if number.dimension == "temperature":
        return study.table.analysis.reference_temperature
    return 0.0


def _solved(evaluator: Evaluator, values: Iterable[float], tell: Tell) -> list[list[DesignRow]]:
    number, designs = evaluator.numbers[0], []
    for value in values:
        tell(f"{number.key} = {number.text(value)}")
        designs.append(evaluator.rows([value]))
    return designs


def _point(study: Study, number: Number, value: float, row: DesignRow) -> CurvePoint:
    unit = study.system.factor(STRESS)
    stress, error = (
        None if x is None else x / unit for x in (row.max_von_mises, row.error_estimate)
    )
    return CurvePoint(
        number.shown(value), row.pin, row.case, stress, error, row.safety_factor, row.outcome,
        row.depends_on, row.verdict, row.reason,
    )  # fmt: skip

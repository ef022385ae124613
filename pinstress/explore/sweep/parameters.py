"""The varying numbers of a study, each with its law."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from pinbase.errors import ArgumentError
from pinbase.keys import key_part
from pinstress.explore.sweep.fits import limits_of
from pinstress.explore.sweep.laws import (
    Floats,
    Law,
    LogNormal,
    Normal,
    Triangular,
    Uniform,
    cut_off,
    of_tolerance,
)
from pinstress.explore.sweep.number import Number, Path, number_at, si_value
from pinstress.study.reading.errors import Errors
from pinstress.study.reading.file import Study
from pinstress.study.schema.shown import as_text
from pinstress.study.schema.thermal_units import difference_of
from pinstress.study.schema.units import UnitSystem
from pinstress.study.schema.vary import ParameterTable

MIN_PROBABILITY_WITHIN_LIMITS = 1e-6  # smallest probability that limits must leave of a law


@dataclass(frozen=True)
class Parameter:
    """A number that varies by a law (SI).

    steps: number of its values in a grid.
    source: the tolerance from which the law was made, as the study gives it; else empty.
    """

    number: Number
    law: Law
    steps: int | None = None
    source: str = ""

    @property
    def key(self) -> str:
        """The number's key."""
        return self.number.key

    @property
    def dimension(self) -> str:
        """The number's dimension; empty for a number without one."""
        return self.number.dimension

    @property
    def nominal(self) -> float:
        """The value of the number in the study, SI."""
        return self.number.nominal

    def quantile(self, u: Floats) -> Floats:
        """Return the quantiles (N,), SI, at probabilities u (N,)."""
        return self.law.quantile(u)

    def of_normal(self, z: Floats) -> Floats:
        """Return the quantiles (N,), SI, at the probabilities of standard normal deviates z."""
        return self.law.of_normal(z)

    @property
    def law_text(self) -> str:
        """The law in words, in the number's unit."""
        text = self.law.text(self.number.text, self.number.spread_text)
        return f"{self.source}: {text}" if self.source else text


def parameters_of(study: Study, sampled: bool = True) -> tuple[Parameter, ...]:
    """Return the parameters of [vary] in their order.

    sampled: whether [vary] must also state which designs to sample.

    Raises: InputError with all errors, also for a study without [vary].
    """
    vary = study.table.vary
    if vary is None:
        raise study.error(
            "the study has no [vary], which says what varies; for instance [vary.parameters] with "
            f"{_example(study)} = {{ from = ..., to = ..., steps = 5 }}",
            code="no-vary",
        )
    wrong = Errors(study.path)
    attempts = [
        wrong.attempt(partial(_parameter, study, key, table))
        for key, table in vary.parameters.items()
    ]
    parameters = tuple(p for p in attempts if p is not None)
    wrong.attempt(partial(_require_different, study, parameters))
    wrong.tell()
    if sampled and vary.sample == "grid":
        _require_grid(study, parameters)
    return parameters


def require_laws(study: Study) -> None:
    """Check that all varying numbers have a probability law.

    Raises: InputError for numbers that have only a range.
    """
    for key, table in study.table.vary.parameters.items() if study.table.vary else ():
        if table.from_ is not None:
            raise study.error(
                f"vary.parameters.{key_part(key)}: from and to say between what the number lies, "
                "not how likely its values are; reliability needs a law, such as normal = [mean, "
                "deviation], or uniform = [least, largest] if all are equally likely",
                code="no-law",
            )


def _require_different(study: Study, parameters: Iterable[Parameter]) -> None:
    known: dict[Path, str] = {}
    for parameter, path in ((p, path) for p in parameters for path in p.number.paths):
        other = known.setdefault(path, parameter.key)
        if other != parameter.key:
            raise study.error(
                f"vary.parameters.{key_part(parameter.key)}: names the same number as "
                f"{as_text(other)}; give one of them",
                code="duplicate-parameter",
            )


def _require_grid(study: Study, parameters: Iterable[Parameter]) -> None:
    """Check a grid.

    Raises: InputError for a grid without steps or with too many.
    """
    from pinstress.study.schema.vary import MAX_DESIGNS

    count = 1
    for parameter in parameters:
        if parameter.steps is None:
            raise study.error(
                f"vary.parameters.{key_part(parameter.key)}: a grid needs steps, the "
                "number of values; or "
                'choose another sample, such as sample = "sobol"',
                code="missing-steps",
            )
        count *= parameter.steps
    if count > MAX_DESIGNS:
        raise study.error(
            f"vary: the grid has {count:,} designs; the limit is {MAX_DESIGNS:,}: take fewer "
            'steps, or sample = "sobol" with a count',
            code="too-large",
        )


def _example(study: Study) -> str:
    for name, pin in study.table.pin.items():
        if pin.profile:
            return key_part(f"pin.{key_part(name)}.profile[1].diameter")
    return '"analysis.tolerance"'


def _parameter(study: Study, key: str, table: ParameterTable) -> Parameter:
    try:
        number = number_at(study, key)
        law = _law(study.system, number, table)
    except ArgumentError as error:
        raise study.error(f"vary.parameters.{key_part(key)}: {error}", code=error.code) from None
    return Parameter(number, law, table.steps, table.tolerance or "")


def _law(system: UnitSystem, number: Number, table: ParameterTable) -> Law:
    def si(name: str, values: Iterable[float | str]) -> list[float]:
        return [_si(system, number, name, value) for value in values]

    if table.tolerance is not None:
        return of_tolerance(*limits_of(table.tolerance, number, system))
    if table.triangular is not None:
        low, mode, high = si("triangular", table.triangular)
        if not (low <= mode <= high and low < high):
            raise ArgumentError(
                "triangular: must be the least, the most likely and the largest value, in this "
                "order",
                "limits-out-of-order",
            )
        return Triangular(low, mode, high)
    if table.normal is not None or table.lognormal is not None:
        difference = replace(number, dimension=difference_of(number.dimension))
        return _bell(si, partial(_si, system, difference), table)
    if table.uniform is not None:
        name, (low, high) = "uniform", si("uniform", table.uniform)
    else:
        assert table.from_ is not None
        assert table.to is not None
        name, low, high = "to", *si("from", [table.from_]), *si("to", [table.to])
    one = table.steps == 1 and low == high
    if not (low < high or one):
        raise ArgumentError(
            f"{name}: the largest value must exceed the least one", "limits-out-of-order"
        )
    return Uniform(low, high)


def _bell(si: Any, of_difference: Any, table: ParameterTable) -> Law:
    """Return a normal or lognormal law of a mean and a deviation.

    si: converts values to SI. of_difference: converts a difference of two values to SI.
    """
    name = "normal" if table.normal is not None else "lognormal"
    first, second = table.normal or table.lognormal or (0.0, 0.0)
    (mean,), deviation = si(name, [first]), of_difference(name, second)
    if not deviation > 0.0:
        raise ArgumentError(f"{name}: the deviation must be positive", "not-positive")
    if name == "lognormal" and not mean > 0.0:
        raise ArgumentError("lognormal: the mean must be positive", "not-positive")
    law = Normal(mean, deviation) if name == "normal" else LogNormal(mean, deviation)
    if table.within is None:
        return law
    low, high = si("within", table.within)
    if not low < high:
        raise ArgumentError(
            "within: the largest value must exceed the least one", "limits-out-of-order"
        )
    law = cut_off(law, low, high)
    if law.within < MIN_PROBABILITY_WITHIN_LIMITS:
        raise ArgumentError(
            f"within: has only {law.within:.1e} of the law's probability", "limits-far-off"
        )
    return law


def _si(system: UnitSystem, number: Number, name: str, value: float | str) -> float:
    try:
        return si_value(system, number, value)
    except ArgumentError as error:
        raise ArgumentError(f"{name}: {error}", error.code) from None

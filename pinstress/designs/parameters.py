"""The numbers of a study that vary: where each stands, its dimension, and its law.

Any number of a study has a key, as messages spell it; what reads it says of which dimension it is.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from loads.coded import LoadsArgumentError
from pinstress.designs.fits import limits_of
from pinstress.designs.laws import (
    Floats,
    Law,
    LogNormal,
    Normal,
    Triangular,
    Uniform,
    cut_off,
    of_tolerance,
)
from pinstress.schema.shown import shown
from pinstress.schema.types import Probe
from pinstress.schema.units import DIMENSIONS, UNIT_NEEDED, UnitSystem, split, to_si
from pinstress.schema.vary import ParameterTable
from pinstress.study.errors import Errors, InputError
from pinstress.study.file import Study, raw_study
from pinstress.study.in_python import key_parts

ANGLES = {"angle": ("deg", math.pi / 180.0)}  # others are in radians
RADIANS = {"angular velocity": "rad/s", "angular acceleration": "rad/s^2"}
LITTLE = 1e-6  # of the probability: a law must not be cut off so far

Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Number:
    """A number of the study: its key, its path in what `raw_study` returns, its dimension (empty
    of a number without one) and its value in SI. unit: of a design's values in tables, `factor` its
    SI value; written: whether the study must give it as a text with that unit.
    """

    key: str
    path: Path
    dimension: str
    nominal: float
    unit: str = ""
    factor: float = 1.0
    written: bool = False

    def in_study(self, value: float) -> float | str:
        """A value in its unit (not SI) as the study may write it."""
        return f"{value!r} {self.unit}" if self.written else value


@dataclass(frozen=True)
class Parameter:
    """A number that varies by a law (SI). steps: how many values a grid has of it. source: the law
    as the study gives it, where that says more than the law itself.
    """

    number: Number
    law: Law
    steps: int | None = None
    source: str = ""

    @property
    def key(self) -> str:
        """The number's."""
        return self.number.key

    @property
    def dimension(self) -> str:
        """The number's; empty of a number without one."""
        return self.number.dimension

    @property
    def nominal(self) -> float:
        """The number in the study, SI."""
        return self.number.nominal

    def quantile(self, u: Floats) -> Floats:
        """Values (N,) in SI below which the number stays with probabilities u (N,)."""
        return self.law.quantile(u)

    def of_normal(self, z: Floats) -> Floats:
        """Values (N,) in SI as likely to be exceeded as z (N,) by a standard normal variable."""
        return self.law.of_normal(z)

    @property
    def law_text(self) -> str:
        """The law in words, in the number's unit."""

        def show(value: float) -> str:
            return f"{value / self.number.factor:.6g} {self.number.unit}".rstrip()

        text = self.law.text(show)
        return f"{self.source}: {text}" if self.source else text


def parameters_of(study: Study, sampled: bool = True) -> tuple[Parameter, ...]:
    """The parameters of [vary] in their order. sampled: whether it must also say which designs to
    make of them. Raises: InputError with all that is wrong, also for a study without [vary].
    """
    vary = study.table.vary
    if vary is None:
        raise study.error(
            "the study has no [vary], which says what varies; for instance [vary.parameters] with "
            f"{_example(study)} = {{ from = ..., to = ..., steps = 5 }}",
            code="no-vary",
        )
    wrong = Errors(study.path)
    found = [
        wrong.attempt(partial(_parameter, study, key, table))
        for key, table in vary.parameters.items()
    ]
    made = tuple(p for p in found if p is not None)
    wrong.attempt(partial(_require_different, study, made))
    wrong.tell()
    if sampled and vary.sample == "grid":
        _require_grid(study, made)
    return made


def number_at(study: Study, key: str) -> Number:
    """The number with a key. Raises: InputError for a key that names no number."""
    raw = raw_study(study)
    path = _path(study, raw, key)
    value = _at(raw, path)
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        what = "a table" if isinstance(value, Mapping) else "a list"
        what = "true or false" if isinstance(value, bool) else what
        raise _no_number(study, key, f"is {what}, not a number")
    try:
        return _number(study, raw, key, path, value)
    except LoadsArgumentError as error:
        raise study.error(f"{key}: {error}", code=error.code) from None


def put(raw: dict[str, Any], path: Path, value: Any) -> dict[str, Any]:
    """A copy of a study's raw content with another value at a path; the rest is shared."""
    made = copy.copy(raw)
    here: Any = made
    for part in path[:-1]:
        here[part] = copy.copy(here[part])
        here = here[part]
    here[path[-1]] = value
    return made


def _number(study: Study, raw: dict[str, Any], key: str, path: Path, value: Any) -> Number:
    dimension = _dimension(study, raw, path)
    if not dimension and isinstance(value, str):
        found = split(value)
        if found is None or not found[1]:
            raise _no_number(study, key, f"is the text {shown(value)}, not a number")
        dimension = _dimension_of_unit(found[1])
        if not dimension:
            raise _no_number(study, key, f"is {shown(value)}, whose unit has no known dimension")
    if not dimension:
        if isinstance(value, int) and _whole(study, raw, path):
            raise _no_number(study, key, "is a whole number, which cannot vary continuously")
        return Number(key, path, "", float(value))
    nominal = to_si(value, dimension, study.system)
    if dimension in ANGLES:
        return Number(key, path, dimension, nominal, *ANGLES[dimension], written=True)
    if dimension in UNIT_NEEDED:
        return Number(key, path, dimension, nominal, RADIANS[dimension], written=True)
    system = study.system
    return Number(
        key, path, dimension, nominal, unit_of(system, dimension), system.factor(dimension)
    )


def unit_of(system: UnitSystem, dimension: str) -> str:
    """The name of a system's unit of a dimension, in length, force, time and stress."""
    if dimension == "stress":
        return system.stress
    exponents, _ = DIMENSIONS[dimension]
    names = (system.force, system.length, system.time)
    powers = [(name, exponents[k]) for name, k in zip(names, (1, 0, 2), strict=True)]
    above, below = (
        " ".join(f"{n}^{abs(e)}" if abs(e) > 1 else n for n, e in powers if e * sign > 0)
        for sign in (1, -1)
    )
    return f"{above or '1'}/{below}" if below else above


def _dimension(study: Study, raw: dict[str, Any], path: Path) -> str:
    probe = Probe(1.0)
    _validate(study, put(raw, path, probe))
    return probe.dimension


def _whole(study: Study, raw: dict[str, Any], path: Path) -> bool:
    """Whether nothing but a whole number may be there."""
    found = _validate(study, put(raw, path, 0.5))
    return any(kind in ("int_type", "int_from_float") for kind in found)


def _validate(study: Study, raw: dict[str, Any]) -> list[str]:
    """The kinds of errors."""
    from pydantic import ValidationError

    from pinstress.schema.tables import StudyTable

    try:
        StudyTable.model_validate(raw, context={"system": study.system})
    except ValidationError as error:
        return [each["type"] for each in error.errors()]
    return []


def _dimension_of_unit(unit: str) -> str:
    from pinstress.schema.units import USUAL

    return USUAL[unit][0] if unit in USUAL else ""


def _path(study: Study, raw: Any, key: str) -> Path:
    """In the raw content. A list of one element may be meant without its index, and a table where
    there may be a list with [1].
    """
    found: list[str | int] = []
    here = raw
    for part in key_parts(study, key):
        if isinstance(part, str) and isinstance(here, list) and len(here) == 1:
            found.append(0)
            here = here[0]
        if part == 0 and isinstance(here, Mapping):
            continue
        there = here[part] if _has(here, part) else None
        if there is None or (not found and part == "vary"):
            said = f"[{part + 1}]" if isinstance(part, int) else shown(part)
            raise _no_number(study, key, f"the study has no {said} there; write it in the study")
        found.append(part)
        here = there
    return tuple(found)


def _has(here: Any, part: str | int) -> bool:
    if isinstance(part, int):
        return isinstance(here, list) and 0 <= part < len(here)
    return isinstance(here, Mapping) and part in here


def _at(raw: Any, path: Path) -> Any:
    for part in path:
        raw = raw[part]
    return raw


def _no_number(study: Study, key: str, why: str) -> InputError:
    return study.error(f"vary.parameters.{key}: {why}", code="not-a-varying-number")


def _require_different(study: Study, made: Iterable[Parameter]) -> None:
    known: dict[Path, str] = {}
    for parameter in made:
        other = known.setdefault(parameter.number.path, parameter.key)
        if other != parameter.key:
            raise study.error(
                f"vary.parameters.{parameter.key}: names the same number as {shown(other)}; "
                "give one of them",
                code="duplicate-parameter",
            )


def _require_grid(study: Study, made: Iterable[Parameter]) -> None:
    """Raises: InputError for a grid without steps or with too many."""
    from pinstress.schema.vary import MOST_DESIGNS

    count = 1
    for parameter in made:
        if parameter.steps is None:
            raise study.error(
                f"vary.parameters.{parameter.key}: a grid needs steps, the number of values; or "
                'choose another sample, such as sample = "sobol"',
                code="missing-steps",
            )
        count *= parameter.steps
    if count > MOST_DESIGNS:
        raise study.error(
            f"vary: the grid has {count:,} designs; the limit is {MOST_DESIGNS:,}: take fewer "
            'steps, or sample = "sobol" with a count',
            code="too-large",
        )


def _example(study: Study) -> str:
    for name, pin in study.table.pin.items():
        if pin.profile:
            return f'"pin.{name}.profile[1].diameter"'
    return '"analysis.tolerance"'


def _parameter(study: Study, key: str, table: ParameterTable) -> Parameter:
    number = number_at(study, key)
    try:
        law = _law(study.system, number, table)
    except LoadsArgumentError as error:
        raise study.error(f"vary.parameters.{key}: {error}", code=error.code) from None
    return Parameter(number, law, table.steps, table.tolerance or "")


def _law(system: UnitSystem, number: Number, table: ParameterTable) -> Law:
    def si(name: str, values: Iterable[float | str]) -> list[float]:
        return [_si(system, number, name, value) for value in values]

    if table.tolerance is not None:
        return of_tolerance(*limits_of(table.tolerance, number, system))
    if table.triangular is not None:
        low, mode, high = si("triangular", table.triangular)
        if not (low <= mode <= high and low < high):
            raise LoadsArgumentError(
                "triangular: must be the least, the most likely and the largest value, in this "
                "order",
                "limits-out-of-order",
            )
        return Triangular(low, mode, high)
    if table.normal is not None or table.lognormal is not None:
        return _bell(si, table)
    if table.uniform is not None:
        name, (low, high) = "uniform", si("uniform", table.uniform)
    else:
        assert table.from_ is not None
        assert table.to is not None
        name, low, high = "to", *si("from", [table.from_]), *si("to", [table.to])
    one = table.steps == 1 and low == high
    if not (low < high or one):
        raise LoadsArgumentError(
            f"{name}: the largest value must exceed the least one", "limits-out-of-order"
        )
    return Uniform(low, high)


def _bell(si: Any, table: ParameterTable) -> Law:
    name = "normal" if table.normal is not None else "lognormal"
    mean, deviation = si(name, table.normal or table.lognormal)
    if not deviation > 0.0:
        raise LoadsArgumentError(f"{name}: the deviation must be positive", "not-positive")
    if name == "lognormal" and not mean > 0.0:
        raise LoadsArgumentError("lognormal: the mean must be positive", "not-positive")
    law = Normal(mean, deviation) if name == "normal" else LogNormal(mean, deviation)
    if table.within is None:
        return law
    low, high = si("within", table.within)
    if not low < high:
        raise LoadsArgumentError(
            "within: the largest value must exceed the least one", "limits-out-of-order"
        )
    law = cut_off(law, low, high)
    if law.within < LITTLE:
        raise LoadsArgumentError(
            f"within: has only {law.within:.1e} of the law's probability", "limits-far-off"
        )
    return law


def _si(system: UnitSystem, number: Number, name: str, value: float | str) -> float:
    try:
        if number.dimension:
            return to_si(value, number.dimension, system)
        if isinstance(value, str):
            raise LoadsArgumentError(
                f"{shown(value)}: the number has no unit in the study; give a number without "
                "quotes",
                "not-a-number",
            )
    except LoadsArgumentError as error:
        raise LoadsArgumentError(f"{name}: {error}", error.code) from None
    return float(value)

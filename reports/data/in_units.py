"""Conversion of whole results from SI to a study's units, by the dimensions of their fields."""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

T = TypeVar("T")
Unit = Callable[[str], float]

# The same in every system
SYSTEM_INDEPENDENT_DIMENSIONS = "1", "degrees", "rad", "rad/s", "rad/s^2"


def in_units(value: T, unit: Unit) -> T:
    """Return a dataclass of results with its numbers, and those of all it holds, in other units.

    unit: returns the SI value of the unit of a dimension.
    Fields are annotated with their dimension (pinbase.dimensions): a name, or several with
    exponents, "stress length^0.5". A class whose dimensions differ from object to object has a
    property `instead`, which maps the dimension of the annotation to that of the object; it holds
    for all that the object holds.
    """
    instead: Mapping[str, str] = getattr(value, "instead", {})

    def own(dimension: str) -> float:
        return _factor(instead.get(dimension, dimension), unit)

    changed = {
        name: _converted(getattr(value, name), hint, own if instead else unit)
        for name, hint in _dimensioned(type(value))  # type: ignore[arg-type]
    }
    return replace(value, **changed) if changed else value  # type: ignore[type-var]


def _factor(dimension: str, unit: Unit) -> float:
    """Return the product of the units of a dimension such as "stress length^0.5"."""
    if dimension in SYSTEM_INDEPENDENT_DIMENSIONS:
        return 1.0
    product = 1.0
    for part in dimension.split():
        name, _, exponent = part.partition("^")
        product *= unit(name) ** float(exponent or 1.0)
    return product


@cache
def _dimensioned(kind: type) -> tuple[tuple[str, Any], ...]:
    """Return the fields that have a dimension somewhere in them, and their annotations."""
    hints = get_type_hints(kind, include_extras=True)
    return tuple((f.name, hints[f.name]) for f in fields(kind) if _matters(hints[f.name]))


@cache
def _matters(hint: Any) -> bool:
    if is_dataclass(hint):
        return True
    return get_origin(hint) is Annotated or any(_matters(arm) for arm in get_args(hint))


def _converted(value: Any, hint: Any, unit: Unit) -> Any:
    if value is None or not _matters(hint):
        return value
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return _scaled(value, _factor(inner[1], unit))
    if origin in (Union, types.UnionType):
        (arm,) = (arm for arm in inner if arm is not types.NoneType)
        return _converted(value, arm, unit)
    if origin is tuple:
        kinds = [inner[0]] * len(value) if inner[1:] == (...,) else inner
        return tuple(_converted(v, k, unit) for v, k in zip(value, kinds, strict=True))
    if isinstance(value, Mapping):
        return {key: _converted(v, inner[1], unit) for key, v in value.items()}
    return in_units(value, unit)


def _scaled(value: Any, factor: float) -> Any:
    """Return the value times the factor; arrays keep their precision."""
    if isinstance(value, np.ndarray):
        return value if factor == 1.0 else value / factor
    return value / factor

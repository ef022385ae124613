"""Conversion of records to JSON, to other units, and to bytes and back.

Records are frozen dataclasses of numbers, arrays, texts and other records. The types of their
fields say what a value is. Numbers have their dimension in an annotation (pinbase.dimensions): a
name, or several with exponents, as "stress length^0.5". In an object with a field `dimension`, the
dimension "own" stands for the value of this field. A class with several dimensions that differ from
object to object has a property `dimension_of`, which maps the dimension of the annotation to that
of the object. Both apply to everything within the object.
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import types
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache, partial
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T")
Array = NDArray[Any]
Unit = Callable[[str], float]

# Dimensions with the same unit in every system of units
SYSTEM_INDEPENDENT_DIMENSIONS = "1", "degrees", "rad", "rad/s", "rad/s^2"
PLAIN_TYPES = frozenset((type(None), bool, int, float, str))  # types that JSON has
JSON_ENTRY = "text"  # name of the JSON text in an npz file; arrays are named by their numbers


def plain(value: Any) -> Any:
    """Return a value in types that JSON has.

    Non-finite numbers become null, records become objects of their fields, and NumPy numbers become
    ordinary numbers.
    """
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def in_units(value: T, unit: Unit) -> T:
    """Return a record with all its numbers, also in records within it, in other units.

    unit: function that returns the SI value of the unit of a dimension.
    """
    # Most of the time goes into factors, of which a record has few different ones.
    return _record_in_units(value, cache(partial(_factor, unit=unit)))


def _record_in_units(value: T, factor: Unit) -> T:
    """Return what `in_units` does. factor: SI value of the unit of a product of dimensions."""
    own_dimension = {"own": value.dimension} if hasattr(value, "dimension") else {}
    dimension_of: Mapping[str, str] = getattr(value, "dimension_of", own_dimension)

    def own(dimension: str) -> float:
        return _factor(dimension, lambda part: factor(dimension_of.get(part, part)))

    changed = {
        name: _converted(hint, getattr(value, name), own if dimension_of else factor)
        for name, hint in _types(type(value)).items()  # type: ignore[arg-type]
        if _has_dimension(hint)
    }
    return replace(value, **changed) if changed else value  # type: ignore[type-var]


def pack(value: object) -> bytes:
    """Return a value as bytes; equal values give equal bytes.

    The bytes are an npz file of the arrays, and a JSON text of the rest, with numbers exact to the
    last bit.
    value: records, tuples (named ones too), lists, dicts by text, arrays, numbers, texts and None.

    Raises: TypeError for anything else.
    """
    arrays: list[Array] = []
    text = json.dumps(_written(value, arrays), separators=(",", ":"))
    file = io.BytesIO()
    named: dict[str, Array] = {f"{i}": array for i, array in enumerate(arrays)}
    named[JSON_ENTRY] = np.frombuffer(text.encode(), np.uint8)
    np.savez(file, **named)  # type: ignore[arg-type]
    return file.getvalue()


def digest(value: object) -> str:
    """Return a hash of a value; equal values have equal hashes.

    value: as for `pack`.

    Raises: TypeError as for `pack`.
    """
    arrays: list[Array] = []
    text = json.dumps(_written(value, arrays), separators=(",", ":"))
    content = hashlib.sha256(text.encode())
    for array in arrays:
        content.update(f"{array.dtype.str}{array.shape}".encode())
        content.update(array.tobytes())
    return content.hexdigest()


def unpack(kind: type[T], data: bytes) -> T:
    """Return the packed value, of type `kind`; every part is checked against the records' types.

    Raises: ValueError for a value of another type; the errors of numpy and zipfile for other data.
    """
    with np.load(io.BytesIO(data), allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    value: T = _read(kind, json.loads(arrays.pop(JSON_ENTRY).tobytes()), arrays)
    return value


@cache
def _types(kind: type) -> dict[str, Any]:
    """Return the types of the fields of a record by name, with their dimensions."""
    hints = get_type_hints(kind, include_extras=True)
    return {f.name: hints[f.name] for f in fields(kind)}


@cache
def _names(kind: type) -> tuple[str, ...]:
    """Return the names of the fields of a record."""
    return tuple(f.name for f in fields(kind))


def _is_named_tuple(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, tuple) and hasattr(kind, "_fields")


@cache
def _present(hint: Any) -> Any:
    """Return the type without None, if it is a union with None."""
    if get_origin(hint) in (Union, types.UnionType):
        (hint,) = (arm for arm in get_args(hint) if arm is not types.NoneType)
    return hint


def _each(hint: Any, values: Iterable[Any]) -> Iterable[tuple[Any, Any]]:
    """Return pairs (type, item) of the items of a tuple with the type `hint`."""
    inner = get_args(hint)
    if inner[1:] == (...,):
        return ((inner[0], value) for value in values)
    return zip(inner, values, strict=True)


@cache
def _has_dimension(hint: Any) -> bool:
    """Return whether a type may contain a dimension."""
    if is_dataclass(hint) or get_origin(hint) is Annotated:
        return True
    return any(_has_dimension(arm) for arm in get_args(hint))


def _factor(dimension: str, unit: Unit) -> float:
    """Return the product of the units of a dimension such as "stress length^0.5"."""
    if dimension in SYSTEM_INDEPENDENT_DIMENSIONS:
        return 1.0
    product = 1.0
    for part in dimension.split():
        name, _, exponent = part.partition("^")
        product *= unit(name) ** float(exponent or 1.0)
    return product


def _converted(hint: Any, value: Any, factor: Unit) -> Any:
    """Return a value of a type in other units; arguments as in `_record_in_units`."""
    if value is None or not _has_dimension(hint):
        return value
    hint = _present(hint)
    if get_origin(hint) is Annotated:
        size = factor(get_args(hint)[1])
        # an array keeps its precision
        return value if isinstance(value, np.ndarray) and size == 1.0 else value / size
    if get_origin(hint) is tuple:
        return tuple(_converted(kind, item, factor) for kind, item in _each(hint, value))
    if isinstance(value, Mapping):
        return {key: _converted(get_args(hint)[1], item, factor) for key, item in value.items()}
    return _record_in_units(value, factor)


def _written(value: object, arrays: list[Array]) -> object:
    """Return a value in types that JSON has; arrays are appended to `arrays` and become numbers."""
    if type(value) in PLAIN_TYPES:  # a shortcut for most values
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":  # savez pickles objects
        arrays.append(value)
        return len(arrays) - 1
    if is_dataclass(value) and not isinstance(value, type):
        content = [_written(getattr(value, name), arrays) for name in _names(type(value))]
        return [type(value).__name__, *content]
    if isinstance(value, tuple | list):
        return [_written(item, arrays) for item in value]
    if isinstance(value, frozenset):
        return [_written(item, arrays) for item in sorted(value)]
    if isinstance(value, dict):
        return {str(key): _written(item, arrays) for key, item in value.items()}
    raise TypeError(f"a {type(value).__name__} cannot be packed")


def _read(hint: Any, value: Any, arrays: dict[str, Array]) -> Any:
    """Return the value of type `hint` from what `_written` returned for it.

    Raises: ValueError for a value of another type.
    """
    kind = _present(hint)
    if value is None and kind is not hint:
        return None
    if get_origin(kind) is Annotated:
        return _read(get_args(kind)[0], value, arrays)
    origin, inner = get_origin(kind), get_args(kind)
    if origin is Literal and value in inner:
        return value
    if origin is np.ndarray and type(value) is int:
        array = arrays[str(value)]
        if array.dtype == np.dtype(get_args(inner[1])[0]):
            return array
    if origin is tuple and isinstance(value, list):
        return tuple(_read(item_kind, item, arrays) for item_kind, item in _each(kind, value))
    if origin is frozenset and isinstance(value, list):
        return frozenset(_read(inner[0], item, arrays) for item in value)
    if origin in (dict, Mapping) and isinstance(value, dict):
        return {key: _read(inner[1], item, arrays) for key, item in value.items()}
    if is_dataclass(kind) and isinstance(value, list):
        name, *content = value
        if name == kind.__name__:  # type: ignore[union-attr]
            kinds = _types(kind).values()  # type: ignore[arg-type]
            items = zip(kinds, content, strict=True)
            return kind(*(_read(k, item, arrays) for k, item in items))  # type: ignore[operator]
    if _is_named_tuple(kind) and isinstance(value, list):
        items = zip(get_type_hints(kind).values(), value, strict=True)
        return kind(*(_read(k, item, arrays) for k, item in items))
    if type(value) is kind or (kind is float and type(value) is int):
        return value
    raise ValueError(f"{kind} expected, not {value!r:.60}")

"""Dataclasses as bytes and back, numbers bit for bit: an npz file of the arrays and a JSON text
with the rest. Everything that is read back is checked against the types of the dataclass.
"""

from __future__ import annotations

import io
import json
import types
from dataclasses import fields, is_dataclass
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T")
Array = NDArray[Any]

JSON_ENTRY = "text"  # the name of the JSON; arrays are called by their numbers


def pack(value: object) -> bytes:
    """Return a value as bytes; equal values give equal bytes.

    value: dataclasses, tuples, lists, dicts by text, arrays, numbers, texts and None.

    Raises: TypeError for anything else.
    """
    arrays: list[Array] = []
    text = json.dumps(_written(value, arrays), separators=(",", ":"))
    file = io.BytesIO()
    named: dict[str, Array] = {f"{i}": array for i, array in enumerate(arrays)}
    named[JSON_ENTRY] = np.frombuffer(text.encode(), np.uint8)
    np.savez(file, **named)  # type: ignore[arg-type]
    return file.getvalue()


def unpack(kind: type[T], data: bytes) -> T:
    """Return the packed value, a `kind`.

    Raises: ValueError for a value of another type; the errors of numpy and zipfile for other data.
    """
    with np.load(io.BytesIO(data), allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    value: T = _read(kind, json.loads(arrays.pop(JSON_ENTRY).tobytes()), arrays)
    return value


def _written(value: object, arrays: list[Array]) -> object:
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":  # savez pickles objects
        arrays.append(value)
        return len(arrays) - 1
    if is_dataclass(value) and not isinstance(value, type):
        content = [_written(getattr(value, f.name), arrays) for f in fields(value)]
        return [type(value).__name__, *content]
    if isinstance(value, tuple | list):
        return [_written(v, arrays) for v in value]
    if isinstance(value, dict):
        return {str(k): _written(v, arrays) for k, v in value.items()}
    raise TypeError(f"a {type(value).__name__} cannot be packed")


def _read(kind: Any, value: Any, arrays: dict[str, Array]) -> Any:
    origin, inner = get_origin(kind), get_args(kind)
    if origin in (Union, types.UnionType):
        if value is None and type(None) in inner:
            return None
        (kind,) = (k for k in inner if k is not type(None))
        return _read(kind, value, arrays)
    if origin is Literal and value in inner:
        return value
    if origin is np.ndarray and type(value) is int:
        array = arrays[str(value)]
        if array.dtype == np.dtype(get_args(inner[1])[0]):
            return array
    if origin is tuple and isinstance(value, list):
        kinds = [inner[0]] * len(value) if inner[1:] == (...,) else inner
        return tuple(_read(k, v, arrays) for k, v in zip(kinds, value, strict=True))
    if is_dataclass(kind) and isinstance(value, list):
        return _dataclass(kind, value, arrays)
    if type(value) is kind or (kind is float and type(value) is int):
        return value
    raise ValueError(f"{kind} expected, not {value!r:.60}")


def _dataclass(kind: Any, value: list[Any], arrays: dict[str, Array]) -> Any:
    hints = get_type_hints(kind)
    name, *content = value
    if name != kind.__name__:
        raise ValueError(f"{kind} expected, not {name!r:.60}")
    kinds = [hints[f.name] for f in fields(kind)]
    return kind(*(_read(k, v, arrays) for k, v in zip(kinds, content, strict=True)))

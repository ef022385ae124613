"""Changes of a pin's dimensions in a study: in its content and in its text."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import tomlkit

from geometry import Pin
from geometry.shape.dimensions import Dimension
from pinstress.explore.size.pin_shape import kind_of
from pinstress.explore.size.scaled_study import (
    replace_number,
    require,
    rounded,
    unit_of,
    value_of,
    with_what_follows,
)
from pinstress.study.reading.file import Study, with_raw, with_value
from pinstress.study.schema.units import UnitSystem, to_si

PATH_PROBE_STEP = 1e-3  # relative change of a dimension that shows where it is in the study
# 1 where rounding up is on the safe side, -1 where rounding down is
ROUNDING_DIRECTIONS = {"diameters": 1, "bores": -1, "fillets": -1}

Path = tuple[str | int, ...]
Values = Mapping[str, Mapping[str, float]]  # m, by pin and by key of a dimension


def paths_of(pin: Pin, dimension: Dimension) -> tuple[Path, ...]:
    """Return the paths of a dimension in the pin's table.

    In the path of a profile segment, "profile" and k, the index of the end follows the key.
    """
    key = dimension.key
    if key.partition("[")[0] in ("meridian", "bore_meridian"):
        line, corners, at = (part.rstrip("]") for part in key.split("["))
        first, _, last = corners.partition("-")
        numbers = range(int(first) - 1, int(last or first))
        return tuple((line, corner, int(at) - 1) for corner in numbers)
    return tuple(_in_profile(pin, dimension.changed(dimension.value * (1.0 - PATH_PROBE_STEP))))


def _in_profile(pin: Pin, other: Pin) -> Iterator[Path]:
    if pin.fillet != other.fillet:
        yield ("fillet",)
    for k, (old, new) in enumerate(zip(pin.segments, other.segments, strict=True)):
        if old.fillet != new.fillet:
            yield "profile", k, "fillet"
        for name in ("diameters", "bores"):
            for end in (0, 1):
                if getattr(old, name)[end] != getattr(new, name)[end]:
                    yield "profile", k, name.removesuffix("s"), end


def study_with(
    study: Study, raw: dict[str, Any], pin: str, values: Sequence[tuple[tuple[Path, ...], float]]
) -> Study:
    """Return the study with other dimensions of a pin.

    raw: the content of the study, as from raw_study. values: the paths of each dimension and its
    value, m.

    Raises: InputError for an impossible shape.
    """
    length_unit = study.system.factor("length")
    for paths, value in values:
        for path in paths:
            where = _as_written(raw["pin"][pin], path)
            raw = with_value(raw, ("pin", pin, *where), value / length_unit)
    return with_raw(study, raw)


def _as_written(table: Any, path: Path) -> Path:
    """Return a path without the index of an end, if one number stands for both ends."""
    here: Any = table
    for k, part in enumerate(path):
        here = value_of(here)
        if not isinstance(here, dict | list):
            return path[:k]
        if isinstance(here, dict) and part not in here:
            return path  # a lug that is stated only in lug_defaults
        here = here[part]  # type: ignore[index]
    return path


def written_study(
    study: Study,
    shapes: Mapping[str, tuple[Pin, Sequence[Dimension]]],
    values: Values,
    step: float | None = None,
    required: float | None = None,
) -> Study:
    """Return the study with other dimensions in its text, and with all values that depend on them.

    shapes: the pins as given, by name, with the dimensions that change.
    step: step to which diameters are rounded up, m. Without it, all dimensions are rounded to four
    digits, diameters up, bores and fillets down.
    required: the required safety factor to write; None to leave it.

    Raises: InputError for an impossible shape.
    """
    document: Any = tomlkit.parse(study.text)
    for name, (pin, dimensions) in shapes.items():
        table = document["pin"][name]
        for dimension in dimensions:
            value = values[name][dimension.key]
            for path in paths_of(pin, dimension):
                _write(table, _as_written(table, path), value, dimension.key, study.system, step)
    require(document, required)
    return with_what_follows(study, document, values)


def _write(
    table: Any, path: Path, value: float, key: str, system: UnitSystem, step: float | None
) -> None:
    """Write a value, m, at the path of a number.

    If a dimension is written in several places in different units, all get the value rounded in the
    study's unit and so remain equal. The radius of a corner is rounded to half a step.
    """
    here: Any = table
    for part in path[:-1]:
        here = value_of(here)[part]
    here = value_of(here)
    last: Any = path[-1]
    old: Any = value_of(here[last])
    if math.isclose(value, to_si(old, "length", system), rel_tol=1e-12):
        return
    unit, one = unit_of(old, "length", system)
    length_unit = system.factor("length")
    steps, up = rounding_step(key, step, length_unit), ROUNDING_DIRECTIONS[kind_of(key)]
    number = rounded(value / length_unit, steps, up) * length_unit / one
    if not math.isclose(number * one, to_si(old, "length", system), rel_tol=1e-12):
        replace_number(here, last, float(f"{number:.12g}"), unit)


def rounding_step(key: str, step: float | None, length_unit: float) -> float | None:
    """Return the step, in the study's unit, to which a dimension is rounded; None for no step.

    step: step to which diameters are rounded, m. length_unit: the study's unit of length, m.
    """
    if step is None or kind_of(key) != "diameters":
        return None
    return (step / 2.0 if key.startswith("meridian") else step) / length_unit

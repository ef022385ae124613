"""Numbers of a study by their keys: path, dimension, and changed values.

Every number of a study has a key, as in messages; the schema gives its dimension.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from pinbase.errors import ArgumentError
from pinbase.keys import key_part
from pinstress.study.model.lugs import known_lugs
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import Study, raw_study, with_value
from pinstress.study.reading.in_python import PAIR_KEYS, key_parts, single_keys, written_parts
from pinstress.study.schema.lugs import with_lug_defaults
from pinstress.study.schema.shown import as_text, nearest
from pinstress.study.schema.thermal_units import TEMPERATURES, THERMAL_UNITS, temperature_unit
from pinstress.study.schema.types import Probe
from pinstress.study.schema.units import (
    DIMENSION_EXPONENTS,
    DIMENSIONS_NEEDING_UNIT,
    USUAL_UNITS,
    UnitSystem,
    split,
    to_si,
)

ANGLE_UNITS = {"angle": ("deg", math.pi / 180.0)}  # others are in radians
# The SI unit of dimensions whose numbers must be written with a unit
SI_UNITS = {
    "angular velocity": "rad/s",
    "angular acceleration": "rad/s^2",
    **THERMAL_UNITS,
}
TEMPERATURE_DECIMALS = 9  # because 353.15 K - 273.15 K is not exactly 80 K

Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Number:
    """A number of the study.

    key: its key.
    path: its path in the content that `raw_study` returns.
    dimension: empty for a number without a dimension.
    nominal: its value in the study, SI.
    unit: unit of a design's values in tables. factor: SI value of this unit. zero: SI value of the
    unit's zero, which only temperatures need.
    written: whether the study must give the number as a text with this unit.
    others: further paths if the key stands for several equal numbers, such as
    "profile[1-3].diameter".
    """

    key: str
    path: Path
    dimension: str
    nominal: float
    unit: str = ""
    factor: float = 1.0
    zero: float = 0.0
    written: bool = False
    others: tuple[Path, ...] = ()

    @property
    def paths(self) -> tuple[Path, ...]:
        """All paths of the number."""
        return self.path, *self.others

    def shown(self, value: float) -> float:
        """Return a value (SI) in the number's unit."""
        if not self.zero:
            return value / self.factor
        return round((value - self.zero) / self.factor, TEMPERATURE_DECIMALS) + 0.0

    def text(self, value: float) -> str:
        """Return a value (SI) in the number's unit, as human-readable text."""
        return f"{self.shown(value):.6g} {self.unit}".rstrip()

    def spread_text(self, difference: float) -> str:
        """Return a difference of two values (SI) in the number's unit, as human-readable text."""
        return f"{difference / self.factor:.6g} {self.unit}".rstrip()

    def in_study(self, value: float) -> float | str:
        """Return a value, given in the number's unit, in the form in which the study writes it."""
        return f"{value!r} {self.unit}" if self.written else value


def number_at(study: Study, key: str) -> Number:
    """Return the number with a key, which may stand for several equal numbers.

    Raises: ArgumentError for a key that names no number, or different numbers; InputError for a
    text that is not a key.
    """
    numbers = [_single(study, single) for single in single_keys(key)]
    for number in numbers[1:]:
        if (number.nominal, number.dimension) != (numbers[0].nominal, numbers[0].dimension):
            differ = f"{numbers[0].key} and {number.key} differ"
            raise _no_number(f"{differ}; only equal ones vary as one")
    paths = tuple(dict.fromkeys(number.path for number in numbers))
    return replace(numbers[0], key=key, path=paths[0], others=paths[1:])


def _single(study: Study, key: str) -> Number:
    raw = raw_study(study)
    complete = with_lug_defaults(raw)
    try:
        path = _path(study, complete, key)
    except ArgumentError:
        clearance = _clearance(study, raw, key)
        if clearance is None:
            raise
        return clearance
    value = _at(complete, path)
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        what = "a table" if isinstance(value, Mapping) else "a list"
        what = "true or false" if isinstance(value, bool) else what
        raise _no_number(f"is {what}, not a number")
    return _number(study, raw, key, path, value)


def si_value(system: UnitSystem, number: Number, value: float | str) -> float:
    """Return a value for a number in SI.

    value: a number in the study's units, or a text with a unit.

    Raises: ArgumentError for a value of another dimension.
    """
    if number.dimension:
        return to_si(value, number.dimension, system)
    if isinstance(value, str):
        raise ArgumentError(
            f"{as_text(value)}: the number has no unit in the study; give a number without quotes",
            "not-a-number",
        )
    return float(value)


def _clearance(study: Study, raw: dict[str, Any], key: str) -> Number | None:
    """Return the clearance of a lug that the study does not state but leaves to a fit or default;
    None for any other key.
    """
    match key_parts(study, key):
        case ["pin", str() as pin, "lug", str() as lug, "clearance"] if pin in study.table.pin:
            profile = pin_of(study, pin).profile
        case _:
            return None
    for known in () if profile is None else known_lugs(study, profile):
        if known.connection == lug:
            path = "pin", pin, "lug", lug, "clearance"
            return replace(_number(study, raw, key, path, 0.0), nominal=known.clearance)
    return None


def _number(study: Study, raw: dict[str, Any], key: str, path: Path, value: Any) -> Number:
    dimension = _dimension(study, raw, path)
    if not dimension and isinstance(value, str):
        parts = split(value)
        if parts is None or not parts[1]:
            raise _no_number(f"is the text {as_text(value)}, not a number")
        dimension = _dimension_of_unit(parts[1])
        if not dimension:
            raise _no_number(f"is {as_text(value)}, whose unit has no known dimension")
    if not dimension:
        if isinstance(value, int) and _whole(study, raw, path):
            raise _no_number("is a whole number, which cannot vary continuously")
        return Number(key, path, "", float(value))
    nominal = to_si(value, dimension, study.system)
    if dimension in ANGLE_UNITS:
        return Number(key, path, dimension, nominal, *ANGLE_UNITS[dimension], written=True)
    if dimension == "temperature":
        unit = temperature_unit(study.system.imperial)
        return Number(key, path, dimension, nominal, unit, *TEMPERATURES[unit], written=True)
    if dimension in DIMENSIONS_NEEDING_UNIT:
        return Number(key, path, dimension, nominal, SI_UNITS[dimension], written=True)
    system = study.system
    return Number(
        key, path, dimension, nominal, unit_of(system, dimension), system.factor(dimension)
    )


def unit_of(system: UnitSystem, dimension: str) -> str:
    """Return the name of a system's unit of a dimension, made of its units of length, force, time
    and stress.
    """
    if dimension == "stress":
        return system.stress
    if dimension in THERMAL_UNITS:
        return THERMAL_UNITS[dimension]
    exponents, _ = DIMENSION_EXPONENTS[dimension]
    names = (system.force, system.length, system.time)
    powers = [(name, exponents[k]) for name, k in zip(names, (1, 0, 2), strict=True)]
    above, below = (
        " ".join(f"{n}^{abs(e)}" if abs(e) > 1 else n for n, e in powers if e * sign > 0)
        for sign in (1, -1)
    )
    per = [below] * bool(below) + ["rad"] * dimension.startswith("torsional")
    return "/".join([above or "1", *per])


def _dimension(study: Study, raw: dict[str, Any], path: Path) -> str:
    probe = Probe(1.0)
    _validate(study, with_value(raw, path, probe))
    return probe.dimension


def _whole(study: Study, raw: dict[str, Any], path: Path) -> bool:
    """Whether the schema permits only a whole number at a path."""
    errors = _validate(study, with_value(raw, path, 0.5))
    return any(kind in ("int_type", "int_from_float") for kind in errors)


def _validate(study: Study, raw: dict[str, Any]) -> list[str]:
    """Return the kinds of the schema's errors in a study's content."""
    from pydantic import ValidationError

    from pinstress.study.schema.tables import StudyTable

    try:
        StudyTable.model_validate(raw, context={"system": study.system})
    except ValidationError as error:
        return [detail["type"] for detail in error.errors()]
    return []


def _dimension_of_unit(unit: str) -> str:
    return USUAL_UNITS[unit][0] if unit in USUAL_UNITS else ""


def _path(study: Study, raw: Any, key: str) -> Path:
    """Return the path of a key in the raw content; a single number for both ends may be addressed
    with [1] or [2].
    """
    path: list[str | int] = []
    here = raw
    for part in written_parts(raw, key_parts(study, key)):
        if part in (0, 1) and path[-1] in PAIR_KEYS and isinstance(here, int | float | str):
            here = [here, here]
        if not path and part == "vary":
            raise _no_number("says how numbers vary, and does not vary itself")
        value = here[part] if _has(here, part) else None
        if value is None:
            if part == -1:
                raise _no_number("has the index 0; elements are counted from 1")
            said = f"[{part + 1}]" if isinstance(part, int) else as_text(part)
            meant = nearest(part, here) if isinstance(here, Mapping) else None
            pins = raw.get("pin", {}).items() if not path and isinstance(part, str) else ()
            meant = next(
                (f"pin.{key_part(name)}.{key}" for name, pin in pins if _has(pin, part)), meant
            )
            hint = f"did you mean {meant!r}?" if meant else "write it in the study"
            raise _no_number(f"the study has no {said} there; {hint}")
        path.append(part)
        here = value
    return tuple(path)


def _has(here: Any, part: str | int) -> bool:
    if isinstance(part, int):
        return isinstance(here, list) and 0 <= part < len(here)
    return isinstance(here, Mapping) and part in here


def _at(raw: Any, path: Path) -> Any:
    for part in path:
        if not isinstance(raw, int | float | str):
            raw = raw[part]  # else one number stands for both ends
    return raw


def _no_number(why: str) -> ArgumentError:
    return ArgumentError(why, "not-a-varying-number")

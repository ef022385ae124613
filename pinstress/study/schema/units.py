"""Conversion of numbers from a study's units to SI units, which are used everywhere inside the
program.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from pathlib import Path
from typing import Any

from pinbase.errors import ArgumentError, NumberInSI
from pinstress.study.schema.shown import as_text, in_toml, nearest
from pinstress.study.schema.thermal_units import THERMAL_UNITS, thermal_si

# By dimension: the exponents of length, force and time, and an example with a unit
DIMENSION_EXPONENTS: dict[str, tuple[tuple[int, int, int], str]] = {
    "length": ((1, 0, 0), "2 in"),
    "force": ((0, 1, 0), "500 lbf"),
    "time": ((0, 0, 1), "0.15 s"),
    "stress": ((-2, 1, 0), "225 ksi"),
    "mass": ((-1, 1, 2), "12 kg"),
    "density": ((-4, 1, 2), "0.2836 lb/in^3"),
    "inertia": ((1, 1, 2), "0.14 kg m^2"),
    "velocity": ((1, 0, -1), "25 ft/s"),
    "acceleration": ((1, 0, -2), "9.81 m/s^2"),
    "energy": ((1, 1, 0), "3 J"),
    "power": ((1, 1, -1), "3 W"),
    "moment": ((1, 1, 0), "12 N m"),
    "torsional stiffness": ((1, 1, 0), "2e5 N m/rad"),
    "area": ((2, 0, 0), "300 mm^2"),
    "volume": ((3, 0, 0), "2e-3 m^3"),
    "stiffness": ((-1, 1, 0), "20 N/mm"),
    "damping": ((-1, 1, 1), "500 N s/m"),
    "torsional damping": ((1, 1, 1), "5 N m s/rad"),
    "angle": ((0, 0, 0), "45 deg"),
    "angular velocity": ((0, 0, -1), "2 rad/s"),
    "angular acceleration": ((0, 0, -2), "3 rad/s^2"),
    "temperature": ((0, 0, 0), "120 degC"),
    "temperature difference": ((0, 0, 0), "5 degC"),
    "thermal expansion": ((0, 0, 0), "11.7e-6 1/K"),
}

# Dimensions whose numbers are ambiguous without a unit, and the units to choose from, in words
DIMENSIONS_NEEDING_UNIT = {
    **dict.fromkeys(("angle", "angular velocity", "angular acceleration"), "degrees or radians"),
    "temperature": "degC, degF or K",
    "temperature difference": "degC, degF or K",
    "thermal expansion": "1/K or 1/degF",
}


MINUS_SIGN = "\N{MINUS SIGN}"  # as reports print it
DECIMAL_COMMA_PATTERN = re.compile(r"\s*[-+]?\d*,\d")
NUMBER_PATTERN = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
MAX_QUANTITY_LENGTH = 200  # characters of a quantity with its unit
# A power of a unit: a small number, or a ratio of two in brackets. Other numbers in a unit are
# rejected, since pint would spend hours on 9^9^9.
_SMALL_NUMBER_PATTERN = r"[-+]?\d{1,2}+(?:\.\d{1,3}+)?"
POWER_PATTERN = re.compile(
    rf"(?<=[\w)])\s*+(?:\^|\*\*)\s*+(?:{_SMALL_NUMBER_PATTERN}|\(\s*{_SMALL_NUMBER_PATTERN}\s*(?:/\s*{_SMALL_NUMBER_PATTERN}\s*)?\))"
    r"(?![\w.]|\s*(?:\^|\*\*))"
)
OTHER_NUMBER_PATTERN = re.compile(r"\^|\*\*|(?<!\w)(?!1\s*/)\d")
MAX_SI_VALUE = 1e18  # in SI units: above any modulus, and its fourth power does not overflow


@dataclass(frozen=True)
class UnitSystem:
    """A consistent system of units: names and SI values of length, force and time, and the name of
    stress.
    """

    name: str
    length: str
    force: str
    time: str
    stress: str
    in_si: tuple[float, float, float]

    @property
    def imperial(self) -> bool:
        """Whether lengths are in inches, so that temperatures are in degrees Fahrenheit."""
        return self.length == "in"

    @property
    def scales(self) -> tuple[str, float]:
        """Name and SI value of the unit in which messages state masses. The system's own unit, such
        as N s^2/mm, is unusual.
        """
        name = "lb" if self.imperial else "kg"
        return name, USUAL_UNITS[name][1]

    def factor(self, dimension: str) -> float:
        """SI value of the system's unit of a dimension."""
        return self._factors[dimension]

    @cached_property
    def _factors(self) -> dict[str, float]:
        """SI values of the units by dimension, computed once, since a study is read again for every
        design.
        """
        return {
            dimension: math.prod(f**e for f, e in zip(self.in_si, exponents, strict=True))
            for dimension, (exponents, _) in DIMENSION_EXPONENTS.items()
        }

    def unit(self, dimension: str) -> str:
        """Name of the system's unit of a dimension, or of a product of dimensions."""
        names = {
            "length": self.length,
            "force": self.force,
            "time": self.time,
            "stress": self.stress,
            "energy": f"{self.force} {self.length}",
            "moment": f"{self.force} {self.length}",
            "area": f"{self.length}^2",
            "volume": f"{self.length}^3",
            "velocity": f"{self.length}/{self.time}",
            "acceleration": f"{self.length}/{self.time}^2",
            "degrees": "deg",
        }
        if dimension in names:
            return names[dimension]
        return " ".join(names.get(part, part) for part in dimension.split())

    def told(self, number: NumberInSI) -> str:
        """Return a number of a message with its unit in this system; masses are in kg or lb."""
        mass, kilogram = self.scales
        if number.dimension == "mass":
            unit, factor = mass, kilogram
        elif number.dimension == "inertia":
            unit, factor = f"{mass} {self.length}^2", kilogram * self.factor("area")
        else:
            unit, factor = self.unit(number.dimension), self.factor(number.dimension)
        return f"{number.value / factor:.4g} {unit}"


_POUND_FORCE = 0.45359237 * 9.80665

UNIT_SYSTEMS = {
    s.name: s
    for s in (
        UnitSystem("in-lbf-s", "in", "lbf", "s", "psi", (0.0254, _POUND_FORCE, 1.0)),
        UnitSystem("mm-N-s", "mm", "N", "s", "MPa", (1e-3, 1.0, 1.0)),
        UnitSystem("m-N-s", "m", "N", "s", "Pa", (1.0, 1.0, 1.0)),
    )
}


# The usual units with pint's values (a test compares them). Importing pint takes longer than
# checking a study, so pint is used only for other units, and to explain what is wrong with a unit.
USUAL_UNITS: dict[str, tuple[str, float]] = {
    "m": ("length", 1.0),
    "cm": ("length", 0.01),
    "mm": ("length", 0.001),
    "µm": ("length", 1e-6),
    "in": ("length", 0.0254),
    "ft": ("length", 0.3048),
    "mm^2": ("area", 1e-6),
    "m^3": ("volume", 1.0),
    "N": ("force", 1.0),
    "kN": ("force", 1e3),
    "lbf": ("force", _POUND_FORCE),
    "kip": ("force", 1e3 * _POUND_FORCE),
    "s": ("time", 1.0),
    "ms": ("time", 0.001),
    "Pa": ("stress", 1.0),
    "MPa": ("stress", 1e6),
    "GPa": ("stress", 1e9),
    "psi": ("stress", _POUND_FORCE / 0.0254**2),
    "ksi": ("stress", 1e3 * _POUND_FORCE / 0.0254**2),
    "kg": ("mass", 1.0),
    "lb": ("mass", 0.45359237),
    "kg/m^3": ("density", 1.0),
    "g/cm^3": ("density", 1e3),
    "lb/in^3": ("density", 0.45359237 / 0.0254**3),
    "lbf s^2/in^4": ("density", _POUND_FORCE / 0.0254**4),
    "kg m^2": ("inertia", 1.0),
    "kg cm^2": ("inertia", 1e-4),
    "lb in^2": ("inertia", 0.45359237 * 0.0254**2),
    "g": ("mass", 1e-3),
    "N m": ("moment", 1.0),
    "kN m": ("moment", 1e3),
    "N cm": ("moment", 0.01),
    "N mm": ("moment", 1e-3),
    "lbf in": ("moment", _POUND_FORCE * 0.0254),
    "N m/rad": ("torsional stiffness", 1.0),
    "N/m": ("stiffness", 1.0),
    "N/mm": ("stiffness", 1e3),
    "N s/m": ("damping", 1.0),
    "deg": ("angle", math.pi / 180.0),
    "rad": ("angle", 1.0),
    "rad/s": ("angular velocity", 1.0),
    "deg/s": ("angular velocity", math.pi / 180.0),
    "rpm": ("angular velocity", math.pi / 30.0),
    "rad/s^2": ("angular acceleration", 1.0),
    "m/s": ("velocity", 1.0),
    "ft/s": ("velocity", 0.3048),
    "m/s^2": ("acceleration", 1.0),
    "ft/s^2": ("acceleration", 0.3048),
    "in/s^2": ("acceleration", 0.0254),
}


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(str(Path(__file__).with_name("units.txt")))


@cache
def _expected(dimension: str) -> Any:
    exponents, _ = DIMENSION_EXPONENTS[dimension]
    unit = _registry().Unit("")
    for base, e in zip(("m", "N", "s"), exponents, strict=True):
        unit = unit * _registry().Unit(base) ** e
    return unit


def to_si(value: object, dimension: str, system: UnitSystem) -> float:
    """Return a number or string of a study as a float in SI units.

    Raises: ArgumentError with what is wrong with it and the remedy.
    """
    _, example = DIMENSION_EXPONENTS[dimension]
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ArgumentError(
            f"{in_toml(value)} is not {_a(dimension)}; write a number, or a text like {example!r}",
            "not-a-quantity",
        )
    if isinstance(value, str):
        si = _parse(value, dimension, system)
    else:
        try:
            si = _plain(float(value), dimension, system)
        except OverflowError:  # a whole number
            raise ArgumentError(f"{as_text(value)} is {_beyond()}", "too-large") from None
    if math.isinf(si) and isinstance(value, int | float) and math.isfinite(value):
        raise ArgumentError(f"{as_text(value)} is {_beyond()}", "too-large")
    if not math.isfinite(si):
        raise ArgumentError(f"must be finite, not {as_text(value)}", "not-finite")
    if abs(si) > MAX_SI_VALUE:
        raise ArgumentError(f"{as_text(value)} is {_beyond()}", "too-large")
    return si


def _a(dimension: str) -> str:
    return f"{'an' if dimension[0] in 'aeio' else 'a'} {dimension}"


def _beyond() -> str:
    return f"too large: the limit is {MAX_SI_VALUE:g} in SI units"


def _plain(number: float, dimension: str, system: UnitSystem) -> float:
    if dimension in DIMENSIONS_NEEDING_UNIT:
        _, example = DIMENSION_EXPONENTS[dimension]
        raise ArgumentError(
            f"{number:g} needs a unit, {DIMENSIONS_NEEDING_UNIT[dimension]}; write for instance "
            f"{example!r}",
            "missing-unit",
        )
    return number * system.factor(dimension)


def split(text: str) -> tuple[float, str] | None:
    """Return a quantity's number and unit; None for a text that does not begin with a number."""
    text = text.strip() if len(text) <= MAX_QUANTITY_LENGTH else ""
    number = NUMBER_PATTERN.match(text)
    return (float(number[0]), text[number.end() :].strip()) if number else None


def _parse(text: str, dimension: str, system: UnitSystem) -> float:
    _, example = DIMENSION_EXPONENTS[dimension]
    if len(text) > MAX_QUANTITY_LENGTH:
        raise ArgumentError(
            f"{as_text(text)} has {len(text):,} characters; write a number and a unit like "
            f"{example!r}",
            "too-long",
        )
    if any(c.isdecimal() and not c.isascii() for c in text):
        raise ArgumentError(
            f"{as_text(text)} has digits other than 0 to 9; write for instance {example!r}",
            "not-a-number",
        )
    if DECIMAL_COMMA_PATTERN.match(text):
        raise ArgumentError(
            f"{as_text(text)} has a comma; write decimals with a point, and thousands without a "
            f"mark",
            "decimal-comma",
        )
    quantity = split(text)
    if quantity is None and MINUS_SIGN in text:
        hyphen = text.replace(MINUS_SIGN, "-")
        raise ArgumentError(
            f"{as_text(text)} has a Unicode minus sign; write {hyphen!r}", "not-a-number"
        )
    if quantity is None:
        raise ArgumentError(
            f"{as_text(text)} does not begin with a number; write for instance {example!r}",
            "not-a-number",
        )
    number, unit = quantity
    if unit.startswith("_"):
        raise ArgumentError(
            f"{as_text(text)} has an underscore after its first digits; write digits without marks "
            f"between them, for instance {example!r}",
            "not-a-number",
        )
    if not unit:
        return _plain(number, dimension, system)
    if dimension in THERMAL_UNITS:
        return thermal_si(number, unit, dimension, text)
    return number * _unit_factor(unit, dimension, text)


@lru_cache(1000)
def _unit_factor(unit: str, dimension: str, text: str) -> float:
    if unit in USUAL_UNITS and USUAL_UNITS[unit][0] == dimension:
        return USUAL_UNITS[unit][1]
    return _by_pint(unit, dimension, text)


def _by_pint(unit: str, dimension: str, text: str) -> float:
    import pint

    near = _meant(unit, dimension)
    try:
        if OTHER_NUMBER_PATTERN.search(POWER_PATTERN.sub("", unit)):
            raise ValueError("a number other than a power")
        parsed = _registry().Quantity(1.0, unit)
        return float(parsed.to(_expected(dimension)).magnitude)
    except pint.UndefinedUnitError as error:
        names: Any = error.unit_names
        unknown = str(names if isinstance(names, str) else names[0])
        near = (
            near
            or _powered(unit, dimension)
            or nearest(unknown, [*_symbols(), *map(str, _registry())])
        )
        what, code = f"unknown unit {as_text(unknown)} in {as_text(text)}", "unknown-unit"
    except pint.DimensionalityError:
        what, code = f"{as_text(text)} is not {_a(dimension)}", "wrong-dimension"
    except Exception:  # pint's parser raises what its tokenizer raises
        what, code = f"cannot read the unit in {as_text(text)}", "unreadable-unit"
    _, example = DIMENSION_EXPONENTS[dimension]
    hint = f"did you mean {near!r}?" if near else f"write for instance {example!r}"
    raise ArgumentError(f"{what}; {hint}", code)


def _meant(unit: str, dimension: str) -> str | None:
    """Return the usual unit of a dimension that has the same spelling except for capitals, blanks,
    dots and signs of powers.
    """
    spelled = {_bare(usual): usual for usual, (of, _) in USUAL_UNITS.items() if of == dimension}
    return spelled.get(_bare(unit))


def _powered(unit: str, dimension: str) -> str | None:
    """Return a unit with signs of powers before its digits, if that is one of the dimension."""
    powered = re.sub(r"(?<=[^\W\d])(?=\d)", "^", unit)
    with suppress(Exception):  # as in _by_pint
        if _registry().Quantity(1.0, powered).check(_expected(dimension)):
            return powered
    return None


def _bare(unit: str) -> str:
    return re.sub(r"[\s*.·^-]", "", unit).casefold()


def _symbols() -> dict[str, None]:
    """Return the names that occur in the usual units, each once."""
    return dict.fromkeys(name for unit in USUAL_UNITS for name in re.findall(r"[A-Za-z]+", unit))

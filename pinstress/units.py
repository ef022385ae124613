"""The door: numbers come in and go out in the study's units; inside everything is SI."""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

# dimension: its exponents of length, force and time, and an example with a unit
DIMENSIONS: dict[str, tuple[tuple[int, int, int], str]] = {
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
    "angle": ((0, 0, 0), "45 deg"),
    "angular velocity": ((0, 0, -1), "2 rad/s"),
    "angular acceleration": ((0, 0, -2), "3 rad/s^2"),
}

UNIT_NEEDED = ("angle", "angular velocity", "angular acceleration")  # degrees or radians?


ENDLESS = re.compile(r"(\^|\*\*)([^a-zA-Z]*(\^|\*\*)|[\s(+-]*\d{3})")  # 9^9^9, 9^999
LARGEST = 1e18  # in SI: beyond any modulus, and its fourth power is still a number


@dataclass(frozen=True)
class UnitSystem:
    """A consistent system: names and SI values of length, force, time; the name of its stress."""

    name: str
    length: str
    force: str
    time: str
    stress: str
    in_si: tuple[float, float, float]

    def factor(self, dimension: str) -> float:
        """SI value of this system's unit of a dimension."""
        exponents, _ = DIMENSIONS[dimension]
        return math.prod(f**e for f, e in zip(self.in_si, exponents, strict=True))


_POUND_FORCE = 0.45359237 * 9.80665

SYSTEMS = {
    s.name: s
    for s in (
        UnitSystem("in-lbf-s", "in", "lbf", "s", "psi", (0.0254, _POUND_FORCE, 1.0)),
        UnitSystem("mm-N-s", "mm", "N", "s", "MPa", (1e-3, 1.0, 1.0)),
        UnitSystem("m-N-s", "m", "N", "s", "Pa", (1.0, 1.0, 1.0)),
    )
}


# What pint gives for the usual units (a test compares them): pint takes longer to import than a
# study to check, so it is asked only for others, and to say what is wrong.
USUAL: dict[str, tuple[str, float]] = {
    "m": ("length", 1.0),
    "cm": ("length", 0.01),
    "mm": ("length", 0.001),
    "in": ("length", 0.0254),
    "ft": ("length", 0.3048),
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
    "kg m^2": ("inertia", 1.0),
    "lb in^2": ("inertia", 0.45359237 * 0.0254**2),
    "g": ("mass", 1e-3),
    "N m": ("moment", 1.0),
    "N cm": ("moment", 0.01),
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
    exponents, _ = DIMENSIONS[dimension]
    unit = _registry().Unit("")
    for base, e in zip(("m", "N", "s"), exponents, strict=True):
        unit = unit * _registry().Unit(base) ** e
    return unit


def to_si(value: object, dimension: str, system: UnitSystem) -> float:
    """A study's number or string as a float in SI.

    Raises: ValueError saying what is wrong with it and what would be right.
    """
    _, example = DIMENSIONS[dimension]
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(
            f"{value!r} is not a {dimension}; write a number or a string like {example!r}"
        )
    if isinstance(value, str):
        si = _parse(value, dimension, system)
    else:
        try:
            si = _plain(float(value), dimension, system)
        except OverflowError:  # a whole number
            raise ValueError("the number is too large to calculate with") from None
    if not math.isfinite(si):
        raise ValueError(f"{value!r} is not finite")
    if abs(si) > LARGEST:
        raise ValueError(f"{value!r} is too large to calculate with")
    return si


def _plain(number: float, dimension: str, system: UnitSystem) -> float:
    if dimension in UNIT_NEEDED:
        _, example = DIMENSIONS[dimension]
        raise ValueError(f"{number:g} needs its unit; write for instance {example!r}")
    return number * system.factor(dimension)


def _parse(text: str, dimension: str, system: UnitSystem) -> float:
    _, example = DIMENSIONS[dimension]
    match = re.fullmatch(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*", text)
    if not match:
        raise ValueError(f"{text!r} does not begin with a number; write for instance {example!r}")
    number, unit = float(match[1]), match[2]
    if not unit:
        return _plain(number, dimension, system)
    return number * _unit_factor(unit, dimension, text)


@cache
def _unit_factor(unit: str, dimension: str, text: str) -> float:
    if unit in USUAL and USUAL[unit][0] == dimension:
        return USUAL[unit][1]
    return _by_pint(unit, dimension, text)


def _by_pint(unit: str, dimension: str, text: str) -> float:
    import pint

    _, example = DIMENSIONS[dimension]
    try:
        if ENDLESS.search(unit):
            raise ValueError("a power that would take for ever")
        parsed = _registry().Quantity(1.0, unit)
    except pint.UndefinedUnitError as error:
        names: Any = error.unit_names
        unknown = names if isinstance(names, str) else names[0]
        near = difflib.get_close_matches(str(unknown), [str(u) for u in _registry()._units], n=1)
        hint = f"; did you mean {near[0]!r}?" if near else f"; write for instance {example!r}"
        raise ValueError(f"unknown unit {str(unknown)!r} in {text!r}{hint}") from None
    except Exception:  # pint's parser raises what its tokenizer raises
        raise ValueError(
            f"cannot read the unit in {text!r}; write for instance {example!r}"
        ) from None
    try:
        return float(parsed.to(_expected(dimension)).magnitude)
    except pint.DimensionalityError:
        article = "an" if dimension[0] in "aeio" else "a"
        raise ValueError(
            f"{text!r} is not {article} {dimension}; write for instance {example!r}"
        ) from None

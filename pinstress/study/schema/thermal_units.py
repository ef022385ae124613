"""Units of temperature, of temperature difference, and of thermal expansion.

An absolute temperature has an offset: 20 degC is 293.15 K. A difference has none: a difference of
20 degC, such as a standard deviation or a tolerance of a temperature, is 20 K.
"""

from __future__ import annotations

from pinbase.errors import ArgumentError
from pinstress.study.schema.shown import as_text

FAHRENHEIT = 5.0 / 9.0  # K
# Size of one unit in K, and temperature of its zero in K
TEMPERATURES = {
    "K": (1.0, 0.0),
    "degC": (1.0, 273.15),
    "°C": (1.0, 273.15),
    "degF": (FAHRENHEIT, 459.67 * FAHRENHEIT),
    "°F": (FAHRENHEIT, 459.67 * FAHRENHEIT),
}
EXPANSIONS = {
    "1/K": 1.0,
    "1/degC": 1.0,
    "1/°C": 1.0,
    "1/degF": 1.0 / FAHRENHEIT,
    "1/°F": 1.0 / FAHRENHEIT,
    "K^-1": 1.0,
    "ppm/K": 1e-6,
    "ppm/degC": 1e-6,
    "ppm/degF": 1e-6 / FAHRENHEIT,
    "um/m/K": 1e-6,
    "um/(m K)": 1e-6,
    "µm/(m K)": 1e-6,
    "in/in/degF": 1.0 / FAHRENHEIT,
}
# By dimension: the unit of the validated tables
THERMAL_UNITS = {"temperature": "K", "temperature difference": "K", "thermal expansion": "1/K"}


def difference_of(dimension: str) -> str:
    """The dimension of a difference between two values of a dimension."""
    return "temperature difference" if dimension == "temperature" else dimension


def thermal_si(number: float, unit: str, dimension: str, text: str) -> float:
    """A quantity of one of the THERMAL_UNITS in SI units.

    text: the quantity as the study writes it.

    Raises: ArgumentError for another unit, or a temperature below absolute zero.
    """
    unit = " ".join(unit.split())
    if dimension == "thermal expansion":
        if unit in EXPANSIONS:
            return number * EXPANSIONS[unit]
        raise _unknown(unit, text, "1/K or 1/degF", "11.7e-6 1/K")
    if unit not in TEMPERATURES:
        raise _unknown(unit, text, "K, degC or degF", "120 degC")
    one, zero = TEMPERATURES[unit]
    if dimension == "temperature difference":
        return number * one
    if number * one + zero < 0.0:
        raise ArgumentError(
            f"{as_text(text)} is below absolute zero, {-zero / one:.6g} {unit}", "out-of-range"
        )
    return number * one + zero


def temperature_unit(imperial: bool) -> str:
    """The unit in which temperatures are shown: degrees Fahrenheit for imperial units, otherwise
    Celsius.
    """
    return "degF" if imperial else "degC"


def shown_temperature(kelvin: float, imperial: bool) -> str:
    """A temperature as text, in the unit in which temperatures are shown."""
    unit = temperature_unit(imperial)
    one, zero = TEMPERATURES[unit]
    return f"{round((kelvin - zero) / one, 1) + 0.0:.10g} {unit}"


def _unknown(unit: str, text: str, known: str, example: str) -> ArgumentError:
    return ArgumentError(
        f"{as_text(text)} has the unit {as_text(unit)}, which is not {known}; write for instance "
        f"{example!r}",
        "unknown-unit",
    )

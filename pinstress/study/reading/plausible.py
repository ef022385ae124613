"""Possible mistakes in the numbers of a study, which are allowed but unusual, mostly because of a
wrong unit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from pinbase.keys import key_part, lug_key
from pinstress.study.schema.materials import MaterialTable
from pinstress.study.schema.pins import PinTable
from pinstress.study.schema.shown import as_text
from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.units import UNIT_SYSTEMS, UnitSystem, split, to_si


@dataclass(frozen=True)
class UsualRange:
    """The usual range of a quantity and its typical value, in SI units, with what it is usual for.

    metric, imperial: the usual units; messages use the first metric one.
    """

    dimension: str
    low: float
    high: float
    typical: float
    whose: str
    metric: tuple[str, ...]
    imperial: tuple[str, ...]


LENGTH_UNITS = ("mm", "m", "cm"), ("in", "ft")
IMPERIAL_STRESS_UNITS = "ksi", "psi", "Msi"
USUAL_RANGES = {
    "modulus": UsualRange(
        "stress", 1e9, 1.2e12, 2e11, "a structural material", ("GPa", "MPa", "Pa"),
        IMPERIAL_STRESS_UNITS,
    ),
    "strength": UsualRange(
        "stress",
        1e6,
        6e9,
        5e8,
        "a structural material",
        ("MPa", "GPa", "Pa"),
        IMPERIAL_STRESS_UNITS,
    ),
    "density": UsualRange(
        "density", 1e2, 2.3e4, 7850.0, "a solid material", ("kg/m^3", "g/cm^3", "t/mm^3"),
        ("lb/in^3", "lb/ft^3"),
    ),
    "diameter": UsualRange("length", 1e-4, 3.0, 0.03, "a pin", *LENGTH_UNITS),
    "length": UsualRange("length", 1e-5, 10.0, 0.03, "a pin", *LENGTH_UNITS),
    "gravity": UsualRange(
        "acceleration", 1.0, 200.0, 9.81, "a machine", ("m/s^2", "mm/s^2"), ("ft/s^2", "in/s^2")
    ),
}  # fmt: skip
USUAL_TEMPERATURES = 1.0, 2000.0  # K, from liquid helium to beyond the melting of steel
USUAL_STIFFNESS_RATIOS = 1e-2, 1e2  # stiffness of a lug over that of the lug as described
MAX_YIELD_STRAIN = 1.0 / 20.0  # largest plausible strain at yield


@dataclass(frozen=True)
class StatedValue:
    """A number of the study: its key in USUAL_RANGES (`kind`), its key in the study, its value in
    SI units, and its text.

    most: upper bound in SI units, if it is below the usual one.
    """

    kind: str
    key: str
    value: float
    written: Any
    most: float = math.inf

    @property
    def usual(self) -> UsualRange:
        """The usual range of the quantity."""
        return USUAL_RANGES[self.kind]

    def plausible(self, value: float) -> bool:
        """Return whether a value (in SI units) would be plausible."""
        return self.usual.low <= value <= min(self.usual.high, self.most)


def questions(table: StudyTable, raw: dict[str, Any], system: UnitSystem) -> tuple[str, ...]:
    """Return the possible mistakes, each with the key and the likely unit.

    raw: the content of the file.
    """
    usual = (text for number in _numbers(table, raw) if (text := _question(number, system)))
    return (*usual, *_of_temperatures(table, raw), *_of_ranges(table))


def _of_temperatures(table: StudyTable, raw: dict[str, Any]) -> Iterator[str]:
    """Yield a sentence on every temperature outside the usual range of machines."""
    stated = {
        f"case.{key_part(name)}.temperature": (case.temperature, raw["case"][name])
        for name, case in table.case.items()
        if case.temperature is not None
    }
    if "reference_temperature" in table.analysis.model_fields_set:
        of_drawing = table.analysis.reference_temperature
        stated["analysis.reference_temperature"] = (of_drawing, raw["analysis"])
    low, high = USUAL_TEMPERATURES
    for key, (kelvin, written) in stated.items():
        if not low <= kelvin <= high:
            text = as_text(written.get(key.rpartition(".")[2], f"{kelvin:g} K"))
            yield (
                f"{key}: {text} is {kelvin:,.4g} K, but the usual range for a machine is {low:g} "
                f"to {high:,g} K; check its unit"
            )


def _of_ranges(table: StudyTable) -> Iterator[str]:
    """Yield a sentence on every range of a lug's stiffness with implausible ratios."""
    low, high = USUAL_STIFFNESS_RATIOS
    common = None if table.lug_defaults is None else table.lug_defaults.range.stiffness
    stated = {"lug_defaults": common}
    for name, pin in table.pin.items():
        for connection, lug in pin.lug.items():
            if lug.range.stiffness != common:
                stated[lug_key(name, connection)] = lug.range.stiffness
    for key, ratios in stated.items():
        if ratios is not None and not (low <= min(ratios) and max(ratios) <= high):
            yield (
                f"{key}.range.stiffness: {ratios[0]:g} to {ratios[1]:g} times that of the lug, but "
                f"the usual range is within {low:g} and {high:g}; give ratios, not stiffnesses"
            )


def _numbers(table: StudyTable, raw: Any) -> Iterator[StatedValue]:
    """Yield all numbers that have a usual range."""
    for name, material in table.material.items():
        yield from _of_material(f"material.{key_part(name)}", material, raw["material"][name])
    for name, pin in table.pin.items():
        yield from _of_pin(f"pin.{key_part(name)}", pin, raw["pin"][name])
    if table.mechanism is not None:
        if gravity := raw["mechanism"].get("gravity"):
            components = table.mechanism.gravity
            written = gravity[max(range(len(components)), key=lambda k: (abs(components[k]), k))]
            yield StatedValue("gravity", "mechanism.gravity", math.hypot(*components), written)
        for name, body in table.mechanism.body.items():
            if body.bar is not None:
                written = raw["mechanism"]["body"][name]["bar"]["density"]
                key = f"mechanism.body.{key_part(name)}.bar.density"
                yield StatedValue("density", key, body.bar.density, written)


def _of_material(key: str, material: MaterialTable, raw: dict[str, Any]) -> Iterator[StatedValue]:
    E, strength = material.youngs_modulus, material.yield_strength
    modulus = StatedValue("modulus", f"{key}.youngs_modulus", E, raw["youngs_modulus"])
    yield modulus
    if material.density is not None:
        yield StatedValue("density", f"{key}.density", material.density, raw["density"])
    if strength is not None:
        most = MAX_YIELD_STRAIN * E if modulus.plausible(E) else math.inf
        yield StatedValue(
            "strength", f"{key}.yield_strength", strength, raw["yield_strength"], most
        )


def _of_pin(key: str, pin: PinTable, raw: dict[str, Any]) -> Iterator[StatedValue]:
    for i, segment in enumerate(pin.profile or ()):
        at, written = f"{key}.profile[{i + 1}]", raw["profile"][i]
        yield StatedValue("length", f"{at}.length", segment.length, written["length"])
        if not isinstance(segment.diameter, tuple):
            yield StatedValue("diameter", f"{at}.diameter", segment.diameter, written["diameter"])
            continue
        for k, value in enumerate(segment.diameter):
            yield StatedValue("diameter", f"{at}.diameter[{k + 1}]", value, written["diameter"][k])


def _question(stated: StatedValue, system: UnitSystem) -> str:
    usual = stated.usual
    if stated.value == 0.0 or stated.plausible(abs(stated.value)):
        return ""
    unit, ends = usual.metric[0], (usual.low, min(usual.high, stated.most))
    one = to_si(f"1 {unit}", usual.dimension, system)
    if usual.low <= stated.value <= usual.high:  # the modulus may be the wrong value
        return (
            f"{stated.key}: {as_text(stated.written)} is {stated.value / one:,.4g} {unit}, more "
            f"than {MAX_YIELD_STRAIN:.0%} of youngs_modulus "
            f"({stated.most / MAX_YIELD_STRAIN / one:,.4g} {unit}); check the units of both"
        )
    is_, low, most = (f"{value / one:,.4g}" for value in (stated.value, *ends))
    hint = f"; did you mean {likely}?" if (likely := _likely(stated, system)) else ""
    return (
        f"{stated.key}: {as_text(stated.written)} is {is_} {unit}, but the usual range for "
        f"{usual.whose} is {low} to {most} {unit}{hint}"
    )


def _likely(stated: StatedValue, system: UnitSystem) -> str:
    """Return the number as written with its most plausible unit; empty if there is none.

    Units of the number's own system come first; among them the unit counts that brings the value
    nearest to the typical one.
    """
    quantity = split(stated.written) if isinstance(stated.written, str) else (stated.written, "")
    if quantity is None:
        return ""
    (number, unit), usual = quantity, stated.usual
    kinds = [usual.metric, usual.imperial]
    if unit in usual.imperial or (not unit and system is UNIT_SYSTEMS["in-lbf-s"]):
        kinds.reverse()
    for units in kinds:
        values = {u: abs(number) * to_si(f"1 {u}", usual.dimension, system) for u in units}
        usable = {u: v for u, v in values.items() if stated.plausible(v)}
        if usable:
            best = min(usable, key=lambda u: abs(math.log(usable[u] / usual.typical)))
            return f'"{number:.10g} {best}"'
    return ""

"""Other diameters in a study's text: everything else in it stays as it was written."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import tomlkit

from pinstress.schema.units import UnitSystem, to_si

DIGITS = 4  # of a length that is not rounded to a step
NUMBER = re.compile(r"\s*[-+]?[0-9_.]+(?:[eE][-+]?[0-9]+)?")


def resized(
    text: str,
    scales: Mapping[str, float],
    system: UnitSystem,
    step: float | None = None,
    required: float | None = None,
) -> str:
    """A study's text with pins (by name) scaled across their axis: diameters, bores, fillets and
    the distances of flats; lengths and cross holes stay.

    Diameters are rounded up, to a step (m) or to four digits, bores and fillets down; scale 1
    without a step changes nothing. Provenance that no longer holds is replaced. required: the
    study's new required factor of safety, if any.
    """
    study = tomlkit.parse(text)
    for name, scale in scales.items():
        if scale == 1.0 and step is None:
            continue
        pin: Any = study["pin"][name]
        for table in (pin, *_plain(pin.get("profile", [])), *_plain(pin.get("flat", []))):
            for key, up in (("diameter", 1), ("distance", 1), ("bore", -1), ("fillet", -1)):
                if key in table:
                    rounding = step if key == "diameter" else None
                    table[key] = _scaled(table, key, scale, system, rounding, up)
    if required is not None:
        analysis: Any = study.setdefault("analysis", tomlkit.table())
        old = analysis.get("required_safety_factor")
        if old is None or float(_value(old)) != required:
            analysis["required_safety_factor"] = required
    return tomlkit.dumps(study)


def _plain(node: Any) -> list[Any]:
    """The entries of an array, also one that comes with its provenance."""
    return list(_value(node))


def _value(node: Any) -> Any:
    return node["value"] if isinstance(node, dict) and "value" in node else node


def _scaled(
    table: Any, key: str, scale: float, system: UnitSystem, step: float | None, up: int
) -> Any:
    old = _value(table[key])
    unit = NUMBER.sub("", old, count=1) if isinstance(old, str) else ""
    one = to_si(f"1{unit}", "length", system) if unit.strip() else system.factor("length")
    size = to_si(old, "length", system) / one
    number = _rounded(size * scale, None if step is None else step / one, up)
    if math.isclose(number, size, rel_tol=1e-12):
        return table[key]
    new = f"{number:.12g}{unit}" if isinstance(old, str) else number
    if "provenance" not in table and not isinstance(table[key], dict):
        return new
    note = f"by pinstress size, from {old}"
    sourced = tomlkit.inline_table()
    sourced.update({"value": new, "provenance": "derived", "note": note})
    return sourced


def _rounded(number: float, step: float | None, up: int) -> float:
    if number == 0.0:
        return 0.0
    step = step or 10.0 ** (math.floor(math.log10(number)) + 1 - DIGITS)
    count = number / step
    # What is a whole number of steps but for the last digits stays.
    whole = math.ceil(count - 1e-9) if up > 0 else math.floor(count + 1e-9)
    return float(f"{whole * step:.12g}")

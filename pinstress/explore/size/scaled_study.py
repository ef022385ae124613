"""Changes of diameters in a study's text; everything else remains as written."""

from __future__ import annotations

import copy
import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import tomlkit

from pinstress.explore.size.standard_diameters import StandardDiameters
from pinstress.study.model.pins import pin, weight
from pinstress.study.reading.file import Study, parse_study
from pinstress.study.reading.in_python import write_lug
from pinstress.study.schema.units import UnitSystem, to_si

LENGTH_DIGITS = 4  # significant digits of a length that is not rounded to a step
LEADING_NUMBER_PATTERN = re.compile(r"\s*[-+]?[0-9_.]+(?:[eE][-+]?[0-9]+)?")
# Keys of lengths transverse to the axis; 1 where rounding up is on the safe side, else -1.
TRANSVERSE_LENGTH_KEYS = {
    "diameter": 1,
    "distance": 1,
    "bore": -1,
    "fillet": -1,
    "edge_radius": -1,
    "bore_radius": -1,
}
PUBLISHED_TABLE_KEYS = ("peaks", "reactions", "motion", "values")  # that [published] names


def resized_study(
    study: Study,
    scales: Mapping[str, float],
    standard: StandardDiameters | None = None,
    required: float | None = None,
) -> Study:
    """Return the study with pins scaled as by `resized`, and with all values that depend on them.

    Stated weights of floating pins change by the weight of their shapes, and eyes that have become
    narrower than [size] eye_ratio times their bores grow.

    Raises: InputError for an impossible shape.
    """
    document = resized(study.text, scales, study.system, standard, required)
    return with_what_follows(study, document, scales)


def with_what_follows(study: Study, document: tomlkit.TOMLDocument, pins: Iterable[str]) -> Study:
    """Return the study of a document in which pins have changed shapes, with all values that depend
    on these shapes updated. The document is updated, too.

    study: the study before the change. pins: the names of the changed pins.

    Raises: InputError for an impossible shape.
    """
    before = tomlkit.dumps(document)
    if before == study.text:
        return study
    new = parse_study(study.path, before)
    for name in pins:
        _reweigh(document, study, new, name)
        _widen_eyes(document, study, new, name)
    text = tomlkit.dumps(document)
    return new if text == before else parse_study(study.path, text)


def resized(
    text: str,
    scales: Mapping[str, float],
    system: UnitSystem,
    standard: StandardDiameters | None = None,
    required: float | None = None,
) -> tomlkit.TOMLDocument:
    """Return a study's document with pins scaled transverse to their axis.

    Diameters, bores, fillets, the distances of flats and the offsets of passages and holes are
    scaled; lengths and other sizes of holes and slots are not. Diameters are rounded up, to a
    standard diameter or to four digits. Bores and fillets are rounded down, fillets to at most the
    height of their steps. Scale 1 without standard diameters changes nothing. Provenance that no
    longer holds is replaced.

    scales: by name of the pin. required: the study's new required safety factor, if any.
    """
    study = tomlkit.parse(text)
    for name, scale in scales.items():
        if scale == 1.0 and standard is None:
            continue
        table_of_pin: Any = study["pin"][name]
        parts = (*_plain(table_of_pin.get("profile", [])), *_plain(table_of_pin.get("flat", [])))
        for table in (table_of_pin, *parts):
            for key, up in TRANSVERSE_LENGTH_KEYS.items():
                if key in table:
                    diameter = 1.0 if key == "diameter" else None
                    for here, at in _numbers(table, key):
                        _scale(here, at, scale, system, up, standard, diameter)
        _fit_fillets(table_of_pin, system)
        for table in (t for cut in ("passage", "hole") for t in _plain(table_of_pin.get(cut, []))):
            if "offset" not in table:
                continue
            for here, at in _numbers(table, "offset"):
                _scale(here, at, scale, system, -1)
        for key, up in (("meridian", 1), ("bore_meridian", -1)):
            for corner in map(value_of, _plain(table_of_pin.get(key, []))):
                _scale(corner, 1, scale, system, up, standard, 0.5 if up > 0 else None)
                if corner[2:]:
                    _scale(corner, 2, scale, system, -1)
    require(study, required)
    return study


def _fit_fillets(pin: Any, system: UnitSystem) -> None:
    """Reduce the fillets between cylinders of a pin's table that exceed the height of their steps,
    which rounding of diameters may have reduced.
    """
    for left, right in pairwise(_plain(pin.get("profile", []))):
        owner = left if "fillet" in left else pin
        diameters = [value_of(segment["diameter"]) for segment in (left, right)]
        if "fillet" not in owner or any(isinstance(d, list) for d in diameters):
            continue
        radius, a, b = (to_si(x, "length", system) for x in (value_of(owner["fillet"]), *diameters))
        if 0.0 < 0.5 * abs(a - b) < radius * (1.0 - 1e-12):
            _write(owner, "fillet", 0.5 * abs(a - b), "length", system, -1)


def require(document: Any, required: float | None) -> None:
    """Write a required safety factor, if any, into a study's document."""
    if required is not None:
        analysis: Any = document.setdefault("analysis", tomlkit.table())
        old = analysis.get("required_safety_factor")
        if old is None or float(value_of(old)) != required:
            analysis["required_safety_factor"] = required


def moved(text: str, old: Path, new: Path) -> str:
    """Return a study's text for another folder, with relative paths to the same files."""
    if old.resolve() == new.resolve():
        return text
    document = tomlkit.parse(text)
    for table, key in _files(document):
        path = os.path.join(old.resolve(), value_of(table[key]))
        try:
            name = os.path.relpath(path, new.resolve())
        except ValueError:  # on another drive
            name = path
        table[key] = Path(name).as_posix()
    return tomlkit.dumps(document)


def _files(document: Any) -> Iterator[tuple[Any, str]]:
    """Yield the tables that name a file, each with the key of the file name."""
    if "materials" in document:
        yield document, "materials"
    yield from ((pin, "geometry") for pin in document.get("pin", {}).values() if "geometry" in pin)
    published = document.get("published", {})
    yield from ((published, key) for key in PUBLISHED_TABLE_KEYS if key in published)
    for part in ("case", "mechanism"):
        yield from _tables(document.get(part, {}))


def _tables(node: Any) -> Iterator[tuple[Any, str]]:
    """Yield the entries that name a file with a table, each with the key of the file name: cases,
    drives, laws of forces and springs, and tables of cases that state their columns.
    """
    if isinstance(node, list):
        for entry in node:
            yield from _tables(entry)
    elif isinstance(node, dict):
        table = value_of(node.get("table"))
        if isinstance(table, str):
            yield node, "table"
        else:
            stated = table if isinstance(table, list) else [table]
            yield from ((one, "file") for one in stated if _states_file(one))
        for entry in node.values():
            yield from _tables(entry)


def _states_file(table: Any) -> bool:
    return isinstance(table, dict) and isinstance(value_of(table.get("file")), str)


def _plain(node: Any) -> list[Any]:
    """Return the entries of an array, also of one with a provenance."""
    return list(value_of(node))


def value_of(node: Any) -> Any:
    return node["value"] if isinstance(node, dict) and "value" in node else node


def _reweigh(document: Any, old: Study, new: Study, name: str) -> None:
    """Change the stated weight of a floating pin by the change of its shape's weight."""
    mechanism, density = new.table.mechanism, new.material_of(name).density
    joint = None if mechanism is None else mechanism.joint.get(name)
    if not density or joint is None or joint.fixed_in or joint.weight is None:
        return
    heavier = weight(pin(new, name), density) - weight(pin(old, name), density)
    _write(
        document["mechanism"]["joint"][name], "weight", joint.weight + heavier, "force", new.system
    )


def _widen_eyes(document: Any, old: Study, new: Study, name: str) -> None:
    for at, least in wider_eyes(old, new, name).items():
        write_lug(document, new, name, at)
        lug = document["pin"][name]["lug"][at]
        if "outer_diameter" not in lug:
            lug["outer_diameter"] = copy.deepcopy(document["lug_defaults"]["outer_diameter"])
        _write(lug, "outer_diameter", least, "length", new.system)


def wider_eyes(old: Study, new: Study, name: str) -> dict[str, float]:
    """Return the outer diameters, m, of the eyes around a pin that must grow, by connection: those
    with a given diameter that have become too narrow and may change.
    """
    out, allowed, table = dict[str, float](), new.table.size, new.table.pin[name]
    for at, lug in table.lug.items():
        if lug.outer_diameter is None or not allowed.scale_lugs:
            continue
        before, after = (hole_in_eye(x, name, at) for x in (old, new))
        least = min(allowed.eye_ratio, lug.outer_diameter / before) * after
        if lug.outer_diameter < least * (1.0 - 1e-9):
            stated = table.shared_lugs.get(at, at)  # the ear that states the size of both
            out[stated] = max(least, out.get(stated, 0.0))
    return out


def hole_in_eye(study: Study, name: str, connection: str) -> float:
    """Return the diameter of the hole in an eye around a pin, m; it includes the bushing."""
    bushing = study.table.pin[name].lug[connection].bushing
    ring = 2.0 * bushing.thickness if bushing else 0.0
    return 2.0 * pin(study, name).band(connection).radius + ring


def _numbers(table: Any, key: str) -> list[tuple[Any, Any]]:
    """Return the containers of a key's numbers, each with the key or index: one number, or one for
    each end.
    """
    both = value_of(table[key])
    return [(both, i) for i in range(len(both))] if isinstance(both, list) else [(table, key)]


def _scale(
    table: Any,
    key: Any,
    scale: float,
    system: UnitSystem,
    up: int,
    standard: StandardDiameters | None = None,
    of_diameter: float | None = None,
) -> None:
    """Scale a number of a table.

    up: 1 to round up, -1 to round down.
    standard: the permitted diameters; None for any.
    of_diameter: 1 for a diameter, 0.5 for a radius, None for any other length.
    """
    old = value_of(table[key])
    size, one = to_si(old, "length", system), unit_of(old, "length", system)[1]
    if standard is None or of_diameter is None or not size:
        number = rounded(size / one * scale, None, up)
    else:
        diameter = standard.up(size * scale / of_diameter, one)
        number = float(f"{diameter * of_diameter / one:.12g}")
    if not math.isclose(number * one, size, rel_tol=1e-12):
        replace_number(table, key, number, unit_of(old, "length", system)[0])


def _write(
    table: Any, key: str, si: float, dimension: str, system: UnitSystem, up: int = 1
) -> None:
    """Write a number, given in SI, in the unit of the old number; up: as in `_scale`."""
    unit, one = unit_of(value_of(table[key]), dimension, system)
    replace_number(table, key, rounded(si / one, None, up), unit)


def unit_of_diameter(study: Study, name: str, diameter: float) -> float:
    """Return the unit, m, in which a pin's diameter (m) is written."""
    table: Any = tomlkit.parse(study.text)["pin"][name]
    written = [
        *((1.0, here[at]) for part in _plain(table.get("profile", []))
          for here, at in _numbers(part, "diameter")),
        *((2.0, value_of(corner)[1]) for corner in _plain(table.get("meridian", []))),
    ]  # fmt: skip
    for times, old in ((times, value_of(old)) for times, old in written):
        if math.isclose(times * to_si(old, "length", study.system), diameter, rel_tol=1e-9):
            return unit_of(old, "length", study.system)[1]
    return study.system.factor("length")


def unit_of(old: Any, dimension: str, system: UnitSystem) -> tuple[str, float]:
    """Return the unit in which a value is written, as text, and the SI value of the unit."""
    text = LEADING_NUMBER_PATTERN.sub("", old, count=1) if isinstance(old, str) else ""
    return text, to_si(f"1{text}", dimension, system) if text.strip() else system.factor(dimension)


def replace_number(table: Any, key: Any, number: float, unit: str) -> None:
    """Write a new number in the same unit; a provenance, if any, is replaced by this program."""
    old = value_of(table[key])
    new = f"{number:.12g}{unit}" if isinstance(old, str) else number
    if (isinstance(table, dict) and "provenance" in table) or isinstance(table[key], dict):
        note = f"by pinstress size, from {old}"
        sourced = tomlkit.inline_table()
        sourced.update({"value": new, "provenance": "derived", "note": note})
        table[key] = sourced
    else:
        table[key] = new


def rounded(number: float, step: float | None, up: int) -> float:
    if number == 0.0:
        return 0.0
    size = abs(number)
    step = step or 10.0 ** (math.floor(math.log10(size)) + 1 - LENGTH_DIGITS)
    count = size / step
    # A value that is a whole number of steps except for round-off does not change.
    whole = math.ceil(count - 1e-9) if up > 0 else math.floor(count + 1e-9)
    return math.copysign(float(f"{whole * step:.12g}"), number)

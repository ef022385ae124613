"""The content of a study with its tables in SI units, and all its errors at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from loads import TableError, table_cases
from loads.landing import GROUND_RULES
from pinbase.keys import key_part
from pinstress.study.reading.case_tables import layout_of
from pinstress.study.reading.damage import Damage, place_of
from pinstress.study.reading.errors import InputError, Wrong
from pinstress.study.reading.limits import too_many
from pinstress.study.reading.references import cross_references
from pinstress.study.reading.validation import remove_wrong
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.landing import GroundCase, Side
from pinstress.study.schema.shown import nearest
from pinstress.study.schema.tables import AnyCase, StudyTable
from pinstress.study.schema.types import ANY_CASE, usable_name
from pinstress.study.schema.units import UNIT_SYSTEMS, UnitSystem

MAX_READINGS = 50  # of a study with errors; each reading removes wrong parts


def system_of(raw: Mapping[str, Any]) -> UnitSystem:
    """Return the unit system that a study names, or SI."""
    units = raw.get("units")
    return UNIT_SYSTEMS.get(units if isinstance(units, str) else "", UNIT_SYSTEMS["m-N-s"])


def table_of(
    path: Path, raw: Mapping[str, Any], damage: Damage, wrong: list[Wrong]
) -> StudyTable | None:
    """Return the valid content of a study in SI units, or None if it cannot be found.

    damage: receives the wrong parts.
    wrong: earlier errors, to which errors of content and references are added.

    Raises: InputError for an unusable table of cases.
    """
    tree = raw
    counted = False
    for _ in range(MAX_READINGS):
        removed = len(damage.places)
        try:
            table = StudyTable.model_validate(tree, context={"system": system_of(tree)})
        except ValidationError as error:
            wrong += remove_wrong(error, tree, damage)
        else:
            table, sections = _expanded(table, path.parent, wrong)
            if not counted:
                wrong += [Wrong(text, code="too-large") for text in too_many(table)]
                counted = True
            references = _of_sections(cross_references(table), sections)
            wrong += _remove_references(references, tree, damage)
            if len(damage.places) == removed:
                return table if not references else None
        if len(damage.places) == removed:
            return None
        tree = damage.remainder()
    return None


def _remove_references(references: list[Wrong], tree: Any, damage: Damage) -> list[Wrong]:
    """Remove references to things that do not exist, and return the errors that do not follow from
    earlier removals.

    tree: the remainder of the study.
    """
    places = [place_of(tree, wrong.at or wrong.message) for wrong in references]
    originals = [damage.original(place) for place in places]
    errors = [
        replace(damage.renumbered(wrong, place), hint=partial(_hint, wrong, set(damage.names)))
        for wrong, place, original in zip(references, places, originals, strict=True)
        if not damage.explains(wrong, original)
    ]
    for wrong, place in zip(references, originals, strict=True):
        some = next(iter(tree.get("material", ())), None)
        drive = ("mechanism", "drive")  # removed as a whole, since its keys determine its kind
        damage.remove(
            drive if place[:2] == drive else place,
            some if wrong.code == "unknown-material" else None,
        )
    return errors


def _hint(wrong: Wrong, removed: set[str]) -> str:
    """Return the hint of an error, which may also suggest a name that was removed for another
    error.
    """
    hint = wrong.hint()
    if not wrong.name or hint.startswith("did") or not removed:
        return hint
    name = nearest(wrong.name, sorted(removed))
    return f"did you mean {name!r}?" if name else hint


def _expanded(
    table: StudyTable, folder: Path, wrong: list[Wrong]
) -> tuple[StudyTable, dict[str, str]]:
    """Return the study with the cases of sections whose name has a *, and the section of each such
    case.

    A section of kind "given" yields a case for every name in the column `case` of its table, a
    section of kind "ground" a case for every load. That name replaces the *.

    folder: of the tables.
    wrong: receives the errors.

    Raises: InputError for an unusable table.
    """
    cases = {name: case for name, case in table.case.items() if ANY_CASE not in name}
    if len(cases) == len(table.case):
        return table, {}
    sections: dict[str, str] = {}
    for section, case in table.case.items():
        if ANY_CASE not in section:
            continue
        key = f"case.{key_part(section)}"
        if section.count(ANY_CASE) > 1:
            wrong.append(Wrong(f"{key}: a name needs no second *", code="unusable-name"))
            continue
        for name, one in _cases_of(key, case, folder, wrong):
            full = section.replace(ANY_CASE, name)
            wrong += _name_mistakes(key, full, full in cases)
            cases[full], sections[full] = one, section
    return table.model_copy(update={"case": cases}), sections


def _cases_of(
    key: str, case: AnyCase, folder: Path, wrong: list[Wrong]
) -> Iterator[tuple[str, AnyCase]]:
    """Yield the cases of a section, each with the text that replaces the * in its name."""
    if isinstance(case, GroundCase):
        yield from ground_cases(case)
        return
    assert isinstance(case, GivenCase)
    if case.table_case is not None:
        text = f"{key}.table_case: the name with a * already stands for every case of the table"
        wrong.append(Wrong(text, code="give-one"))
        return
    for name in _table_case_names(folder / case.tables[0].file, case):
        yield name, case.model_copy(update={"table_case": name})


def _table_case_names(path: Path, case: GivenCase) -> list[str]:
    try:
        return table_cases(path, layout_of(case, case.tables[0], ""))
    except TableError as error:
        raise InputError(str(error), code=error.code) from None


def _name_mistakes(key: str, name: str, known: bool) -> Iterator[Wrong]:
    if known:
        text = f"{key}: case {name!r} exists already; rename one, or this section"
        yield Wrong(text, code="duplicate-case")
    try:
        usable_name(name)
    except ValueError as error:
        yield Wrong(f"{key}: case {name!r}: {error}", code=getattr(error, "code", ""))


def _of_sections(references: Iterable[Wrong], sections: Mapping[str, str]) -> list[Wrong]:
    """Return errors of cases that come from a section as errors of the section, each once."""
    named: dict[str, Wrong] = {}
    for wrong in references:
        for name, section in sections.items():
            here = f"case.{key_part(name)}"
            if wrong.message.startswith((f"{here}.", f"{here}:")):
                message = f"case.{key_part(section)}{wrong.message.removeprefix(here)}"
                wrong = replace(wrong, message=message)
                break
        named.setdefault(wrong.message, wrong)
    return list(named.values())


def ground_cases(case: GroundCase) -> Iterator[tuple[str, GroundCase]]:
    """Yield the single cases of a section with their names.

    A side load yields two cases, one towards each side, unless `toward` states the side.
    """
    sides: tuple[Side, Side] = (
        ("left", "right") if case.stands == "nose" else ("inboard", "outboard")
    )
    for rule in case.rules:
        one = case.model_copy(update={"part": None, "rule": rule, "factors": []})
        yield from _to_sides(rule, one, GROUND_RULES[rule].side, sides)
    for row in case.factors:
        update = {"part": None, "factors": [row], "toward": row.toward or case.toward}
        yield from _to_sides(row.name, case.model_copy(update=update), row.side, sides)


def _to_sides(
    name: str, case: GroundCase, side: float, sides: tuple[Side, Side]
) -> Iterator[tuple[str, GroundCase]]:
    if not side or case.toward is not None:
        yield name, case
        return
    for toward in sides:
        yield f"{name}-{toward}", case.model_copy(update={"toward": toward})

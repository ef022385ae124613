"""Many cases in one section: [case."*"] stands for every case that its table names."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from loads import TableError, table_cases
from pinstress.study.reading.errors import InputError, Wrong
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.types import ANY_CASE, usable_name


def with_cases_of_tables(table: StudyTable, folder: Path, wrong: list[Wrong]) -> StudyTable:
    """The study with a case for every name in the column `case` of the table of a section whose
    name has a *, which that name replaces. folder: of the tables. wrong: where errors go.

    Raises: InputError for an unusable table.
    """
    if not any(ANY_CASE in name for name in table.case):
        return table
    cases = {name: case for name, case in table.case.items() if ANY_CASE not in name}
    for section, case in table.case.items():
        if ANY_CASE not in section:
            continue
        key = f"case.{section}"
        assert isinstance(case, GivenCase)
        assert case.table is not None
        if section.count(ANY_CASE) > 1:
            wrong.append(Wrong(f"{key}: a name needs no second *", code="unusable-name"))
        elif case.table_case is not None:
            text = f"{key}.table_case: the name with a * already stands for every case of the table"
            wrong.append(Wrong(text, code="give-one"))
        else:
            for name in _names(folder / case.table, case):
                ours = section.replace(ANY_CASE, name)
                wrong += _mistakes(key, ours, case.table, ours in cases)
                cases[ours] = case.model_copy(update={"table_case": name})
    return table.model_copy(update={"case": cases})


def _names(path: Path, case: GivenCase) -> list[str]:
    try:
        return table_cases(path, case.columns)
    except TableError as error:
        raise InputError(str(error), code=error.code) from None


def _mistakes(key: str, name: str, table: str, known: bool) -> Iterator[Wrong]:
    if known:
        text = f"{key}: case {name!r} of {table} exists already; rename one, or this section"
        yield Wrong(text, code="duplicate-case")
    try:
        usable_name(name)
    except ValueError as error:
        yield Wrong(f"{key}: case {name!r} of {table}: {error}", code=getattr(error, "code", ""))

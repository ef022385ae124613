"""Requirements with what was reached, as a table."""

from __future__ import annotations

from reports.data.requirements import RequirementRow, requirement_rows
from reports.data.results import Results
from reports.format.numbers import DASH, short
from reports.format.ranges import factor_text
from reports.tables.column import Column, Table, fields, texts

COLUMNS: list[Column[RequirementRow]] = [
    *texts("pin"),
    Column("case", lambda row: row.case, "", "case", lambda row: row.case or DASH, numeric=False),
    *fields("level"),
    Column("check", lambda row: row.check, "", "requirement", lambda row: row.title, numeric=False),
    Column("required", lambda row: row.required, "", "required", lambda row: short(row.required)),
    Column("reached", lambda row: row.reached, "", "reached",
           lambda row: factor_text(row.reached, row.required, 4)),
    *texts("outcome"),
    Column("needs", lambda row: row.needs, "", "needs", numeric=False, rank=1, drop_if_empty=True),
    *fields("stated over"),
]  # fmt: skip


def requirements_table(results: Results) -> Table[RequirementRow]:
    """Return a row for every requirement on a pin in a case, with all digits."""
    return Table("requirements", COLUMNS, requirement_rows(results))

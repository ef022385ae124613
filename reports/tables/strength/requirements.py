"""Requirements with what was reached, as a table."""

from __future__ import annotations

from reports.data.requirements import RequirementRow, requirement_rows
from reports.data.results import Results
from reports.format.numbers import short
from reports.format.ranges import factor_text
from reports.tables.column import Column, Table, fields, headed, or_dash, texts

COLUMNS: list[Column[RequirementRow]] = [
    *texts("pin"),
    *texts("case", show=or_dash),
    *fields("level"),
    Column("check", lambda row: row.check, "", "requirement", lambda row: row.title, numeric=False),
    *headed("required", show=short),
    *headed("reached", text=lambda row: factor_text(row.reached, row.required, 4)),
    *texts("outcome"),
    *texts("needs", rank=1, drop_if_empty=True),
    *fields("stated over"),
]


def requirements_table(results: Results) -> Table[RequirementRow]:
    """Return a row for every requirement on a pin in a case, with all digits."""
    return Table("requirements", COLUMNS, requirement_rows(results))

"""The line that JUnit XML has of a requirement."""

from __future__ import annotations

from reports.data.requirements import RequirementRow
from reports.junit import message


def test_a_result_that_depends_says_on_what() -> None:
    """As it is otherwise reached: a factor above the required one would look like no failure."""
    row = RequirementRow("P", "pull", "limit", "shear", 9.0, 9.5, "depends", over="joint")
    assert message(row) == (
        "depends: shear at limit load, factor 9.50, 9 required; "
        "not reached over what is open: joint"
    )

"""The sentence on the largest force of all cases."""

from __future__ import annotations

from dataclasses import replace

from reports.page.loads import largest_force
from tests.support.each import each
from tests.support.results.made_up_run import make_results, static


@each("more", [1.0, 1.0 + 1e-15, 1.0 - 1e-15])
def test_of_equal_forces_the_first_case_is_named_in_any_units(more: float) -> None:
    """Two cases with the same position, whose forces differ by the round-off of a unit."""
    first = static()
    second = replace(first, case="the same", forces=first.forces * more)
    found = largest_force(replace(make_results(), reactions=(first, second)))
    assert ", in landing" in found

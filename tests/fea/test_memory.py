"""The estimate of memory beside what was measured, and what is done with it."""

from __future__ import annotations

import pytest

from fea.linear import SolveError
from fea.memory import allowed_memory, free_memory, require_memory, solid_memory


@pytest.mark.parametrize(
    ("unknowns", "measured"),
    [(28_509, 212), (58_000, 396), (61_263, 369), (114_552, 791), (128_000, 964), (415_000, 5054)],
)
def test_it_is_near_what_was_measured(unknowns: int, measured: float) -> None:
    assert 0.95 * measured < solid_memory(unknowns) < 1.4 * measured


def test_there_is_memory_and_most_of_it_is_allowed() -> None:
    assert 100.0 < free_memory() < 1e8
    assert 0.0 < allowed_memory(None) < 1e8
    assert allowed_memory(12.0) == 12.0


def test_too_large_a_solid_is_refused() -> None:
    require_memory("P", 1000, 10.0)
    with pytest.raises(SolveError, match=r"pin P: 4,000,000 unknowns would take about 98 GB"):
        require_memory("P", 4_000_000, 1000.0)

"""A memory of values by their content: bounded, and without an effect on what is answered."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest

from pinbase.memo import Memo, size_of


@dataclass(frozen=True)
class Table:
    """Values of which others are derived."""

    values: np.ndarray

    @cached_property
    def twice(self) -> np.ndarray:
        """Twice the values."""
        return 2.0 * self.values


def zeros(count: int) -> np.ndarray:
    return np.zeros(count)


def test_what_was_not_asked_for_longest_goes_first() -> None:
    memo = Memo(3 * zeros(10).nbytes)
    for key in "abc":
        memo.get(key, lambda: zeros(10))
    memo.get("a", lambda: zeros(10))
    assert memo.made == 3
    memo.get("d", lambda: zeros(10))
    assert [memo.read(key) is None for key in "abcd"] == [False, True, False, False]


def test_the_latest_value_is_kept_however_large() -> None:
    memo = Memo(1)
    large = memo.get("large", lambda: zeros(1000))
    assert memo.read("large") is large
    memo.get("other", lambda: zeros(10))
    assert memo.read("large") is None


def test_a_value_that_could_not_be_made_is_not_remembered() -> None:
    memo = Memo()

    def fails() -> int:
        raise ArithmeticError

    with pytest.raises(ArithmeticError):
        memo.get("key", fails)
    assert memo.get("key", lambda: 1) == 1


def test_what_a_value_derives_later_counts() -> None:
    memo = Memo(3 * zeros(100).nbytes)
    memo.get("first", lambda: zeros(100))
    table = memo.get("table", lambda: Table(zeros(100)))
    assert table.twice.nbytes == zeros(100).nbytes
    memo.get("second", lambda: zeros(100))
    assert [memo.read(key) is None for key in ("first", "table", "second")] == [True, False, False]


def test_shared_arrays_count_once() -> None:
    one = zeros(100)
    assert size_of((one, [one], {"key": one})) == one.nbytes + len("key")

"""`tests.support.near`: small numbers are not all alike, and larger ones are compared as before."""

from __future__ import annotations

import numpy as np
import pytest


def test_small_numbers_differ() -> None:
    """They were equal to the 1e-12 of pytest."""
    assert pytest.approx(1e-13, rel=1e-3) == 1.0005e-13
    assert pytest.approx(1e-13, rel=1e-3) != 2e-13
    assert np.array([1e-13, 0.0]) != pytest.approx(np.array([2e-13, 0.0]), rel=1e-3)
    assert pytest.approx({"a": 1e-13}) != {"a": 2e-13}
    assert pytest.approx([1e-13, 0.0]) == [1e-13, 1e-30]  # round-off of the largest


def test_others_are_compared_as_pytest_does() -> None:
    assert pytest.approx(0.0) == 1e-13
    assert pytest.approx([1e7, 0.0]) == [1e7, 1e-13]
    assert pytest.approx(1.0) == 1.0 + 1e-7
    assert pytest.approx(1.0) != 1.0 + 1e-5
    assert pytest.approx(1.0, abs=0.2) == 1.1
    assert pytest.approx("text") == "text"
    assert [1.0, float("inf")] == pytest.approx([1.0, float("inf")])
    assert pytest.approx({"a": None, "b": 1.0}) == {"a": None, "b": 1.0}

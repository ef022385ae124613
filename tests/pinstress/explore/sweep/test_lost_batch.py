"""A batch whose worker dies just as its result is fetched: it is solved again."""

from __future__ import annotations

from typing import Any

import pytest

from pinstress.explore.sweep.scheduler import _outcome
from pinstress.study.reading.errors import InputError


class Batch:
    """A future of a status that another thread has changed since it was looked at."""

    def __init__(self, status: str) -> None:
        self.status = status


class Lost:
    """A cluster that is asked for nothing but the error that it is lost."""

    def lost(self) -> InputError:
        return InputError("lost", code="lost")


def outcome(status: str) -> Any:
    return _outcome(Lost(), Batch(status))  # type: ignore[arg-type]


@pytest.mark.parametrize("status", ["lost", "pending"])
def test_a_batch_lost_with_its_worker_waits(status: str) -> None:
    assert outcome(status) is None


def test_a_batch_that_is_cancelled_has_lost_its_scheduler() -> None:
    with pytest.raises(InputError, match="lost"):
        outcome("cancelled")

"""The processor time that a limit load may take if the user has not requested it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field


class OutOfTimeError(Exception):
    """The error that the budget is spent, or that the next step would exceed it."""


@dataclass(frozen=True)
class Budget:
    """A budget of processor time.

    seconds: processor time that this thread may take after `begin`, which is the time of
    construction by default.
    """

    seconds: float = math.inf
    begin: float = field(default_factory=lambda: time.thread_time())

    @property
    def spent(self) -> float:
        """Processor time since `begin`, s."""
        return time.thread_time() - self.begin

    def require(self, more: float = 0.0) -> None:
        """Check that the budget has at least `more` seconds left.

        Raises: OutOfTimeError.
        """
        if not self.spent + more <= self.seconds:
            raise OutOfTimeError

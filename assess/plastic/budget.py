"""The processor time that a limit load may take when nobody has asked for it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field


class OutOfTimeError(Exception):
    """The budget is spent, or what comes next would exceed it."""


@dataclass(frozen=True)
class Budget:
    """Processor time that may be spent.

    seconds: of this thread from `begin` on, which is the moment of construction.
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

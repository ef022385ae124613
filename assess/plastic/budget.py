"""How much processor time a limit load may take that nobody has asked for."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field


class OutOfTimeError(Exception):
    """The budget is spent, or what comes next would exceed it."""


@dataclass(frozen=True)
class Budget:
    """seconds: of processor time of this thread from `begin` on, which is when it is made."""

    seconds: float = math.inf
    begin: float = field(default_factory=lambda: time.thread_time())

    @property
    def spent(self) -> float:
        """s."""
        return time.thread_time() - self.begin

    def require(self, more: float = 0.0) -> None:
        """Raises: OutOfTimeError where so many seconds are not left."""
        if not self.spent + more <= self.seconds:
            raise OutOfTimeError

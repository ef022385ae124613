"""Plots still to be drawn, so that they can be distributed over processes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

Plot = Callable[[], list[Path]]
Draw = Callable[[Sequence[Plot]], list[Path]]


def in_turn(plots: Sequence[Plot]) -> list[Path]:
    """Draw plots one after another; their files."""
    return [path for plot in plots for path in plot()]

"""Rows for labels that would overlap."""

from __future__ import annotations

from collections.abc import Sequence


def rows(places: Sequence[float], sizes: Sequence[float]) -> list[int]:
    """Return the lowest row for each label such that no two labels of a row overlap."""
    ends: list[float] = []
    row_indices = []
    for place, size in zip(places, sizes, strict=True):
        free = [r for r, end in enumerate(ends) if end <= place - 0.5 * size]
        row = free[0] if free else len(ends)
        if row == len(ends):
            ends.append(0.0)
        ends[row] = place + 0.5 * size
        row_indices.append(row)
    return row_indices

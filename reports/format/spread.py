"""Positions along a line for labels that would overlap."""

from __future__ import annotations

from collections.abc import Sequence


def spread(wanted: Sequence[float], sizes: Sequence[float]) -> list[float]:
    """Centres for labels of `sizes`, in the order of `wanted`, near them and without overlap.

    Labels that would overlap form a block, centred on the mean of what its labels want.
    """
    order = sorted(range(len(wanted)), key=lambda i: wanted[i])
    blocks: list[list[int]] = []
    for i in order:
        blocks.append([i])
        while len(blocks) > 1 and _top(blocks[-2], wanted, sizes) > _foot(
            blocks[-1], wanted, sizes
        ):
            last = blocks.pop()
            blocks[-1] += last
    places = [0.0] * len(wanted)
    for block in blocks:
        foot = _foot(block, wanted, sizes)
        for i in block:
            places[i] = foot + 0.5 * sizes[i]
            foot += sizes[i]
    return places


def rows(places: Sequence[float], sizes: Sequence[float]) -> list[int]:
    """The lowest row for each label such that none overlaps another of its row."""
    ends: list[float] = []
    found = []
    for place, size in zip(places, sizes, strict=True):
        free = [r for r, end in enumerate(ends) if end <= place - 0.5 * size]
        row = free[0] if free else len(ends)
        if row == len(ends):
            ends.append(0.0)
        ends[row] = place + 0.5 * size
        found.append(row)
    return found


def _middle(block: list[int], wanted: Sequence[float]) -> float:
    return sum(wanted[i] for i in block) / len(block)


def _foot(block: list[int], wanted: Sequence[float], sizes: Sequence[float]) -> float:
    return _middle(block, wanted) - 0.5 * sum(sizes[i] for i in block)


def _top(block: list[int], wanted: Sequence[float], sizes: Sequence[float]) -> float:
    return _middle(block, wanted) + 0.5 * sum(sizes[i] for i in block)

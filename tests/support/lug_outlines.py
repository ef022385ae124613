"""Outlines of lugs by the few dimensions that tests vary, m."""

from geometry.shape.lug_outline import LugOutline


def round_lug(bore: float, head: float) -> LugOutline:
    """A head about its bore with a shank as wide and as long."""
    return LugOutline("round", bore, head, head, head, head / 2.0)


def square_lug(bore: float, width: float, end: float) -> LugOutline:
    """A strip with a square end."""
    return LugOutline("square", bore, 0.0, width, width, end)

"""Outlines of lugs from the few dimensions that tests vary, m."""

from geometry.shape.lug_outline import LugOutline


def round_lug(bore: float, head: float) -> LugOutline:
    """Return a lug with a round head about its bore, and a shank as wide and as long as
    the head.
    """
    return LugOutline("round", bore, head, head, head, head / 2.0)


def square_lug(bore: float, width: float, end: float) -> LugOutline:
    """Return a strip with a square end."""
    return LugOutline("square", bore, 0.0, width, width, end)

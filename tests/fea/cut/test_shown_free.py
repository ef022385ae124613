"""The surface of a pin with cuts where lugs press on it."""

from __future__ import annotations

import numpy as np

from fea.core.pressed import ARC_COUNT, PressedArcs, Rings
from fea.cut.shown import ShownCut
from fea.cut.shown_free import free_picture


def test_an_envelope_of_unit_loads_that_cancel_is_zero() -> None:
    """Squares of von Mises stress are below zero by round-off there: the envelope was NaN."""
    rng = np.random.default_rng(1)
    one, count = rng.normal(size=(200, 6)), 200
    mask = np.ones(count, dtype=bool)
    points = np.column_stack([rng.uniform(-1.0, 1.0, (count, 2)), np.full(count, 9.0)])
    stress = np.stack([one, one / 3.0], axis=2)
    cut = ShownCut(points, np.zeros((0, 3), dtype=np.int64), stress, points[..., None], mask, mask)
    zero, one_metre = np.zeros(1), np.ones(1)
    rings = Rings(zero, one_metre, one_metre, np.array([0]), np.array([False]), zero)
    pressed = PressedArcs(rings, np.zeros((1, 1, ARC_COUNT), dtype=bool), 10)
    _, envelope, on = free_picture(cut, np.array([[1.0, -3.0]]), pressed, 0)
    assert not on.any()
    assert np.abs(envelope).max() < 1e-6

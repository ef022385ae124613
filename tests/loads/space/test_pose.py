"""Euler parameters of any length: rotations, and angular velocities by differences of these."""

from __future__ import annotations

import numpy as np
import pytest

from loads.space.pose import rotations, turning
from tests.support.each import each

STEP = 1e-6


@each("shape", [(), (3,), (3, 2), (2, 3, 2)])
def test_angular_velocities_are_those_of_the_rotations(shape: tuple[int, ...]) -> None:
    """R' R^T is antisymmetric, with the angular velocity; for one body at one instant as for all.
    Rates along the parameters turn nothing.
    """
    p, rate = np.random.default_rng(2).standard_normal((2, *shape, 4))
    R = rotations(p)
    assert np.swapaxes(R, -1, -2) @ R == pytest.approx(np.broadcast_to(np.eye(3), R.shape))
    spin = (rotations(p + STEP * rate) - rotations(p - STEP * rate)) / (2.0 * STEP)
    spin = spin @ np.swapaxes(R, -1, -2)
    expected = np.stack([spin[..., 2, 1], spin[..., 0, 2], spin[..., 1, 0]], axis=-1)
    found = (turning(p) @ rate[..., None])[..., 0]
    assert turning(p).shape == (*shape, 3, 4)
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-8)
    assert (turning(p) @ p[..., None]) == pytest.approx(np.zeros((*shape, 3, 1)), abs=1e-12)

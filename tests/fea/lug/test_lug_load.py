"""The load of a joint on a lug: how rings share it, and single instants of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.lug.lug_load import LugLoad
from tests.support.each import each

LENGTH = np.array([0.002, 0.003, 0.005])
ALONG, ACROSS = (np.array(x) for x in ((0.6, -0.8), (0.8, 0.6)))


def load(scale: float) -> LugLoad:
    """Two instants; rings of 2, 3 and 5 mm have 1, 2 and -0.5 times a pressure, and across it 3, -2
    and 0, which have no resultant. At a third nothing is pressed.
    """
    first = np.outer([1.0, 2.0, -0.5], ALONG) + np.outer([3.0, -2.0, 0.0], ACROSS)
    pressure = np.zeros((2, 3, 3, 2))
    pressure[1] = scale * np.array([1.0, 3.0, 0.0])[:, None, None] * first
    force = math.pi * 0.01 * np.einsum("trp,r->tp", pressure[1], LENGTH)
    return LugLoad(force, pressure, LENGTH, np.array([0.1, 0.2, 0.3]), np.array([0.0, 1.0, 2.0]))


@each("scale", [1e-9, 1.0, 1e9])
def test_shares_are_loads_per_length_over_their_mean(scale: float) -> None:
    """The mean is (2 + 6 - 2.5) / 10 = 0.55, at any pressure; a ring that pulls back has no share,
    and without a force all are alike.
    """
    shares = load(scale).shares
    assert shares[:2] == pytest.approx(np.tile([1.0 / 0.55, 2.0 / 0.55, 0.0], (2, 1)))
    assert shares[2] == pytest.approx(np.ones(3))


def test_an_instant_is_one() -> None:
    given = load(1e6)
    for t in range(3):
        one = given.at(t)
        assert (one.force.shape, one.pressure.shape) == ((1, 2), (2, 1, 3, 2))
        assert one.force[0] == pytest.approx(given.force[t])
        assert one.first[0] == pytest.approx(given.first[t])
        assert one.angle.tolist() == [given.angle[t]]
        assert one.times is not None
        assert one.times.tolist() == [float(t)]

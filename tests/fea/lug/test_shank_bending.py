"""What the shank of a lug that bends out of its plane adds to the stress beside its bore."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.lug.lug_load import LugLoad
from fea.lug.shank_bending import SHARE, bent
from geometry.shape.lug_outline import LugOutline

RADIUS, THICK, COUNT = 0.01, 0.01, 10
OUTLINE = LugOutline("round", 2.0 * RADIUS, 0.05, 0.05, 0.1, 0.025)
LENGTH = np.full(COUNT, THICK / COUNT)


def load(angle: float, force: tuple[float, float], shank: float = 0.0) -> LugLoad:
    """A force per length, N/m, that is larger towards the end of the band; shank: its angle."""
    z = (np.arange(COUNT) + 0.5) / COUNT - 0.5
    pressure = np.zeros((2, 1, COUNT, 2))
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    pressure[1, 0] = np.outer(1.0 + z, np.array(force) @ turn) / (math.pi * RADIUS)
    total = math.pi * RADIUS * np.einsum("trp,r->tp", pressure[1], LENGTH)
    return LugLoad(total, pressure, LENGTH, np.array([shank]))


def test_a_pulled_shank_is_bent_by_the_couple_of_the_pressure() -> None:
    """The nominal stress of the net section, 30 x 10 mm, by the couple; at 82 degrees."""
    given = load(0.0, (-1e6, 0.0))
    couple = 1e6 * float((((np.arange(COUNT) + 0.5) / COUNT - 0.5) ** 2).sum()) * THICK**2 / COUNT
    assert given.couple(RADIUS) == pytest.approx([-couple])
    angles = np.radians([82.0, -82.0, 0.0, 180.0, 90.0])
    stress = bent(OUTLINE, given, angles)[0]
    nominal = couple * 0.45 * THICK / (0.03 * THICK**3 / 12.0)
    assert stress[-1, :2] == pytest.approx(SHARE * nominal * np.ones(2))
    assert stress[0] == pytest.approx(-stress[-1])
    assert stress[-1, 2] == pytest.approx(SHARE * nominal * math.cos(math.radians(82.0)) ** 2)
    assert stress[-1, 3] == 0.0
    assert 0.9 * stress[-1, 0] < stress[-1, 4] < stress[-1, 0]


def test_a_pressed_shank_adds_nothing_and_one_across_none() -> None:
    angles = np.radians([82.0, 90.0])
    assert not bent(OUTLINE, load(0.0, (1e6, 0.0)), angles).any()
    assert bent(OUTLINE, load(0.0, (0.0, 1e6)), angles) == pytest.approx(np.zeros((1, COUNT, 2)))
    assert not bent(OUTLINE, load(0.0, (0.0, 0.0)), angles).any()


def test_it_turns_with_the_shank() -> None:
    angles = np.radians([70.0, 100.0])
    straight = bent(OUTLINE, load(0.0, (-1e6, 2e5)), angles)
    turned = bent(OUTLINE, load(0.7, (-1e6, 2e5), shank=0.7), angles)
    assert turned == pytest.approx(straight)


def test_what_is_added_is_proportional_to_the_load() -> None:
    """A force of millinewtons as of meganewtons."""
    angles = np.radians([82.0, 100.0])
    small = bent(OUTLINE, load(0.0, (-1e-3, 0.0)), angles)
    assert 1e9 * small == pytest.approx(bent(OUTLINE, load(0.0, (-1e6, 0.0)), angles))


def test_a_couple_without_a_force_pulls_no_shank() -> None:
    """Which lug is pulled decides who carries the couple; here the eye as a body has it all."""
    given = load(0.0, (-1e6, 0.0))
    even = given.pressure - given.pressure.mean(axis=2, keepdims=True)
    alone = replace(given, force=np.zeros((1, 2)), pressure=even)
    assert alone.couple(RADIUS) == pytest.approx(given.couple(RADIUS))
    assert not bent(OUTLINE, alone, np.radians([82.0, 90.0])).any()

"""Quantities on which a force can depend, as time, a slider's or turn's position, or a distance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

from loads.linkage.parts import Point, Slider, Turn
from loads.motion.complex_points import number
from loads.motion.motion import Instants, Motion
from pinbase.arrays import Floats

AnyMotion = TypeVar("AnyMotion", contravariant=True)  # a Motion or SpaceMotion


class Measure(Protocol[AnyMotion]):
    """A quantity of a motion: a call returns value and rate at every instant, (T,) each, in SI."""

    def __call__(self, motion: AnyMotion) -> tuple[Floats, Floats]: ...


@dataclass(frozen=True)
class Clock:
    """Time, s."""

    def __call__(self, motion: Instants[Any]) -> tuple[Floats, Floats]:
        """Values and rates."""
        return motion.times, np.ones(len(motion))


@dataclass(frozen=True)
class Position:
    """Length (m) of a slider, or angle (rad) of a turn."""

    of: Slider | Turn

    def __call__(self, motion: Motion) -> tuple[Floats, Floats]:
        """Values and rates."""
        value, rate, _ = motion.coordinate(self.of)
        return value, rate


@dataclass(frozen=True)
class Distance:
    """Distance between two points, each of an item or the ground, m.

    points: the two points as drawn, m.
    """

    items: tuple[str, str]
    points: tuple[Point, Point]

    def line(self, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
        """Vector from the first point to the second, m, and its rate, m/s, (T,) complex each."""
        index = np.array([motion.linkage.index[item] for item in self.items])
        drawn = np.array([number(p) for p in self.points])
        place, velocity, _ = motion.follow(motion.loops.points(index, drawn))
        return place[:, 1] - place[:, 0], velocity[:, 1] - velocity[:, 0]

    def __call__(self, motion: Motion) -> tuple[Floats, Floats]:
        """Values and rates."""
        line, rate = self.line(motion)
        length = np.abs(line)
        return length, np.real(np.conj(line) * rate) / np.where(length > 0.0, length, 1.0)

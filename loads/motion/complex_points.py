"""Points of a planar linkage as complex numbers, at all instants at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.linkage.parts import Point
from pinbase.arrays import Complex, Floats, Ints


def number(point: Point) -> complex:
    """A point or vector as a complex number."""
    return complex(point[0], point[1])


def pairs(z: Complex) -> Floats:
    """Components x, y (..., 2) of complex numbers (...)."""
    return np.stack([z.real, z.imag], axis=-1)


def cross(a: Complex, b: Complex) -> Floats:
    """Cross product of complex vectors, such as the moment of forces b at arms a."""
    return np.asarray(a.real * b.imag - a.imag * b.real)


@dataclass(frozen=True)
class Points:
    """N points (or gaps of loops) as sums of vectors that rotate and slide.

    turning: (F, N) complex, m, the fixed vector A of every frame, in the formula of
    `loop_equations`.
    sliding: (S, N), the factor B of every slider, 0 or +-1 for a point.
    """

    turning: Complex
    sliding: Floats

    def __sub__(self, other: Points) -> Points:
        return Points(self.turning - other.turning, self.sliding - other.sliding)


@dataclass(frozen=True)
class Pose:
    """The position of a linkage at T instants.

    turn: (T, F) exp(i angle) of every frame, the ground's first.
    axis: (T, S) directions of the sliders, complex unit vectors.
    extension: (T, S) extensions of the sliders since the drawing, m.
    """

    turn: Complex
    axis: Complex
    extension: Floats

    def __getitem__(self, chosen: slice | Ints) -> Pose:
        return Pose(self.turn[chosen], self.axis[chosen], self.extension[chosen])


@dataclass(frozen=True)
class PointMotion:
    """A quantity of points at T instants (position, velocity, ...), linear in `Points`.

    turning: (T, F), factor of each frame's vector. sliding: (T, S), factor of each slider.
    """

    turning: Complex
    sliding: Complex

    def of(self, points: Points) -> Complex:
        """The quantity of N points, (T, N) complex."""
        return np.asarray(self.turning @ points.turning + self.sliding @ points.sliding)

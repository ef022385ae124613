"""The interface of solutions, which all models have in common."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from fea.core.pin_loads import Loads, PinLoads
from fea.core.unit_surface import SurfaceField
from pinbase.arrays import Floats, Ints, Mask

# A function that returns the stress (J, T, 6), Pa, at points (J,) rotated by angles (J,), rad, at
# instants (T,).
StressAt = Callable[[Ints, Floats, Ints], Floats]


@dataclass(frozen=True)
class Picture:
    """A mesh with results at its N nodes at one instant.

    points: (N, 3) m.
    cells: node numbers, (M, 10) in VTK's order of "tetra10", or (M, 4) for "quad".
    displacement: (N, 3) m.
    stress: xx, yy, zz, yz, xz, xy, (N, 6) Pa.
    envelope: largest von Mises stress over all instants, (N,) Pa; NaN inside the body.
    pressed: mask (N,) of the nodes on which lugs press; None without lugs. The envelope there is
    over the instants at which no lug presses, and NaN if a lug always presses.
    more: cells of other types, by type.
    """

    points: Floats
    cells: Ints
    cell_type: str
    displacement: Floats
    stress: Floats
    envelope: Floats
    pressed: Mask | None = None
    more: Mapping[str, Ints] = field(default_factory=dict)


@dataclass(frozen=True)
class StressPoints:
    """The points at which a model knows the stress, for fatigue.

    points: (S, 3) m; for a body of revolution at theta = 0.
    surface: mask (S,) of the points at which fatigue is checked: on the surface, outside zones of
    singularities.
    revolved: whether the body is one of revolution.
    count: number of instants.
    at: returns the stress at some of the points, by their numbers. Angles have no effect on bodies
    that are not of revolution.
    """

    points: Floats
    surface: Mask
    revolved: bool
    count: int
    at: StressAt

    @classmethod
    def in_space(
        cls, points: Floats, stress: Floats, surface: Mask, amounts: Floats
    ) -> StressPoints:
        """The points (S, 3) of a body that is not of revolution.

        stress: of L unit loads, (S, 6, L) Pa. amounts: of the unit loads, (T, L).
        """

        def at(rows: Ints, _: Floats, instants: Ints) -> Floats:
            return np.asarray((stress[rows] @ amounts[instants].T).swapaxes(1, 2))

        return cls(points, surface, False, len(amounts), at)

    @classmethod
    def on_meridian(cls, section: Floats, surface: Mask, count: int, at: StressAt) -> StressPoints:
        """The points of a body of revolution. section: r and z, (S, 2) m."""
        r, z = section.T
        return cls(np.stack([r, np.zeros_like(r), z], axis=1), surface, True, count, at)


class StressMaxima(Protocol):
    """The largest von Mises stress at a place of a pin under any amounts of the same unit loads."""

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest von Mises stress at each instant outside all zones of singularities, (T,) Pa.

        least: for instants at which the stress does not exceed this, Pa, any value up to it may be
        returned.
        """

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest of these over all instants, Pa, and the number of its instant."""


class StressField(StressMaxima, Protocol):
    """The stress that a model has computed for a whole pin."""

    def points(self, loads: PinLoads) -> StressPoints:
        """The stress tensors at points of the pin at all instants, for fatigue."""

    def surface(self) -> SurfaceField | None:
        """The surface for views, which superpose its unit fields; None for a model without
        fields.
        """

    def picture(self, loads: PinLoads, instant: int) -> Picture | None:
        """The pin at one instant, with its envelope over all instants; None for a model without
        fields.
        """

    def volume(self, loads: PinLoads, instant: int) -> Picture | None:
        """The body with its interior at one instant, without an envelope; None for solid models,
        whose picture includes the interior.
        """

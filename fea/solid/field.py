"""A solid pin on one mesh, and its stress under any combination of its unit loads."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.core.pin_loads import Loads, PinLoads
from fea.core.solution import Picture, StressPoints
from fea.core.unit_surface import SpaceSurface, UnitSurface
from fea.core.zone import Zone
from fea.solid.boundary import QUARTER_TRIANGLES
from fea.solid.model import UnitFields
from fea.solid.superposition import envelope
from pinbase.arrays import Floats, Ints, Mask

# Most nodes of a surface of quadratic triangles whose middle nodes are shown, too.
MAX_SHOWN_NODES = 6000


@dataclass(frozen=True)
class SolidSolution:
    """The unit fields on one mesh, and which of their points lie in each singularity.

    within: for each singularity, a mask of the points in its zone.
    varied: masks of the points that are in no zone if half, and if twice, the distance is excluded.
    """

    fields: UnitFields
    singularities: tuple[Zone, ...]
    within: tuple[Mask, ...]
    varied: tuple[Mask, ...]

    @property
    def outside(self) -> Mask:
        """A mask of the points that are in no singularity."""
        return in_none(self.within, len(self.fields.points))

    @cached_property
    def shown(self) -> tuple[Ints, Ints]:
        """The nodes (P,), sorted, and the plane triangles (M, 3) of the surface in views.

        On a fine mesh these are corner nodes alone.
        """
        surface = self.fields.surface
        corners = surface.corners
        if len(surface.nodes) > MAX_SHOWN_NODES:
            corners = corners[:, :3]
        elif corners.shape[1] == 6:
            corners = corners[:, QUARTER_TRIANGLES].reshape(-1, 3)
        return np.unique(corners), np.asarray(corners, dtype=np.int64)

    @cached_property
    def unit_surface(self) -> UnitSurface:
        """The surface for views."""
        fields, (nodes, triangles) = self.fields, self.shown
        return UnitSurface.in_space(
            fields.space.nodes[nodes],
            np.searchsorted(nodes, triangles),
            fields.stress[nodes],
            fields.displacement[nodes],
        )


def in_none(within: Iterable[Mask], count: int) -> Mask:
    """A mask of the `count` points that are in none of some masks."""
    return np.asarray(~np.any([np.zeros(count, dtype=bool), *within], axis=0))


class SolidField:
    """The stress of a solid under any combination of its unit loads (fea.core.solution)."""

    def __init__(self, solution: SolidSolution) -> None:
        self.solution = solution

    def maxima(self, loads: Loads, _: float = 0.0) -> Floats:
        """The largest von Mises stress (T,), Pa, at every instant outside the singularities."""
        return envelope(self.solution.fields, loads, self.solution.outside).maxima

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest von Mises stress over all instants, Pa, and the number of its instant."""
        top = envelope(self.solution.fields, loads, self.solution.outside)
        return top.maximum, top.instant

    def points(self, loads: PinLoads) -> StressPoints:
        """The stress at points of the surface, for fatigue."""
        fields, surface = self.solution.fields, self.solution.outside.copy()
        surface[len(fields.surface.nodes) :] = False
        return StressPoints.in_space(
            fields.points, fields.read, surface, fields.coefficients(loads)
        )

    def surface(self) -> SpaceSurface:
        """The surface for views."""
        fields, nodes = self.solution.fields, self.solution.fields.surface.nodes
        inside = ~self.solution.outside[: len(nodes)]
        excluded = inside[np.searchsorted(nodes, self.solution.shown[0])]
        return SpaceSurface(self.solution.unit_surface, excluded, fields.coefficients)

    def picture(self, loads: PinLoads, instant: int) -> Picture:
        """The body at one instant, with its envelope over all instants."""
        fields = self.solution.fields
        top = envelope(fields, loads)
        c = fields.coefficients(loads)[instant]
        over_all = np.full(len(fields.space.nodes), np.nan)
        over_all[fields.surface.nodes] = top.field
        return Picture(
            points=fields.space.nodes,
            cells=fields.space.elements,
            cell_type="tetra10" if fields.space.quadratic else "tetra",
            displacement=fields.displacement @ c,
            stress=fields.stress @ c,
            envelope=over_all,
        )

    def volume(self, loads: PinLoads, instant: int) -> None:
        """Return None, since the picture shows the whole body."""

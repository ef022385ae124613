"""Fields of the unit loads on a pin's surface, for views that superpose them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fea.core.pin_loads import PinLoads
from fea.core.pressed import ARC_COUNT
from fea.core.solution import StressField
from fea.harmonic.evaluate import HarmonicField
from fea.harmonic.five_numbers import EVEN_COUNT, VON_MISES_ROOT
from fea.singular.singularities import outside
from pinbase.arrays import Floats, Ints, Mask

if TYPE_CHECKING:
    from fea.solid.boundary import SurfaceMesh

MAX_SHOWN_NODES = 6000  # of a surface of quadratic triangles, to show their middle nodes, too
_EVEN_COMPONENTS = (True,) * EVEN_COUNT + (False,) * (5 - EVEN_COUNT) + (True, False, True)


@dataclass(frozen=True)
class UnitSurface:
    """The fields of K unit loads at P points of the surface.

    points: (P, 3) m; of a body of revolution those of its meridian at theta = 0, edge by edge in
    their order (the last of an edge is where the next begins), and `triangles` is empty.
    triangles: (M, 3) points of any other body.
    n: (K,) harmonics.
    stress: (P, 5, K) Pa, five numbers whose squares sum to von Mises squared.
    displacement: (P, 3, K) m along r, theta, z (x, y, z).

    Under a load of the amounts a, b (its two phases) a component that is `even` (of the eight,
    stress first) is at an angle theta a cos + b sin of n theta times the number here, any other a
    sin - b cos.

    Where K loads of a solid are of one phase each they have n = 0, are even, and b = 0.
    """

    points: Floats
    triangles: Ints
    n: Ints
    even: tuple[bool, ...]
    stress: Floats
    displacement: Floats

    @property
    def revolved(self) -> bool:
        """Whether the surface is the meridian of a body of revolution."""
        return not len(self.triangles)


def unit_surface(answer: StressField) -> UnitSurface | None:
    """The surface on the finest mesh; None for a model without fields."""
    if isinstance(answer, HarmonicField):
        fields = answer.fields
        r, z = fields.points[: fields.skin].T
        return UnitSurface(
            points=np.stack([r, 0.0 * r, z], axis=1),
            triangles=np.zeros((0, 3), dtype=np.int64),
            n=np.array([load.n for load in fields.loads], dtype=np.int64),
            even=_EVEN_COMPONENTS,
            stress=VON_MISES_ROOT @ fields.stress[: fields.skin],
            displacement=fields.displacement[: fields.skin],
        )
    # Models of other pins are imported where there are any.
    from fea.cut.evaluate import CutField
    from fea.solid.evaluate import SolidField

    if isinstance(answer, CutField):
        cut = answer.surface
        return UnitSurface(
            points=cut.points,
            triangles=cut.triangles,
            n=np.zeros(cut.stress.shape[2], dtype=np.int64),
            even=(True,) * 8,
            stress=VON_MISES_ROOT @ cut.stress,
            displacement=cut.displacement,
        )
    if isinstance(answer, SolidField):
        solid = answer.solution.fields
        nodes, triangles = _shown(solid.surface)
        return UnitSurface(
            points=solid.space.nodes[nodes],
            triangles=np.searchsorted(nodes, triangles),
            n=np.zeros(len(solid.loads), dtype=np.int64),
            even=(True,) * 8,
            stress=VON_MISES_ROOT @ solid.stress[nodes],
            displacement=solid.displacement[nodes],
        )
    return None


def amounts(answer: StressField, loads: PinLoads) -> Floats:
    """The amount of each unit load of the surface at each instant, by phase: (T, K, 2)."""
    if isinstance(answer, HarmonicField):
        acting = loads.coefficients()
        none = np.zeros((len(loads), 2))
        return np.stack([acting.get(load, none) for load in answer.fields.loads], axis=1)
    from fea.cut.evaluate import CutField
    from fea.solid.evaluate import SolidField

    assert isinstance(answer, SolidField | CutField)
    known = answer.solution.fields if isinstance(answer, SolidField) else answer
    one = known.coefficients(loads)
    return np.stack([one, np.zeros_like(one)], axis=2)


def excluded(answer: StressField) -> Mask:
    """A mask (P,) of the points of the surface in a singularity, where the maximum is not read."""
    if isinstance(answer, HarmonicField):
        return ~outside(answer.singularities, *answer.fields.points[: answer.fields.skin].T)
    from fea.cut.evaluate import CutField
    from fea.solid.evaluate import SolidField

    if isinstance(answer, CutField):
        return ~answer.surface.read
    assert isinstance(answer, SolidField)
    surface = answer.solution.fields.surface
    inside = ~answer.solution.outside[: len(surface.nodes)]
    return np.asarray(inside[np.searchsorted(surface.nodes, _shown(surface)[0])])


def largest_there(answer: StressField, loads: PinLoads, instant: int) -> Floats:
    """The von Mises stress (P,) Pa at the surface's points at an instant.

    On a meridian it is the largest about the axis where it is read (fea.harmonic.free_surface), 0
    where it is not.
    """
    if isinstance(answer, HarmonicField):
        skin = np.arange(answer.fields.skin)
        largest, _ = answer.reader(loads).round(skin, np.full(len(skin), instant))
        return largest
    from fea.cut.evaluate import CutField
    from fea.solid.evaluate import SolidField

    if isinstance(answer, CutField):
        stress = VON_MISES_ROOT @ answer.surface.stress
    else:
        assert isinstance(answer, SolidField)
        fields = answer.solution.fields
        stress = VON_MISES_ROOT @ fields.stress[_shown(fields.surface)[0]]
    return np.asarray(np.linalg.norm(stress @ amounts(answer, loads)[instant, :, 0], axis=1))


def largest_at(
    answer: StressField, loads: PinLoads, instant: int
) -> tuple[float, float, float] | None:
    """The location (x, y, z), m, of the largest stress that is read in a section at an instant.

    None for other models.
    """
    if not isinstance(answer, HarmonicField):
        return None
    around = answer.reader(loads.at(np.array([instant])))
    top = around.top(around.fields.outside(answer.singularities))
    r, z = (float(x) for x in around.fields.points[top.point])
    return r * math.cos(top.angle), r * math.sin(top.angle), z


def unread(answer: StressField, loads: PinLoads, points: Ints, angles: Floats) -> Mask | None:
    """A mask of the points (J,) of the surface that are not read, since lugs press on them or
    beside.

    It has the shape (T, J, A) for all instants and `angles` (A,), rad; None where no lugs press on
    a body of revolution.
    """
    if not isinstance(answer, HarmonicField) or loads.pressed is None:
        return None
    region = answer.reader(loads).region
    assert region is not None
    arcs = np.rint(np.degrees(angles) * ARC_COUNT / 360.0).astype(np.int64) % ARC_COUNT
    some = np.flatnonzero(region.masked(points))
    out = np.zeros((len(loads), len(points), len(angles)), dtype=bool)
    for t in range(len(loads)):
        out[t, some] = ~region.read(points[some], np.full(len(some), t))[:, arcs]
    return out


def _shown(surface: SurfaceMesh) -> tuple[Ints, Ints]:
    """The nodes (P,), sorted, and the plane triangles (M, 3) of a surface; of a fine mesh the
    corners alone.
    """
    from fea.solid.boundary import QUARTER_TRIANGLES

    corners = surface.corners
    if len(surface.nodes) > MAX_SHOWN_NODES:
        corners = corners[:, :3]
    elif corners.shape[1] == 6:
        corners = corners[:, QUARTER_TRIANGLES].reshape(-1, 3)
    return np.unique(corners), np.asarray(corners, dtype=np.int64)

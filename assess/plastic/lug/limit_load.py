"""The limit load of a lug in plane strain: the pin force per thickness at which the lug collapses.

The pin pulls along the shank. The lug is rigid-perfectly plastic with small displacements; the pin
is rigid and frictionless, fits the bore and may separate from it anywhere. Clearance has no effect,
because plastic flow closes it. Two cone programs on each of a few meshes give strict bounds of the
load for the meshed polygon (assess.plastic.lug.bounds). Each mesh is refined where the lug on the
previous mesh flows.

Plane stress is not offered: in plane stress a yielding bore carries at most 1.15 times yield on its
projected area, whatever the shape of the head. Metal that is constrained across its thickness
carries more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from assess.plastic.lug.bounds import lower_program, upper_program
from assess.plastic.lug.cone_program import ConeSolution, solve_cone_program
from assess.plastic.lug.mesh import PlaneMesh, SizeField, half_lug_mesh
from geometry import ArgumentError
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats

ForcePerLength = Annotated[float, "force per length"]

FIRST_SIZE = 0.08  # size of the triangles at the bore on the first mesh, in radii
TRIANGLE_COUNTS = 1200, 2400, 4000  # target numbers for the later meshes; they take 1, 3 and 5 s
MAX_BRACKET = 0.03  # default width of the bracket relative to its middle
# The size of triangles is proportional to (work of flow per area)^-SIZE_EXPONENT. Of 1/4, 1/3 and
# 1/2 the last gave the narrowest bracket on a round lug 3 bores wide.
SIZE_EXPONENT = 0.5
MIN_FLOW_SHARE = 1e-3  # floor of the work of flow per area relative to its largest value
MAX_SIZE = 0.5  # largest triangle, in radii
EQUILATERAL = math.sqrt(3.0) / 4.0  # area of an equilateral triangle over its side squared
PULL = np.array([1.0, 0.0])


@dataclass(frozen=True)
class LugMeshBounds:
    """The bounds of one mesh, N/m, strict for its polygon."""

    triangles: int
    lower: ForcePerLength
    upper: ForcePerLength


@dataclass(frozen=True)
class LugLimitLoad:
    """The load per thickness at which a lug collapses, N/m; it lies between `lower` and `upper`.

    polygon: relative amount by which both bounds are widened, because arcs are meshed as polygons;
    an estimate. meshes: the bounds of all meshes, of which the best count.
    """

    lower: ForcePerLength
    upper: ForcePerLength
    polygon: float
    meshes: tuple[LugMeshBounds, ...]

    @property
    def load(self) -> ForcePerLength:
        """The middle of the bracket, N/m."""
        return (self.lower + self.upper) / 2.0

    @property
    def half_width(self) -> float:
        """Half the width of the bracket, relative to its middle."""
        return (self.upper - self.lower) / (self.upper + self.lower)


def lug_limit_load(
    lug: LugOutline, yield_strength: float, max_bracket: float = MAX_BRACKET
) -> LugLimitLoad:
    """Return the limit load of a lug.

    lug: if there is a bushing, its hole is the one in which the bushing sits, since the bushing is
    treated as part of the pin.
    yield_strength: von Mises stress at which the metal flows, Pa.
    max_bracket: refinement ends when the width of the bracket relative to its middle is at most
    this, or after the finest mesh.

    Raises: ArgumentError for a strength that is not positive, or for a ring; MeshError; SolveError.
    """
    if not (math.isfinite(yield_strength) and yield_strength > 0.0):
        raise ArgumentError("the yield strength of a lug must be positive", "not-positive")
    # The lug is two halves; in the programs the unit of length is the radius of the hole, and the
    # unit of stress the shear strength.
    unit = 2.0 * yield_strength / math.sqrt(3.0) * lug.hole / 2.0
    meshes: list[LugMeshBounds] = []
    mesh = half_lug_mesh(lug, FIRST_SIZE)
    polygon = 0.0
    for count in (*TRIANGLE_COUNTS, 0):
        below = solve_cone_program(lower_program(mesh, PULL))
        above = solve_cone_program(upper_program(mesh, PULL))
        bounds = LugMeshBounds(len(mesh.triangles), unit * below.lower, unit * above.upper)
        meshes.append(bounds)
        polygon = _polygon_share(lug, mesh)
        if not count or _width(meshes) <= max_bracket:
            break
        mesh = half_lug_mesh(lug, FIRST_SIZE, SizeField(mesh, _sizes(mesh, (below, above), count)))
    lower, upper = _best(meshes)
    return LugLimitLoad(lower * (1.0 - polygon), upper * (1.0 + polygon), polygon, tuple(meshes))


def _best(meshes: list[LugMeshBounds]) -> tuple[float, float]:
    return max(m.lower for m in meshes), min(m.upper for m in meshes)


def _width(meshes: list[LugMeshBounds]) -> float:
    lower, upper = _best(meshes)
    return 2.0 * (upper - lower) / (upper + lower)


def _sizes(mesh: PlaneMesh, solutions: tuple[ConeSolution, ConeSolution], count: int) -> Floats:
    """Return the triangle sizes at the nodes (N,) for about `count` triangles; they are small where
    either solution flows.
    """
    corner = mesh.triangles.ravel()
    area = mesh.gradients()[1]
    flow = sum(s.flow.reshape(-1, 3).sum(axis=1) / s.flow.sum() for s in solutions)
    around = np.bincount(corner, np.repeat(area, 3))
    dense = np.bincount(corner, np.repeat(flow, 3)) / around
    relative = np.maximum(dense, MIN_FLOW_SHARE * dense.max()) ** -SIZE_EXPONENT
    needed = (area / (EQUILATERAL * relative[mesh.triangles].mean(axis=1) ** 2)).sum()
    return np.asarray(np.minimum(relative * math.sqrt(needed / count), MAX_SIZE))


def _polygon_share(lug: LugOutline, mesh: PlaneMesh) -> float:
    """Return the largest height of the bore's arcs over their chords, relative to the thickness of
    the metal between the bore and the end of the head.
    """
    chord = np.linalg.norm(np.diff(mesh.nodes[mesh.edges["bore"]], axis=1)[:, 0], axis=1).max()
    height = 1.0 - math.sqrt(1.0 - (chord / 2.0) ** 2)
    return float(height / (2.0 * lug.end / lug.hole - 1.0))

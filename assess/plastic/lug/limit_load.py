"""The limit load of a lug: the force of a pin per thickness at which it collapses, in plane strain.

The pin pulls along the shank. Rigid-perfectly plastic, small displacements, a rigid pin without
friction that fits and may leave the bore anywhere. Clearance does not matter: what flows closes it.
Two cone programs on each of a few meshes bound the load strictly for their polygons
(assess.plastic.lug.bounds); each mesh is finer where the one before flows.

Plane stress is not offered: there a bore that flows carries no more than 1.15 times yield on its
projected area, whatever the head is like, whereas a bore in metal that is held across does.
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

FIRST_SIZE = 0.08  # radii, of triangles at the bore on the first mesh
TRIANGLE_COUNTS = 1200, 2400, 4000  # wanted of the meshes after that: 1, 3 and 5 s
MAX_BRACKET = 0.03  # width of a bracket over its middle, by default
# Triangles are as large as (work of flow per area)^-SIZE_EXPONENT; of 1/4, 1/3 and 1/2 the last
# gave the narrowest bracket on a round lug 3 bores wide.
SIZE_EXPONENT = 0.5
MIN_FLOW_SHARE = 1e-3  # of the largest work of flow per area: less does not enlarge triangles
MAX_SIZE = 0.5  # radii
EQUILATERAL = math.sqrt(3.0) / 4.0  # area over the square of a side
PULL = np.array([1.0, 0.0])


@dataclass(frozen=True)
class LugMeshBounds:
    """The bounds of one mesh, N/m, strict for its polygon."""

    triangles: int
    lower: ForcePerLength
    upper: ForcePerLength


@dataclass(frozen=True)
class LugLimitLoad:
    """The load per thickness at which a lug collapses, N/m, between lower and upper.

    polygon: the part of them by which both are moved outwards, because arcs are meshed as polygons;
    an estimate. meshes: of which the best bounds count.
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
        """Half of the bracket over its middle."""
        return (self.upper - self.lower) / (self.upper + self.lower)


def lug_limit_load(
    lug: LugOutline, yield_strength: float, max_bracket: float = MAX_BRACKET
) -> LugLimitLoad:
    """The limit load of a lug whose metal flows at a von Mises stress, Pa.

    lug: with a bushing the hole in which it sits counts: the bushing is part of the pin.
    max_bracket: the width over the middle at which no finer mesh is made; the finest is the last in
    any case.

    Raises: ArgumentError for a strength that is not positive, or a ring; MeshError; SolveError.
    """
    if not (math.isfinite(yield_strength) and yield_strength > 0.0):
        raise ArgumentError("the yield strength of a lug must be positive", "not-positive")
    # Two halves; lengths of the programs are radii, stresses the shear strength.
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
    """Sizes (N,) of about `count` triangles, small where either solution flows."""
    corner = mesh.triangles.ravel()
    area = mesh.gradients()[1]
    flow = sum(s.flow.reshape(-1, 3).sum(axis=1) / s.flow.sum() for s in solutions)
    around = np.bincount(corner, np.repeat(area, 3))
    dense = np.bincount(corner, np.repeat(flow, 3)) / around
    relative = np.maximum(dense, MIN_FLOW_SHARE * dense.max()) ** -SIZE_EXPONENT
    needed = (area / (EQUILATERAL * relative[mesh.triangles].mean(axis=1) ** 2)).sum()
    return np.asarray(np.minimum(relative * math.sqrt(needed / count), MAX_SIZE))


def _polygon_share(lug: LugOutline, mesh: PlaneMesh) -> float:
    """The largest height of the bore's arcs over their chords, of the metal behind the pin."""
    chord = np.linalg.norm(np.diff(mesh.nodes[mesh.edges["bore"]], axis=1)[:, 0], axis=1).max()
    height = 1.0 - math.sqrt(1.0 - (chord / 2.0) ** 2)
    return float(height / (2.0 * lug.end / lug.hole - 1.0))

"""The maxima of a pin's cases in the solid model on one mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

from fea.core.memory import most_unknowns, require_memory
from fea.core.mesh_result import MeshMaximum, ZoneMaximum
from fea.core.model import MeshBefore, MeshProblem, MeshSequence
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.zone import DISTANCE_VARIATIONS, Zone
from fea.singular.probes import all_round, rim
from fea.singular.singularities import clamp_rims, free_of_arcs, outside
from fea.solid.field import SolidField, SolidSolution, in_none
from fea.solid.model import SolidModel, acting
from fea.solid.sharp_edges import sharp_edges
from fea.solid.superposition import envelope
from geometry.imported.meshing import solid_mesh
from geometry.mesh.elements import Element
from geometry.mesh.solid_mesh import MeshSize
from geometry.shape.band import END_FACES

# Tetrahedra are larger than a small step. At a tenth of the step from its corner, the harmonic
# model finds 1.6 to 2.1 times the stress of the shaft there. This factor stands for that rise.
SHALLOW_STEP_FACTOR = 1.5
# The scatter was measured on fillets with and without a bore, 0.07 to 0.13.
SOLID_MESHES = MeshSequence(
    ratio=2.0**0.5, growth=3.0, max_meshes=4, max_unknowns=300_000, scatter=0.13
)
GIVEN_SOLID_MESHES = replace(SOLID_MESHES, ratio=2.0)


def solid_solution(
    problem: MeshProblem, size: MeshSize, element: Element = "curved"
) -> SolidSolution:
    """Solve all unit loads of the cases on a mesh that is finer at edges of bands and clamps.

    The zones of a body of revolution are those of the problem; those of any other body are found on
    its mesh.

    Raises: MeshError, SolveError.
    """
    pin, clamps, cases, singularities = problem.pin, problem.clamps, problem.cases, problem.zones
    names = tuple(dict.fromkeys(name for c in cases for name in c.surfaces))
    edges = tuple(z for name in names for z in (pin.band(name).z0, pin.band(name).z1))
    profile = pin.profile
    if profile is not None:
        turned = tuple(name for name in clamps if name in (*END_FACES, *profile.labels))
        edges += tuple(z for _, z in clamp_rims(profile, turned))
    most = most_unknowns(problem.memory)
    mesh = solid_mesh(pin, size, tuple(dict.fromkeys(edges)), element, most)
    units = acting(cases) or ((UnitLoad(names[0], "force", 1), 0),)  # whose coefficient is zero
    model = SolidModel(pin, mesh, problem.material, clamps)
    require_memory(pin.name, model.space.unknowns, problem.memory)
    if profile is not None and pin.revolved:
        near = [[p.varied(x) for p in singularities] for x in (1.0, *DISTANCE_VARIATIONS)]
        rims = [all_round(rim(profile, p, p.radius)) for here in near for p in here]
        fields = model.solve(units, np.concatenate([np.zeros((0, 3)), *rims]))
        r, z = np.hypot(*fields.points[:, :2].T), fields.points[:, 2]
        within, *varied = ([~outside((p,), r, z) for p in here] for here in near)
        zones = list(singularities)
    else:
        fields = model.solve(units)
        limit = partial(free_of_arcs, profile) if profile is not None else None
        edge = sharp_edges(fields.space, fields.surface, clamps, limit)
        at = [
            edge.singularities(fields.points, times * problem.distance)
            for times in (1.0, *DISTANCE_VARIATIONS)
        ]
        within, *varied = ([mask for _, mask in here] for here in at)
        zones = [singularity for singularity, _ in at[0]]
    count = len(fields.points)
    return SolidSolution(
        fields, tuple(zones), tuple(within), tuple(in_none(masks, count) for masks in varied)
    )


@dataclass(frozen=True)
class SolidMeshSolution:
    """One mesh solved as a solid (fea.core.model.MeshSolution).

    ratio: how much coarser the mesh before is.
    before: the maxima of that mesh for each case, from which the growth of stress in zones follows.
    """

    solution: SolidSolution
    ratio: float
    before: Mapping[str, MeshMaximum]

    solids: ClassVar[tuple[tuple[float, float], ...]] = ()

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones of the problem for a body of revolution; for any other body, those found on the
        mesh.
        """
        return self.solution.singularities

    def field(self, case: str) -> SolidField:
        """The stress of a case; all cases have the same zones."""
        return SolidField(self.solution)

    def maximum(self, loads: PinLoads) -> MeshMaximum:
        """The maximum of a case."""
        return solid_result(self.solution, self.before, self.ratio, loads)


class Solid:
    """The model of any body by tetrahedra (fea.core.model.Model).

    given: whether the mesh comes from a file, so that it can only be refined by halving its
    elements.
    """

    name = "solid"

    def __init__(self, given: bool = False, element: Element = "curved") -> None:
        self.meshes = GIVEN_SOLID_MESHES if given else SOLID_MESHES
        self._element = element

    def solve(
        self, problem: MeshProblem, level: int, before: MeshBefore | None = None
    ) -> SolidMeshSolution:
        """Solve all unit loads on mesh number `level` (fea.core.model.Model.solve)."""
        size = MeshSize().finer(self.meshes.ratio**level)
        solution = solid_solution(problem, size, self._element)
        maxima = {} if before is None else before.maxima
        return SolidMeshSolution(solution, self.meshes.ratio, maxima)


def solid_result(
    solution: SolidSolution, earlier: Mapping[str, MeshMaximum], ratio: float, loads: PinLoads
) -> MeshMaximum:
    """The maximum outside the singularities, and the maximum inside each of them.

    Exponents follow from the growth of stress since the mesh before.
    earlier: the result of each case on the mesh before.
    ratio: how much coarser that mesh is.
    """
    fields, before = solution.fields, earlier.get(loads.case)
    top = envelope(fields, loads, solution.outside, solution.within)
    exponents: list[float | None] = [None] * len(top.inside)
    if before is not None and len(before.singularities) == len(top.inside):
        exponents = [
            float(np.log(now / then.maximum) / np.log(ratio)) if now > then.maximum > 0.0 else None
            for (now, _), then in zip(top.inside, before.singularities, strict=True)
        ]
    result = MeshMaximum(
        unknowns=fields.space.unknowns,
        maximum=top.maximum,
        instant=top.instant,
        location=top.location,
        singularities=tuple(
            ZoneMaximum(
                value, value * (SHALLOW_STEP_FACTOR if p.feature < p.radius else 1.0), at, s
            )
            for p, (value, at), s in zip(solution.singularities, top.inside, exponents, strict=True)
        ),
        scatter=top.scatter,
        energy=fields.energy,
    )
    if not result.singular:
        return result
    maxima = [envelope(fields, loads, mask).maximum for mask in solution.varied]
    return replace(result, interval=(min(maxima), max(maxima)))

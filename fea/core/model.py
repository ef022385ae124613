"""The interface of the models, which compute stress from loads on successive meshes of a pin."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from fea.core.material import Material
from fea.core.mesh_result import MeshMaximum
from fea.core.pin_loads import PinLoads
from fea.core.solution import StressField
from fea.core.zone import Zone
from geometry import PinLike


@dataclass(frozen=True)
class MeshSequence:
    """The refinement of a model's meshes, and their properties that are known in advance.

    ratio: element size of a mesh over that of the next.
    growth: exponent with which the number of unknowns grows, as ratio^growth.
    max_meshes, max_unknowns: limits at which a sequence ends.
    scatter: relative scatter of the maximum with the positions of nodes on the first mesh; it falls
    with the square of the element size.
    min_order: lowest order of convergence of the maximum.
    min_meshes: number of meshes before a maximum can be converged, since fewer may agree by chance.
    """

    ratio: float
    growth: float
    max_meshes: int
    max_unknowns: int
    scatter: float
    min_order: float = 0.5
    min_meshes: int = 3

    def unknowns_after(self, unknowns: int) -> float:
        """The approximate number of unknowns of the mesh after one with `unknowns`."""
        grown: float = self.ratio**self.growth
        return unknowns * grown


@dataclass(frozen=True)
class MeshProblem:
    """A pin under loads, in the form that models take.

    clamps: constrained surfaces, by the pin's names.
    cases: loads of all cases, whose unit loads are solved.
    zones: zones of unbounded stress in any of the cases.
    acting: for each case, the zones that its loads make singular; all zones by default.
    distance: excluded around singularities, as a fraction of the local diameter.
    tolerance: of the maximum, relative.
    memory: limit, MB; by default most of the free memory.
    """

    pin: PinLike
    material: Material
    clamps: tuple[str, ...]
    cases: tuple[PinLoads, ...]
    zones: tuple[Zone, ...] = ()
    acting: Mapping[str, tuple[Zone, ...]] = field(default_factory=dict)
    distance: float = 0.1
    tolerance: float = 0.02
    memory: float | None = None

    def zones_of(self, case: str) -> tuple[Zone, ...]:
        """The zones that the loads of one case make singular."""
        return self.acting.get(case, self.zones)


class MeshSolution(Protocol):
    """The solution of unit loads on one mesh."""

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones of the problem, and those found on the mesh: corners of cuts, sharp edges."""

    @property
    def solids(self) -> tuple[tuple[float, float], ...]:
        """The ends z of each local solid, m; empty where one model covers the whole pin."""

    def field(self, case: str) -> StressField:
        """The stress for one case, which is not read in zones that the loads of this case make
        singular.
        """

    def maximum(self, loads: PinLoads) -> MeshMaximum:
        """The maximum of a case, with the parts of its error that follow from this mesh alone."""


@dataclass(frozen=True)
class MeshBefore:
    """The previous, coarser mesh.

    solution: of that mesh; None where only its maxima are known.
    maxima: for each case, the maximum.
    """

    solution: MeshSolution | None
    maxima: Mapping[str, MeshMaximum]

    @property
    def results(self) -> Collection[MeshMaximum]:
        """The maxima in all cases."""
        return self.maxima.values()


class Model(Protocol):
    """A way to solve a pin on a sequence of meshes."""

    @property
    def name(self) -> str: ...

    @property
    def meshes(self) -> MeshSequence: ...

    def solve(
        self, problem: MeshProblem, level: int, before: MeshBefore | None = None
    ) -> MeshSolution:
        """Solve all unit loads of all cases on mesh number `level`.

        level: 0 for the first mesh of a run; charts also ask for coarser meshes, below 0.
        before: the previous mesh. The new mesh is fine where stress was high on it, and reuses the
        parts that need not be solved again.

        Raises: MeshError; SolveError, also for more memory than the problem allows.
        """

"""The interface of the models: from loads on a pin to its stress, on one mesh after another."""

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
    """The refinement of a model's meshes, and all that is known of them before one is solved.

    ratio: element size of a mesh over that of the next. growth: unknowns grow as ratio^growth.
    max_meshes, max_unknowns: where a sequence ends. scatter: of the maximum on the first mesh with
    the positions of its nodes, relative; it falls with the square of the element size. min_order:
    the lowest order of convergence of the maximum. min_meshes: before a maximum can be converged,
    since fewer agree by chance.
    """

    ratio: float
    growth: float
    max_meshes: int
    max_unknowns: int
    scatter: float
    min_order: float = 0.5
    min_meshes: int = 3

    def unknowns_after(self, unknowns: int) -> float:
        """Unknowns of the mesh that follows one with `unknowns`, roughly."""
        grown: float = self.ratio**self.growth
        return unknowns * grown


@dataclass(frozen=True)
class MeshProblem:
    """A pin under loads, as a model takes it.

    clamps: constrained surfaces, by the pin's names. cases: of which all unit loads are solved.
    zones: of unbounded stress in any of the cases; acting: those of each case, all by default.
    distance: excluded around zones, as a fraction of the local diameter. tolerance: of the maximum,
    relative. memory: limit in MB, by default most of the free memory.
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
        """Zones that the loads of one case make singular."""
        return self.acting.get(case, self.zones)


class MeshSolution(Protocol):
    """Unit loads solved on one mesh."""

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The problem's, and those found on the mesh: corners of cuts, edges of tetrahedra."""

    @property
    def solids(self) -> tuple[tuple[float, float], ...]:
        """The ends, z in m, of each local solid; none where the whole pin has one model."""

    def field(self, case: str) -> StressField:
        """Stress as one case sees it: it is not read in zones that its loads make singular."""

    def maximum(self, loads: PinLoads) -> MeshMaximum:
        """The maximum of a case, with the parts of its error that this mesh knows."""


@dataclass(frozen=True)
class MeshBefore:
    """The mesh below: its solution, None where only its maxima are known, and these by case."""

    solution: MeshSolution | None
    maxima: Mapping[str, MeshMaximum]

    @property
    def results(self) -> Collection[MeshMaximum]:
        """Its maxima in all cases."""
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
        """All unit loads of all cases on mesh number `level`; 0 is the first of a run, charts also
        ask for coarser ones below. before: the mesh below, by which this one is fine where stress
        is high, and from which it takes what need not be solved again.

        Raises: MeshError; SolveError, also for more memory than the problem allows.
        """

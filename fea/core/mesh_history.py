"""The maxima of one load case on successive meshes, and the error that they show."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fea.core.mesh_result import MeshMaximum
from fea.core.model import MeshSequence
from fea.core.peak import ErrorParts, Refinement, discretisation_error, widened
from fea.core.pin_loads import PinLoads


@dataclass(frozen=True)
class MeshHistory:
    """The meshes of one load case so far, from coarse to fine.

    results: maximum on each mesh.
    seconds: solution time of each mesh, s.
    meshes: refinement of the sequence.
    first: number of meshes of a run that are coarser than the first of these.
    """

    pin: str
    case: str
    model: str
    results: tuple[MeshMaximum, ...]
    seconds: tuple[float, ...]
    meshes: MeshSequence
    first: int = 0

    def appended(self, result: MeshMaximum, spent: float) -> MeshHistory:
        """The history with the result of one more mesh, which took `spent` seconds."""
        return replace(self, results=(*self.results, result), seconds=(*self.seconds, spent))

    @property
    def history(self) -> tuple[Refinement, ...]:
        """The maxima outside the singular zones, mesh by mesh."""
        return tuple(
            Refinement(result.unknowns, result.maximum, spent)
            for result, spent in zip(self.results, self.seconds, strict=True)
        )

    def under(self, loads: PinLoads) -> tuple[Refinement, ...]:
        """The history with the strain energy of each mesh under loads of one instant."""
        return tuple(
            replace(step, strain_energy=result.energy.of(loads) if result.energy else None)
            for step, result in zip(self.history, self.results, strict=True)
        )

    @property
    def error(self) -> float:
        """The estimated error of the last maximum, Pa."""
        return self.parts.total

    @property
    def parts(self) -> ErrorParts:
        """The parts of the error of the last maximum.

        The part of the mesh follows from the sequence of meshes, but is never less than the scatter
        with the positions of nodes.
        """
        last = self.results[-1]
        if len(self.results) == 1:
            return ErrorParts(last.maximum)  # one mesh shows no error, so that all is uncertain
        mesh = self._of_mesh(last)
        return ErrorParts(mesh, last.between, last.left_out, truncation=last.truncated)

    def _of_mesh(self, last: MeshMaximum) -> float:
        finer = self.meshes.ratio ** (self.first + len(self.results) - 1)
        scatter = max(last.scatter, self.meshes.scatter * last.maximum / finer**2)
        return discretisation_error(self.history, self.meshes.ratio, scatter, self.meshes.min_order)

    @property
    def relative(self) -> float:
        """The error divided by the maximum."""
        largest = self.results[-1].maximum
        return self.error / largest if largest else 0.0

    @property
    def range(self) -> tuple[float, float]:
        """The bounds of the maximum, Pa, from the error of meshes and instants; where stress is
        larger in an excluded zone, also from half and twice the excluded distance.
        """
        last = self.results[-1]
        if self.excluded is None:
            return last.maximum - self.error, last.maximum + self.error
        return widened(self.excluded, self.relative)

    @property
    def excluded(self) -> tuple[float, float] | None:
        """The bounds of the maximum outside half and twice the excluded distance, Pa, where stress
        is larger in an excluded zone; None elsewhere.

        Both are widened by their change from the mesh before, since so near to the singularity they
        are less accurate than the maximum.
        """
        last = self.results[-1]
        if not last.governed:
            return None
        low, high = last.interval or (last.maximum, last.maximum)
        for before in self.results[-2:-1]:
            if before.interval is not None:
                low -= abs(low - before.interval[0])
                high += abs(high - before.interval[1])
        return low, high

    def known(self, tolerance: float) -> bool:
        """Return whether there are enough meshes and the error is within a relative tolerance."""
        return len(self.results) >= self.meshes.min_meshes and self.relative <= tolerance

"""The elastic response of the piece about a pin's cuts to nodal forces of one parity class."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from fea.core.linear_solver import ConstrainedSystem, SolveError
from fea.core.material import Material
from fea.cut.parity import Parities
from fea.cut.two_level import ENERGY_TOLERANCE, MAX_FACTORED_UNKNOWNS, TwoLevel
from fea.solid.assembly import Discretisation
from fea.solid.model import rigid_modes
from pinbase.arrays import Floats, Ints

# Chosen by judgement. Singular values of a class's forces below this part of the largest are not
# solved.
TRACTION_RANK_TOLERANCE = 1e-5
# An imbalance above this part of the tractions on the cuts is not due to the section's mesh.
MAX_UNBALANCED_TRACTION = 0.1


@dataclass(frozen=True)
class Combined:
    """Displacements under L loads as combinations of a few.

    few: (3 N, R) m.
    amounts: (R, L) of these in each load.
    """

    few: Floats
    amounts: Floats

    def at(self, unknowns: Ints) -> Floats:
        """The displacements (M, L), m, of some unknowns, by their numbers."""
        return np.asarray(self.few[unknowns] @ self.amounts)


@dataclass(frozen=True)
class PieceSystem:
    """The equations of a piece on one mesh; the names are those of fea.cut.local_model.LocalModel.

    pin: its name, for messages.
    """

    pin: str
    space: Discretisation
    material: Material
    clamps: tuple[str, ...]
    parities: Parities

    def displace(
        self,
        loaded: Ints,
        forces: Floats,
        parity: tuple[int, ...],
        whole: Floats,
        tolerance: float = ENERGY_TOLERANCE,
    ) -> Combined:
        """The displacements of a parity class, after its forces are balanced.

        loaded: (M,) numbers of the unknowns on which forces act, all three of each such node.
        forces: (M, L) N.
        parity: of the class.
        whole: (M, L) N, the size of the forces of all classes.
        tolerance: of the iterations (TwoLevel.solve).

        Raises: SolveError.
        """
        free = np.ones(self.space.unknowns)
        free[self._fixed(parity)] = 0.0
        held = np.zeros(0, dtype=np.int64)
        # Without clamps rigid-body motions are possible. So forces are balanced, and for each
        # motion one unknown of a corner node is held, chosen by pivoted QR to be independent.
        if not self.clamps:
            modes = rigid_modes(self.space.nodes)[:, self.parities.rigid(parity)]
            forces = self.balanced(forces, modes[loaded], whole)
            if count := modes.shape[1]:
                at = np.flatnonzero(free * self._at_corners)
                _, _, pivot = scipy.linalg.qr(modes[at].T, mode="economic", pivoting=True)
                held = at[pivot[:count]]
        # Many loads stress the cuts in few ways, so only the singular vectors of the forces are
        # solved.
        forces = free[loaded, None] * forces
        size, right = combinations(forces)
        rank = int(np.sum(size > TRACTION_RANK_TOLERANCE * size[0]))
        some = np.zeros((self.space.unknowns, rank))
        some[loaded] = forces @ right[:rank].T
        u = (
            self._two_level.solve(free, held, some, tolerance)
            if self.space.unknowns > MAX_FACTORED_UNKNOWNS
            else None
        )
        # Small systems, and those for which the iteration fails, are factored.
        if u is None:
            free[held] = 0.0
            u = self._system.solve(self.stiffness.copy(), free, some)
        return Combined(u, right[:rank])

    @cached_property
    def _at_corners(self) -> Floats:
        """The factors (3 N,), 1 for unknowns at corners of elements, 0 for those in the middle of
        edges.
        """
        out = np.zeros((len(self.space.nodes), 3))
        out[self.space.elements[:, :4]] = 1.0
        return out.ravel()

    @cached_property
    def _two_level(self) -> TwoLevel:
        return TwoLevel(self.space, self.stiffness)

    @cached_property
    def _system(self) -> ConstrainedSystem:
        return ConstrainedSystem(self.stiffness, np.arange(self.space.unknowns) // 3)

    @cached_property
    def stiffness(self) -> sp.csr_matrix:
        """The stiffness matrix, N/m."""
        return self.space.stiffness(self.material)

    def _fixed(self, parity: tuple[int, ...]) -> Ints:
        """The numbers of the unknowns that are zero on mirror planes and clamps."""
        unknowns = [np.zeros(0, dtype=np.int64)]
        boundaries = self.space.mesh.boundaries

        def add(name: str, components: tuple[int, ...]) -> None:
            nodes = self.space.basis.get_dofs(boundaries[name]).flatten()
            unknowns.extend(3 * nodes + a for a in components)

        for mirror, components in self.parities.fixed(parity).items():
            add("start" if mirror == "z" else f"mirror {mirror}", components)
        for name in self.clamps:
            add(name, (0, 1, 2))
        return np.unique(np.concatenate(unknowns))

    def balanced(self, forces: Floats, modes: Floats, whole: Floats) -> Floats:
        """The forces without the small resultant that the mesh of the section leaves.

        The nodes of the cuts take it up, in proportion to the forces there.
        forces: (M, L) N.
        modes: (M, m) rigid-body motions.
        whole: (M, L) N, as for `displace`.

        Raises: SolveError when the resultant is too large to be due to the mesh.
        """
        if not modes.shape[1]:
            return forces
        lost = np.abs(modes.T @ forces) / (np.abs(modes).T @ whole + 1e-300)
        if not lost.max() < MAX_UNBALANCED_TRACTION:
            raise SolveError(
                f"pin {self.pin}: the stress of the uncut pin on the cuts is not in "
                f"equilibrium (by {lost.max():.1e}), so a load or the weight of the pin acts on "
                'the removed area; use model = "solid"',
                "cut-unbalanced",
            )
        force_size = np.linalg.norm(forces.reshape(len(forces) // 3, -1), axis=1)
        weight = force_size.repeat(3)[:, None] * modes
        return np.asarray(forces - weight @ np.linalg.solve(modes.T @ weight, modes.T @ forces))


def combinations(columns: Floats) -> tuple[Floats, Floats]:
    """The singular values (K,) of columns (N, K), largest first, and the right singular vectors (K,
    K), a row each.

    They are found from the products of the columns, in a fraction of the time of a singular value
    decomposition. Values below 1e-7 of the largest are noise.
    """
    square, vectors = np.linalg.eigh(columns.T @ columns)
    return np.sqrt(np.maximum(square[::-1], 0.0)), vectors.T[::-1]

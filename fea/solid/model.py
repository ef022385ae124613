"""The solid model: a pin in tetrahedra, quadratic ones by default, under unit loads.

There is one factorisation for each mesh. Each unit load that acts has a field for each phase. The
stress at any instant of any case is a linear combination of these.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from fea.core.linear_solver import SolveError, factorize
from fea.core.material import Material
from fea.core.pin_loads import Loads, PinLoads, Unit, amounts_of
from fea.core.strain_energy import StrainEnergy
from fea.singular.probes import interpolation
from fea.solid.assembly import Discretisation
from fea.solid.boundary import SurfaceMesh, clamped_nodes, resultants, surface
from fea.solid.nodal_loads import nodal_loads, relative_resultant, with_closing_tractions
from fea.solid.stress_recovery import nodal_stress, with_known_traction
from geometry import PinLike
from geometry.mesh.solid_mesh import SolidMesh
from pinbase.arrays import Floats, Ints

_NO_POINTS = np.zeros((0, 3))


@dataclass(frozen=True)
class UnitFields:
    """The fields of L unit loads, each in one phase, per unit of load.

    displacement: (N, 3, L) m.
    stress: (N, 6, L) Pa.
    forces: (N, 3, L) N, at the nodes.
    extra: (P, 3) m, additional points inside the body where stress is read.
    fixed: numbers of the constrained displacement components, 3 n + c for component c of node n.
    support: (6, L) force and moment of the clamps about (0, 0, 0), from the residual of the system;
    in equilibrium they are minus those of the load.
    revolved: whether the pin is a body of revolution.
    """

    space: Discretisation
    surface: SurfaceMesh
    loads: tuple[Unit, ...]
    displacement: Floats
    stress: Floats
    forces: Floats
    fixed: Ints
    support: Floats
    revolved: bool = True
    extra: Floats = field(default_factory=lambda: np.zeros((0, 3)))

    @property
    def points(self) -> Floats:
        """The points (S + P, 3), m, where stress is read: those on the surface, then the additional
        ones.
        """
        return np.concatenate([self.space.nodes[self.surface.nodes], self.extra])

    @cached_property
    def read(self) -> Floats:
        """The stress (S + P, 6, L), Pa, at these points."""
        to_extra = interpolation(self.space.nodes, self.space.elements, self.extra)
        inside = to_extra @ self.stress.reshape(len(self.stress), -1)
        shape = len(self.extra), *self.stress.shape[1:]
        return np.concatenate([self.stress[self.surface.nodes], inside.reshape(shape)])

    @cached_property
    def energy(self) -> StrainEnergy:
        """The strain energy of the pin under these loads."""
        forces, moved = (x.reshape(-1, len(self.loads)) for x in (self.forces, self.displacement))
        return StrainEnergy(self.loads, forces.T @ moved)

    def coefficients(self, loads: Loads) -> Floats:
        """The amount (T, L) of each unit load at each instant.

        Raises: ArgumentError when there is no field for a part of the loads.
        """
        return amounts_of(self.loads, loads)


def acting(cases: Iterable[PinLoads]) -> tuple[Unit, ...]:
    """The unit loads of which the cases consist, in all phases, so that loads can be turned."""
    loads = dict.fromkeys(load for case in cases for load in case.coefficients())
    return tuple((load, phase) for load in loads for phase in load.phases)


class SolidModel:
    """A pin on one mesh, clamped at surfaces (by name).

    Without clamps, closing tractions on the bands of all connections react the resultants of every
    load; they cancel where loads are in balance. Six unknowns are then constrained against
    rigid-body motions.

    Plasticity, contact and clearance are not included: loads are tractions.
    """

    def __init__(
        self, pin: PinLike, solid: SolidMesh, material: Material, clamps: tuple[str, ...]
    ) -> None:
        self.pin, self.material, self.clamps = pin, material, clamps
        self.space = Discretisation(solid.mesh)

    @cached_property
    def stiffness(self) -> sp.csr_matrix:
        """The stiffness matrix, N/m."""
        return self.space.stiffness(self.material)

    @cached_property
    def fixed(self) -> Ints:
        """The numbers of the constrained unknowns."""
        if self.clamps:
            nodes = clamped_nodes(self.space, self.clamps)
            return (3 * nodes[:, None] + np.arange(3)).ravel()
        return _isostatic(self.space.nodes)

    def solve(self, units: tuple[Unit, ...], extra: Floats = _NO_POINTS) -> UnitFields:
        """The unit fields of loads in their phases.

        On surfaces that are not bands, only forces may act.
        extra: (P, 3) m, additional points inside the body where stress is read.

        Raises: SolveError when the pin is not constrained or a check fails.
        """
        boundary = surface(self.space)
        loads = nodal_loads(self.pin, self.material, self.space, boundary, units)
        if not self.clamps:
            pressing = np.array([not load.shears for load, _ in units])
            loads = with_closing_tractions(self.pin, self.space, boundary, loads, pressing)
        displacement, support = self._displace(loads.forces)
        clamped = boundary.on(self.space, self.clamps)
        stress = nodal_stress(self.space, self.material, displacement)
        stress = with_known_traction(stress, boundary, loads.traction, clamped)
        return UnitFields(
            self.space, boundary, units, displacement, stress, loads.forces, self.fixed, support,
            self.pin.revolved, extra,
        )  # fmt: skip

    def _displace(self, F: Floats) -> tuple[Floats, Floats]:
        """The displacements (N, 3, L), m, under nodal forces F (N, 3, L), N, and the resultants (6,
        L) of the clamps.

        Raises: SolveError when the reactions do not balance the loads.
        """
        shape, F = F.shape, F.reshape(self.space.unknowns, -1)
        free = np.setdiff1d(np.arange(self.space.unknowns), self.fixed)
        K = self.stiffness
        u = np.zeros_like(F)
        u[free] = factorize(K[free][:, free], free // 3)(F[free])
        # Reactions from the residual; they must balance the loads.
        reaction = np.zeros_like(F)
        reaction[self.fixed] = K[self.fixed] @ u - F[self.fixed]
        F = F.reshape(shape)
        support = resultants(self.space.nodes, reaction.reshape(shape))
        lost = relative_resultant(self.pin, support + resultants(self.space.nodes, F), F).max()
        if not lost < 1e-6:
            raise SolveError(
                f"pin {self.pin.name}: reactions and loads differ by {lost:.1e} of the load, so "
                "the solution is not in equilibrium",
                "no-equilibrium",
            )
        return u.reshape(shape), support


def rigid_modes(x: Floats) -> Floats:
    """Three translations and three rotations (3 N, 6) about the origin.

    x: (N, 3) m, nodes; rotations are scaled by the largest coordinate.
    """
    x = x / np.abs(x).max()
    modes = np.zeros((len(x), 3, 6))
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        modes[:, a, a] = 1.0
        modes[:, b, 3 + a], modes[:, c, 3 + a] = -x[:, c], x[:, b]
    return modes.reshape(-1, 6)


def _isostatic(nodes: Floats) -> Ints:
    """Six unknowns whose constraint prevents rigid-body motions, chosen far apart by pivoted QR."""
    _, _, pivot = scipy.linalg.qr(
        rigid_modes(nodes - nodes.mean(axis=0)).T, mode="economic", pivoting=True
    )
    return np.sort(pivot[:6]).astype(np.int64)

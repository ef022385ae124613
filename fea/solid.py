"""The solid model: a pin in quadratic tetrahedra under unit loads on its bands.

One factorisation per mesh; each band gets a unit force along each axis, spread as a uniform
traction. The stress at any instant of any case is a linear combination of these unit fields.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray

from fea.elasticity import Discretisation
from fea.linear import SolveError, factorize
from fea.material import Material
from fea.stress import nodal_stress, with_known_traction
from fea.surface import Surface, held_nodes, surface, uniform_share
from geometry import Pin
from geometry.solid_mesh import SolidMesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

RESULTANT_TOLERANCE = 1e-10


@dataclass(frozen=True)
class PinLoads:
    """Forces on one pin in one case: forces (T, C, 3) N in the pin's axes, one per surface name."""

    case: str
    surfaces: tuple[str, ...]
    forces: Floats

    @property
    def axial(self) -> bool:
        """Whether any force has a part along the pin."""
        return bool(np.any(self.forces[..., 2]))

    def turned(self, angle: float) -> PinLoads:
        """The same forces, all turned about the pin's axis by `angle` (rad)."""
        c, s = np.cos(angle), np.sin(angle)
        about_z = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        return PinLoads(self.case, self.surfaces, self.forces @ about_z)


@dataclass(frozen=True)
class UnitFields:
    """Fields per newton of each load: displacement (N, 3, L) in m/N, stress (N, 6, L) in Pa/N.

    loads: the L (surface, axis) pairs. support: (L, 3) force of the clamps per newton, from the
    residual of the system; minus the load when all is well.
    """

    space: Discretisation
    surface: Surface
    loads: tuple[tuple[str, int], ...]
    displacement: Floats
    stress: Floats
    support: Floats

    def coefficients(self, loads: PinLoads) -> Floats:
        """Newtons of each unit load at each instant, (T, L)."""
        out = np.zeros((len(loads.forces), len(self.loads)))
        for k, (name, axis) in enumerate(self.loads):
            if name in loads.surfaces:
                out[:, k] = loads.forces[:, loads.surfaces.index(name), axis]
        return out


class SolidModel:
    """A pin on one mesh, held at surfaces (by name).

    Without any, every load's resultant and couple are taken up by forces spread over all nodes,
    which cancel where loads are in balance, and six unknowns are held against rigid motions.

    Leaves out: plasticity, contact and clearance (loads are tractions), the pin's own weight and
    inertia, moments at connections.
    """

    def __init__(
        self, pin: Pin, solid: SolidMesh, material: Material, clamps: tuple[str, ...]
    ) -> None:
        self.pin, self.material, self.clamps = pin, material, clamps
        self.space = Discretisation(solid.mesh)

    @property
    def unknowns(self) -> int:
        """Displacement components, held ones included."""
        return self.space.unknowns

    @cached_property
    def stiffness(self) -> sp.csr_matrix:
        """N/m."""
        return self.space.stiffness(self.material)

    @cached_property
    def fixed(self) -> Ints:
        """Held unknowns."""
        if self.clamps:
            nodes = held_nodes(self.space, self.clamps)
            return (3 * nodes[:, None] + np.arange(3)).ravel()
        return _isostatic(self.space.nodes)

    def solve(self, loads: tuple[tuple[str, int], ...]) -> UnitFields:
        """Unit fields for (surface, axis) pairs.

        Raises: SolveError when the pin is not held or a check fails.
        """
        boundary = surface(self.space)
        shares, areas = {}, {}
        for name in dict.fromkeys(name for name, _ in loads):
            shares[name], areas[name] = uniform_share(self.space, boundary, name)
            self._check_share(name, shares[name], areas[name])
        F = np.zeros((self.unknowns, len(loads)))
        for k, (name, axis) in enumerate(loads):
            F[axis::3, k] = shares[name]
        u, support = self._displace(F)
        n_nodes = self.unknowns // 3
        displacement = u.reshape(n_nodes, 3, -1)
        traction = np.zeros((len(boundary.facets), 3, len(loads)))
        for k, (name, axis) in enumerate(loads):
            on = np.isin(boundary.facets, self.space.mesh.boundaries[name])
            traction[on, axis, k] = 1.0 / areas[name]
        held = np.zeros(len(boundary.facets), dtype=bool)
        for name in self.clamps:
            held |= np.isin(boundary.facets, self.space.mesh.boundaries[name])
        stress = nodal_stress(self.space, self.material, displacement)
        stress = with_known_traction(stress, boundary, traction, held)
        return UnitFields(self.space, boundary, loads, displacement, stress, support)

    def _displace(self, F: Floats) -> tuple[Floats, Floats]:
        """Displacements (n, L) under F (n, L), and the clamps' resultant force (L, 3)."""
        free = np.setdiff1d(np.arange(self.unknowns), self.fixed)
        K = self.stiffness
        if not self.clamps:
            rigid, _ = np.linalg.qr(rigid_modes(self.space.nodes))
            F = F - rigid @ (rigid.T @ F)
        u = np.zeros_like(F)
        u[free] = factorize(K[free][:, free], free // 3)(F[free])
        reaction = np.zeros_like(F)
        reaction[self.fixed] = K[self.fixed] @ u - F[self.fixed]
        support = reaction.reshape(-1, 3, F.shape[1]).sum(axis=0).T
        applied = F.reshape(-1, 3, F.shape[1]).sum(axis=0).T
        lost = float(np.abs(support + applied).max())
        if self.clamps and lost > 1e-6:
            raise SolveError(
                f"pin {self.pin.name}: clamps and loads differ by {lost:.1e} of the load; "
                "the solution is not in equilibrium"
            )
        return u, support

    def _check_share(self, name: str, share: Floats, area: float) -> None:
        if abs(share.sum() - 1.0) > RESULTANT_TOLERANCE:
            raise SolveError(f"pin {self.pin.name}: the load on {name} does not sum to its force")
        exact = next((b.area for b in self.pin.bands if b.name == name), area)
        if abs(area / exact - 1.0) > 0.01:
            raise SolveError(
                f"pin {self.pin.name}: surface {name} has {area / exact:.3f} of its true area "
                "in the mesh; make the mesh finer"
            )


def rigid_modes(nodes: Floats) -> Floats:
    """Three translations and three rotations (3 N, 6) about the nodes' centre, lengths scaled."""
    x = nodes - nodes.mean(axis=0)
    x = x / np.abs(x).max()
    modes = np.zeros((len(x), 3, 6))
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        modes[:, a, a] = 1.0
        modes[:, b, 3 + a], modes[:, c, 3 + a] = -x[:, c], x[:, b]
    return modes.reshape(-1, 6)


def _isostatic(nodes: Floats) -> Ints:
    """Six unknowns that prevent the rigid motions, chosen well apart by a pivoted QR."""
    _, _, pivot = scipy.linalg.qr(rigid_modes(nodes).T, mode="economic", pivoting=True)
    return np.sort(pivot[:6]).astype(np.int64)


def out_of_balance(pin: Pin, loads: PinLoads) -> tuple[float, float]:
    """Largest resultant force and couple (over the pin's length) as parts of the largest force.

    A pin that nothing holds can only be analysed when both vanish.
    """
    z = np.array([pin.band(name).middle for name in loads.surfaces])
    largest = float(np.abs(loads.forces).max()) or 1.0
    force = np.abs(loads.forces.sum(axis=1)).max()
    couple = np.abs(np.einsum("tca,c->ta", loads.forces[..., :2], z)).max()
    return float(force) / largest, float(couple) / (largest * pin.length)

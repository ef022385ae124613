"""The solid model: a pin in quadratic tetrahedra under unit loads on its bands.

One factorisation per mesh; each band gets a unit force along each axis, spread as a uniform
traction, and a unit moment about each axis where any acts. The stress at any instant of any case is
a linear combination of these unit fields.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray

from fea.elasticity import Discretisation
from fea.linear import SolveError, factorize
from fea.material import Material
from fea.stress import nodal_stress, with_known_traction
from fea.surface import Patch, Surface, held_nodes, resultants, surface
from geometry import Pin
from geometry.solid_mesh import SolidMesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

UnitLoad = tuple[str, int]  # surface; axis: 0, 1, 2 a force along, 3, 4, 5 a moment about x, y, z

RESULTANT_TOLERANCE = 1e-10


@dataclass(frozen=True)
class PinLoads:
    """Loads on one pin in one case, in the pin's axes: at each surface (by name) a force at its
    middle, forces (T, C, 3) N, and moments (T, C, 3) N m, or what broadcasts to that shape.
    """

    case: str
    surfaces: tuple[str, ...]
    forces: Floats
    moments: Floats = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        moments = np.broadcast_to(self.moments, self.forces.shape)
        object.__setattr__(self, "moments", moments)

    @property
    def components(self) -> Floats:
        """Forces and moments, (T, C, 6)."""
        return np.concatenate([self.forces, self.moments], axis=2)

    @property
    def units(self) -> tuple[UnitLoad, ...]:
        """The unit loads of which these are made, whichever way they are turned about z."""
        acts = np.any(self.components, axis=0)
        for x, y in ((0, 1), (3, 4)):
            acts[:, x] = acts[:, y] = acts[:, x] | acts[:, y]
        return tuple((self.surfaces[c], int(axis)) for c, axis in np.argwhere(acts))

    def turned(self, angle: float) -> PinLoads:
        """The same loads, all turned about the pin's axis by `angle` (rad)."""
        c, s = np.cos(angle), np.sin(angle)
        about_z = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        return PinLoads(self.case, self.surfaces, self.forces @ about_z, self.moments @ about_z)


@dataclass(frozen=True)
class UnitFields:
    """Fields per newton, or newton metre, of each of L loads: displacement (N, 3, L) in m, stress
    (N, 6, L) in Pa.

    support: (6, L) force and moment of the clamps about (0, 0, 0), from the residual of the system;
    minus those of the load when all is well.
    """

    space: Discretisation
    surface: Surface
    loads: tuple[UnitLoad, ...]
    displacement: Floats
    stress: Floats
    support: Floats

    def coefficients(self, loads: PinLoads) -> Floats:
        """Newtons or newton metres of each unit load at each instant, (T, L).

        Raises: ValueError when there is no field for a part of the loads.
        """
        missing = set(loads.units) - set(self.loads)
        if missing:
            raise ValueError(f"case {loads.case}: no unit fields for {sorted(missing)}")
        out = np.zeros((len(loads.forces), len(self.loads)))
        for k, (name, axis) in enumerate(self.loads):
            if name in loads.surfaces:
                out[:, k] = loads.components[:, loads.surfaces.index(name), axis]
        return out


class SolidModel:
    """A pin on one mesh, held at surfaces (by name).

    Without any, every load's resultant and couple are taken up by forces spread over all nodes,
    which cancel where loads are in balance, and six unknowns are held against rigid motions.

    Leaves out: plasticity, contact and clearance (loads are tractions), the pin's own weight and
    inertia.
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

    def solve(self, loads: tuple[UnitLoad, ...]) -> UnitFields:
        """Unit fields for (surface, axis) pairs; moments act on bands only.

        Raises: SolveError when the pin is not held or a check fails.
        """
        boundary = surface(self.space)
        traction = np.zeros((*boundary.normals.shape, len(loads)))
        F = np.zeros((*self.space.nodes.shape, len(loads)))
        for name in dict.fromkeys(name for name, _ in loads):
            patch = Patch(self.space, boundary, name)
            self._check_area(name, patch.area)
            here = [(k, axis) for k, (other, axis) in enumerate(loads) if other == name]
            units = patch.forces()
            if any(axis > 2 for _, axis in here):
                units = np.concatenate([units, patch.moments(self.pin.band(name).middle)], axis=3)
            for k, axis in here:
                traction[patch.rows, ..., k] = units[..., axis]
            F[..., [k for k, _ in here]] = patch.nodal_forces(units[..., [a for _, a in here]])
        self._check_resultants(loads, F)
        displacement, support = self._displace(F)
        held = np.zeros(len(boundary.facets), dtype=bool)
        for name in self.clamps:
            held |= np.isin(boundary.facets, self.space.mesh.boundaries[name])
        stress = nodal_stress(self.space, self.material, displacement)
        stress = with_known_traction(stress, boundary, traction, held)
        return UnitFields(self.space, boundary, loads, displacement, stress, support)

    def _displace(self, F: Floats) -> tuple[Floats, Floats]:
        """Displacements (N, 3, L) under nodal forces F (N, 3, L), and the clamps' force and moment
        (6, L).
        """
        shape, F = F.shape, F.reshape(self.unknowns, -1)
        free = np.setdiff1d(np.arange(self.unknowns), self.fixed)
        K = self.stiffness
        if not self.clamps:
            rigid, _ = np.linalg.qr(rigid_modes(self.space.nodes))
            F = F - rigid @ (rigid.T @ F)
        u = np.zeros_like(F)
        u[free] = factorize(K[free][:, free], free // 3)(F[free])
        reaction = np.zeros_like(F)
        reaction[self.fixed] = K[self.fixed] @ u - F[self.fixed]
        F = F.reshape(shape)
        support = resultants(self.space.nodes, reaction.reshape(shape))
        lost = self._part(support + resultants(self.space.nodes, F), F).max()
        if not lost < 1e-6:
            raise SolveError(
                f"pin {self.pin.name}: clamps and loads differ by {lost:.1e} of the load; "
                "the solution is not in equilibrium"
            )
        return u.reshape(shape), support

    def _part(self, resultant: Floats, F: Floats) -> Floats:
        """Forces and moments (6, L) as parts of the size of the nodal forces F (N, 3, L), the
        moments also of the pin's length.
        """
        arm = np.repeat([1.0, self.pin.length], 3)
        return np.asarray(np.abs(resultant) / arm[:, None] / np.abs(F).sum(axis=(0, 1)))

    def _check_resultants(self, loads: tuple[UnitLoad, ...], F: Floats) -> None:
        found = resultants(self.space.nodes, F)
        wrong = self._part(found - np.eye(6)[:, [axis for _, axis in loads]], F)
        for k, (name, axis) in enumerate(loads):
            # a force also has a moment; a moment has no force, so it is the same about any point
            if not wrong[: 3 if axis < 3 else 6, k].max() < RESULTANT_TOLERANCE:
                what = "force" if axis < 3 else "moment"
                raise SolveError(
                    f"pin {self.pin.name}: the load on {name} does not sum to its {what}"
                )

    def _check_area(self, name: str, area: float) -> None:
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
    """Largest resultant force and couple (over the pin's length) as parts of the largest load: a
    force, or a moment over the pin's length.

    A pin that nothing holds can only be analysed when both vanish.
    """
    z = np.array([pin.band(name).middle for name in loads.surfaces])
    arms = z[:, None] * [0.0, 0.0, 1.0]
    couples = (np.cross(arms, loads.forces) + loads.moments) / pin.length
    largest = float(max(np.abs(loads.forces).max(), np.abs(loads.moments).max() / pin.length))
    force, couple = (np.abs(x.sum(axis=1)).max() for x in (loads.forces, couples))
    return float(force) / (largest or 1.0), float(couple) / (largest or 1.0)

"""The response of a lug to pressures on the wall of its bore: plane stress, by finite elements.

Unit loads are pressures cos n theta and sin n theta on the bore, each with the reaction of the held
end of the shank, and the misfit of a bushing. The nodes of the bore are equally spaced, so their
displacements are differentiated as Fourier series. Together with the pressure they give the hoop
stress, without extrapolating stress from elements,

    hoop = E e_tt - nu p,    e_tt = (u_r + du_t / dtheta) / r.

At the interface of a bushing the traction follows from the forces between the nodes of both parts.

All quantities are in units of the bore's radius and of the lug's modulus; stress is per pressure.
Plane stress is exact at the faces of a lug, and on the safe side of yield inside it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from fea.core.linear_solver import ConstrainedSystem
from geometry.mesh.lug_mesh import LugMesh, lug_mesh
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats, Ints
from pinbase.memo import Memo

# Highest harmonic of pressure; higher ones change the hoop stress by minus the pressure.
HARMONICS = 16
# Elements, and sectors of contact, around the bore; docs/measured has results with fewer and more.
USUAL_AROUND = 96


@dataclass(frozen=True)
class Elasticity:
    """The elastic constants in plane stress; the modulus of a bushing is relative to the lug's."""

    poisson_ratio: float
    bushing_modulus: float = 1.0
    bushing_poisson_ratio: float = 0.3


@dataclass(frozen=True)
class Wall:
    """The stresses of a cylindrical wall under K unit loads, at points around it.

    angles: (P,) rad, equally spaced from 0 on.
    hoop, radial, shear: (K, P) stress per pressure; for the last load, the misfit, stress per
    strain and per modulus of the lug.
    """

    angles: Floats
    hoop: Floats
    radial: Floats
    shear: Floats

    def at(self, amounts: Floats) -> Wall:
        """The stresses (..., P) under amounts (..., K) of the unit loads."""
        return Wall(self.angles, *(amounts @ x for x in (self.hoop, self.radial, self.shear)))


@dataclass(frozen=True)
class PlaneFields:
    """A lug under the unit pressures of harmonics 0 to HARMONICS, cosines then sines, and a misfit.

    flexibility: (2 H + 1, 2 H + 1) the Fourier coefficients of u_r (rows) under each pressure, in
    units of the bore's radius over the lug's modulus.
    bore: the wall on which the pin bears.
    hole: the wall of the lug about a bushing; None without one.
    """

    flexibility: Floats
    bore: Wall
    hole: Wall | None


def plane_fields(
    outline: LugOutline, elastic: Elasticity, around: int = USUAL_AROUND, memo: Memo | None = None
) -> PlaneFields:
    """The fields of a lug under unit loads.

    around: number of elements around the bore.
    memo: a store of lugs that are solved already.

    Raises: MeshError, SolveError.
    """
    fields: PlaneFields = (memo or Memo()).get(
        ("plane lug", outline, elastic, around),
        lambda: _Plane(outline, elastic, lug_mesh(outline, around)).fields(),
    )
    return fields


def waves(angles: Floats, highest: int = HARMONICS) -> Floats:
    """The pressures (2 H + 1, P) of the unit loads at angles (P,), rad."""
    turns = np.outer(np.arange(highest + 1), angles)
    return np.concatenate([np.cos(turns), np.sin(turns[1:])])


def _coefficients(values: Floats) -> Floats:
    """The Fourier coefficients (.., 2 H + 1) of values (.., P) at equally spaced angles."""
    P = values.shape[-1]
    both = 2.0 / P * np.fft.rfft(values, axis=-1)[..., : HARMONICS + 1]
    cos, sin = both.real, -both.imag[..., 1:]
    cos[..., 0] /= 2.0
    return np.concatenate([cos, sin], axis=-1)


def _derivative(values: Floats) -> Floats:
    """The derivative of values (.., P) at equally spaced angles with respect to the angle."""
    P = values.shape[-1]
    spectrum = np.fft.rfft(values, axis=-1)
    spectrum[..., 2 * HARMONICS + 1 :] = 0.0  # noise of the mesh: loads and response are smooth
    return np.asarray(np.fft.irfft(1j * np.arange(P // 2 + 1) * spectrum, P, axis=-1))


class _Plane:
    """The finite elements of one lug."""

    def __init__(self, outline: LugOutline, elastic: Elasticity, mesh: LugMesh) -> None:
        from skfem import Basis, ElementTriP2, ElementVector, MeshTri2

        self.outline, self.elastic = outline, elastic
        tri = MeshTri2(np.ascontiguousarray(mesh.nodes.T), np.ascontiguousarray(mesh.elements.T))
        self.element = ElementVector(ElementTriP2())
        self.mesh, self.basis = tri, Basis(tri, self.element, intorder=4)
        self.bushing = mesh.in_bushing
        x, y = self.basis.doflocs
        self.radius, self.angle = np.hypot(x, y), np.arctan2(y, x)

    def fields(self) -> PlaneFields:
        interface = self.outline.interface
        bore, K = self._circle(1.0), self._stiffness()
        loads = self._loads()
        u = self._displaced(K, loads)
        shape = waves(self.angle[bore[0]])
        pressure = np.concatenate([shape, np.zeros((1, shape.shape[1]))])
        made_of = self._constants(bushing=interface is not None)
        wall = self._wall(bore, 1.0, u, -pressure, np.zeros_like(pressure), made_of)
        hole = None
        if interface is not None:
            hole = self._hole(loads, u, interface / self.outline.bore)
            # The free expansion of the bushing under its misfit causes no stress.
            wall.hoop[-1] -= made_of[0]
        return PlaneFields(_coefficients(self._polar(bore, u)[0])[:-1].T, wall, hole)

    def _constants(self, bushing: bool) -> tuple[float, float]:
        e = self.elastic
        return (e.bushing_modulus, e.bushing_poisson_ratio) if bushing else (1.0, e.poisson_ratio)

    def _stiffness(self, only_bushing: bool = False) -> sp.csr_matrix:
        from skfem import Basis, BilinearForm
        from skfem.helpers import ddot, eye, sym_grad, trace

        total: Any = None
        for bushing in (True, False):
            elements = np.flatnonzero(self.bushing == bushing)
            if not len(elements) or (only_bushing and not bushing):
                continue
            E, nu = self._constants(bushing and self.outline.interface is not None)
            mu, lam = E / (2.0 * (1.0 + nu)), E * nu / (1.0 - nu * nu)

            @BilinearForm
            def work(u: Any, v: Any, _: Any, lam: float = lam, mu: float = mu) -> Any:
                strain = sym_grad(u)
                return ddot(lam * eye(trace(strain), 2) + 2.0 * mu * strain, sym_grad(v))

            part = work.assemble(Basis(self.mesh, self.element, elements=elements, intorder=4))
            total = part if total is None else total + part
        return sp.csr_matrix(total)

    def _loads(self) -> Floats:
        """The forces (unknowns, 2 H + 2) of the unit pressures and of the misfit.

        Those on a ring are balanced by a reaction on its outer surface (`_held`).
        """
        from skfem import FacetBasis, LinearForm

        on_bore = self.mesh.facets_satisfying(
            lambda x: np.abs(np.hypot(*x) - 1.0) < 1e-2 / 3.0, boundaries_only=True
        )
        basis = FacetBasis(self.mesh, self.element, facets=on_bore, intorder=6)
        columns = []
        for k in range(2 * HARMONICS + 1):
            n = k if k <= HARMONICS else k - HARMONICS
            wave = np.cos if k <= HARMONICS else np.sin

            @LinearForm
            def pushed(v: Any, w: Any, n: int = n, wave: Any = wave) -> Any:
                outwards = w.x / np.hypot(*w.x)
                return wave(n * np.arctan2(w.x[1], w.x[0])) * (outwards * v).sum(axis=0)

            columns.append(pushed.assemble(basis))
        loads = np.stack([*columns, self._misfit()], axis=1)
        return self._held(loads) if self.outline.shape == "ring" else loads

    def _misfit(self) -> Floats:
        """The forces of a bushing that would expand by a unit strain if it were free."""
        from skfem import Basis, LinearForm
        from skfem.helpers import div

        if self.outline.interface is None:
            return np.zeros(self.basis.N)
        E, nu = self._constants(bushing=True)

        @LinearForm
        def grows(v: Any, _: Any) -> Any:
            return E / (1.0 - nu) * div(v)

        elements = np.flatnonzero(self.bushing)
        return np.asarray(
            grows.assemble(Basis(self.mesh, self.element, elements=elements, intorder=4))
        )

    def _held(self, loads: Floats) -> Floats:
        """The loads on a ring, with the reaction on its outer surface, of constant direction."""
        from skfem import FacetBasis, LinearForm

        head = self.outline.head / self.outline.bore
        outer = self.mesh.facets_satisfying(
            lambda x: np.hypot(*x) > 0.5 * (1.0 + head), boundaries_only=True
        )
        basis = FacetBasis(self.mesh, self.element, facets=outer, intorder=6)
        for axis in (0, 1):

            @LinearForm
            def along(v: Any, _: Any, axis: int = axis) -> Any:
                return v[axis]

            against, one = along.assemble(basis), np.zeros(self.basis.N)
            one[self._components(axis)] = 1.0
            loads = loads - np.outer(against, one @ loads / (one @ against))
        return np.asarray(loads)

    def _components(self, axis: int) -> Ints:
        """The unknowns of the displacements along an axis."""
        dofs = self.basis.dofs
        return np.concatenate([dofs.nodal_dofs[axis], dofs.facet_dofs[axis]]).astype(np.int64)

    def _displaced(self, K: sp.csr_matrix, loads: Floats) -> Floats:
        """The displacements (unknowns, K) under loads (unknowns, K)."""
        free = np.ones(self.basis.N)
        x = self.basis.doflocs[0]
        # A ring is held at three unknowns, which need no reaction since its loads are balanced.
        if self.outline.shape == "ring":
            outer = self._circle(self.outline.head / self.outline.bore)
            free[[outer[0, 0], outer[1, 0], outer[1, outer.shape[1] // 2]]] = 0.0
        else:
            free[x > (1.0 - 1e-9) * x.max()] = 0.0
        return ConstrainedSystem(K).solve(K, free, loads)

    def _circle(self, radius: float) -> Ints:
        """The unknowns along x and y (2, P) of the nodes on a circle, in the order of the angle."""
        near = np.abs(self.radius - radius) < 1e-6 * radius
        rows = []
        for axis in (0, 1):
            here = self._components(axis)
            here = here[near[here]]
            turn = np.mod(self.angle[here] + 1e-9, 2.0 * np.pi)
            rows.append(here[np.argsort(turn)])
        return np.stack(rows)

    def _polar(self, circle: Ints, values: Floats) -> tuple[Floats, Floats]:
        """The components along r and theta, (K, P) each, of values (unknowns, K) on a circle."""
        angle = self.angle[circle[0]]
        x, y = values[circle[0]].T, values[circle[1]].T
        return x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)

    def _wall(
        self,
        circle: Ints,
        radius: float,
        u: Floats,
        radial: Floats,
        shear: Floats,
        made_of: tuple[float, float],
    ) -> Wall:
        u_r, u_t = self._polar(circle, u)
        stretch = (u_r + _derivative(u_t)) / radius
        E, nu = made_of
        angles = np.mod(self.angle[circle[0]] + 1e-9, 2.0 * np.pi)
        hoop = E * stretch + nu * radial
        return Wall(angles, hoop, radial, shear)

    def _hole(self, loads: Floats, u: Floats, radius: float) -> Wall:
        """The wall of the lug about its bushing."""
        circle = self._circle(radius)
        # The lug reacts the nodal forces that the bushing's elements leave unbalanced at the
        # interface.
        force = loads - self._stiffness(only_bushing=True) @ u
        pushed = self._polar(circle, force)
        traction = [_consistent_traction(x, radius) for x in pushed]
        return self._wall(
            circle, radius, u, -traction[0], -traction[1], self._constants(bushing=False)
        )


def _consistent_traction(forces: Floats, radius: float) -> Floats:
    """The traction (K, P) whose quadratic interpolation has the nodal forces (K, P).

    The P nodes are corners and middles of elements in turn, beginning with a corner.
    """
    P = forces.shape[1]
    size = 4.0 * np.pi * radius / P  # of an element
    mass = np.zeros((P, P))
    local = size / 30.0 * np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]])
    for first in range(0, P, 2):
        rows = np.array([first, first + 1, first + 2]) % P
        mass[np.ix_(rows, rows)] += local
    return np.asarray(np.linalg.solve(mass, forces.T).T)

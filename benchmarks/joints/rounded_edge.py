"""A lug with rounded bore edges, shrunk on a pin, by independent axisymmetric finite elements.

The elements are bilinear quadrilaterals with facing nodes in contact and no friction. They share
only the problem with the rings of fea.support.contact, for which the rounding is a gap of a lug
with sharp edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from skfem import Basis, BilinearForm, ElementQuad1, ElementVector, MeshQuad
from skfem.helpers import ddot, sym_grad, trace

from fea.core.material import Material
from pinbase.arrays import Floats

GROWTH = 1.1  # ratio of successive elements, away from the end of contact
FINE = 0.1  # of the edge's radius, on both sides of the start of rounding; elements are equal there


@dataclass(frozen=True)
class ShrinkFit:
    """A shrink fit; lengths in m.

    length: of the lug. radius: of its edges. outer: its diameter.
    interference: of the diameters.
    over: length of the pin beyond the lug.
    """

    diameter: float
    length: float
    radius: float
    outer: float
    interference: float
    over: float


@dataclass(frozen=True)
class EdgeStress:
    """The largest pressure, and the largest von Mises stress of the pin near the edge, Pa."""

    pressure: float
    von_mises: float


def edge_stress(fit: ShrinkFit, pin: Material, lug: Material, element: float) -> EdgeStress:
    """Return the stress at the edge, from one half of the fit, mirrored at z = 0.

    element: the smallest one over the radius of the edge.
    """
    z, gap, of_lug = _lug_grid(fit, element)
    on_pin = _pin_grid(fit, z, element)
    bodies = _Body(on_pin, pin, len(z), axis=True), _Body(of_lug, lug, len(z))
    soft = bodies[0].softness + bodies[1].softness
    gap = gap - fit.interference / 2.0
    force = _contact(soft, gap)
    share = np.zeros(len(z))
    share[:-1] += np.diff(z) / 2.0
    share[1:] += np.diff(z) / 2.0
    pressure = force / (np.pi * fit.diameter * share)
    near = fit.length / 2.0 - fit.radius * (1.0 + FINE)
    return EdgeStress(float(pressure.max()), bodies[0].von_mises(force, near))


def _contact(soft: Floats, gap: Floats) -> Floats:
    """Return the contact forces by an active set, N: no force pulls, and no gap is negative.

    soft: (N, N) compliance, m/N. gap: (N,), m, negative for interference.
    Raises: RuntimeError if the active set does not settle.
    """
    active = gap < 0.0
    for _ in range(100):
        force = np.zeros(len(gap))
        force[active] = np.linalg.solve(soft[np.ix_(active, active)], -gap[active])
        now = np.where(active, force > 0.0, gap + soft @ force < 0.0)
        if (now == active).all():
            return force
        active = now
    raise RuntimeError("contact does not settle")


def _growing(first: float, total: float) -> Floats:
    """Return lengths that grow from about `first` and add up to `total`."""
    count = max(1, int(np.log(total / first * (GROWTH - 1.0) + 1.0) / np.log(GROWTH)))
    parts = first * GROWTH ** np.arange(count)
    return np.asarray(parts * (total / parts.sum()))


def _lug_grid(fit: ShrinkFit, element: float) -> tuple[Floats, Floats, Floats]:
    """Return the z of the lug's nodes that face the pin, their gaps by the rounding, and all nodes
    (2, Z, R).

    The grid is a rectangle, one corner of which follows the quarter circle of the rounding.
    """
    r, bore, outer, half = fit.radius, fit.diameter / 2.0, fit.outer / 2.0, fit.length / 2.0
    first, flat = element * r, half - r
    even = np.full(round(FINE / element), first)
    facing = [_growing(first, flat - even.sum())[::-1], even, even]
    z = np.concatenate([[0.0], np.cumsum(np.concatenate(facing))])
    gap = r - np.sqrt(r * r - np.maximum(z - flat, 0.0) ** 2)
    start = float(np.arcsin(FINE))
    turn = start + np.cumsum(_growing(first, r * (np.pi / 4.0 - start))) / r
    inner = np.stack([
        bore + np.concatenate([gap, r - r * np.cos(turn)]),
        np.concatenate([z, flat + r * np.sin(turn)]),
    ])  # fmt: skip
    rising = np.concatenate([[0.0], np.cumsum(_growing(first, outer - bore))]) / (outer - bore)
    along = rising * (r * np.pi / 4.0 + outer - bore - r)  # the face, from half the circle on
    angle = np.minimum(np.pi / 4.0 + along / r, np.pi / 2.0)
    face = np.stack([
        bore + r - r * np.cos(angle) + np.maximum(along - r * np.pi / 4.0, 0.0),
        flat + r * np.sin(angle),
    ])  # fmt: skip
    plane = np.stack([bore + rising * (outer - bore), np.zeros(len(rising))])
    outside = np.stack([np.full(inner.shape[1], outer), inner[1] / inner[1, -1] * half])
    part = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(inner, axis=1)))])
    return z, gap, _between((inner, outside), (plane, face), part / part[-1], rising)


def _between(
    along: tuple[Floats, Floats], across: tuple[Floats, Floats], part: Floats, rising: Floats
) -> Floats:
    """Return the nodes (2, Z, R) between four sides, by transfinite interpolation."""
    u, v = part[None, :, None], rising[None, None, :]
    (low, high), (first, last) = along, across
    out = (1.0 - v) * low[:, :, None] + v * high[:, :, None]
    out = out + (1.0 - u) * first[:, None, :] + u * last[:, None, :]
    for side, weight in ((low, 1.0 - v), (high, v)):
        out = out - weight * ((1.0 - u) * side[:, :1, None] + u * side[:, -1:, None])
    return np.asarray(out)


def _pin_grid(fit: ShrinkFit, facing: Floats, element: float) -> Floats:
    """Return all nodes (2, Z, R) of the pin, from its surface inwards."""
    first, R = element * fit.radius, fit.diameter / 2.0
    rest = _growing(first, fit.length / 2.0 + fit.over - facing[-1])
    z = np.concatenate([facing, facing[-1] + np.cumsum(rest)])
    r = R - np.concatenate([[0.0], np.cumsum(_growing(first, R))])
    r[-1] = 0.0
    return np.stack(np.meshgrid(r, z))


class _Body:
    """A body on a grid of nodes (2, Z, R); the first `facing` nodes of column 0 are in contact."""

    def __init__(self, grid: Floats, material: Material, facing: int, axis: bool = False) -> None:
        _, rows, columns = grid.shape
        i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
        a = (i * columns + j).ravel()
        x = grid.reshape(2, -1)
        mesh = MeshQuad(x, np.stack([a, a + 1, a + columns + 1, a + columns]), validate=False)
        self.basis = Basis(mesh, ElementVector(ElementQuad1()), intorder=4)
        self.lame = material.lame
        stiffness = self._stiffness()
        radial, axial = self.basis.nodal_dofs
        held = axial[np.abs(x[1]) < 1e-12]
        if axis:
            held = np.union1d(held, radial[x[0] < 1e-12])
        self.free = np.setdiff1d(np.arange(stiffness.shape[0]), held)
        rows_of = np.searchsorted(self.free, radial[np.arange(facing) * columns])
        one = np.zeros((len(self.free), facing))
        one[rows_of, np.arange(facing)] = 1.0
        self.moved = spla.splu(stiffness[self.free][:, self.free].tocsc()).solve(one)
        self.softness = self.moved[rows_of]  # same sign for force and displacement

    def _stiffness(self) -> sp.csr_matrix:
        shear, rest = self.lame[1], self.lame[0]

        @BilinearForm
        def work(u, v, w):  # type: ignore[no-untyped-def]
            e, f, r = sym_grad(u), sym_grad(v), w.x[0]
            et, ft = u[0] / r, v[0] / r
            volume = rest * (trace(e) + et) * (trace(f) + ft)
            return 2.0 * np.pi * r * (volume + 2.0 * shear * (ddot(e, f) + et * ft))

        return sp.csr_matrix(work.assemble(self.basis))

    def von_mises(self, force: Floats, near: float) -> float:
        """Return the largest von Mises stress, Pa, at integration points beyond z = near, under
        inward forces.
        """
        u = np.zeros(self.basis.N)
        u[self.free] = -self.moved @ force
        field = self.basis.interpolate(u)
        (rr, rz), (_, zz) = (row for row in np.asarray(sym_grad(field)))
        r, z = np.asarray(self.basis.global_coordinates())
        tt = np.asarray(field)[0] / r
        shear = self.lame[1]
        square = (rr - tt) ** 2 + (tt - zz) ** 2 + (zz - rr) ** 2 + 6.0 * rz**2
        return float(2.0 * shear * np.sqrt(0.5 * square[z > near].max()))

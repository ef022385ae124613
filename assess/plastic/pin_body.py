"""A pin as an elastic-plastic body of hexahedra: the modelled sector, its supports, its loads.

Elements have 20 nodes and 2 x 2 x 2 quadrature points, which avoids volumetric locking in plastic
flow (`python -m benchmarks limit_load` compares them with tetrahedra).

The size of the modelled sector depends on the loads. If all loads are symmetric about one plane,
half of the pin is enough. If all harmonics are odd, a rotation by half a turn changes the sign of
the loads and of the whole solution, because yield is the same in tension and compression: again
half of the pin is enough. If both apply, a quarter is enough.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from skfem import ElementHexS2

from assess.plastic.body import Elements, FlowingBody, Ties
from assess.plastic.flow import FlowRule
from assess.plastic.mechanism import RefinedElements
from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Loads, UnitLoad
from fea.core.tractions import Traction, closing_tractions, tractions_of
from fea.solid.model import rigid_modes
from fea.solid.nodal_loads import components
from geometry import Pin
from geometry.mesh.hexahedra import HexMesh, HexSize, hexahedra
from pinbase.arrays import Floats, Ints
from pinbase.grouped import grouped

OUT_OF_PLANE_TOLERANCE = 1e-6  # relative to the largest load of its kind: smaller loads are zero

Acting = tuple[tuple[UnitLoad, int, float], ...]  # unit loads with their phase and amount
Acted = tuple[float, Traction, int, int]  # amount, traction, harmonic and phase


@dataclass(frozen=True)
class Sector:
    """The modelled sector of a pin.

    quarters: number of modelled quarters, 1, 2 or 4.
    mirror: whether the solution is symmetric about the plane y = 0.
    odd: whether the solution changes sign under rotation by half a turn.
    """

    quarters: int
    mirror: bool
    odd: bool


@dataclass(frozen=True)
class PinBody:
    """The modelled sector of a pin as an elastic-plastic body.

    forces: (U,) N, on the free unknowns.
    mesh, sector: the mesh and the sector from which the body was made.
    """

    body: FlowingBody
    forces: Floats
    mesh: HexMesh
    sector: Sector


def plane_of(loads: Loads, instant: int) -> float:
    """Return the direction (rad from x) of the largest transverse load; 0 without any."""
    vectors = [both[instant] for load, both in loads.coefficients().items() if load.n == 1]
    if not vectors:
        return 0.0
    sizes = np.array([np.linalg.norm(v) for v in vectors])
    x, y = vectors[int(sizes.argmax())]
    return math.atan2(y, x)


def sector_of(acting: Acting) -> Sector:
    """Return the smallest sector of the pin that the symmetry of its loads allows."""
    largest: dict[str, float] = {}
    for load, _, amount in acting:
        largest[load.kind] = max(largest.get(load.kind, 0.0), abs(amount))
    some = [
        (load, p)
        for load, p, amount in acting
        if abs(amount) > OUT_OF_PLANE_TOLERANCE * largest[load.kind]
    ]
    mirror = all(p == 0 for _, p in some)
    odd = all(load.n % 2 for load, _ in some)
    return Sector(1 if mirror and odd else 2 if mirror or odd else 4, mirror, odd)


def acting_at(loads: Loads, instant: int, angle: float = 0.0) -> Acting:
    """Return the unit loads that act at an instant, rotated about the axis by an angle (rad)."""
    out = []
    for load, both in loads.coefficients().items():
        c, s = math.cos(load.n * angle), math.sin(load.n * angle)
        turned = np.array([[c, -s], [s, c]]) @ both[instant]
        out += [(load, phase, float(turned[phase])) for phase in load.phases]
    return tuple(out)


def pin_body(
    pin: Pin, rule: FlowRule, clamps: tuple[str, ...], acting: Acting, fineness: HexSize
) -> PinBody:
    """Return a pin under loads as an elastic-plastic body.

    clamps: the names of the clamped surfaces.
    acting: unit loads with phase and amount. Without clamps their small imbalance is closed as in
    fea.core.tractions.

    Raises: SolveError for a pin with neither clamps nor connections, and for a body load on a
    material without density.
    """
    sector = sector_of(acting)
    mesh = hexahedra(pin, fineness, sector.quarters)
    elements = hexahedral(mesh.nodes, mesh.elements)
    ties = _ties(mesh, sector)
    if clamps:
        nodes = _clamped(pin, mesh, clamps)
        unknown = ties.unknown[(3 * nodes[:, None] + np.arange(3)).ravel()]
        ties = ties.without(np.unique(unknown[unknown >= 0]))
    force = nodal_forces(pin, rule, mesh, elements, acting)
    if not clamps:
        force, ties = _balanced(pin, mesh, ties, force)
    unknowns = np.asarray(ties.matrix.T @ force.ravel())
    return PinBody(FlowingBody(elements, ties, rule), unknowns, mesh, sector)


def hexahedral(nodes: Floats, numbers: Ints, points: int = 2) -> Elements:
    """Return 20-node hexahedra with `points` quadrature points along each axis."""
    x, weight = _gauss(points)
    grid = np.stack(np.meshgrid(x, x, x, indexing="ij")).reshape(3, -1)
    weights = np.einsum("i,j,k->ijk", weight, weight, weight).ravel()
    local = np.stack([ElementHexS2().lbasis(grid, k)[1] for k in range(20)])
    jacobian = np.einsum("kaq,mkb->mqab", local, nodes[numbers], optimize=True)
    gradients = np.einsum("mqba,kaq->mqkb", np.linalg.inv(jacobian), local, optimize=True)
    return Elements(nodes, numbers, gradients, np.linalg.det(jacobian) * weights)


def refine(elements: Elements) -> RefinedElements:
    """Return the same hexahedra with three instead of two quadrature points along each axis."""
    three = _gauss(3)[0]
    grid = np.stack(np.meshgrid(three, three, three, indexing="ij"), axis=-1).reshape(-1, 3)
    return RefinedElements(hexahedral(elements.nodes, elements.numbers, 3), reading(grid))


def reading(local: Floats) -> Floats:
    """Return the matrix (P, 8) that extrapolates values at the eight quadrature points of an
    element to P places in it.

    local: (P, 3) local coordinates of the places, 0 to 1.
    """
    two = _gauss(2)[0]
    right = (local - two[0]) / (two[1] - two[0])
    first, second, third = np.stack([1.0 - right, right], axis=-1).swapaxes(0, 1)
    return np.asarray(np.einsum("pi,pj,pk->pijk", first, second, third).reshape(-1, 8))


def _gauss(points: int) -> tuple[Floats, Floats]:
    """Return the Gauss points and weights on the interval from 0 to 1."""
    x, weight = np.polynomial.legendre.leggauss(points)
    return (x + 1.0) / 2.0, weight / 2.0


def _ties(mesh: HexMesh, sector: Sector) -> Ties:
    """Return the ties of all nodes; those on the planes that bound a sector are constrained."""
    x, y, z = mesh.nodes.T
    near = 1e-9 * np.ptp(mesh.nodes)
    zero = np.zeros((len(x), 3), dtype=bool)
    unknown = np.arange(3 * len(x)).reshape(-1, 3)
    sign = np.ones((len(x), 3))
    # Nodes on the mirror plane y = 0 stay in it.
    if sector.mirror:
        zero[np.abs(y) < near, 1] = True
    # On x = 0 the half turn and the mirror together allow displacements along x only.
    if sector.odd and sector.mirror:
        zero[np.abs(x) < near, 1:] = True
    elif sector.odd:
        zero[np.hypot(x, y) < near, 2] = True
        cut = np.flatnonzero((np.abs(y) < near) & (np.abs(x) >= near))
        # Nodes of the plane y = 0 at -x and x are images of each other under half a turn: pair them
        # by r and z. With the change of sign, u_x and u_y are equal and u_z is opposite.
        left, right = cut[x[cut] < 0.0], cut[x[cut] > 0.0]
        order = [np.lexsort((np.round(np.abs(x[s]) / near / 10), np.round(z[s] / near / 10)))
                 for s in (left, right)]  # fmt: skip
        unknown[left[order[0]]] = unknown[right[order[1]]]
        sign[left, 2] = -1.0
    free = np.where(zero, -1, unknown).ravel()
    used, number = np.unique(free, return_inverse=True)
    return Ties(number - int(used[0] < 0), sign.ravel())


def _clamped(pin: Pin, mesh: HexMesh, clamps: tuple[str, ...]) -> Ints:
    """Return the numbers of the nodes on clamped surfaces."""
    nodes = []
    for name in clamps:
        if name in ("start", "end"):
            at = pin.ends[name == "end"]
            nodes.append(np.flatnonzero(np.abs(mesh.nodes[:, 2] - at) < pin.tolerance))
        else:
            nodes.append(np.unique(mesh.elements[_on(pin, mesh, name)][:, _OUTER_FACE_NODES]))
    return np.unique(np.concatenate(nodes))


_OUTER_FACE_NODES = np.flatnonzero(np.asarray(ElementHexS2().doflocs)[:, 0] == 1.0)


def _on(pin: Pin, mesh: HexMesh, name: str) -> Ints:
    """Return the numbers of the cells with a face on a band."""
    band = pin.band(name)
    cells = mesh.outside[_segment(pin, name)]
    z = mesh.nodes[mesh.elements[cells], 2].mean(axis=1)
    return np.asarray(cells[(z > band.z0) & (z < band.z1)])


def _segment(pin: Pin, name: str) -> int:
    """Return the number of the segment on whose outer surface a band lies.

    The face of a shoulder belongs to the thicker segment, and its force here enters over the whole
    outer surface of that segment.
    """
    band = pin.band(name)
    if band.name in pin.labels:
        return pin.labels.index(band.name)
    return next(i for i, b in enumerate(pin.bands) if (b.z0, b.z1) == (band.z0, band.z1))


def nodal_forces(
    pin: Pin, rule: FlowRule, mesh: HexMesh, elements: Elements, acting: Acting
) -> Floats:
    """Return the nodal forces (N, 3), N, of all loads."""
    out = _traction_forces(
        pin,
        mesh,
        ((amount, t, load.n, p) for load, p, amount in acting for t in tractions_of(pin, load)),
    )
    for load, phase, amount in acting:
        if load.kind == "body":
            out += amount * _body_force(rule, elements, phase if load.n else 2)
    return out


def _traction_forces(pin: Pin, mesh: HexMesh, tractions: Iterable[Acted]) -> Floats:
    """Return the nodal forces (N, 3), N, of tractions."""
    # Grouped by band, because in contact there are thousands of tractions on a few bands.
    out = np.zeros_like(mesh.nodes)
    for name, of_band in grouped((x[1].surface, x) for x in tractions).items():
        _push(out, pin, mesh, name, of_band)
    return out


def _push(out: Floats, pin: Pin, mesh: HexMesh, name: str, tractions: list[Acted]) -> None:
    """Add the forces of tractions on a band to the nodal forces `out` (N, 3), N."""
    nodes = mesh.elements[_on(pin, mesh, name)][:, _OUTER_FACE_NODES]
    g, weight = _gauss(3)
    # Quadrature on the outer faces of the cells: their shape functions, tangents and areas there.
    grid = np.stack([np.ones(9), np.repeat(g, 3), np.tile(g, 3)])
    basis = [ElementHexS2().lbasis(grid, k) for k in _OUTER_FACE_NODES]
    shapes, slopes = np.stack([b[0] for b in basis]), np.stack([b[1] for b in basis])
    corners = mesh.nodes[nodes]
    x = np.einsum("kq,mka->mqa", shapes, corners)
    tangents = np.einsum("kaq,mkb->amqb", slopes[:, 1:], corners)
    area = np.linalg.norm(np.cross(*tangents), axis=2) * np.outer(weight, weight).ravel()
    # The traction of a shoulder's face refers to a cylinder with the area of the face, which has a
    # smaller radius.
    area *= pin.band(name).radius / pin.bands[_segment(pin, name)].radius
    whole = np.zeros_like(x)
    for amount, t, n, phase in tractions:
        whole += amount * components(t, x, n, phase)
    np.add.at(out, nodes, np.einsum("mq,kq,mqa->mka", area, shapes, whole, optimize=True))


def _body_force(rule: FlowRule, elements: Elements, axis: int) -> Floats:
    """Return the nodal forces (N, 3), N, of an acceleration of 1 m/s^2 along an axis.

    Raises: SolveError for a material without density.
    """
    density = rule.material.density
    if density is None:
        raise SolveError(
            f"material {rule.material.name} has no density, which weight and inertia need",
            "no-density",
        )
    x, _ = _gauss(2)
    grid = np.stack(np.meshgrid(x, x, x, indexing="ij")).reshape(3, -1)
    shapes = np.stack([ElementHexS2().lbasis(grid, k)[0] for k in range(20)])
    nodal_mass = density * np.einsum("mq,kq->mk", elements.weights, shapes)
    out = np.zeros_like(elements.nodes)
    np.add.at(out[:, axis], elements.numbers, nodal_mass)
    return out


def _balanced(pin: Pin, mesh: HexMesh, ties: Ties, force: Floats) -> tuple[Floats, Ties]:
    """Return the forces with closing tractions that cancel their resultant, and ties without rigid
    motions.

    ties: of the sector. One unknown is fixed for each rigid motion that they allow.
    """
    whole = ties.matrix
    whole_turn = np.concatenate([mesh.nodes, mesh.nodes * [-1.0, -1.0, 1.0]])  # about the axis
    modes = rigid_modes(whole_turn - whole_turn.mean(axis=0))[: mesh.nodes.size]
    counts = np.asarray(abs(whole).sum(axis=0)).ravel()
    # Find the rigid motions that the symmetries of the sector allow.
    free = (whole.T @ modes) / counts[:, None]
    possible = np.abs(whole @ free - modes).max(axis=0) < 1e-9
    free = free[:, possible]
    # Find the amounts of the closing tractions that cancel the resultant in each of these motions.
    closing = [
        _traction_forces(pin, mesh, ((1.0, t, n, phase) for t in everywhere))
        for n, phase in ((1, 0), (1, 1), (0, 0), (0, 1))
        for everywhere in closing_tractions(pin, n, phase)
    ]
    columns = whole.T @ np.stack([np.ravel(c) for c in closing], axis=1)
    columns /= np.linalg.norm(columns, axis=0)[None]
    unbalanced = free.T @ (whole.T @ force.ravel())
    amount = np.linalg.lstsq(free.T @ columns, -unbalanced, rcond=1e-9)[0]
    corrected = force.ravel() + whole @ ((columns @ amount) / counts)
    # Fix one unknown for each rigid motion: pivoted QR picks the best conditioned ones.
    _, _, pivot = scipy.linalg.qr(free.T, mode="economic", pivoting=True)
    return corrected.reshape(-1, 3), ties.without(pivot[: free.shape[1]].astype(np.int64))

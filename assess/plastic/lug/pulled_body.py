"""A plane-strain body of quadratic triangles pulled by a rigid pin: forces and tangent of a step.

In small strain the geometry does not change. In finite strain each step starts from the geometry
before it. The strain increment is taken at the middle of the step, the stress rotates with the
material (Hughes and Winget), and equilibrium holds in the geometry after the step. Elastic strain
is small in metals, so this rate form is accurate. The tangent is consistent except for terms of the
finite step size. Quadratic triangles with three quadrature points do not lock: there are four
displacement unknowns for three volume constraints.

The pin is a frictionless circle. Points inside it are pushed out by a stiff spring.

Source: T. J. R. Hughes, J. Winget, Int. J. Num. Meth. Eng. 15 (1980) 1862; S. W. Sloan, M. F.
Randolph, Int. J. Num. Anal. Meth. Geomech. 6 (1982) 47, for elements that do not lock.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from assess.plastic.flow import Flow, FlowRule
from assess.plastic.lug.bounds import QuadraticNodes
from assess.plastic.lug.mesh import PlaneMesh
from pinbase.arrays import Floats, Ints, Mask

# Stiffness of the pin's surface, in Young's moduli per radius. With ten times this stiffness the
# load of a yielding bore changes by less than 0.1 %.
CONTACT_STIFFNESS = 20.0
PLACES = np.full((3, 3), 1.0 / 6.0) + np.eye(3) / 2.0  # quadrature points in area coordinates
EDGE_PLACES, EDGE_WEIGHTS = np.polynomial.legendre.leggauss(3)
# Quadratic shape functions at the quadrature points of an edge: first end, last end, middle.
EDGE_SHAPES = np.stack(
    [
        EDGE_PLACES * (EDGE_PLACES - 1.0) / 2.0,
        EDGE_PLACES * (EDGE_PLACES + 1.0) / 2.0,
        1.0 - EDGE_PLACES**2,
    ],
    axis=1,
)
_EYE = np.eye(2)
_PLANE = [0, 5, 5, 1]  # Voigt components of the entries xx, xy, yx, yy of a plane tensor


@dataclass(frozen=True)
class PulledState:
    """The state after a step; lengths in radii of the bore.

    nodes: (N, 2) current positions. elastic: (M, 3, 6) elastic strain. equivalent: (M, 3)
    equivalent plastic strain. pin: displacement of the pin. load: force of the pin on the modelled
    half, N/m per radius (Pa).
    """

    nodes: Floats
    elastic: Floats
    equivalent: Floats
    pin: float
    load: float


class PulledBody:
    """Half of a lug of an elastic-plastic material on a mesh; lengths in radii of its bore.

    finite: whether strains are finite.
    """

    def __init__(self, mesh: PlaneMesh, rule: FlowRule, finite: bool) -> None:
        self.rule, self.finite = rule, finite
        space = QuadraticNodes(mesh)
        self.numbers = space.numbers
        self.start = _nodes(mesh, space)
        self.bore = space.of_edges(mesh.edges["bore"])
        on_bore = np.unique(self.bore)
        self.start[on_bore] /= np.linalg.norm(self.start[on_bore], axis=1)[:, None]
        self.free = _free(mesh, space)
        self._slopes = _local_slopes()
        dofs = (2 * self.numbers[..., None] + np.arange(2)).reshape(len(self.numbers), 12)
        edge = (2 * self.bore[..., None] + np.arange(2)).reshape(len(self.bore), 6)
        self._dofs, self._edge_dofs = dofs, edge
        pairs = [
            (np.repeat(d, d.shape[1], axis=1).ravel(), np.tile(d, (1, d.shape[1])).ravel())
            for d in (dofs, edge)
        ]
        self._rows, self._columns = (np.concatenate(x) for x in zip(*pairs, strict=True))
        self._spring = CONTACT_STIFFNESS * rule.material.youngs_modulus

    def at_rest(self) -> PulledState:
        """Return the state before the pin moves."""
        points = len(self.numbers), 3
        return PulledState(self.start, np.zeros((*points, 6)), np.zeros(points), 0.0, 0.0)

    def residual(
        self, before: PulledState, moved: Floats, pin: float
    ) -> tuple[Floats, sp.csc_matrix, PulledState, float]:
        """Return the unbalanced forces (U,) at the end of a step, the tangent (U, U), the state,
        and the size of the pin's forces.

        moved: (N, 2) displacements in the step. pin: position of the pin after the step.
        """
        shape = before.nodes + moved if self.finite else self.start
        flow, elastic = self._flow(before, moved)
        gradients, weights = self._gradients(shape)
        plane = flow.stress[..., _PLANE].reshape(*weights.shape, 2, 2)
        forces = np.einsum("mqij,mqkj,mq->mki", plane, gradients, weights, optimize=True)
        moduli = self._moduli(flow, plane)
        matrix = np.einsum(
            "mqaj,mqijkl,mqbl,mq->maibk", gradients, moduli, gradients, weights, optimize=True
        )
        nodes = before.nodes + moved
        pressed, springs, load = self._contact(nodes, pin)
        inner = np.bincount(self._dofs.ravel(), forces.ravel(), minlength=nodes.size)
        outer = np.bincount(self._edge_dofs.ravel(), pressed.ravel(), minlength=nodes.size)
        data = np.concatenate([matrix.ravel(), springs.ravel()])
        whole = sp.csc_matrix((data, (self._rows, self._columns)), shape=(nodes.size, nodes.size))
        free = self.free
        state = PulledState(nodes, elastic, flow.equivalent, pin, load)
        size = float(np.linalg.norm(outer[free])) + 1e-12 * self._spring
        unbalanced = np.asarray(inner - outer, dtype=np.float64)[free]
        return unbalanced, sp.csc_matrix(whole[free][:, free]), state, size

    def _flow(self, before: PulledState, moved: Floats) -> tuple[Flow, Floats]:
        """Return the flow in a step, and the elastic strains after it."""
        middle = before.nodes + moved / 2.0 if self.finite else self.start
        gradients, _ = self._gradients(middle)
        slope = np.einsum("mki,mqkj->mqij", moved[self.numbers], gradients, optimize=True)
        elastic = before.elastic
        if self.finite:
            elastic = _turned(elastic, (slope[..., 1, 0] - slope[..., 0, 1]) / 2.0)
        increment = np.zeros_like(elastic)
        increment[..., 0], increment[..., 1] = slope[..., 0, 0], slope[..., 1, 1]
        increment[..., 5] = (slope[..., 0, 1] + slope[..., 1, 0]) / 2.0
        trial = elastic + increment
        flow = self.rule.step(trial, np.zeros_like(trial), before.equivalent)
        return flow, trial - flow.plastic

    def _moduli(self, flow: Flow, stress: Floats) -> Floats:
        """Return d(force)_ij / d(gradient)_kl at the quadrature points, (M, 3, 2, 2, 2, 2)."""
        moduli = flow.tangent[..., _PLANE, :][..., _PLANE].reshape(*stress.shape[:2], 2, 2, 2, 2)
        if not self.finite:
            return np.asarray(moduli)

        def term(indices: str) -> Floats:
            return np.asarray(np.einsum(f"mq{indices[:2]},{indices[2:]}->mqijkl", stress, _EYE))

        # Volume and gradients change with the geometry; the stress rotates with the material.
        out = moduli + term("ijkl") - term("iljk")
        out += (term("ljik") - term("kjil") - term("iklj") + term("iljk")) / 2.0
        return np.asarray(out)

    def _gradients(self, nodes: Floats) -> tuple[Floats, Floats]:
        """Return the gradients (M, 3, 6, 2) of the shape functions, and the weights (M, 3), for
        nodes at given positions.
        """
        jacobian = np.einsum("mki,qka->mqia", nodes[self.numbers], self._slopes, optimize=True)
        determinant = np.linalg.det(jacobian)
        inverse = np.linalg.inv(jacobian)
        gradients = np.einsum("qka,mqai->mqki", self._slopes, inverse, optimize=True)
        return gradients, determinant / 6.0

    def _contact(self, nodes: Floats, pin: float) -> tuple[Floats, Floats, float]:
        """Return the forces (E, 3, 2) of the pin on the nodes of the edges, the stiffness
        (E, 3, 2, 3, 2) of its springs, and the load of the pin.
        """
        chord = self.start[self.bore]
        at = np.einsum("qk,eki->eqi", EDGE_SHAPES, nodes[self.bore]) - [pin, 0.0]
        distance = np.linalg.norm(at, axis=-1)
        normal = at / distance[..., None]
        if not self.finite:  # the normals do not change
            at_start = np.einsum("qk,eki->eqi", EDGE_SHAPES, chord)
            normal = at_start / np.linalg.norm(at_start, axis=-1)[..., None]
            distance = (at * normal).sum(axis=-1)
        # Lengths in the reference geometry, to which the pressure refers.
        length = np.linalg.norm(chord[:, 1] - chord[:, 0], axis=1)
        weight = length[:, None] * EDGE_WEIGHTS / 2.0
        inside = np.maximum(1.0 - distance, 0.0)
        force = self._spring * inside * weight
        forces = np.einsum("eq,qk,eqi->eki", force, EDGE_SHAPES, normal)
        out = normal[..., :, None] * normal[..., None, :]
        along = (inside / distance * self.finite)[..., None, None] * (_EYE - out)
        stiff = (self._spring * weight * (inside > 0.0))[..., None, None] * (out - along)
        springs = np.einsum("qk,eqij,ql->ekilj", EDGE_SHAPES, stiff, EDGE_SHAPES)
        return forces, springs, float((force * normal[..., 0]).sum())


def _turned(strain: Floats, half: Floats) -> Floats:
    """Return strains (M, Q, 6) after the rotation of a step whose spin increment is `half` (M, Q),
    by the midpoint rule of Hughes and Winget.
    """
    angle = 2.0 * np.arctan(half / 2.0)
    c, s = np.cos(angle), np.sin(angle)
    x, y, xy = strain[..., 0], strain[..., 1], strain[..., 5]
    out = strain.copy()
    out[..., 0] = c * c * x + s * s * y - 2.0 * c * s * xy
    out[..., 1] = s * s * x + c * c * y + 2.0 * c * s * xy
    out[..., 5] = c * s * (x - y) + (c * c - s * s) * xy
    return out


def _nodes(mesh: PlaneMesh, space: QuadraticNodes) -> Floats:
    nodes = np.zeros((space.count, 2))
    nodes[: len(mesh.nodes)] = mesh.nodes
    nodes[len(mesh.nodes) :] = mesh.nodes[space.sides].mean(axis=1)
    return nodes


def _free(mesh: PlaneMesh, space: QuadraticNodes) -> Ints:
    """Return the numbers of the free unknowns: all but those across the axis and on held edges."""
    free: Mask = np.ones((space.count, 2), dtype=bool)
    free[space.of_edges(mesh.edges["axis"]), 1] = False
    free[space.of_edges(mesh.edges["held"])] = False
    return np.flatnonzero(free)


def _local_slopes() -> Floats:
    """Return the derivatives (3, 6, 2) of the shape functions by the first two area coordinates, at
    PLACES.
    """
    slope = np.zeros((3, 6, 3))
    for i in range(3):
        slope[:, i, i] = 4.0 * PLACES[:, i] - 1.0
        j = (i + 1) % 3
        slope[:, 3 + i, i], slope[:, 3 + i, j] = 4.0 * PLACES[:, j], 4.0 * PLACES[:, i]
    return np.asarray(slope[..., :2] - slope[..., 2:])

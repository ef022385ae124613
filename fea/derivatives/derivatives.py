"""Derivatives of the largest von Mises stress of a pin with respect to all that it depends on.

At the governing point, instant and angle the stress is a function J of the nodes' coordinates x, of
their displacements u and of the tractions t. With K u = f and the adjoint l, K l = dJ/du,

    dJ/dp = J,x x' + J,t t' + l^T f' - (l^T K u),x x'

for any parameter p, so that one solution l of each harmonic, with the stiffness that the stress
itself took, serves all of them. Nodes move by x' as geometry.mesh.outline_motion says on the
outline and harmonically inside. The maximum moves along the surface, over the circumference and in
time too, but there it is stationary, or held by the edge of an excluded zone, which x' follows. So
this is the derivative of the maximum on the mesh as it is moved, to round-off; its error is that of
the mesh.

Source: Haftka & Gurdal, Elements of Structural Optimization, ch. 7 (adjoint method); Choi & Kim,
Structural Sensitivity Analysis and Optimization 1, ch. 6 (shape).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.derivatives.governing import Column, by_loads, columns_of
from fea.derivatives.reading_point import (
    AtJump,
    FromInside,
    ReadingPoint,
    Samples,
    State,
    at_node,
    at_rough,
    nearest,
    on_axis,
    on_skin,
)
from fea.derivatives.records import Derivatives
from fea.derivatives.virtual_work import COLUMNS, Interior, integral_rates, shape_gradient, work
from fea.harmonic.assembly import Section, elasticity
from fea.harmonic.evaluate import HarmonicSolution
from fea.harmonic.model import HarmonicModel, applied, generalised
from fea.harmonic.pressure_edge import DIRECTIONS, jumps
from fea.harmonic.stress_recovery import points_of_nodes
from fea.harmonic.superposition import Circumference
from fea.harmonic.surface_stress import AT
from fea.singular.singularities import Singularity
from geometry import Pin
from geometry.arrays import Floats
from geometry.mesh.outline_motion import OtherShapeError, OutlineNodes, Reach, rate
from geometry.shape.dimensions import Dimension

POISSON = 1e-3  # step of Poisson's ratio
OTHER = "with a little more or less of it the section has other edges"


@dataclass(frozen=True)
class Solved:
    """A pin of a material, clamped at surfaces (by the pin's names), as it was solved on one mesh
    under loads of one instant; zones: the singularities that are left out.
    """

    pin: Pin
    material: Material
    clamps: tuple[str, ...]
    loads: PinLoads
    solution: HarmonicSolution
    zones: tuple[Singularity, ...]


def derivatives(solved: Solved, dimensions: Iterable[Dimension]) -> Derivatives:
    """Of the maximum at the only instant of the loads.

    Raises: SolveError.
    """
    return _Adjoint(solved).derivatives(tuple(dimensions))


class _Adjoint:
    """All at the governing point and angle."""

    def __init__(self, solved: Solved) -> None:
        self.solved = solved
        self.fields = solved.solution.fields
        self.model = HarmonicModel(solved.pin, solved.solution.mesh, solved.material, solved.clamps)
        self.space, self.outline = self.model.space, self.model.outline
        around = Circumference(self.fields, solved.loads)
        self.top = around.top(self.fields.outside(solved.zones))
        self.columns, self.weight = columns_of(self.fields_at, solved.loads, self.top)
        self.n = np.array([column.n for column in self.columns])
        self.traction = self._traction(solved.pin, self.outline)
        self.point = _point(self)
        self._lambda = self._solve()

    @cached_property
    def fields_at(self) -> dict[UnitLoad, Floats]:
        """Stress (6,) Pa at the governing point of each unit load."""
        at = self.fields.stress[self.top.point]
        return {load: at[:, k] for k, load in enumerate(self.fields.loads)}

    @cached_property
    def u(self) -> Floats:
        """(N, 3, K) m, of the columns."""
        rows = points_of_nodes(self.outline, len(self.space.nodes))
        index = {load: k for k, load in enumerate(self.fields.loads)}
        amounts = np.zeros((len(index), len(self.columns)))
        for k, column in enumerate(self.columns):
            for load, amount in column.amounts.items():
                amounts[index[load], k] = amount
        return np.asarray((self.fields.displacement @ amounts)[rows])

    def _forces(
        self, column: Column, pin: Pin, outline: object, integrals: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """Of a column: on the unknowns (3 N,), and tractions (E, 3, 3)."""
        loads = tuple(column.amounts)
        amounts = np.array([column.amounts[load] for load in loads])
        forces, tractions = applied(self.model, pin, outline, column.n, loads, integrals)  # type: ignore[arg-type]
        return forces @ amounts, tractions @ amounts

    def _traction(self, pin: Pin, outline: object) -> Floats:
        found = [self._forces(column, pin, outline)[1] for column in self.columns]
        return np.stack(found, axis=-1)

    @cached_property
    def places(self) -> Floats:
        """(Z, 3): r, z, radius of the zones, m."""
        return np.array([[p.r, p.z, p.radius] for p in self.solved.zones]).reshape(-1, 3)

    @cached_property
    def state(self) -> State:
        return State(self.space.nodes, self.traction, self.places)

    def read(self, state: State, material: Material | None = None) -> float:
        """Von Mises stress to first order, of displacements as they are."""
        u = self.u[self.point.nodes]
        found = self.point.stress(material or self.solved.material, state, self.n, u)
        return float(sum(c.weight @ found[:, k] for k, c in enumerate(self.columns)))

    def _solve(self) -> Floats:
        """Adjoints (3 N, K)."""
        L, K = len(self.point.nodes), len(self.columns)
        unit = np.eye(3 * L).reshape(L, 3, 3 * L)
        out = np.zeros((self.space.unknowns, K))
        forces = np.zeros((len(self.space.nodes), 3, K))
        still = replace(self.state, traction=np.zeros((*self.traction.shape[:3], 3 * L)))
        for n in np.unique(self.n):
            here = np.flatnonzero(self.n == n)
            found = self.point.stress(self.solved.material, still, np.full(3 * L, n), unit)
            for k in here:
                forces[self.point.nodes, :, k] = (self.columns[k].weight @ found).reshape(L, 3)
            rhs = np.stack([generalised(forces[:, :, k]) for k in here], axis=1)
            out[:, here] = self.model.displace(int(n), rhs)
        return out

    def derivatives(self, dimensions: tuple[Dimension, ...]) -> Derivatives:
        by_dimension, without = self._by_dimension(dimensions)
        top, solved = self.top, self.solved
        r, z = (float(x) for x in self.fields.points[top.point])
        by_force, by_moment = by_loads(self.fields_at, solved.loads, self.weight, top)
        return Derivatives(
            top.value,
            (r * float(np.cos(top.angle)), r * float(np.sin(top.angle)), z),
            by_dimension,
            without,
            by_force,
            by_moment,
            self._by_poisson(),
            self._by_density(),
        )

    def _by_dimension(
        self, dimensions: tuple[Dimension, ...]
    ) -> tuple[dict[str, float], dict[str, str]]:
        solved = self.solved
        reaches = [Reach((p.r, p.z), p.radius) for p in solved.zones]
        nodes = OutlineNodes(solved.solution.mesh, solved.pin, reaches)
        moved: list[tuple[Dimension, float, Floats]] = []
        without = {}
        for dimension in dimensions:
            try:
                velocity, step = nodes.velocity(dimension)
                moved.append((dimension, step, velocity))
            except OtherShapeError:
                without[dimension.key] = OTHER
        if not moved:
            return {}, without
        interior = Interior(self.space, nodes.rows)
        gradient = sum(
            shape_gradient(self.space, self._D, c.n, self._unknowns(k), self._lambda[:, k])
            for k, c in enumerate(self.columns)
        )
        out = {}
        for k in range(0, len(moved), COLUMNS):
            some = moved[k : k + COLUMNS]
            every = interior.velocity(np.stack([v for _, __, v in some], axis=2))
            heavy = any(load.kind == "body" for c in self.columns for load in c.amounts)
            grown = integral_rates(self.space, every) if heavy else None
            for i, (dimension, step, _) in enumerate(some):
                velocity = every[:, :, i]
                given = self._given(
                    dimension, step, velocity, None if grown is None else grown[:, i]
                )
                out[dimension.key] = given - float(np.sum(gradient * velocity))
        return out, without

    def _given(
        self, dimension: Dimension, step: float, velocity: Floats, grown: Floats | None
    ) -> float:
        """What forces, tractions and the reading change, with displacements as they are."""

        def at(x: float) -> Floats:
            pin = dimension.changed(dimension.value + x)
            nodes = self.space.nodes + x * velocity
            outline = self.outline.moved(nodes)
            integrals = None if grown is None else self.space.integrals + x * grown
            total, tractions = 0.0, []
            for k, column in enumerate(self.columns):
                forces, traction = self._forces(column, pin, outline, integrals)
                total += float(self._lambda[:, k] @ forces)
                tractions.append(traction)
            state = State(nodes, np.stack(tractions, axis=-1), self._places_at(x, velocity))
            return np.array(total + self.read(state))

        return float(rate(at, step))

    def _places_at(self, x: float, velocity: Floats) -> Floats:
        out = self.places.copy()
        for k, (r, z, radius) in enumerate(self.places):
            node = int(np.hypot(*(self.space.nodes - [r, z]).T).argmin())
            out[k, :2] += x * velocity[node]
            out[k, 2] = radius * out[k, 0] / r
        return out

    @property
    def _D(self) -> Floats:
        return elasticity(self.solved.material)

    def _unknowns(self, k: int) -> Floats:
        """(3 N,) p, m, w of column k."""
        U, V, W = self.u[:, :, k].T
        return np.stack([(U + V) / 2.0, (U - V) / 2.0, W], axis=1).ravel()

    def _by_poisson(self) -> float:
        material = self.solved.material
        nu = material.poisson_ratio
        step = min(POISSON, 0.1 * (0.5 - nu), 0.1 * (1.0 + nu))

        def at(x: float) -> Floats:
            other = replace(material, poisson_ratio=nu + x)
            against = sum(
                work(self.space, elasticity(other), c.n, self._unknowns(k), self._lambda[:, k])
                for k, c in enumerate(self.columns)
            )
            return np.array(self.read(self.state, other) - against)

        return float(rate(at, step))

    def _by_density(self) -> float:
        density = self.solved.material.density
        if not density:
            return 0.0
        total = 0.0
        for column in self.columns:
            own = [x for load, x in column.amounts.items() if load.kind == "body"]
            at = [self.fields_at[load] for load in column.amounts if load.kind == "body"]
            total += sum(x * float(column.weight @ s) for x, s in zip(own, at, strict=True))
        return total / density


def _point(job: _Adjoint) -> ReadingPoint:
    """The governing one, by its number among those of fea.harmonic.stress_recovery."""
    space, outline, number = job.space, job.outline, job.top.point
    skin = job.fields.skin
    if number < skin:
        edge, at = divmod(number, len(AT))
        clamped = outline.constrained(job.model.clamps)[edge]
        if clamped or on_axis(space, float(job.fields.points[number, 0])):
            return at_rough(space, outline, edge, at)
        return on_skin(outline, job.traction, edge, at)
    if number < len(job.fields.displacement):
        inner = np.setdiff1d(np.arange(len(space.nodes)), outline.nodes)
        return at_node(space, int(inner[number - skin]))
    ends = job.solved.solution.ends
    first = len(job.fields.points) - DIRECTIONS * len(ends)
    if number >= first:
        which, direction = divmod(number - first, DIRECTIONS)
        (jump,) = jumps(space, outline, job.solved.material, ends[which : which + 1])
        return AtJump(outline, jump, Samples(space, jump.samples), direction)
    return _on_rim(space, job.solved.zones, job.fields.points[number])


def _on_rim(space: Section, zones: tuple[Singularity, ...], at: Floats) -> FromInside:
    """Of the zone on whose circle it is."""
    off = [abs(np.hypot(at[0] - p.r, at[1] - p.z) / p.radius - 1.0) for p in zones]
    zone = int(np.argmin(off))
    p, (r, z) = zones[zone], (float(x) for x in at)
    return FromInside(nearest(space, [at]), (1.0,), (), (r, z), zone, (p.r, p.z, p.radius))

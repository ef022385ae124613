"""Derivatives of the largest von Mises stress of a pin with respect to shape, loads and material.

At the governing point, instant and angle the stress is a function J of the nodes' coordinates x, of
their displacements u and of the tractions t. With K u = f and the adjoint l, K l = dJ/du,

    dJ/dp = J,x x' + J,t t' + l^T f' - (l^T K u),x x'

for any parameter p. One adjoint solution l of each harmonic, with the stiffness matrix of the
stress solution, therefore serves all parameters. Nodes move by x': on the outline as given by
geometry.mesh.outline_motion, inside by harmonic extension. The location of the maximum also moves,
along the surface, over the circumference and in time. This does not change the derivative, because
the maximum is stationary there, or is at the edge of an excluded zone, which x' follows. The result
is the derivative of the maximum on the moved mesh, to round-off; its error is that of the mesh.

Source: Haftka & Gurdal, Elements of Structural Optimization, ch. 7 (adjoint method); Choi & Kim,
Structural Sensitivity Analysis and Optimization 1, ch. 6 (shape).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from assess.derivatives.governing import by_loads, waves_of
from assess.derivatives.governing_point import point_of
from assess.derivatives.in_section import OTHER_EDGES_REASON
from assess.derivatives.reading_point import Continued, ReadingPoint, SectionState
from assess.derivatives.records import Derivatives, SolvedCase
from assess.derivatives.ties import competing_places, competing_times
from assess.derivatives.virtual_work import (
    MOTION_BATCH,
    Interior,
    integral_rate,
    shape_gradient,
    work,
)
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from fea.harmonic.assembly import around, elasticity
from fea.harmonic.boundary import Outline
from fea.harmonic.free_surface import reader
from fea.harmonic.model import HarmonicModel, applied, generalised
from fea.harmonic.stress_recovery import points_of_nodes
from fea.singular.singularities import free_of_arcs
from geometry import Pin
from geometry.mesh.outline_motion import (
    DIFFERENCE_STEPS,
    NodeMotion,
    OtherShapeError,
    OutlineNodes,
    Reach,
    rate,
    rate_of,
)
from geometry.shape.dimensions import Dimension
from pinbase.arrays import Floats, Ints, Mask

# Steps of central differences, chosen by judgement.
POISSON_STEP = 1e-3  # of Poisson's ratio
EXPONENT_STEP = 1e-4  # of a pressure's exponent


def derivatives(solved: SolvedCase, dimensions: Iterable[Dimension]) -> Derivatives:
    """Return the derivatives of the maximum; the loads must have a single instant.

    Raises: SolveError.
    """
    return Adjoint(solved).derivatives(tuple(dimensions))


class Adjoint:
    """The adjoint solution at the governing point and angle of a solved load case.

    top: the maximum.
    waves: the harmonic components of the load that contribute to the stress there.
    among: (S,) mask of the points that may govern, all by default.
    reused: another adjoint solution on the same mesh, whose matrices this one reuses.
    """

    def __init__(
        self, solved: SolvedCase, among: Mask | None = None, reused: Adjoint | None = None
    ) -> None:
        self.solved = solved
        self.fields = solved.solution.fields
        mesh = solved.solution.mesh
        shared_model = reused and reused.model
        self.model: HarmonicModel = shared_model or HarmonicModel(
            solved.pin, mesh, solved.material, solved.clamps
        )
        if reused and reused.solved.zones == solved.zones:
            self.outline_nodes, self.interior = reused.outline_nodes, reused.interior
        self.space, self.outline = self.model.space, self.model.outline
        self.around = reader(self.fields, solved.loads, solved.material.poisson_ratio)
        self.read_at = self.around.fields
        # Find the governing point, instant and angle; then the waves that act there, the way in
        # which stress is read there, and the adjoint solution.
        outside = self.read_at.outside(solved.zones)
        self.top = self.around.top(outside if among is None else outside & among)
        self.waves, self.weight = waves_of(self.fields_at, solved.loads, self.top)
        self.n = np.array([wave.n for wave in self.waves])
        self.traction = self._forces(solved.pin, self.outline)[1]
        self.point = point_of(self.model, solved, self._jumping, self.top.point)
        self._lambda = self._solve()

    @cached_property
    def fields_at(self) -> dict[UnitLoad, Floats]:
        """Stress (6,), Pa, of each unit load at the governing point."""
        at = self.read_at.stress[self.top.point]
        return {load: at[:, k] for k, load in enumerate(self.fields.loads)}

    @property
    def _jumping(self) -> Floats:
        """Tractions (E, 3, 3, K), Pa, of the waves and of all other unit loads.

        Smoothing of stress stops at an edge where any of these tractions jumps.
        """
        loads, out = self.fields.loads, [self.traction]
        acting = {load for wave in self.waves for load in wave.amounts}
        for n in sorted({load.n for load in loads}):
            others = [x for x in loads if x.n == n and x not in acting]
            if others:
                out.append(applied(self.model, self.solved.pin, self.outline, n, others)[1])
        return np.concatenate(out, axis=3)

    @cached_property
    def u(self) -> Floats:
        """Displacements (N, 3, K), m, of the nodes in each wave."""
        rows = points_of_nodes(self.outline, len(self.space.nodes))
        index = {load: k for k, load in enumerate(self.fields.loads)}
        amounts = np.zeros((len(index), len(self.waves)))
        for k, wave in enumerate(self.waves):
            for load, amount in wave.amounts.items():
                amounts[index[load], k] = amount
        return np.asarray((self.fields.displacement @ amounts)[rows])

    @cached_property
    def _harmonics(self) -> list[tuple[int, tuple[UnitLoad, ...], Floats, Ints]]:
        """The waves grouped by harmonic: n, its unit loads (L), their amounts in each of its waves
        (L, W), and the numbers of these waves (W,).
        """
        out = []
        for n in np.unique(self.n):
            here = np.flatnonzero(self.n == n)
            loads = tuple(dict.fromkeys(load for k in here for load in self.waves[k].amounts))
            amounts = [[self.waves[k].amounts.get(load, 0.0) for k in here] for load in loads]
            out.append((int(n), loads, np.array(amounts), here))
        return out

    def _forces(
        self, pin: Pin, outline: Outline, integrals: Floats | None = None, moved: bool = False
    ) -> tuple[Floats, Floats]:
        """Return the generalised forces of the waves (3 N, K) and their tractions (E, 3, 3, K).

        moved: whether to leave out the forces of plain pressures, which `_plain_pressures` covers.
        """
        forces = np.zeros((self.space.unknowns, len(self.waves)))
        tractions = np.zeros((*outline.nodes.shape, 3, len(self.waves)))
        for n, loads, amounts, here in self._harmonics:
            if moved and _plain(n, loads):
                tractions[..., here] = self.traction[..., here]
                continue
            one, other = applied(self.model, pin, outline, n, loads, integrals)
            forces[:, here], tractions[..., here] = one @ amounts, other @ amounts
        return forces, tractions

    @cached_property
    def _plain_pressures(self) -> tuple[Ints, Floats]:
        """The numbers of the edges under plain pressures, (E,), and the adjoint work of these
        pressures per nodal weight, (E, 3).
        """
        by_edge = np.zeros(self.outline.nodes.shape)
        for n, loads, amounts, here in self._harmonics:
            if not _plain(n, loads):
                continue
            p, m = (self._lambda[c::3, here] for c in (0, 1))  # a pressure works on their sum
            inwards = -around(n) * (p + m)
            for load, amount in zip(loads, amounts, strict=True):
                nodal_work = inwards @ amount
                for surface, pressure in load.parts:
                    rows = self.outline.rows[surface]
                    by_edge[rows] += pressure * nodal_work[self.outline.nodes[rows]]
        rows = np.flatnonzero(by_edge.any(axis=1))
        return rows, by_edge[rows]

    def of_loads(self, k: int, loads: Sequence[UnitLoad]) -> Floats:
        """Return the stress (L,), Pa, that one unit of each of some unit loads adds.

        loads: unit loads (L,) of the harmonic and part of wave k.
        """
        wave = self.waves[k]
        forces, traction = applied(self.model, self.solved.pin, self.outline, wave.n, loads)
        state = replace(self.state, traction=traction)
        none = np.zeros((len(self.point.nodes), 3, len(loads)))
        n = np.full(len(loads), wave.n)
        read = self.point.stress(self.solved.material, state, n, none)
        return np.asarray(self._lambda[:, k] @ forces + wave.weight @ read)

    @cached_property
    def places(self) -> Floats:
        """The r, z and radius of each excluded zone, (Z, 3), m."""
        return np.array([[p.r, p.z, p.radius] for p in self.solved.zones]).reshape(-1, 3)

    @cached_property
    def state(self) -> SectionState:
        return SectionState(self.space.nodes, self.traction, self.places)

    def read(
        self,
        state: SectionState,
        material: Material | None = None,
        point: ReadingPoint | None = None,
    ) -> float:
        """Return the von Mises stress, Pa, to first order, with the displacements unchanged.

        state, material, point: may differ from those of the solution.
        """
        u = self.u[self.point.nodes]
        stress = (point or self.point).stress(material or self.solved.material, state, self.n, u)
        return float(sum(c.weight @ stress[:, k] for k, c in enumerate(self.waves)))

    def by_exponent(self) -> float:
        """Return the derivative, Pa, by the exponent of the pressure at the edge of a lug.

        The derivative is zero unless the stress is extrapolated to that edge.
        """
        point = self.point
        if not isinstance(point, Continued):
            return 0.0

        def other(x: float) -> Floats:
            cusp = replace(point.cusp, exponent=point.cusp.exponent + x)
            return np.array(self.read(self.state, point=replace(point, cusp=cusp)))

        return float(rate(other, EXPONENT_STEP))

    def _solve(self) -> Floats:
        """Return the adjoint displacements (3 N, K), one column for each wave."""
        # The reading is linear in the displacements of its nodes: unit displacements give dJ/du.
        L, K = len(self.point.nodes), len(self.waves)
        unit = np.eye(3 * L).reshape(L, 3, 3 * L)
        out = np.zeros((self.space.unknowns, K))
        forces = np.zeros((len(self.space.nodes), 3, K))
        still = replace(self.state, traction=np.zeros((*self.traction.shape[:3], 3 * L)))
        for n in np.unique(self.n):
            here = np.flatnonzero(self.n == n)
            unit_stress = self.point.stress(self.solved.material, still, np.full(3 * L, n), unit)
            for k in here:
                forces[self.point.nodes, :, k] = (self.waves[k].weight @ unit_stress).reshape(L, 3)
            rhs = np.stack([generalised(forces[:, :, k]) for k in here], axis=1)
            out[:, here] = self.model.displace(int(n), rhs)
        return out

    def derivatives(self, dimensions: tuple[Dimension, ...]) -> Derivatives:
        """Return the derivatives by dimensions, loads and material."""
        by_dimension, without = self.by_dimension(dimensions)
        top, solved = self.top, self.solved
        r, z = (float(x) for x in self.read_at.points[top.point])
        by_force, by_moment = by_loads(self.fields_at, solved.loads, self.weight, top)
        return Derivatives(
            top.value,
            (r * float(np.cos(top.angle)), r * float(np.sin(top.angle)), z),
            by_dimension,
            without,
            by_force,
            by_moment,
            self.by_poisson(),
            self.by_density(),
            competing_places(self.around, solved.zones, top, solved.error),
            competing_times(solved, top.value),
        )

    def by_dimension(
        self, dimensions: tuple[Dimension, ...]
    ) -> tuple[dict[str, float], dict[str, str]]:
        """Return the derivatives, Pa/m, by key of the dimension, and for each dimension without a
        derivative the reason.
        """
        motions: list[NodeMotion] = []
        without = {}
        for dimension in dimensions:
            try:
                motions.append(self.outline_nodes.motion(dimension))
            except OtherShapeError:
                without[dimension.key] = OTHER_EDGES_REASON
        return self.by_motions(motions), without

    @cached_property
    def outline_nodes(self) -> OutlineNodes:
        """The nodes on the outline of the mesh."""
        reaches = [Reach((p.r, p.z), p.radius) for p in self.solved.zones]
        return OutlineNodes(self.solved.solution.mesh, self.solved.pin, reaches)

    @cached_property
    def interior(self) -> Interior:
        """The harmonic extension of the outline's motion to the nodes inside."""
        return Interior(self.space, self.outline_nodes.rows)

    def by_motions(self, motions: Sequence[NodeMotion]) -> dict[str, float]:
        """Return the derivatives, Pa/m, by the key of each motion of the outline."""
        if not motions:
            return {}
        # The derivative of l^T K u by the coordinates of every node, computed once for all motions.
        gradient = sum(
            shape_gradient(self.space, self._D, c.n, self._unknowns(k), self._lambda[:, k])
            for k, c in enumerate(self.waves)
        )
        heavy = any(load.kind == "body" for c in self.waves for load in c.amounts)
        out = {}
        for k in range(0, len(motions), MOTION_BATCH):
            some = motions[k : k + MOTION_BATCH]
            every = self.interior.velocity(np.stack([motion.velocity for motion in some], axis=2))
            for i, motion in enumerate(some):
                velocity = np.ascontiguousarray(every[:, :, i])
                grown = integral_rate(self.space, velocity) if heavy else None
                direct = self._direct(motion, velocity, grown)
                out[motion.key] = direct - float(np.sum(gradient * velocity))
        return out

    def _direct(self, motion: NodeMotion, velocity: Floats, grown: Floats | None) -> float:
        """Return the direct part of a derivative, with the displacements unchanged.

        This part comes from the forces, the tractions and the place where stress is read.
        velocity: (N, 2) of the nodes.
        grown: (N,) rate of the integrals of the shape functions; None without body loads.
        """
        values = []
        for x, pin in zip(DIFFERENCE_STEPS, motion.pins, strict=True):
            step = x * motion.step
            nodes = self.space.nodes + step * velocity
            outline = self.outline.moved(nodes)
            integrals = None if grown is None else self.space.integrals + step * grown
            forces, tractions = self._forces(pin, outline, integrals, moved=True)
            state = SectionState(nodes, tractions, self._places_at(pin, step, velocity))
            rows, pressure_work = self._plain_pressures
            work = np.sum(self._lambda * forces) + np.sum(pressure_work * outline.weights(rows))
            values.append(np.array(work + self.read(state)))
        return float(rate_of(values, motion.step))

    @cached_property
    def _zone_nodes(self) -> list[int]:
        """The number of the node nearest to the centre of each zone."""
        nodes = self.space.nodes
        return [int(np.hypot(*(nodes - place[:2]).T).argmin()) for place in self.places]

    def _places_at(self, pin: Pin, step: float, velocity: Floats) -> Floats:
        """Return the zones (r, z, radius) on a pin with moved nodes, (Z, 3), m.

        The radius of a zone is proportional to the diameter there, or limited by the next fillet.
        """
        out, zones = self.places.copy(), self.solved.zones
        out[:, :2] += step * velocity[self._zone_nodes]
        times = out[:, 0] / self.places[:, 0]
        limited = np.array([p.radius >= p.limit for p in zones], dtype=bool)
        if limited.any():
            now, then = (
                free_of_arcs(of, *x[limited, :2].T)
                for of, x in ((pin, out), (self.solved.pin, self.places))
            )
            times[limited] = now / then
        out[:, 2] *= times
        return out

    @property
    def _D(self) -> Floats:
        return elasticity(self.solved.material)

    def _unknowns(self, k: int) -> Floats:
        """Return the unknowns p, m, w of wave k, (3 N,)."""
        U, V, W = self.u[:, :, k].T
        return np.stack([(U + V) / 2.0, (U - V) / 2.0, W], axis=1).ravel()

    def by_poisson(self) -> float:
        """Return the derivative by Poisson's ratio, Pa."""
        material = self.solved.material
        nu = material.poisson_ratio
        step = min(POISSON_STEP, 0.1 * (0.5 - nu), 0.1 * (1.0 + nu))

        def other(x: float) -> Material:
            return replace(material, poisson_ratio=nu + x)

        stiffer = rate(lambda x: elasticity(other(x)), step)
        against = sum(
            work(self.space, stiffer, c.n, self._unknowns(k), self._lambda[:, k])
            for k, c in enumerate(self.waves)
        )
        return float(rate(lambda x: np.array(self.read(self.state, other(x))), step)) - against

    def by_density(self) -> float:
        """Return the derivative by density, Pa/(kg/m^3)."""
        density = self.solved.material.density
        if not density:
            return 0.0
        total = 0.0
        for wave in self.waves:
            amounts = [x for load, x in wave.amounts.items() if load.kind == "body"]
            at = [self.fields_at[load] for load in wave.amounts if load.kind == "body"]
            total += sum(x * float(wave.weight @ s) for x, s in zip(amounts, at, strict=True))
        return total / density


def _plain(n: int, loads: Iterable[UnitLoad]) -> bool:
    """Whether all loads of harmonic n are pressures that do not depend on the pin's shape."""
    return n > 1 and all(load.parts for load in loads)

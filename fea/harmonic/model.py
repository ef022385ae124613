"""The harmonic model: three-dimensional elasticity of a body of revolution, solved in its section.

There is one factorisation for each mesh and harmonic, and one right-hand side for each unit load.
Both phases of a load, hence all its directions, share the solution.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import scipy.sparse as sp

from fea.core.linear_solver import ConstrainedSystem, Solve, SolveError
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from fea.core.tractions import (
    ALONG_X,
    ALONG_Z,
    Traction,
    closing_tractions,
    density_of,
    tractions_of,
)
from fea.harmonic.assembly import Section, around
from fea.harmonic.boundary import Outline
from fea.harmonic.fields import MeridianFields
from fea.harmonic.pressure_edge import unread
from fea.harmonic.stress_recovery import NO_POINTS, Reading, reading
from geometry import Pin
from geometry.mesh.section_mesh import MeridianMesh
from pinbase.arrays import Floats, Ints

LOADS_READ_AT_ONCE = 128  # whose samples take 0.2 GB on a mesh of 20,000 unknowns


class HarmonicBody:
    """A body of revolution on one mesh of its section.

    space: the equations of the section.
    material: one material, or one for each of the section's parts.
    clamps: names of the clamped surfaces.
    pivot: a position along the pin, 0 to 1 of its length. Without clamps, as many unknowns near it
    are constrained as there are rigid-body motions.
    """

    def __init__(
        self,
        pin: Pin,
        space: Section,
        material: Material | Sequence[Material],
        clamps: tuple[str, ...] = (),
        pivot: float = 0.0,
    ) -> None:
        self.pin, self.space, self.pivot = pin, space, pivot
        self.clamps = tuple(pin.surface(name) for name in clamps)
        self.outline = Outline(self.space)
        self.materials = material
        # One system serves all harmonics, since constrained unknowns stay in the matrix.
        self._system: ConstrainedSystem | None = None

    def forces(self, n: int, parts: Sequence[tuple[Traction, ...]]) -> Floats:
        """The nodal forces (unknowns, K), N, of K loads of harmonic n, each a sum of tractions."""
        return np.stack([generalised(self.outline.forces(part, n)) for part in parts], axis=1)

    def displace(self, n: int, forces: Floats, moved: Floats | None = None) -> Floats:
        """The displacement unknowns (unknowns, K) of harmonic n under nodal forces.

        forces: (unknowns, K) N.
        moved: (unknowns, K) prescribed motions of the clamps; zero by default.
        """
        system, K, free = self._equations(n)
        if moved is None:
            return system.solve(K, free, forces)
        return system.solve(K, free, forces - K @ moved) + moved

    def solver(self, n: int) -> Solve:
        """Return a function that solves harmonic n for nodal forces, any number of times."""
        system, K, free = self._equations(n)
        return system.kept(K, free)

    def work(self, n: int, forces: Floats) -> Floats:
        """The work (K, K) of nodal forces (unknowns, K) of harmonic n on the displacements that
        each column causes.
        """
        system, K, free = self._equations(n)
        return system.work(K, free, forces)

    def _equations(self, n: int) -> tuple[ConstrainedSystem, sp.csr_matrix, Floats]:
        """The linear system, its matrix of harmonic n, and a factor for each unknown: 0 if it is
        constrained, else 1.
        """
        fixed = np.concatenate([self._on_axis(n), self._constrained(n)])
        K = self.space.stiffness(self.materials, n)
        if n < 2:
            self._require_equilibrium(K, n)
        free = np.ones(K.shape[0])
        free[fixed] = 0.0
        if self._system is None:
            self._system = ConstrainedSystem(K)
        return self._system, K, free

    def motions(self, n: int, surfaces: Sequence[str], turns: Sequence[bool]) -> Floats:
        """The unknowns (unknowns, K) of harmonic n of unit motions of clamps, which are zero
        elsewhere.

        surfaces: K names; for "" the column is zero.
        turns: (K,) whether each motion is a rotation (1 rad) instead of a translation (1 m).
        """
        modes, out = rigid_motions(self.space.nodes, n), np.zeros((3 * len(self.space.nodes), 0))
        for surface, turn in zip(surfaces, turns, strict=True):
            mode = np.zeros(len(modes))
            if surface:
                nodes = np.unique(self.outline.nodes[self.outline.constrained((surface,))])
                rows = (3 * nodes[:, None] + np.arange(3)).ravel()
                mode[rows] = modes[rows, int(turn)] * (-1.0 if turn and n == 0 else 1.0)
            out = np.column_stack([out, mode])
        return out

    def _require_equilibrium(self, K: sp.csr_matrix, n: int) -> None:
        """Check that rigid-body motions of the section cause no nodal forces.

        The reactions of the supports then balance the loads, whatever the displacements are.

        Raises: SolveError.
        """
        modes = rigid_motions(self.space.nodes, n)
        lost = np.abs(K @ modes).max(axis=0) / (np.abs(K.data).max() * np.abs(modes).max(axis=0))
        if not lost.max() < 1e-9:
            raise SolveError(
                f"pin {self.pin.name}: the stiffness against rigid-body motion is {lost.max():.1e} "
                "of the pin's, not zero, so the solution would not be in equilibrium",
                "no-equilibrium",
            )

    def _on_axis(self, n: int) -> Ints:
        """The unknowns that vanish on the axis, so that displacements are smooth there."""
        axis = 3 * self.space.section.axis
        p, m, w = axis, axis + 1, axis + 2
        return np.concatenate({0: [p, m], 1: [p, w]}.get(n, [p, m, w]))

    def _constrained(self, n: int) -> Ints:
        """The unknowns that are zero on clamps or, without clamps, those that prevent rigid-body
        motions.
        """
        if self.clamps:
            edges = self.outline.nodes[self.outline.constrained(self.clamps)]
            return (3 * np.unique(edges)[:, None] + np.arange(3)).ravel()
        if n > 1:
            return np.zeros(0, dtype=np.int64)
        r, z = self.space.nodes.T
        place = np.abs(z - self.pivot * self.pin.length)
        if n == 0:  # prevent translation along the axis and rotation about it
            outer = int(np.lexsort((place, -r))[0])
            return np.array([3 * int(place.argmin()) + 2, 3 * outer])
        innermost = np.flatnonzero(r <= r.min() * (1.0 + 1e-9))
        near = int(innermost[place[innermost].argmin()])
        far = int(innermost[np.abs(z[innermost] - z[near]).argmax()])
        return np.array([3 * near + 1, 3 * far + 1])


# For each harmonic: the numbers (K,) of its loads, their nodal forces (unknowns, K), N, and their
# tractions (E, 3, 3, K), Pa, at the nodes of the outline's edges.
Forces = Mapping[int, tuple[Ints, Floats, Floats]]


def shares(on_single: Sequence[UnitLoad], loads: Sequence[UnitLoad]) -> Floats:
    """The amount (A, K) of each of A single-surface loads in each of K loads."""
    number = {load: k for k, load in enumerate(on_single)}
    out = np.zeros((len(on_single), len(loads)))
    for k, load in enumerate(loads):
        for one, amount in load.single_surface_loads.items():
            out[number[one], k] = amount
    return out


class HarmonicModel(HarmonicBody):
    """A pin on one mesh of its section, clamped at surfaces (by name), under unit loads.

    Without clamps, tractions on the bands react the imbalance of the loads (fea.core.tractions);
    `pivot` then changes the rigid-body motion and nothing else.

    Plasticity, contact and clearance are not included: loads are tractions.
    """

    def __init__(
        self, pin: Pin, section: MeridianMesh, material: Material, clamps: tuple[str, ...]
    ) -> None:
        super().__init__(pin, Section(section), material, clamps)
        self.material = material
        self._readings: dict[tuple[bytes, tuple[tuple[float, float], ...]], Reading] = {}

    def solve(
        self,
        loads: tuple[UnitLoad, ...],
        extra: Floats = NO_POINTS,
        ends: Iterable[tuple[float, float]] = (),
        solvers: dict[int, Solve] | None = None,
    ) -> MeridianFields:
        """The unit fields of loads.

        extra: (P, 2) m, additional points inside the section at which stress is read.
        ends: (r, z), m, the places on the outline where a pressure ends.
        solvers: the solver of each harmonic; missing ones are added and kept for later loads. None:
        none is kept.

        Raises: SolveError when the pin is not constrained or a check fails.
        """
        forces, shape = self._forces(loads), (len(self.space.nodes), 3, len(loads))
        u, applied, harmonics = np.zeros(shape), np.zeros(shape), np.zeros(len(loads), np.int64)
        tractions = np.zeros((*self.outline.nodes.shape, 3, len(loads)))
        for n, (here, on_nodes, on_edges) in forces.items():
            harmonics[here] = n
            moved = self._clamp_motions(n, loads, here)
            if solvers is None or moved is not None:
                u[:, :, here] = polar(self.displace(n, on_nodes, moved))
            else:
                if n not in solvers:
                    solvers[n] = self.solver(n)
                u[:, :, here] = polar(solvers[n](on_nodes))
            applied[:, :, here] = polar(on_nodes) * [[0.5], [0.5], [1.0]]
            tractions[..., here] = on_edges
        read = self._reading(extra, tuple(ends))
        displacement, stress = _read_in_blocks(read, harmonics, u, tractions)
        return MeridianFields(
            read.points,
            loads,
            stress,
            displacement,
            read.skin,
            self.space.unknowns,
            read.triangles,
            unread(read.jumps, read.points, read.skin),
            read.at_points(applied),
            self.space.section,
        )

    def _reading(self, extra: Floats, ends: tuple[tuple[float, float], ...]) -> Reading:
        """The points at which stress is read on this mesh and how; made once, since the first mesh
        is read again for other loads.
        """
        key = extra.tobytes(), ends
        if key not in self._readings:
            self._readings[key] = reading(
                self.space, self.outline, self.material, self.clamps, extra, ends
            )
        return self._readings[key]

    def _clamp_motions(self, n: int, loads: tuple[UnitLoad, ...], here: Ints) -> Floats | None:
        """The motions of clamps (unknowns, K) that the loads of harmonic n prescribe; None if there
        are none.

        here: (K,) the numbers of these loads.
        """
        units = [loads[k] for k in here]
        moves = [load.kind in ("shift", "turn") for load in units]
        if not any(moves):
            return None
        names = [load.surface if move else "" for load, move in zip(units, moves, strict=True)]
        return self.motions(n, names, [load.kind == "turn" for load in units])

    def _forces(self, loads: tuple[UnitLoad, ...]) -> Forces:
        harmonics = np.array([load.n for load in loads])
        rows = {n: np.flatnonzero(harmonics == n) for n in sorted(set(harmonics.tolist()))}
        return {n: (here, *self._applied(n, [loads[k] for k in here])) for n, here in rows.items()}

    def _applied(self, n: int, loads: list[UnitLoad]) -> tuple[Floats, Floats]:
        """The nodal forces (unknowns, K) and the tractions at the outline's nodes (E, 3, 3, K) of
        loads.
        """
        return applied(self, self.pin, self.outline, n, loads)


def _read_in_blocks(
    read: Reading, harmonics: Ints, u: Floats, tractions: Floats
) -> tuple[Floats, Floats]:
    """Return what Reading.of does, reading a block of loads at a time: the samples of all loads
    together would take several times the memory of the result.
    """
    count = len(harmonics)
    whole: list[Floats] = []
    for first in range(0, count, LOADS_READ_AT_ONCE):
        some = slice(first, first + LOADS_READ_AT_ONCE)
        parts = read.of(harmonics[some], u[..., some], tractions[..., some])
        whole = whole or [np.empty((*x.shape[:2], count)) for x in parts]
        for target, part in zip(whole, parts, strict=True):
            target[..., some] = part
    displacement, stress = whole
    return displacement, stress


def applied(
    model: HarmonicModel,
    pin: Pin,
    outline: Outline,
    n: int,
    loads: Sequence[UnitLoad],
    integrals: Floats | None = None,
) -> tuple[Floats, Floats]:
    """The nodal forces (unknowns, K) and the tractions (E, 3, 3, K) at the outline's nodes of unit
    loads.

    pin, outline: those of the model, or the same with nodes moved elsewhere.
    n: the harmonic of all loads.
    integrals: of the shape functions of the moved section (Section.integrals); those of the model
    by default.

    Raises: SolveError for a body load without a density, and for a pin with neither clamps nor
    connections.
    """

    def spread(parts: Sequence[tuple[Traction, ...]]) -> tuple[Floats, Floats]:
        forces = [generalised(outline.forces(part, n)) for part in parts]
        return np.stack(forces, axis=1), np.stack([outline.traction(p) for p in parts], axis=3)

    on_single = list(dict.fromkeys(one for load in loads for one in load.single_surface_loads))
    # Loads on rings have the same tractions in all harmonics; only the integral around the axis
    # differs. So they are assembled once, for n = 0, and scaled.
    on_rings = tuple(load._replace(n=0) for load in on_single if load.parts and not load.fades)
    if len(on_rings) < len(on_single):
        forces, tractions = spread([tractions_of(pin, load) for load in on_single])
    else:
        if on_rings not in outline.of_rings:
            forces, tractions = spread([tractions_of(pin, load) for load in on_rings])
            outline.of_rings = {on_rings: (forces / around(n), tractions)}
        forces, tractions = (x.copy() for x in outline.of_rings[on_rings])
        forces *= around(n)
    if on_single != list(loads):
        share = shares(on_single, loads)
        forces = np.asarray(forces @ share, np.float64)
        tractions = np.asarray(tractions @ share, np.float64)
    for k, load in enumerate(loads):
        if load.kind == "body":
            within = model.space.integrals if integrals is None else integrals
            forces[:, k] = body_force(model.material, n, within)
    if model.clamps or n > 1:
        return forces, tractions
    # Without clamps, closing tractions cancel the resultants of each load. They are pressures for
    # loads that do not shear their bands, since a shear would be singular at the bands' edges.
    modes = rigid_motions(outline.every_node, n)
    for shears in (True, False):
        here = [k for k, load in enumerate(loads) if load.shears == shears]
        phases = (0,) if n else (0, 1)
        closing = [c for p in phases for c in closing_tractions(pin, n, p, not shears)]
        on_unknowns, on_outline = spread(closing)
        amounts = -np.linalg.solve(modes.T @ on_unknowns, modes.T @ forces[:, here])
        forces[:, here] += on_unknowns @ amounts
        tractions[..., here] += on_outline @ amounts
    return forces, tractions


def body_force(material: Material, n: int, integrals: Floats) -> Floats:
    """The nodal forces of the pin's mass in 1 m/s^2 along x, or along z for n = 0.

    integrals: (N,) m^3, of the shape functions (Section.integrals).
    """
    amplitude = density_of(material) * (ALONG_X if n else ALONG_Z)
    return generalised(around(n) * integrals[:, None] * amplitude)


def generalised(forces: Floats) -> Floats:
    """The forces (3 N,) on the unknowns p, m, w from nodal forces (N, 3) along r, theta and z."""
    R, T, Z = forces.T
    return np.stack([R + T, R - T, Z], axis=1).ravel()


def polar(u: Floats) -> Floats:
    """The amplitudes U, V, W (N, 3, K) of the unknowns p, m, w."""
    p, m, w = (u[c::3] for c in range(3))
    return np.stack([p + m, p - m, w], axis=1)


def rigid_motions(nodes: Floats, n: int) -> Floats:
    """The unknowns (3 N, 2) of the rigid-body motions of harmonic 1 or 0.

    n = 1: translation along x, rotation about y. n = 0: translation along z, rotation about z. The
    work of a load on these motions is its resultant force and moment.
    """
    r, z = nodes.T
    zero = np.zeros_like(r)
    if n == 1:
        modes = ([zero, zero + 1.0, zero], [zero, z, -r])
    else:
        modes = ([zero, zero, zero + 1.0], [r / 2.0, -r / 2.0, zero])
    return np.stack([np.stack(mode, axis=1).ravel() for mode in modes], axis=1)

"""The piece of a pin about its cuts, under what the cuts relieve of the uncut pin's stress.

The displacement of the cut pin is that of the uncut one, and a difference: what the tractions
-s . n on the surfaces of the cuts do to the cut pin, s being the uncut pin's stress there, n the
outward normal. These tractions balance where no load acts on what is cut away, so that by
Saint-Venant's principle the difference is a rigid motion a diameter or so away: the piece about the
cuts is enough, free at its ends. All loads of the pin act on the uncut one alone, and whatever the
cuts change of its compliance moves its ends rigidly, which is no stress if supports are statically
determinate.

About mirror planes of the piece the difference is split by parity (fea.cut.parity): only what lies
on one side of them is meshed, and factored once for each class that acts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from fea.core.linear_solver import ConstrainedSystem, SolveError
from fea.core.material import Material
from fea.core.voigt import TENSOR_TO_VOIGT
from fea.cut.lost_loads import Bearing, trial_forces, trials
from fea.cut.parity import AXIS_NAMES, Parities
from fea.cut.surface_reading import Face, FaceReading, read_face
from fea.cut.two_level import MAX_FACTORED_UNKNOWNS, TwoLevel
from fea.solid.assembly import Discretisation
from fea.solid.boundary import QUARTER_TRIANGLES, area_vectors, quadrature, slopes_at, surface
from geometry.mesh.cut_piece import Piece
from geometry.mesh.solid_mesh import SolidMesh
from pinbase.arrays import Floats, Ints, Mask

MIN_CLASS_TRACTION = 2e-4  # of the tractions: less of a class is the noise of the section's mesh
TRACTION_RANK_TOLERANCE = 1e-5  # of the tractions of a class: what less of them does is not solved
MAX_UNBALANCED_TRACTION = 0.1  # of the tractions, by the section's mesh
ROUNDED_CORNER_SCATTER = (
    0.06  # scatter of stress on rounded corners on the first mesh, by flats and keyways
)
MIN_READ_STRESS = 0.02  # of the pin's largest stress: less of it is not looked at
END_SURFACES = ("start", "end")


@dataclass(frozen=True)
class Read:
    """At points (P, 3), m, of a piece, those of each image after the other: the stress of the cut
    pin (P, 6, L), Pa, and by how much it is not that of the uncut one; which are on a cut;
    displaced: (P, 3, L) m by how much the cuts move them, besides a rigid motion of all. moved: (2,
    6, L) by how much they move the piece's lower and upper ends, besides the same motion, as a
    shift (m) and a turn (rad) about the origin of its frame.
    """

    points: Floats
    stress: Floats
    difference: Floats
    cut: Mask
    displaced: Floats
    moved: Floats


class LocalModel:
    """A piece on one mesh, `finer` than the first. clamps: names of clamped surfaces of it.
    bearings: loaded bands with cuts in them.
    """

    def __init__(
        self,
        piece: Piece,
        solid: SolidMesh,
        material: Material,
        clamps: tuple[str, ...] = (),
        bearings: tuple[Bearing, ...] = (),
        finer: float = 1.0,
    ) -> None:
        self.piece, self.material, self.clamps, self.finer = piece, material, clamps, finer
        self.bearings = bearings
        self.space = Discretisation(solid.mesh)
        self.surface = surface(self.space)
        self.parities = Parities(piece.mirrors)
        self.readings = tuple(self._readings())

    @property
    def unknowns(self) -> int:
        """Displacement components, constrained ones included."""
        return self.space.unknowns

    def mirrored(self, boundary: str) -> bool:
        """Whether a boundary of the mesh is a mirror plane."""
        amid = boundary == "start" and "z" in self.piece.mirrors
        return amid or boundary.startswith("mirror ")

    def _readings(self) -> list[FaceReading]:
        out = []
        for name in self.space.mesh.boundaries:
            if name in END_SURFACES or self.mirrored(name) or name in self.clamps:
                continue
            rows = np.flatnonzero(self.surface.on(self.space, (name,)))
            face = Face(name, rows, self.piece.cut_at(name) is not None)
            out.append(read_face(self.space, self.surface, face, self.parities))
        return out

    @cached_property
    def cut(self) -> Mask:
        """(P,) which points are on cuts."""
        parts = [np.full(len(r.nodes), r.face.cut) for r in self.readings]
        return np.concatenate(parts)

    @cached_property
    def scatter(self) -> Floats:
        """(P,) of the stress at the points with the positions of nodes, relative, beyond that of
        all pieces.
        """
        parts = [
            np.full(
                len(r.nodes), ROUNDED_CORNER_SCATTER * r.face.name.endswith(("fillet", "mouth"))
            )
            for r in self.readings
        ]
        return np.asarray(np.concatenate(parts) / self.finer**2)

    @cached_property
    def nodes(self) -> Ints:
        """Of its faces, face by face, (P,)."""
        return np.concatenate([r.nodes for r in self.readings])

    @cached_property
    def points(self) -> Floats:
        """These nodes (P, 3), m, from the mirror plane or the lower end on."""
        return np.asarray(self.space.nodes[self.nodes])

    @property
    def images(self) -> Floats:
        """The points and their images, (G, P, 3)."""
        return np.asarray(self.parities.images[:, None] * self.points)

    def solve(
        self,
        uncut: Floats,
        most: Floats | float = 0.0,
        shears: Sequence[bool] = (),
        weight: Floats | float = 1.0,
    ) -> Read:
        """Of the stress of the uncut pin at all images (G, P, 6, L), Pa, along x, y and z. most:
        the largest anywhere in the pin, (L,). shears: which loads shear the bands they act on, all
        by default. weight: (L,) how accurate each must be.

        Raises: SolveError.
        """
        by_kind = np.ones(uncut.shape[3], dtype=bool)
        by_kind[: len(shears)] = shears
        by_class = self.parities.split(uncut)
        largest = np.maximum(
            np.abs(by_class[:, self.cut]).max(axis=(0, 1, 2)), MIN_READ_STRESS * most
        )
        scale = np.where(largest > 0.0, largest, 1.0) / weight
        difference = np.zeros_like(by_class)
        moved = np.zeros((2, 6, uncut.shape[3]))
        displaced = np.zeros((*by_class.shape[:2], 3, uncut.shape[3]))
        forces = [self._forces(part / scale) for part in by_class]
        pressed = self._forces(_pressure(len(self.points)))
        most = max(float(np.linalg.norm(f)) for f in (pressed, *forces))
        whole = np.maximum(_size(pressed), np.sum([_size(f) for f in forces], axis=0))
        for c, parity in enumerate(self.parities.classes):
            if np.linalg.norm(forces[c]) > MIN_CLASS_TRACTION * most:
                more, spread = self._spread(by_class[c] / scale, parity, by_kind)
                u = self._displace(forces[c] + more, parity, whole)
                moved += self._moved(u, parity) * scale
                displaced[c] = u.reshape(-1, 3, u.shape[1])[self.nodes] * scale
                difference[c] = self._stress(u, by_class[c] / scale, spread, c) * scale
        total = self._in_faces(by_class) + difference
        total[:, self.cut, 2:5] = 0.0
        whole, changed = (self._everywhere(x) for x in (total, difference))
        cut = np.tile(self.cut, len(by_class))
        displaced = self.parities.everywhere(displaced)
        return Read(self.images.reshape(-1, 3), whole, changed, cut, displaced, moved)

    def _moved(self, u: Floats, parity: tuple[int, ...]) -> Floats:
        """The rigid motions (2, 6, L) of both ends by displacements (3 N, L) of a class. Of what
        its mirror planes leave only those that belong to the class; about the origin.
        """
        out, boundaries = np.zeros((2, 6, u.shape[1])), self.space.mesh.boundaries
        across = dict(zip(self.parities.mirrors, parity, strict=True))
        around = Parities(tuple(m for m in across if m != "z"))
        own = around.rigid(tuple(s for m, s in across.items() if m != "z"))
        for e, name in enumerate(END_SURFACES):
            if name not in boundaries or (name == "start" and "z" in across):
                continue
            nodes = self.space.basis.get_dofs(boundaries[name]).flatten()
            rows = (3 * nodes[:, None] + np.arange(3)).ravel()
            modes = _rigid(self.space.nodes)[rows][:, own]
            out[e, own] = np.linalg.lstsq(modes, u[rows])[0]
        out[:, 3:] /= np.abs(self.space.nodes).max()
        if "z" in across:  # u(M x) = parity M u(x): shifts but that along z, and the spin, as u
            sign = across["z"] * np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
            out[0] = sign[:, None] * out[1]
        return out

    def _everywhere(self, by_class: Floats) -> Floats:
        """Stress (C, P, 6, L) along the faces' directions along x, y, z at all images, (G P, 6,
        L).
        """
        back = np.concatenate([r.directions for r in self.readings]).swapaxes(1, 2)
        summed = np.tensordot(self.parities.characters.T, by_class, axes=1)
        found = np.stack([rotated(part, back) for part in summed])
        found *= self.parities.stress_signs[:, None, :, None]
        return np.asarray(found.reshape(-1, *found.shape[2:]))

    @cached_property
    def triangles(self) -> Ints:
        """(M, 3) of the points at all images: the faces, four to a facet."""
        first, out = 0, []
        for r in self.readings:
            corners = np.searchsorted(r.nodes, self.surface.corners[r.face.rows])
            out.append(first + corners[:, QUARTER_TRIANGLES].reshape(-1, 3))
            first += len(r.nodes)
        one = np.concatenate(out)
        shift = first * np.arange(len(self.parities.images))
        return np.asarray((one + shift[:, None, None]).reshape(-1, 3))

    def _spread(
        self, stress: Floats, parity: tuple[int, ...], shears: Mask
    ) -> tuple[Floats, Floats]:
        """What of a class acted on bands where they are cut away, on the rest of them: nodal forces
        (3 N, L), and tractions (P, 3, L) at the points.
        """
        forces = np.zeros((self.unknowns, stress.shape[2]))
        at_points = np.zeros((len(self.points), 3, stress.shape[2]))
        own = self.parities.rigid(parity)
        modes = _rigid(self.space.nodes)[:, own]
        for bearing in self.bearings if own.any() else ():
            lost = modes.T @ self._forces(stress, bearing.cuts)
            on = bearing.on(self.points, self.normals) & ~self.cut
            for shear in (True, False):
                here = np.flatnonzero(shears == shear)
                trial = trial_forces(self.space, self.surface, bearing, shear)[:, own]
                amount = -np.linalg.solve(modes.T @ trial, lost[:, here])
                forces[:, here] += trial @ amount
                t = trials(self.points[on], self.normals[on], shear)[..., own]
                at_points[np.ix_(on, np.arange(3), here)] += t @ amount
        return forces, at_points

    @cached_property
    def normals(self) -> Floats:
        """At the points, outwards, (P, 3)."""
        return np.concatenate([r.directions[:, 2] for r in self.readings])

    def _forces(self, stress: Floats, only: tuple[str, ...] = ()) -> Floats:
        """Nodal forces (3 N, L) of the tractions that relieve cuts, or some of them by name, of a
        stress (P, 6, L).
        """
        out = np.zeros((len(self.space.nodes), 3, stress.shape[2]))
        (x, y), weight = quadrature()
        shapes, _ = slopes_at(x, y)
        first = 0
        for r in self.readings:
            here = stress[first : first + len(r.nodes)]
            first += len(r.nodes)
            if not r.face.cut or (only and self.piece.cut_at(r.face.name) not in only):
                continue
            corners = self.surface.corners[r.face.rows]
            area = area_vectors(self.space.nodes[corners], x, y)
            normals = self.surface.normals[r.face.rows].mean(axis=1)
            area *= np.sign(np.sum(area * normals[:, None], axis=2))[..., None]
            local = here[np.searchsorted(r.nodes, corners)][
                :, :, TENSOR_TO_VOIGT
            ]  # (F, 6, 3, 3, L)
            at = np.einsum("qi,fiabl->fqabl", shapes, local)
            t = np.einsum("q,fqabl,fqb->fqal", weight, at, area)
            np.add.at(out, corners, -np.einsum("qi,fqal->fial", shapes, t))
        return out.reshape(-1, stress.shape[2])

    def _displace(self, forces: Floats, parity: tuple[int, ...], whole: Floats) -> Floats:
        """Displacements (3 N, L) of a class, of as many fields as differ; balanced before. whole:
        the size of all classes' forces.
        """
        free = np.ones(self.unknowns)
        free[self._fixed(parity)] = 0.0
        held = np.zeros(0, dtype=np.int64)
        if not self.clamps:
            modes = _rigid(self.space.nodes)[:, self.parities.rigid(parity)]
            forces = self._balanced(forces, modes, whole)
            if count := modes.shape[1]:
                at = np.flatnonzero(free * self._at_corners)
                _, _, pivot = scipy.linalg.qr(modes[at].T, mode="economic", pivoting=True)
                held = at[pivot[:count]]
        left, size, right = scipy.linalg.svd(free[:, None] * forces, full_matrices=False)
        rank = int(np.sum(size > TRACTION_RANK_TOLERANCE * size[0]))
        some = left[:, :rank] * size[:rank]
        found = (
            self._two_level.solve(free, held, some)
            if self.unknowns > MAX_FACTORED_UNKNOWNS
            else None
        )
        if found is None:
            free[held] = 0.0
            found = self._system.solve(self.stiffness.copy(), free, some)
        return np.asarray(found @ right[:rank])

    @cached_property
    def _at_corners(self) -> Floats:
        """(3 N,) 1 for unknowns of corners of elements, 0 amid their edges."""
        out = np.zeros((len(self.space.nodes), 3))
        out[self.space.elements[:, :4]] = 1.0
        return out.ravel()

    @cached_property
    def _two_level(self) -> TwoLevel:
        return TwoLevel(self.space, self.stiffness)

    @cached_property
    def _system(self) -> ConstrainedSystem:
        return ConstrainedSystem(self.stiffness, np.arange(self.unknowns) // 3)

    @cached_property
    def stiffness(self) -> sp.csr_matrix:
        """N/m."""
        return self.space.stiffness(self.material)

    def _fixed(self, parity: tuple[int, ...]) -> Ints:
        """Unknowns that are zero on mirror planes and clamps."""
        found = [np.zeros(0, dtype=np.int64)]
        boundaries = self.space.mesh.boundaries

        def add(name: str, components: tuple[int, ...]) -> None:
            nodes = self.space.basis.get_dofs(boundaries[name]).flatten()
            found.extend(3 * nodes + a for a in components)

        for mirror, components in self.parities.fixed(parity).items():
            add("start" if mirror == "z" else f"mirror {mirror}", components)
        for name in self.clamps:
            add(name, (0, 1, 2))
        return np.unique(np.concatenate(found))

    def _balanced(self, forces: Floats, modes: Floats, whole: Floats) -> Floats:
        """Without the resultant that the mesh of the section leaves, taken up by the cuts' nodes.

        Raises: SolveError when it is more than that.
        """
        if not modes.shape[1]:
            return forces
        lost = np.abs(modes.T @ forces) / (np.abs(modes).T @ whole + 1e-300)
        if not lost.max() < MAX_UNBALANCED_TRACTION:
            raise SolveError(
                f"pin {self.piece.profile.name}: the stress of the uncut pin on the cuts is not in "
                f"equilibrium (by {lost.max():.1e}), so a load acts on what is cut away",
                "cut-unbalanced",
            )
        there = np.linalg.norm(forces.reshape(len(self.space.nodes), -1), axis=1)
        weight = there.repeat(3)[:, None] * modes
        return np.asarray(forces - weight @ np.linalg.solve(modes.T @ weight, modes.T @ forces))

    def _stress(self, u: Floats, uncut: Floats, spread: Floats, c: int) -> Floats:
        """What a displacement (3 N, L) adds to the stress of the uncut pin (P, 6, L), along the
        faces' directions. spread: tractions (P, 3, L) that act besides.
        """
        E, nu, mu = self.material.youngs_modulus, self.material.poisson_ratio, self.material.lame[1]
        out, first = np.zeros((*uncut.shape[:2], u.shape[1])), 0
        character = self.parities.characters[c]
        for r in self.readings:
            here = slice(first, first + len(r.nodes))
            first += len(r.nodes)
            e = r.strain(u.reshape(-1, 3, u.shape[1]), self.parities, character)
            out[here, [4, 3, 2]] = np.einsum("pia,pal->pil", r.directions, spread[here])
            normal = out[here, 2]
            if r.face.cut:
                normal = -rotated(uncut[here], r.directions)[:, 2]
            plane = E / (1.0 - nu**2)
            out[here, 0] = plane * (e[:, 0] + nu * e[:, 1]) + nu / (1.0 - nu) * normal
            out[here, 1] = plane * (e[:, 1] + nu * e[:, 0]) + nu / (1.0 - nu) * normal
            out[here, 5] = 2.0 * mu * e[:, 2]
        return out

    def _in_faces(self, stress: Floats) -> Floats:
        """Stress (C, P, 6, L) along x, y, z along the faces' directions."""
        directions = np.concatenate([r.directions for r in self.readings])
        return np.stack([rotated(part, directions) for part in stress])


def rotated(stress: Floats, directions: Floats) -> Floats:
    """Components of stress (P, 6, L) along directions (P, 3, 3)."""
    s = stress[:, TENSOR_TO_VOIGT]  # (P, 3, 3, L)
    t = np.einsum("pia,pabl,pjb->pijl", directions, s, directions, optimize=True)
    return np.stack([t[:, 0, 0], t[:, 1, 1], t[:, 2, 2], t[:, 1, 2], t[:, 0, 2], t[:, 0, 1]], 1)


def _pressure(count: int) -> Floats:
    """A stress of one in all directions, (P, 6, 1)."""
    return np.repeat([[1.0], [1.0], [1.0], [0.0], [0.0], [0.0]], count, axis=1).T[..., None]


def _size(forces: Floats) -> Floats:
    """The size of nodal forces (3 N, L) in place of their components."""
    size = np.linalg.norm(forces.reshape(-1, 3, forces.shape[1]), axis=1)
    return np.asarray(size.repeat(3, axis=0))


def _rigid(nodes: Floats) -> Floats:
    """Shifts along the axes and turns about them (3 N, 6), lengths scaled."""
    x = nodes / np.abs(nodes).max()
    modes = np.zeros((len(x), 3, 6))
    for a in range(len(AXIS_NAMES)):
        b, c = (a + 1) % 3, (a + 2) % 3
        modes[:, a, a] = 1.0
        modes[:, b, 3 + a], modes[:, c, 3 + a] = -x[:, c], x[:, b]
    return modes.reshape(-1, 6)

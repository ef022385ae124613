"""The piece of a pin about its cuts as a solid, loaded by the tractions that its cuts relieve.

The displacement of the cut pin is that of the uncut one plus a difference: the response of the cut
pin to the tractions -s . n on the surfaces of the cuts, s being the uncut pin's stress there, n the
outward normal. These tractions are in equilibrium where no load acts on what is cut away, so by
Saint-Venant's principle the difference is a rigid motion a diameter or so away: the piece about the
cuts is enough, free at its ends. All loads of the pin act on the uncut one alone. The change of
compliance by the cuts moves the ends of the piece rigidly, which is no stress if supports are
statically determinate.

If the piece has mirror planes, the difference is split by parity (fea.cut.parity): only one side of
the planes is meshed, and the system is factored once for each class that acts.

`LocalModel.solve` takes the uncut stress and goes through these steps for each class: nodal forces
of the relieving tractions (`_forces`); lost loads moved to the rest of their bands (`_spread`);
balance, constraints and solution (fea.cut.piece_system); motions of the ends
(`_moved`); stress on the faces from surface strains and known tractions (`_stress`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from fea.core.material import Material
from fea.core.voigt import TENSOR_TO_VOIGT, rotation
from fea.cut.interior import InnerFields
from fea.cut.lost_loads import Bearing, trial_forces, trials
from fea.cut.parity import Parities
from fea.cut.piece_system import Combined, PieceSystem
from fea.cut.surface_reading import Face, FaceReading, read_face
from fea.solid.assembly import Discretisation
from fea.solid.boundary import QUARTER_TRIANGLES, area_vectors, quadrature, slopes_at, surface
from fea.solid.model import rigid_modes
from geometry.mesh.cut_piece import Piece
from geometry.mesh.solid_mesh import SolidMesh
from pinbase.arrays import Floats, Ints, Mask

# Chosen by judgement, as parts of the tractions on the cuts or of the pin's largest stress:
MIN_CLASS_TRACTION = 2e-4  # a smaller class is the noise of the section's mesh
MIN_READ_STRESS = 0.02  # stress below it is not resolved
# Relative scatter of stress on rounded corners on the first mesh, measured on flats and keyways
# (`python -m benchmarks cut-scatter`).
ROUNDED_CORNER_SCATTER = 0.06
END_SURFACES = ("start", "end")


@dataclass(frozen=True)
class Read:
    """The solution at points (P, 3), m, of a piece, image after image.

    stress: (P, 6, L) Pa, of the cut pin.
    difference: (P, 6, L) Pa, from the uncut pin.
    cut: (P,) which points are on a cut.
    displaced: (P, 3, L) m, displacements by the cuts, up to a rigid motion of the whole.
    moved: (2, 6, L) motions of the piece's lower and upper ends by the cuts, up to the same motion,
    as a shift (m) and a turn (rad) about the origin of its frame.
    inner: the displacements by the cuts at all nodes of its mesh.
    """

    points: Floats
    stress: Floats
    difference: Floats
    cut: Mask
    displaced: Floats
    moved: Floats
    inner: InnerFields


class LocalModel:
    """A piece on one mesh, `finer` than the first one.

    clamps: names of its clamped surfaces.
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
        self.system = PieceSystem(piece.profile.name, self.space, material, clamps, self.parities)
        self.readings = tuple(self._readings())

    @property
    def unknowns(self) -> int:
        """Number of displacement components, constrained ones included."""
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
        """Mask (P,) of the points on cuts."""
        parts = [np.full(len(r.nodes), r.face.cut) for r in self.readings]
        return np.concatenate(parts)

    @cached_property
    def scatter(self) -> Floats:
        """Relative scatter (P,) of stress with the positions of nodes, of rounded corners."""
        parts = [
            np.full(
                len(r.nodes), ROUNDED_CORNER_SCATTER * r.face.name.endswith(("fillet", "mouth"))
            )
            for r in self.readings
        ]
        return np.asarray(np.concatenate(parts) / self.finer**2)

    @cached_property
    def nodes(self) -> Ints:
        """Node numbers (P,) of its faces, face by face."""
        return np.concatenate([r.nodes for r in self.readings])

    @cached_property
    def points(self) -> Floats:
        """The nodes of its faces (P, 3), m, from the mirror plane or the lower end on."""
        return np.asarray(self.space.nodes[self.nodes])

    @property
    def images(self) -> Floats:
        """The points and their mirror images, (G, P, 3)."""
        return np.asarray(self.parities.images[:, None] * self.points)

    def solve(
        self,
        uncut: Floats,
        most: Floats | float = 0.0,
        shears: Sequence[bool] = (),
        weight: Floats | float = 1.0,
    ) -> Read:
        """The solution under what the cuts relieve of the uncut pin's stress.

        uncut: (G, P, 6, L) Pa, the uncut pin's stress at all images, along x, y and z.
        most: (L,) Pa, its largest anywhere in the pin.
        shears: (L,) which loads shear the bands they act on, all by default.
        weight: (L,) how accurate each load must be.

        Raises: SolveError.
        """
        by_kind = np.ones(uncut.shape[3], dtype=bool)
        by_kind[: len(shears)] = shears
        # Step 1: split by parity, and scale the loads so that each weighs by its accuracy. (These
        # arrays are the largest of all, so that there are as few of them as can be.)
        by_class = self.parities.split(uncut)
        largest = np.maximum(
            np.abs(by_class[:, self.cut]).max(axis=(0, 1, 2)), MIN_READ_STRESS * most
        )
        scale = np.where(largest > 0.0, largest, 1.0) / weight
        by_class /= scale
        difference = np.zeros_like(by_class)
        moved = np.zeros((2, 6, uncut.shape[3]))
        displaced = np.zeros((*by_class.shape[:2], 3, uncut.shape[3]))
        inside: dict[int, Combined] = {}
        # Step 2: nodal forces of the tractions that relieve the cuts, and their size in all
        # classes.
        forces, acting, whole = self._relieving(by_class)
        # Step 3: solve each class that acts.
        for c, parity in enumerate(self.parities.classes):
            if acting[c]:
                more, spread = self._spread(by_class[c], parity, by_kind)
                u = self.system.displace(self.loaded, forces[c] + more, parity, whole)
                moved += self._moved(u.few, parity) @ u.amounts * scale
                inside[c] = Combined(u.few.astype(np.float32), u.amounts * scale)
                on_faces = (3 * self.nodes[:, None] + np.arange(3)).ravel()
                displaced[c] = u.at(on_faces).reshape(displaced.shape[1:]) * scale
                difference[c] = self._stress(u, by_class[c], spread, c) * scale
        # Step 4: add the uncut stress. Cuts are free of traction.
        del by_class
        changed = self._everywhere(difference)
        total = uncut.reshape(changed.shape) + changed
        cut = np.tile(self.cut, len(uncut))
        total[cut] = self._without_traction(total[cut])
        displaced = self.parities.everywhere(displaced)
        inner = InnerFields(self.space.mesh, self.parities, self.material, inside)
        return Read(self.images.reshape(-1, 3), total, changed, cut, displaced, moved, inner)

    @cached_property
    def nodes_once(self) -> Ints:
        """Node numbers (S,) of its faces, each once."""
        return np.unique(self.nodes)

    @cached_property
    def loaded(self) -> Ints:
        """The numbers (3 S,) of the unknowns at these nodes, the only ones on which forces act."""
        return np.asarray((3 * self.nodes_once[:, None] + np.arange(3)).ravel())

    @cached_property
    def _rigid(self) -> Floats:
        """Rigid motions (3 S, 6) at these unknowns."""
        return rigid_modes(self.space.nodes)[self.loaded]

    def reliefs(self, uncut: Floats) -> list[Floats]:
        """The balanced nodal forces (3 S, L) that relieve the cuts of a stress of the uncut pin, by
        class; none are zero.

        uncut: as for `solve`, under loads that do not shear the bands they act on.

        Raises: SolveError.
        """
        by_class, shears = self.parities.split(uncut), np.zeros(uncut.shape[3], dtype=bool)
        forces, acting, whole = self._relieving(by_class)
        out = []
        for c, parity in enumerate(self.parities.classes):
            part, f = by_class[c], forces[c]
            if not acting[c]:
                out.append(np.zeros_like(f))
                continue
            modes = self._rigid[:, self.parities.rigid(parity)]
            every = f + self._spread(part, parity, shears)[0]
            out.append(self.system.balanced(every, modes, whole))
        return out

    def _relieving(self, by_class: Floats) -> tuple[list[Floats], list[bool], Floats]:
        """The nodal forces (3 S, L) of the tractions that relieve the cuts, by class; which classes
        act, as the smaller ones are noise of the section's mesh; and the size (L,) of all of them.
        """
        forces = [self._forces(part) for part in by_class]
        pressed = self._forces(_pressure(len(self.points)))
        sizes = [float(np.linalg.norm(f)) for f in forces]
        most = max(float(np.linalg.norm(pressed)), *sizes)
        whole = np.maximum(_size(pressed), np.sum([_size(f) for f in forces], axis=0))
        return forces, [size > MIN_CLASS_TRACTION * most for size in sizes], whole

    def displaced(self, forces: Floats, parity: tuple[int, ...], tolerance: float) -> Floats:
        """Displacements (3 S, L) of a class under balanced nodal forces (3 S, L).

        tolerance: of iterations, as of fea.cut.two_level.
        """
        u = self.system.displace(self.loaded, forces, parity, _size(forces), tolerance)
        return u.at(self.loaded)

    def _moved(self, u: Floats, parity: tuple[int, ...]) -> Floats:
        """The rigid motions (2, 6, L) of both ends by displacements (3 N, L) of a class.

        Mirror planes leave only those motions that belong to the class.
        """
        out, boundaries = np.zeros((2, 6, u.shape[1])), self.space.mesh.boundaries
        across = dict(zip(self.parities.mirrors, parity, strict=True))
        around = Parities(tuple(m for m in across if m != "z"))
        allowed = around.rigid(tuple(s for m, s in across.items() if m != "z"))
        for e, name in enumerate(END_SURFACES):
            if name not in boundaries or (name == "start" and "z" in across):
                continue
            nodes = self.space.basis.get_dofs(boundaries[name]).flatten()
            rows = (3 * nodes[:, None] + np.arange(3)).ravel()
            modes = rigid_modes(self.space.nodes)[rows][:, allowed]
            out[e, allowed] = np.linalg.lstsq(modes, u[rows])[0]
        out[:, 3:] /= np.abs(self.space.nodes).max()
        if "z" in across:  # u(M x) = parity M u(x): shifts but that along z, and the spin, as u
            sign = across["z"] * np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
            out[0] = sign[:, None] * out[1]
        return out

    def _everywhere(self, by_class: Floats) -> Floats:
        """Stress along x, y, z at all images, (G P, 6, L), from that along the faces' directions.

        by_class: (C, P, 6, L).
        """
        back = rotation(np.swapaxes(self.directions, 1, 2))
        summed = np.tensordot(self.parities.characters.T, by_class, axes=1)
        for image, signs in zip(summed, self.parities.stress_signs, strict=True):
            image[:] = back @ image
            image *= signs[:, None]
        return np.asarray(summed.reshape(-1, *summed.shape[2:]))

    def _without_traction(self, stress: Floats) -> Floats:
        """Stress (G C, 6, L) along x, y, z at all images of the C points on cuts, without the
        components zz, yz and xz along the faces' directions, whose z is normal to the face.
        """
        to_faces = rotation(self.directions[self.cut])
        to_faces[:, 2:5] = 0.0
        free = rotation(np.swapaxes(self.directions[self.cut], 1, 2)) @ to_faces
        signs = self.parities.stress_signs[:, None, :, None]
        images = stress.reshape(len(signs), -1, *stress.shape[1:])
        return np.asarray((free @ (images * signs) * signs).reshape(stress.shape))

    @cached_property
    def directions(self) -> Floats:
        """Two directions (P, 3, 3) along the face at each point, and its outward normal."""
        return np.concatenate([r.directions for r in self.readings])

    @cached_property
    def triangles(self) -> Ints:
        """Triangles (M, 3) of the points at all images: the faces, four to a facet."""
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
        """The loads on removed areas, moved to the rest of their bands (lost_loads).

        Returns nodal forces (3 S, L), and tractions (P, 3, L) at the points.
        stress: (P, 6, L) Pa, the uncut pin's.
        shears: (L,).
        """
        forces = np.zeros((len(self.loaded), stress.shape[2]))
        at_points = np.zeros((len(self.points), 3, stress.shape[2]))
        allowed = self.parities.rigid(parity)
        modes = self._rigid[:, allowed]
        for bearing in self.bearings if allowed.any() else ():
            # The resultants that the cuts' tractions take from the band, in the motions of the
            # class.
            lost = modes.T @ self._forces(stress, bearing.cuts)
            on = bearing.on(self.points, self.normals) & ~self.cut
            for shear in np.unique(shears).tolist():
                here = np.flatnonzero(shears == shear)
                trial = trial_forces(self.space, self.surface, bearing, shear)
                trial = trial[self.loaded][:, allowed]
                # Amounts of the trial tractions that restore these resultants.
                amount = -np.linalg.solve(modes.T @ trial, lost[:, here])
                forces[:, here] += trial @ amount
                t = trials(self.points[on], self.normals[on], shear)[..., allowed]
                at_points[np.ix_(on, np.arange(3), here)] += t @ amount
        return forces, at_points

    @cached_property
    def normals(self) -> Floats:
        """Outward normals (P, 3) at the points."""
        return self.directions[:, 2]

    def _forces(self, stress: Floats, only: tuple[str, ...] = ()) -> Floats:
        """Nodal forces (3 S, L) of the tractions -s . n that relieve cuts of a stress (P, 6, L).

        only: names of cuts, all by default.
        """
        out = np.zeros((len(self.loaded), stress.shape[2]))
        for cut, points, matrix in self._relief_of_faces:
            if not only or cut in only:
                out += matrix @ stress[points].reshape(-1, stress.shape[2])
        return out

    @cached_property
    def _relief_of_faces(self) -> list[tuple[str | None, slice, sp.csr_matrix]]:
        """The faces of cuts: the cut, the points on its face, and the matrix that makes nodal
        forces (3 S,) of the stress (6 P,) at these.
        """
        (x, y), weight = quadrature()
        shapes, _ = slopes_at(x, y)
        first, out = 0, []
        for r in self.readings:
            here = slice(first, first + len(r.nodes))
            first = here.stop
            if not r.face.cut:
                continue
            corners = self.surface.corners[r.face.rows]
            area = area_vectors(self.space.nodes[corners], x, y)
            normals = self.surface.normals[r.face.rows].mean(axis=1)
            area *= np.sign(np.sum(area * normals[:, None], axis=2))[..., None]
            # Component a of the force at a facet's node i by component ab of the stress at node j.
            each = -np.einsum("q,qi,qj,fqb->fijb", weight, shapes, shapes, area, optimize=True)
            each = np.broadcast_to(each[..., None, :], (*each.shape[:3], 3, 3))
            nodes = np.searchsorted(self.nodes_once, corners)
            forces = 3 * nodes[:, :, None, None, None] + np.arange(3)[:, None]
            at = np.searchsorted(r.nodes, corners)[:, None, :, None, None]
            rows: Ints = np.broadcast_to(forces, each.shape).ravel()
            columns: Ints = np.broadcast_to(6 * at + TENSOR_TO_VOIGT, each.shape).ravel()
            shape = len(self.loaded), 6 * len(r.nodes)
            matrix = sp.coo_matrix((each.ravel(), (rows, columns)), shape=shape).tocsr()
            out.append((self.piece.cut_at(r.face.name), here, matrix))
        return out

    def _stress(self, u: Combined, uncut: Floats, spread: Floats, c: int) -> Floats:
        """The stress (P, 6, L) that displacements add, along faces' directions.

        spread: (P, 3, L) Pa, tractions that act besides.
        c: number of the class.
        """
        E, nu, mu = self.material.youngs_modulus, self.material.poisson_ratio, self.material.lame[1]
        out, first = np.zeros(uncut.shape), 0
        character, few = self.parities.characters[c], u.few.reshape(-1, 3, u.few.shape[1])
        for r in self.readings:
            here = slice(first, first + len(r.nodes))
            first += len(r.nodes)
            e = r.strain(few, self.parities, character) @ u.amounts
            # Components along the normal are the known tractions; on cuts minus those of the uncut
            # stress.
            out[here, [4, 3, 2]] = np.einsum("pia,pal->pil", r.directions, spread[here])
            normal = out[here, 2]
            if r.face.cut:
                normal = -(rotation(r.directions)[:, 2:3] @ uncut[here])[:, 0]
            # The others follow from the strains in the surface by Hooke's law with a known normal
            # stress.
            plane = E / (1.0 - nu**2)
            out[here, 0] = plane * (e[:, 0] + nu * e[:, 1]) + nu / (1.0 - nu) * normal
            out[here, 1] = plane * (e[:, 1] + nu * e[:, 0]) + nu / (1.0 - nu) * normal
            out[here, 5] = 2.0 * mu * e[:, 2]
        return out


def _pressure(count: int) -> Floats:
    """The stress (P, 6, 1) of a unit tension in all directions."""
    return np.repeat([[1.0], [1.0], [1.0], [0.0], [0.0], [0.0]], count, axis=1).T[..., None]


def _size(forces: Floats) -> Floats:
    """The size of nodal forces (3 S, L), repeated for their three components."""
    size = np.linalg.norm(forces.reshape(-1, 3, forces.shape[1]), axis=1)
    return np.asarray(size.repeat(3, axis=0))

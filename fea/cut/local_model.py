"""The piece of a pin about its cuts as a solid, loaded by the tractions that relieve its cuts.

The displacement of the cut pin is that of the uncut one plus a difference. The difference is the
response of the cut pin to the tractions -s . n on the surfaces of the cuts, s being the stress of
the uncut pin there and n the outward normal. These tractions are in equilibrium if no load acts on
the removed material. So, by Saint-Venant's principle, the difference is a rigid-body motion at a
distance of about a diameter: it is enough to solve the piece about the cuts, free at its ends. All
loads of the pin act on the uncut pin alone. The compliance that the cuts add moves the ends of the
piece rigidly, which causes no stress if supports are statically determinate.

If the piece has mirror planes, the difference is split by parity (fea.cut.parity): only one side of
the planes is meshed, and the system is factored once for each parity class that acts.

`LocalModel.solve` takes the uncut stress and goes through these steps for each class: nodal forces
of the relieving tractions, and lost loads moved to the rest of their bands (fea.cut.relief);
balance, constraints and solution (fea.cut.piece_system); motions of the ends (`_moved`); stress on
the faces from surface strains and known tractions (`_stress`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.core.material import Material
from fea.core.voigt import rotation
from fea.cut.interior import InnerFields
from fea.cut.lost_loads import Bearing
from fea.cut.parity import Parities
from fea.cut.piece_faces import END_SURFACES, PieceFaces
from fea.cut.piece_system import Combined, PieceSystem
from fea.cut.relief import Relief, nodal_size
from fea.solid.assembly import Discretisation
from fea.solid.boundary import surface
from fea.solid.model import rigid_modes
from geometry.mesh.cut_piece import Piece
from geometry.mesh.solid_mesh import SolidMesh
from pinbase.arrays import Floats, Mask

# Stress below this part of the pin's largest stress is not resolved; chosen by judgement.
MIN_READ_STRESS = 0.02
# Relative scatter of stress on rounded corners on the first mesh, measured on flats and keyways
# (`python -m benchmarks cut-scatter`).
ROUNDED_CORNER_SCATTER = 0.06


@dataclass(frozen=True)
class Read:
    """The solution at points (P, 3), m, of a piece, image after image.

    stress: (P, 6, L) Pa, of the cut pin.
    difference: (P, 6, L) Pa, from the uncut pin.
    cut: (P,) the points on a cut.
    displaced: (P, 3, L) m, displacements caused by the cuts, up to a rigid-body motion of the
    whole.
    moved: (2, 6, L) motions of the lower and upper end of the piece caused by the cuts, up to the
    same motion: a translation (m) and a rotation (rad) about the origin of the piece's frame.
    inner: displacements caused by the cuts at all nodes of the mesh.
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
    bearings: the loaded bands that have cuts.
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
        self.piece, self.material, self.finer = piece, material, finer
        self.space = Discretisation(solid.mesh)
        self.parities = Parities(piece.mirrors)
        self.faces = PieceFaces(piece, self.space, surface(self.space), self.parities, clamps)
        self.relief = Relief(self.faces, bearings)
        self.system = PieceSystem(piece.profile.name, self.space, material, clamps, self.parities)

    @cached_property
    def scatter(self) -> Floats:
        """The relative scatter (P,) of stress on rounded corners with the positions of nodes."""
        rounded = [r.face.name.endswith(("fillet", "mouth")) for r in self.faces.readings]
        rows = np.repeat(rounded, [len(r.nodes) for r in self.faces.readings])
        return np.asarray(ROUNDED_CORNER_SCATTER * rows / self.finer**2)

    def solve(
        self,
        uncut: Floats,
        most: Floats | float = 0.0,
        shears: Sequence[bool] = (),
        weight: Floats | float = 1.0,
    ) -> Read:
        """The solution under the tractions that relieve the cuts of the uncut pin's stress.

        uncut: (G, P, 6, L) Pa, the stress of the uncut pin at all images, along x, y and z.
        most: (L,) Pa, the largest stress component anywhere in the uncut pin.
        shears: whether each load shears the band on which it acts; loads without an entry do.
        weight: (L,) the relative accuracy that each load needs.

        Raises: SolveError.
        """
        by_kind = np.ones(uncut.shape[3], dtype=bool)
        by_kind[: len(shears)] = shears
        # Step 1: split by parity, and scale the loads so that each counts by its weight. (These
        # arrays are the largest of all, so there are as few of them as possible.)
        by_class = self.parities.split(uncut)
        largest = np.maximum(
            np.abs(by_class[:, self.faces.cut]).max(axis=(0, 1, 2)), MIN_READ_STRESS * most
        )
        scale = np.where(largest > 0.0, largest, 1.0) / weight
        by_class /= scale
        difference = np.zeros_like(by_class)
        moved = np.zeros((2, 6, uncut.shape[3]))
        displaced = np.zeros((*by_class.shape[:2], 3, uncut.shape[3]))
        inside: dict[int, Combined] = {}
        # Step 2: nodal forces of the tractions that relieve the cuts, and their size in all
        # classes.
        forces, acting, whole = self.relief.by_class(by_class)
        # Step 3: solve each class that acts.
        for c, parity in enumerate(self.parities.classes):
            if acting[c]:
                more, spread = self.relief.of_lost_loads(by_class[c], parity, by_kind)
                u = self.system.displace(self.faces.loaded, forces[c] + more, parity, whole)
                moved += self._moved(u.few, parity) @ u.amounts * scale
                inside[c] = Combined(u.few.astype(np.float32), u.amounts * scale)
                on_faces = (3 * self.faces.nodes[:, None] + np.arange(3)).ravel()
                displaced[c] = u.at(on_faces).reshape(displaced.shape[1:]) * scale
                difference[c] = self._stress(u, by_class[c], spread, c) * scale
        # Step 4: add the uncut stress. Cuts are free of traction.
        del by_class
        changed = self.faces.everywhere(difference)
        total = uncut.reshape(changed.shape) + changed
        cut = np.tile(self.faces.cut, len(uncut))
        total[cut] = self.faces.without_traction(total[cut])
        displaced = self.parities.everywhere(displaced)
        inner = InnerFields(self.space.mesh, self.parities, self.material, inside)
        return Read(self.faces.images.reshape(-1, 3), total, changed, cut, displaced, moved, inner)

    def reliefs(self, uncut: Floats) -> list[Floats]:
        """The balanced nodal forces (3 S, L), N, that relieve the cuts of a stress of the uncut
        pin, for each parity class.

        Those of classes that do not act are zero.
        uncut: as for `solve`, under loads that do not shear the bands on which they act.

        Raises: SolveError.
        """
        by_class, shears = self.parities.split(uncut), np.zeros(uncut.shape[3], dtype=bool)
        forces, acting, whole = self.relief.by_class(by_class)
        out = []
        for c, parity in enumerate(self.parities.classes):
            part, f = by_class[c], forces[c]
            if not acting[c]:
                out.append(np.zeros_like(f))
                continue
            modes = self.faces.rigid[:, self.parities.rigid(parity)]
            every = f + self.relief.of_lost_loads(part, parity, shears)[0]
            out.append(self.system.balanced(every, modes, whole))
        return out

    def displaced(self, forces: Floats, parity: tuple[int, ...], tolerance: float) -> Floats:
        """The displacements (3 S, L), m, of a parity class under balanced nodal forces (3 S, L), N.

        tolerance: of the iterations (fea.cut.two_level).
        """
        u = self.system.displace(self.faces.loaded, forces, parity, nodal_size(forces), tolerance)
        return u.at(self.faces.loaded)

    def _moved(self, u: Floats, parity: tuple[int, ...]) -> Floats:
        """The rigid-body motions (2, 6, L) of both ends under displacements (3 N, L) of a parity
        class.

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
        # The lower end is the mirror image of the upper. By u(M x) = parity M u(x), translations
        # along x and y and the rotation about z have the sign of the parity, the others the
        # opposite sign.
        if "z" in across:
            sign = across["z"] * np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
            out[0] = sign[:, None] * out[1]
        return out

    def _stress(self, u: Combined, uncut: Floats, spread: Floats, c: int) -> Floats:
        """The stress (P, 6, L), Pa, that displacements add, along the directions of the faces.

        u: displacements of the class.
        uncut: (P, 6, L) Pa, the part of the uncut pin's stress in the class.
        spread: (P, 3, L) Pa, additional tractions on the bands.
        c: number of the class.
        """
        E, nu, mu = self.material.youngs_modulus, self.material.poisson_ratio, self.material.lame[1]
        out, first = np.zeros(uncut.shape), 0
        character, few = self.parities.characters[c], u.few.reshape(-1, 3, u.few.shape[1])
        for r in self.faces.readings:
            here = slice(first, first + len(r.nodes))
            first += len(r.nodes)
            e = r.strain(few, self.parities, character) @ u.amounts
            # Components along the normal are the known tractions: on cuts, minus those of the uncut
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

"""By how much cuts make a pin more compliant under unit loads: the work of these on what cuts add.

A load i moves the cut pin by u_i + d_i, u_i being the displacement of the pin without cuts and d_i
the response of the local solid to the tractions h_i that relieve its cuts (fea.cut.local_model).
Load j does on d_i the work that h_j does on u_i + d_i (Betti). So the added compliance is

    h_j . u_i + h_j . d_i,

the first part being twice the energy of what is cut away, the second that of the local solid. Both
are symmetric and none is negative, and no mesh is compared with another one. The tractions of many
loads are combinations of few, for which alone the solid is solved.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fea.core.local_fit import continuation
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from fea.cut.evaluate import fine_about
from fea.cut.frames import cartesian, turn_of
from fea.cut.local_model import LocalModel
from fea.cut.local_solution import LocalFineness, LocalMesh, section_points
from fea.cut.movement import of_units
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from fea.harmonic.section_solution import FIRST_MESH_SIZE, finer_at_rings
from fea.solid.nodal_loads import Unit
from geometry import Pin
from geometry.mesh.cut_piece import Piece
from geometry.mesh.section_mesh import meridian_mesh
from pinbase.arrays import Floats

# Of the largest nodal forces that relieve a cut of a unit load: those that are negligible. With a
# tenth of it pressures about the flat and hole of the tests change by 0.03 % of the largest.
RELIEF_TOLERANCE = 2e-3


@dataclass
class _Reliefs:
    """The forces that relieve the cuts of loads, of one class, as sums of a few.

    basis: (3 N, B) orthonormal.
    amounts: (B, K) of each for every load so far.
    largest: of all forces so far, N.
    """

    basis: Floats
    amounts: Floats
    largest: float = 0.0

    def add(self, forces: Floats) -> None:
        """Add the forces (3 N, L) of further loads."""
        self.largest = max(self.largest, float(np.linalg.norm(forces, axis=0).max(initial=0.0)))
        amounts = self.basis.T @ forces
        left = forces - self.basis @ amounts
        more, size, _ = np.linalg.svd(left, full_matrices=False)
        more = more[:, size > RELIEF_TOLERANCE * self.largest]
        self.basis = np.concatenate([self.basis, more], axis=1)
        before = np.pad(self.amounts, ((0, more.shape[1]), (0, 0)))
        self.amounts = np.concatenate([before, self.basis.T @ forces], axis=1)


def added_compliance(
    pin: Pin,
    material: Material,
    pieces: Sequence[Piece],
    bands: Sequence[tuple[float, float]],
    loads: Sequence[tuple[UnitLoad, ...]],
) -> tuple[tuple[Unit, ...], Floats]:
    """The unit loads in all their phases (K,), and the work (K, K), N m, that each does on what the
    cuts add to the displacement under each.

    pin: without its cuts.
    pieces: about its cuts. bands: loaded ones with cuts in them (fea.cut.region.loaded_bands).
    loads: pressures on rings, those of one harmonic together.

    Raises: MeshError, SolveError.
    """
    rings = tuple(dict.fromkeys(name for x in loads for load in x for name in load.surfaces))
    grades = [*(fine_about(piece, 0) for piece in pieces), *finer_at_rings(pin, rings)]
    section = HarmonicModel(pin, meridian_mesh(pin, FIRST_MESH_SIZE, (), grades), material, ())
    models = [LocalMesh(x, material, (), LocalFineness.of(0), (), bands).model() for x in pieces]
    points = np.concatenate([section_points(model) for model in models])
    fields = [section.solve(x, points) for x in loads]
    units = [tuple((load, p) for load in x for p in load.phases) for x in loads]
    every = tuple(unit for part in units for unit in part)
    work, first = np.zeros((len(every), len(every))), 0
    for model in models:
        here = slice(first, first + len(section_points(model)))
        first = here.stop
        work += _of_piece(model, here, list(zip(fields, units, strict=True)))
    return every, work


def _of_piece(
    model: LocalModel, here: slice, parts: Sequence[tuple[MeridianFields, tuple[Unit, ...]]]
) -> Floats:
    """The added work (K, K) of one piece.

    here: of its section_points among those at which the fields have stress.
    parts: fields and unit loads, harmonic by harmonic.
    """
    classes = model.parities.classes
    nothing = np.zeros((model.unknowns, 0)), np.zeros((0, 0))
    reliefs = [_Reliefs(*nothing) for _ in classes]
    for fields, units in parts:
        stress = _on_cuts(model, fields, here, units)
        for relief, forces in zip(reliefs, model.reliefs(stress), strict=True):
            relief.add(forces)
    on_uncut = [np.zeros((x.basis.shape[1], 0)) for x in reliefs]
    for displaced in _displaced(model, parts):
        by_class = model.parities.split_vectors(displaced)
        for c, relief in enumerate(reliefs):
            basis = relief.basis.reshape(len(model.space.nodes), 3, -1 if relief.basis.size else 0)
            basis = basis[model.nodes_once]
            done = np.einsum("pab,pal->bl", basis, by_class[c], optimize=True)
            on_uncut[c] = np.concatenate([on_uncut[c], done], axis=1)
    out = np.zeros((len(reliefs[0].amounts.T),) * 2)
    for c, relief in enumerate(reliefs):
        if not relief.basis.shape[1]:
            continue
        moved = model.displaced(relief.basis, classes[c])
        own = relief.amounts.T @ on_uncut[c]
        within = relief.amounts.T @ (relief.basis.T @ moved) @ relief.amounts
        out += len(classes) * (own + within)
    return np.asarray(0.5 * (out + out.T))  # iteration and interpolation leave a little besides


def _on_cuts(
    model: LocalModel, fields: MeridianFields, here: slice, units: tuple[Unit, ...]
) -> Floats:
    """The stress (G, P, 6, L) of the uncut pin at the images of a piece's points, on cuts alone."""
    x, columns = model.images, [fields.loads.index(load) for load, _ in units]
    first = len(fields.displacement)
    at = fields.stress[first + here.start : first + here.stop]
    amplitude = np.zeros((*x.shape[:2], *fields.stress.shape[1:]))
    amplitude[:, model.cut] = at.reshape(len(x), -1, *at.shape[1:])
    angle = np.arctan2(x[..., 1], x[..., 0])
    return cartesian(amplitude[..., columns], angle, model.piece.angle, units)


def _displaced(
    model: LocalModel, parts: Sequence[tuple[MeridianFields, tuple[Unit, ...]]]
) -> Iterator[Floats]:
    """The displacement (G, N, 3, L) of the uncut pin at the images of the model's nodes on its
    faces, along the axes of the piece.
    """
    nodes = model.space.nodes[model.nodes_once]
    x = model.parities.images[:, None] * nodes
    at = np.stack([np.hypot(x[..., 0], x[..., 1]), x[..., 2] + model.piece.origin], axis=2)
    angle = (np.arctan2(x[..., 1], x[..., 0]) + model.piece.angle).ravel()
    back, fit = turn_of(model.piece.angle), None
    for fields, units in parts:
        known = len(fields.displacement)
        if fit is None:
            fit = continuation(fields.points[:known], at.reshape(-1, 2))
        columns = [fields.loads.index(load) for load, _ in units]
        amplitude = fit @ fields.displacement[..., columns].reshape(known, -1)
        moved = of_units(np.asarray(amplitude).reshape(len(angle), 3, -1), angle, units)
        along = np.einsum("ba,pbl->pal", back, moved)
        yield along.reshape(*x.shape[:2], 3, -1)

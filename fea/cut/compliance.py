"""The compliance that cuts add to a pin: the work of unit loads on the displacements that cuts add.

A load i moves the cut pin by u_i + d_i. Here u_i is the displacement of the pin without cuts, and
d_i the response of the local solid to the tractions h_i that relieve its cuts
(fea.cut.local_model). The work of load j on d_i is that of h_j on u_i + d_i (Betti). So the added
compliance is

    h_j . u_i + h_j . d_i,

of which the first term is twice the strain energy of the removed material, the second twice that of
the local solid. Both are symmetric and not negative, and no mesh is compared with another one. The
tractions of many loads are combinations of a few, and the solid is solved for these alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fea.core.local_fit import continuation
from fea.core.material import Material
from fea.core.memory import most_unknowns
from fea.core.pin_loads import Unit, UnitLoad
from fea.cut.evaluate import fine_about
from fea.cut.frames import cartesian, turn_of
from fea.cut.local_model import LocalModel
from fea.cut.local_solution import LocalFineness, LocalMesh
from fea.cut.movement import of_units
from fea.cut.piece_system import combinations
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from fea.harmonic.section_solution import FIRST_MESH_SIZE, finer_at_rings
from geometry import Pin
from geometry.mesh.cut_piece import Piece
from geometry.mesh.section_mesh import meridian_mesh
from pinbase.arrays import Floats

# Negligible nodal forces that relieve a cut, of the largest under any unit load. With a tenth of
# this, pressures about the flat and hole of the tests change by 0.03 % of the largest.
RELIEF_TOLERANCE = 2e-3
# Negligible stress on the cuts under a combination of unit loads, of the largest under any. If none
# is neglected, the flexibility that is added to cells changes by less than 1e-3 of the largest
# (test_seen_cuts.py).
STRESS_TOLERANCE = 1e-4
WORK_TOLERANCE = 1e-4  # of the iterative response to relieving forces (fea.cut.two_level)


@dataclass
class _Reliefs:
    """The forces of one parity class that relieve the cuts under many loads, as sums of a few.

    basis: (3 S, B) orthonormal forces at the unknowns on which forces act (PieceFaces.loaded).
    amounts: (B, K) of each basis vector, for every load so far.
    sizes: (B,) N, of the forces for which each basis vector was needed.
    largest: size of the largest forces so far, N.
    """

    basis: Floats
    amounts: Floats
    sizes: Floats
    largest: float = 0.0

    def add(self, forces: Floats, shares: Floats) -> None:
        """Add loads, as combinations of forces.

        forces: (3 S, C) N, of C combinations.
        shares: (C, L) of each combination in each load.
        """
        squares = np.einsum("cl,cd,dl->l", shares, forces.T @ forces, shares, optimize=True)
        self.largest = max(self.largest, math.sqrt(max(0.0, squares.max(initial=0.0))))
        left = forces - self.basis @ (self.basis.T @ forces)
        size, right = combinations(left)
        needed = size > RELIEF_TOLERANCE * self.largest
        more = left @ right[needed].T / size[needed]
        self.basis = np.concatenate([self.basis, more], axis=1)
        self.sizes = np.concatenate([self.sizes, size[needed]])
        before = np.pad(self.amounts, ((0, more.shape[1]), (0, 0)))
        self.amounts = np.concatenate([before, self.basis.T @ forces @ shares], axis=1)


@dataclass(frozen=True)
class AddedCompliance:
    """The work of unit loads on the displacements that cuts add, in terms of the few forces that
    relieve the cuts.

    units: K unit loads, in all their phases.
    amounts: (B, K) of the relieving forces under each unit load.
    relief_work: (B, K) N m, the work of the relieving forces on the displacement under each unit
    load.
    """

    units: tuple[Unit, ...]
    amounts: Floats
    relief_work: Floats

    def work(self, loads: Floats) -> Floats:
        """The work (U, U), N m, of U sums of the unit loads on the displacements that cuts add
        under each.

        loads: (K, U) amounts of the unit loads in the sums.
        """
        work = (self.amounts @ loads).T @ (self.relief_work @ loads)
        # Iteration and interpolation leave a small asymmetry.
        return np.asarray(0.5 * (work + work.T))


def added_compliance(
    pin: Pin,
    material: Material,
    pieces: Sequence[Piece],
    bands: Sequence[tuple[float, float]],
    loads: Sequence[tuple[UnitLoad, ...]],
) -> AddedCompliance:
    """The compliance that cuts add to a pin under unit loads.

    pin: without its cuts.
    pieces: the pieces about its cuts.
    bands: ends of the loaded bands that have cuts (fea.cut.region.loaded_bands).
    loads: pressures on rings, grouped by harmonic.

    Raises: MeshError, SolveError.
    """
    rings = tuple(dict.fromkeys(name for x in loads for load in x for name in load.surfaces))
    grades = [*(fine_about(piece, 0) for piece in pieces), *finer_at_rings(pin, rings)]
    section = HarmonicModel(pin, meridian_mesh(pin, FIRST_MESH_SIZE, (), grades), material, ())
    first_mesh, max_unknowns = LocalFineness.of(0), most_unknowns(None, 1)
    meshes = [LocalMesh(x, material, (), first_mesh, (), bands, max_unknowns) for x in pieces]
    points = np.concatenate([mesh.section_points for mesh in meshes])
    fields = [section.solve(x, points) for x in loads]
    units = [tuple((load, p) for load in x for p in load.phases) for x in loads]
    every = tuple(unit for part in units for unit in part)
    parts, first = [], 0
    for mesh in meshes:
        here = slice(first, first + len(mesh.section_points))
        first = here.stop
        parts += _of_piece(mesh.model, here, list(zip(fields, units, strict=True)))
    amounts, relief_work = (np.concatenate(x) for x in zip(*parts, strict=True))
    return AddedCompliance(every, amounts, relief_work)


def _of_piece(
    model: LocalModel, here: slice, parts: Sequence[tuple[MeridianFields, tuple[Unit, ...]]]
) -> list[tuple[Floats, Floats]]:
    """The amounts (B, K) of the forces that relieve the cuts of one piece, and their work (B, K), N
    m, on the displacement under each load, for each parity class.

    here: the positions of the piece's section_points among the additional points of the fields.
    parts: fields and unit loads of each harmonic.
    """
    classes = model.parities.classes
    none = np.zeros((len(model.faces.loaded), 0))
    reliefs = [_Reliefs(none, np.zeros((0, 0)), np.zeros(0)) for _ in classes]
    for stress, shares in _on_cuts(model, here, parts):
        by_class = model.reliefs(stress) if len(shares) else [none] * len(classes)
        for relief, forces in zip(reliefs, by_class, strict=True):
            relief.add(forces, shares)
    on_uncut = [np.zeros((x.basis.shape[1], 0)) for x in reliefs]
    for displaced in _displaced(model, parts):
        moved_by_class = model.parities.split_vectors(displaced)
        for c, relief in enumerate(reliefs):
            done = relief.basis.T @ moved_by_class[c].reshape(-1, displaced.shape[3])
            on_uncut[c] = np.concatenate([on_uncut[c], done], axis=1)
    out = []
    for c, relief in enumerate(reliefs):
        within = np.zeros_like(relief.amounts)
        if relief.basis.shape[1]:
            # Scaled by their sizes, so that forces that add little are solved less accurately.
            moved = model.displaced(relief.basis * relief.sizes, classes[c], WORK_TOLERANCE)
            within = relief.basis.T @ (moved / relief.sizes) @ relief.amounts
        out.append((relief.amounts, len(classes) * (on_uncut[c] + within)))
    return out


def _on_cuts(
    model: LocalModel, here: slice, parts: Sequence[tuple[MeridianFields, tuple[Unit, ...]]]
) -> Iterator[tuple[Floats, Floats]]:
    """Yield, for each harmonic, the stress (G, P, 6, C), Pa, of the uncut pin under C combinations
    of the unit loads, and the shares (C, L) of the combinations in each load.

    The stress is at the images of a piece's points, and zero except on cuts. Few combinations of
    pressures on rings reach a cut, the fewer the higher their harmonic.
    """
    x = model.faces.images
    angle = np.arctan2(x[..., 1], x[..., 0])
    combined = []
    for fields, units in parts:
        loads, first = tuple(dict.fromkeys(load for load, _ in units)), len(fields.displacement)
        columns = [fields.loads.index(load) for load in loads]
        at = fields.stress[first + here.start : first + here.stop][..., columns]
        at = at.reshape(-1, len(loads))
        combined.append((at, *combinations(at)))
    largest = max(size.max(initial=0.0) for _, size, _ in combined)
    for (_, units), (at, size, of_loads) in zip(parts, combined, strict=True):
        some = size > STRESS_TOLERANCE * largest
        amplitude = np.zeros((*x.shape[:2], 6, some.sum()))
        at_cut = at @ of_loads[some].T
        amplitude[:, model.faces.cut] = at_cut.reshape(len(x), model.faces.cut.sum(), 6, some.sum())
        load = units[0][0]
        every = tuple((load, phase) for _ in range(some.sum()) for phase in load.phases)
        twice = np.repeat(amplitude, len(load.phases), axis=-1)
        shares = np.kron(of_loads[some], np.eye(len(load.phases)))
        yield cartesian(twice, angle, model.piece.angle, every), shares


def _displaced(
    model: LocalModel, parts: Sequence[tuple[MeridianFields, tuple[Unit, ...]]]
) -> Iterator[Floats]:
    """Yield, for each harmonic, the displacement (G, S, 3, L), m, of the uncut pin at the images of
    the nodes on the piece's faces, along the axes of the piece.
    """
    nodes = model.space.nodes[model.faces.nodes_once]
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

"""Contact that sees cuts by harmonics and local solids, against whole solids.

The flexibility of the pin on the cells is changed by what its cut changes: the difference of two
whole solids, with the cut and without it, under a unit force on what is left of every cell. Cells
that the cut takes press no more. Half of the joint is solid, the loads lying in its plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from fea.core.linear_solver import ConstrainedSystem
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.voigt import von_mises
from fea.solid.assembly import Discretisation
from fea.solid.boundary import SurfaceMesh, area_vectors, slopes_at, surface
from fea.solid.stress_recovery import nodal_stress
from fea.solve.solve import solve_in_lugs
from fea.support.contact.contact import ContactProblem
from fea.support.contact.contact_state import ContactState
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import Cut, CutPin, Flat, Hole, Slot
from geometry.mesh import cut_piece
from geometry.mesh.cut_piece import Piece, piece_mesh
from pinbase.arrays import Floats, Mask
from tests.support.pins.plain_pins import CLEVIS

D, F = 0.02, 50e3
STEEL = Material("steel", 2.1e11, 0.3)
LUGS = tuple(
    Lug(n, 0.05, STEEL, 5e-5, 5e-4, t) for n, t in zip("ABC", (2.6e5, math.inf, 2.6e5), strict=True)
)
LOADS = PinLoads(
    "pull", ("A", "B", "C"), F * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
)
NOTHING = Hole(0.001, 6e-4, 0.0, 6e-4)  # a prick in the overhang: a solid as good as uncut
PARTS, LEFT, EDGE = 8, 0.15, 0.004  # of a facet; of a cell that presses no more; m, off lugs' edges


@dataclass(frozen=True)
class Half:
    """A solid half of the pin (y > 0), and what unit forces on what is left of cells do there."""

    space: Discretisation
    boundary: SurfaceMesh
    forces: Floats
    moved: Floats
    left: Floats

    @property
    def flexibility(self) -> Floats:
        """Of cells in the half, m/N."""
        return np.asarray(self.forces.T @ self.moved)


def half_of(cut: Cut, problem: ContactProblem) -> Half:
    """With a cut."""
    cuts = CutPin(CLEVIS, (cut,)).cuts
    piece = Piece(CLEVIS, 0.0, CLEVIS.length, 0.0, cuts, ("y",), (False, False))
    space = Discretisation(piece_mesh(piece, 1.0).mesh)
    boundary = surface(space)
    forces, left = on_cells(space, boundary, problem)
    x, free = space.nodes, np.ones(space.unknowns)
    free[3 * np.flatnonzero(np.abs(x[:, 1]) < 1e-9) + 1] = 0.0
    axis = np.hypot(x[:, 0], x[:, 1])
    low, high = (int(np.argmin(axis + 10.0 * np.abs(x[:, 2] - z))) for z in (0.0, CLEVIS.length))
    free[[3 * low, 3 * low + 2, 3 * high]] = 0.0
    K = space.stiffness(STEEL)
    solve = ConstrainedSystem(K, np.arange(space.unknowns) // 3).factorize(K.copy(), free)
    parts = np.array_split(free[:, None] * forces, 8, axis=1)
    return Half(space, boundary, forces, np.concatenate([solve(x) for x in parts], axis=1), left)


def on_cells(
    space: Discretisation, boundary: SurfaceMesh, problem: ContactProblem
) -> tuple[Floats, Floats]:
    """Nodal forces (3 N, R H) of a unit force inwards, even on what is left of each cell, and the
    part that is left.
    """
    bands, M = problem.bands, problem.sectors
    count = M // 2 + 1
    x = space.nodes[boundary.corners]
    rows = np.flatnonzero((np.abs(np.hypot(x[..., 0], x[..., 1]) - D / 2.0) < 1e-7).all(axis=1))
    i, j = (k.ravel() for k in np.meshgrid(np.arange(PARTS), np.arange(PARTS)))
    both = [(i + j < PARTS, 1.0 / 3.0), (i + j < PARTS - 1, 2.0 / 3.0)]
    at = np.concatenate([(np.stack([i[k], j[k]]) + d) / PARTS for k, d in both], axis=1)
    shapes, _ = slopes_at(*at)
    points = np.einsum("qi,fia->fqa", shapes, x[rows])
    area = area_vectors(x[rows], *at) * 0.5 / PARTS**2
    out = boundary.normals[rows].mean(axis=1)[:, None]
    area *= np.sign(np.sum(area * out, axis=2))[..., None]
    start, z = bands.z - bands.length / 2.0, points[..., 2]
    ring = np.searchsorted(start, z, side="right") - 1
    inside = (ring >= 0) & (z < (start + bands.length)[ring])
    sector = np.rint(np.abs(np.arctan2(points[..., 1], points[..., 0])) * M / (2.0 * np.pi))
    cell = (ring * count + sector).astype(np.int64)[inside]
    there, own = np.zeros(len(bands.z) * count), area[inside]
    np.add.at(there, cell, np.linalg.norm(own, axis=1))
    forces = np.zeros((len(space.nodes), 3, len(there)))
    facet, point = np.nonzero(inside)
    for k in range(6):
        node = boundary.corners[rows][facet, k]
        for a in range(3):
            np.add.at(forces, (node, a, cell), -shapes[point, k] * own[:, a])
    whole = np.repeat(bands.length * bands.radius * 2.0 * np.pi / M, count)
    whole *= np.tile(np.where(np.arange(count) % (count - 1) == 0, 0.5, 1.0), len(bands.z))
    return forces.reshape(-1, len(there)) / np.maximum(there, 1e-12), there / whole


def real_contact(problem: ContactProblem, plain: Half, cut: Half) -> tuple[ContactState, Floats]:
    """Pressures, and the stress (N,) Pa that they make in the solid with the cut."""
    M, rings = problem.sectors, len(problem.bands.z)
    count, around = M // 2 + 1, np.arange(M)
    own = (np.arange(rings)[:, None] * count + np.minimum(around, M - around)).ravel()
    change = 0.5 * (cut.flexibility - plain.flexibility)[np.ix_(own, own)]
    gone: Mask = cut.left[own] < LEFT
    change[gone], change[:, gone] = 0.0, 0.0
    # A cut makes nothing stiffer: what is negative is the difference of two meshes.
    values, modes = np.linalg.eigh(0.5 * (change + change.T))
    added = (modes * np.maximum(values, 0.0)) @ modes.T
    model = uncut_model()
    tilt = [lug.tilt for lug in LUGS]
    real = ContactProblem(problem.bands, model.flexibility, model.tail, tilt, M, added, gone)
    found = real.solve(LOADS.forces[0, :, :2])
    force = np.zeros(rings * count)
    force[own] = found.pressure.ravel() * problem.area
    force.reshape(rings, count)[:, [0, -1]] *= 0.5
    moved = (cut.moved @ force).reshape(-1, 3, 1)
    return found, von_mises(nodal_stress(cut.space, STEEL, moved)[..., 0])


def bending(problem: ContactProblem, found: ContactState) -> float:
    """In the middle, N m."""
    force = -(found.pressure.ravel() * problem.area).reshape(found.pressure.shape)
    along = (force * np.cos(problem.angles)).sum(axis=1)
    return float(-(along * np.maximum(CLEVIS.length / 2.0 - problem.bands.z, 0.0)).sum())


@cache
def uncut_model() -> ContactModel:
    """The joint without a cut, once for all cuts."""
    return ContactModel(CLEVIS, STEEL, LUGS)


@cache
def uncut_joint() -> tuple[ContactProblem, Half]:
    """The joint and its solid without a cut, once for all cuts."""
    problem = uncut_model().contact
    return problem, half_of(NOTHING, problem)


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize(
    ("cut", "moment"),
    [
        (Flat(0.0165, 0.0295, D / 2.0 * math.cos(math.pi / 6.0), math.pi, 0.001), 0.93),
        (Hole(0.023, 0.4 * D), 0.86),
        (Hole(0.023, 0.4 * D, math.pi / 2.0), 0.964),
    ],
)
def test_real_contact_is_within_the_error(
    cut: Cut, moment: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A flat and a large hole under the pressure of the eye, and the hole across it, which unloads
    the middle of the pin: it is soft under pressure. CalculiX has 0.92 of the moment with such a
    flat (its ends slant), and without it agrees to 0.4 %.
    """
    real, peak = real_and_ours(cut, moment, monkeypatch)
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    coarse = 0.05 * real  # of the solid, 8 elements over the diameter and 6 on a hole's quarter
    assert abs(real - peak.max_von_mises) < coarse
    assert abs(real - peak.max_von_mises) < peak.error_estimate + 0.01 * real
    assert peak.error_estimate < 0.08 * peak.max_von_mises


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize(
    ("cut", "moment"),
    [
        (Slot(0.018, 0.028, 0.004, 0.0025, math.pi, 0.0008), 0.970),
        (Slot(0.0195, 0.0265, 0.005, 0.003, math.pi, 0.001), 0.970),
    ],
)
def test_real_contact_of_keyways_is_within_their_error(
    cut: Cut, moment: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Under the pressure of the eye, with round ends: square ones have corners without a maximum,
    and 703 MPa of the solid, 0.2 mm off one, is not to be compared with 551 outside of its zone.
    """
    real, peak = real_and_ours(cut, moment, monkeypatch)
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    assert 0.88 * real < peak.max_von_mises < 1.05 * real
    assert 1.05 * real < peak.max_von_mises + peak.error_estimate  # the solid is right to 5 %


def real_and_ours(
    cut: Cut, moment: float, monkeypatch: pytest.MonkeyPatch
) -> tuple[float, Maximum]:
    """The largest stress of the solid off the lugs' edges, Pa, and our maximum, where both have
    a bending moment over that without the cut.
    """
    monkeypatch.setattr(
        cut_piece, "REMOTE_MESH_SIZE", replace(cut_piece.REMOTE_MESH_SIZE, across=8.0)
    )
    problem, plain = uncut_joint()
    half = half_of(cut, problem)
    found, stress = real_contact(problem, plain, half)
    uncut = bending(problem, problem.solve(LOADS.forces[0, :, :2]))
    assert bending(problem, found) / uncut == pytest.approx(moment, abs=0.02)
    requirement = Requirement(0.05, distance=EDGE / D)
    (ours,) = solve_in_lugs(PinProblem(CutPin(CLEVIS, (cut,)), STEEL, LUGS, (LOADS,)), requirement)
    assert ours.joint is not None
    assert ours.joint.bending_moment is not None
    assert ours.joint.bending_moment / uncut == pytest.approx(moment, abs=0.035)
    z = half.space.nodes[:, 2]
    edges = [z_ for b in map(CLEVIS.band, "ABC") for z_ in (b.z0, b.z1)]
    away = np.abs(z[:, None] - edges).min(axis=1) > EDGE
    on = np.isin(np.arange(len(z)), half.boundary.corners)
    return float(stress[on & away].max()), ours.peak

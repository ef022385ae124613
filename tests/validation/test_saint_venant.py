"""Saint-Venant's problems for round bars and tubes, to 1e-6.

Reference: Timoshenko & Goodier, Theory of Elasticity, 3rd ed., McGraw-Hill 1970, secs. 99 to
102 and 119 to 121, as written out in `tests.support.exact.saint_venant`.

The ends carry the exact tractions and nothing is clamped, so the solution is exact everywhere but
for a rigid motion. Quadratic elements hold tension, torsion and bending: one coarse mesh, 1e-10 (of
the largest stress or displacement; measured 1e-11, round-off of the solver). Flexure is cubic and,
in a tube, has 1/r: energies on the mesh itself to 1e-6 (measured 2e-8), stresses, whose error has
the powers h^2 and h^4 of the mesh, extrapolated from three meshes to 1e-6 (measured 7e-7).
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.harmonic.model import HarmonicModel, rigid_motions
from fea.harmonic.stress_recovery import reading
from geometry import Pin, Segment
from tests.support.exact.exact_fields import (
    Exact,
    boundary_forces,
    displacements_of,
    edge_tractions,
    errors,
    unknowns_of,
)
from tests.support.exact.saint_venant import bending, end_force, flexure, tension, torsion
from tests.support.pins.section_grid import rectangle

A, L = 0.01, 0.04
INNER = pytest.mark.parametrize("b", [0.0, 0.004], ids=["bar", "tube"])


class Solved(NamedTuple):
    """On one mesh: points (S, 2) and stresses (S, 6), the work of the loads, what it should be, and
    relative errors of displacement (largest, but for a rigid motion) and of the elements' stress.
    """

    points: Floats
    stress: Floats
    work: float
    true_work: float
    moved: float
    inside: float


def solved(exact: Exact, material: Material, b: float, fine: int) -> Solved:
    """With 4 x 8 squares times `fine`^2."""
    pin = Pin("bar", (Segment(L, 2.0 * A, bore=2.0 * b),))
    model = HarmonicModel(pin, rectangle(b, A, L, 4 * fine, 8 * fine), material, ())
    space, outline = model.space, model.outline
    forces = boundary_forces(space, outline, exact)
    x = model.displace(exact.n, forces[:, None])[:, 0]
    truth = unknowns_of(exact.at_nodes(space)[..., 0])
    modes = rigid_motions(space.nodes, exact.n)
    rigid = modes @ np.linalg.lstsq(modes, x - truth, rcond=None)[0]
    read = reading(space, outline, material)
    _, stress = read.of(exact.n, displacements_of(x), edge_tractions(space, outline, exact))
    moved = np.abs(x - truth - rigid).max() / np.abs(truth).max()
    inside = errors(space, material, exact, displacements_of(x - rigid))[1]
    work, true_work = float(forces @ x), float(forces @ truth)
    return Solved(read.points, stress[..., 0], work, true_work, float(moved), inside)


@INNER
@pytest.mark.parametrize("state", [tension, torsion, bending])
def test_what_quadratic_elements_hold(state: type, steel: Material, b: float) -> None:
    exact: Exact = state(steel)
    found = solved(exact, steel, b, 1)
    true = exact.stress(*found.points.T)
    assert np.abs(found.stress - true).max() < 1e-10 * np.abs(true).max()
    assert found.moved < 1e-10
    assert found.inside < 1e-10


@INNER
def test_energy_of_flexure(steel: Material, b: float) -> None:
    """Order 4 (measured 3.96), from below, within 1e-6 of the truth."""
    exact = flexure(steel, b, A, L)
    coarse, fine = (solved(exact, steel, b, k) for k in (4, 8))
    wrong = [1.0 - s.work / s.true_work for s in (coarse, fine)]
    assert 0.0 < wrong[1] < 1e-6
    assert np.log2(wrong[0] / wrong[1]) == pytest.approx(4.0, abs=0.15)
    assert fine.moved < 1e-5  # order 3


@INNER
def test_stress_of_flexure(steel: Material, b: float) -> None:
    """Extrapolated, at 35 points that are nodes of all meshes: on the surface, on the axis or the
    bore, and between. On one mesh the error has order 2, also at r = 0.
    """
    exact = flexure(steel, b, A, L)
    place = np.array([(r, z) for z in np.linspace(0.0, L, 9)[1:-1] for r in np.linspace(b, A, 5)])
    true = exact.stress(*place.T)
    peak = np.abs(true).max()
    seen = []
    for k in (4, 8, 16):
        found = solved(exact, steel, b, k)
        distance = np.linalg.norm(found.points - place[:, None], axis=2)
        assert distance.min(axis=1).max() < 1e-9 * A
        seen.append(found.stress[distance.argmin(axis=1)])
    wrong = [np.abs(s - true).max() / peak for s in seen]
    assert np.log2(wrong[1] / wrong[2]) == pytest.approx(2.0, abs=0.1)
    first = [(4.0 * y - x) / 3.0 for x, y in pairwise(seen)]
    second = (16.0 * first[1] - first[0]) / 15.0
    assert np.abs(second - true).max() < 1e-6 * peak


@INNER
def test_flexure_has_the_force_it_should(steel: Material, b: float) -> None:
    """The reference by itself: its shear stresses sum to E I, and its surfaces are free."""
    exact = flexure(steel, b, A, L)
    x, w = np.polynomial.legendre.leggauss(20)
    r = b + (A - b) * (x + 1.0) / 2.0
    stress = exact.stress(r, np.full_like(r, 0.3 * L))
    force = np.pi * np.sum(w * (A - b) / 2.0 * r * (stress[:, 4] - stress[:, 3]))
    assert force == pytest.approx(end_force(steel, b, A), rel=1e-12)
    for radius in {A, b} - {0.0}:
        rim = exact.stress(np.array([radius]), np.array([0.1 * L]))[0]
        assert abs(rim[4]) < 1e-14 * abs(rim[3])


@pytest.mark.parametrize(
    "state", [tension, torsion, bending, None], ids=lambda s: getattr(s, "__name__", "none")
)
def test_no_spurious_stress_on_the_axis(state: type | None, steel: Material) -> None:
    """At r = 0 and on the rows of nodes next to it a mesh is no worse than elsewhere (but for
    round-off, 1e-9 of the largest stress: measured 2e-10 at the corner on the axis).
    """
    exact: Exact = flexure(steel, 0.0, A, L) if state is None else state(steel)
    found = solved(exact, steel, 0.0, 4)
    true = exact.stress(*found.points.T)
    wrong = np.abs(found.stress - true).max(axis=1)
    close = found.points[:, 0] <= A / 32.0 * (1.0 + 1e-9)
    assert close.sum() > 100
    assert wrong[close].max() <= max(wrong[~close].max(), 1e-9 * np.abs(true).max())
    assert np.any(found.points[close, 0] == 0.0)

"""Stress on the surface from displacements that are known exactly.

1e-11 of the largest stress wherever displacements are quadratic along straight edges, for then
strains in the surface are linear, and lines and cubics hold these.
"""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline
from fea.harmonic.surface_stress import Skin, skin
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from tests.support.exact.exact_fields import Exact, edge_tractions
from tests.support.exact.polynomial_fields import manufactured, polynomial
from tests.support.exact.saint_venant import bending, tension, torsion
from tests.support.pins.section_grid import rectangle

TUBE = rectangle(0.5, 1.0, 2.0, 3, 7)


def quadratic(material: Material, n: int) -> Exact:
    """All quadratic terms that are smooth on the axis, which the tube has not."""
    if n == 0:
        U, V = {(1, 0): 0.3, (1, 1): 0.7}, {(1, 0): 0.2, (1, 1): -0.4}
        W = {(0, 0): 1.0, (2, 0): 0.5, (0, 1): -0.6, (0, 2): 0.9}
        return manufactured(material, 0, *(polynomial(t) for t in (U, V, W)))
    p, m, w = {
        1: ({(2, 0): 0.4}, {(0, 0): 1.0, (0, 1): 0.5, (0, 2): -0.3, (2, 0): 0.7}, {(1, 1): 0.8}),
        2: ({}, {(1, 0): 0.5, (1, 1): -0.6}, {(2, 0): 0.9}),
    }[n]
    plus, minus = polynomial(p), polynomial(m)
    return manufactured(material, n, plus + minus, plus - minus, polynomial(w))


def found_by(space: Section, material: Material, exact: Exact, traction: Floats) -> Skin:
    return skin(space, Outline(space), material, exact.n, exact.at_nodes(space), traction)


def wrong(found: Skin, exact: Exact) -> Floats:
    """Errors (E, 5) of the largest stress."""
    true = exact.stress(*np.moveaxis(found.points, -1, 0))
    return np.asarray(np.abs(found.stress[..., 0] - true).max(axis=2) / np.abs(true).max())


@pytest.mark.parametrize("n", [0, 1, 2])
def test_quadratic_displacements(n: int, steel: Material) -> None:
    """All six stresses at all five points of all edges, rims included, where edges meet at right
    angles and so each keeps to itself.
    """
    exact = quadratic(steel, n)
    space = Section(TUBE)
    found = found_by(space, steel, exact, edge_tractions(space, Outline(space), exact))
    assert found.stress.shape == (20, 5, 6, 1)
    assert wrong(found, exact).max() < 1e-11


@pytest.mark.parametrize("state", [tension, torsion, bending])
def test_on_a_face_that_reaches_the_axis(state: type, steel: Material) -> None:
    """Up to the axis; at r = 0 itself fea.harmonic.stress_recovery takes the stress from inside."""
    exact: Exact = state(steel)
    space = Section(rectangle(0.0, 1.0, 2.0, 3, 6))
    found = found_by(space, steel, exact, edge_tractions(space, Outline(space), exact))
    assert np.all(np.isfinite(found.stress))
    off = wrong(found, exact)[found.points[..., 0] > 0.0]
    assert off.max() < 1e-11


def test_cubic_displacements_away_from_corners(steel: Material) -> None:
    """Derivatives of the quadratic interpolant of a cubic are exact at the Gauss points, and the
    cubic through four of these holds the quadratic strain, where lines would not. At nodes only,
    since half-way between them the displacement itself (e_tt) is off.
    """
    exact = manufactured(
        steel, 0, np.zeros((10, 10)), polynomial({(1, 2): 1.0}), polynomial({(0, 3): 1.0})
    )
    space = Section(TUBE)
    outline = Outline(space)
    found = found_by(space, steel, exact, edge_tractions(space, outline, exact))
    off = wrong(found, exact)[:, [0, 2, 4]]
    along = outline.rows["outer"]
    inner = along[1:-1]
    assert off[inner].max() < 1e-11
    assert off[along[[0, -1]]].max() > 1e-4  # at corners lines have to do


def test_a_jump_of_traction_is_seen_from_its_own_side(steel: Material) -> None:
    """Displacements with a kink in their second derivative at z = 1, as a load's edge makes: the
    stress is exact on both sides; and without the jump in the traction, by which it is known, it is
    not.
    """

    def displacement(r: Floats, z: Floats) -> Floats:
        return np.stack([0.0 * r, 0.0 * r, np.where(z < 1.0, z, z + (z - 1.0) ** 2)], axis=-1)

    def stress(r: Floats, z: Floats) -> Floats:
        lam, mu = steel.lame
        e = np.where(z < 1.0, 1.0, 1.0 + 2.0 * (z - 1.0))
        zero = 0.0 * r
        return np.stack([lam * e, lam * e, (lam + 2.0 * mu) * e, zero, zero, zero], axis=-1)

    exact = Exact(0, displacement, stress)
    space = Section(rectangle(0.5, 1.0, 2.0, 3, 8))
    outline = Outline(space)
    traction = edge_tractions(space, outline, exact)
    assert wrong(found_by(space, steel, exact, traction), exact).max() > 1e-3
    beyond = np.flatnonzero(space.nodes[outline.nodes[:, 2], 1] > 1.0)
    beyond = np.intersect1d(beyond, outline.rows["outer"])
    jump = 1e-6 * np.abs(traction).max()
    traction[beyond, :, 2] += jump
    off = wrong(found_by(space, steel, exact, traction), exact)[outline.rows["outer"]]
    assert off.max() < 2e-6  # the jump itself


@pytest.mark.parametrize("clockwise", [1.0, -1.0])
def test_smooth_and_sharp_corners(clockwise: float, steel: Material) -> None:
    """Along a fillet neighbours are those that go on smoothly; a shoulder's rim has none."""
    pin = Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02)), fillet=0.004)
    space = Section(meridian_mesh(pin, SectionSize()))
    outline = Outline(space)
    exact = Exact(
        0,
        lambda r, z: clockwise * np.stack([0.0 * r, r, 0.0 * r], axis=-1),
        lambda r, z: np.zeros((*r.shape, 6)),
    )
    found = found_by(space, steel, exact, np.zeros((len(outline.nodes), 3, 3, 1)))
    assert np.abs(found.stress).max() < 1e-11 * steel.youngs_modulus
    assert np.linalg.norm(found.tangent, axis=2) == pytest.approx(np.ones(found.tangent.shape[:2]))


def test_on_a_curved_edge_errors_fall_with_order_two(steel: Material) -> None:
    """Tension of a shouldered pin, whose traction on the fillet is given: the largest error."""
    pin = Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02)), fillet=0.004)
    exact: Exact = tension(steel)
    seen = []
    for k in (2.0, 4.0, 8.0):
        space = Section(meridian_mesh(pin, SectionSize().finer(k)))
        outline = Outline(space)
        found = found_by(space, steel, exact, edge_tractions(space, outline, exact))
        bow = found.points[:, 2] - (0.014, 0.024)
        middle = (np.abs(np.arctan2(-bow[:, 1], -bow[:, 0]) - np.pi / 4.0) < np.pi / 8.0) & (
            np.isin(np.arange(len(bow)), outline.rows["fillet 1"])
        )
        assert middle.sum() >= 3
        seen.append(wrong(found, exact)[middle].max())
    assert np.log2(seen[0] / seen[2]) / 2.0 > 1.9, seen

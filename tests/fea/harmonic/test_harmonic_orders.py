"""The stiffness of every harmonic: patch tests, and full orders on manufactured solutions."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import ElementTriP2

from fea.core.local_fit import nodal_extrapolation
from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.harmonic.assembly import Section
from fea.harmonic.model import HarmonicModel
from fea.harmonic.stress_recovery import reading
from fea.harmonic.surface_stress import skin
from geometry import Pin, Segment
from geometry.mesh.section_mesh import MeridianMesh, SectionSize, meridian_mesh
from tests.support.each import each
from tests.support.exact.exact_fields import (
    Exact,
    boundary_forces,
    edge_tractions,
    errors,
    unknowns_of,
    with_edges_moved,
)
from tests.support.exact.polynomial_fields import manufactured, polynomial
from tests.support.pins.section_grid import rectangle

SHOULDER = Pin("P", (Segment(0.02, 0.03, bore=0.008), Segment(0.03, 0.02)), fillet=0.004)
Terms = dict[tuple[int, int], float]


def model_on(pin: Pin, section: MeridianMesh, material: Material) -> HarmonicModel:
    return HarmonicModel(pin, section, material, ())


# U, V, W: the states of constant strain, and the rigid motions, of every harmonic that has any
LINEAR: dict[str, tuple[int, Terms, Terms, Terms]] = {
    "shift along z": (0, {}, {}, {(0, 0): 1.0}),
    "spin": (0, {}, {(1, 0): 1.0}, {}),
    "stretch": (0, {(1, 0): -0.7}, {}, {(0, 1): 1.0}),
    "shift along x": (1, {(0, 0): 1.0}, {(0, 0): -1.0}, {}),
    "turn": (1, {(0, 1): 1.0}, {(0, 1): -1.0}, {(1, 0): -1.0}),
    "shear": (1, {(0, 1): 1.0}, {(0, 1): -1.0}, {(1, 0): 2.0}),
    "ovalisation": (2, {(1, 0): 1.0}, {(1, 0): -1.0}, {}),
}


@each("state", LINEAR)
def test_patch(state: str, steel: Material) -> None:
    """States of constant strain on triangles of all shapes, curved along the fillet, on the axis
    and in a bore: residual forces below 1e-12 of the sum of the elements', stress exact to 1e-11.

    The curved elements are isoparametric, so linear displacements are theirs too, and 6 points in
    an element integrate their products with r exactly. Rigid motions leave no stress on the skin,
    the curved one included.
    """
    n, *parts = LINEAR[state]
    exact = manufactured(steel, n, *(polynomial(terms) for terms in parts))
    model = model_on(SHOULDER, meridian_mesh(SHOULDER, SectionSize()), steel)
    space, outline = model.space, model.outline
    assert "fillet 1" in space.section.edges
    truth = exact.at_nodes(space)
    K = space.stiffness(steel, n)
    x = unknowns_of(truth[..., 0])
    left = K @ x - boundary_forces(space, outline, exact)
    left[model._on_axis(n)] = 0.0  # the reactions there are none of the body's
    assert np.abs(left).max() < 1e-12 * (abs(K) @ np.abs(x)).max()
    true = exact.stress(*space.nodes.T)
    size = steel.youngs_modulus * np.abs(truth).max() / SHOULDER.length
    traction = edge_tractions(space, outline, exact)
    everywhere = reading(space, outline, steel, inside=space.nodes)
    _, stress = everywhere.of(n, truth, traction)
    assert np.abs(stress[-len(space.nodes) :, :, 0] - true).max() < 1e-11 * size
    found = skin(space, outline, steel, n, truth, traction)
    true = exact.stress(*np.moveaxis(found.points, -1, 0))
    wrong = np.abs(found.stress[..., 0] - true).max(axis=2)
    wrong[found.points[..., 0] == 0.0] = 0.0
    if np.abs(true).max() > 1e-9 * size:  # strains in the surface have a kink beside the fillet
        fillet = space.nodes[outline.nodes[outline.rows["fillet 1"]]].reshape(-1, 2)
        reach = np.linalg.norm(found.points[..., None, :] - fillet, axis=3).min(axis=2)
        wrong = wrong[reach.min(axis=1) > 0.002]
        assert len(wrong) > 15
    assert wrong.max() < 1e-11 * size


@each("state", LINEAR)
def test_patch_solved(state: str, steel: Material) -> None:
    """The same by solving for the inside, 1e-12 of the largest displacement (round-off of the
    system is 1e-13).
    """
    n, *parts = LINEAR[state]
    exact = manufactured(steel, n, *(polynomial(terms) for terms in parts))
    model = model_on(SHOULDER, meridian_mesh(SHOULDER, SectionSize()), steel)
    found = with_edges_moved(model.space, model.outline, steel, exact, model._on_axis(n))
    truth = exact.at_nodes(model.space)
    assert np.abs(found - truth).max() < 1e-12 * np.abs(truth).max()


def smooth(n: int) -> tuple[Floats, Floats, Floats]:
    """Displacements of harmonic n that are smooth in space: with p = (U + V) / 2, m = (U - V) / 2,
    these go as r^(n+1), r^|n-1| and W as r^n, times even powers of r; in n = 0 U and V as r.
    """

    def even(power: int, seed: int) -> Floats:
        c = np.random.default_rng(seed).uniform(0.3, 1.0, 6)
        a, b = power, power + 2
        powers = ((a, 0), (a, 1), (a, 3), (b, 0), (b, 2), (b, 3))
        return polynomial(dict(zip(powers, c * [1, 1, -1, -1, 1, 0.5], strict=True)))

    if n == 0:
        return even(1, 1), even(1, 2), even(0, 3)
    p, m = even(n + 1, 1), even(n - 1, 2)
    return p + m, p - m, even(n, 3)


CASES = {
    "tension": (0, (1.0, 0.0, 1.0)),
    "torsion": (0, (0.0, 1.0, 0.0)),
    "1": (1, (1.0, 1.0, 1.0)),
    "2": (2, (1.0, 1.0, 1.0)),
    "4": (4, (1.0, 1.0, 1.0)),
}


def orders(seen: list[tuple[float, float]]) -> Floats:
    """Between successive meshes, each twice as fine."""
    return np.asarray(np.log2(np.array(seen)[:-1] / np.array(seen)[1:]))


@each("inner", [0.0, 0.4])
@each("case", CASES)
def test_orders(case: str, inner: float, steel: Material) -> None:
    """Displacement 3, stress 2, in L2 and space, over three nested meshes, within 0.15."""
    n, factors = CASES[case]
    exact = manufactured(steel, n, *(f * c for f, c in zip(factors, smooth(n), strict=True)))
    pin = Pin("P", (Segment(1.2, 2.0, bore=2.0 * inner),))
    seen = []
    for k in (8, 16, 32):
        model = model_on(pin, rectangle(inner, 1.0, 1.2, k, k), steel)
        u = with_edges_moved(model.space, model.outline, steel, exact, model._on_axis(n))
        seen.append(errors(model.space, steel, exact, u))
    assert orders(seen) == pytest.approx(np.array([[3.0, 2.0]] * 2), abs=0.15), seen


@each("case", CASES)
def test_order_of_recovered_stress(case: str, steel: Material) -> None:
    """Largest error over the nodes: on the skin with order 2, less 0.1 because a maximum wanders
    from node to node; fitted to samples, up to the axis and the surface, where these are on one
    side only, with order 1.5 at least (measured 1.55), but on meshes like ours with at most half
    the error of averages of extrapolated stress, which have order 2.
    """
    n, factors = CASES[case]
    exact = manufactured(steel, n, *(f * c for f, c in zip(factors, smooth(n), strict=True)))
    pin = Pin("P", (Segment(1.2, 2.0),))
    seen = []
    for k in (8, 16, 32):
        model = model_on(pin, rectangle(0.0, 1.0, 1.2, k, k), steel)
        u = with_edges_moved(model.space, model.outline, steel, exact, model._on_axis(n))
        seen.append(_nodal_errors(model.space, model, exact, u))
        assert seen[-1][0] < 0.5 * _by_averages(model.space, steel, exact, u)
    fitted, on_skin = orders(seen)[-1]
    assert fitted > 1.5, seen
    assert on_skin > 1.9, seen


def _by_averages(space: Section, steel: Material, exact: Exact, u: Floats) -> float:
    """Largest error of stress at nodes off the ends, of the largest stress."""
    stress = space.sampled_stress(steel, exact.n, u)
    averaged = nodal_extrapolation(space.elements, space.sampled_at, ElementTriP2.doflocs.T)
    inside = (space.nodes[:, 1] > 0.0) & (space.nodes[:, 1] < 1.2)
    true = exact.stress(*space.nodes[inside].T)
    wrong = np.abs((averaged @ stress.reshape(-1, 6))[inside] - true).max()
    return float(wrong / np.abs(true).max())


def _nodal_errors(
    space: Section, model: HarmonicModel, exact: Exact, u: Floats
) -> tuple[float, float]:
    """Largest error of stress at inner nodes and on the skin, of the largest stress."""
    traction = edge_tractions(space, model.outline, exact)
    inside = space.nodes[(space.nodes[:, 1] > 0.0) & (space.nodes[:, 1] < 1.2)]
    there = reading(space, model.outline, model.material, inside=inside)
    _, stress = there.of(exact.n, u, traction)
    found = skin(space, model.outline, model.material, exact.n, u, traction)
    away = found.points[..., 0] > 0.0
    on_skin = found.stress[..., 0] - exact.stress(*np.moveaxis(found.points, -1, 0))
    true = exact.stress(*inside.T)
    peak = np.abs(true).max()
    wrong = np.abs(stress[-len(inside) :, :, 0] - true).max()
    return float(wrong / peak), float(np.abs(on_skin[away]).max() / peak)

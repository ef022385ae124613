"""The mesh of a pin's section: names, measures, extremes, determinism."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skfem import Basis, ElementTriP2

from geometry import Arc, Edge, Pin, Segment, meridian
from geometry.mesh.gmsh_tetrahedra import MIN_JACOBIAN_RATIO
from geometry.mesh.section_mesh import MeridianMesh, SectionSize, Spot, meridian_mesh
from geometry.mesh.solid_mesh import MeshError
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.section_pins import PINS, Floats, nodes

ALL = pytest.mark.parametrize("name", PINS)


def jacobians(found: MeridianMesh) -> Floats:
    """det J (M, Q) at many points, corners included."""
    x = np.array([(i / 4, j / 4) for i in range(5) for j in range(5 - i)]).T
    return np.asarray(found.mesh.mapping().detDF(x))


def volume(found: MeridianMesh) -> float:
    basis = Basis(found.mesh, ElementTriP2(), intorder=8)
    return float(2.0 * np.pi * np.sum(basis.dx * basis.global_coordinates()[0]))


@ALL
def test_volume(name: str) -> None:
    """Exact but for fillets, whose parabolas are off by the fourth power of an edge's angle: 1e-5
    of the volume (measured 4e-7 at most) on the coarsest mesh.
    """
    pin = PINS[name]
    curved = any(pin.fillet_at(i) for i in range(len(pin.segments) - 1))
    found = volume(meridian_mesh(pin, SectionSize()))
    assert found == pytest.approx(pin.volume, rel=1e-5 if curved else 1e-12)


@ALL
def test_surfaces(name: str) -> None:
    """All that the outline has, each as long as it is, in order round the section."""
    pin = PINS[name]
    found = meridian_mesh(pin, SectionSize())
    x = nodes(found)
    outline = [e for e in meridian(pin) if e.name]
    assert set(found.edges) == {e.name for e in outline}
    for e in outline:
        assert e.name
        edges = found.edges[e.name]
        ends = x[edges[:, 1]] - x[edges[:, 0]]
        assert ends.sum(axis=0) == pytest.approx(np.subtract(e.end, e.start), abs=1e-12)
        middle = x[edges[:, :2]].mean(axis=1)
        sagitta = np.linalg.norm(x[edges[:, 2]] - middle, axis=1)
        chord = np.linalg.norm(ends, axis=1)
        assert np.all(sagitta < (0.15 if "fillet" in e.name else 1e-9) * chord)
        for k in (0, 1, 2):
            assert np.all(_on(x[edges[:, k]], e) < 1e-9 * pin.length)


def _on(x: Floats, edge: Edge) -> Floats:
    """Distance of points from an edge of the outline, m."""
    if isinstance(edge, Arc):
        return np.asarray(np.abs(np.linalg.norm(x - edge.centre, axis=1) - edge.radius))
    start, end = np.array(edge.start), np.array(edge.end)
    along = (end - start) / np.linalg.norm(end - start)
    away = x - start
    return np.asarray(np.abs(away[:, 0] * along[1] - away[:, 1] * along[0]))


@ALL
def test_axis(name: str) -> None:
    """Its nodes are those at r = 0, exactly, along all that is solid."""
    pin = PINS[name]
    found = meridian_mesh(pin, SectionSize())
    r, z = nodes(found).T
    assert set(found.axis) == set(np.flatnonzero(r < 1e-9 * pin.smallest_diameter))
    assert np.all(r[found.axis] == 0.0)
    solid = [s.length for s in pin.segments if s.bore == 0.0]
    assert np.ptp(z[found.axis]) if solid else not len(found.axis)
    if solid:
        assert np.ptp(z[found.axis]) == pytest.approx(sum(solid))


@ALL
@each("factor", [1.0, 2.0])
def test_jacobians(name: str, factor: float) -> None:
    """Positive everywhere, and no element too bent."""
    detail = jacobians(meridian_mesh(PINS[name], SectionSize().finer(factor)))
    assert np.all(detail.min(axis=1) / detail.max(axis=1) > MIN_JACOBIAN_RATIO)


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.floats(0.3, 3.0), min_size=1, max_size=4),
    st.lists(st.floats(0.05, 5.0), min_size=4, max_size=4),
    st.just(0.0) | st.floats(1e-4, 1.0),
    st.just(0.0) | st.floats(1e-4, 0.95),
)
def test_any_pin(diameters: list[float], lengths: list[float], part: float, bore: float) -> None:
    """Volume and Jacobians of pins by chance, with what fillets and bores fit."""
    inner = bore * min(diameters)
    steps = [abs(a - b) / 2 for a, b in pairwise(diameters) if a != b]
    room = [*(0.4 * x for x in lengths), *steps]
    fillet = part * min(room) if min(steps, default=1.0) > 1e-3 else 0.0
    segments = (Segment(z, d, bore=inner) for d, z in zip(diameters, lengths, strict=False))
    pin = Pin("H", tuple(segments), fillet=fillet)
    try:
        found = meridian_mesh(pin, SectionSize())
    except MeshError as error:
        assert error.code == "too-many-elements"  # noqa: PT017
        return
    assert volume(found) == pytest.approx(pin.volume, rel=1e-4)
    detail = jacobians(found)
    assert np.all(detail.min(axis=1) / detail.max(axis=1) > MIN_JACOBIAN_RATIO)


def test_the_same_twice() -> None:
    """Bit for bit, also with another mesh in between."""
    pin, spots = PINS["shoulders"], [Spot(0.015, 0.0, 1e-4, 0.003)]
    one = meridian_mesh(pin, SectionSize(), spots)
    meridian_mesh(PINS["tube"], SectionSize())
    other = meridian_mesh(pin, SectionSize(), spots)
    assert nodes(one).tobytes() == nodes(other).tobytes()
    assert np.array_equal(one.mesh.dofs.element_dofs, other.mesh.dofs.element_dofs)
    assert list(one.edges) == list(other.edges)
    for name in one.edges:
        assert np.array_equal(one.edges[name], other.edges[name])


def test_what_cannot_be_meshed_within_reason() -> None:
    """A wall of a ten-thousandth on a long tube."""
    pin = Pin("P", (Segment(1.0, 0.02, bore=0.02 - 2e-6), Segment(1.0, 1.0, bore=0.0199)))
    with raises(MeshError, "too-many-elements", "pin P", "200,000 are allowed"):
        meridian_mesh(pin, SectionSize())


@each("fillet", [1e-9, 1e-13, 1e-40])
def test_a_fillet_too_small_to_mesh(fillet: float) -> None:
    """Refused at once: gmsh hung at 1e-13."""
    pin = Pin("P", (Segment(1.0, 2.0), Segment(1.0, 3.0)), fillet=fillet)
    with raises(MeshError, "fillet-too-small", "fillet 1"):
        meridian_mesh(pin, SectionSize())


def test_a_fillets_arc_is_round() -> None:
    """Nodes on the circle to 1e-12 m, middles of edges too."""
    pin = PINS["full fillet"]
    found = meridian_mesh(pin, SectionSize())
    x = nodes(found)[np.unique(found.edges["fillet 1"])]
    centre = (0.01 + 0.005, 0.02 + 0.005)
    assert np.linalg.norm(x - centre, axis=1) == pytest.approx(0.005, abs=1e-12)
    assert len(found.edges["fillet 1"]) >= 4
    assert math.isclose(x[:, 1].min(), 0.02, abs_tol=1e-12)

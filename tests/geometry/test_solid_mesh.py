"""Solid meshes: volume, areas, names, valid elements."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.solid.assembly import Discretisation
from fea.solid.boundary import Patch, surface
from geometry import Pin, Segment, meridian
from geometry.mesh import gmsh_tetrahedra as tetrahedra
from geometry.mesh.elements import with_element
from geometry.mesh.gmsh_session import gmsh_model
from geometry.mesh.solid_mesh import MeshError, MeshSize, solid_mesh
from tests.support.each import each
from tests.support.errors import raises

PINS = {
    "plain": Pin("plain", (Segment(0.05, 0.02, connection="B"),)),
    "sharp": Pin("sharp", (Segment(0.005, 0.03), Segment(0.03, 0.02, connection="B"))),
    "fillet": Pin(
        "fillet", (Segment(0.02, 0.02, connection="B"), Segment(0.01, 0.03)), fillet=0.003
    ),
    "whole step": Pin(
        "whole", (Segment(0.02, 0.03), Segment(0.02, 0.02, connection="B")), fillet=0.005
    ),
    "bores": Pin(
        "bores",
        (Segment(0.02, 0.02, bore=0.01, connection="B"), Segment(0.02, 0.03, bore=0.006)),
    ),
    "large": Pin("large", (Segment(5.0, 2.0, connection="B"), Segment(1.0, 3.0))),
}


@each("name", PINS)
def test_volume_area_names_and_elements(name: str) -> None:
    pin = PINS[name]
    solid = solid_mesh(pin, MeshSize(), (pin.band("B").z0, pin.band("B").z1))
    space = Discretisation(solid.mesh)
    assert solid.jacobian > 0.1
    # quadratic facets on a circle in 12 parts or more: 1e-4 is twice what is seen
    assert space.weights.sum() == pytest.approx(pin.volume, rel=1e-4)
    assert Patch(space, surface(space), "B").area == pytest.approx(pin.band("B").area, rel=1e-4)
    facets = np.concatenate(list(solid.mesh.boundaries.values()))
    assert np.array_equal(np.sort(facets), np.sort(solid.mesh.boundary_facets()))
    expected = {e.name for e in meridian(pin) if e.name}
    assert set(solid.mesh.boundaries) == expected


def test_nodes_of_a_band_lie_on_its_cylinder() -> None:
    pin = PINS["fillet"]
    space = Discretisation(solid_mesh(pin, MeshSize()).mesh)
    s = surface(space)
    on = s.corners[np.isin(s.facets, space.mesh.boundaries["B"])]
    x = space.nodes[on]
    assert np.hypot(x[..., 0], x[..., 1]) == pytest.approx(np.full(on.shape, 0.01), rel=1e-9)
    outward = s.normals[np.isin(s.facets, space.mesh.boundaries["B"])]
    radial = x[..., :2] / 0.01
    assert np.sum(outward[..., :2] * radial, axis=2).min() > math.cos(0.05)


def test_the_same_pin_gives_the_same_mesh() -> None:
    one, two = (solid_mesh(PINS["sharp"], MeshSize()) for _ in range(2))
    assert np.array_equal(one.nodes, two.nodes)
    assert np.array_equal(one.mesh.t, two.mesh.t)


def test_finer_means_more_elements() -> None:
    coarse = solid_mesh(PINS["plain"], MeshSize())
    fine = solid_mesh(PINS["plain"], MeshSize().finer(2.0))
    assert fine.mesh.nelements > 4 * coarse.mesh.nelements


def test_bad_elements_are_repaired(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mesh so coarse that gmsh's curved elements turn inside out (its own optimiser aborts the
    process on this one) must come out valid, with few elements touched and the volume kept.
    """
    pin = Pin("P", tuple(Segment(0.02, 0.02, connection=c) for c in "ABC"))
    edges = (0.0, 0.02, 0.04, 0.06)
    solid = solid_mesh(pin, MeshSize(across=2.5).finer(2.0**0.5), edges)
    assert 0 < solid.repaired < 0.02 * solid.mesh.nelements
    assert solid.jacobian > 0.1
    assert Discretisation(solid.mesh).weights.min() > 0.0
    assert Discretisation(solid.mesh).weights.sum() == pytest.approx(pin.volume, rel=1e-3)
    monkeypatch.setattr(tetrahedra, "MAX_REPAIRS", 0)
    monkeypatch.setattr("geometry.mesh.solid_mesh.MIN_JACOBIAN_RATIO", 1.5)  # more than any has
    with raises(MeshError, "bad-elements"):
        solid_mesh(pin, MeshSize(across=2.5).finer(2.0**0.5), edges)


def test_the_jacobian_measure_sees_an_inverted_element() -> None:
    """A mid-edge node pushed across its element turns det J negative; gmsh's bound must say so."""
    with gmsh_model("one") as gmsh:
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMin", 1.0)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        assert tetrahedra._jacobians(gmsh) == pytest.approx(1.0)
        nodes = gmsh.model.mesh.getElementsByType(11)[1].reshape(-1, 10)[0]
        a, b = (np.array(gmsh.model.mesh.getNode(n)[0]) for n in nodes[[0, 3]])
        gmsh.model.mesh.setNode(int(nodes[4]), list(a + 1.2 * (b - a)), [])
        assert tetrahedra._jacobians(gmsh).min() < 0.0
        jacobian, touched = tetrahedra.repair(gmsh)
        assert jacobian > 0.1
        assert touched >= 1


def test_a_pin_of_impossible_proportions_is_refused_before_it_is_meshed() -> None:
    wire = Pin("wire", (Segment(100.0, 0.001), Segment(1.0, 1.0)))
    with raises(MeshError, "too-many-elements", "pin wire", "1,000,000 are allowed"):
        solid_mesh(wire, MeshSize())


@pytest.mark.parametrize("diameter", [2e-5, 500.0])
def test_very_small_and_very_large_pins(diameter: float) -> None:
    pin = Pin("P", (Segment(2 * diameter, diameter), Segment(diameter, 1.5 * diameter)))
    solid = solid_mesh(pin, MeshSize())
    assert Discretisation(solid.mesh).weights.sum() == pytest.approx(pin.volume, rel=1e-3)


def test_other_elements_stand_on_the_same_vertices(cantilever_pin: Pin) -> None:
    """As gmsh makes them and as they are made from its curved ones; straight sides cut off a part
    of a cylinder, which on the same mesh is the same for linear and quadratic elements.
    """
    size = MeshSize(across=3.0)
    curved = solid_mesh(cantilever_pin, size).mesh
    volumes = {}
    for element in ("linear", "straight"):
        direct = solid_mesh(cantilever_pin, size, element=element).mesh
        made = with_element(curved, element)
        assert direct.p.shape == made.p.shape
        assert set(direct.boundaries) == set(made.boundaries) == set(curved.boundaries)
        for mesh in (direct, made):
            space = Discretisation(mesh)
            assert Patch(space, surface(space), "start").area < 0.998 * np.pi * 0.015**2
        volumes[element] = [Discretisation(m).weights.sum() for m in (direct, made)]
    assert volumes["linear"] == pytest.approx(volumes["straight"], rel=1e-9)
    assert volumes["linear"][0] == pytest.approx(volumes["linear"][1], rel=5e-3)
    assert max(volumes["linear"]) < 0.99 * cantilever_pin.volume

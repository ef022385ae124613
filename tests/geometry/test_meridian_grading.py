"""How large the elements of a section are: everywhere, along fillets, at spots."""

from __future__ import annotations

import numpy as np
import pytest

from geometry import Pin, Segment, vertices
from geometry.mesh.section_mesh import MeridianMesh, SectionSize, Spot, meridian_mesh
from geometry.mesh.sizing import size_at
from tests.support.each import each
from tests.support.pins.section_pins import PINS, Floats, nodes


def sizes(found: MeridianMesh) -> tuple[Floats, Floats]:
    """Middles (M, 2) and mean edge lengths (M,) of elements."""
    corners = nodes(found)[found.mesh.dofs.element_dofs[:3].T]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    return corners.mean(axis=1), edges.mean(axis=1)


def test_size_away_from_all() -> None:
    """`across` elements over the shaft, within the freedom of triangles (0.6 to 1.2)."""
    pin = PINS["plain"]
    for across in (2.0, 4.0, 8.0):
        _, size = sizes(meridian_mesh(pin, SectionSize(across=across)))
        assert 0.6 < np.median(size) / (0.02 / across) < 1.2
        assert size.max() < 1.5 * 0.02 / across


@each("arc", [4.0, 8.0, 16.0])
def test_elements_along_a_fillet(arc: float) -> None:
    found = meridian_mesh(PINS["shoulders"], SectionSize(arc=arc))
    for i in (1, 2):
        assert arc <= len(found.edges[f"fillet {i}"]) <= 1.5 * arc + 1


@each("size", [1e-4, 1e-5, 1e-6])
def test_elements_at_a_spot(size: float) -> None:
    """As small as asked beside it, and growing from there no faster than 0.7 per distance (1.5
    times that, as gmsh keeps to it by and large).
    """
    pin = PINS["tube"]
    v = next(v for v in vertices(pin) if v.z == 0.0)
    spot = Spot(v.r, v.z, size, 0.003)
    middle, length = sizes(meridian_mesh(pin, SectionSize(), [spot]))
    distance = np.linalg.norm(middle - [v.r, v.z], axis=1)
    beside = length[distance < 1.5 * size]
    assert len(beside)
    assert 0.4 < beside.mean() / size < 1.6
    near = distance < 0.003
    assert np.all(length[near] < 1.5 * (size + 0.7 * distance[near]) + 0.5 * size)


def test_nodes_at_the_reach_of_a_spot() -> None:
    """On both edges that meet there."""
    pin = Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02)))
    corner, reach = (0.01, 0.02), 0.002
    x = nodes(meridian_mesh(pin, SectionSize(), [Spot(*corner, 1e-4, reach)]))
    for there in ((0.01, 0.02 + reach), (0.01 + reach, 0.02)):
        assert np.linalg.norm(x - there, axis=1).min() < 1e-12


def test_the_size_that_is_told_is_the_least_of_all() -> None:
    """Half a shaft over `across` far away; at a fillet its arc over `arc`; at a spot its own."""
    pin = Pin("P", (Segment(0.2, 0.03), Segment(0.2, 0.02)), fillet=0.004)
    size = SectionSize(across=4.0, arc=8.0, growth=0.25)
    spot = Spot(0.015, 0.0, 1e-5, 0.002)

    def at(r: float, z: float) -> float:
        return size_at(pin, size, [spot], (r, z))

    assert at(0.0, 0.4) == pytest.approx(0.02 / 4.0)
    fillet = 0.004 * np.pi / 2.0 / 8.0
    assert at(0.01, 0.2) == pytest.approx(fillet)
    assert at(0.01, 0.2 + 1.3 * 0.004 + 0.008) == pytest.approx(fillet + 0.25 * 0.008)
    assert at(0.015, 0.0) == pytest.approx(1e-5)
    reach = at(0.015, 0.002 + 0.004)  # beyond its reach as after an element of growth x reach there
    assert reach == pytest.approx(0.25 * 0.002 + 0.25 * 0.004)
    found = meridian_mesh(pin, size, [spot])
    middle, length = sizes(found)
    told = np.array([at(*m) for m in middle])
    assert np.median(length / told) == pytest.approx(1.0, abs=0.25)

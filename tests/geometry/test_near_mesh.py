"""Meshes of near shapes with their nodes moved: exact outlines, good elements, and always the same
mesh for the same shape.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from skfem import Basis, ElementTriP2

from geometry import Pin, Segment, meridian
from geometry.mesh.moved import near_mesh
from geometry.mesh.section_mesh import (
    MIN_JACOBIAN_RATIO,
    MeridianMesh,
    SectionSize,
    Spot,
    meridian_mesh,
)
from geometry.mesh.sizing import Grade
from geometry.shape.profile import off_edge
from tests.support.each import each
from tests.support.pins.section_pins import PINS

PIN = Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02, connection="A")), fillet=0.002)


def wider(pin: Pin, times: float) -> Pin:
    """With another diameter of the second segment."""
    second = replace(pin.segments[1], diameter=times * pin.segments[1].diameter)
    return replace(pin, segments=(pin.segments[0], second, *pin.segments[2:]))


def volume(found: MeridianMesh) -> float:
    basis = Basis(found.mesh, ElementTriP2(), intorder=8)
    return float(2.0 * np.pi * np.sum(basis.dx * basis.global_coordinates()[0]))


@each("name", PINS)
def test_the_outline_is_exact_and_elements_are_good(name: str) -> None:
    pin = PINS[name]
    found = near_mesh.near_mesh(pin, SectionSize())
    curved = any(pin.fillet_at(i) for i in range(len(pin.segments) - 1))
    assert volume(found) == pytest.approx(pin.volume, rel=1e-5 if curved else 1e-12)
    for label in {e.name for e in meridian(pin) if e.name}:
        same = [off_edge(e) for e in meridian(pin) if e.name == label]
        r, z = found.nodes[np.unique(found.edges[label])].T
        assert np.min([off(r, z) for off in same], axis=0).max() < 1e-12 * pin.length
    assert (found.nodes[found.axis, 0] == 0.0).all()
    assert found.distortion().min() > MIN_JACOBIAN_RATIO


def test_near_shapes_have_the_same_elements_and_other_nodes() -> None:
    one, other = (near_mesh.near_mesh(wider(PIN, x), SectionSize()) for x in (1.0, 1.005))
    assert np.array_equal(one.elements, other.elements)
    assert one.shared is other.shared is not None
    apart = np.hypot(*(one.nodes - other.nodes).T)
    assert 0.0 < apart.max() < 0.006 * PIN.segments[1].diameter


def test_a_shape_has_the_same_mesh_whatever_was_meshed_before(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """To the last bit, with spots and grades: first of all, and after near and far shapes."""
    monkeypatch.setattr(near_mesh, "_KEPT_MESHES", near_mesh._Kept())
    corner = (PIN.segments[1].diameter / 2.0, PIN.stations[2])
    spots = [Spot(*corner, 1e-4, 1e-3)]
    high = [Grade(((0.0101, 0.0221),), 3e-4, 1e-3, 0.8)]
    first = near_mesh.near_mesh(PIN, SectionSize(), spots, high)
    for x in (1.003, 0.997, 1.2, 0.8):
        near_mesh.near_mesh(wider(PIN, x), SectionSize(), [], high)
        near_mesh.near_mesh(wider(PIN, x), SectionSize())
    monkeypatch.setattr(near_mesh, "MAX_KEPT_NODES", 1)
    near_mesh.near_mesh(PINS["plain"], SectionSize())
    again = near_mesh.near_mesh(PIN, SectionSize(), spots, high)
    assert first.shared is not again.shared
    assert first.nodes.tobytes() == again.nodes.tobytes()
    assert first.elements.tobytes() == again.elements.tobytes()


def test_a_node_stays_at_the_reach_of_a_spot() -> None:
    """Which is where the stress is read again: its distance is exact, on any shape."""
    for x in (0.98, 1.0, 1.013):
        pin = wider(PIN, x)
        r, z = pin.segments[1].diameter / 2.0, pin.stations[2]
        reach = 0.2 * r * (1.0 + 1e-7 * x)
        found = near_mesh.near_mesh(pin, SectionSize(), [Spot(r, z, 2e-4, reach)])
        distance = np.hypot(*(found.nodes[np.unique(found.edges["A"])] - [r, z]).T)
        assert np.abs(distance - reach).min() < 1e-12 * r


def test_what_a_fillet_leaves_of_a_shoulder_is_rounded_itself() -> None:
    """Where the rest, rounded with the diameters, would be quite another part of the shoulder."""
    for fillet in (0.00499, 0.0046, 0.0037):
        pin = Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02)), fillet=fillet)
        one, other = (near_mesh.near_mesh(pin.scaled(x), SectionSize()) for x in (1.0, 1.001))
        assert one.shared is other.shared is not None
        assert volume(one) == pytest.approx(pin.volume, rel=1e-5)
        assert one.distortion().min() > MIN_JACOBIAN_RATIO


def test_without_a_rounded_shape_it_is_the_shapes_own_mesh() -> None:
    """Of a small step in a bore, which rounded diameters do not have."""
    pin = Pin("P", (Segment(0.02, 0.03, bore=0.01), Segment(0.03, 0.03, bore=0.0102)))
    found = near_mesh.near_mesh(pin, SectionSize())
    assert found.shared is None
    own = meridian_mesh(pin, SectionSize())
    assert found.nodes.tobytes() == own.nodes.tobytes()

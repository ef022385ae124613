"""Edges of cuts in the view from y, x upwards, beside what cuts are by their numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from geometry import Bottom, Cut, CutPin, Flat, GeometryError, Hole, Passage, Pin, Segment, Slot
from geometry.mesh.solid_mesh import MeshError, MeshSize, solid_mesh
from geometry.shape.cut_edges import DrawnCut, drawn
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.errors import raises

R, L = 0.01, 0.1
SHAFT = Pin("shaft", (Segment(L, 2.0 * R),))
TUBE = Pin("tube", (Segment(L, 2.0 * R, bore=R),))
ACROSS = math.pi / 2.0


def ends(found: DrawnCut, hidden: bool) -> Floats:
    """Least and greatest z and x of the lines that are hidden, or seen: (2, 2)."""
    x = np.concatenate([at for at, hide in found.lines if hide == hidden])
    return np.array([x.min(axis=0), x.max(axis=0)])


def test_a_hole_towards_the_eye_is_a_circle_that_is_seen() -> None:
    found = drawn(Hole(0.05, 0.004, ACROSS), SHAFT)
    assert ends(found, False) == pytest.approx(np.array([[0.048, -0.002], [0.052, 0.002]]))
    blind = drawn(Hole(0.05, 0.004, -ACROSS, 0.005), SHAFT)
    assert all(hidden for _, hidden in blind.lines)


def test_a_blind_hole_ends_where_it_does() -> None:
    """4 mm deep, its tip a cone of 90 degrees below: 2 mm more."""
    found = drawn(Hole(0.05, 0.004, 0.0, 0.004, Bottom(ACROSS)), SHAFT)
    walls = ends(found, True)
    assert walls[:, 0] == pytest.approx([0.048, 0.052])
    assert walls[:, 1] == pytest.approx([R - 0.006, R])


def test_an_oblique_hole_has_its_mouths_apart() -> None:
    """Its walls lean by its tilt; beside the axis it is so when seen from above."""
    aside = drawn(Hole(0.05, 0.004, tilt=0.5), SHAFT)
    apart, half = R * math.tan(0.5), 0.002 / math.cos(0.5)
    both = np.concatenate([ends(aside, hidden) for hidden in (False, True)])
    assert both[:, 0].min() == pytest.approx(0.05 - apart - half)
    assert both[:, 0].max() == pytest.approx(0.05 + apart + half)
    above = drawn(Hole(0.05, 0.004, ACROSS, offset=0.003), SHAFT)
    assert ends(above, False) == pytest.approx(np.array([[0.048, -0.005], [0.052, -0.001]]))


def test_a_hole_through_a_tube_leaves_its_bore_alone() -> None:
    found = drawn(Hole(0.05, 0.004), TUBE)
    walls = [at[:, 1] for at, hidden in found.lines if hidden and np.ptp(at[:, 1]) > 1e-3]
    assert len(walls) == 4
    assert all(np.abs(x).min() == pytest.approx(R / 2.0) for x in walls)


def test_a_flat_is_a_chord_with_its_length() -> None:
    """Seen from its side a notch down to its distance; from above a field as wide as its chord."""
    aside = drawn(Flat(0.02, 0.05, 0.008), SHAFT)
    assert np.array(aside.notches) == pytest.approx(np.array([[0.02, 0.008, 0.05, R]]))
    above = drawn(Flat(0.02, 0.05, 0.008, ACROSS), SHAFT)
    assert not above.notches
    assert ends(above, False) == pytest.approx(np.array([[0.02, -0.006], [0.05, 0.006]]))
    behind = drawn(Flat(0.02, 0.05, 0.008, -ACROSS), SHAFT)
    assert all(hidden for _, hidden in behind.lines)


def test_a_keyway_has_its_outline_from_above_and_its_depth_from_aside() -> None:
    above = drawn(Slot(0.02, 0.05, 0.004, 0.003, ACROSS), SHAFT)
    assert ends(above, False) == pytest.approx(np.array([[0.02, -0.002], [0.05, 0.002]]))
    aside = drawn(Slot(0.02, 0.05, 0.004, 0.003, math.pi), SHAFT)
    assert np.array(aside.notches) == pytest.approx(np.array([[0.02, 0.003 - R, 0.05, -R]]))


def test_a_passage_is_hidden_and_ends_with_its_tip() -> None:
    found = drawn(Passage(0.0, 0.06, 0.004, 0.005, 0.0, "start", Bottom(ACROSS)), SHAFT)
    assert not [1 for _, hidden in found.lines if not hidden]
    assert ends(found, True) == pytest.approx(np.array([[0.0, 0.003], [0.062, 0.007]]))


def mouths(offset: float) -> float:
    """What a hole of 4 mm beside the axis takes of the surface."""
    y = offset + 0.002 * np.cos((np.arange(4000) + 0.5) * math.pi / 4000)
    step = np.sqrt(0.002**2 - (y - offset) ** 2) * math.pi / 4000
    wide = 2.0 * np.sqrt(0.002**2 - (y - offset) ** 2)
    return float(2.0 * np.sum(wide * step * R / np.sqrt(R**2 - y**2)))


@each(
    ("cut", "area"),
    [
        (Hole(0.05, 0.002), 2.0 * math.pi * 1e-6),
        (Hole(0.05, 0.002, 1.0, 0.003), math.pi * 1e-6),
        (Hole(0.05, 0.004, 1.0, offset=-0.006), mouths(0.006)),
        (Hole(0.05, 0.004, 1.0, offset=0.006, tilt=-0.6), mouths(0.006) / math.cos(0.6)),
        (Flat(0.02, 0.05, 0.008), 0.03 * 2.0 * R * math.acos(0.8)),
        (Slot(0.02, 0.05, 0.004, 0.003, 0.3, 0.0, False), 0.03 * 2.0 * R * math.asin(0.2)),
        (Passage(0.0, L, 0.004, 0.004), 0.0),
    ],
)
def test_what_cuts_take_of_the_surface(cut: Cut, area: float) -> None:
    """Counted on cells of the surface."""
    angle, z = (x.ravel() for x in np.meshgrid(np.arange(2000) * np.pi / 1000, np.arange(1000)))
    z = (z + 0.5) * L / 1000
    x = np.stack([R * np.cos(angle), R * np.sin(angle), z], axis=1)
    found = cut.takes(x, R).sum() * (2.0 * np.pi * R / 2000) * (L / 1000)
    assert found == pytest.approx(area, rel=0.02, abs=1e-12)


@each(
    ("holes", "code"),
    [
        ((Hole(0.05, 0.004), Hole(0.054, 0.004)), "thin-wall"),
        ((Hole(0.05, 0.004), Hole(0.054, 0.004, 1.0)), "thin-wall"),  # on the axis
        ((Hole(0.05, 0.004), Hole(0.05401, 0.004)), "thin-wall"),
        ((Hole(0.05, 0.004), Hole(0.055, 0.004)), ""),
        ((Hole(0.05, 0.004), Hole(0.05, 0.004, offset=0.004)), "thin-wall"),
        ((Hole(0.05, 0.004), Hole(0.05, 0.004, ACROSS, offset=0.003)), ""),  # into each other
        ((Hole(0.05, 0.004), Hole(0.056, 0.004, 0.0, offset=0.003, tilt=0.3)), ""),
        ((Hole(0.05, 0.004), Hole(0.052, 0.004)), ""),
        ((Hole(0.05, 0.004), Hole(0.054, 0.004, math.pi, 0.004)), "thin-wall"),
        ((Hole(0.05, 0.004, 0.0, 0.004), Hole(0.054, 0.004, math.pi, 0.004)), ""),
    ],
)
def test_holes_that_all_but_touch_are_refused(holes: tuple[Hole, ...], code: str) -> None:
    if code:
        with raises(GeometryError, code):
            CutPin(SHAFT, holes)
    else:
        assert len(CutPin(SHAFT, holes).cuts) == 2


def test_a_bottom_at_the_bore_is_refused() -> None:
    """At it, and a hundredth of the diameter before; into it and well before it is a hole."""
    for depth in (0.005, 0.00496):
        with raises(GeometryError, "thin-wall"):
            CutPin(TUBE, (Hole(0.05, 0.004, depth=depth),))
    for depth in (0.004, 0.006):
        assert CutPin(TUBE, (Hole(0.05, 0.004, depth=depth),)).cuts
    with raises(GeometryError, "hole-too-large"):
        CutPin(SHAFT, (Hole(0.05, 0.004, mouth_radius=0.009),))


def test_a_wall_too_thin_for_any_mesh_is_named() -> None:
    pin = CutPin(SHAFT, (Hole(0.05, 0.0199),))
    with raises(MeshError, "no-elements"):
        solid_mesh(pin, MeshSize(2.0, 2.0, 2.0))

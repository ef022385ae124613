"""Cross holes and flats: volume and areas beside quadrature, names, and what cannot be cut."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.solid.assembly import Discretisation
from fea.solid.boundary import Patch, surface
from fea.solid.sharp_edges import sharp_edges
from geometry import CutPin, Flat, GeometryError, Hole, Pin, Segment, Slot
from geometry.imported.meshing import solid_mesh
from geometry.mesh.solid_mesh import MeshSize
from tests.support.each import each
from tests.support.errors import raises

BAR = Pin("bar", (Segment(0.06, 0.02, connection="B"),))
R = 0.01


def sines(points: int = 4000) -> tuple[np.ndarray, float]:
    """Angles and weight of the midpoint rule over a quarter, which is exact to round-off for the
    smooth periodic integrands here.
    """
    step = math.pi / 2 / points
    return step * (np.arange(points) + 0.5), step


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_drilled_bar(angle: float) -> None:
    """Hole of radius a through a bar of radius R: the common volume is the integral of
    2 sqrt(R^2 - x^2) over the disc, the hole's wall 4 times that of chords, and the bar loses on
    its outside what lies above the disc, R / sqrt(R^2 - x^2) per area. Meshes to 1e-4, as for
    bands, and 1e-3 for what is curved twice.
    """
    a = 0.003
    pin = CutPin(BAR, (Hole(0.03, 2 * a, angle),))
    t, w = sines()
    x = a * np.sin(t)
    common = 4 * w * np.sum(2 * np.sqrt(R**2 - x**2) * (a * np.cos(t)) ** 2)
    wall = 4 * w * np.sum(2 * np.sqrt(R**2 - x**2) * a)
    lost = 2 * 4 * w * np.sum(R / np.sqrt(R**2 - x**2) * (a * np.cos(t)) ** 2)
    assert pin.volume == pytest.approx(BAR.volume - common, rel=1e-6)
    space = Discretisation(solid_mesh(pin, MeshSize()).mesh)
    assert space.weights.sum() == pytest.approx(pin.volume, rel=3e-4)
    boundary = surface(space)
    assert Patch(space, boundary, "hole 1").area == pytest.approx(wall, rel=1e-3)
    outside = BAR.band("B").area - lost
    assert Patch(space, boundary, "B").area == pytest.approx(outside, rel=3e-4)
    assert set(space.mesh.boundaries) == {"start", "B", "end", "hole 1"}
    assert not len(sharp_edges(space, boundary, ()).corner)


@each(("radius", "sharp"), [(0.04, False), (0.0, True)])
def test_the_rounded_bottom_of_a_keyway_is_no_sharp_corner(radius: float, sharp: bool) -> None:
    """With two facets across it was one on all meshes of a whole solid. The keyway ends beyond the
    shaft, within a band, where local solids do not apply.
    """
    d = 2.0 * R
    keyway = Slot(-0.25 * d, 0.6 * d, 0.3 * d, 0.125 * d, radius=radius * d)
    pin = CutPin(Pin("P", (Segment(d, d, connection="A"), Segment(0.5 * d, d))), (keyway,))
    space = Discretisation(solid_mesh(pin, MeshSize()).mesh)
    assert bool(len(sharp_edges(space, surface(space), ()).corner)) == sharp


def test_a_flat() -> None:
    """A segment of a circle is taken away; the flat's steps are inner corners without fillets."""
    d, long = 0.007, 0.02
    pin = CutPin(BAR, (Flat(0.02, 0.02 + long, d, 1.0),))
    half = math.acos(d / R)
    area = R**2 * half - d * math.sqrt(R**2 - d**2)
    assert pin.volume == pytest.approx(BAR.volume - area * long, rel=1e-6)
    space = Discretisation(solid_mesh(pin, MeshSize()).mesh)
    boundary = surface(space)
    width = 2 * math.sqrt(R**2 - d**2)
    assert Patch(space, boundary, "flat 1").area == pytest.approx(width * long, rel=1e-3)
    assert Patch(space, boundary, "flat 1 end").area == pytest.approx(2 * area, rel=1e-3)
    outside = BAR.band("B").area - 2 * half * R * long
    assert Patch(space, boundary, "B").area == pytest.approx(outside, rel=1e-3)
    found = sharp_edges(space, boundary, ("start",))
    z = found.corner[:, 2]
    assert np.minimum(np.abs(z - 0.02), np.abs(z - 0.04)).max() < 1e-9
    assert np.abs(found.corner[:, :2] @ [math.cos(1.0), math.sin(1.0)] - d).max() < 1e-9
    assert np.hypot(*found.rim[:, :2].T) == pytest.approx(np.full(len(found.rim), R), rel=1e-3)
    at = np.array([[d * math.cos(1.0), d * math.sin(1.0), 0.0205], [R, 0, 0], [-R, 0, 0.03]])
    (corner, near_corner), (rim, near_rim) = found.singularities(at, 0.1)
    assert (corner.kind, near_corner.tolist()) == ("sharp corner", [True, False, False])
    assert (rim.kind, near_rim.tolist()) == ("edge of a clamp", [False, True, False])
    assert corner.radius == pytest.approx(0.1 * 2.0 * R, rel=1e-3)
    assert corner.theory is None  # the angle is not known
    assert [p.kind for p, _ in sharp_edges(space, boundary, ()).singularities(at, 0.1)] == [
        corner.kind
    ]


@pytest.mark.slow
def test_holes_may_cross_and_a_profile_keeps_its_surfaces() -> None:
    """Through a bore, through a fillet, and at right angles through each other."""
    profile = Pin(
        "P",
        (Segment(0.03, 0.03), Segment(0.04, 0.02, bore=0.006, connection="B")),
        fillet=0.003,
    )
    holes = (Hole(0.033, 0.005), Hole(0.05, 0.004), Hole(0.05, 0.004, math.pi / 2))
    pin = CutPin(profile, holes)
    mesh = solid_mesh(pin, MeshSize(across=2.5)).mesh
    assert {"fillet 1", "shoulder 1", "bore B", "hole 1", "hole 2", "hole 3"} <= set(
        mesh.boundaries
    )
    assert (
        np.sort(np.concatenate(list(mesh.boundaries.values()))).tolist()
        == np.sort(mesh.boundary_facets()).tolist()
    )
    assert pin.surface("hole 3") == "hole 3"
    with raises(GeometryError, "unknown-surface", "'hole 4'", "hole 1, hole 2, hole 3"):
        pin.surface("hole 4")


@each(
    ("holes", "flats", "code"),
    [
        ((Hole(0.03, 0.02),), (), "hole-too-large"),
        ((Hole(0.03, 0.05),), (), "hole-too-large"),
        ((Hole(0.001, 0.005),), (), "beyond-end"),
        ((Hole(0.03, -1.0),), (), "not-positive"),
        ((), (Flat(0.01, 0.02, 0.011),), "cuts-nothing"),
        ((), (Flat(0.02, 0.01, 0.008),), "z-reversed"),
        ((), (Flat(0.07, 0.08, 0.008),), "beyond-end"),
        ((), (Flat(0.01, 0.02, 0.0),), "not-positive"),
    ],
)
def test_what_cannot_be_cut(holes: tuple[Hole, ...], flats: tuple[Flat, ...], code: str) -> None:
    with raises(GeometryError, code, "pin bar, ") as error:
        CutPin(BAR, (*holes, *flats))
    assert error.value.at == ("hole" if holes else "flat", 1)


def test_flats_that_leave_nothing_between_them() -> None:
    """Opposite flats are a tang; four of them with holes across may part the pin."""
    pin = CutPin(BAR, (Flat(0.02, 0.04, 0.004), Flat(0.02, 0.04, 0.004, math.pi)))
    assert pin.volume < BAR.volume
    buried = CutPin(BAR, (Flat(0.02, 0.04, 0.004), Flat(0.025, 0.035, 0.008)))
    with raises(GeometryError, "cut-away", "flat 2") as error:
        solid_mesh(buried, MeshSize())
    assert error.value.at == ("flat", 2)


def test_normals_point_out_of_the_wall_of_a_hole() -> None:
    """On coarse facets that bulge past the middle of their elements, too: all towards its axis."""
    pin = CutPin(BAR, (Hole(0.03, 0.006),))
    space = Discretisation(solid_mesh(pin, MeshSize()).mesh)
    boundary = surface(space)
    on = np.isin(boundary.facets, space.mesh.boundaries["hole 1"])
    to_axis = [0.0, 0.0, 0.03] - space.nodes[boundary.corners[on]]
    to_axis[..., 0] = 0.0
    cosine = np.sum(boundary.normals[on] * to_axis, axis=2) / 0.003
    assert cosine.min() > 0.9


def test_surfaces_of_a_cut_pin_have_names() -> None:
    pin = CutPin(BAR, (Hole(0.03, 0.006),))
    names = ["hole 1", "B", "start"]
    assert [pin.surface(name) for name in names] == names
    with raises(GeometryError, "unknown-surface", "'hole 2'", "hole 1"):
        pin.surface("hole 2")


def test_a_pin_that_is_parted_is_refused() -> None:
    """Four flats, none of which reaches the axis, and holes through what they leave."""
    flats = tuple(Flat(0.02, 0.04, 0.002, k * math.pi / 2) for k in range(4))
    pin = CutPin(BAR, (Hole(0.03, 0.006), *flats))
    with raises(GeometryError, "cut-apart", "pin bar", "2 pieces"):
        solid_mesh(pin, MeshSize())


@pytest.mark.parametrize("name", ["hole 1", "hole 1 wall"])
def test_a_band_has_not_the_name_of_a_cut(name: str) -> None:
    bar = Pin("bar", (Segment(0.06, 0.02, connection=name),))
    CutPin(bar, (Flat(0.0, 0.01, 0.008),))
    with raises(GeometryError, "duplicate-name", name):
        CutPin(bar, (Hole(0.03, 0.004),))

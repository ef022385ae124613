"""Blind holes, widened mouths, rounded flats, slots and passages: volumes beside quadrature, names,
images, and what cannot be cut.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from geometry import Bottom, Cut, CutPin, Flat, GeometryError, Hole, Passage, Pin, Segment, Slot
from geometry.mesh import cut_pin
from geometry.mesh.gmsh_session import MeshError
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.errors import raises

R, L = 0.01, 0.06
BAR = Pin("bar", (Segment(L, 2 * R, connection="B"),))
TIP = math.radians(118.0)
a, DEPTH, RHO = 0.002, 0.008, 0.0006
COUNT = 4000


def made(*cuts: Cut) -> CutPin:
    return CutPin(BAR, cuts)


def integral(f: Callable[[Floats], Floats], low: float, high: float) -> float:
    """By midpoints, of what has roots at its ends, too."""
    t = (np.arange(COUNT) + 0.5) * math.pi / COUNT
    x = 0.5 * (low + high) - 0.5 * (high - low) * np.cos(t)
    return float(np.sum(f(x) * np.sin(t)) * 0.5 * (high - low) * math.pi / COUNT)


def height(y: Floats) -> Floats:
    return np.sqrt(R**2 - y**2)


def over_disc(floor: float) -> float:
    """Between a plane and the surface of the bar, of a hole."""
    return integral(lambda y: 2.0 * np.sqrt(a**2 - y**2) * (height(y) - floor), -a, a)


def beside(offset: float) -> float:
    """Of a hole through the bar beside its axis; an oblique one is longer by its cosine."""
    return integral(
        lambda y: 4.0 * np.sqrt(a**2 - (y - offset) ** 2) * height(y), offset - a, offset + a
    )


def ring(rho: float, radius: float) -> float:
    """What rounds the right-angled corner of a cylinder, by Pappus: the area between a corner and
    its quarter circle, turned about the axis.
    """
    centroid = rho * (10.0 - 3.0 * math.pi) / (12.0 - 3.0 * math.pi)
    return rho**2 * (1.0 - math.pi / 4.0) * 2.0 * math.pi * (radius - centroid)


def countersink(wide: float) -> float:
    """What a cone of 45 degrees takes round a mouth: its height below the surface."""
    s, phi = np.meshgrid(
        a + (np.arange(400) + 0.5) * wide / 400, (np.arange(800) + 0.5) * 2 * math.pi / 800
    )
    above = height(s * np.sin(phi)) - (R - (a + wide - s))
    return float(np.sum(np.maximum(above, 0.0) * s) * wide / 400 * 2 * math.pi / 800)


def rounded_flat(distance: float, long: float) -> float:
    def length(u: Floats) -> Floats:
        deep = np.minimum(u - distance, RHO)
        return long - 2.0 * (RHO - np.sqrt(RHO**2 - (RHO - deep) ** 2))

    return integral(lambda u: 2.0 * height(u) * length(u), distance, distance + RHO) + integral(
        lambda u: 2.0 * height(u) * long, distance + RHO, R
    )


def slotted(width: float, long: float, floor: float | None) -> float:
    def length(y: Floats) -> Floats:
        return long - width + 2.0 * np.sqrt(width**2 / 4.0 - y**2)

    def high(y: Floats) -> Floats:
        return 2.0 * height(y) if floor is None else height(y) - floor

    return integral(lambda y: length(y) * high(y), -width / 2.0, width / 2.0)


CONE = a**3 / math.tan(TIP / 2.0) * math.pi / 3.0
CUTS: dict[str, tuple[Cut, float]] = {
    "blind": (Hole(0.03, 2 * a, 0.3, DEPTH), over_disc(R - DEPTH)),
    "tip": (Hole(0.03, 2 * a, 0.3, DEPTH, Bottom(TIP)), over_disc(R - DEPTH) + CONE),
    "rounded bottom": (
        Hole(0.03, 2 * a, 0.3, DEPTH, Bottom(radius=RHO)),
        over_disc(R - DEPTH) - ring(RHO, a),
    ),
    "countersink": (
        Hole(0.03, 2 * a, 0.3, chamfer=0.0006),
        2.0 * (over_disc(0.0) + countersink(0.0006)),
    ),
    "beside the axis": (Hole(0.03, 2 * a, 0.3, offset=-0.004), beside(0.004)),
    "oblique": (Hole(0.03, 2 * a, 0.3, tilt=0.5), 2.0 * over_disc(0.0) / math.cos(0.5)),
    "both": (Hole(0.03, 2 * a, 0.3, offset=0.004, tilt=-0.5), beside(0.004) / math.cos(0.5)),
    "flat": (Flat(0.02, 0.04, 0.007, 0.3, RHO), rounded_flat(0.007, 0.02)),
    "keyway": (Slot(0.02, 0.04, 0.005, 0.003, 0.3), slotted(0.005, 0.02, R - 0.003)),
    "slot through": (Slot(0.02, 0.04, 0.005, None, 0.3), slotted(0.005, 0.02, None)),
    "short slot": (Slot(0.02, 0.025, 0.005, None), 2.0 * integral(
        lambda y: 2.0 * np.sqrt(0.0025**2 - y**2) * height(y), -0.0025, 0.0025)),
    "square keyway": (
        Slot(0.02, 0.04, 0.005, 0.003, 0.3, 0.0, False),
        0.02 * integral(lambda y: height(y) - 0.007, -0.0025, 0.0025),
    ),
    "open keyway": (
        Slot(0.05, L, 0.005, 0.003, 0.3),
        slotted(0.005, 0.01 + 0.0025, R - 0.003)
        - integral(lambda y: (np.sqrt(0.0025**2 - y**2)) * (height(y) - 0.007), -0.0025, 0.0025),
    ),
    "passage": (Passage(0.0, L, 2 * a, 0.005, 0.3), math.pi * a**2 * L),
    "blind passage": (
        Passage(0.0, 0.03, 2 * a, 0.005, 0.3, "start", Bottom(TIP)),
        math.pi * a**2 * 0.03 + CONE,
    ),
    "passage from the end": (
        Passage(0.04, L, 2 * a, 0.005, 0.3, "end", Bottom(radius=RHO)),
        math.pi * a**2 * 0.02 - ring(RHO, a),
    ),
}  # fmt: skip


@each("name", CUTS)
def test_the_volume_of_a_cut(name: str) -> None:
    cut, expected = CUTS[name]
    # OpenCASCADE's volume of a body with an oblique hole, or one beside the axis, is 2e-6 off.
    aslant = 3e-6 * BAR.volume if isinstance(cut, Hole) and cut.aslant else 0.0
    assert BAR.volume - made(cut).volume == pytest.approx(expected, rel=2e-5, abs=aslant)


@each(
    ("size", "radius"),
    [(0.1, 0.05), (0.2, 0.38), (0.35, 0.15), (0.35, 0.31)],
)
def test_mouths_of_any_radius_that_fits_are_rounded(size: float, radius: float) -> None:
    """In metres OpenCASCADE failed at every third, and faces of wide holes "match no surface"."""
    d = 0.02 * size
    hole = Hole(0.02, d, 0.3, mouth_radius=radius * d)
    pin = CutPin(Pin("B", (Segment(0.04, 0.02),)), (hole,))
    sharp = CutPin(Pin("B", (Segment(0.04, 0.02),)), (replace(hole, mouth_radius=0.0),))
    taken = beside_balls(0.01, d / 2.0, radius * d)  # 2 % by its sample
    assert sharp.volume - pin.volume == pytest.approx(taken, rel=0.06)


def beside_balls(outer: float, a: float, rho: float) -> float:
    """The volume at both mouths of a hole of radius a that no ball of radius rho within the pin
    fills, from points at random. Their centres have r <= outer - rho, and s >= a + rho from the
    hole's axis.
    """
    rng, wide = np.random.default_rng(1), 2.0 * (a + 3.0 * rho)
    low = math.sqrt((outer - rho) ** 2 - (a + rho) ** 2) - 2.0 * rho
    x = rng.random((300_000, 3)) * [outer - low, wide, wide] + [low, -wide / 2.0, -wide / 2.0]
    r, s = np.hypot(x[:, 0], x[:, 1]), np.hypot(x[:, 1], x[:, 2])
    x = x[(r < outer) & (s > a)]
    r, s = np.hypot(x[:, 0], x[:, 1]), np.hypot(x[:, 1], x[:, 2])
    inward, outward = x.copy(), x.copy()  # to the nearest centre, as far as there is one
    inward[:, :2] *= np.minimum(1.0, (outer - rho) / r)[:, None]
    outward[:, 1:] *= np.maximum(1.0, (a + rho) / s)[:, None]
    filled = np.hypot(inward[:, 1], inward[:, 2]) >= a + rho
    filled |= (np.hypot(outward[:, 0], outward[:, 1]) <= outer - rho) & (s > a)
    turn = np.linspace(0.0, 2.0 * math.pi, 4001)
    y, z = (a + rho) * np.sin(turn), (a + rho) * np.cos(turn)
    along = np.stack([np.sqrt((outer - rho) ** 2 - y**2), y, z], axis=1)
    left = cKDTree(along).query(x[~filled])[0] > rho
    return 2.0 * (outer - low) * wide**2 * float(np.count_nonzero(left)) / 300_000


def test_a_mouth_that_does_not_fit_is_refused_with_the_largest_that_does() -> None:
    shaft = Pin("B", (Segment(0.08, 0.02),))
    with raises(GeometryError, "radius-too-large", "at most 0.893 of its diameter"):
        CutPin(shaft, (Hole(0.02, 0.0035, mouth_radius=0.0037),))


def test_mouths_that_gmsh_cannot_round_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """It said "a dimension that is very small compared with its neighbours"."""
    monkeypatch.setattr(cut_pin, "unit_of_solid", lambda *_: 1.0)  # as OpenCASCADE cannot
    shaft = Pin("B", (Segment(0.08, 0.02),))
    pin = CutPin(shaft, (Hole(0.02, 0.004, math.pi / 2.0, mouth_radius=0.0015),))
    with raises(MeshError, "mouth-not-rounded", "to 0.38 of its diameter", "or a chamfer"):
        assert pin.volume


def test_a_rounded_mouth_takes_what_lies_outside_of_its_circles() -> None:
    """Along the edge, where the material's angle changes, by Pappus, who does not know that the
    edge is curved in space as well; and a keyway's rounded bottom leaves such a ring.
    """
    sharp, rounded = (made(Hole(0.03, 2 * a, mouth_radius=r)).volume for r in (0.0, RHO))
    phi = (np.arange(400) + 0.5) * 2.0 * math.pi / 400
    half = 0.5 * (math.pi / 2.0 - np.arcsin(a * np.abs(np.sin(phi)) / R) * np.abs(np.sin(phi)))
    corner = RHO**2 * (1.0 / np.tan(half) - (math.pi / 2.0 - half))
    along = a + 0.25 * RHO  # about where its centroid moves
    assert sharp - rounded == pytest.approx(2.0 * np.mean(corner) * 2 * math.pi * along, rel=0.08)
    floor = [made(Slot(0.02, 0.04, 0.005, 0.003, 0.0, r)).volume for r in (0.0, RHO)]
    straight = 2.0 * 0.015 * RHO**2 * (1.0 - math.pi / 4.0)
    assert floor[1] - floor[0] == pytest.approx(straight + ring(RHO, 0.0025), rel=1e-4)


def test_a_countersink_is_cut_at_any_angle() -> None:
    """OpenCASCADE lost it at the last three, where the edge of its tool just touched the pin."""
    pin = Pin("P", (Segment(0.012936, 0.0077), Segment(0.01463, 0.0077, connection="B")))
    taken = [
        pin.volume - CutPin(pin, [Hole(0.009086, 0.001001, angle, chamfer=0.00015015)]).volume
        for angle in (0.3, 0.8, 1.68511056923227, 2.27)
    ]
    assert taken == pytest.approx([taken[0]] * 4, rel=1e-4)


@each("name", ["tip", "flat", "keyway", "blind passage"])
def test_surfaces_of_a_cut_are_one_boundary(name: str) -> None:
    """Only the ends of flats have a name of their own; everything has one, also in another unit."""
    cut, _ = CUTS[name]
    pin = made(cut).scaled(1e-4)
    mesh = solid_mesh(pin, MeshSize(across=2.5)).mesh
    own = {f"{cut.what} 1"} | ({"flat 1 end"} if cut.what == "flat" else set())
    assert set(mesh.boundaries) == {"start", "B", "end", *own}
    found = np.concatenate(list(mesh.boundaries.values()))
    assert np.sort(found).tolist() == np.sort(mesh.boundary_facets()).tolist()
    assert pin.surface(f"{cut.what} 1") == f"{cut.what} 1"


def test_images_of_cuts() -> None:
    """Twice mirrored is the same; a passage turns round; what goes through is its own image."""
    for cut, _ in CUTS.values():
        for plane in "xyz":
            assert cut.mirrored(plane).mirrored(plane).like(cut, 1e-12), (cut, plane)
        away = cut.moved(0.01, 0.2)
        assert away.extent == pytest.approx([z - 0.01 for z in cut.extent])
        assert not away.like(cut, 1e-9)
    one, other = CUTS["blind passage"][0].mirrored("z"), CUTS["slot through"][0]
    assert isinstance(one, Passage)
    assert (one.mouth, one.z0, one.z1) == ("end", -0.03, 0.0)
    assert other.turned(other.angle + math.pi).like(other, 1e-12)
    flat = CUTS["flat"][0]
    assert not flat.turned(flat.angle + math.pi).like(flat, 1e-12)
    assert not flat.like(other, 1.0)


BORED = Pin("bored", (Segment(L, 2 * R, 0.008, connection="B"),))


@each(
    ("cut", "code"),
    [
        (Hole(0.03, 2 * a, 0.0, -1.0), "not-positive"),
        (Hole(0.03, 2 * a, 0.0, 0.0001), "cuts-nothing"),
        (Hole(0.03, 2 * a, 0.0, 0.0199), "too-deep"),
        (Hole(0.03, 2 * a, 0.0, 0.0190, Bottom(TIP)), "too-deep"),
        (Hole(0.03, 2 * a, 0.0, DEPTH, offset=0.003), "key-not-applicable"),
        (Hole(0.03, 2 * a, 0.0, tilt=1.1), "too-oblique"),
        (Hole(0.03, 2 * a, 0.0, offset=R - a), "thin-wall"),
        (Hole(0.008, 2 * a, 0.0, tilt=0.7), "beyond-end"),
        (Hole(0.03, 2 * a, 0.0, DEPTH, Bottom(0.1)), "tip-angle"),
        (Hole(0.03, 2 * a, 0.0, DEPTH, Bottom(radius=1.01 * a)), "radius-too-large"),
        (Hole(0.03, 2 * a, chamfer=0.0001), "chamfer-too-small"),
        (Hole(0.03, 2 * a, chamfer=0.001, mouth_radius=0.001), "key-not-applicable"),
        (Hole(0.03, 2 * a, mouth_radius=0.0079), "radius-too-large"),
        (Hole(0.03, 2 * a, chamfer=0.0085), "hole-too-large"),
        (Flat(0.02, 0.03, 0.007, 0.0, 0.006), "radius-too-large"),
        (Slot(0.02, 0.03, 0.0), "not-positive"),
        (Slot(0.03, 0.02, 0.004), "z-reversed"),
        (Slot(0.07, 0.08, 0.004, 0.002), "beyond-end"),
        (Slot(0.05, 0.07, 0.004), "beyond-end"),
        (Slot(0.02, 0.05, 0.021), "slot-too-wide"),
        (Slot(0.02, 0.022, 0.004, 0.002), "slot-too-short"),
        (Slot(0.02, 0.04, 0.004, None, 0.0, RHO), "no-bottom"),
        (Slot(0.02, 0.04, 0.004, 0.0001), "cuts-nothing"),
        (Slot(0.02, 0.04, 0.004, R), "too-deep"),
        (Slot(0.02, 0.04, 0.004, 0.003, 0.0, 0.002), "radius-too-large"),
        (Passage(0.0, 0.03, 0.0, 0.004, 0.0, "start"), "not-positive"),
        (Passage(0.0, 0.03, 0.004, -0.004, 0.0, "start"), "negative"),
        (Passage(0.0, L, 0.004, 0.008, 0.0, "start"), "too-deep"),
        (Passage(0.0, 0.03, 0.004, 0.009, 0.0, "start"), "breaks-out"),
    ],
)
def test_what_is_refused(cut: Cut, code: str) -> None:
    with raises(GeometryError, code, f"pin bar, {cut.what} 1") as error:
        made(cut)
    assert error.value.at == (cut.what, 1)


def test_a_passage_beside_a_bore() -> None:
    """It must not meet it; a rounded mouth must be on a cylinder."""
    meets: Any = (Passage(0.0, L, 0.002, 0.0049),)
    with raises(GeometryError, "meets-bore", "passage 1"):
        CutPin(BORED, meets)
    assert CutPin(BORED, (Passage(0.0, L, 0.002, 0.007),)).volume < BORED.volume
    cone = Pin("cone", (Segment(L, 2 * R, end_diameter=R),))
    with raises(GeometryError, "mouth-not-on-cylinder", "hole 1"):
        CutPin(cone, (Hole(0.03, 2 * a, mouth_radius=RHO),))


def test_cuts_that_leave_too_little() -> None:
    """Slots across each other part the pin; a flat takes all of a band, or a slot of a flat."""
    cross = tuple(Slot(0.02, 0.04, 0.019, None, angle, 0.0, False) for angle in (0.0, math.pi / 2))
    with raises(GeometryError, "cut-apart", "pin bar", "pieces"):
        CutPin(BAR, cross).require_whole()
    narrow = Pin("N", (Segment(0.02, 2 * R), Segment(0.02, R, connection="B"), Segment(0.02, R)))
    around = tuple(Flat(0.02, 0.04, 0.003, k * math.pi / 2) for k in range(4))
    with raises(GeometryError, "cut-away", "all of B"):
        CutPin(narrow, around).require_whole()
    with raises(GeometryError, "cut-away", "flat 1") as error:
        CutPin(
            BAR, (Flat(0.025, 0.035, 0.0095), Slot(0.02, 0.04, 0.008, 0.005, 0.0))
        ).require_whole()
    assert error.value.at == ("flat", 1)

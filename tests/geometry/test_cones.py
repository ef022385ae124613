"""Cones, rounded edges, tapered bores, and outlines given by their corners."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import Arc, GeometryError, Pin, Segment, meridian, sharp_corners, vertices
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from geometry.shape.polyline import Bend, Stripe, pin_of_polyline, with_stripes
from tests.geometry.test_meridian_mesh import volume
from tests.geometry.test_pin import integrated_volume
from tests.support.each import each
from tests.support.errors import raises

CONE = Pin(
    "C",
    (
        Segment(2.0, 3.0, connection="A"),
        Segment(1.0, 3.0, end_diameter=2.0),
        Segment(2.0, 2.0, connection="B"),
    ),
)
EVERYTHING = Pin(
    "E",
    (
        Segment(2.0, 3.0, bore=0.5, end_bore=1.0, edge_radii=(0.3, 0.1), bore_radii=(0.05, 0.0)),
        Segment(1.0, 2.6, bore=1.0, end_diameter=2.0, fillet=0.3, bore_radii=(0.0, 0.1)),
        Segment(0.5, 2.0, bore=0.6, fillet=0.1, bore_radii=(0.08, 0.0)),
        Segment(0.5, 2.4, bore=0.6, edge_radii=(0.05, 0.1)),
    ),
    fillet=0.1,
)


def test_the_volume_of_a_cone_is_the_textbooks() -> None:
    frustum = math.pi * (1.5**2 + 1.5 * 1.0 + 1.0**2) / 3.0
    assert CONE.volume == pytest.approx(2.0 * math.pi * (2.25 + 1.0) + frustum, rel=1e-14)


def test_a_ball_is_two_rounded_ends() -> None:
    ball = Pin("B", (Segment(2.0, 2.0, edge_radii=(1.0, 1.0)),))
    assert ball.volume == pytest.approx(4.0 / 3.0 * math.pi, rel=1e-14)
    assert [e.name for e in meridian(ball)] == ["edge start", "edge end", None]


def test_a_cones_corners_have_its_angle() -> None:
    slope = math.atan2(0.5, 1.0)
    edge, inner = (v for v in vertices(CONE) if v.z in (2.0, 3.0))
    assert edge.angle == pytest.approx(math.pi - slope, abs=1e-14)
    assert inner.angle == pytest.approx(math.pi + slope, abs=1e-14)
    assert [(c.r, c.z) for c in sharp_corners(CONE)] == [(1.0, 3.0)]


def test_the_fillet_of_a_cone_is_tangent_to_it() -> None:
    pin = Pin("C", CONE.segments, fillet=0.4)
    (arc,) = [e for e in meridian(pin) if isinstance(e, Arc)]
    slope = math.atan2(0.5, 1.0)
    assert arc.turn == pytest.approx(-slope)
    taken = 0.4 * math.tan(slope / 2.0)
    assert pin.band("B").z0 == pytest.approx(3.0 + taken)
    assert all(v.angle == pytest.approx(math.pi) for v in vertices(pin) if "fillet 2" in v.between)
    assert not sharp_corners(pin)


def test_meshes_have_the_exact_volume() -> None:
    assert volume(meridian_mesh(CONE, SectionSize())) == pytest.approx(CONE.volume, rel=1e-12)
    assert EVERYTHING.volume == pytest.approx(integrated_volume(EVERYTHING), rel=1e-12)
    found = meridian_mesh(EVERYTHING, SectionSize())
    assert volume(found) == pytest.approx(EVERYTHING.volume, rel=1e-4)
    finer = volume(meridian_mesh(EVERYTHING, SectionSize().finer(2.0)))
    assert finer == pytest.approx(EVERYTHING.volume, rel=1e-5)
    assert set(found.edges) == {e.name for e in meridian(EVERYTHING) if e.name}
    edges = {f"edge {end}" for end in ("start", 1, 3, "end")} | {"bore edge start", "bore edge 2"}
    assert edges | {"fillet 2", "fillet 3", "bore fillet 2"} <= set(found.edges) | {"fillet 1"}


@each("pin", [CONE, EVERYTHING])
def test_the_solid_is_the_same_body(pin: Pin) -> None:
    made = solid_mesh(pin, MeshSize(across=3.0, corner=1.0))
    tetrahedra = made.mesh.mapping().detDF(made.mesh.p[:, :1] * 0.0 + 0.25)
    assert set(made.mesh.boundaries) == {e.name for e in meridian(pin) if e.name}
    assert float(tetrahedra.sum()) / 6.0 == pytest.approx(pin.volume, rel=0.02)


def test_a_groove_for_a_circlip_is_a_short_segment() -> None:
    groove = (Segment(5.0, 2.0), Segment(0.13, 1.9), Segment(0.5, 2.0))
    pin = Pin("G", groove, fillet=0.02)
    assert [e.name for e in meridian(pin) if isinstance(e, Arc)] == ["fillet 1", "fillet 2"]
    assert volume(meridian_mesh(pin, SectionSize())) == pytest.approx(pin.volume, rel=1e-7)


def _bends(pin: Pin) -> list[Bend]:
    out = [Bend(0.0, pin.segments[0].diameter / 2.0)]
    for i, (left, right) in enumerate(pairwise(pin.segments)):
        a, b, z = left.diameters[1] / 2.0, right.diameter / 2.0, pin.stations[i + 1]
        radius = pin.fillet_at(i)
        if a == b:
            out.append(Bend(z, a, radius))
        else:
            out += [Bend(z, a, radius if a < b else 0.0), Bend(z, b, 0.0 if a < b else radius)]
    return [*out, Bend(pin.length, pin.segments[-1].diameters[1] / 2.0)]


@st.composite
def profiles(draw: st.DrawFn) -> Pin:
    """Of cylinders and cones that taper towards the end."""
    segments, size = [], 4.0
    for _ in range(draw(st.integers(1, 4))):
        size -= draw(st.sampled_from([0.0, 0.25, 0.5]))
        taper = draw(st.sampled_from([0.0, 0.0, 0.125]))
        end = size - taper if taper else None
        fillet = draw(st.sampled_from([0.0, 0.03125]))
        segments.append(Segment(1.0, size, fillet=fillet, end_diameter=end))
        size -= taper
    return Pin("H", tuple(segments))


@settings(max_examples=60, deadline=None)
@given(profiles())
def test_a_polyline_is_the_same_pin_bit_for_bit(pin: Pin) -> None:
    assert meridian(pin_of_polyline("H", _bends(pin))) == meridian(pin)


def test_stripes_name_parts_of_cylinders() -> None:
    pin = pin_of_polyline("P", _bends(Pin("C", CONE.segments, fillet=0.1)))
    found = with_stripes(pin, [Stripe("B", 4.0, 5.0), Stripe("A", 0.5, 1.5, connection=False)])
    assert found.labels == ("segment 1", "A", "segment 3", "segment 4", "segment 5", "B")
    assert found.connections == ("B",)
    assert (found.band("A").z0, found.band("A").z1) == (0.5, 1.5)
    assert found.volume == pytest.approx(pin.volume, rel=1e-14)


@each("start", [0.1 + 0.2, 0.3, 0.3 - 1e-10])
def test_stripes_that_touch_but_for_round_off_have_nothing_between_them(start: float) -> None:
    first, second = Stripe("A", 0.1, 0.1 + 0.2), Stripe("B", start, 0.6)
    found = with_stripes(Pin("P", (Segment(1.0, 0.3),)), [second, first])
    assert found.labels == ("segment 1", "A", "B", "segment 4")


@each(
    ("stripe", "code"),
    [
        (Stripe("B", 2.2, 2.8), "band-on-cone"),
        (Stripe("B", 1.5, 2.2), "band-on-step"),
        (Stripe("B", 4.0, 6.0), "band-not-found"),
        (Stripe("B", 1.0, 0.5), "z-reversed"),
    ],
)
def test_stripes_elsewhere_are_refused(stripe: Stripe, code: str) -> None:
    with raises(GeometryError, code, "band B") as error:
        with_stripes(CONE, [stripe])
    assert error.value.at == ("band", "B")


@each(
    ("outside", "bore", "code"),
    [
        ([Bend(0, 1)], [], "too-few-corners"),
        ([Bend(0, 1), Bend(2, 1), Bend(1, 2)], [], "goes-back"),
        ([Bend(0, 1), Bend(1, 1), Bend(1, 2), Bend(1, 3), Bend(2, 3)], [], "three-at-one-z"),
        ([Bend(0, 1), Bend(0, 2), Bend(2, 2)], [], "face-in-outline"),
        ([Bend(1, 1), Bend(2, 1)], [], "not-whole"),
        ([Bend(0, 1), Bend(2, 1)], [Bend(0, 0.5), Bend(1, 0.5)], "not-whole"),
        ([Bend(0, 1), Bend(2, 1)], [Bend(0, 0.5), Bend(2, 1.5)], "bore-too-large"),
    ],
)
def test_outlines_that_cannot_be(outside: list[Bend], bore: list[Bend], code: str) -> None:
    with raises(GeometryError, code, "pin P"):
        pin_of_polyline("P", outside, bore)


@each(
    ("segments", "code"),
    [
        ((Segment(1, 2, end_diameter=1, connection="B"),), "band-on-cone"),
        ((Segment(1, 2, end_diameter=-1.0),), "not-positive"),
        ((Segment(1, 2, bore=1, end_bore=2),), "bore-too-large"),
        ((Segment(1, 2, edge_radii=(-0.1, 0)),), "negative"),
        ((Segment(1, 2, edge_radii=(1.1, 0)),), "fillets-overlap"),
        ((Segment(1, 2, edge_radii=(0.6, 0.6)),), "fillets-overlap"),
        ((Segment(1, 2, edge_radii=(0, 0.1)), Segment(1, 3)), "no-edge"),
        ((Segment(1, 2), Segment(1, 2, edge_radii=(0.1, 0))), "no-edge"),
        ((Segment(1, 2, bore_radii=(0.1, 0)),), "no-edge"),
        ((Segment(1, 2, bore=1, bore_radii=(0, 0.1)), Segment(1, 2, bore=1)), "no-edge"),
        ((Segment(1, 2), Segment(1, 2, end_diameter=4, fillet=0.1), Segment(1, 4)), None),
    ],
)
def test_impossible_cones_are_refused(segments: tuple[Segment, ...], code: str | None) -> None:
    if code is None:
        assert Pin("P", segments).volume > 0.0
        return
    with raises(GeometryError, code, "pin P"):
        Pin("P", segments)

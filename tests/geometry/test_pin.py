"""Pins: exact volume, bands and outline; shapes that cannot be."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import Arc, GeometryError, Pin, Segment, meridian, sharp_corners
from tests.support.each import each
from tests.support.errors import raises


def integrated_volume(pin: Pin) -> float:
    """By Gauss's theorem over the outline, edge by edge: V = pi * integral of r^2 dz."""
    total = 0.0
    for e in meridian(pin):
        if isinstance(e, Arc):
            a0, a1 = (math.atan2(p[1] - e.centre[1], p[0] - e.centre[0]) for p in (e.start, e.end))
            a1 += 2 * math.pi * round((a0 - a1) / (2 * math.pi))

            at, weight = np.polynomial.legendre.leggauss(20)
            a = a0 + (a1 - a0) * (at + 1.0) / 2.0
            r = e.centre[0] + e.radius * np.cos(a)
            total += float(weight @ (r**2 * e.radius * np.cos(a))) * (a1 - a0) / 2.0
        else:
            r0, r1, dz = e.start[0], e.end[0], e.end[1] - e.start[1]
            total += dz * (r0**2 + r0 * r1 + r1**2) / 3.0
    return math.pi * total


@st.composite
def pins(draw: st.DrawFn) -> Pin:
    n = draw(st.integers(1, 5))
    diameters = [draw(st.floats(0.5, 3.0)) for _ in range(n)]
    segments = [
        Segment(draw(st.floats(0.5, 4.0)), d, bore=draw(st.sampled_from([0.0, 0.1, 0.4])))
        for d in diameters
    ]
    steps = [abs(a - b) / 2 for a, b in pairwise(diameters) if a != b]
    room = min([*steps, *(s.length / 2 for s in segments)])
    return Pin("H", tuple(segments), fillet=draw(st.floats(0.0, 1.0)) * 0.99 * room)


@settings(max_examples=100, deadline=None)
@given(pins())
def test_the_volume_is_exact(pin: Pin) -> None:
    assert pin.volume == pytest.approx(integrated_volume(pin), rel=1e-10)


@settings(max_examples=20, deadline=None)
@given(pins())
def test_radii_at_many_places_are_those_at_each(pin: Pin) -> None:
    """To the last bit, at stations and beyond the ends too."""
    cone = Segment(0.7, 0.9, end_diameter=0.81, bore=0.1, end_bore=0.2)
    for one in (pin, replace(pin, segments=(*pin.segments, cone), fillet=0.0)):
        z = np.append(np.linspace(-0.1, one.length + 0.1, 37), one.stations)
        assert np.array_equal(one.radii_at(z), np.transpose([one.radii(float(x)) for x in z]))


@settings(max_examples=50, deadline=None)
@given(pins())
def test_the_outline_is_closed(pin: Pin) -> None:
    edges = meridian(pin)
    for a, b in zip(edges, (*edges[1:], edges[0]), strict=True):
        assert a.end == pytest.approx(b.start, abs=1e-12)


def test_a_fillet_takes_from_the_thinner_band_only() -> None:
    pin = Pin("P", (Segment(2.0, 2.0, connection="B"), Segment(1.0, 3.0)), fillet=0.3)
    assert (pin.band("B").z0, pin.band("B").z1) == (0.0, 1.7)
    assert pin.band("segment 2").length == 1.0
    assert pin.band("B").area == pytest.approx(2 * math.pi * 1.7)


def test_the_arc_is_tangent_to_shaft_and_shoulder() -> None:
    pin = Pin("P", (Segment(1.0, 3.0), Segment(2.0, 2.0)), fillet=0.3)
    (arc,) = [e for e in meridian(pin) if isinstance(e, Arc)]
    assert arc.centre == pytest.approx((1.3, 1.3))
    assert arc.start == pytest.approx((1.3, 1.0))
    assert arc.end == pytest.approx((1.0, 1.3))
    assert not sharp_corners(pin)


def test_a_segments_own_fillet_overrides_the_pins() -> None:
    segments = (Segment(1, 3, fillet=0.0), Segment(1, 2, fillet=0.1), Segment(1, 3))
    pin = Pin("P", segments, fillet=0.4)
    assert (pin.fillet_at(0), pin.fillet_at(1)) == (0.0, 0.1)
    assert [(c.r, c.z) for c in sharp_corners(pin)] == [(1.0, 1.0)]


def test_surfaces_go_by_connection_name_or_number() -> None:
    pin = Pin("P", (Segment(1, 2, name="root", connection="B"), Segment(1, 3, name="head")))
    assert [pin.surface(n) for n in ("B", "root", "head", "start")] == ["B", "B", "head", "start"]
    with raises(GeometryError, "unknown-surface", "'tail'", "start, end, B, head"):
        pin.surface("tail")
    solid = Pin("P", (Segment(1, 2, name="root"), Segment(1, 3, connection="bore root")))
    assert solid.band("bore root").radius == 1.5


@each(
    ("segments", "fillet", "code", "at"),
    [
        ((), 0.0, "no-segments", ()),
        ((Segment(0.0, 1.0),), 0.0, "not-positive", ("segment", 1)),
        ((Segment(1.0, -1.0),), 0.0, "not-positive", ("segment", 1)),
        ((Segment(1.0, np.inf),), 0.0, "not-positive", ("segment", 1)),
        ((Segment(1.0, 1.0, bore=1.0),), 0.0, "bore-too-large", ("segment", 1)),
        ((Segment(1.0, 2.0), Segment(1.0, 3.0)), 0.6, "fillet-too-large", ("segment", 1)),
        ((Segment(1, 3), Segment(0.5, 2), Segment(1, 3)), 0.3, "fillets-overlap", ("segment", 2)),
        ((Segment(1, 2), Segment(1, 3)), -0.1, "negative", ()),
        ((Segment(1, 3, bore=2.5), Segment(1, 2)), 0.0, "segments-separate", ("segment", 1)),
        ((Segment(1, 3, name="a"), Segment(1, 2, connection="a")), 0.0, "duplicate-name", ()),
        ((Segment(1, 3, name="start"),), 0.0, "duplicate-name", ()),
        ((Segment(1, 3, name="segment 2"), Segment(1, 2)), 0.0, "duplicate-name", ("segment", 1)),
        (
            (Segment(1, 3), Segment(1, 2, connection="shoulder 1")),
            0.0,
            "duplicate-name",
            ("segment", 2),
        ),
        (
            (Segment(1, 3), Segment(1, 2, connection="fillet 1")),
            0.1,
            "duplicate-name",
            ("segment", 2),
        ),
        (
            (Segment(1, 3, bore=1, name="a"), Segment(1, 2, name="bore a")),
            0.0,
            "duplicate-name",
            ("segment", 2),
        ),
    ],
)
def test_impossible_shapes_are_refused(
    segments: tuple[Segment, ...], fillet: float, code: str, at: tuple[str | int, ...]
) -> None:
    with raises(GeometryError, code, "pin P") as error:
        Pin("P", segments, fillet)
    assert error.value.at == at

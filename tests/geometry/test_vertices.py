"""Vertices of the outline: where, between which surfaces, at which angle."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import Arc, Pin, Segment, Vertex, meridian, sharp_corners, vertices
from tests.support.each import each

RIM, SMOOTH, INNER = math.pi / 2.0, math.pi, 1.5 * math.pi


def test_a_plain_pin_has_two_rims_and_nothing_on_the_axis() -> None:
    assert vertices(Pin("P", (Segment(3.0, 2.0),))) == (
        Vertex(1.0, 0.0, RIM, ("start", "segment 1")),
        Vertex(1.0, 3.0, RIM, ("segment 1", "end")),
    )


def test_equal_diameters_meet_smoothly() -> None:
    pin = Pin("P", (Segment(1.0, 2.0, connection="B"), Segment(1.0, 2.0)))
    assert vertices(pin)[1] == Vertex(1.0, 1.0, SMOOTH, ("B", "segment 2"))


@each("rises", [True, False])
def test_a_sharp_shoulder(rises: bool) -> None:
    thin, thick = Segment(2.0, 2.0, name="thin"), Segment(2.0, 3.0, name="thick")
    pin = Pin("P", (thin, thick) if rises else (thick, thin))
    inner, rim = vertices(pin)[1:3] if rises else vertices(pin)[2:0:-1]
    assert (inner.r, inner.z, inner.angle) == (1.0, 2.0, INNER)
    assert (rim.r, rim.z, rim.angle) == (1.5, 2.0, RIM)
    assert set(inner.between) == {"thin", "shoulder 1"}
    assert set(rim.between) == {"shoulder 1", "thick"}


@each("rises", [True, False])
@each("rho", [0.2, 1e-6, 3e-9])
def test_a_fillet_runs_smoothly_into_shaft_and_face(rises: bool, rho: float) -> None:
    thin, thick = Segment(2.0, 2.0), Segment(2.0, 3.0)
    pin = Pin("P", (thin, thick) if rises else (thick, thin), fillet=rho)
    angles = [v.angle for v in vertices(pin)]
    middle = [SMOOTH, SMOOTH, RIM]
    assert angles == [RIM, *(middle if rises else middle[::-1]), RIM]
    (arc,) = [e for e in meridian(pin) if isinstance(e, Arc)]
    smooth = [(v.r, v.z) for v in vertices(pin) if v.angle == SMOOTH]
    assert smooth == [arc.start, arc.end]


def test_a_fillet_as_high_as_the_step_ends_at_the_rim() -> None:
    pin = Pin("P", (Segment(2.0, 2.0), Segment(2.0, 3.0)), fillet=0.5)
    assert vertices(pin)[2] == Vertex(1.5, 2.0, RIM, ("fillet 1", "segment 2"))


def test_fillets_that_take_a_whole_groove_meet_smoothly() -> None:
    """0.1 + 0.2 - 0.3 is not 0: what is left of the groove may be negative and must not fold."""
    pin = Pin("P", (Segment(0.1, 0.8), Segment(0.2, 0.4), Segment(0.3, 0.8)), fillet=0.1)
    angles = [v.angle for v in vertices(pin)]
    assert angles == [RIM, RIM, SMOOTH, SMOOTH, SMOOTH, RIM, RIM]
    assert vertices(pin)[3].between == ("fillet 1", "fillet 2")


def test_bores_have_rims_and_inner_corners() -> None:
    pin = Pin("P", (Segment(1.0, 4.0, bore=1.0), Segment(1.0, 4.0, bore=2.0), Segment(1.0, 4.0)))
    inside = [v for v in vertices(pin) if v.r < 2.0]
    assert inside == [
        Vertex(1.0, 2.0, INNER, ("bore step 2", "bore segment 2")),
        Vertex(1.0, 1.0, INNER, ("bore segment 2", "bore step 1")),
        Vertex(0.5, 1.0, RIM, ("bore step 1", "bore segment 1")),
        Vertex(0.5, 0.0, RIM, ("bore segment 1", "start")),
    ]


@st.composite
def pins(draw: st.DrawFn) -> Pin:
    segments = tuple(
        Segment(
            1.0,
            draw(st.sampled_from([2.0, 2.5, 3.0])),
            bore=draw(st.sampled_from([0.0, 0.5, 1.0])),
            fillet=draw(st.sampled_from([0.0, 0.1, 0.25])),
        )
        for _ in range(draw(st.integers(1, 5)))
    )
    return Pin("H", segments)


@settings(max_examples=100, deadline=None)
@given(pins())
def test_the_turns_of_the_outline_make_one_circle(pin: Pin) -> None:
    """Its arcs turn back by a quarter each, and the axis ends in two right angles."""
    turns = sum(math.pi - v.angle for v in vertices(pin))
    turns -= sum(math.pi / 2.0 for e in meridian(pin) if isinstance(e, Arc))
    bores = [s.bore > 0.0 for s in pin.segments]
    # every stretch of the axis is entered and left at a right angle
    stretches = sum(not here and (i == 0 or bores[i - 1]) for i, here in enumerate(bores))
    assert turns + math.pi * stretches == pytest.approx(2.0 * math.pi, abs=1e-12)


@settings(max_examples=100, deadline=None)
@given(pins())
def test_inner_corners_are_the_sharp_corners(pin: Pin) -> None:
    inner = {(v.r, v.z) for v in vertices(pin) if v.angle > 1.01 * math.pi}
    assert inner == {(c.r, c.z) for c in sharp_corners(pin)}

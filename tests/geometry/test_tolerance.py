"""Dimensions that are one: closer than a billionth of the pin's smallest diameter."""

from __future__ import annotations

import math

import pytest

from geometry import (
    CutPin,
    Flat,
    GeometryError,
    Hole,
    Pin,
    Segment,
    meridian,
    sharp_corners,
    vertices,
)
from geometry.imported.meshing import solid_mesh
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize
from tests.support.each import each
from tests.support.errors import raises

INCH, MM = 0.7 * 0.0254, 17.78 * 1e-3  # the same, but for the last place
SHAFT = (Segment(0.02, INCH), Segment(0.03, MM, connection="B"), Segment(0.01, INCH))


def test_the_two_ways_to_write_it_do_differ() -> None:
    assert 0.0 < abs(INCH - MM) < 1e-17


@each("fillet", [0.0, 0.004])
def test_equal_diameters_in_different_units_are_one_surface(fillet: float) -> None:
    pin = Pin("P", SHAFT, fillet)
    assert {s.diameter for s in pin.segments} == {min(INCH, MM)}
    assert pin.merged == 0.0
    assert not sharp_corners(pin)
    assert not [e for e in meridian(pin) if e.name and e.name.startswith(("shoulder", "fillet"))]
    joints = [v for v in vertices(pin) if "B" in v.between]
    assert [v.angle for v in joints] == [math.pi, math.pi]
    assert set(meridian_mesh(pin, SectionSize()).edges) == {
        "start", "segment 1", "B", "segment 3", "end"
    }  # fmt: skip


def test_so_are_bores_and_what_is_drilled_across_them() -> None:
    bores = (0.3 * 0.0254, 7.62 * 1e-3, 0.762 * 1e-2)
    assert len(set(bores)) > 1
    profile = Pin(
        "P", tuple(Segment(s.length, s.diameter, b) for s, b in zip(SHAFT, bores, strict=True))
    )
    assert len({s.bore for s in profile.segments}) == 1
    cut = CutPin(profile, (Hole(0.035, 0.004),))
    named = solid_mesh(cut, MeshSize(across=2.0)).mesh.boundaries
    assert {"hole 1", "bore segment 1", "bore segment 2", "bore segment 3"} <= set(named)


@each("apart", [1e-12, 9e-10])
def test_what_is_merged_is_known(apart: float) -> None:
    pin = Pin("P", (Segment(1.0, 1.0 + apart), Segment(1.0, 1.0)))
    assert pin.segments[0].diameter == pin.segments[1].diameter == 1.0
    assert pin.merged == pytest.approx(apart, rel=1e-3)


def test_a_chain_of_small_differences_is_merged_as_a_whole() -> None:
    """Otherwise a step below the tolerance would be left between two groups."""
    d = (1.0, 1.0 + 0.8e-9, 1.0 + 1.6e-9, 1.5)
    pin = Pin("P", tuple(Segment(1.0, each) for each in d))
    assert [s.diameter for s in pin.segments] == [1.0, 1.0, 1.0, 1.5]


@each("apart", [2e-9, 1e-7, 1e-5])
def test_a_larger_difference_is_a_real_step(apart: float) -> None:
    pin = Pin("P", (Segment(1.0, 1.0 + apart), Segment(1.0, 1.0)))
    assert pin.merged == 0.0
    (corner,) = sharp_corners(pin)
    assert (corner.r, corner.z) == (0.5, 1.0)
    assert len(meridian_mesh(pin, SectionSize()).edges["shoulder 1"]) == 1


def test_a_fillet_is_not_made_as_high_as_a_tiny_step() -> None:
    for rho in (0.0, 0.5e-9):
        pin = Pin("P", (Segment(1.0, 1.0 + 2e-9), Segment(1.0, 1.0)), rho)
        assert pin.fillet_at(0) == rho


def test_a_fillet_as_high_as_the_step_in_another_unit() -> None:
    """(1 in - 0.7 in) / 2 = 3.81 mm leaves no shoulder of 1e-18 m, and is not too large."""
    for rho in (3.81e-3, 3.81e-3 * (1.0 + 1e-12), 3.81e-3 * (1.0 - 1e-12)):
        pin = Pin("P", (Segment(0.02, 0.0254), Segment(0.03, MM)), rho)
        assert [e.name for e in meridian(pin)][2] == "fillet 1"
        assert "shoulder 1" not in meridian_mesh(pin, SectionSize()).edges
    with raises(GeometryError, "fillet-too-large"):
        Pin("P", (Segment(0.02, 0.0254), Segment(0.03, MM)), 3.81e-3 * (1.0 + 1e-8))


def test_fillets_that_take_a_whole_shaft_meet_in_one_circle() -> None:
    long = 0.2 * 0.0254 + 1e-18
    pin = Pin("P", (Segment(0.02, 0.03), Segment(long, 0.018), Segment(0.02, 0.03)), 2.54e-3)
    assert pin.bands[1].length == 0.0
    assert {"fillet 1", "fillet 2"} <= set(meridian_mesh(pin, SectionSize()).edges)
    with raises(GeometryError, "fillets-overlap", "segment 2"):
        Pin(
            "P",
            (Segment(0.02, 0.03), Segment(long, 0.018, connection="B"), Segment(0.02, 0.03)),
            2.54e-3,
        )


def test_flats_end_where_a_band_does() -> None:
    profile = Pin("P", SHAFT)
    cut = CutPin(profile, (Flat(0.02 + 1e-13, 0.05 - 1e-13, 0.008),))
    assert cut.cuts["flat 1"].extent == (profile.stations[1], profile.stations[2])
    named = solid_mesh(cut, MeshSize(across=2.0)).mesh.boundaries
    assert {"flat 1", "B", "segment 1", "segment 3"} <= set(named)


@each(
    ("segments", "code"),
    [
        ((Segment(1.0, 1.0, bore=1.0 - 1e-10),), "bore-too-large"),
        ((Segment(1e-10, 1.0), Segment(1.0, 1.0)), "segment-too-short"),
        ((Segment(1, 3, bore=2), Segment(1, 2 + 1e-10)), "segments-separate"),
    ],
)
def test_less_than_the_tolerance_is_nothing(segments: tuple[Segment, ...], code: str) -> None:
    with raises(GeometryError, code, "segment 1"):
        Pin("P", segments)


@each(
    ("holes", "flats", "code"),
    [
        ((Hole(0.03, INCH),), (), "hole-too-large"),
        ((), (Flat(0.01, 0.02, MM / 2),), "cuts-nothing"),
    ],
)
def test_a_cut_that_just_touches(
    holes: tuple[Hole, ...], flats: tuple[Flat, ...], code: str
) -> None:
    with raises(GeometryError, code, "hole 1" if holes else "flat 1"):
        CutPin(Pin("P", SHAFT), (*holes, *flats))

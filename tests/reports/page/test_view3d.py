"""The data of a view: packed small, and still the fields that went in."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reports.data.results import Results
from reports.data.surface import HalfSection, LoadCourse, Surface, SurfaceCase
from reports.format.packed import packed
from reports.format.ranges import error_words
from reports.page.page import write_page
from reports.page.viewer import (
    MAX_DISPLACEMENT_INTEGER,
    MAX_SECTION_INTEGER,
    MAX_STRESS_INTEGER,
    pin_views,
)
from tests.support.each import each
from tests.support.programs.packed import unpacked
from tests.support.results.rows import with_values

EVIL = "</script><script>alert(1)</script>"


@pytest.fixture
def surface() -> Surface:
    """A meridian of five points and two unit loads; near the last point stresses are enormous."""
    rng = np.random.default_rng(7)
    stress = rng.normal(size=(5, 5, 2)) * np.array([1.0, 2.0, 3.0, 4.0, 1e6])[:, None, None]
    amounts = rng.normal(size=(3, 2, 2)) * np.array([1e-3, 50.0])[None, :, None]
    r = np.array([0.0, 0.5, 0.5, 0.5, 0.0])
    excluded = np.array([False, False, False, False, True])
    case = SurfaceCase(
        "landing",
        None,
        1,
        amounts,
        np.array([1.0, 5.0, 2.0]),
        excluded,
        0.0 * r + 1.0,
        zones=np.array([[0.0, 2.0, 0.3]]),
        loads=(LoadCourse("strut B", 1.5, 0.5, rng.normal(size=(3, 3)), False),),
        section=HalfSection(
            0.5,
            np.array([0.0, 1.0, 2.0]),
            np.zeros(3),
            np.full(3, 0.5),
            np.array([0.0, 1.0]),
            rng.uniform(0.0, 5.0, size=(2, 3, 2)),
        ),
    )
    return Surface(
        pin="B",
        points=np.stack([r, 0.0 * r, np.array([0.0, 0.0, 1.0, 2.0, 2.0])], axis=1),
        triangles=np.zeros((0, 3), dtype=np.int64),
        n=np.array([1, 0]),
        even=(True, True, True, False, False, True, False, True),
        stress=stress,
        displacement=rng.normal(size=(5, 3, 2)),
        yield_strength=100.0,
        cases=(case,),
    )


def data(results: Results, surface: Surface) -> dict[str, Any]:
    (view,) = pin_views(replace(results, surfaces=(surface,)), "B")
    return dict(json.loads(str(view.data)))


@each("kind", ["<i1", "<i2", "<u1", "<u2", "<u4", "<f4"])
def test_packed_numbers_come_back_to_the_last_bit(kind: str) -> None:
    """Extremes after each other, whose differences no number of the type holds."""
    whole = np.dtype(kind).kind != "f"
    ends = np.iinfo(kind) if whole else np.finfo(kind)
    values = np.array([ends.max, ends.min, ends.max, 0, 1, ends.min], dtype=kind)
    assert unpacked(packed(values, kind)).tolist() == values.astype(float).tolist()
    assert unpacked(packed(values[:0], kind)).tolist() == []


def test_every_point_is_exact_to_a_part_of_its_own_stress(
    results: Results, surface: Surface
) -> None:
    found = data(results, surface)
    (shown,), (case,) = found["surfaces"], found["cases"]
    scale = unpacked(shown["stress_scale"])
    stress = unpacked(shown["stress"]).reshape(2, 5, 5).T * scale[:, None, None]
    amounts = unpacked(case["amounts"]).reshape(2, 2, 3).T
    amounts = amounts * np.array(case["amounts_scale"])[:, None]
    for phase in (0, 1):
        theirs = stress @ amounts[:, :, phase].T
        ours = surface.stress @ surface.cases[0].amounts[:, :, phase].T
        largest = np.abs(surface.stress * np.abs(surface.cases[0].amounts).max(axis=(0, 2)))
        allowed = 2.0 * largest.max(axis=(1, 2)) / MAX_STRESS_INTEGER
        assert (np.abs(theirs - ours).max(axis=(1, 2)) <= allowed).all()
    moved = unpacked(shown["moved"]).reshape(2, 3, 5).T
    moved = moved * unpacked(shown["moved_scale"])
    theirs, ours = (
        moved @ amounts[1, :, 0],
        surface.displacement @ surface.cases[0].amounts[1, :, 0],
    )
    largest = np.abs(surface.displacement).max(axis=(0, 1))
    reach = largest @ np.abs(surface.cases[0].amounts).max(axis=(0, 2))
    assert theirs == pytest.approx(ours, abs=float(reach) / MAX_DISPLACEMENT_INTEGER)


def test_maxima_are_those_of_the_analysis(results: Results, surface: Surface) -> None:
    (case,) = data(results, surface)["cases"]
    (pin,) = (p for p in results.pins if (p.pin, p.case) == ("B", "landing"))
    assert case["maxima"] == [1.0, 5.0, 2.0]
    assert case["error"] == error_words(pin)
    assert case["verdict"] == "converged, beyond yield" if pin.yields else "converged"
    assert case["zones"] == [[0.0, 2.0, 0.3]]
    assert case["beneath"]  # 1 on the surface is less than the maximum


def test_a_maximum_on_the_surface_is_not_beneath(results: Results, surface: Surface) -> None:
    (pin,) = (p for p in results.pins if (p.pin, p.case) == ("B", "landing"))
    assert pin.max_von_mises is not None
    (case,) = surface.cases
    high = replace(case, largest=np.array([0.0, 0.0, pin.max_von_mises, 0.0, 9e9]))
    (found,) = data(results, replace(surface, cases=(high,)))["cases"]
    assert not found["beneath"]
    high = replace(case, largest=np.array([0.0, 0.0, 0.0, 0.0, pin.max_von_mises]))  # excluded
    (found,) = data(results, replace(surface, cases=(high,)))["cases"]
    assert found["beneath"]


def test_a_solid_without_stress_has_a_view(results: Results, surface: Surface) -> None:
    """The view turns about a place, which an idle row of a solid does not name."""
    (case,) = surface.cases
    solid = replace(surface, triangles=np.array([[1, 2, 3]]), cases=(replace(case, section=None),))
    rows = tuple(
        with_values(p, max_von_mises=0.0) if (p.pin, p.case) == ("B", "landing") else p
        for p in results.pins
    )
    (idle,) = (p for p in rows if (p.pin, p.case) == ("B", "landing"))
    assert idle.location is None
    (found,) = data(replace(results, pins=rows), solid)["cases"]
    assert np.shape(found["location"]) == (3,)
    assert np.shape(found["turn"]) == (3, 3)


def test_names_do_not_end_the_script(results: Results, surface: Surface, tmp_path: Path) -> None:
    (case,) = surface.cases
    evil = replace(surface, cases=(replace(case, case=EVIL),))
    rows = tuple(
        with_values(p, case=EVIL) if (p.pin, p.case) == ("B", "landing") else p
        for p in results.pins
    )
    made = replace(results, pins=rows, surfaces=(evil,))
    assert json.loads(str(pin_views(made, "B")[0].data))["cases"][0]["name"] == EVIL
    assert EVIL not in write_page(made, tmp_path).read_text(encoding="utf-8")


def test_loads_and_section_come_through(results: Results, surface: Surface) -> None:
    (case,) = data(results, surface)["cases"]
    (given,) = surface.cases
    assert given.section is not None
    (load,) = case["loads"]
    forces = unpacked(load["forces"]).reshape(3, 3) * load["scale"]
    assert forces == pytest.approx(given.loads[0].forces, abs=0.51 * load["scale"])
    assert (load["name"], load["z"], load["held"]) == ("strut B", 1.5, False)
    stress = unpacked(case["section"]["values"]).reshape(2, 3, 2) * case["section"]["scale"]
    largest = float(given.section.von_mises.max())
    assert stress == pytest.approx(
        given.section.von_mises, abs=0.51 * largest / MAX_SECTION_INTEGER
    )
    assert stress.max() == pytest.approx(largest, rel=1e-12)
    assert unpacked(case["section"]["outer"]).tolist() == [0.5, 0.5, 0.5]


def test_one_view_opens_on_the_case_that_governs(results: Results, surface: Surface) -> None:
    """Of a pin whose cases have meshes of their own, too; the landing is five times as bad."""
    (landing,) = surface.cases
    other = replace(surface, cases=(replace(landing, case="retract"),))
    (view,) = pin_views(replace(results, surfaces=(surface, other)), "B")
    assert view.cases == ("retract", "landing")
    assert view.cases[view.opens] == "landing"
    cases = json.loads(str(view.data))["cases"]
    assert [c["surface"] for c in cases] == [1, 0]


def test_maxima_along_the_pin_leave_out_what_is_excluded(
    results: Results, surface: Surface
) -> None:
    (case,) = surface.cases
    case = replace(case, largest=np.array([1.0, 2.0, 3.0, 4.0, 9.0]))
    (view,) = pin_views(replace(results, surfaces=(replace(surface, cases=(case,)),)), "B")
    assert view.along is not None
    rows = {row[0]: row[3:] for row in view.along.body}
    assert list(rows) == ["head", "drag brace B", "gap", "strut B", "nut"]
    assert rows["head"] == ["2.000", "0"]  # z from 0 to 0.25
    assert rows["drag brace B"] == ["3.000", "1.000"]
    assert rows["strut B"] == ["4.000", "2.000"]  # the next point there is excluded
    assert rows["gap"] == ["–", "–"]  # no point is there


@each("kind", ["u1", "<i1", "<i2", "<u2", "<u4", "<f4", "<f8"])
def test_numbers_of_every_type_that_is_packed_are_unpacked(kind: str) -> None:
    """Those of one byte have no order of bytes; "u1" was once written as "1", which left the views
    of pins with cuts empty.
    """
    values = np.array([0, 3, 100, 7])
    assert unpacked(packed(values, kind)).tolist() == values.tolist()

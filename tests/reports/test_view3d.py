"""The data of a view: packed small, and still the fields that went in."""

from __future__ import annotations

import json
from base64 import b64decode
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reports.data.results import Floats, Results
from reports.data.surface import Surface, SurfaceCase
from reports.format.ranges import error_words
from reports.page.page import write_page
from reports.page.viewer import WHOLE, pin_views

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
        "landing", None, 1, amounts, np.array([1.0, 5.0, 2.0]), excluded, 0.0 * r + 1.0
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


def unpacked(text: str, kind: str) -> Floats:
    return np.frombuffer(b64decode(text), dtype=kind).astype(np.float64)


def test_every_point_is_exact_to_a_part_of_its_own_stress(
    results: Results, surface: Surface
) -> None:
    found = data(results, surface)
    scale = unpacked(found["stress_scale"], "<f4")
    stress = unpacked(found["stress"], "<i2").reshape(5, 5, 2) * scale[:, None, None]
    amounts = unpacked(found["cases"][0]["amounts"], "<f4").reshape(3, 2, 2)
    for phase in (0, 1):
        theirs = stress @ amounts[:, :, phase].T
        ours = surface.stress @ surface.cases[0].amounts[:, :, phase].T
        largest = np.abs(surface.stress * np.abs(surface.cases[0].amounts).max(axis=(0, 2)))
        allowed = 2.0 * largest.max(axis=(1, 2)) / WHOLE
        assert (np.abs(theirs - ours).max(axis=(1, 2)) <= allowed).all()
    moved = unpacked(found["moved"], "<i2").reshape(5, 3, 2) * found["moved_scale"]
    theirs, ours = (
        moved @ amounts[1, :, 0],
        surface.displacement @ surface.cases[0].amounts[1, :, 0],
    )
    assert theirs == pytest.approx(ours, abs=1e-3 * float(np.abs(ours).max()))


def test_maxima_are_those_of_the_analysis(results: Results, surface: Surface) -> None:
    (case,) = data(results, surface)["cases"]
    (pin,) = (p for p in results.pins if (p.pin, p.case) == ("B", "landing"))
    assert case["maxima"] == [1.0, 5.0, 2.0]
    assert case["error"] == error_words(pin)
    assert case["verdict"] == "converged, beyond yield" if pin.yields else "converged"
    assert unpacked(case["excluded"], "u1").tolist() == [0, 0, 0, 0, 1]
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


def test_names_do_not_end_the_script(results: Results, surface: Surface, tmp_path: Path) -> None:
    (case,) = surface.cases
    evil = replace(surface, cases=(replace(case, case=EVIL),))
    rows = tuple(
        replace(p, case=EVIL) if (p.pin, p.case) == ("B", "landing") else p for p in results.pins
    )
    made = replace(results, pins=rows, surfaces=(evil,))
    assert json.loads(str(pin_views(made, "B")[0].data))["cases"][0]["name"] == EVIL
    assert EVIL not in write_page(made, tmp_path, {}, []).read_text(encoding="utf-8")

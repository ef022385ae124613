"""What a reader of VTU files finds on the surface that lugs leave free, by pyvista alone.

Which cells are pressed is told by the row's contact (cells with p > 0). How the program reads the
surface, and what it takes off or continues there, is not used.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista
from numpy.typing import NDArray

from pinstress.analysis.gather.gather import results_of
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.solve import solve_tasks
from pinstress.study.reading.file import load_study
from reports.data.fields import Field
from reports.data.results import Results
from reports.data.row import PinResult
from reports.vtk.fields import write_pin
from tests.conftest import ROOT
from tests.support.pins.clevis import CLEVIS

Rows = list[tuple[PinResult, Any, Any]]  # the others: pyvista.DataSet


def written(plan: Plan, folder: Path, also_solid: bool = True) -> Rows:
    """Each row with what is read of its VTU files: the surface, and the outside of the solid."""
    fields: list[Field] = []
    results: Results = results_of(plan, solve_tasks(plan, fields.append))
    out = []
    for row, field in zip(results.pins, fields, strict=True):
        name = f"{row.pin}_{row.case}"
        write_pin(field, name, folder, results.units)
        body = pyvista.read(folder / name / "solid.vtu") if also_solid else None
        outside = None if body is None else body.extract_surface(algorithm=None)
        out.append((row, pyvista.read(folder / f"{name}.vtu"), outside))
    return out


def in_cells(points: NDArray[np.float64], row: PinResult, more: float) -> NDArray[np.bool_]:
    """Points in pressed cells that are grown by a part of a cell on every side."""
    found = np.zeros(len(points), dtype=bool)
    angle, z = np.degrees(np.arctan2(points[:, 1], points[:, 0])), points[:, 2]
    assert row.places is not None
    assert row.places.contact is not None
    cells = [cell for band in row.places.contact.bands for cell in band.pressed]
    assert cells
    for z0, z1, a0, a1 in cells:
        dz, da = (more + 1e-6) * (z1 - z0), (more + 1e-6) * (a1 - a0)
        off = np.abs((angle - (a0 + a1) / 2.0 + 180.0) % 360.0 - 180.0)
        found |= (z > z0 - dz) & (z < z1 + dz) & (off < (a1 - a0) / 2.0 + da)
    return found


def require_free_of_steps(row: PinResult, read: Any, stress: str) -> None:
    largest, error, places = row.max_von_mises, row.error_estimate, row.places
    assert largest is not None
    assert error is not None
    assert places is not None
    (name,) = (n for n in read.point_data if n.startswith("von Mises [") and stress in n)
    points, von_mises = np.asarray(read.points, float), np.asarray(read.point_data[name])
    for more in (0.0, 0.5, 1.0):  # of a cell
        free = ~in_cells(points, row, more)
        assert von_mises[free].max() <= largest + error, (row.pin, more)
    unpressed = np.asarray(read.point_data["pressed"]) == 0
    assert von_mises[unpressed].max() <= largest + error
    assert von_mises[unpressed].max() >= 0.9 * places.surface.max_von_mises
    # the mask is that of the cells, but for the nodes at their very edges
    assert not (~unpressed & ~in_cells(points, row, 0.3)).any()


def require_rows(rows: Rows, stress: str) -> None:
    for row, surface, body in rows:
        require_free_of_steps(row, surface, stress)
        if body is not None:
            require_free_of_steps(row, body, stress)
        # two nodes to each cell, about
        angles = np.unique(np.round(np.arctan2(surface.points[:, 1], surface.points[:, 0]), 5))
        assert row.places is not None
        assert row.places.contact is not None
        cell = row.places.contact.bands[0].pressed[0]
        assert len(angles) >= 1.8 * 360.0 / (cell[3] - cell[2])


@pytest.mark.long
@pytest.mark.slow
def test_the_free_surface_of_a_clevis_pin_has_no_steps_of_its_lugs(tmp_path: Path) -> None:
    (tmp_path / "clevis.toml").write_text(CLEVIS, encoding="utf-8")
    plan = prepare(load_study(tmp_path / "clevis.toml"), also="solid")
    require_rows(written(plan, tmp_path), "MPa")


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("pins", ["EJ", "DG"])
def test_the_free_surface_of_the_gear_has_no_steps_of_its_lugs(pins: str, tmp_path: Path) -> None:
    """D, G, E: a fillet beside a lug governs; J: the section, beside the edges of touching lugs."""
    gear = load_study(ROOT / "studies" / "landing_gear.toml")
    plan = prepare(gear, pins=list(pins), cases=["landing"], also="solid")
    rows = written(plan, tmp_path)
    assert [row.pin for row, *_ in rows] == list(pins)
    require_rows(rows, "psi")


@pytest.mark.slow
def test_the_envelope_has_what_is_read_at_some_instant(tmp_path: Path) -> None:
    """Over a motion lugs press here and there: where they always do, there is none; nowhere is
    it more than the largest of the surface over all instants, at which the row is.
    """
    gear = load_study(ROOT / "studies" / "landing_gear.toml")
    ((row, read, _),) = written(
        prepare(gear, pins=["E"], cases=["retract"]), tmp_path, also_solid=False
    )
    envelope = np.asarray(read.point_data["von Mises envelope [psi]"])
    now, pressed = (np.asarray(read.point_data[n]) for n in ("von Mises [psi]", "pressed"))
    assert row.max_von_mises is not None
    assert row.error_estimate is not None
    assert np.nanmax(envelope) <= row.max_von_mises + row.error_estimate
    assert (envelope[pressed == 0] >= now[pressed == 0] * (1.0 - 1e-6)).all()
    assert np.isnan(envelope).any()
    assert np.isfinite(envelope[pressed == 1]).any()  # pressed now, but not always


@pytest.mark.long
@pytest.mark.slow
def test_a_pin_with_a_hole_is_shown_like_others(tmp_path: Path) -> None:
    """By the local solid about its hole and beside it, under a lug and beside its edges."""
    hole = 'material = "steel"\nhole = [{ z = 40.0, diameter = 3.0, angle = "90 deg" }]'
    text = CLEVIS.replace('material = "steel"', hole, 1)
    (tmp_path / "clevis.toml").write_text(text, encoding="utf-8")
    ((row, read, _),) = written(prepare(load_study(tmp_path / "clevis.toml")), tmp_path, False)
    assert row.model == "harmonic+local"
    require_free_of_steps(row, read, "MPa")

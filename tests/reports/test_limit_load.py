"""The limit load of a row in tables, in results.json and as a plot."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista

from assess.plastic.records import FlowField, LimitLoad, LoadCurve, PlasticMesh
from geometry import Pin, Segment
from geometry.mesh.hexahedra import HexSize, hexahedra, twenty
from pinbase.records import pack, unpack
from reports.data.results import Results
from reports.plots.strength import limit_plot
from reports.tables.json_results import to_json
from reports.tables.strength.limit_load import limit_load_table, limit_word, limits_table
from reports.vtk.fields import write_flow
from tests.support.each import each
from tests.support.results.rows import with_values

CURVE = LoadCurve(
    np.array([0.0, 0.5, 0.9]), np.array([0.0, 1e-3, 4e-3]), np.array([0.0, 0.0, 2.5e-3])
)
FOUND = LimitLoad(
    method="solid",
    lower=0.88,
    upper=0.91,
    carries=False,
    permanent_set=1e-3,
    permanent_at=0.84,
    meshes=(
        PlasticMesh(900, 0.9, 0.92, 0.05, 0.01, 12, 40),
        PlasticMesh(3000, 0.89, 0.91, 0.03, 0.01, 12, 44),
    ),
    curve=CURVE,
)


def test_a_file_of_flow_has_the_pin(results: Results, tmp_path: Path) -> None:
    """VTK finds the volume of the quarter that was computed, so the nodes are in its order."""
    pin = Pin("p", (Segment(1.0, 2.0), Segment(1.0, 3.0)), fillet=0.2)
    mesh = hexahedra(pin, HexSize(4, 0.25), 1)
    strain = mesh.nodes[:, 2].copy()
    flow = FlowField(mesh.nodes, mesh.elements[:, twenty()], 0.0 * mesh.nodes, strain, strain, 1.2)
    write_flow(flow, tmp_path / "flow.vtu", results.units)
    read = pyvista.read(tmp_path / "flow.vtu")
    assert set(read.celltypes.tolist()) == {25}
    assert read.volume == pytest.approx(pin.volume / 4.0, rel=2e-2)
    assert np.max(read.point_data["equivalent plastic strain"]) == pytest.approx(2.0)
    assert read.field_data["load factor"][0] == pytest.approx(1.2)


@each(
    ("limit", "word"),
    [
        (FOUND, "collapses"),
        (replace(FOUND, carries=True), "bends"),
        (replace(FOUND, carries=None), "not decided"),
        (LimitLoad("none", note="no mesh"), "not computed"),
    ],
)
def test_words(results: Results, limit: LimitLoad, word: str) -> None:
    row = with_values(results.pins[0], safety_factor=0.9)
    assert limit_word(row, limit) == word


@each(("permanent_set", "word"), [(0.0, "does not yield"), (1e-3, "bends")])
def test_a_pin_that_does_not_yield_does_not_bend(
    results: Results, permanent_set: float, word: str
) -> None:
    """A limit load that was asked for, of a pin with the factor 1.33, said that it bends."""
    row = with_values(results.pins[0], safety_factor=1.33, verdict="converged")
    limit = replace(FOUND, carries=True, permanent_set=permanent_set, permanent_at=1.0)
    assert limit_word(row, limit) == word
    singular = with_values(row, verdict="singular")
    assert limit_word(singular, limit) == "bends"


def test_the_cache_gives_back_what_it_took() -> None:
    back = unpack(LimitLoad, pack(FOUND))
    assert back.curve is not None
    np.testing.assert_array_equal(back.curve.factor, CURVE.factor)
    assert replace(back, curve=None) == replace(FOUND, curve=None)


def test_tables_json_and_plot_are_in_the_units_of_the_study(results: Results) -> None:
    none = to_json(results)["pins"][0]["limit_load"]
    assert none is None
    assert not limits_table(results).rows
    assert not limit_load_table(results).rows
    first = replace(results.pins[0], limit_load=FOUND)
    with_one = replace(results, pins=(first, *results.pins[1:]))
    written = to_json(with_one)["pins"][0]["limit_load"]
    assert (written["lower"], written["upper"], written["carries"]) == (0.88, 0.91, False)
    assert [mesh["unknowns"] for mesh in written["meshes"]] == [900, 3000]
    grid = limits_table(with_one).grid(results.units)
    assert grid.body[0][:4] == [first.pin, first.case, "collapses", "0.880 to 0.910"]
    table = limit_load_table(with_one)
    assert len(table) == 3
    (displacement,) = (c for c in table.columns if c.key == "displacement")
    assert displacement.unit(results.units) == results.units.length
    plot = limit_plot(first, results.units)
    assert plot is not None
    rows = plot.spec["data"]["values"].splitlines()[1:]
    assert all(row.split(",")[1] for row in rows)  # a gap would break the line

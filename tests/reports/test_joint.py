"""Contact of a pin with its lugs in tables, plots, page and terminal."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from io import StringIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from rich.console import Console

from fea.support.records import JointRange, JointResult, Variation
from pinbase.records import in_units
from pinstress.study.schema.units import UNIT_SYSTEMS
from reports.data.dependence import depends_on
from reports.data.fields import Field
from reports.data.results import Results
from reports.files import write_reports
from reports.format.ranges import part_words, variation_range
from reports.format.words import JOINT_RANGE_NOTE
from reports.page.viewer import pin_views
from reports.plots.all import all_plots
from reports.plots.draw import draw
from reports.plots.stress.joint import joint_plot
from reports.tables.strength.safety_factors import (
    safety_factors_table,
    shown_factors,
    write_safety_factors,
)
from reports.tables.stress.joint import joint_json, joint_tables
from reports.text.safety_factors import print_safety_factors
from reports.text.summary import summary
from reports.vtk.fields import point_data, surface
from tests.support.programs.packed import unpacked
from tests.support.results.html_page import EVIL, parse
from tests.support.results.made_up_joint import in_lugs, make_joint, surface_in

CONTACT = make_joint()


@pytest.fixture(scope="module")
def small(results: Results) -> Results:
    """Two rows, the first in contact."""
    few = replace(results, pins=results.pins[:2], shapes=(), reactions=(), motion=(), drive=())
    few = replace(few, beam_check=None, motion_check=None, published=())
    return in_lugs(few, CONTACT)


@pytest.fixture(scope="module")
def written(small: Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_reports(small, tmp_path_factory.mktemp("joint"))


def test_lengths_of_a_joint_are_converted() -> None:
    found = in_units(CONTACT, UNIT_SYSTEMS["mm-N-s"].factor)
    assert found.range is not None
    assert [v.length for v in found.range.variations] == pytest.approx([0.0, 3.0, None])
    assert found.bands[0].ends == pytest.approx((0.0, 500.0, 1000.0))
    assert found.bands[0].line_load[0] == pytest.approx((250.0, 0.3))  # N/mm


def test_tables_and_json_have_the_same_numbers(small: Results, tmp_path: Path) -> None:
    for table in joint_tables(small):
        assert all(len(row) == len(table.keys) for row in table.cells())
        table.write(tmp_path)
    with (tmp_path / "joint_range.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    found = joint_json(small.pins[0].joint)
    assert found is not None
    for row, entry in zip(rows, found["range"]["over"], strict=True):
        assert (float(row["length"]) if row["length"] else None) == entry["length"]
        assert row["length_unit"] == ("in" if row["length"] else "")
        assert row["value"] == entry["value"]
    with (tmp_path / "line_loads.csv").open(encoding="utf-8", newline="") as file:
        first = next(csv.DictReader(file))
    ends = [float(first["z_start"]), float(first["z_end"])]
    assert ends == found["bands"][0]["ends"][:2]


def test_loads_without_rings_have_no_ends(small: Results) -> None:
    smooth = replace(CONTACT, bands=(replace(CONTACT.bands[0], ends=()),))
    lines = joint_tables(in_lugs(small, smooth))[1]
    assert [row[-2:] for row in lines.cells()] == [[None, None], [None, None]]


def around(results: Results, **changes: object) -> Results:
    """The first pin prescribed, with a range by a beam on foundations in assumed lugs."""
    over = JointRange(
        (1100.0, 1900.0), (Variation("tilt", "free", 1500.0, None, (1200.0, 1800.0)),),
        "foundation", True,
    )  # fmt: skip
    joint = JointResult("prescribed", range=over)
    return in_lugs(results, replace(joint, **changes))  # type: ignore[arg-type]


def shown_joints(results: Results) -> list[str]:
    """The texts of the column of ranges over the joint, if it is shown."""
    grid = shown_factors(results).grid(results.units)
    at = [k for k, heading in enumerate(grid.head) if heading == "joint [psi]"]
    return [row[k] for row in grid.body for k in at]


def test_a_range_in_assumed_lugs_is_marked(small: Results, tmp_path: Path) -> None:
    odd = around(small)
    found = joint_json(odd.pins[0].joint)
    assert found is not None
    assert (found["model"], found["bands"]) == ("prescribed", [])
    assert (found["range"]["model"], found["range"]["lugs"]) == ("foundation", "assumed")
    assert found["range"]["over"][0]["max_von_mises_interval"] == [1200.0, 1800.0]
    first = odd.pins[0]
    assert "1,100 to 1,900" in shown_joints(odd)
    row = safety_factors_table(odd).records()[0]
    assert (row["pin"], row["case"]) == (first.pin, first.case)
    assert (row["joint_model"], row["joint_lugs"]) == ("foundation", "assumed")
    last = next(joint_tables(odd)[2].cells())[-5:]
    assert list(last) == ["foundation", "assumed", 1200.0, 1800.0, None]
    assert not any(name.startswith("joint") for name in all_plots(odd))


def test_the_page_shows_a_range_in_assumed_lugs(small: Results, tmp_path: Path) -> None:
    path = write_reports(around(small), tmp_path)
    text = parse(path).text
    assert "1,100 to 1,900 psi over what is not known of the joint" in text
    assert "in assumed lugs" in text
    assert "1,200 to 1,800" in text
    assert "Contact with the lugs" not in text
    assert "half contact angle" not in text
    assert "<dt>Held by</dt>" not in path.read_text(encoding="utf-8")


def test_the_page_says_why_there_is_no_range(small: Results, tmp_path: Path) -> None:
    odd = around(small, range=None, remark="no lug surrounds its clamp (start)")
    text = parse(write_reports(odd, tmp_path)).text
    assert "no range over the joint: no lug surrounds its clamp (start)." in text


def test_foundations_have_the_section_of_contact(small: Results, tmp_path: Path) -> None:
    text = parse(write_reports(in_lugs(small, replace(CONTACT, model="foundation")), tmp_path)).text
    assert "Load from the lugs" in text
    assert "beam on foundations" in text
    assert "half contact angle" in text


def test_published_maxima_are_apart_and_fit(results: Results) -> None:
    theirs = replace(results.pins[0], published_max_von_mises=2000.0)
    odd = around(replace(results, pins=(theirs, *results.pins[1:])))
    for width in (80, 200):
        out = StringIO()
        print_safety_factors(odd, Console(file=out, width=width, no_color=True))
        first, _, last = out.getvalue().partition("Published values")
        assert max(len(line) for line in out.getvalue().splitlines()) <= width
        assert "published" not in first
        assert "ours / published" in last


def test_a_column_only_where_a_range_was_found(small: Results, tmp_path: Path) -> None:
    assert sorted(shown_joints(small)) == ["1,100 to 1,900", "–"]
    bare = in_lugs(small, make_joint(over=False))
    assert shown_joints(bare) == []
    for some, has in ((small, True), (bare, False)):
        write_safety_factors(some, tmp_path)
        text = (tmp_path / "safety_factors.md").read_text(encoding="utf-8")
        assert ("joint [psi] |" in text) is has
        assert (JOINT_RANGE_NOTE in text) is has


@pytest.mark.parametrize("over", [True, False])
def test_the_terminal_shows_the_range(small: Results, over: bool) -> None:
    out = StringIO()
    shown = in_lugs(small, make_joint(over))
    print_safety_factors(shown, Console(file=out, width=80, no_color=True))
    text = out.getvalue()
    assert max(len(line) for line in text.splitlines()) <= 80
    assert ("open range" in text) is over


@pytest.mark.parametrize(("verdict", "factor", "changes"), [
    ("converged", 1.6, True), ("converged", 3.2, False), ("singular", 1.6, False),
])  # fmt: skip
def test_a_result_that_the_joint_changes_is_named(
    small: Results, verdict: str, factor: float, changes: bool
) -> None:
    odd = in_lugs(
        small, CONTACT, verdict=verdict, max_von_mises=1500.0, safety_factor=factor,
        error_estimate=1.0, decided=True if verdict == "converged" else None,
    )  # fmt: skip
    first = odd.pins[0]
    first = replace(first, depends_on=depends_on(first))
    assert (first.outcome == "depends") is changes
    text = summary(replace(odd, pins=(first, *odd.pins[1:])))
    assert ("depends: A (joint)" in text) is changes


def test_without_a_required_factor_yield_is_the_limit(small: Results) -> None:
    odd = in_lugs(
        replace(small, required_safety_factor=None), CONTACT, max_von_mises=1500.0,
        error_estimate=1.0, safety_factor=1.1, decided=True, required=None,
    )  # fmt: skip
    (over,) = depends_on(odd.pins[0])
    assert (over.what, over.value) == ("tilt", "guided")


def test_words_of_a_row(small: Results) -> None:
    ranges = [pin.joint.range if pin.joint else None for pin in small.pins]
    assert [variation_range(over) for over in ranges] == ["1,100 to 1,900", "–"]
    assert part_words(small.pins[0]) == "mesh, cells of contact"


def test_the_page_has_a_section(small: Results, written: Path) -> None:
    text = parse(written).text
    assert text.count("Contact with the lugs") == 1
    said = "Errors of mesh, cells of contact; the maximum is 1,100 to 1,900 psi over what is not"
    assert said in text
    assert "0.003 in (twice the given)" in text
    assert "half contact angle [°]" in text
    page = written.read_text(encoding="utf-8")
    assert f'aria-label="Pin A, {small.pins[0].case}: load per length from the lugs' in page
    assert "<dt>Supported by</dt>" in page
    assert "<dt>Clamped</dt>" in page  # of the other row


def test_the_page_without_a_range(small: Results, tmp_path: Path) -> None:
    text = parse(write_reports(in_lugs(small, make_joint(over=False)), tmp_path)).text
    assert "Errors of mesh, cells of contact." in text
    assert "what is not known" not in text


def test_names_of_lugs_are_shown_and_not_run(small: Results, tmp_path: Path) -> None:
    odd = replace(CONTACT, bands=(replace(CONTACT.bands[0], name=EVIL), *CONTACT.bands[1:]))
    page = parse(write_reports(in_lugs(small, odd), tmp_path))
    assert EVIL in page.text


def test_a_plot_for_every_pin_in_contact(small: Results) -> None:
    plots = all_plots(small)
    (name,) = (name for name in plots if name.startswith("joint"))
    assert name == f"joint.{small.pins[0].case}.A"
    load, _ = plots[name].spec["vconcat"]
    areas = [part for part in load["layer"] if part.get("mark", {}).get("type") == "area"]
    drawn = [part["data"]["values"] for part in areas]
    assert [row["x"] for row in drawn[0]] == pytest.approx(CONTACT.bands[0].ends)
    assert [row["y"] for row in drawn[0]][:-1] == [q for _, q in CONTACT.bands[0].line_load]
    assert plots[name].spec["data"]["values"] == [
        {"x": z, "y": m} for z, m in CONTACT.bending_moments
    ]


def test_plots_of_odd_contacts(small: Results, tmp_path: Path) -> None:
    """No load, a curve in place of rings, and no moment."""
    nothing = replace(
        CONTACT,
        bands=tuple(
            replace(b, ends=(), line_load=tuple((z, 0.0) for z, _ in b.line_load))
            for b in CONTACT.bands
        ),
        bending_moment=0.0,
        bending_moments=((0.0, 0.0), (4.5, 0.0)),
    )
    svg, png = draw([joint_plot("$a/b", "x" * 60, nothing, small.units)], tmp_path)
    assert ElementTree.parse(svg).getroot().tag.endswith("svg")
    assert png.read_bytes().startswith(b"\x89PNG")


def test_the_pressure_is_a_field_of_the_surface(solid: Field, small: Results) -> None:
    pressed = replace(solid, contact_pressure=np.arange(10.0))
    assert "cell mean pressure [psi]" not in point_data(solid, small.units)
    assert point_data(pressed, small.units)["cell mean pressure [psi]"].tolist() == list(range(10))
    outside = surface(pressed)
    assert outside.contact_pressure is not None
    assert len(outside.contact_pressure) == len(outside.points)


@pytest.mark.parametrize("pressed", [True, False])
def test_the_view_has_the_pressure_of_the_cells(small: Results, pressed: bool) -> None:
    cells = np.array([[1.0, 2.0, 3.0], [0.0, 7.5, 0.0]])
    rings = np.array([-1, 0, 1])
    shown = surface_in(small.pins[0].case, (rings, cells) if pressed else (None, None))
    (view,) = pin_views(replace(small, surfaces=(shown,)), "A")
    found = json.loads(str(view.data))["cases"][0]["pressure"]
    assert view.pressed is pressed
    if not pressed:
        assert found is None
        return
    assert found["sectors"] == 3
    assert 3.0 < found["top"] < 7.5  # cells at edges are in its last colour
    assert unpacked(found["rings"]).tolist() == rings.tolist()
    assert unpacked(found["cells"]).tolist() == cells.ravel().tolist()

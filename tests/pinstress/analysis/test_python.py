"""Pinstress as it is used from Python: what help, repr and notebooks show, and pictures of rows."""

from __future__ import annotations

import inspect
import pydoc
import re
import sys
import textwrap
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import pinstress
from pinstress.analysis.results import RunResults
from reports.data.results import Results
from tests.conftest import ROOT
from tests.support.programs.command_line import QUICK

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def results() -> RunResults:
    return pinstress.run(pinstress.study_from(QUICK))


def test_help_lists_every_public_name_with_its_signature() -> None:
    assert set(pinstress.__all__) <= set(dir(pinstress))
    shown = pydoc.plain(pydoc.render_doc(pinstress))
    summary = inspect.getdoc(pinstress) or ""
    for name in pinstress.__all__:
        assert name in summary
        assert re.search(rf"^ +(class )?{name}\(", shown, re.MULTILINE), name
    for name, first in re.findall(r"^    (\w+)\((\w+)", summary, re.MULTILINE):
        parameters = list(inspect.signature(getattr(pinstress, name)).parameters)
        assert first == parameters[0], name


def test_the_example_of_the_module_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    example = (inspect.getdoc(pinstress) or "").split("\n\n")[1]
    monkeypatch.chdir(tmp_path)
    Path("studies").symlink_to(ROOT / "studies")
    names: dict[str, object] = {}
    exec(textwrap.dedent(example), names)
    said = re.search(r"# (<B landing.*>)", example)
    assert said is not None
    pattern = re.escape(said[1]).replace(r"\.\.", ".*")
    assert re.fullmatch(pattern, repr(names["row"])), repr(names["row"])
    assert ElementTree.parse("B.svg").getroot().tag == f"{SVG}svg"


def test_rows_are_one_line_with_their_units(results: RunResults) -> None:
    row = results["B", "landing"]
    assert row.max_von_mises is not None
    assert row.location is not None
    text = repr(row)
    assert text == repr(results.pins[0])
    assert text.startswith("<B landing: safe, factor ")
    assert f"{float(f'{row.max_von_mises:.4g}'):,.0f} psi at" in text
    assert f"z = {float(f'{row.location[2]:.4g}'):g} in>" in text
    singular = replace(row, maximum=replace(row.maximum, interval=(1.0, 2.0)))
    assert "±" not in repr(singular)
    missing = replace(row.maximum, max_von_mises=None, location=None, verdict="rigid")
    assert repr(replace(row, maximum=missing)).endswith(", rigid>")


def test_results_and_study_are_one_line(results: RunResults) -> None:
    study = pinstress.study_from(QUICK)
    assert repr(study) == "<Study 'One pin' (study): pins: 1, cases: 1, in-lbf-s>"
    assert "<td>B</td>" in study._repr_html_()
    assert repr(results).startswith("<One pin: pins: 1, rows: 1. Pin B is safe: factor")
    assert len(repr(results).splitlines()) == 1
    assert repr(pinstress.prepare(study)) == f"<Plan of {study!r}: pins: 1, cases: 1>"


def test_names_in_the_html_of_a_study_and_a_row_are_texts() -> None:
    evil = QUICK.replace('title = "One pin"', 'title = "<script>"')
    study = pinstress.study_from(evil)
    assert "<script>" not in study._repr_html_()
    row = pinstress.run(study)["B", "landing"]
    assert "<script>" not in row._repr_html_()
    assert "<svg" in row._repr_html_()


def test_a_missing_row_names_what_there_is(results: RunResults) -> None:
    for row, message in {
        ("Q", "landing"): "no pin 'Q'; the pins are B",
        ("B", "take-off"): "pin B has no case 'take-off'; its cases are landing",
        "B": "results['B']: give a pin and a case; the pins are B",
    }.items():
        with pytest.raises(KeyError) as raised:
            results[row]  # type: ignore[index]
        assert str(raised.value) == message


def test_a_row_equals_that_of_the_table(results: RunResults) -> None:
    row, same = results["B", "landing"], results.pins[0]
    assert ("B", "landing") in results
    assert ("B", "pull") not in results
    assert "B" not in results
    assert row in results
    assert row == same
    assert same == row
    assert row == Results.__getitem__(results, ("B", "landing"))
    assert row != replace(same, held="otherwise")
    assert row != "B"


def test_the_plot_has_the_stress_of_its_row_along_the_pin(results: RunResults) -> None:
    """From beside the edge of the clamp, where it is not read, to the free end of the pin; its
    largest stress is where the row has it.
    """
    root = ElementTree.fromstring(results["B", "landing"].plot().svg)
    walls = [r for r in root.findall(f"{SVG}rect") if r.attrib.get("stroke") == "#222222"]
    left = min(float(wall.attrib["x"]) for wall in walls)
    right = max(float(wall.attrib["x"]) + float(wall.attrib["width"]) for wall in walls)
    curves = [c.attrib["points"] for c in root.findall(f"{SVG}polyline[@class='surface']")]
    points = [tuple(map(float, p.split(","))) for curve in curves for p in curve.split()]
    assert left < min(x for x, _ in points) < left + 0.15 * (right - left)
    assert max(x for x, _ in points) == pytest.approx(right, abs=0.06)
    row = results["B", "landing"]
    assert row.location is not None
    top = min(points, key=lambda point: point[1])
    assert (top[0] - left) / (right - left) == pytest.approx(row.location[2] / 3.5, abs=0.02)


@pytest.mark.slow
def test_the_mesh_of_a_row_has_its_maximum(results: RunResults) -> None:
    row = results["B", "landing"]
    mesh = row.to_pyvista()
    largest = float(np.max(mesh.point_data["von Mises [psi]"]))
    assert largest == pytest.approx(row.max_von_mises, rel=0.1)


def test_a_frame_has_a_line_per_row_or_says_what_to_install(
    results: RunResults, monkeypatch: pytest.MonkeyPatch
) -> None:
    frame = results.frame()
    assert list(frame["safety_factor"]) == [results.pins[0].safety_factor]
    assert list(results.frame("reactions")["case"]) == ["landing"]
    monkeypatch.setitem(sys.modules, "pandas", None)  # as if not installed
    with pytest.raises(ImportError, match=r"pinstress\[fatigue\]"):
        results.frame()

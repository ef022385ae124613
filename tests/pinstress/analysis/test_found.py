"""Results as Python and a notebook see them, and the tutorial, cell by cell."""

from __future__ import annotations

import json
import sys
from html.parser import HTMLParser
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import pinstress
from pinstress.analysis.results import RunResults
from reports.format.ranges import factor_range
from tests.conftest import ROOT
from tests.support.results.rows import with_values


@pytest.fixture(scope="module")
def found() -> RunResults:
    return pinstress.run(pinstress.load_study(ROOT / "studies" / "one_pin.toml"), fields=True)


class Cells(HTMLParser):
    """Texts of a table's cells; fails where tags do not close each other."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.found: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] in ("td", "th"):
            self.found.append(data)


def test_a_notebook_shows_the_factor_with_its_verdict(found: RunResults) -> None:
    cells = Cells(found._repr_html_()).found
    assert "max von Mises [psi]" in cells
    factor = cells[len(cells) // 2 :]
    shown = factor_range(found.pins[0])
    assert {"B", "landing", shown, "converged"} <= set(factor)
    assert f"factor {shown} ≥ 10 required" in repr(found)


def test_all_rows_one_by_one(found: RunResults) -> None:
    assert len(found) == len(found.pins) > 0
    assert list(found) == [found[row.pin, row.case] for row in found.pins]


def test_names_in_html_are_texts(found: RunResults) -> None:
    from dataclasses import replace

    odd = replace(found, title="<b>", pins=(with_values(found.pins[0], pin="<i>"),))
    text = odd._repr_html_()
    assert "<i>" not in text
    assert "<i>" in Cells(text).found


def test_frames_get_every_row(found: RunResults, monkeypatch: pytest.MonkeyPatch) -> None:
    """The library is whatever is installed; what it is given is the table."""

    def frame(rows: list[list[Any]], **how: Any) -> tuple[list[list[Any]], dict[str, Any]]:
        return rows, how

    for name in ("pandas", "polars"):
        module = ModuleType(name)
        module.DataFrame = frame  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, name, module)
        rows, how = getattr(found, f"to_{name}")("reactions")
        columns = how.get("columns") or how["schema"]
        assert columns[:4] == ["case", "time", "connection", "body"]
        assert [list(row) for row in rows] == [
            ["landing", None, "B", "", 0.0, pytest.approx(-988.86), 0.0, 0.0, 0.0, 0.0]
        ]
        assert how.get("orient", "row") == "row"


@pytest.mark.parametrize("name", ["pandas", "polars"])
def test_without_the_library_it_says_so(
    found: RunResults, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, name, None)  # as if not installed
    with pytest.raises(ImportError, match=f"pip install {name}"):
        getattr(found, f"to_{name}")()


def test_a_table_that_is_not_there(found: RunResults) -> None:
    with pytest.raises(ValueError, match="no table 'motion'; there are safety_factors"):
        found.to_pandas("motion")


@pytest.mark.slow
def test_mesh_and_picture(found: RunResults) -> None:
    mesh = found.to_pyvista("B", "landing")
    largest = float(np.max(mesh.point_data["von Mises [psi]"]))
    assert largest == pytest.approx(found.pins[0].max_von_mises, rel=2e-3)  # of 60 meridians
    assert found.picture("B", "landing")._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
    with pytest.raises(ValueError, match="there are B in landing"):
        found.to_pyvista("B", "taxi")


def test_a_field_that_was_not_kept_is_solved_for(found: RunResults) -> None:
    from dataclasses import replace

    without = replace(found, fields={})
    mesh, kept = without.to_pyvista("B", "landing"), found.to_pyvista("B", "landing")
    assert np.array_equal(mesh.point_data["von Mises [psi]"], kept.point_data["von Mises [psi]"])
    assert list(without.fields) == [("B", "landing")]
    with pytest.raises(ValueError, match="there are none"):
        replace(found, fields={}, plan=None).to_pyvista("B", "landing")


@pytest.mark.slow
def test_the_tutorial_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its cells in their order, and what its text says of the fillets."""
    book = json.loads((ROOT / "docs" / "notebook.ipynb").read_text(encoding="utf-8"))
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for cell in book["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            exec("".join(cell["source"]), names)
    verdicts = {fillet: pin.verdict for fillet, pin in names["found"].items()}
    assert verdicts == {0.4: "converged", 0.2: "converged", 0.1: "converged", 0.0: "singular"}
    factors = [names["found"][fillet].safety_factor for fillet in (0.4, 0.2, 0.1)]
    assert factors == sorted(factors, reverse=True)
    assert "0.0 in:" in capsys.readouterr().out

"""The page of a sweep's designs: what it holds, for whatever a table has in it."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from pinstress.explore.sweep.design_columns import designs_of
from pinstress.explore.sweep.page import (
    column_grid,
    page_data,
    reason_grid,
    render_designs,
    summary,
)
from reports.format.packed import packed
from tests.support.each import each
from tests.support.programs.packed import unpacked
from tests.support.results.html_page import EVIL, parse
from tests.support.results.made_up_designs import FAILING, made_up_designs, table_of

TWO = (("B", "landing"), ("E", "retract"))
SOLVED = {
    "pin": "B",
    "case": "landing",
    "max_von_mises": 100.0,
    "error_estimate": 1.0,
    "safety_factor": 2.0,
    "verdict": "converged",
    "governing_time": None,
    "mass": None,
    "reason": "",
    "code": "",
}
LACKING: dict[str, Any] = {
    **dict.fromkeys(SOLVED),
    "verdict": "failed",
    "reason": FAILING[0],
    "code": FAILING[1],
}
LAW = {"a": {"unit": "mm", "law": "from 1 to 3"}}


def some(*rows: dict[str, Any], values: tuple[Any, ...] | None = None) -> pa.Table:
    """A table of one design for each row, with one parameter, the design's number by default."""
    found = values or tuple(float(k + 1) for k in range(len(rows)))
    numbered = [{"design": k + 1, "a": found[k], **row} for k, row in enumerate(rows)]
    return table_of(numbered, ["a"], LAW)


def column(data: dict[str, Any], key: str) -> dict[str, Any]:
    (found,) = (c for c in data["columns"] if c["key"] == key)
    return dict(found)


def write(table: pa.Table, folder: Path) -> Path:
    path = folder / "designs.html"
    path.write_text(render_designs(designs_of(table)), encoding="utf-8")
    return path


def data_of(path: Path) -> dict[str, Any]:
    """The data as the page's scripts read it."""
    text = path.read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    assert found
    return dict(json.loads(found[1]))


def test_doubles_are_packed_to_the_last_bit() -> None:
    values = np.random.default_rng(2).lognormal(0.0, 40.0, 999)
    values[:4] = np.nan, np.inf, 5e-324, -0.0
    assert np.array_equal(unpacked(packed(values, "<f8")), values, equal_nan=True)


def test_the_page_has_every_number_of_the_table(tmp_path: Path) -> None:
    table = made_up_designs(200, 3, TWO)
    data = data_of(write(table, tmp_path))
    number = table.column("design").to_numpy()
    assert unpacked(data["numbers"]).tolist() == list(range(1, 201))
    assert unpacked(data["first"]).tolist() == list(range(0, 401, 2))
    for key in ("pin.B.profile[2].diameter", "max_von_mises", "mass", "governing_time"):
        found, wanted = column(data, key), table.column(key).to_numpy()
        wanted = wanted[:: len(TWO)] if found["of"] == "design" else wanted
        assert np.array_equal(unpacked(found["values"]), wanted, equal_nan=True)
        assert found["unit"] == table.schema.field(key).metadata[b"unit"].decode()
    verdict = data["texts"]["verdict"]
    told = [verdict["names"][int(k) - 1] for k in unpacked(verdict["places"])]
    assert told == table.column("verdict").to_pylist()
    assert len(number) == len(told)


def test_rows_may_come_in_any_order() -> None:
    table = made_up_designs(50, 2, TWO)
    mixed = table.take(np.random.default_rng(3).permutation(table.num_rows))
    again = page_data(designs_of(mixed))
    assert column(again, "pin.B.profile[1].diameter") == column(
        page_data(designs_of(table)), "pin.B.profile[1].diameter"
    )
    one = designs_of(mixed)
    assert one.numbers.tolist() == list(range(1, 51))
    assert np.diff(one.first).tolist() == [2] * 50


def test_a_design_failed_if_a_row_has_a_reason_and_no_maximum() -> None:
    """A row that is not converged has a reason, too."""
    singular = {**SOLVED, "verdict": "singular", "reason": "a sharp corner", "code": "singular"}
    designs = designs_of(some(SOLVED, LACKING, singular))
    assert designs.failed.tolist() == [False, True, False]
    assert reason_grid(designs).body == [["1", FAILING[0]]]
    assert summary(designs) == (
        "3 designs; 2 with results and 1 without; 1 varied parameter; required safety factor 1.5."
    )


def test_reasons_are_counted_by_code() -> None:
    other = {**LACKING, "reason": "gmsh failed at 3", "code": "mesh"}
    same = {**LACKING, "reason": "gmsh failed at 4", "code": "mesh"}
    bare = {**LACKING, "reason": "no code", "code": None}
    found = reason_grid(designs_of(some(LACKING, other, same, bare)))
    assert found.body == [["2", "gmsh failed at 3"], ["1", FAILING[0]], ["1", "no code"]]


@each(
    "table",
    [
        some(SOLVED),
        some(LACKING, LACKING),
        some(SOLVED, SOLVED, values=(2.0, 2.0)),
        some({**SOLVED, "safety_factor": None}, {**SOLVED, "safety_factor": float("inf")}),
        some(SOLVED, SOLVED, values=("steel", "titanium")),
        made_up_designs(30, 20, TWO, failing=1.0),
    ],
)
def test_any_table_makes_a_page(table: pa.Table, tmp_path: Path) -> None:
    page = parse(write(table, tmp_path))
    designs = designs_of(table)
    assert f"{len(designs.numbers)} design" in page.text
    apart = {"design", "pin", "case", "verdict", "outcome", "reason", "code"}
    drawn = [name for name in table.column_names if name not in apart]
    assert len(data_of(tmp_path / "designs.html")["columns"]) == len(drawn)
    assert page.addresses == []


def test_the_ranges_of_all_columns_are_a_table() -> None:
    body = {row[0]: row for row in column_grid(designs_of(some(SOLVED, LACKING, SOLVED))).body}
    assert body["a"] == ["a", "parameter", "mm", "1", "3", "from 1 to 3"]
    assert body["maximum von Mises"] == ["maximum von Mises", "result", "MPa", "100", "100", "–"]
    assert body["mass"][3:5] == ["–", "–"]


def test_names_run_nothing(tmp_path: Path) -> None:
    row = {**LACKING, "reason": EVIL, "code": EVIL, "pin": EVIL}
    law = {EVIL: {"unit": EVIL, "law": EVIL}}
    table = table_of([{"design": 1, EVIL: 1.0, **row}], [EVIL], law, study=EVIL)
    path = write(table, tmp_path)
    page = parse(path)
    assert page.tags.count("script") == 2
    assert f"Designs: {EVIL}" in page.text
    assert EVIL not in path.read_text(encoding="utf-8")
    assert data_of(path)["texts"]["reason"]["names"] == [EVIL]


def test_the_same_table_makes_the_same_page(tmp_path: Path) -> None:
    pages = [write(made_up_designs(20, 2), tmp_path).read_bytes() for _ in range(2)]
    assert pages[0] == pages[1]


def test_verdicts_are_explained(tmp_path: Path) -> None:
    text = parse(write(some({**SOLVED, "verdict": "singular"}), tmp_path)).text
    assert "grows without bound" in text
    assert "not in equilibrium" not in text


def test_what_is_no_table_of_a_sweep_is_refused() -> None:
    with pytest.raises(ValueError, match="not that of a sweep"):
        designs_of(pa.table({"design": [1]}))
    twice = [{"design": 1, "a": a, **SOLVED} for a in (1.0, 2.0)]
    with pytest.raises(ValueError, match="two values of a"):
        designs_of(table_of(twice, ["a"], LAW))

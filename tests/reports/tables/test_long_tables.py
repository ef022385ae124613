"""Tables of many rows: Parquet beyond a limit, with the same cells as CSV."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from pyarrow import parquet

from pinstress.analysis.mechanics import gather_space
from pinstress.cli.commands import run_command_line
from reports.data.mechanics import ReactionTable
from reports.format.files import parquet as ours
from reports.format.files.csv import Cell, write_csv
from reports.format.files.parquet import write_parquet
from reports.tables import column as tables
from reports.tables.column import ArrayTable, Table
from reports.tables.loads.motion import REACTION_COLUMNS
from tests.conftest import ROOT


@pytest.fixture
def reactions() -> Table[ReactionTable]:
    """Two cases, one of them without time."""
    rng = np.random.default_rng(3)

    def table(case: str, times: np.ndarray | None, count: int) -> ReactionTable:
        forces, moments = rng.standard_normal((2, count, 2, 3))
        return ReactionTable(
            case, times, None, ("B", "C"), ("link", "arm"), ("P", "Q"), forces, moments, (), {}, ""
        )

    rows = [table("turn", np.linspace(0.0, 1.0, 7), 7), table("rest", None, 1)]
    return ArrayTable("reactions", REACTION_COLUMNS, rows)


def test_lines_and_columns_have_the_same_cells(reactions: Table[ReactionTable]) -> None:
    lines = [*reactions.cells()]
    assert len(lines) == len(reactions) == 16
    columns = [reactions.values(column) for column in reactions.columns]
    assert lines == [*zip(*columns, strict=True)]
    assert lines[3][:4] == ("turn", pytest.approx(1 / 6), "C", "arm")
    assert lines[14][:4] == ("rest", None, "B", "link")


def test_a_long_table_is_parquet_with_the_cells_of_the_csv(
    reactions: Table[ReactionTable], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert reactions.write(tmp_path).name == "reactions.csv"
    monkeypatch.setattr(tables, "MAX_CSV_ROWS", 15)
    monkeypatch.setattr(ours, "ROWS_PER_GROUP", 5)
    path = reactions.write(tmp_path)
    assert path.name == "reactions.parquet"
    found = parquet.read_table(path)
    assert parquet.ParquetFile(path).num_row_groups == 4
    assert found.column_names == reactions.keys
    read = csv.DictReader((tmp_path / "reactions.csv").read_text().splitlines())
    for row, plain in zip(found.to_pylist(), read, strict=True):
        assert (row["case"], row["connection"]) == (plain["case"], plain["connection"])
        assert row["fx"] == float(plain["fx"])
        assert row["time"] == (float(plain["time"]) if plain["time"] else None)


def test_a_case_that_is_too_long_for_the_table_of_bodies_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Four bodies at 121 instants of the retraction, and at one of each landing."""
    monkeypatch.setattr(gather_space, "MAX_BODY_LINES", 4 * 121 - 1)
    study, out = ROOT / "studies" / "side_stay.toml", tmp_path / "out"
    command = ["loads", str(study), "--out", str(out)]
    assert run_command_line(command) == 0
    written = [*csv.DictReader((out / "bodies.csv").read_text().splitlines())]
    assert "landing" in (cases := {row["case"] for row in written})
    assert "retract" not in cases
    told = "bodies.csv does not have this case: 484 lines, above 483; ask for fewer samples."
    printed = " ".join(capsys.readouterr().out.split())
    assert printed.count(told) == 1
    assert "In space" in printed[: printed.index(told)].rpartition("retract: ")[2]
    assert told in (out / "report.html").read_text(encoding="utf-8")

    monkeypatch.setattr(gather_space, "MAX_BODY_LINES", 4 * 121)
    assert run_command_line(command) == 0
    assert (out / "bodies.csv").read_text().count("retract") == 4 * 121
    assert "bodies.csv does not" not in capsys.readouterr().out


def test_cells_that_are_no_numbers(tmp_path: Path) -> None:
    rows: list[list[Cell]] = [["a", 1.5, None, True], ["=b", float("nan"), None, False]]
    write_csv(tmp_path / "t.csv", ("n", "x", "y", "ok"), rows)
    assert (tmp_path / "t.csv").read_text() == "n,x,y,ok\na,1.5,,yes\n'=b,,,no\n"
    write_parquet(tmp_path / "t.parquet", ("n", "x", "y", "ok"), [[*zip(*rows, strict=True)]])
    assert parquet.read_table(tmp_path / "t.parquet").to_pylist() == [
        {"n": "a", "x": 1.5, "y": None, "ok": True},
        {"n": "=b", "x": None, "y": None, "ok": False},
    ]

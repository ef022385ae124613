"""Texts of other programs: what is read, and what is refused with its line and column."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from loads import FileReading, JointAxes, Layout, Reactions, TableError, read_reactions
from loads.tables import open_table, text_grid
from loads.tables.grid import Source
from tests.support.each import each
from tests.support.errors import raises

UNITS = {"s": 1.0, "ms": 1e-3, "kN": 1e3, "N": 1.0, "N m": 1.0}
NAMES = {"time": "t", "B.fx": "Fx", "B.fy": "Fy"}
NUMBERS = {"time": 1, "B.fx": 2, "B.fy": 3}


@pytest.fixture(params=["at once", "by cells"], autouse=True)
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Tables of numbers alone are read at once where they are long: the results are the same."""
    least = 0 if request.param == "at once" else 1_000_000
    monkeypatch.setattr("loads.tables.text_grid.MIN_BLOCK_LINES", least)
    open_table._open.cache_clear()


def unit(written: str, dimension: str) -> float:
    """Tables are in N and s unless they say otherwise."""
    if written and written not in UNITS:
        raise TableError(f"unknown unit {written!r}", "unknown-unit")
    return UNITS.get(written, 1.0)


def read(
    tmp_path: Path, content: str | bytes, columns: dict[str, Any] | None = None, **more: Any
) -> Reactions:
    path = tmp_path / "table.txt"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    columns = NAMES if columns is None else columns
    layout = {k: v for k, v in more.items() if k in ("units", "axes", "offset", "step")}
    reading = FileReading(**{k: v for k, v in more.items() if k not in layout})
    return read_reactions(
        path, Layout("case", columns, reading=reading, **layout), unit, {"B", "C"}
    )


@each(
    ("content", "columns"),
    [
        ("t,Fx,Fy\n0,1,2\n0.5,3,-4.5\n", NAMES),
        ("t,Fx,Fy,\n0,1,2,\n0.5,3,-4.5,\n", NAMES),  # every line ends with a separator
        ("t;Fx;Fy\ns;N;N\n0;1;2\n0,5;3;-4,5\n", NAMES),
        ("t\tFx\tFy\n[ms]\t[kN]\t(N)\n0\t0.001\t2\n500\t0.003\t-4.5\n", NAMES),
        ("t Fx   Fy\n 0 1 2\n  0.5 3.0D+00   -4.5d0\n", NAMES),
        ("t (s)  Fx (kN) Fy [N]\n0 0.001 2\n0.5 0.003 -4.5\n",
         {"time": "t (s)", "B.fx": "Fx (kN)", "B.fy": "Fy [N]"}),
        ('"the time" "Fx of E" Fy\n0 1 2\n0.5 3 -4.5\n',
         {"time": "the time", "B.fx": "Fx of E", "B.fy": "Fy"}),
        ("the time  Fx of E   Fy\n0 1 2\n0.5 3 -4.5\n",
         {"time": "the time", "B.fx": "Fx of E", "B.fy": "Fy"}),
        ("% a\n// b\n! c\n# t Fx Fy\n0 1 2\n\n# later\n0.5 3 -4.5\n", NAMES),
        ("# t, Fx, Fy\n0, 1, 2\n0.5, 3, -4.5\n", NAMES),
        ("# b\n0 1 2\n0.5 3 -4.5\n", NUMBERS),
        ("0,0 1,0 2,0\n0,5 3,0 -4,5\n", NUMBERS),  # no comma separates: they are decimal
        ("t of E Fx Fy\ns N N\n0 1 2\n0.5 3 -4.5\n", NUMBERS),
        ("t;Fx;Fy;name\n0;1;2;start\n0.5;3;-4.5;\n", NAMES),  # an empty cell that nobody reads
        ("t,Fx,Fy\r\n0,1,2\r\n0.5,3,-4.5\r\n", NAMES),
        ("t,Fx,Fy\n0,1,2\n0.5,3,-4.5\n".encode("utf-8-sig"), NAMES),
        ("t\tFx\tFy\n0\t1\t2\n0.5\t3\t-4.5\n".encode("utf-16"), NAMES),
        (b"\xfe\xff" + "t\tFx\tFy\n0\t1\t2\n0.5\t3\t-4.5\n".encode("utf-16-be"), NAMES),
        ("0.5,3,-4.5\n0,1,2\n", NUMBERS),  # in any order
    ],
)  # fmt: skip
def test_the_same_forces_however_they_are_written(
    tmp_path: Path, content: str | bytes, columns: dict[str, Any]
) -> None:
    found = read(tmp_path, content, columns)
    assert found.times is not None
    assert found.times.tolist() == [0.0, 0.5]
    assert found.force("B").tolist() == [[1.0, 2.0, 0.0], [3.0, -4.5, 0.0]]


@each(
    ("content", "more", "force"),
    [
        # Zeros before the comma, one or two digits after it: no thousands.
        ("t;Fx;Fy\n0;1,234;0,5\n", {}, 1.234),
        ("t;Fx;Fy\n0;1,234;2\n", {"decimal": ","}, 1.234),
        ("t;Fx;Fy\n0;1,234;2\n", {"decimal": "."}, 1234.0),
        ("t;Fx;Fy\n0;1.234,5;2\n", {"decimal": ","}, 1234.5),
        ("t;Fx;Fy\n0;1,234.5;2\n", {"decimal": "."}, 1234.5),
        ('t,Fx,Fy\n0,"1,5",2\n', {"decimal": ","}, 1.5),
        ("t;Fx;Fy\n0;1.234;2\n", {}, 1.234),
        ("t;Fx;Fy\n0;1.234;2\n", {"decimal": ","}, 1234.0),
        ("t Fx Fy\nnot a comment\n0 1 2\n", {"header_line": 1}, None),
        ("Run 12, of 3\nt;Fx;Fy\n0;7;2\n", {"header_line": 2}, 7.0),
        ("t;Fx, N;Fy\n0;7;2\n", {"separator": ";"}, None),
        ("µ;t;Fx;Fy\n1;0;7;2\n".encode("cp1252"), {"encoding": "cp1252"}, 7.0),
        ("t;Fx;Fy\n0;7;2\n".encode("utf-16-le"), {"encoding": "utf-16-le"}, 7.0),
    ],
)
def test_what_the_study_states(
    tmp_path: Path, content: str | bytes, more: dict[str, Any], force: float | None
) -> None:
    if force is None:
        with pytest.raises(TableError):
            read(tmp_path, content, **more)
    else:
        assert read(tmp_path, content, **more).force("B")[0, 0] == force


@each(
    ("content", "code", "named"),
    [
        # Ambiguous: what to state.
        ("t;Fx;Fy\n0;1,234;2\n", "ambiguous-decimal", "line 2: Fx = 1,234 may be 1234 or 1.234"),
        ("t;Fx;Fy\n0;1,234;2.5\n", "ambiguous-decimal", 'decimal = "."'),
        ("t;Fx;Fy\n0;1,234;0,5\n1;2.5;1\n", "ambiguous-decimal", "line 2: Fx"),
        ("t;Fx;Fy\n0;0,5;2\n1;1.234;2\n", "ambiguous-decimal", "line 3: Fx = 1.234"),
        ("t;Fx;Fy\n0;1,234,567;2\n", "ambiguous-decimal", "line 2: Fx"),
        ("t;Fx;Fy\n0;1.234,5;2\n", "ambiguous-decimal", "line 2: Fx"),
        # Cells that are no numbers.
        ("t;Fx;Fy\n0;;2\n", "not-a-number", "line 2: Fx = '' is not a number; the cell is empty"),
        ("# a\n\nt;Fx;Fy\n0;1;2\n1;2;x\n", "not-a-number", "line 5: Fy = 'x'"),
        ("t Fx Fy\n0 1 2\n1 nan 2\n", "not-finite", "line 3: Fx = nan"),
        ("t Fx Fy\n0 1 2\n1 2 -inf\n", "not-finite", "line 3: Fy = -inf"),
        ("t Fx Fy\n0 1 2\n1 1e400 2\n", "not-finite", "line 3: Fx"),
        ("t Fx Fy\n0 1_0 2\n", "not-a-number", "line 2: Fx = '1_0'"),
        ("t Fx Fy\n0 \u0661 2\n", "not-a-number", "line 2: Fx"),
        ("t;Fx;Fy\n0;1;2\n;1;2\n", "missing-row", "line 3: connection B has no time here"),
        # Tables of no use.
        ("", "no-rows", "table.txt"),
        ("t Fx Fy\n", "no-rows", "table.txt"),
        ("t Fx Fy\ns N N\n", "not-a-number", "line 2: t = 's'"),
        ("t;Fx;Fy\n0;1;2\n1;2\n", "cell-count", "line 3: 2 cells, but the header has 3"),
        ("t Fx Fy\n0 1 2\n1 2 3 4\n", "cell-count", "line 3: 4 cells"),
        ("time of E Fx Fy\n0 1 2\n", "cell-count", "line 1: 5 words above rows of 3 cells"),
        ("t;Fx;Fx;Fy\n0;1;2;3\n", "duplicate-column", "occurs twice; give its number, 2 and 3"),
        ("t;Fx;FY\n0;1;2\n", "missing-column", "'Fy' for B.fy is missing; there are t, Fx, FY"),
        ("0 1 2\n1 2 3\n", "missing-column", "'t'"),
        ("t;Fx;Fy\nms;kN;furlong\n0;1;2\n", "unknown-unit", "line 2: Fy: unknown unit 'furlong'"),
        ("t;Fx [kN];Fy\nms;N;N\n0;1;2\n", "missing-column", "'Fx'"),
        ("t;Fx;Fy\n0;1;2\n" + "1" * 10_000_000, "not-csv", "line 3: has more than"),
        (bytes(range(256)) * 40, "not-text", "table.txt"),
        (b"\x00\x01\x02\x03" * 100, "not-text", "table.txt"),
        ("t;Fx;Fy\n0;7;2\n".encode("utf-16-le"), "not-text", 'encoding = "utf-16-le"'),
        ("µ;Fx;Fy\n".encode("cp1252"), "not-text", 'encoding = "cp1252"'),
        (b"\xd0\xcf\x11\xe0" + bytes(600), "not-text", ".xlsx"),
        (b"PK\x03\x04" + bytes(600), "not-a-workbook", "table.txt"),
        (b"PAR1" + bytes(600), "not-parquet", "table.txt"),
    ],
)
def test_what_is_refused(tmp_path: Path, content: str | bytes, code: str, named: str) -> None:
    with raises(TableError, code, named):
        read(tmp_path, content)


def test_which_tables_are_read_at_once() -> None:
    """Those with columns of numbers and of texts; not with a broken row or a doubtful comma."""
    source, reading = Source("t.csv"), FileReading()
    plain = ["t;Fx", "0;1", "1;2,5", ""]
    assert text_grid._of_numbers(source, plain, reading) is not None
    commented = text_grid._of_numbers(source, [*plain[:2], "# b", "", *plain[2:]], reading)
    assert commented is not None
    assert list(commented.places) == [2, 5]
    named = text_grid._of_numbers(source, ["t;Fx;n", "0;1;A", "1;2,5;B, C"], reading)
    assert named is not None
    assert named.columns[2] == ["A", "B, C"]
    for line in ("2;1.5", '"2";1', "2", "2;1;3", "2;nan"):
        assert text_grid._of_numbers(source, [*plain[:3], line, "3;1"], reading) is None
    assert text_grid._of_numbers(source, ["t;Fx", "0;1", "1;2,500"], reading) is None


def test_a_folder_is_refused(tmp_path: Path) -> None:
    with raises(TableError, "folder", "is a folder"):
        read_reactions(tmp_path, Layout("case", NAMES), unit, {"B"})


def test_one_row_needs_no_time(tmp_path: Path) -> None:
    found = read(tmp_path, "Fx Fy\n1 2\n", {"B.fx": "Fx", "B.fy": "Fy"})
    assert found.times is None
    assert found.forces.tolist() == [[[1.0, 2.0, 0.0]]]


def test_units_of_header_row_and_study_must_agree(tmp_path: Path) -> None:
    names = {"time": "t", "B.fx": "Fx [kN]", "B.fy": "Fy"}
    agreeing = "t;Fx [kN];Fy\nms;kN;N\n0;1;2\n"
    assert read(tmp_path, agreeing, names, units={"force": ""}).force("B")[0, 0] == 1000.0
    assert read(tmp_path, agreeing, names, units={"B.fx": "kN"}).force("B")[0, 0] == 1000.0
    with raises(TableError, "units-differ", "'Fx [kN]'"):
        read(tmp_path, agreeing, names, units={"B.fx": "N"})
    with raises(TableError, "units-differ", "row of units"):
        read(tmp_path, agreeing.replace(";kN;", ";N;"), names)
    other = "t;Fx [filtered];Fy\n0;1;2\n"
    names |= {"B.fx": "Fx [filtered]"}
    assert read(tmp_path, other, names, units={"B.fx": "kN"}).force("B")[0, 0] == 1000.0


def test_a_jump_has_both_its_limits(tmp_path: Path) -> None:
    """Two instants, distinct and next to each other; linear interpolation between is a jump."""
    found = read(tmp_path, "t Fx Fy\n0 1 0\n0.5 2 0\n0.5 -3 0\n2 -4 0\n", offset=1.0)
    assert found.times is not None
    assert found.times == pytest.approx([1.0, 1.5, 1.5, 3.0], rel=1e-15)
    assert (np.diff(found.times) > 0.0).all()
    force = found.force("B")[:, 0]
    assert force.tolist() == [1.0, 2.0, -3.0, -4.0]
    between = np.interp([1.5 - 1e-9, 1.5 + 1e-9], found.times, force)
    assert between == pytest.approx([2.0, -3.0], rel=1e-7)


def test_a_time_given_thrice_is_refused(tmp_path: Path) -> None:
    with raises(TableError, "duplicate-row", "line 4: connection B is given thrice"):
        read(tmp_path, "t Fx Fy\n0.5 1 0\n0.5 2 0\n0.5 3 0\n")
    with raises(TableError, "duplicate-row", "line 5: connection B is given thrice"):
        read(tmp_path, "t Fx Fy\n0 1 0\n0.5 2 0\n0.5 3 0\n0.5 4 0\n")


@each(
    "rows",
    [
        "0 1 0\n1 2 0\n0.5 3 0\n1.5 4 0\n",  # two runs: whose values are between whose?
        "1 1 0\n1.5 2 0\n1 3 0\n",
        "2 1 0\n1 2 0\n1 3 0\n0 4 0\n",  # which one is before the jump?
        "0.5 1 0\n0.5 2 0\n0 1 0\n",
        "0.5 1 0\n0 2 0\n0.5 3 0\n",
    ],
)
def test_times_that_go_back_are_refused(rows: str, tmp_path: Path) -> None:
    """Sorted, the values of several runs would be one between the other without a word."""
    with raises(TableError, "time-goes-back", "of connection B goes back from "):
        read(tmp_path, f"t Fx Fy\n{rows}")


def test_a_column_is_not_two_components(tmp_path: Path) -> None:
    """A slip of the pen, fx = 2, fy = 2, would turn the force by 45 degrees."""
    with raises(TableError, "duplicate-column", "column 2 is stated for fx and fy of B"):
        read(tmp_path, "t Fx Fy\n0 1 2\n", {"time": 1, "B.fx": 2, "B.fy": 2})
    both = {"time": 1, "B.fx": 2, "B.fy": 3, "C.fx": 2, "C.fy": 3}  # of two connections it may be
    assert read(tmp_path, "t Fx Fy\n0 1 2\n", both).force("C").tolist() == [[1.0, 2.0, 0.0]]


def test_row_numbers_without_a_header_are_named(tmp_path: Path) -> None:
    """As pandas writes them by default: the remedy is to state the columns."""
    table = ",time,B.fx,B.fy\n0,0,1,2\n1,1,3,4\n"
    with raises(
        TableError, "unknown-column", "column 1 has no header", "state those to read: columns = {"
    ):
        read(tmp_path, table, {})
    stated = {"time": "time", "B.fx": "B.fx", "B.fy": "B.fy"}
    assert read(tmp_path, table, stated).force("B")[:, 0].tolist() == [1.0, 3.0]


def test_a_table_may_begin_after_empty_columns(tmp_path: Path) -> None:
    found = read(tmp_path, ",,time,B.fx,B.fy\n,,0,1,2\n,,1,3,4\n", {})
    assert found.force("B").tolist() == [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]]


def test_a_jump_of_each_connection_in_a_long_table(tmp_path: Path) -> None:
    """The rows of one connection decide, however those of others lie between."""
    rows = "time,connection,fx,fy\n0,B,1,0\n0,C,2,0\n1,B,3,0\n1,C,4,0\n1,B,5,0\n1,C,6,0\n"
    found = read(tmp_path, rows, {})
    assert found.forces[:, :, 0].tolist() == [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]
    with raises(TableError, "missing-row", "connection C has no row at time 1"):
        read(tmp_path, rows.rpartition("1,C")[0], {})


def test_forces_and_moments_in_other_axes(tmp_path: Path) -> None:
    """A force F at P has the moment r x F about the middle of the band, besides its own about P;
    turned by 90 degrees about x, with the reaction on the link.
    """
    columns = {f"B.{c}": k for k, c in enumerate(("fx", "fy", "fz", "mx", "my", "mz"), 1)}
    turned = ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
    found = read(tmp_path, "1 2 3 4 5 6\n", columns, axes={"B": JointAxes(turned)})
    assert found.forces[0, 0].tolist() == [1.0, -3.0, 2.0]
    assert found.moments[0, 0].tolist() == [4.0, -6.0, 5.0]
    arm = JointAxes(arm=(0.0, 0.0, 0.5))
    found = read(tmp_path, "1 2 0 0 0 6\n", columns, axes={"": arm})
    assert found.moments[0, 0].tolist() == [-1.0, 0.5, 6.0]
    need_z = {"time": 1, "B.fx": 2, "B.fy": 3}
    with raises(TableError, "missing-column", "'B.fz'"):
        read(tmp_path, "0 1 2\n", need_z, axes={"B": JointAxes(turned)})


def test_a_file_that_is_replaced_and_keeps_its_time_is_read_again(tmp_path: Path) -> None:
    path, layout = tmp_path / "table.txt", Layout("case", NAMES, reading=FileReading())
    first = []
    for force in (1, 3):
        path.write_text(f"t Fx Fy\n0 {force} 2\n1 3 4\n", encoding="utf-8")
        os.utime(path, ns=(10**18, 10**18))
        first.append(read_reactions(path, layout, unit, {"B", "C"}).forces[0, 0, 0])
    assert first == [1.0, 3.0]

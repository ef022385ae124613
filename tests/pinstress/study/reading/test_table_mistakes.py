"""Tables that state their columns: what is taken, and what is refused with its key."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from loads import Reactions
from pinstress import InputError
from pinstress.study.model.cases import case_loads
from pinstress.study.reading.file import load_study
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import QUICK, run_here

TEXT = (ROOT / "studies" / "one_pin.toml").read_text()
ROWS = "t;Fx;Fy;Fz;Mx;My;Mz\n0;1;2;3;4;5;6\n1;7;8;9;10;11;12\n"
B = 'B = { fx = "Fx", fy = "Fy", unit = "N" }'
TIME = 'time = { column = "t", unit = "s" }'
ALL = 'fx = "Fx", fy = "Fy", fz = "Fz", mx = "Mx", my = "My", mz = "Mz", moment_unit = "N m"'


def reactions(folder: Path, table: str, rows: str = ROWS, case: str = "landing") -> Reactions:
    text = re.sub(r"forces = \{ B = .*", lambda _: table, TEXT)
    (folder / "a.csv").write_text(rows)
    (folder / "s.toml").write_text(text.replace("[case.landing]", f'[case."{case}"]'))
    study = load_study(folder / "s.toml")
    return case_loads(study, next(iter(study.table.case)), None).reactions


@each(
    ("table", "code", "named"),
    [
        (f"table = {{ {B} }}", "missing-key", "case.landing.table.file: is missing"),
        ("table = { file = 3 }", "not-a-text", "case.landing.table.file"),
        ("table = []", "list-too-short", "case.landing.table"),
        ('table = { file = "a.csv", unitt = "kN" }', "unknown-key", "did you mean 'unit'?"),
        ('table = { file = "a.csv", X = { fx = "Fx", fy = "Fy" } }', "unknown-connection",
         "no pin has a connection 'X'"),
        ('table = { file = "a.csv", B = { fx = "Fx", gy = "Fy" } }', "unknown-key",
         "case.landing.table.B: unknown key 'gy'"),
        ('table = { file = "a.csv", B = { fx = 1.5 } }', "not-a-whole-number",
         "case.landing.table.B.fx"),
        (f'table = {{ file = "a.csv", unit = "furlong", {B} }}', "unknown-unit",
         "case.landing.table.unit: unknown unit 'furlong'"),
        (f'table = {{ file = "a.csv", unit = "N m", {B} }}', "wrong-dimension",
         "case.landing.table.unit"),
        (f'table = {{ file = "a.csv", axes = ["x", "y"], {B} }}', "", "case.landing.table.axes"),
        (f'table = {{ file = "a.csv", axes = ["x", "y", "w"], {B} }}', "not-a-choice", "'w'"),
        (f'table = {{ file = "a.csv", axes = ["x", "x", "y"], {B} }}', "not-a-rotation",
         "case.landing.table: axes must be unit vectors at right angles"),
        (f'table = {{ file = "a.csv", axes = ["x", "y", "-z"], {B} }}', "not-a-rotation",
         'left-handed: reverse one of them; for reactions write acts_on = "link"'),
        (f'table = {{ file = "a.csv", axes = [[1, 0, 0], [0, 1, 1], [0, 0, 1]], {B} }}',
         "not-a-rotation", "right angles"),
        (f'table = {{ file = "a.csv", time = {{ column = "t", step = 1 }}, {B} }}', "give-one",
         "case.landing.table.time"),
        (f'table = {{ file = "a.csv", time = {{}}, {B} }}', "give-one", 'column = "t"'),
        (f'table = {{ file = "a.csv", header_line = 0, {B} }}', "out-of-range", "header_line"),
        (f'table = {{ file = "a.csv", {B} }}\ncolumns = {{ "B.fx" = "Fx" }}', "give-one",
         "columns is for a table that is only a file name"),
        (f'table = {{ file = "a.csv", {TIME}, {B[:-1]}, mz = "Mz" }} }}',
         "missing-unit", "column 'Mz' for B.mz has no unit; state moment_unit"),
        (f'table = {{ file = "a.csv", {B} }}', "duplicate-row", "line 3: connection B"),
        (f'table = {{ file = "gone.csv", {B} }}', "no-such-file", "gone.csv"),
        (f'table = {{ file = ".", {B} }}', "folder", "s.toml:26: case.landing.table: "),
        ('table = "."', "folder", "s.toml:26: case.landing.table: "),
        (f'table = [{{ file = "a.csv", {TIME}, {B} }}, {{ file = "a.csv", {TIME}, {B} }}]',
         "duplicate-row", "connection B is in another table of the case, too"),
        (f'table = {{ file = "a.csv", sheet = "x", {B} }}', "no-sheets", "remove sheet"),
    ],
)  # fmt: skip
def test_mistakes_are_told_at_their_key(tmp_path: Path, table: str, code: str, named: str) -> None:
    with pytest.raises(InputError) as wrong:
        reactions(tmp_path, table)
    assert named in str(wrong.value), wrong.value
    if code:
        assert code in wrong.value.codes


def test_units_axes_and_reaction_of_the_table_hold_unless_a_connection_has_its_own(
    tmp_path: Path,
) -> None:
    of_table = f'table = {{ file = "a.csv", {TIME}, unit = "kN", acts_on = "link", '
    found = reactions(tmp_path, f'{of_table} B = {{ {ALL}, axes = ["y", "z", "x"] }} }}')
    assert found.force("B")[0].tolist() == [-2000.0, -3000.0, -1000.0]
    assert found.moments[1, 0].tolist() == [-11.0, -12.0, -10.0]
    own = 'unit = "N", acts_on = "pin", axes = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]'
    found = reactions(tmp_path, f"{of_table} B = {{ {ALL}, {own} }} }}")
    assert found.force("B")[0].tolist() == [2.0, -1.0, 3.0]


def test_the_point_of_moments(tmp_path: Path) -> None:
    """A force of 2 N along y at 0.5 m along the pin has the moment -1 N m about x there."""
    at = f'B = {{ {ALL}, unit = "N", moments_at = [0, 0, "0.5 m"] }}'
    found = reactions(tmp_path, f'table = {{ file = "a.csv", {TIME}, {at} }}')
    assert found.moments[0, 0] == pytest.approx([4.0 - 1.0, 5.0 + 0.5, 6.0])


def test_times_of_steps_and_cases_of_a_column(tmp_path: Path) -> None:
    rows = "case;Fx;Fy\ngust;1;2\ngust;3;4\n"
    table = f'table = {{ file = "a.csv", time = {{ step = "2 ms", offset = "1 s" }}, {B} }}'
    found = reactions(tmp_path, table, rows, case="rig *")
    assert found.case == "rig gust"
    assert found.times == pytest.approx([1.0, 1.002], rel=1e-15)


def test_our_own_workbook_is_a_table(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(QUICK)
    done = run_here("loads", "s.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    before = case_loads(load_study(tmp_path / "s.toml"), "landing", None).reactions
    table = 'table = { file = "out/s-loads/tables.xlsx", sheet = "reactions" }'
    found = reactions(tmp_path, table)
    assert found.times is None
    assert found.force("B") == pytest.approx(before.force("B"), rel=1e-12)


@pytest.mark.slow  # two runs; the quick test is of the table alone
def test_a_jump_in_a_run(tmp_path: Path) -> None:
    """Both limits are solved: the row is that of the larger one, at its own time, and the plots,
    the sequence and the page take the table.
    """
    table = f'table = {{ file = "a.csv", {TIME}, B = {{ fx = "Fx", fy = "Fy", unit = "kN" }} }}'
    text = re.sub(r"forces = \{ B = .*", lambda _: table, QUICK)
    text += '\n[sequence.twice]\nsteps = [{ case = "landing", repeat = 2 }]\n'
    (tmp_path / "s.toml").write_text(text)
    (tmp_path / "a.csv").write_text("t Fx Fy\n1 0 1\n2 0 2\n2 4 4\n3 0 1\n")
    done = run_here("run", "s.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    row = first_row(tmp_path / "out" / "s")
    assert float(row[2]) == np.nextafter(2.0, 3.0)
    (tmp_path / "a.csv").write_text("t Fx Fy\n2 4 4\n")
    done = run_here("run", "s.toml", "--out", "alone", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert float(row[3]) == pytest.approx(float(first_row(tmp_path / "alone")[3]), rel=1e-9)


def first_row(folder: Path) -> list[str]:
    """The first row of the safety factors of a run."""
    return (folder / "safety_factors.csv").read_text().splitlines()[1].split(",")

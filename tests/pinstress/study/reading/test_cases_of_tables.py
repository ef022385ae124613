"""One section for every case that a table names: the same as a section for each."""

from __future__ import annotations

from pathlib import Path

import pytest

from pinstress.study.model.cases import case_loads
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study, load_study
from tests.support.each import each
from tests.support.programs.command_line import QUICK, run_here

FORCES = "forces = { B = [0.0, -988.86] }"
TABLE = "case,connection,fx,fy\ngust,B,1,2\ntaxi,B,3,-4\ngust,C,9,9\n"


def study(folder: Path, section: str, table: str = TABLE, more: str = "") -> Study:
    assert FORCES in QUICK
    assert "[case.landing]" in QUICK
    (folder / "loads.csv").write_text(table)
    text = QUICK.replace("[case.landing]", f'[case."{section}"]')
    text = text.replace(FORCES, 'table = "loads.csv"\nlabels = { B = "B" }')
    (folder / "s.toml").write_text(text + more)
    return load_study(folder / "s.toml")


@each(("section", "name"), [("*", "{}"), ("rig 3, *", "rig 3, {}")])
def test_each_case_of_the_table_has_its_own_forces(tmp_path: Path, section: str, name: str) -> None:
    found = study(tmp_path, section)
    for case, force in (("gust", [1.0, 2.0, 0.0]), ("taxi", [3.0, -4.0, 0.0])):
        reactions = case_loads(found, name.format(case), None).reactions
        assert reactions.case == name.format(case)
        size = found.system.factor("force")
        assert reactions.force("B")[0].tolist() == pytest.approx([size * f for f in force])
    assert list(found.table.case) == [name.format(case) for case in ("gust", "taxi")]


def test_the_case_column_may_have_another_name(tmp_path: Path) -> None:
    table = "LC\tF1\tF2\nup\t1\t2\ndown\t1\t-2\n"
    more = '\n[case."*".columns]\ncase = "LC"\n"B.fx" = "F1"\n"B.fy" = "F2"\n'
    text = QUICK.replace("[case.landing]", '[case."*"]').replace(FORCES, 'table = "t.tab"')
    (tmp_path / "t.tab").write_text(table)
    (tmp_path / "s.toml").write_text(text + more)
    found = load_study(tmp_path / "s.toml")
    assert case_loads(found, "down", None).reactions.force("B")[0, 1] < 0.0


def test_the_command_line_selects_among_them(tmp_path: Path) -> None:
    study(tmp_path, "*")
    checked = run_here("check", "s.toml", cwd=tmp_path)
    assert checked.stdout.count("\ncase ") == 2
    done = run_here("run", "s.toml", "--cases", "taxi", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    rows = (tmp_path / "out" / "s" / "safety_factors.csv").read_text().splitlines()
    assert [row.split(",")[1] for row in rows[1:]] == ["taxi"]
    wrong = run_here("run", "s.toml", "--cases", "taxy", cwd=tmp_path)
    assert wrong.returncode == 2
    assert "taxi" in wrong.stderr


@each(
    ("section", "table", "more", "code"),
    [
        ("*", TABLE.replace("case", "name"), "", "missing-column"),
        ("*", TABLE.replace("taxi", ""), "", "no-such-case"),
        ("*", TABLE.replace("taxi", "a/b"), "", "unusable-name"),
        ("* *", TABLE, "", "unusable-name"),
        ("*", TABLE, '\n[case.taxi]\nkind = "given"\nforces = { B = [1, 2] }\n', "duplicate-case"),
        ("*", TABLE, '\n[case."x*"]\nkind = "given"\nforces = { B = [1, 2] }\n', "unusable-name"),
        ("*", TABLE, '\n[case."x*"]\nkind = "static"\n', "unusable-name"),
        (
            "*",
            TABLE,
            '\n[case."x*"]\nkind = "given"\ntable = "loads.csv"\ntable_case = "gust"\n',
            "give-one",
        ),
        ("*", "case,connection,fx,fy\n" + "".join(f"c{k},B,1,2\n" for k in range(1001)), "",
         "too-large"),
    ],
)  # fmt: skip
def test_bad_tables_are_refused(
    tmp_path: Path, section: str, table: str, more: str, code: str
) -> None:
    with pytest.raises(InputError) as wrong:
        study(tmp_path, section, table, more)
    assert code in wrong.value.codes

"""Tables that other programs wrote give the forces that went into them."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from loads import Reactions
from pinstress.study.model.cases import case_loads
from pinstress.study.reading.file import load_study
from tests.conftest import ROOT
from tests.loads.tables.write_files import COLUMNS, GRAVITY, MASS, TIMES
from tests.support.each import each

FILES = ROOT / "tests" / "loads" / "tables" / "files"
TEXT = (ROOT / "studies" / "one_pin.toml").read_text()
STATED = 'unit = "kN", moment_unit = "N m"'
NAMED = 'B = { fx = "Fx_E", fy = "Fy_E", fz = "Fz_E", mz = "Mz_E"'


def reactions(folder: Path, table: str, *files: Path) -> Reactions:
    """The forces of a case that has this table."""
    text = re.sub(r"forces = \{ B = .*", lambda _: table, TEXT)
    assert text != TEXT
    for file in files:
        shutil.copy(file, folder)
    (folder / "s.toml").write_text(text)
    return case_loads(load_study(folder / "s.toml"), "landing", None).reactions


@each(
    ("file", "more", "stated"),
    [
        ("pandas_blank.txt", "", STATED),
        ("pandas_german.csv", "", ""),
        ("pandas_utf16.tab", "", STATED),
        ("pandas.xlsx", "", STATED),
        ("pandas.parquet", "", STATED),
        ("openpyxl.xlsx", 'sheet = "forces", header_line = 2, ', ""),
        ("libreoffice.csv", "", ""),
        ("libreoffice.xlsx", "", ""),
    ],
)
def test_the_load_that_a_program_wrote_is_read(
    tmp_path: Path, file: str, more: str, stated: str
) -> None:
    """To the digit: all files hold the same numbers, with a jump at 10 ms."""
    time = f'time = {{ column = "t"{", unit = " + chr(34) + "ms" + chr(34) if stated else ""} }}'
    columns = f"{NAMED}{', ' if stated else ''}{stated} }}"
    table = f'table = {{ file = "{file}", {more}{time}, {columns} }}'
    found = reactions(tmp_path, table, FILES / file)
    assert found.times is not None
    assert found.times == pytest.approx(np.array(TIMES) / 1e3, rel=1e-12)
    assert (np.diff(found.times) > 0.0).all()
    forces = np.array([COLUMNS[c] for c in ("Fx_E", "Fy_E", "Fz_E")]).T * 1e3
    assert found.force("B") == pytest.approx(forces, rel=1e-12)
    assert found.moments[:, 0, 2] == pytest.approx(np.array(COLUMNS["Mz_E"]), rel=1e-12)


EXUDYN = 'file = "exudyn_joint.txt", time = { column = 1, unit = "s" }'
MUJOCO = 'file = "mujoco_hinge.txt", time = { column = "time", unit = "s" }'


def test_the_joint_force_of_a_pendulum(tmp_path: Path) -> None:
    """Released from the horizontal, the rod pulls on the pin by 3 m g times the height fallen over
    its length: along the rod, so that F^2 = 3 m g |Fy| whatever the angle. exudyn's solution, by
    a method of second order with steps of 0.2 ms, is within 1e-4 of it.
    """
    table = f'table = {{ {EXUDYN}, B = {{ fx = 2, fy = 3, fz = 4, unit = "N" }} }}'
    found = reactions(tmp_path, table, FILES / "exudyn_joint.txt")
    fx, fy, _ = found.force("B").T
    assert found.times == pytest.approx(0.02 * np.arange(21), rel=1e-9)
    inertia = 1e-3  # N^2: 3 m g times 1.3e-5 N, for the mass is a cube of 1 mm
    assert fx**2 + fy**2 == pytest.approx(-3 * MASS * GRAVITY * fy, rel=1e-4, abs=inertia)
    assert (fx[1:] > 0.0).all()  # it hangs to the right of the pin and below, and pulls there
    assert (fy < 0.0).all()


def test_two_programs_and_files_of_one_motion(tmp_path: Path) -> None:
    """MuJoCo states the force on the rod, in its axes: reversed, it has exudyn's magnitude."""
    more = '  { length = 1.0, diameter = 2.0, connection = "C" },'
    pins = TEXT.replace('connection = "B" },', f'connection = "B" }},{more}')
    assert pins != TEXT
    tables = f"""
[[case.landing.table]]
{EXUDYN.replace(", time", chr(10) + "time")}
B = {{ fx = 2, fy = 3, unit = "N" }}
[[case.landing.table]]
{MUJOCO.replace(", time", chr(10) + "time")}
C = {{ fx = "fx", fy = "fy", unit = "N", acts_on = "link" }}
"""
    text = re.sub(r"forces = \{ B = .*\n", "", pins)
    for file in ("exudyn_joint.txt", "mujoco_hinge.txt"):
        shutil.copy(FILES / file, tmp_path)
    (tmp_path / "s.toml").write_text(text + tables)
    found = case_loads(load_study(tmp_path / "s.toml"), "landing", None).reactions
    assert found.connections == ("B", "C")
    by_exudyn, by_mujoco = found.magnitudes.T
    # exudyn's first forces, after steps of 0.2 ms, are 1 mN off.
    assert by_mujoco == pytest.approx(by_exudyn, rel=1e-3, abs=1e-3)
    assert (found.force("C")[1:, 0] > 0.0).all()

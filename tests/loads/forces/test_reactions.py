"""Reading tables of reactions, and a pin's own axes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from loads import Layout, Reactions, TableError, given_reactions, impulse_force, read_reactions
from tests.support.each import each
from tests.support.errors import raises


def unit(written: str, dimension: str) -> float:
    """Tables are in 2 N and 3 N m unless they say otherwise."""
    return {"kN": 1e3, "ms": 1e-3}.get(written) or {"force": 2.0, "moment": 3.0}.get(dimension, 1.0)


def read(tmp_path: Path, text: str, **layout: Any) -> Reactions:
    path = tmp_path / "table.csv"
    path.write_text(text)
    return read_reactions(path, Layout("case", **layout), unit, {"B", "C"})


def test_a_sweep(tmp_path: Path) -> None:
    found = read(tmp_path, "connection, fx, fy, time\nB,1,2,0.5\nC,3,4,0.5\nB,5,6,0\nC,7,8,0\n")
    assert found.times is not None
    assert found.times.tolist() == [0.0, 0.5]
    assert found.force("B").tolist() == [[10.0, 12.0, 0.0], [2.0, 4.0, 0.0]]
    assert found.moments.shape == (2, 2, 3)
    assert not found.moments.any()


def test_a_table_with_moments(tmp_path: Path) -> None:
    """In the table's own units; columns in any order, those that are absent are zero."""
    found = read(
        tmp_path,
        "connection,mz,fx,fy,mx,time\nB,1,2,3,4,0\nC,5,6,7,8,0\nB,0,0,0,9,1\nC,0,0,0,0,1\n",
    )
    assert found.connections == ("B", "C")
    assert found.forces[0].tolist() == [[4.0, 6.0, 0.0], [12.0, 14.0, 0.0]]
    assert found.moments.tolist() == [
        [[12.0, 0.0, 3.0], [24.0, 0.0, 15.0]],
        [[27.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    ]


@each(
    ("text", "code", "named"),
    [
        ("connection,fx\nB,1\n", "missing-column", "'fy'"),
        ("connection,mx,my\nB,1,2\n", "missing-column", "'fx'"),
        ("connection,fx,fy,mx\nB,1,2,twist\n", "not-a-number", "line 2: mx = 'twist'"),
        ("connection,fx,fy,mx,mz\nB,1,2,3,nan\n", "not-finite", "line 2: mz = nan"),
        ("connection,fx,fy,mx,my\nB,1,2,3\n", "cell-count", "line 2: 4 "),
        ("connection,fx,fy\nX,1,2\n", "unknown-connection", "line 2: "),
        ("connection,fx,fy\nB,1,inf\n", "not-finite", "line 2: fy = inf"),
        ("connection,fx,fy\nB,one,2\n", "not-a-number", "line 2: fx = 'one'"),
        ("connection,fx,fy\nB,1\n", "cell-count", "line 2: 2 "),
        ("connection,fx,fy\nB,1,2,3\n", "cell-count", "line 2: 4 "),
        ("connection,fx,fy,fx\nB,1,2,3\n", "duplicate-column", "'fx'"),
        ("connection,fx,fy,MZ\nB,1,2,3\n", "unknown-column", "'MZ'"),
        ("connection,fx,fy\nB,1,1e99\n", "too-large", "line 2: fy = 1e99"),
        ("connection,fx,fy\nB,1," + "9" * 200_000, "not-csv", "table.csv"),
        ("connection|fx|fy\nB|1|2\n", "unknown-column", "connection|fx|fy"),
        ("B.fx,B.mz\n1,2\n", "missing-column", "B.fy"),
        ("X.fx,X.fy\n1,2\n", "unknown-connection", "line 2: "),
        ("case,connection,fx,fy\nother,B,1,2\n", "no-such-case", "other"),
        ("time,case,connection,fx,fy\n,case,B,1,2\n1,case,B,1,2\n", "missing-row", "B"),
        ("# nothing\n\n", "no-rows", "table.csv"),
        ('connection,fx,fy\nB,"1,5","2,0"\n', "decimal-comma", "line 2: fx = '1,5'"),
        ("connection,fx,fy\nB,1,5,2,0\n", "cell-count", "line 2: 5 "),
        ("connection,fx,fy\nB,1,2\nB,1,2\n", "duplicate-row", "line 3: "),
        ("connection,fx,fy,time\nB,1,2,0\nC,1,2,1\n", "missing-row", "connection "),
        ("connection,fx,fy\n", "no-rows", "table.csv"),
    ],
)
def test_a_bad_table_is_refused(tmp_path: Path, text: str, code: str, named: str) -> None:
    with raises(TableError, code, named):
        read(tmp_path, text)


def test_a_missing_table_is_named(tmp_path: Path) -> None:
    with raises(TableError, "no-such-file", "gone.csv"):
        read_reactions(tmp_path / "gone.csv", Layout("case"), unit, {"B"})


def test_the_pins_own_axes_turn_with_it() -> None:
    given = given_reactions("case", {"B": (0.0, 3.0, 1.0)}, {"B": (2.0, 0.0, 4.0)})
    found = replace(given, turn=np.array([[np.pi / 2]]))
    assert found.in_pin_axes("B")[0] == pytest.approx([3.0, 0.0, 1.0])
    assert found.moment_in_pin_axes("B")[0] == pytest.approx([0.0, -2.0, 4.0])


def test_a_connection_may_have_a_force_a_moment_or_both() -> None:
    found = given_reactions("case", {"B": (1.0, 2.0)}, {"C": (3.0, 4.0, 5.0), "B": (6.0, 7.0)})
    assert found.connections == ("B", "C")
    assert found.bodies == ("", "")
    assert found.forces.tolist() == [[[1.0, 2.0, 0.0], [0.0, 0.0, 0.0]]]
    assert found.moments.tolist() == [[[6.0, 7.0, 0.0], [3.0, 4.0, 5.0]]]


def test_the_published_impulse() -> None:
    """37,500 lbf at 32.2 ft/s^2 stopped from 25 ft/s in 0.15 s: 194,099.4 lbf (Grenier, eq. L2)."""
    assert impulse_force(37500.0 / 32.2, 25.0, 0.15) == pytest.approx(194099.3788819876, rel=1e-15)


@each(
    ("pulse", "shape"),
    [
        ("rectangular", lambda s: np.ones_like(s)),
        ("half-sine", lambda s: np.sin(np.pi * s)),
        ("triangular", lambda s: 1.0 - np.abs(2.0 * s - 1.0)),
    ],
)
def test_every_pulse_takes_the_same_momentum(
    pulse: str, shape: Callable[[np.ndarray], np.ndarray]
) -> None:
    """Its peak times the area under its shape over 0.15 s is mass times velocity change."""
    s = np.linspace(0.0, 1.0, 20001)
    area = 0.15 * float(np.trapezoid(shape(s), s))
    assert impulse_force(1000.0, 7.0, 0.15, pulse) * area == pytest.approx(7000.0, rel=1e-8)


@each(
    "text",
    [
        "time [ms],B.fx [kN],B.fy [kN],B.mz\n0,1.5,-2,1\n500,2.5,0,0\n",
        "# on a rig\n\ntime [ms];B fx [kN];B fy (kN);B mz\n0;1,5;-2;1\n# later\n500;2,5;0;0\n",
        "time\tconnection\tfx [kN]\tfy [kN]\tmz\n0\tB\t1,5\t-2\t1\n0,5\tB\t2.5\t0\t0\n",
    ],
)
def test_the_same_forces_however_they_are_laid_out(tmp_path: Path, text: str) -> None:
    found = read(tmp_path, text)
    assert found.times == pytest.approx([0.0, 0.5])
    assert found.force("B").tolist() == [[1500.0, -2000.0, 0.0], [2500.0, 0.0, 0.0]]
    assert found.moments[:, 0, 2].tolist() == [3.0, 0.0]


def test_a_decimal_comma_needs_another_separator(tmp_path: Path) -> None:
    with raises(TableError, "cell-count", "line 2: 3 "):
        read(tmp_path, "B.fx,B.fy\n1,5,2\n")


def test_many_cases_in_one_table(tmp_path: Path) -> None:
    text = "case,B.fx,B.fy,C.fx,C.fy\n" + "".join(f"c{k},{k},0,0,{-k}\n" for k in range(50))
    for k in (0, 49):
        path = tmp_path / "table.csv"
        path.write_text(text)
        found = read_reactions(path, Layout(f"c{k}"), unit, {"B", "C"})
        assert found.times is None
        assert found.forces[0].tolist() == [[2.0 * k, 0.0, 0.0], [0.0, -2.0 * k, 0.0]]


def test_joint_forces_of_mbdyn(tmp_path: Path) -> None:
    """A .jnt has no header and no time: a row per joint and step with its label, force and moment
    in the joint's axes, then both in global axes (MBDyn input manual, output of joints).
    """
    rows = ""
    for step in range(3):
        for label in (7, 12, 99):
            local = " ".join(["5.0e-1"] * 6)
            rows += f"      {label} {local} {step + label:e} {-2.0 * label:e} 0. 0. 0. {step}.5\n"
    mapping = {"connection": 1, "fx": -8, "fy": -9, "fz": -10, "mz": -13}
    found = read(tmp_path, rows, columns=mapping, labels={"B": 12, "C": 7}, step=0.25)
    assert found.times == pytest.approx([0.0, 0.25, 0.5])
    assert found.force("B").tolist() == [[-2.0 * (k + 12), 48.0, 0.0] for k in range(3)]
    assert found.force("C")[:, 1].tolist() == [28.0] * 3
    assert found.moments[:, 0, 2].tolist() == [-3.0 * (k + 0.5) for k in range(3)]


def test_applied_forces_of_mbdyn(tmp_path: Path) -> None:
    """A row of a .frc for a force on a node: label, node, force and point, in global axes (MBDyn,
    mbdyn/struct/strforce.cc: ConservativeForce::Output). A couple has fewer cells: refused.
    """
    rows = ""
    for step in range(2):
        for label in (3, 9):
            rows += f"{label:8d} {70 + label} {step}.5 {-label:e} 0. 8.0e+0 9.0e+0 7.0e+0\n"
    mapping = {"connection": 1, "fx": 3, "fy": 4, "fz": 5}
    found = read(tmp_path, rows, columns=mapping, labels={"B": 9}, step=0.1)
    assert found.connections == ("B",)
    assert found.force("B").tolist() == [[1.0, -18.0, 0.0], [3.0, -18.0, 0.0]]
    with raises(TableError, "cell-count", "line 5: 5 cells"):
        read(tmp_path, rows + "4 71 0. 0. 1.\n", columns=mapping, labels={"B": 9}, step=0.1)


def test_a_sensor_file_of_exudyn(tmp_path: Path) -> None:
    """Comments, then time and components separated by commas (Exudyn user documentation)."""
    head = "#Exudyn sensor output file\n#sensor type = Object\n#\n"
    text = f"{head}0.000,1.0,2.0,0.0\n0.001,3.0,4.0,0.0\n"
    found = read(tmp_path, text, columns={"time": 1, "B.fx": 2, "B.fy": 3})
    assert found.times == pytest.approx([0.0, 0.001])
    assert found.force("B").tolist() == [[2.0, 4.0, 0.0], [6.0, 8.0, 0.0]]


def test_columns_by_the_headers_of_a_plot_export(tmp_path: Path) -> None:
    text = "Time\tPIN_1.FX (kN)\tPIN_1.FY (kN)\tunused\n0.0\t1.0\t2.0\t9\n0.5\t3.0\t4.0\t9\n"
    mapping = {"time": "Time", "C.fx": "-PIN_1.FX (kN)", "C.fy": "-PIN_1.FY (kN)"}
    found = read(tmp_path, text, columns=mapping)
    assert found.force("C").tolist() == [[-1e3, -2e3, 0.0], [-3e3, -4e3, 0.0]]
    with raises(TableError, "missing-column", "PIN_2"):
        read(tmp_path, text, columns={"C.fx": "PIN_2.FX", "C.fy": "Time"})

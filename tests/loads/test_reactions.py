"""Reading tables of reactions, and a pin's own axes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from loads import TableError, given_reactions, impulse_force, read_reactions
from tests.support.errors import raises


def read(tmp_path: Path, text: str) -> object:
    path = tmp_path / "table.csv"
    path.write_text(text)
    return read_reactions("case", path, 2.0, 3.0, 1.0, {"B", "C"})


def test_a_sweep(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("connection, fx, fy, time\nB,1,2,0.5\nC,3,4,0.5\nB,5,6,0\nC,7,8,0\n")
    found = read_reactions("case", path, 2.0, 3.0, 1.0, {"B", "C"})
    assert found.times is not None
    assert found.times.tolist() == [0.0, 0.5]
    assert found.force("B").tolist() == [[10.0, 12.0, 0.0], [2.0, 4.0, 0.0]]
    assert found.moments.shape == (2, 2, 3)
    assert not found.moments.any()


def test_a_table_with_moments(tmp_path: Path) -> None:
    """In the table's own units; columns in any order, those that are absent are zero."""
    path = tmp_path / "table.csv"
    path.write_text(
        "connection,mz,fx,fy,mx,time\nB,1,2,3,4,0\nC,5,6,7,8,0\nB,0,0,0,9,1\nC,0,0,0,0,1\n"
    )
    found = read_reactions("case", path, 2.0, 3.0, 1.0, {"B", "C"})
    assert found.connections == ("B", "C")
    assert found.forces[0].tolist() == [[4.0, 6.0, 0.0], [12.0, 14.0, 0.0]]
    assert found.moments.tolist() == [
        [[12.0, 0.0, 3.0], [24.0, 0.0, 15.0]],
        [[27.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    ]


@pytest.mark.parametrize(
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
        ("connection;fx;fy\nB;1;2\n", "wrong-separator", "semicolons"),
        ("connection\tfx\tfy\nB\t1\t2\n", "wrong-separator", "tabs"),
        ("connection;fx;fy\nB;1,5;2,0\n", "wrong-separator", "semicolons"),
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
        read_reactions("case", tmp_path / "gone.csv", 1.0, 1.0, 1.0, {"B"})


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


@pytest.mark.parametrize(
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

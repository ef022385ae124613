"""Reading tables of reactions, and a pin's own axes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from loads import TableError, given_reactions, impulse_force, read_reactions


def read(tmp_path: Path, text: str) -> object:
    path = tmp_path / "table.csv"
    path.write_text(text)
    return read_reactions("case", path, 2.0, 1.0, {"B", "C"})


def test_a_sweep(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("connection, fx, fy, time\nB,1,2,0.5\nC,3,4,0.5\nB,5,6,0\nC,7,8,0\n")
    found = read_reactions("case", path, 2.0, 1.0, {"B", "C"})
    assert found.times is not None
    assert found.times.tolist() == [0.0, 0.5]
    assert found.force("B").tolist() == [[10.0, 12.0, 0.0], [2.0, 4.0, 0.0]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("connection,fx\nB,1\n", "column 'fy' is missing"),
        ("connection,fx,fy\nX,1,2\n", "line 2: unknown connection 'X'; the study's pins have B, C"),
        ("connection,fx,fy\nB,1,inf\n", "line 2: fy = inf is not finite"),
        ("connection,fx,fy\nB,one,2\n", "line 2: fx = 'one' is not a number"),
        ("connection,fx,fy\nB,1\n", "line 2: fy = None is not a number"),
        ("connection,fx,fy\nB,1,2\nB,1,2\n", "line 3: connection B is given twice"),
        ("connection,fx,fy,time\nB,1,2,0\nC,1,2,1\n", "is not given at every time"),
        ("connection,fx,fy\n", "has no rows"),
    ],
)
def test_a_bad_table_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(TableError, match=message):
        read(tmp_path, text)


def test_a_missing_table_is_named(tmp_path: Path) -> None:
    with pytest.raises(TableError, match=r"gone\.csv: no such file"):
        read_reactions("case", tmp_path / "gone.csv", 1.0, 1.0, {"B"})


def test_the_pins_own_axes_turn_with_it() -> None:
    found = replace(given_reactions("case", {"B": (0.0, 3.0, 1.0)}), turn=np.array([[np.pi / 2]]))
    assert found.in_pin_axes("B")[0] == pytest.approx([3.0, 0.0, 1.0])


def test_the_published_impulse() -> None:
    """37,500 lbf at 32.2 ft/s^2 stopped from 25 ft/s in 0.15 s: 194,099.4 lbf (Grenier, eq. L2)."""
    assert impulse_force(37500.0 / 32.2, 25.0, 0.15) == pytest.approx(194099.3788819876, rel=1e-15)

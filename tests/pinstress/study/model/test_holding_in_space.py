"""A linkage in space at rest, held by locks and stops instead of its drives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pinstress import load_study
from pinstress.analysis.mechanics.gather_space import drives_in_space
from pinstress.analysis.plan import all_loads
from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.errors import InputError
from tests.support.each import each
from tests.support.study_text import edited_once, study_file

# A leg about x, a jack to its knee line, and a stay of two links whose knee locks.
LEG = """
title = "A leg that a jack folds and a lock holds"
units = "m-N-s"
[mechanism]
dimension = 3
gravity = [0, 0, 0]
[mechanism.joint.O]
at = [0, 0, 0]
axis = [1, 0, 0]
fixed_in = "ground"
connections = { O1 = "leg" }
[mechanism.joint.S]
at = [0.1, 1.0, 0]
axis = [1, 0, 0]
fixed_in = "ground"
connections = { S1 = "upper" }
[mechanism.joint.K]
at = [0.1, 0.6, -0.5]
axis = [1, 0, 0]
fixed_in = "upper"
connections = { K1 = "lower" }
[mechanism.joint.L]
at = [0.1, 0, -1]
kind = "spherical"
fixed_in = "leg"
connections = { L1 = "lower" }
[mechanism.body]
leg = { mass = 10 }
upper = { mass = 1 }
lower = { mass = 1 }
[mechanism.drive]
name = "jack"
bodies = ["ground", "leg"]
between = [[0, -0.5, 0], [0, 0, -0.5]]
law = "cosine"
start = 0.7071067811865476
end = 0.8
duration = 1
[mechanism.stop.downlock]
joint = "K"
[case.landing]
kind = "static"
hold = ["downlock"]
[[case.landing.apply]]
body = "leg"
at = [0, 0, -2]
force = [300, 1000, 0]
"""  # fmt: skip


def _loads(folder: Path, *changes: tuple[str, str]) -> CaseLoads:
    study = load_study(study_file(folder, edited_once(LEG, changes)))
    return all_loads(study, ["landing"])["landing"]


def _line(found: CaseLoads) -> float:
    """The couple of the load about the hinge line of the leg that the stay's pull at L balances."""
    pull = found.reactions.force("L1")[0]
    return float(np.cross([0.1, 0.0, -1.0], pull)[0])


def test_a_lock_holds_in_place_of_the_jack(tmp_path: Path) -> None:
    """The leg turns about x: the stay balances the load's 2 m x 1000 N. The couple of the lock is
    the force at L times its arm about the knee, and the jack carries nothing.
    """
    found = _loads(tmp_path)
    assert found.space is not None
    assert _line(found) == pytest.approx(-2000.0)
    (couple,) = found.space.dynamics.drive[0]
    force = found.reactions.force("L1")[0]  # of the lower link on the leg
    about = np.cross([0.0, -0.6, -0.5], force)[0]  # L from K
    assert abs(couple) > 100.0
    assert couple == pytest.approx(about)


def test_the_jack_holds_where_nothing_else_is_named(tmp_path: Path) -> None:
    """Then the stay carries nothing about the hinge of the leg."""
    found = _loads(tmp_path, ('hold = ["downlock"]\n', ""))
    assert found.space is not None
    assert _line(found) == pytest.approx(0.0, abs=1e-9)
    (force,) = found.space.dynamics.drive[0]
    assert force == pytest.approx(-2000.0 / (0.5 * np.sqrt(0.5)))


def test_a_lock_holds_in_the_position_of_the_drive(tmp_path: Path) -> None:
    found = _loads(tmp_path, ('hold = ["downlock"]\n', 'hold = ["downlock"]\nposition = 0.75\n'))
    assert found.space is not None
    motion = found.space.dynamics.motion
    span = motion.point("leg", (0.0, 0.0, -0.5))[0][0] - [0.0, -0.5, 0.0]
    assert np.linalg.norm(span) == pytest.approx(0.75)
    assert abs(motion.coordinate("downlock")[0][0]) > 0.05
    assert found.space.dynamics.motion.drives[0, 0] == motion.coordinate("downlock")[0][0]


def test_locks_alone_need_no_drive(tmp_path: Path) -> None:
    start, end = LEG.index("[mechanism.drive]"), LEG.index("[mechanism.stop")
    found = _loads(tmp_path, (LEG[start:end], ""))
    assert _line(found) == pytest.approx(-2000.0)


def test_the_lock_is_in_the_table_of_drives(tmp_path: Path) -> None:
    path = tmp_path / "leg.toml"
    path.write_text(LEG, encoding="utf-8")
    study = load_study(path)
    solved = all_loads(study, ["landing"])["landing"].space
    assert solved is not None
    (table,) = drives_in_space(study, "landing", solved)
    assert (table.name, table.kind) == ("downlock", "rotary")
    assert table.force == pytest.approx(solved.dynamics.drive[:, 0])


@each(("carries", "opens"), [("positive", False), ("negative", True), ("both", False)])
def test_a_stop_that_would_have_to_pull_opens(tmp_path: Path, carries: str, opens: bool) -> None:
    """Loads in the other direction press it closed."""
    sign = float(np.sign(_loads(tmp_path).space.dynamics.drive[0, 0]))  # type: ignore[union-attr]
    stated = ('joint = "K"\n', f'joint = "K"\ncarries = "{carries}"\n')
    other = ("force = [300, 1000, 0]", f"force = [{-sign * 300}, {sign * 1000}, 0]")
    if opens:
        with pytest.raises(InputError, match="it opens"):
            _loads(tmp_path, stated, other)
    else:
        _loads(tmp_path, stated, other)


@each(
    ("old", "new", "words"),
    [
        ('hold = ["downlock"]', 'hold = ["uplock"]', "no drive or stop 'uplock'"),
        ('hold = ["downlock"]', 'hold = ["downlock", "jack"]', "2 for 1 degree"),
        ('joint = "K"\n', 'joint = "L"\n', "has no angle"),
        ('joint = "K"\n', 'slide = "K"\n', "has no travel"),
        ('joint = "K"\n', "", "joint, slide or between"),
    ],
)
def test_what_is_wrong_with_locks(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        _loads(tmp_path, (old, new))
    assert words in str(error.value)


WHEEL = """
[mechanism.joint.W]
at = [0, 0, -2]
axis = [1, 0, 0]
fixed_in = "leg"
connections = { W1 = "wheel" }
[mechanism.body.wheel]
mass = 1
centre = [0, 0, -2]
inertia = [1, 1, 1]
[mechanism.stop.brake]
joint = "W"
[[mechanism.drive]]
name = "spin"
joint = "W"
[case.landing]
"""


@each(
    ("hold", "words"),
    [
        ('["brake"]', "1 for 2 degrees of freedom; name 1 more"),
        ('["brake", "spin"]', "leg, upper, lower, wheel can still move"),
        ('["brake", "downlock"]', ""),
    ],
)
def test_a_lock_that_leaves_bodies_free_is_told(tmp_path: Path, hold: str, words: str) -> None:
    """A wheel on the leg is locked, once or twice, and the leg is not."""
    changes = (
        ("[case.landing]\n", WHEEL),
        ('["downlock"]', hold),
        ('[mechanism.drive]\nname = "jack"', '[[mechanism.drive]]\nname = "jack"'),
        ("leg = { mass = 10 }", "leg = { mass = 10, centre = [0, 0, -1] }"),
    )
    if not words:
        assert _line(_loads(tmp_path, *changes)) == pytest.approx(-2000.0)
        return
    with pytest.raises(InputError) as error:
        _loads(tmp_path, *changes)
    assert words in str(error.value)

"""Ground loads by regulation on a leg in space: as on the same leg in a plane, and in any axes."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from pinstress import load_study
from pinstress.analysis.mechanics.gather_loads import mechanics
from pinstress.analysis.plan import all_loads
from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.published_tables import Published
from tests.support.each import each
from tests.support.study_text import edited_once

LEG = """
title = "A leg on the left of an aircraft"
units = "m-N-s"
[mechanism]
gravity = [0, -9.81]
[mechanism.joint.O]
at = [0, 0]
fixed_in = "ground"
connections = { O1 = "leg" }
[mechanism.joint.W]
at = [0.1, -1.2]
fixed_in = "leg"
connections = { W1 = "wheel" }
[mechanism.body.leg]
mass = 50
centre = [0, -0.6]
inertia = 6
[mechanism.body.wheel]
mass = 20
centre = [0.1, -1.2]
[mechanism.drive]
body = "leg"
line = ["O", "W"]
[case."main-*"]
kind = "ground"
part = "25"
reference = 1e5
body = "leg"
at = "W"
leg = "left"
forward = "left"
radius = 0.4
spin_up = { inertia = 2, radius = 0.4, speed = 60, time = 0.2 }
[[case."main-*".factors]]
name = "braked roll"
clause = "14 CFR 25.493"
vertical = 1
drag = 0.8
braked = true
"""  # fmt: skip
IN_SPACE = (
    ("gravity = [0, -9.81]", "dimension = 3\ngravity = [0, -9.81, 0]"),
    ("inertia = 6", "inertia = [3, 3, 6]"),
    ("at = [0.1, -1.2]\nfixed_in", 'at = [0.1, -1.2]\nkind = "fixed"\nfixed_in'),
    ('body = "leg"\nline = ["O", "W"]', 'joint = "O"'),
    ('forward = "left"', "forward = [-3, 0.5, 0]"),  # its level part counts
)


def _in_space(*changes: tuple[str, str]) -> str:
    text = edited_once(LEG, IN_SPACE)
    text = re.sub(r"= \[(-?[\d.]+), (-?[\d.]+)\]", r"= [\1, \2, 0]", text)
    text = text.replace("\nconnections = { O1", "\naxis = [0, 0, 1]\nconnections = { O1")
    return edited_once(text, changes)


def _loads(folder: Path, text: str) -> dict[str, CaseLoads]:
    path = folder / "leg.toml"
    path.write_text(text, encoding="utf-8")
    study = load_study(path)
    return all_loads(study, [*study.table.case])


def test_ground_loads_are_those_in_the_plane(tmp_path: Path) -> None:
    """All components of all landings, with their clauses and sums."""
    plane, space = _loads(tmp_path, LEG), _loads(tmp_path, _in_space())
    assert [*plane] == [*space]
    assert len(plane) == 6  # spin-up, spring-back, drag, drift to both sides, braked roll
    for name, flat in plane.items():
        for key in ("forces", "moments"):
            ours, theirs = getattr(space[name].reactions, key), getattr(flat.reactions, key)
            assert ours == pytest.approx(theirs, abs=1e-6), (name, key)
        assert space[name].note.split(" Offsets")[0] == flat.note.split(" Offsets")[0]
    drift = space["main-25.479-drift-inboard"].reactions.force("O1")[0]
    assert drift[2] == pytest.approx(-0.75 * 0.25 * 1e5)  # the pilot's right, from a left leg


def test_the_sums_of_a_leg_in_space_are_in_the_table(tmp_path: Path) -> None:
    """With the place of the axle, here a point of the leg that is no joint."""
    path = tmp_path / "leg.toml"
    path.write_text(_in_space(('at = "W"', "at = [0.1, -1.2, 0.2]")), encoding="utf-8")
    study = load_study(path)
    loads = all_loads(study, ["main-25.479-drag"])
    (table,) = mechanics(study, loads, Published({}, {}))["reactions"]
    vertical, drag = table.wheel_loads
    assert (vertical.component, vertical.force) == ("vertical", 1e5)
    assert vertical.point == pytest.approx((0.1, -1.6, 0.2))
    assert (drag.component, drag.force) == ("drag", pytest.approx(0.25e5))
    assert drag.point == pytest.approx((0.1, -1.2, 0.2))
    assert table.clause.startswith("14 CFR 25.479")
    moment = loads["main-25.479-drag"].reactions.moments[0, 0]  # about x: vertical load, 0.2 m off
    assert moment[0] == pytest.approx(-0.2 * 1e5)


def test_a_leg_that_is_turned_has_the_same_loads_turned(tmp_path: Path) -> None:
    """x to y, y to z, z to x: gravity along -z, forward along -y."""
    numbers = r"= \[(-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\]"
    turned = re.sub(numbers, r"= [\3, \1, \2]", _in_space())
    one, other = _loads(tmp_path, _in_space()), _loads(tmp_path, turned)
    for name, case in one.items():
        for key in ("forces", "moments"):
            expected = np.roll(getattr(case.reactions, key), 1, axis=2)
            assert getattr(other[name].reactions, key) == pytest.approx(expected, abs=1e-6)


@each(
    ("old", "new", "words"),
    [
        ("forward = [-3, 0.5, 0]", 'forward = "left"', "in space give [x, y, z]"),
        ("forward = [-3, 0.5, 0]", "forward = [0, 0, 0]", "must not be zero"),
        ("forward = [-3, 0.5, 0]", "forward = [0, 1, 0]", "is vertical"),
        ("gravity = [0, -9.81, 0]", "gravity = [0, 0, 0]", "gravity says where up is"),
        ('at = "W"', 'at = "V"', "no joint 'V'"),
        ('body = "leg"\nat', 'body = "tyre"\nat', "no body 'tyre'"),
        ("reference = 1e5", 'drop = "fall"', "in space there is no drop"),
    ],
)
def test_what_is_wrong_with_ground_loads(tmp_path: Path, old: str, new: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        _loads(tmp_path, _in_space((old, new)))
    assert words in str(error.value)


@each(
    ("old", "new", "words"),
    [
        ('forward = "left"', "forward = [-1, 0, 0]", 'in a plane give "left" or "right"'),
        ('at = "W"', "at = [0, 0, 0]", "in a plane name the joint"),
        ('forward = "left"', 'forward = "ahead"', "'left'"),
    ],
)
def test_directions_and_points_are_of_space(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert LEG.count(old) == 1
    with pytest.raises(InputError) as error:
        _loads(tmp_path, LEG.replace(old, new))
    assert words in str(error.value)

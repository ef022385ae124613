"""Forces, springs, holders and friction of a study: what is wrong is named, with its code."""

from __future__ import annotations

import os
from pathlib import Path

from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import load_study
from tests.conftest import ROOT
from tests.support.described import describe
from tests.support.each import each
from tests.support.errors import raises

STUDIES = ROOT / "studies"
GAS = 'table = "engine/gas_force.csv"        # columns position_deg,force'
TURN = 'ground_motion = { rate = "1 rad/s" }'
PUSH = "[[case.two_turns.apply]]"
IMPULSE = """body = "piston"
[case.two_turns.apply.impulse]
mass = 1
velocity_change = 1
impulse_time = 1
direction = [1, 0]
range = { impulse_time = [1, 2] }
"""
HOLD, OFF = 'hold = ["downlock"]', "outside-table"
LOAD = 'force = { value = ["40 kN", "90 kN"], provenance = "assumed" }'
SUN = 'bodies = ["sun", "planet1"]'
SHARED = 'connections = ["sun_planet1", "sun_planet2", "sun_planet3"]'
LOCKS = 'bodies = ["upper_lock", "lower_lock"]'


@each(
    ("study", "old", "new", "code", "named"),
    [
        ("engine", 'position_of = "crank"', 'position_of = "krank"', "unknown-slider", "'krank'"),
        ("engine", GAS, 'points = [["9 deg", 1], ["5 deg", 1]]', "table-not-increasing", "row 2"),
        ("engine", GAS, "points = [[0, 1], [720, 1]]", "missing-unit", "points"),
        ("engine", GAS, 'points = [["0 deg", 1], ["720 deg", 2]]', "table-not-periodic", "repeat"),
        ("engine", GAS, 'points = [["0 deg", 1]]', "list-too-short", "points"),
        ("engine", GAS, 'table = "none.csv"', "no-such-file", "none.csv"),
        ("engine", GAS, "", "give-one", "force_law"),
        ("engine", 'outside = "repeat"', "", OFF, "750 deg"),
        ("engine", 'position_of = "crank"', 'length_between = ["O", "Q"]', "unknown-joint", "'Q'"),
        ("engine", "direction = [-1, 0]\n\n", "\n", "give-both", "direction"),
        ("engine", 'at = "C"\n', 'at = "C"\nforce = [1, 0]\n', "give-one", "force_law"),
        ("engine", 'at = "C"\n', 'at = "C"\nbegin = 2\nend = 1\n', "out-of-range", "begin"),
        ("main_gear", LOAD, "couple_law = { points = [[0, 0], [1, 1]] }", "needs-motion", "time"),
        ("main_gear", LOAD, f"{LOAD}\nend = 2", "needs-motion", "end"),
        ("engine", PUSH, f"{PUSH}\n{IMPULSE}\n{PUSH}", "needs-instant", "range"),
        ("main_gear", HOLD, 'hold = ["uplock"]', "unknown-stop", "'uplock'"),
        ("main_gear", HOLD, 'hold = ["downlock", "actuator"]', "hold-too-many", "parallel"),
        ("main_gear", HOLD, "hold = []", "list-too-short", "hold"),
        ("main_gear", HOLD, f"{HOLD}\n{TURN}", "wrong-dimension", "ground_motion"),
        ("kuleuven2014", "axis = [0, 0, 1]", "axis = [0, 0, 0]", "no-direction", "ground_motion"),
        ("main_gear", LOCKS, f'{LOCKS}\ncarries = "positive"', "stop-opens", "downlock"),
        ("main_gear", LOCKS, 'bodies = ["leg", "leg"]', "same-body", "downlock"),
        ("main_gear", LOCKS, 'bodies = ["leg", "log"]', "unknown-body", "'log'"),
        ("main_gear", 'fixed_in = "leg"\n', 'fixed_in = "leg"\nfriction = 1\n', "give-both", "W"),
        ("crane", 'parallel = ["front", "rear"]', 'parallel = ["rear", "x"]', "one-must-drive", ""),
        ("crane", "areas =", "stiffness = [1, 1]\nareas =", "give-one", "sharing"),
        ("crane", '"front", "rear"]', '"front", "rear", "x"]', "lengths-differ", "sharing"),
        ("hood", 'slider = "gas_spring"', 'slider = "spring"', "unknown-slider", "'spring'"),
        ("hood", 'slider = "gas_spring"', 'bodies = ["hood", "ground"]', "give-both", "joints"),
        ("hood", "[535, 680]", "[580, 680]", OFF, "541.912 mm"),
        ("bucket", 'tip]\nbody = "bucket"', 'tip]\nbody = "spoon"', "unknown-body", "'spoon'"),
        ("planetary", "distance = 96", "distance = 97", "gears-apart", "96 mm apart"),
        ("planetary", "internal = true\n", "", "gears-apart", "192 mm apart"),
        ("planetary", "module = 4 ", "radii = [48, 48]", "give-one", "either teeth or radii"),
        ("planetary", "teeth = [24, 24]", "radii = [48, 48]", "give-both", "module needs teeth"),
        ("planetary", "teeth = [24, 24]", "teeth = [24, 0]", "out-of-range", "at least 1"),
        ("planetary", 'joints = ["O", "P1"]', 'joints = ["O", "P9"]', "unknown-joint", "'P9'"),
        ("planetary", SUN, 'bodies = ["sun", "planet2"]', "joint-not-on-body", "arm, planet1"),
        ("planetary", SUN, 'bodies = ["sun", "sun"]', "same-body", "twice"),
        ("planetary", SUN, 'bodies = ["sun", "moon"]', "unknown-body", "'moon'"),
        ("planetary", SUN, f'{SUN}\npressure_angle = "50 deg"', "out-of-range", "45 deg"),
        ("planetary", SHARED, SHARED.replace("net3", "net9"), "unknown-connection", "gear"),
        ("planetary", 'inertia = { value = "0.0025 kg m^2", provenance = "assumed" }', "",
         "missing-inertia", "0 is allowed"),
        ("planetary", 'connections = { sun = "sun", arm = "arm" }', 'connections = { sun = "sun" }',
         "no-carrier", "no third body"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(
    tmp_path: Path, study: str, old: str, new: str, code: str, named: str
) -> None:
    text = (STUDIES / f"{study}.toml").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / f"{study}.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    os.symlink(STUDIES / "engine", tmp_path / "engine")
    with raises(InputError, code, named):
        describe(load_study(path))


def test_too_few_hold(tmp_path: Path) -> None:
    """The arm of the excavator has three cylinders."""
    text = (STUDIES / "excavator.toml").read_text(encoding="utf-8")
    path = tmp_path / "arm.toml"
    old = 'kind = "static"\n'
    assert text.count(old) == 1
    path.write_text(text.replace(old, f'{old}hold = ["boom_cylinder"]\n'), encoding="utf-8")
    with raises(InputError, "hold-too-few", "2 more"):
        describe(load_study(path))

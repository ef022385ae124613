"""Mechanisms in study files: places by distances, bars, several drives, tables, and mistakes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pinstress import InputError, load_study, study_from
from pinstress.analysis.gather.gather import loads_only
from pinstress.study.model.cases import case_loads
from pinstress.study.model.mechanism.drives import laws
from pinstress.study.model.mechanism.linkage import linkage
from tests.conftest import ROOT
from tests.support.described import describe
from tests.support.each import each
from tests.support.errors import raises
from tests.support.study_text import study_file

STUDIES = ROOT / "studies"
BOWMAN = (STUDIES / "bowman2019.toml").read_text(encoding="utf-8").replace("bowman2019/", "")
CRANK = (STUDIES / "slider_crank.toml").read_text(encoding="utf-8")


def write(tmp_path: Path, text: str) -> Path:
    (tmp_path / "published.csv").write_bytes((STUDIES / "bowman2019/published.csv").read_bytes())
    return study_file(tmp_path, text)


def every_case(path: Path) -> None:
    study = load_study(path)
    drawn = linkage(study)
    for case in study.table.case:
        case_loads(study, case, drawn)


@each("name", ["bowman2019", "matrix_four_bar", "slider_crank", "kuleuven2014", "excavator"])
def test_every_study_that_ships_is_described(name: str) -> None:
    text, *_ = describe(load_study(STUDIES / f"{name}.toml"))
    assert "case " in text
    assert "pin " in text


def test_check_says_what_the_four_bar_is() -> None:
    text, *_ = describe(load_study(STUDIES / "bowman2019.toml"))
    assert "four-bar O2-A-B-O4: crank-rocker (Grashof), drawn open" in text
    assert "mobility 1;" in text


@each(
    ("text", "old", "new", "code", "named"),
    [
        (BOWMAN, "distances = [30, 26]", "distances = [3, 4]", "unreachable-point", "3 in and 4"),
        (BOWMAN, 'origins = ["A", "O4"]', 'origins = ["A", "B"]', "circular-positions", "at: "),
        (BOWMAN, 'origins = ["A", "O4"]', 'origins = ["A", "Q"]', "unknown-joint", "'Q'"),
        (BOWMAN, 'side = "left"', 'side = "up"', "not-a-choice", "at.side: "),
        (BOWMAN, 'angle = "315 deg"', "angle = 315", "missing-unit", "at.angle: 315"),
        (BOWMAN, 'line = ["O2", "A"]', 'line = ["O2", "X"]', "unknown-joint", "drive.line: "),
        (BOWMAN, 'body = "crank"', 'body = "krank"', "unknown-body", "'krank'"),
        (BOWMAN, 'velocity = "0.824 rad/s"', "velocity = 0.824", "missing-unit", "velocity: 0.824"),
        (BOWMAN, 'law = "cycloidal"', 'law = "cycloid"', "not-a-choice", "law: "),
        (BOWMAN, 'value = "360 deg"', 'value = "360 in"', "wrong-dimension", "not an angle"),
        (BOWMAN, 'position = "315 deg"', "position = { arm = 3 }", "unknown-drive", "position: "),
        (BOWMAN, 'line = ["O2", "A"]', 'line = ["O4", "B"]', "joint-not-on-body", "joint O4"),
        (BOWMAN, 'line = ["O2", "A"]', 'line = ["A", "A"]', "same-joint", "drive crank"),
        (BOWMAN, 'F14 = "ground"', 'F14 = "grund"', "unknown-body", "'grund'"),
        (BOWMAN, 'kind = "motion"', 'kind = "move"', "not-a-choice", ".kind: "),
        (CRANK, 'joints = ["O", "C"]', 'joints = ["A", "C"]', "joint-not-on-body", "joint A"),
        (CRANK, "duration = 0.25 ", "begin = -1\nduration = 0.25 ", "negative", "begin: "),
        (CRANK, 'duration = 0.25 ', "samples = 4", "unknown-key", "'samples'"),
        (CRANK, "direction = [1, 0]", "direction = [0, 0]", "no-direction", "direction: "),
        (CRANK, "section = [40, 20],", "", "give-one", ".bar: "),
        (CRANK, "direction = [1, 0]", "direction = [0, 1]", "dead-point", "crank"),
        (CRANK, 'law = "constant"', 'law = "table"', "law-and-keys", "drive"),
        (CRANK, 'end = "380 deg"', "", "law-and-keys", "drive"),
    ],
)  # fmt: skip
def test_each_mistake_is_told(
    tmp_path: Path, text: str, old: str, new: str, code: str, named: str
) -> None:
    assert old in text
    path = write(tmp_path, text.replace(old, new, 1))
    with raises(InputError, code, str(path), named):
        every_case(path)


def test_what_shows_when_parts_are_put_together_is_told_at_once(tmp_path: Path) -> None:
    """Of the mechanism, of two pins and of a table, each with its line; a part once."""
    text = CRANK
    for old, new in (
        ('line = ["O", "A"]', 'line = ["A", "A"]'),
        ('joints = ["O", "C"]', 'joints = ["A", "C"]'),
        ('connections = { C = "rod" }', 'connections = { C = "piston" }'),
        ("fillet = 3", "fillet = 30"),
        ('clamp = ["left", "right"]', 'clamp = ["lift", "light"]'),
        ("[mechanism]", '[case.more]\nkind = "given"\ntable = "gone.csv"\n\n[mechanism]'),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    path = write(tmp_path, text)
    with pytest.raises(InputError) as caught:
        describe(load_study(path))
    told = str(caught.value).splitlines()
    assert told[0] == f"{path}: 7 errors"
    for key, message in (
        ("[mechanism.drive]", "drive crank: "),
        ("[mechanism.slider.guide]", "slider guide: joint A is not on ground"),
        ('connections = { C = "piston" }', "pin C is fixed in piston"),
        ('  { length = 10, diameter = 30, name = "web" }', "pin O: the fillet"),
        ('clamp = ["lift"', "pin.C.clamp[1]: no surface 'lift'"),
        ('clamp = ["lift"', "pin.C.clamp[2]: no surface 'light'"),
    ):
        line = text[: text.index(key)].count("\n") + 1
        assert [t for t in told if t.startswith(f"{path}:{line}: ") and message in t], message
    assert [t for t in told if "gone.csv: no such file" in t]


def test_jamming_is_told_with_time_and_remedy() -> None:
    study = load_study(STUDIES / "slider_crank_jammed.toml")
    with raises(InputError, "friction-jams", "case.turn: ", "slider guide at t = "):
        case_loads(study, "turn", linkage(study))


def test_a_motion_needs_a_course(tmp_path: Path) -> None:
    text = CRANK
    for line in ('start = "20 deg"\n', 'end = "380 deg"\n'):
        text = text.replace(line, "")
    text = text.replace("duration = 0.25                       # 240 rpm\n", "")
    with raises(InputError, "drive-without-motion", "case.turn: "):
        load_study(write(tmp_path, text))


def test_a_drive_may_follow_a_table(tmp_path: Path) -> None:
    times = np.linspace(0.0, 0.25, 41)
    rows = "\n".join(f"{t},{20 + 360 * t / 0.25}" for t in times)
    (tmp_path / "turn.csv").write_text(f"time,position_deg\n{rows}\n", encoding="utf-8")
    text = CRANK.replace('law = "constant"', 'law = "table"\ntable = "turn.csv"')
    for line in ('start = "20 deg"\n', 'end = "380 deg"\n'):
        text = text.replace(line, "")
    text = text.replace("duration = 0.25                       # 240 rpm\n", "")
    study = load_study(write(tmp_path, text))
    (law,) = laws(study)
    _, rate, _ = law(np.array([0.1]))
    assert rate[0] == pytest.approx(2 * np.pi / 0.25)
    early = "\n".join(f"{t - 0.125},{20 + 360 * t / 0.25}" for t in times)
    (tmp_path / "turn.csv").write_text(f"time,position_deg\n{early}\n", encoding="utf-8")
    with raises(InputError, "negative", "turn.csv, line 2", "a motion begins at time 0"):
        laws(study)
    (tmp_path / "turn.csv").write_text("time,position\n0,1\n", encoding="utf-8")
    with raises(InputError, "missing-column", "turn.csv", "'position_deg'"):
        laws(study)


ARM = """
title = "arm"
units = "m-N-s"

[case.dig]
kind = "motion"
samples = 11

[case.held]
kind = "static"
position = { boom = "40 deg", stick = "-60 deg" }

[[mechanism.drive]]
body = "boom"
line = ["O", "P"]
start = "30 deg"
end = "50 deg"
duration = 1

[[mechanism.drive]]
body = "stick"
against = "boom"
against_line = ["O", "P"]
line = ["P", "Q"]
start = "-30 deg"
end = "-75 deg"
duration = 1
begin = 1

[mechanism.joint.O]
at = [0, 0]
fixed_in = "ground"
connections = { O = "boom" }

[mechanism.joint.P]
at = { origin = "O", distance = 2, angle = "30 deg" }
fixed_in = "boom"
connections = { P = "stick" }

[mechanism.joint.Q]
at = { origin = "P", distance = 1, angle = "0 deg" }
fixed_in = "stick"
connections = { Q = "load" }

[mechanism.body.boom]
bar = { joints = ["O", "P"], diameter = 0.1, density = 7850 }

[mechanism.body.stick]
bar = { joints = ["P", "Q"], diameter = 0.1, density = 7850 }

[mechanism.body.load]
mass = 50
"""


def test_two_drives_in_a_row(tmp_path: Path) -> None:
    """An arm of two bars: first the boom turns, then the stick against it."""
    study = load_study(write(tmp_path, ARM))
    found = case_loads(study, "dig", linkage(study)).dynamics
    assert found is not None
    angle = np.degrees(found.motion.drives)
    assert angle[0] == pytest.approx([30.0, -30.0])
    assert angle[5] == pytest.approx([50.0, -30.0])
    assert angle[-1] == pytest.approx([50.0, -75.0])
    q, _, _ = found.motion.joint("Q")
    wanted = 2 * np.exp(1j * np.radians(50)) + np.exp(-1j * np.radians(25))
    assert q[-1] @ [1.0, 1.0j] == pytest.approx(wanted)


def test_a_drive_too_many_and_a_loose_body_are_told(tmp_path: Path) -> None:
    second = """
[[mechanism.drive]]
body = "rocker"
line = ["O4", "B"]
start = "301 deg"
end = "302 deg"
duration = 5
"""
    text = BOWMAN.replace("[mechanism.drive] ", "[[mechanism.drive]] ") + second
    for case in ("position", "velocity", "acceleration"):
        lines = [x for x in text.splitlines() if not x.startswith(f"{case} = ")]
        text = "\n".join(lines) + "\n"
    with raises(InputError, "too-many-drives", "crank, rocker"):
        describe(load_study(write(tmp_path, text)))
    loose = BOWMAN + "\n[mechanism.body.spare]\nmass = 1\ncentre = [0, 0]\ninertia = 1\n"
    with raises(InputError, "not-joined", "spare"):
        describe(load_study(write(tmp_path, loose)))


@each(
    ("row", "message"),
    [
        ("snapshot,,angle,nobody,1,", "has no body 'nobody' with angle"),
        ("snapshot,,force_x,F99,1,", "has no connection 'F99' with force_x"),
        ("snapshot,,weight,crank,1,", "no quantity 'weight'; there are force_x"),
        ("snap,,angle,crank,1,", "line 2: the study has no case 'snap'"),
        ("snapshot,noon,angle,crank,1,", "time 'noon' is not a number"),
        ("turn,,angle,bead,1,", "has no body 'bead' with angle"),
    ],
)
def test_published_values_that_name_nothing(tmp_path: Path, row: str, message: str) -> None:
    bead = "\n[mechanism.body.bead]\nmass = 1\n"
    text = BOWMAN.replace(
        'connections = { F12 = "crank" }', 'connections = { F12 = "crank", Z = "bead" }'
    )
    path = write(
        tmp_path,
        text.replace("[case.snapshot]", '[case.turn]\nkind = "motion"\n\n[case.snapshot]') + bead,
    )
    head = "case,time,quantity,name,published,reason"
    (tmp_path / "published.csv").write_text(f"{head}\n{row}\n", encoding="utf-8")
    with pytest.raises(InputError, match=message):
        loads_only(load_study(path))


@each("samples", [2, 6, 201])
def test_published_values_are_set_beside_those_of_their_own_time(
    tmp_path: Path, samples: int
) -> None:
    """Not of the nearest sample: with two, all would be those of an end."""
    gear = (STUDIES / "grenier2008.toml").read_text(encoding="utf-8")
    assert "samples = 201" in gear
    text = gear.replace("samples = 201", f"samples = {samples}")
    path = tmp_path / "gear.toml"
    path.write_text(text.replace('"grenier2008/', f'"{STUDIES}/grenier2008/'), encoding="utf-8")
    check = loads_only(load_study(path), ["retract"]).motion_check
    assert check is not None
    found = {t: (v, a) for t, _, _, v, a in check.published}
    assert found[1.4] == pytest.approx((4.2827, 2.7672), rel=1e-2)
    assert found[3.1] == pytest.approx((5.5502, 3.1508), rel=1e-2)


def test_a_published_time_that_the_motion_does_not_reach_is_refused(tmp_path: Path) -> None:
    table = (STUDIES / "bowman2019" / "published.csv").read_text(encoding="utf-8")
    head, first, *_ = table.splitlines()
    cells = first.split(",")
    cells[head.split(",").index("case")] = "retract"
    cells[head.split(",").index("time")] = "50"
    (tmp_path / "late.csv").write_text(f"{head}\n{','.join(cells)}\n", encoding="utf-8")
    path = write(tmp_path, BOWMAN.replace('"published.csv"', '"late.csv"'))
    with pytest.raises(InputError, match=r"late\.csv, line 2: case retract has no time 50"):
        loads_only(load_study(path))


def test_the_direction_of_a_slider_may_have_any_length() -> None:
    assert CRANK.count("direction = [1, 0]") == 1
    long = study_from(CRANK.replace("direction = [1, 0]", "direction = [1e308, 0]"))
    assert linkage(long).sliders[0].axis == (1.0, 0.0)

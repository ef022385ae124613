"""Duty cycles: cases on one time axis, from what is known of each; nothing is solved again."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import pinstress
from pinstress.analysis.gather.gather import loads_only
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import load_study
from reports.data.results import Results
from reports.format.numbers import engineering
from tests.conftest import ROOT
from tests.support.described import describe
from tests.support.each import each
from tests.support.errors import raises

DUTY = """
[case.locked]
kind = "static"
hold = ["brake"]
[[case.locked.apply]]
body = "arm"
couple = "-900 N m"

[mechanism.stop.brake]
bodies = ["ground", "arm"]

[sequence.shift]
steps = [{ case = "lift", repeat = 2 }, { case = "locked", duration = "6 s" }, { case = "lift" }]
"""
TURNED = 'steps = [{ case = "test_load", duration = "1 s" }, { case = "turned", duration = "1 s" }]'


def hoist(tmp_path: Path, more: str = DUTY) -> Path:
    path = tmp_path / "hoist.toml"
    shipped = (ROOT / "studies" / "planetary.toml").read_text(encoding="utf-8")
    path.write_text(shipped.replace("samples = 121", "samples = 11") + more, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Results:
    path = hoist(tmp_path_factory.mktemp("hoist"))
    return loads_only(load_study(path))


def test_forces_follow_each_other_on_one_axis(found: Results) -> None:
    lift, locked, shift = (
        next(t for t in found.reactions if t.case == c) for c in ("lift", "locked", "shift")
    )
    own = lift.times
    assert own is not None
    assert shift.times == pytest.approx([*own, *(own + 3.0), 6.0, 12.0, *(own + 12.0)])
    parts = (lift, lift, locked, locked, lift)
    assert np.array_equal(shift.forces, np.concatenate([t.forces for t in parts]))
    for c, peak in enumerate(shift.largest):
        most = max(lift.largest[c].force, locked.largest[c].force)
        assert peak.force == most
        if most == lift.largest[c].force:
            assert peak.time == lift.largest[c].time  # in its first occurrence


def test_drives_over_the_cycle(found: Results) -> None:
    """The motor works in 9 of 15 s, the brake holds 900 N m in the other six."""
    drives = {(d.case, d.name): d for d in found.drive}
    motor, brake, alone = (drives[x] for x in (("shift", "motor"), ("shift", "brake"),
                                               ("lift", "motor")))  # fmt: skip
    assert motor.mean == pytest.approx(9.0 / 15.0 * alone.mean)
    assert motor.rms == pytest.approx(math.sqrt(9.0 / 15.0) * alone.rms)
    assert (motor.largest, motor.stroke) == (alone.largest, alone.stroke)
    assert motor.work[-1] == pytest.approx(3.0 * alone.work[-1])
    raised = 900e3 * 24.0 * math.pi / 4.0  # N mm: the drum's work, gravity and inertia make none
    assert alone.work[-1] == pytest.approx(raised, rel=1e-6)
    assert brake.rms == pytest.approx(math.sqrt(6.0 / 15.0) * 900e3)
    assert brake.mean == pytest.approx(6.0 / 15.0 * 900e3)
    assert np.isnan(brake.position[:22]).all()
    note = next(t.note for t in found.reactions if t.case == "shift")
    assert "15 s" in note
    assert f"motor {engineering(3.0 * raised)} N mm, brake 0 N mm" in note


def test_a_linkage_that_jumps_is_named(tmp_path: Path) -> None:
    """The sun turned by 90 degrees moves the planets; after 12 turns they are where they were."""
    more = (
        DUTY
        + f"""
[case.turned]
kind = "static"
position = "90 deg"
[sequence.other]
{TURNED}
"""
    )
    results = loads_only(load_study(hoist(tmp_path, more)))
    notes = {t.case: t.note for t in results.reactions}
    assert "jumps between test_load and turned" in notes["other"]
    assert "jumps" not in notes["shift"]


ARM = """
title = "An arm whose steps have other loads"
units = "m-N-s"
[mechanism.drive]
body = "arm"
start = "0 deg"
end = "90 deg"
duration = 2
[mechanism.joint.O]
at = [1, 2]
fixed_in = "ground"
connections = { O = "arm" }
friction = 0.1
diameter = 0.2
[mechanism.body.arm]
mass = 10
centre = [1.5, 2.0]
inertia = 1
[case.loaded]
kind = "motion"
samples = 5
apply = [{ body = "arm", at = [4, 6], force = [30, -40] }]
[case.empty]
kind = "static"
position = "180 deg"
[case.held]
kind = "static"
apply = [{ body = "arm", at = [2, 2], force = [0, -5000] }, { body = "arm", force = [0, 0, 7] }]
[sequence.first]
steps = [{ case = "loaded" }, { case = "empty", duration = 1 }, { case = "held", duration = 1 }]
[sequence.last]
steps = [{ case = "empty", duration = 1 }, { case = "held", duration = 1 }, { case = "loaded" }]
"""


def test_every_load_of_a_sequence_acts_in_its_own_steps(tmp_path: Path) -> None:
    """Whichever step comes first: its force is zero in the others, where its point, carried by the
    arm, is its drawn arm from O turned by the angle. At rest nothing rubs: the largest force
    without friction is that of the case at rest, which is larger than those of the motion.
    """
    path = tmp_path / "arm.toml"
    path.write_text(ARM, encoding="utf-8")
    found = loads_only(load_study(path))
    turned = {"loaded": [*found.motion[0].angle[:, 0]], "empty": [180.0] * 2, "held": [0.0] * 2}
    for name, order in (
        ("first", ("loaded", "empty", "held")),
        ("last", ("empty", "held", "loaded")),
    ):
        motion = next(m for m in found.motion if m.case == name)
        angles = np.radians(np.concatenate([turned[case] for case in order]))
        cases = np.concatenate([[case] * len(turned[case]) for case in order])
        (aside,) = motion.aside
        by_case = {"loaded": (3 + 4j, [30.0, -40.0]), "held": (1 + 0j, [0.0, -5000.0])}
        assert len(motion.applied) == 2
        for load in (*motion.applied, aside):
            (case,) = set(cases[load.sizes > 0.0])
            drawn, force = (0.5 + 0j, [0.0, 0.0, 7.0]) if load is aside else by_case[case]
            at = 1 + 2j + drawn * np.exp(1j * angles)
            assert load.position == pytest.approx(np.stack([at.real, at.imag], axis=1))
            assert load.force == pytest.approx(np.outer(cases == case, force))
        drive = next(d for d in found.drive if d.case == name)
        assert drive.effort is not None
        assert drive.effort.frictionless == drive.largest == pytest.approx(5000 + 98.0665 / 2)
        (table,) = (t for t in found.reactions if t.case == name)
        assert table.largest[0].frictionless == table.largest[0].force == pytest.approx(5098.0665)


def test_drives_over_a_sequence_in_space_are_those_in_the_plane(tmp_path: Path) -> None:
    in_plane, in_space = tmp_path / "plane.toml", tmp_path / "space.toml"
    in_plane.write_text(ARM, encoding="utf-8")
    solid = (
        ARM.replace('body = "arm"\nstart', 'joint = "O"\nstart')
        .replace("[mechanism.drive]", "[mechanism]\ndimension = 3\n[mechanism.drive]")
        .replace("[mechanism.drive]", 'gravity = [0, "-9.80665 m/s^2", 0]\n[mechanism.drive]')
        .replace("at = [1, 2]", "at = [1, 2, 0]\naxis = [0, 0, 1]")
        .replace("[1.5, 2.0]\ninertia = 1", "[1.5, 2.0, 0]\ninertia = [1, 1, 1]")
        .replace("[4, 6], force = [30, -40]", "[4, 6, 0], force = [30, -40, 0]")
        .replace("[2, 2], force = [0, -5000]", "[2, 2, 0], force = [0, -5000, 0]")
    )
    in_space.write_text(solid, encoding="utf-8")
    flat, deep = (loads_only(load_study(path)) for path in (in_plane, in_space))
    for name in ("first", "last"):
        a, b = (next(d for d in found.drive if d.case == name) for found in (flat, deep))
        for key in ("time", "position", "force", "power", "work"):
            assert getattr(a, key) == pytest.approx(getattr(b, key), abs=1e-9)
        for key in ("largest", "mean", "rms", "stroke"):
            assert getattr(a, key) == pytest.approx(getattr(b, key))
        notes = [next(t.note for t in f.reactions if t.case == name) for f in (flat, deep)]
        assert "Work per cycle: O " in notes[1]
        assert notes[1].split("O ")[1].split(" N")[0] == notes[0].split("arm ")[1].split(" N")[0]


SPEC = """
title = "Bent to and fro"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "700 MPa"
[material.steel.fatigue]
knee_stress = "100 MPa"
knee_cycles = 1e6
slope = 5
slope_below = 5
mean_stress = "none"
[pin.P]
material = "steel"
clamp = ["start"]
profile = [{ length = 30, diameter = 16 }, { length = 10, diameter = 16, connection = "B" }]
[analysis]
model = "beam"
[case.up]
kind = "given"
forces = { B = [0, 1000] }
[case.down]
kind = "given"
forces = { B = [0, -600] }
[sequence.to_and_fro]
steps = [{ case = "up", duration = 1, repeat = 2 }, { case = "down", duration = 2 }]
[fatigue]
unit = "hour"
occurrences = { to_and_fro = 10 }
"""


def test_fatigue_of_a_sequence_has_no_zero_between_its_steps(tmp_path: Path) -> None:
    """A sequence is one cycle from +S to -0.6 S: amplitude 0.8 S; apart they would be pulses."""
    path = tmp_path / "bent.toml"
    path.write_text(SPEC, encoding="utf-8")
    results = pinstress.run(load_study(path))
    assert {p.case for p in results.pins} == {"up", "down"}
    history = results.histories[0]
    by_case = {c.case: c for c in history.cases}
    joined = by_case["to_and_fro"]
    assert joined.times == pytest.approx([0.0, 1.0, 1.0, 2.0, 2.0, 4.0])
    up, down = by_case["up"].signed[0], by_case["down"].signed[0]
    assert joined.signed == pytest.approx([up] * 4 + [down] * 2)
    assert results.fatigue is not None
    worst = results.fatigue.points[0]
    amplitude = abs(up - down) / 2.0
    assert worst.amplitude == pytest.approx(amplitude)
    assert worst.damage == pytest.approx(10.0 * (amplitude / 100.0) ** 5 / 1e6)


@each(
    ("old", "new", "code", "named"),
    [
        ('case = "locked", ', 'case = "unlocked", ', "unknown-case", "steps[2].case"),
        (', duration = "6 s"', "", "missing-key", "duration"),
        ('"lift", repeat = 2', '"lift", duration = 2', "key-not-applicable", "own time"),
        ("repeat = 2", "repeat = 0", "out-of-range", "at least 1"),
        ("[sequence.shift]", "[sequence.lift]", "duplicate-case", "rename"),
        ('kind = "static"\nhold = ["brake"]', 'kind = "instant"', "not-in-sequences", "instant"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, old: str, new: str, code: str, named: str) -> None:
    assert old in DUTY
    with raises(InputError, code, named):
        describe(load_study(hoist(tmp_path, DUTY.replace(old, new, 1))))


def test_a_sequence_is_named_as_the_study_writes_it(tmp_path: Path) -> None:
    text = DUTY.replace("sequence.shift", 'sequence."long shift"').replace(', duration = "6 s"', "")
    with raises(InputError, "missing-key", 'sequence."long shift".steps[2]: '):
        describe(load_study(hoist(tmp_path, text)))


def test_a_sequence_that_is_chosen_brings_its_cases(tmp_path: Path) -> None:
    study = load_study(hoist(tmp_path))
    assert {t.case for t in loads_only(study, cases=["shift"]).reactions} == {
        "lift", "locked", "shift",
    }  # fmt: skip
    assert {t.case for t in loads_only(study, cases=["lift"]).reactions} == {"lift"}


def test_check_names_the_steps_and_finds_those_without_a_duration(tmp_path: Path) -> None:
    assert (
        "sequence shift: 2 × lift, 1 × locked, 1 × lift" in describe(load_study(hoist(tmp_path)))[0]
    )
    path = tmp_path / "bent.toml"
    path.write_text(SPEC.replace(", duration = 2", ""), encoding="utf-8")
    with raises(InputError, "give-one", "steps[2]", "give its duration"):
        describe(load_study(path))

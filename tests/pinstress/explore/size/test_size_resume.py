"""A size that is interrupted keeps its finished pins, and goes on without solving them again."""

from __future__ import annotations

import re
import signal
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from pinstress.analysis.plan import prepare
from pinstress.analysis.results import run
from pinstress.explore.size import least_weight as lightest_module
from pinstress.explore.size import size_pins as module
from pinstress.explore.size.lightest_pin import Lightest, lightest_pin
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.size_pin import MAX_FULL, SizingGoal, SizingResult, size_pin
from pinstress.explore.size.size_pins import changes_of_load, loaded_more
from pinstress.explore.size.size_state import PINS_FILE, FinishedPins, SizeState
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import load_study
from reports.data.decision import factor_ends
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import QUICK, run_here
from tests.support.programs.process_group import started
from tests.support.programs.signals import signals_heard

NAMES = "BCDE"
PATIENCE = 300.0  # s, for the first pin


def several(names: str = NAMES) -> str:
    """The quick study with pins of several sizes, each under a force of its own."""
    head, pin, tail = re.split(r"(?=\[pin\.B\])|(?=\[case)", QUICK)
    pins = []
    for k, name in enumerate(names):
        wide = pin.replace("diameter = 4.0", f"diameter = {4.0 + 0.1 * k}")
        pins.append(wide.replace("pin.B", f"pin.{name}").replace('"B"', f'"{name}"'))
    forces = ", ".join(f"{name} = [0.0, -{900 + 50 * k}.0]" for k, name in enumerate(names))
    return head + "".join(pins) + re.sub(r"forces = \{.*?\}", f"forces = {{ {forces} }}", tail)


def calls(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The pins that are solved from now on."""
    solved: list[str] = []

    def counted(plan: Any, pin: str, *others: Any) -> SizingResult:
        solved.append(pin)
        return size_pin(plan, pin, *others)

    monkeypatch.setattr(module, "size_pin", counted)
    return solved


@pytest.mark.long
@pytest.mark.slow
def test_an_interrupted_size_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a process of its own, which is interrupted once its first pin is written: finished pins
    are in the new study; with --resume only the others are solved, and the new study is that of a
    size in one go.
    """
    (tmp_path / "study.toml").write_text(several())
    target, state = tmp_path / "study_sized.toml", tmp_path / "study_sized.toml.unfinished"
    command = [sys.executable, "-m", "pinstress", "size", "study.toml", "--jobs", "1"]
    with started(command, cwd=tmp_path, stderr=-1, stdout=-1) as process:
        deadline = time.monotonic() + PATIENCE
        while not target.exists() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate()
    assert process.returncode == 130, err
    assert out == ""
    match = re.search(r"(\d) pins? (?:is|are) kept: run the same command with --resume", err)
    assert match is not None, err
    finished = NAMES[: int(match[1])]
    assert 0 < len(finished) < len(NAMES)
    assert state.exists()
    old, now = load_study(tmp_path / "study.toml"), load_study(target)
    changed = [n for n in NAMES if now.table.pin[n].diameters != old.table.pin[n].diameters]
    assert "".join(changed) == finished

    refused = run_here("size", "study.toml", cwd=tmp_path)
    assert refused.returncode == 2
    assert "has a size that did not end: resume it with --resume" in refused.stderr

    solved = calls(monkeypatch)
    resumed = run_here("size", "study.toml", "--jobs", "1", "--resume", cwd=tmp_path)
    assert resumed.returncode == 0, resumed.stderr
    assert "".join(solved) == NAMES[len(finished) :]
    assert resumed.stdout.count(" safe ") == len(NAMES)
    assert not state.exists()
    whole = run_here("size", "study.toml", "--jobs", "1", "--out", "whole.toml", cwd=tmp_path)
    assert whole.returncode == 0
    assert target.read_bytes() == (tmp_path / "whole.toml").read_bytes()
    assert resumed.stdout == whole.stdout
    # what was said to reach the factor does in a run
    for row in run(load_study(target)).pins:
        assert factor_ends(row)[0] >= 10.0


@pytest.mark.seconds
def test_an_interrupted_search_of_the_lightest_pins_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Searches that ended are not made again, and the new study is that of a command in one go."""
    (tmp_path / "study.toml").write_text(several("BC"))
    searched: list[str] = []

    def counted(study: Any, plan: Any, pin: str, *others: Any) -> Lightest:
        searched.append(pin)
        return lightest_pin(study, plan, pin, *others)

    def interrupted(study: Any, plan: Any, pin: str, *others: Any) -> Lightest:
        if searched:
            signal.raise_signal(signal.SIGINT)
        return counted(study, plan, pin, *others)

    command = "size", "study.toml", "--least-weight", "--jobs", "1"
    monkeypatch.setattr(lightest_module, "lightest_pin", interrupted)
    with signals_heard():
        first = run_here(*command, cwd=tmp_path)
    assert first.returncode == 130
    assert "1 search is kept: run the same command with --resume to continue" in first.stderr
    target = tmp_path / "study_sized.toml"
    assert not target.exists()
    refused = run_here(*command, cwd=tmp_path)
    assert "has a size that did not end: resume it with --resume" in refused.stderr

    monkeypatch.setattr(lightest_module, "lightest_pin", counted)
    resumed = run_here(*command, "--resume", cwd=tmp_path)
    assert resumed.returncode == 0, resumed.stderr
    assert searched.count(searched[0]) == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == ["study.toml", target.name]
    whole = run_here(*command, "--out", "whole.toml", cwd=tmp_path)
    assert target.read_bytes() == (tmp_path / "whole.toml").read_bytes()
    assert resumed.stdout == whole.stdout


@each(
    ("option", "printed"),
    [([], "pinstress.cli.size.print_sizes"),
     (["--least-weight"], "pinstress.cli.least_weight.print_light")],
)  # fmt: skip
def test_an_interrupt_after_the_study_is_written_leaves_nothing_to_resume(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, option: list[str], printed: str
) -> None:
    """It was said that nothing was written, or that searches are kept for --resume."""
    (tmp_path / "study.toml").write_text(QUICK)
    monkeypatch.setattr(printed, lambda *_: signal.raise_signal(signal.SIGINT))
    with signals_heard():
        stopped = run_here("size", "study.toml", *option, "--jobs", "1", cwd=tmp_path)
    assert (stopped.returncode, stopped.stderr.splitlines()[-1]) == (
        130,
        "Interrupted; study_sized.toml is written.",
    )
    assert sorted(p.name for p in tmp_path.iterdir()) == ["study.toml", "study_sized.toml"]


def test_a_search_that_was_killed_after_it_wrote_the_study_is_resumed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Unless the new study was edited, which is then kept."""
    (tmp_path / "study.toml").write_text(QUICK)
    target = tmp_path / "study_sized.toml"
    command = "size", "study.toml", "--least-weight", "--jobs", "1"
    with monkeypatch.context() as killed:
        killed.setattr(SizeState, "end", lambda _: None)
        assert run_here(*command, cwd=tmp_path).returncode == 0
    new = target.read_text()
    target.write_text(new + "# mine\n")
    refused = run_here(*command, "--resume", cwd=tmp_path)
    assert refused.returncode == 2
    assert "study_sized.toml exists already" in refused.stderr
    target.write_text(new)
    resumed = run_here(*command, "--resume", cwd=tmp_path)
    assert resumed.returncode == 0, resumed.stderr
    assert target.read_text() == new
    assert sorted(p.name for p in tmp_path.iterdir()) == ["study.toml", "study_sized.toml"]


def test_what_cannot_be_resumed_is_told(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(several("B"))
    nothing = run_here("size", "study.toml", "--resume", cwd=tmp_path)
    assert nothing.returncode == 2
    assert "there is no size of study_sized.toml to resume" in nothing.stderr
    state = SizeState[SizingResult](tmp_path / "study_sized.toml", "another", FinishedPins)
    state.begin()
    for option in ([], ["--resume"]):
        busy = run_here("size", "study.toml", *option, cwd=tmp_path)
        assert busy.returncode == 2
        assert "another size is writing study_sized.toml; wait for it" in busy.stderr
    state.close()
    other = run_here("size", "study.toml", "--resume", cwd=tmp_path)
    assert other.returncode == 2
    assert "is of another study, factor, step or pins" in other.stderr
    whole = (state.path / PINS_FILE).read_bytes()
    at = whole.index(b"PK\1\2")  # the entry of a file in it, with its flags and its compression
    for byte, value in ((0, 0), (at + 8, 1), (at + 10, 99)):
        (state.path / PINS_FILE).write_bytes(whole[:byte] + bytes([value]) + whole[byte + 1 :])
        damaged = run_here("size", "study.toml", "--resume", cwd=tmp_path)
        assert damaged.returncode == 2
        assert "is damaged" in damaged.stderr
    assert not (tmp_path / "study_sized.toml").exists()


def test_a_link_is_no_state(tmp_path: Path) -> None:
    """Nor is it followed."""
    (tmp_path / "study.toml").write_text(QUICK)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "study_sized.toml.unfinished").symlink_to(tmp_path / "elsewhere")
    for option, told in (([], "delete study_sized.toml.unfinished"), (["--resume"], "is damaged")):
        refused = run_here("size", "study.toml", "--fos", "1.5", *option, cwd=tmp_path)
        assert refused.returncode == 2
        assert told in refused.stderr
    assert not list((tmp_path / "elsewhere").iterdir())


def test_a_file_that_cannot_be_written_is_named_as_it_was_given(tmp_path: Path) -> None:
    """Names have 255 bytes, which leaves too few for the folder of finished pins."""
    (tmp_path / "study.toml").write_text(QUICK)
    name = "n" * 245 + ".toml"
    made = run_here("size", "study.toml", "--fos", "1.5", "--out", name, cwd=tmp_path)
    assert made.returncode == 2
    assert made.stderr == (
        f"Error: {name}: cannot be written (File name too long); pins that are done would be kept "
        f"beside it, in {name}.unfinished\n"
    )
    assert [p.name for p in tmp_path.iterdir()] == ["study.toml"]


def test_a_long_name_leaves_room_for_the_finished_pins(tmp_path: Path) -> None:
    """Of 238 characters: the file beside it in which they were written had a longer one."""
    (tmp_path / "study.toml").write_text(QUICK)
    name = "n" * 233 + ".toml"
    made = run_here("size", "study.toml", "--fos", "1.5", "--out", name, cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == [name, "study.toml"]


def test_a_new_study_that_was_edited_is_not_overwritten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of two pins the first is written, the second fails with an error of the study."""
    (tmp_path / "study.toml").write_text(several("BC"))

    def failing(plan: Any, pin: str, *others: Any) -> SizingResult:
        if pin == "C":
            raise InputError("no second pin", code="test")
        return size_pin(plan, pin, *others)

    monkeypatch.setattr(module, "size_pin", failing)
    first = run_here("size", "study.toml", "--jobs", "1", cwd=tmp_path)
    assert first.returncode == 2
    assert "1 pin is kept: run the same command with --resume to continue" in first.stderr
    target = tmp_path / "study_sized.toml"
    edited = target.read_text() + "# mine\n"
    target.write_text(edited)
    again = run_here("size", "study.toml", "--jobs", "1", "--resume", cwd=tmp_path)
    assert again.returncode == 2
    assert "has changed since it was written" in again.stderr
    assert target.read_text() == edited


def test_a_state_is_read_as_it_was_written(tmp_path: Path) -> None:
    result = SizingResult("B", 1.5, 2.0, float("inf"), "converged", others=(("C", 2.0),))
    state = SizeState[SizingResult](tmp_path / "x.toml", "this", FinishedPins)
    state.begin()
    state.write((result,))
    assert state.read() == (result,)


def test_progress_counts_pins_and_trials(tmp_path: Path) -> None:
    """And no pin takes more full solutions than it may."""
    (tmp_path / "study.toml").write_text(several("BC"))
    plan = prepare(load_study(tmp_path / "study.toml"))
    told: list[str] = []
    result = size_pin(plan, "C", SizingGoal(10.0), {}, "pin 2 of 2", told.append)
    assert result.scale is not None
    assert 1 <= result.full <= MAX_FULL
    for k in range(1, result.trials + 1):
        assert any(line.startswith(f"pin 2 of 2, trial {k} (") for line in told)


def test_loads_that_follow_from_weights_of_pins() -> None:
    """In landing, pins of the publication weigh nothing beside an impact; raised, they do: a pin
    that just reaches its factor as it is alone, is sized again with the others.
    """
    study = load_study(ROOT / "studies" / "grenier2008.toml")
    plan = prepare(study, pins=["J", "E"])
    new = resized_study(study, {"J": 3.0, "E": 3.0})
    alone = resized_study(study, {"E": 3.0})
    loads = [prepare(x, pins=["E"]).loads for x in (alone, new)]
    change = changes_of_load(study, "E", *loads)
    assert change["landing"] < 1e-3
    assert change["retract"] > 0.05
    goal = SizingGoal(10.0)

    def result(pin: str, retract: float) -> SizingResult:
        from pinstress.explore.size.judged_pin import JudgedPin

        judged = JudgedPin("", "landing", "", "", "safe", (("retract", retract), ("landing", 10.1)))
        return SizingResult(pin, 3.0, 2.0, 10.1, "converged", judged=judged)

    assert loaded_more(plan, goal, [result("J", 1e3), result("E", 1e3)]) == []
    assert "E" in loaded_more(plan, goal, [result("J", 1e3), result("E", 10.1)])
    assert loaded_more(plan, goal, [result("E", 10.1)]) == []


def test_a_size_that_was_killed_before_it_had_begun_begins_again(tmp_path: Path) -> None:
    """Its folder is empty, or has the file in which the finished pins were to be written."""
    (tmp_path / "study.toml").write_text(QUICK)
    state = tmp_path / "study_sized.toml.unfinished"
    state.mkdir()
    (state / ".pins.partial").write_bytes(b"PK")
    command = "size", "study.toml", "--fos", "1.5"
    nothing = run_here(*command, "--resume", cwd=tmp_path)
    assert nothing.returncode == 2
    assert "there is no size of study_sized.toml to resume" in nothing.stderr
    made = run_here(*command, cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["study.toml", "study_sized.toml"]

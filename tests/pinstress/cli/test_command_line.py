"""The command line when something is wrong or ends it: message, exit status, what it leaves."""

from __future__ import annotations

import json
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from geometry import Pin
from pinstress.cli.commands import commands, run_command_line
from pinstress.cli.output_folder import replacing
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.shipped import shipped
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import ONE_PIN, QUICK, run_here
from tests.support.programs.process_group import started


def two_pins(text: str) -> str:
    """The study with a second pin, C, a tenth thicker, under the same force."""
    head, rest = text.split("[pin.B]")
    pin, case = rest.split("[case.landing]")
    other = pin.replace('"B"', '"C"').replace("2.0, connection", "2.2, connection")
    case = case.replace("{ B = [0.0, -988.86] }", "{ B = [0.0, -988.86], C = [0.0, -988.86] }")
    return f"{head}[pin.B]{pin}[pin.C]{other}[case.landing]{case}"


@each(
    ("arguments", "change", "message"),
    [
        (["study.toml", "--pins", "Q"], ("", ""), "--pins: the study has no pin 'Q'"),
        (["study.toml", "--cases", "lading"], ("", ""), "did you mean 'landing'?"),
        (
            ["study.toml", "--model", "harmonic"],
            ("fillet = 0.4", "hole = [{ z = 2.5, diameter = 0.2 }]\nfillet = 0.4"),
            "pin B is not a body of revolution, which the harmonic model needs: use auto or solid",
        ),
        (["study.toml", "--model", "shell"], ("", ""), "'shell' is not one of 'auto', 'beam'"),
        (["study.toml"], ("tolerance = 0.05", 'goal = "guess"'), "'value' or 'decide'"),
        (["study.toml"], ("tolerance = 0.05", "excluded_distance = 0.6"), "excluded_distance"),
        (["study.toml", "--tolerance", "2"], ("", ""), "--tolerance"),
        (["gone.toml"], ("", ""), "gone.toml: no such file"),
        (["study.toml"], ("fillet = 0.4", "fillet = 4"), "pin B: the fillet between"),
        (["study.toml"], ("-988.86", "nan"), "must be finite, not nan"),
        (["study.toml"], ('["start"]', '["B"]'), "no load acts on it"),
        (["study.toml"], ("forces = { B = [0.0, -988.86] }", 'table = "t.csv"'), "t.csv"),
        (["study.toml"], ('distribution = "uniform"', 'distribution = "sine"'), "cosine"),
    ],
)
def test_bad_input_is_one_message_and_nothing_written(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    change: tuple[str, str],
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(ONE_PIN.replace(*change) if change[0] else ONE_PIN)
    Path("t.csv").write_text("connection,fx,fy\nX1,0,1\n")
    before = sorted(p.name for p in tmp_path.iterdir())
    assert run_command_line(["run", *arguments]) == 2
    said = capsys.readouterr()
    assert message in said.err
    assert said.out == ""
    assert "Traceback" not in said.err
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_a_pin_that_nothing_holds_is_rigid(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(ONE_PIN.replace('clamp = ["start"]', "clamp = []"))
    assert run_command_line(["run", "study.toml", "--no-pictures"]) == 1
    assert "the pin is not clamped" in capsys.readouterr().err
    (pin,) = json.loads(Path("out/study/results.json").read_text())["pins"]
    assert pin["verdict"] == "rigid"
    assert pin["max_von_mises"] is None
    assert pin["safety_factor"] is None


def test_init_follows_no_link(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Not even one that leads nowhere yet."""
    (tmp_path / "one_pin.toml").symlink_to(tmp_path / "home.toml")
    assert run_command_line(["init", str(tmp_path)]) == 2
    assert "one_pin.toml exists already" in capsys.readouterr().err
    assert not (tmp_path / "home.toml").exists()
    assert not (tmp_path / "pin_in_lugs.toml").exists()


def test_init_writes_studies_and_does_not_overwrite_them(tmp_path: Path) -> None:
    done = run_here("init", "new", cwd=tmp_path)
    assert done.returncode == 0
    assert [Path(line).name for line in done.stdout.split()] == ["pin_in_lugs.toml", "one_pin.toml"]
    assert (tmp_path / "new" / "one_pin.toml").read_text() == ONE_PIN
    first = tmp_path / "new" / "pin_in_lugs.toml"
    assert first.read_bytes() == shipped("pin_in_lugs.toml").read_bytes()
    again = run_here("init", "new", cwd=tmp_path)
    assert again.returncode == 2
    assert "exists already" in again.stderr


def test_init_takes_no_name_of_a_study_for_a_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command_line(["init", str(tmp_path / "mine.toml")]) == 2
    assert "name a folder; the studies are called pin_in_lugs.toml" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("folder", ["my trial", "ä's", "-new"])
def test_a_shell_takes_the_command_that_init_prints(folder: str, tmp_path: Path) -> None:
    (line,) = run_here("init", "--", folder, cwd=tmp_path).stderr.splitlines()
    command = shlex.split(line.removeprefix("Next: ").partition("  (")[0])
    done = run_here("check", *command[2:], cwd=tmp_path)
    assert done.returncode == 0, done.stderr


def test_check_says_what_would_be_run(tmp_path: Path) -> None:
    done = run_here("check", str(ROOT / "studies" / "grenier2008.toml"), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert any("D1, D2, G1, G3 follow the sharing rule" in line for line in lines)
    assert any(line.startswith("case retract: motion, 201 instants over 4 s") for line in lines)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("study", "status", "unheld"),
    [("one_pin", 0, False), ("clevis", 0, False), ("failures/free_pin", 1, True)],
)
def test_check_reports_a_pin_that_nothing_holds(study: str, status: int, unheld: bool) -> None:
    """As `run` would: exit status 1 and not decided."""
    done = run_here("check", str(ROOT / "studies" / f"{study}.toml"), cwd=ROOT)
    assert done.returncode == status
    assert ("unconstrained in case" in done.stderr) is unheld


def test_schema_is_json_and_knows_every_table() -> None:
    done = run_here("schema", cwd=ROOT)
    made = json.loads(done.stdout)
    assert {"title", "units", "case"} <= set(made["required"])
    assert {"material", "pin", "mechanism"} <= set(made["properties"])
    assert "mechanism" in made["properties"]


def test_every_command_is_listed_once_in_a_section(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["--help"]) == 0
    said = capsys.readouterr().out
    listed = re.findall(r"^  ([\w-]+) {2,}\S", said.partition("Studies:")[2], re.M)
    assert sorted(listed) == sorted(commands.commands)
    assert said.index("Analysis:") < said.index("  run ") < said.index("Earlier runs:")


def test_without_a_command_the_help_is_whole(capsys: pytest.CaptureFixture[str]) -> None:
    """It was cut in its middle, like a message that is too long."""
    assert run_command_line(["--help"]) == 0
    whole = capsys.readouterr().out
    assert run_command_line([]) == 2
    assert capsys.readouterr().err.strip() == whole.strip()


@each(
    "command",
    [
        "run",
        "loads",
        "chart",
        "check",
        "export",
        "import",
        "init",
        "schema",
        "size",
        "view",
        "completion",
    ],
)
def test_help_begins_with_an_example(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line([command, "--help"]) == 0
    body = capsys.readouterr().out.split("\n\n")[1]
    assert body.strip().startswith(f"Example: pinstress {command}")


def test_an_interrupt_leaves_nothing_behind(tmp_path: Path) -> None:
    slow = ONE_PIN.replace("tolerance = 0.05", 'model = "solid"\ntolerance = 0.001')
    (tmp_path / "study.toml").write_text(slow)
    earlier = tmp_path / "out" / "study"
    with replacing(earlier) as staging:
        (staging / "results.json").write_text("{}")
    command = [sys.executable, "-m", "pinstress", "run", "study.toml"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with started(command, cwd=tmp_path, **pipes) as process:
        deadline = time.monotonic() + 60.0
        while not list((tmp_path / "out").glob(".study.*")):
            assert time.monotonic() < deadline  # until it has begun to write
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=120)
    assert process.returncode == 130, stderr
    assert "Interrupted; nothing was written" in stderr
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["study"]
    assert (earlier / "results.json").read_text() == "{}"


def test_a_folder_that_is_not_ours_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.doc").write_text("years of work")
    with (
        pytest.raises(InputError, match="not results of this command"),
        replacing(tmp_path / "mine"),
    ):
        raise AssertionError("must not get here")
    assert (tmp_path / "mine" / "thesis.doc").read_text() == "years of work"


def test_a_failure_keeps_the_earlier_results(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with replacing(out) as staging:
        (staging / "results.json").write_text("1")
    with pytest.raises(ZeroDivisionError), replacing(out) as staging:
        (staging / "results.json").write_text(f"2{1 // 0}")
    assert (out / "results.json").read_text() == "1"
    with replacing(out) as staging:
        (staging / "results.json").write_text("3")
    assert (out / "results.json").read_text() == "3"
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_pin_whose_numerics_fail_is_told_and_the_others_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], jobs: str
) -> None:
    import fea.harmonic.section_solution
    import geometry.mesh.section_mesh
    from geometry.mesh.solid_mesh import MeshError

    good = geometry.mesh.section_mesh.meridian_mesh

    def no_mesh(pin: Pin, *rest: object) -> object:
        if pin.name == "B":
            raise MeshError("pin B: no mesh")
        return good(pin, *rest)  # type: ignore[arg-type]

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(fea.harmonic.section_solution, "meridian_mesh", no_mesh)
    Path("study.toml").write_text(two_pins(QUICK))
    command = ["run", "study.toml", "--jobs", jobs]
    assert run_command_line(command) == 1  # auto has the beam answer, and says why
    said = capsys.readouterr()
    assert "the harmonic model failed: pin B: no mesh" in said.err
    assert run_command_line([*command, "--model", "harmonic"]) == 3
    said = capsys.readouterr()
    assert "the solution failed: B (landing): pin B: no mesh" in said.err
    assert "failed" in said.out
    failed, solved = json.loads(Path("out/study/results.json").read_text())["pins"]
    assert (failed["pin"], failed["verdict"], failed["note"]) == ("B", "failed", "pin B: no mesh")
    assert failed["max_von_mises"] is failed["safety_factor"] is failed["meets_required"] is None
    assert (solved["pin"], solved["verdict"]) == ("C", "converged")


CRASHES = """
import os, signal, sys
from pinbase.processes.threads import hold_threads
hold_threads()
import fea.harmonic.section_solution
from pinstress.cli.commands import commands, run_command_line

good = fea.harmonic.section_solution.meridian_mesh

def crash(pin, *rest):
    if pin.name == "B":
        os.kill(os.getpid(), signal.SIGKILL)
    return good(pin, *rest)

fea.harmonic.section_solution.meridian_mesh = crash
sys.exit(run_command_line(["run", "study.toml", "--jobs", "2"]))
"""


@pytest.mark.slow
def test_a_crash_of_a_library_costs_its_pin_alone(tmp_path: Path) -> None:
    """In a process of its own, without threads: beside others there are no workers to crash."""
    (tmp_path / "study.toml").write_text(two_pins(QUICK))
    done = subprocess.run(
        [sys.executable, "-c", CRASHES], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 3
    assert "B (landing): its process was ended by signal 9" in done.stderr
    pins = json.loads((tmp_path / "out/study/results.json").read_text())["pins"]
    assert [p["verdict"] for p in pins] == ["failed", "converged"]


def test_a_solid_that_needs_more_memory_than_allowed_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its first mesh, before it is solved; with room for that one alone, no finer one is made."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(ONE_PIN.replace("tolerance = 0.05", "tolerance = 0.001"))
    command = ["run", "study.toml", "--model", "solid", "--memory-limit"]
    assert run_command_line([*command, "50"]) == 3
    told = capsys.readouterr().err
    assert "fit into the memory allowed (--memory-limit): allow more, or close other" in told
    assert run_command_line([*command, "300"]) == 1
    told = capsys.readouterr().err
    assert "only one mesh was solved, which tells no error; on the next mesh" in told
    assert "and 0.29 GB are allowed (--memory-limit): allow more, or increase" in told
    (pin,) = json.loads(Path("out/study/results.json").read_text())["pins"]
    assert (pin["verdict"], pin["outcome"]) == ("unconverged", "not decided")
    assert len(pin["history"]) == 1

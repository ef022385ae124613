"""The command line as a user meets it: output, exit status, files, interruption."""

from __future__ import annotations

import csv
import json
import math
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from geometry import Pin
from pinstress.cli import run_command_line
from pinstress.errors import InputError
from pinstress.output import replacing
from tests.conftest import ROOT

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()
# a coarse answer is enough to test what surrounds it
QUICK = ONE_PIN.replace("tolerance = 0.05", "tolerance = 0.3")


def two_pins(text: str) -> str:
    """The study with a second pin, C, a tenth thicker, under the same force."""
    head, rest = text.split("[pin.B]")
    pin, case = rest.split("[case.landing]")
    other = pin.replace('"B"', '"C"').replace("2.0, connection", "2.2, connection")
    case = case.replace("{ B = [0.0, -988.86] }", "{ B = [0.0, -988.86], C = [0.0, -988.86] }")
    return f"{head}[pin.B]{pin}[pin.C]{other}[case.landing]{case}"


def pinstress(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "pinstress", *arguments], cwd=cwd, capture_output=True, text=True
    )


@pytest.fixture(scope="module")
def run_once(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, str]:
    folder = tmp_path_factory.mktemp("run")
    (folder / "study.toml").write_text(QUICK)
    done = pinstress("run", "study.toml", "--no-pictures", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder, done.stdout, done.stderr


def test_run_writes_what_the_contract_names(run_once: tuple[Path, str, str]) -> None:
    folder, stdout, stderr = run_once
    out = folder / "out" / "study"
    for name in ("results.json", "safety_factors.csv", "safety_factors.md", "reactions.csv",
                 "vtk/B_landing.vtu", "report.html"):  # fmt: skip
        assert (out / name).is_file(), name
    assert sorted(p.name for p in (folder / "out").iterdir()) == ["study"]
    results = json.loads((out / "results.json").read_text())
    assert results["schema"] == "pinstress-results/1"
    assert results["units"] == {"length": "in", "force": "lbf", "stress": "psi", "time": "s"}
    (pin,) = results["pins"]
    assert (pin["pin"], pin["case"], pin["model"]) == ("B", "landing", "harmonic")
    assert pin["verdict"] == "converged"
    assert pin["error_estimate"] <= 0.3 * pin["max_von_mises"]
    assert pin["safety_factor"] == pytest.approx(225e3 / pin["max_von_mises"], rel=1e-12)
    assert pin["meets_required"] is True
    assert pin["yields"] is False
    assert pin["time"] is None
    # the peak of this pin sits in the fillet, on the line through the load
    assert 1.5 < pin["location"][2] < 2.0
    assert "landing" in stdout
    assert "Report: " in stderr
    assert "\x1b" not in stdout + stderr  # no colour, no bar without a terminal


def test_reactions_have_the_contracts_columns(run_once: tuple[Path, str, str]) -> None:
    path = run_once[0] / "out" / "study" / "reactions.csv"
    (row,) = csv.DictReader(path.read_text().splitlines())
    assert list(row) == ["case", "time", "connection", "body", "fx", "fy", "fz", "mx", "my", "mz"]
    assert float(row["fy"]) == pytest.approx(-988.86, rel=1e-14)


def test_moments_reach_the_pin_and_the_tables(tmp_path: Path) -> None:
    """500 lbf in bend a 2 in shaft to 32 M / (pi d^3) = 637 psi, its fillet to somewhat more."""
    text = QUICK.replace("forces = { B = [0.0, -988.86] }", 'moments = { B = ["0 N m", 500.0] }')
    (tmp_path / "study.toml").write_text(text)
    done = pinstress("run", "study.toml", "--no-pictures", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    out = tmp_path / "out" / "study"
    (row,) = csv.DictReader((out / "reactions.csv").read_text().splitlines())
    found = [float(row[k]) for k in ("fx", "fy", "fz", "mx", "my", "mz")]
    assert found == pytest.approx([0.0, 0.0, 0.0, 0.0, 500.0, 0.0])
    (pin,) = json.loads((out / "results.json").read_text())["pins"]
    assert 637.0 < pin["max_von_mises"] < 1.5 * 637.0
    assert 1.5 < pin["location"][2] < 2.0  # in the fillet


def test_the_same_study_gives_the_same_numbers(run_once: tuple[Path, str, str]) -> None:
    folder = run_once[0]
    first = json.loads((folder / "out" / "study" / "results.json").read_text())
    done = pinstress("run", "study.toml", "--no-pictures", "--out", "again", cwd=folder)
    assert done.returncode == 0
    again = json.loads((folder / "again" / "results.json").read_text())

    def without_times(results: dict[str, object]) -> object:
        text = json.dumps(results)
        return json.loads(
            text, object_hook=lambda d: {k: v for k, v in d.items() if k != "seconds"}
        )

    assert without_times(first) == without_times(again)


def test_a_tolerance_that_is_not_reached_is_status_1(tmp_path: Path) -> None:
    sharp = ONE_PIN.replace("fillet = 0.4 ", "fillet = 0.0 ")
    (tmp_path / "study.toml").write_text(sharp)
    done = pinstress("run", "study.toml", "--no-pictures", cwd=tmp_path)
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    said = re.match(
        r"Not reached: B \(landing\): no maximum exists: at a sharp corner \(shoulder 1 / B\) "
        r"stress grows like distance\^-s, s = (0\.\d\d) measured, 0\.46 by theory; outside of what "
        r"is excluded, known to ",
        last,
    )
    assert said
    assert float(said[1]) == pytest.approx(0.456, abs=0.05)
    (pin,) = json.loads((tmp_path / "out" / "study" / "results.json").read_text())["pins"]
    assert pin["verdict"] == "singular"
    assert pin["meets_required"] is None  # enough outside says nothing of the corner
    assert pin["safety_factor"] > 10.0
    assert pin["error_estimate"] <= 0.05 * pin["max_von_mises"]
    x, y, z = pin["location"]  # the corner is at r = 1, z = 1.5; 0.1 of 2 is left out around it
    assert math.hypot(math.hypot(x, y) - 1.0, z - 1.5) > 0.199


@pytest.mark.slow
def test_all_models_answer(run_once: tuple[Path, str, str], tmp_path: Path) -> None:
    """Each by its name, off the harmonic model by less than their errors add to. The beam's 34 % is
    not within 30 %, so its status is 1.
    """
    (tmp_path / "study.toml").write_text(QUICK)
    (by_default,) = json.loads((run_once[0] / "out/study/results.json").read_text())["pins"]
    for model, status, verdict in (
        ("beam", 1, "unconverged"),
        ("harmonic", 0, "converged"),
        ("solid", 0, "converged"),
    ):
        done = pinstress("run", "study.toml", "--no-pictures", "--model", model, cwd=tmp_path)
        assert done.returncode == status, done.stderr
        (pin,) = json.loads((tmp_path / "out/study/results.json").read_text())["pins"]
        assert (pin["model"], pin["verdict"]) == (model, verdict)
        off = abs(pin["max_von_mises"] - by_default["max_von_mises"])
        assert off <= pin["error_estimate"] + by_default["error_estimate"]
        assert (off == 0.0) == (model == "harmonic")


def test_what_is_asked_decides_how_far_it_goes(tmp_path: Path) -> None:
    """A factor of 120 is far above the 10 that is required, which three meshes decide; the
    tolerance would take more, but is not what was asked for.
    """
    text = ONE_PIN.replace("tolerance = 0.05", 'goal = "decide"\ntolerance = 0.001')
    (tmp_path / "study.toml").write_text(text)
    done = pinstress("run", "study.toml", "--no-pictures", cwd=tmp_path)
    (pin,) = json.loads((tmp_path / "out/study/results.json").read_text())["pins"]
    assert (pin["model"], len(pin["history"])) == ("harmonic", 3)
    assert pin["verdict"] == "unconverged"
    assert pin["meets_required"] is True
    assert pin["safety_factor"] > 100.0
    assert done.returncode == 0
    assert "Not reached" not in done.stderr
    assert "1 of 1 pin meets the required safety factor" in " ".join(done.stdout.split())


def test_millimetres_and_inches_give_the_same_pin(
    run_once: tuple[Path, str, str], tmp_path: Path
) -> None:
    text = QUICK.replace('"in-lbf-s"', '"mm-N-s"')
    for inch in (
        "length = 1.5",
        "length = 2.0",
        "diameter = 4.0",
        "diameter = 2.0",
        "fillet = 0.4",
    ):
        key, value = inch.split(" = ")
        text = text.replace(inch, f'{key} = "{value} in"')
    text = text.replace("-988.86", '"-988.86 lbf"')
    (tmp_path / "study.toml").write_text(text)
    assert pinstress("run", "study.toml", "--no-pictures", cwd=tmp_path).returncode == 0
    (mm,) = json.loads((tmp_path / "out" / "study" / "results.json").read_text())["pins"]
    (inch,) = json.loads((run_once[0] / "out" / "study" / "results.json").read_text())["pins"]
    assert mm["max_von_mises"] == pytest.approx(inch["max_von_mises"] * 6.894757293e-3, rel=1e-9)
    assert mm["safety_factor"] == pytest.approx(inch["safety_factor"], rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "change", "message"),
    [
        (["study.toml", "--pins", "Q"], ("", ""), "--pins: the study has no pin 'Q'"),
        (["study.toml", "--cases", "lading"], ("", ""), "did you mean 'landing'?"),
        (
            ["study.toml", "--model", "harmonic"],
            ("fillet = 0.4", "hole = [{ z = 2.5, diameter = 0.2 }]\nfillet = 0.4"),
            "pin B is no body of revolution, which the harmonic model needs: use auto or solid",
        ),
        (["study.toml", "--model", "shell"], ("", ""), "'shell' is not one of 'auto', 'beam'"),
        (["study.toml"], ("tolerance = 0.05", 'goal = "guess"'), "'value' or 'decide'"),
        (["study.toml"], ("tolerance = 0.05", "excluded_distance = 0.6"), "excluded_distance"),
        (["study.toml", "--tolerance", "2"], ("", ""), "--tolerance"),
        (["gone.toml"], ("", ""), "gone.toml: no such file"),
        (["study.toml"], ("fillet = 0.4", "fillet = 4"), "does not fit"),
        (["study.toml"], ("-988.86", "nan"), "nan is not finite"),
        (["study.toml"], ('["start"]', '["B"]'), "nothing loads it"),
        (["study.toml"], ("forces = { B = [0.0, -988.86] }", 'table = "t.csv"'), "t.csv"),
        (["study.toml"], ('kind = "given"', 'kind = "given"\ndistribution = "sine"'), "cosine"),
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
    assert "nothing holds the pin" in capsys.readouterr().err
    (pin,) = json.loads(Path("out/study/results.json").read_text())["pins"]
    assert pin["verdict"] == "rigid"
    assert pin["max_von_mises"] is None
    assert pin["safety_factor"] is None


def test_init_writes_a_study_and_does_not_overwrite_it(tmp_path: Path) -> None:
    assert pinstress("init", "new", cwd=tmp_path).returncode == 0
    assert (tmp_path / "new" / "one_pin.toml").read_text() == ONE_PIN
    again = pinstress("init", "new", cwd=tmp_path)
    assert again.returncode == 2
    assert "exists already" in again.stderr


def test_check_says_what_would_be_run_and_loads_no_heavy_library(tmp_path: Path) -> None:
    code = (
        "import sys; from pinstress.cli import run_command_line as run; "
        f"status = run(['check', {str(ROOT / 'studies' / 'grenier2008.toml')!r}]); "
        "heavy = {'gmsh', 'pyvista', 'vtk', 'matplotlib', 'skfem', 'scipy.sparse', 'meshio', "
        "'rich', 'cvxopt', 'jinja2'} & set(sys.modules); print(sorted(heavy)); sys.exit(status)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[-1] == "[]"
    assert any("D1, D2, G1, G3 follow the sharing rule" in line for line in lines)
    assert any(line.startswith("case retract: motion, 201 instants over 4 s") for line in lines)
    assert list(tmp_path.iterdir()) == []


def test_schema_is_json_and_knows_every_table() -> None:
    done = pinstress("schema", cwd=ROOT)
    made = json.loads(done.stdout)
    assert {"title", "units", "case"} <= set(made["required"])
    assert {"material", "pin", "spatial_leg"} <= set(made["properties"])
    assert "mechanism" in made["properties"]


@pytest.mark.parametrize(
    "command", ["run", "loads", "chart", "check", "init", "schema", "size", "view", "completion"]
)
def test_help_begins_with_an_example(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line([command, "--help"]) == 0
    body = capsys.readouterr().out.split("\n\n")[1]
    assert body.strip().startswith(f"Example: pinstress {command}")


def test_an_interrupt_leaves_nothing_behind(tmp_path: Path) -> None:
    slow = ONE_PIN.replace("tolerance = 0.05", 'model = "solid"\ntolerance = 0.001')
    (tmp_path / "study.toml").write_text(slow)
    earlier = tmp_path / "out" / "study"
    earlier.mkdir(parents=True)
    (earlier / "results.json").write_text("{}")
    process = subprocess.Popen(
        [sys.executable, "-m", "pinstress", "run", "study.toml", "--no-pictures"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 60.0
    while not list((tmp_path / "out").glob(".study.*")) and time.monotonic() < deadline:
        time.sleep(0.02)  # until it has begun to write
    os.kill(process.pid, signal.SIGINT)
    _, stderr = process.communicate(timeout=120)
    assert process.returncode == 130, stderr
    assert "Interrupted; nothing was written" in stderr
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["study"]
    assert (earlier / "results.json").read_text() == "{}"


def test_a_folder_that_is_not_ours_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.doc").write_text("years of work")
    with pytest.raises(InputError, match="not results of pinstress"), replacing(tmp_path / "mine"):
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
    import fea.harmonic_look
    import geometry.meridian_mesh
    from geometry.solid_mesh import MeshError

    good = geometry.meridian_mesh.meridian_mesh

    def no_mesh(pin: Pin, *rest: object) -> object:
        if pin.name == "B":
            raise MeshError("pin B: no mesh")
        return good(pin, *rest)  # type: ignore[arg-type]

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(fea.harmonic_look, "meridian_mesh", no_mesh)
    Path("study.toml").write_text(two_pins(QUICK))
    assert run_command_line(["run", "study.toml", "--no-pictures", "--jobs", jobs]) == 3
    said = capsys.readouterr()
    assert "the numerics failed: B (landing): pin B: no mesh" in said.err
    assert "failed" in said.out
    failed, solved = json.loads(Path("out/study/results.json").read_text())["pins"]
    assert (failed["pin"], failed["verdict"], failed["note"]) == ("B", "failed", "pin B: no mesh")
    assert failed["max_von_mises"] is failed["safety_factor"] is failed["meets_required"] is None
    assert (solved["pin"], solved["verdict"]) == ("C", "converged")


CRASHES = """
import os, signal, sys
from pinstress.threads import hold_threads
hold_threads()
import fea.harmonic_look
from pinstress.cli import run_command_line

good = fea.harmonic_look.meridian_mesh

def crash(pin, *rest):
    if pin.name == "B":
        os.kill(os.getpid(), signal.SIGKILL)
    return good(pin, *rest)

fea.harmonic_look.meridian_mesh = crash
sys.exit(run_command_line(["run", "study.toml", "--no-pictures", "--jobs", "2"]))
"""


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
    command = ["run", "study.toml", "--no-pictures", "--model", "solid", "--memory-limit"]
    assert run_command_line([*command, "50"]) == 3
    told = capsys.readouterr().err
    assert "and 0.049 GB are allowed (--memory-limit): close other programs, allow more" in told
    assert run_command_line([*command, "300"]) == 1
    told = capsys.readouterr().err
    assert "only, so the error is not known; on the next mesh" in told
    assert "and 0.29 GB are allowed (--memory-limit): allow more, or ask for a larger" in told
    (pin,) = json.loads(Path("out/study/results.json").read_text())["pins"]
    assert pin["verdict"] == "unconverged"
    assert 1 <= len(pin["history"]) < 3

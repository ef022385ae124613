"""The command `chart`: bad input, interrupts, and the files of a short ladder."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pinstress.cli.commands import run_command_line
from tests.conftest import ROOT
from tests.pinstress.explore.chart.test_chart import CONTRACT, CURVED, LINEAR, STRAIGHT, STUDY
from tests.support.each import each
from tests.support.programs.command_line import ONE_PIN, pinstress, run_here
from tests.support.programs.process_group import started

OTHER_PIN = """[pin.C]
material = "AISI 4340"
clamp = ["start"]
profile = [{ length = 2.0, diameter = 2.0, connection = "C" }]
"""


@each(
    ("arguments", "change", "message"),
    [
        (["--pin", "Q", "--case", "landing"], ("", ""), "--pin: the study has no pin 'Q'"),
        (["--pin", "B", "--case", "lading"], ("", ""), "--case: the study has no case 'lading'; "
         "did you mean 'landing'?"),
        (["--pin", "B"], ("", ""), "Missing option '--case'"),
        (["--pin", "B", "--case", "landing"], ('["start"]', "[]"), "there is nothing to chart"),
        (["--pin", "B", "--case", "landing"], ("-988.86", "0.0"), "there is nothing to chart"),
        (["--pin", "C", "--case", "landing"], ("[case.landing]", OTHER_PIN + "[case.landing]"),
         "case landing does not load pin C"),
        (["--pin", "B", "--case", "landing", "--runs", "0"], ("", ""), "--runs"),
    ],
)  # fmt: skip
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
    assert run_command_line(["chart", "study.toml", *arguments]) == 2
    said = capsys.readouterr()
    assert message in said.err
    assert said.out == ""
    assert [p.name for p in tmp_path.iterdir()] == ["study.toml"]


def test_after_a_failure_there_is_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(ONE_PIN)
    arguments = ["chart", "study.toml", "--pin", "B", "--case", "landing", "--time-limit", "0.01"]
    assert run_command_line(arguments) == 3
    assert "exceeded the limit of 0.01 s" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["study.toml"]


def test_results_of_a_run_are_not_replaced_by_a_chart(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("out").mkdir()
    Path("out/results.json").write_text("{}")
    arguments = ["chart", str(STUDY), "--pin", "B", "--case", "landing", "--out", "out"]
    assert run_command_line(arguments) == 2
    assert "it has no chart.csv" in capsys.readouterr().err
    assert Path("out/results.json").read_text() == "{}"


def leads_a_group(pid: int) -> bool:
    try:
        return os.getpgid(pid) == pid
    except ProcessLookupError:
        return False


def test_an_interrupt_leaves_nothing_behind(tmp_path: Path) -> None:
    with started(
        [sys.executable, "-m", "pinstress", "chart", str(STUDY), "--pin", "B", "--case", "landing"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)},
    ) as process:
        deadline = time.monotonic() + 60.0
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while not any(leads_a_group(int(pid)) for pid in children.read_text().split()):
            assert time.monotonic() < deadline  # until the first point's process is at work
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=60)
    assert process.returncode == 130, stderr
    assert "Interrupted; nothing was written" in stderr
    assert list(tmp_path.iterdir()) == []


def _stays_within(error: float, rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """The last rows of an element that are all within an error."""
    beyond = [k for k, row in enumerate(rows) if float(row["relative_error"]) > error]
    return rows[max(beyond, default=-1) + 1 :]


@pytest.mark.slow
def test_the_command(tmp_path: Path) -> None:
    """On a short ladder. The mesh on which auto ends is that of a run, to the last digit; every
    model's error falls with its meshes; the chart has what it must.
    """
    done = pinstress(
        "chart", str(STUDY), "--pin", "B", "--case", "landing", "--meshes", "2", "--runs", "1",
        cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "out" / "one_pin-chart.B.landing"
    assert sorted(p.name for p in folder.iterdir()) == [
        ".pinstress.json",
        "chart.csv",
        "chart.png",
        "chart.svg",
    ]
    rows = list(csv.DictReader((folder / "chart.csv").read_text().splitlines()))
    assert list(rows[0])[: len(CONTRACT)] == CONTRACT
    assert {r["model"] for r in rows} == {"beam", "harmonic", "solid"}
    assert not any(r["failed"] for r in rows)
    for element in (LINEAR, CURVED):
        coarse, fine = (float(r["relative_error"]) for r in rows if r["element"] == element)
        assert fine < coarse
    linear, straight, curved = (
        float([r for r in rows if r["element"] == e][-1]["relative_error"])
        for e in (LINEAR, STRAIGHT, CURVED)
    )
    assert curved < straight < linear
    assert all(float(r["relative_error"]) < 0.02 for r in rows if r["model"] == "harmonic")
    assert run_here("run", str(STUDY), cwd=tmp_path).returncode == 0
    (run,) = json.loads((tmp_path / "out" / "one_pin" / "results.json").read_text())["pins"]
    (auto,) = [r for r in rows if r["chosen_by_auto"] == "yes"]
    assert (auto["model"], int(auto["dofs"])) == (run["model"], run["dofs"])
    assert float(auto["max_von_mises"]) == pytest.approx(run["max_von_mises"], rel=1e-9)
    said, elements = " ".join(done.stdout.split()), {r["element"] for r in rows}
    # By the times that were measured, which a busy machine may turn around.
    within = [_stays_within(0.05, [r for r in rows if r["element"] == e]) for e in elements]
    cheapest = min((tail[0] for tail in within if tail), key=lambda r: float(r["seconds"]))
    assert f"Cheapest within 5 %: {cheapest['model']}" in said
    assert "Reference: harmonic model" in said

"""Whatever becomes of what is printed, the status is that of the work."""

from __future__ import annotations

import codecs
import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

import click
import pytest

from fea.core.linear_solver import SolveError
from fea.solve.solve import solve
from pinbase.processes import interrupts
from pinstress import InputError
from pinstress.cli.commands import run_command_line
from pinstress.cli.output_folder import replacing
from pinstress.cli.streams import _plain
from tests.conftest import ROOT
from tests.support.each import each, sampled
from tests.support.programs.command_line import QUICK, run_here
from tests.support.programs.signals import signals_heard

GUARD = 300.0  # s
SHARP = QUICK.replace("fillet = 0.4 ", "fillet = 0.0 ")  # whose maximum does not exist: status 1
RUN = ["run", "study.toml"]
LOADS = ["loads", "study.toml"]
TABLES = {  # with what they leave behind, which says the same
    "run": (RUN, SHARP, 1, "out/study/results.json"),
    "loads": (LOADS, QUICK, 0, "out/study-loads/results.json"),
    "size": (["size", "study.toml"], QUICK, 0, "study_sized.toml"),
    "init": (["init", "new"], QUICK, 0, "new/one_pin.toml"),
}
DATA = {
    "run --json": ([*RUN, "--json"], SHARP, 1),
    "check": (["check", "study.toml"], QUICK, 0),
    "schema": (["schema"], QUICK, 0),
    "completion": (["completion", "bash"], QUICK, 0),
    "--help": (["--help"], QUICK, 0),
    "run --help": (["run", "--help"], QUICK, 0),
    "--version": (["--version"], QUICK, 0),
}


def shell(
    folder: Path, arguments: list[str], to: str = "", text: str = QUICK, **environment: str
) -> tuple[int, str, str]:
    """Status, output and messages of a command whose output a shell redirects."""
    (folder / "study.toml").write_text(text, encoding="utf-8")
    quoted = " ".join(f"'{each}'" for each in arguments)
    done = subprocess.run(
        ["bash", "-c", f"'{sys.executable}' -m pinstress {quoted} {to}"],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        capture_output=True,
        timeout=GUARD,
    )
    return done.returncode, done.stdout.decode(), done.stderr.decode()


FULL = "cannot write to standard output (No space left on device)"
CLOSED = "cannot write to standard output (Bad file descriptor)"
# A reader that takes nothing and is gone before anything is written, with the command's status.
GONE = "| true; exit ${PIPESTATUS[0]}"


ENDS = {"full": (">/dev/full", FULL), "closed": (">&-", CLOSED), "gone": (GONE, "")}
# Every command meets every end: in CI each of them one, and `check`, the cheapest, all of them, as
# all tables and all data are written by one function.
CI_ENDS = {
    **{"run": "full", "loads": "closed", "size": "gone", "init": "full", "run --json": "full"},
    **{"schema": "gone", "completion": "closed", "--help": "full", "run --help": "gone"},
    "--version": "closed",
}


def ended(commands: Iterable[str], *ends: str) -> list[Any]:
    """command, to, told."""
    return [
        pytest.param(
            command,
            *ENDS[end],
            marks=[pytest.mark.long] * (CI_ENDS.get(command, end) != end),
            id=f"{command}, {end}",
        )
        for command in commands
        for end in ends
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("command", "to", "told"), ended(TABLES, *ENDS))
def test_a_table_that_cannot_be_printed_changes_no_status(
    tmp_path: Path, command: str, to: str, told: str
) -> None:
    arguments, text, wanted, left = TABLES[command]
    status, _, said = shell(tmp_path, arguments, to, text)
    assert status == wanted, said
    assert (tmp_path / left).is_file()
    assert said.count("cannot write") == bool(told)
    assert told in said
    assert "Traceback" not in said
    assert "Exception ignored" not in said


@pytest.mark.slow
@pytest.mark.parametrize(("command", "to", "told"), ended(DATA, "full", "closed"))
def test_data_that_cannot_be_printed_are_lost(
    tmp_path: Path, command: str, to: str, told: str
) -> None:
    arguments, text, _ = DATA[command]
    status, _, said = shell(tmp_path, arguments, to, text)
    assert status == 2
    assert said.endswith(f"Error: {told}\n")
    assert "Traceback" not in said


@pytest.mark.parametrize(("command", "to", "told"), ended(DATA, "gone"))
def test_a_reader_that_has_enough_is_no_error(
    tmp_path: Path, command: str, to: str, told: str
) -> None:
    arguments, text, wanted = DATA[command]
    status, _, said = shell(tmp_path, arguments, to, text)
    assert (status, "Error" in said, "ignored" in said) == (wanted, False, False)


@pytest.mark.parametrize("to", ["2>/dev/full", "2>&-", f"2>&1 {GONE}"])
@pytest.mark.parametrize(
    ("arguments", "wanted"),
    [
        pytest.param(RUN, 1, marks=[pytest.mark.slow, pytest.mark.long]),
        (["check", "study.toml"], 0),
        (["check", "no.toml"], 2),
    ],
)
def test_messages_that_cannot_be_printed_change_no_status(
    tmp_path: Path, arguments: list[str], wanted: int, to: str
) -> None:
    assert shell(tmp_path, arguments, to, SHARP)[0] == wanted


def test_files_are_not_written_into_by_what_is_printed(tmp_path: Path) -> None:
    """A file that is opened while standard output is closed would get its number."""
    status, _, said = shell(tmp_path, RUN, ">&- 2>&- <&-", SHARP)
    assert status == 1, said
    assert json.loads((tmp_path / "out" / "study" / "results.json").read_text())["pins"]
    page = (tmp_path / "out" / "study" / "report.html").read_bytes()
    assert page.lower().startswith(b"<!doctype html>")
    assert page.rstrip().endswith(b"</html>")


ASCII = [
    {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    {"LC_ALL": "C", "PYTHONIOENCODING": "ascii"},
    {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii:strict"},
]


@pytest.mark.slow
@pytest.mark.parametrize("environment", sampled(ASCII, every=3))
def test_a_terminal_that_knows_ascii_alone(tmp_path: Path, environment: dict[str, str]) -> None:
    text = SHARP.replace("[pin.B]", '[pin."Bügel ±"]').replace('"One pin', '"Bügel–β')
    status, out, said = shell(tmp_path, RUN, text=text, **environment)
    assert status == 1, said
    assert out.isascii()
    assert "B?gel" in out
    if environment is not ASCII[0]:  # the rest has the same output
        return
    status, out, said = shell(tmp_path, [*RUN, "--json"], text=text, **environment)
    assert status == 1, said
    assert json.loads(out)["pins"][0]["pin"] == "Bügel ±"
    for arguments in (LOADS, ["check", "study.toml"], ["run", "--help"]):
        assert shell(tmp_path, arguments, text=text, **environment)[0] == 0


def test_what_libraries_read_from_the_environment_decides_nothing(tmp_path: Path) -> None:
    bad = {"MPLBACKEND": "module://nowhere", "SOURCE_DATE_EPOCH": "9" * 20}
    status, _, said = shell(tmp_path, ["loads", "study.toml"], **bad)
    assert status == 0, said
    assert said.count("Warning: SOURCE_DATE_EPOCH") == 1
    assert (tmp_path / "out" / "study-loads" / "results.json").is_file()


@each("columns", ["0", "00", ""])
def test_a_terminal_of_unknown_width_gets_the_answer(columns: str, tmp_path: Path) -> None:
    """COLUMNS=0 of a container or a serial line printed nothing, with status 0."""
    printed = []
    for stated in ("120", columns):
        status, table, said = shell(tmp_path, ["loads", "study.toml"], COLUMNS=stated)
        assert status == 0, said
        printed.append(table)
    assert "Connection" in printed[0]
    assert printed[1] == printed[0]


@each("epoch", ["abc", "-5", "9" * 20, "9" * 5000, "", "1700000000"])
def test_a_time_that_is_none_is_removed_before_libraries_read_it(
    epoch: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "study.toml").write_text(QUICK, encoding="utf-8")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", epoch)
    monkeypatch.setenv("MPLBACKEND", "foo")
    done = run_here("check", "study.toml", cwd=tmp_path)
    valid = epoch == "1700000000"
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("Warning: SOURCE_DATE_EPOCH") == (not valid)
    assert os.environ.get("SOURCE_DATE_EPOCH") == (epoch if valid else None)
    assert os.environ["MPLBACKEND"] == "agg"


@pytest.mark.parametrize(
    "error",
    [
        RuntimeError("CPU dispatcher tracer already initialized"),
        ImportError("numpy.core.multiarray failed to import"),
        SystemError("returned NULL without setting an exception"),
        InputError("cannot be read"),
        SolveError("the matrix is singular"),
        MemoryError(),
        click.ClickException("no"),
        SystemExit(1),
    ],
)
@pytest.mark.parametrize("interrupt", [signal.SIGINT, signal.SIGTERM])
def test_whatever_an_interrupt_becomes_the_status_is_130(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    error: BaseException,
    interrupt: signal.Signals,
) -> None:
    """C code that is being imported makes its own error of a KeyboardInterrupt."""

    def interrupted(_: Any) -> None:
        try:
            signal.raise_signal(interrupt)
        except KeyboardInterrupt:
            raise error from None

    monkeypatch.setattr("pinstress.study.reading.file.load_study", interrupted)
    with signals_heard():
        assert run_command_line(["check", "study.toml"]) == 130
    assert capsys.readouterr().err == "Interrupted; nothing was written.\n"
    interrupts.require_none()  # nor does anything that this process does later end for it


def test_a_home_that_cannot_be_written_is_no_news() -> None:
    """Matplotlib, which keeps a list of fonts there, said so on every picture."""
    load = "import pinstress.cli.commands as c; c._settle_environment(); import matplotlib"
    command, nowhere = [sys.executable, "-c", load], {"MPLCONFIGDIR": f"{os.devnull}/nowhere"}
    done = subprocess.run(command, env=os.environ | nowhere, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_an_interrupt_before_the_command_line_is_there_is_told() -> None:
    """On a slow machine its imports take a second, in which an interrupt was silent."""
    begin = "import signal, pinstress.__main__ as m, pinstress.cli.streams as s\n"
    late = "s.guard = lambda: signal.raise_signal(signal.SIGTERM)\nm.main()"
    done = subprocess.run([sys.executable, "-c", begin + late], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (130, "Interrupted; nothing was written.\n")


@pytest.mark.parametrize(
    "at",
    [
        "pinstress.cli.output_folder.lock",
        "pinstress.cli.manifest.begin",
        "pinstress.cli.output_folder._replace",
    ],
)
def test_an_interrupt_while_folders_are_created_or_replaced_leaves_one_or_the_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at: str
) -> None:
    """An interrupt between creating the folder and knowing that it is ours left it behind."""
    module, name = at.rsplit(".", 1)
    step = getattr(sys.modules[module], name)

    def interrupted(*arguments: Any) -> Any:
        out = step(*arguments)
        signal.raise_signal(signal.SIGINT)
        return out

    monkeypatch.setattr(at, interrupted)
    with signals_heard():
        interrupts.listen()
        try:
            with pytest.raises(KeyboardInterrupt), replacing(tmp_path / "out") as staging:
                (staging / "results.json").write_text("{}")
            left = interrupts.left()
        finally:
            interrupts.forget()
    done = at.endswith("_replace")
    assert left == (f"{tmp_path / 'out'} is written" if done else "nothing was written")
    assert [p.name for p in tmp_path.iterdir()] == (["out"] if done else [])


def test_an_interrupt_that_is_dropped_comes_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A callback that cannot raise drops it; the next step of the work ends it all the same."""

    def dropping(*arguments: Any) -> Any:
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        return solve(*arguments)

    (tmp_path / "study.toml").write_text(QUICK)
    monkeypatch.setattr("fea.solve.solve.solve", dropping)
    monkeypatch.chdir(tmp_path)
    with signals_heard():
        assert run_command_line([*RUN, "--jobs", "1"]) == 130
    assert "Interrupted; nothing was written." in capsys.readouterr().err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["study.toml"]


@each(
    ("encoding", "shown"),
    [
        ("ascii", "22.8x10^-6 -> 3x10^12, s^2, >= 2 inf, dia 3, 30 deg?"),
        ("cp1252", "22.8×10^-6 -> 3×10¹², s², >= 2 inf, dia 3, 30°?"),
    ],
)
def test_a_terminal_without_a_character_gets_what_reads_the_same(encoding: str, shown: str) -> None:
    """A power of ten lost its exponent, "22.8x10??", and ≥ became >."""
    codecs.register_error("plain", _plain)
    text = "22.8×10⁻⁶ → 3×10¹², s², ≥ 2 ∞, ⌀3, 30°✕"
    assert text.encode(encoding, "plain").decode(encoding) == shown

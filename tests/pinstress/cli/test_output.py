"""An output folder is complete or absent, whatever ends the run that writes it."""

from __future__ import annotations

import errno
import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from pinstress.cli import manifest, output_folder
from pinstress.cli.new_file import write_new
from pinstress.cli.output_folder import replacing
from pinstress.study.reading.errors import InputError
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.errors import raises
from tests.support.programs.process_group import alive, started

WRITER = """
import sys, time
from pathlib import Path
from pinstress.cli.output_folder import replacing
with replacing(Path(sys.argv[1])) as staging:
    (staging / "results.json").write_text("half")
    (staging / "plots").mkdir()
    (staging / "plots" / "one.svg").write_text("half")
    print("writing", flush=True)
    time.sleep(600)
"""
# all three meshes of a solid: long enough to be ended in the middle
SLOW = (
    (ROOT / "studies" / "one_pin.toml")
    .read_text()
    .replace("tolerance = 0.05", 'model = "solid"\ntolerance = 0.001')
)
ROOM = "--memory-limit", "1e6"  # enough for several solids at a time, by whatever solver


@pytest.fixture
def earlier(tmp_path: Path) -> Path:
    """Complete results of an earlier run."""
    with replacing(tmp_path / "out") as staging:
        (staging / "results.json").write_text("earlier")
    return tmp_path / "out"


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


@contextmanager
def writer(directory: Path) -> Iterator[subprocess.Popen[str]]:
    """A run in the middle of writing."""
    command = [sys.executable, "-c", WRITER, str(directory)]
    with started(command, cwd=ROOT, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "writing\n"
        yield process


def test_what_a_killed_run_left_is_cleared_by_the_next(earlier: Path) -> None:
    with writer(earlier) as process:
        process.kill()
    assert (earlier / "results.json").read_text() == "earlier"
    assert names(earlier.parent) == [".out.partial", "out"]
    with replacing(earlier) as staging:
        assert names(staging) == [manifest.MANIFEST_FILE]
        (staging / "results.json").write_text("next")
    assert (earlier / "results.json").read_text() == "next"
    assert names(earlier.parent) == ["out"]


def test_of_two_runs_into_one_folder_one_is_refused(earlier: Path) -> None:
    with writer(earlier) as process:
        with pytest.raises(InputError, match="another run is writing"), replacing(earlier):
            raise AssertionError("must not get here")
        assert names(earlier.parent / ".out.partial") == [
            manifest.MANIFEST_FILE,
            "plots",
            "results.json",
        ]
        process.kill()
    assert (earlier / "results.json").read_text() == "earlier"


@pytest.mark.linux
@pytest.mark.parametrize(
    ("jobs", "ending"),
    [
        ("1", signal.SIGINT),
        ("2", signal.SIGINT),
        ("1", signal.SIGTERM),
        ("2", signal.SIGHUP),
        pytest.param("2", signal.SIGTERM, marks=pytest.mark.long),
        pytest.param("1", signal.SIGHUP, marks=pytest.mark.long),
    ],
)
def test_a_signal_ends_a_run_with_nothing_written(
    earlier: Path, ending: signal.Signals, jobs: str
) -> None:
    (earlier.parent / "study.toml").write_text(SLOW)
    command = "run", "study.toml", "--out", "out", "--jobs", jobs, *ROOM
    with started(
        [sys.executable, "-m", "pinstress", *command],
        cwd=earlier.parent,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
    ) as process:
        deadline = time.monotonic() + 60.0
        while not (earlier.parent / ".out.partial" / "vtk").is_dir():
            assert time.monotonic() < deadline
            time.sleep(0.02)
        time.sleep(1.0)  # into the meshes
        process.send_signal(ending)
        _, said = process.communicate(timeout=120)
    assert process.returncode == 130, said
    assert said.strip() == "Interrupted; nothing was written."
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)  # none of its processes is left
    assert (earlier / "results.json").read_text() == "earlier"
    assert names(earlier.parent) == ["out", "study.toml"]


@pytest.mark.linux
def test_a_run_in_the_background_of_a_script_is_not_interrupted(earlier: Path) -> None:
    """The shell has such a job ignore SIGINT, which is for what runs in the foreground."""
    (earlier.parent / "study.toml").write_text(
        SLOW.replace("0.001", "0.5").replace("solid", "harmonic")
    )
    command = "run", "study.toml", "--out", "out", "--jobs", "2"
    ignoring = ["sh", "-c", 'trap "" INT; exec "$@"', "sh", sys.executable, "-m", "pinstress"]
    with started(
        [*ignoring, *command],
        cwd=earlier.parent,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    ) as process:
        deadline = time.monotonic() + 60.0
        while not (earlier.parent / ".out.partial").is_dir():
            assert time.monotonic() < deadline
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=120)
    assert "Interrupted" not in said
    assert process.returncode in (0, 1), said
    assert (earlier / "results.json").read_text() != "earlier"


def test_workers_end_when_their_run_is_killed(earlier: Path) -> None:
    (earlier.parent / "study.toml").write_text(SLOW)
    command = "run", "study.toml", "--out", "out", "--jobs", "2", *ROOM
    with started(
        [sys.executable, "-m", "pinstress", *command],
        cwd=earlier.parent,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.DEVNULL,
    ) as process:
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while not children.read_text():
            assert process.poll() is None
            time.sleep(0.02)
        process.kill()
        process.wait()
        deadline = time.monotonic() + 60.0
        while alive(process.pid):
            assert time.monotonic() < deadline
            time.sleep(0.02)
    assert (earlier / "results.json").read_text() == "earlier"


def test_a_file_where_a_folder_belongs_is_called_so(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    why = r"--out: cannot write to .*out \(it is a file, not a folder\)"
    with pytest.raises(InputError, match=why), replacing(tmp_path / "out" / "trial"):
        pass
    assert (tmp_path / "out").read_text() == "a file"


def test_a_name_that_is_too_long_is_named(tmp_path: Path) -> None:
    """The folder around it was, whose name is short."""
    why = r"--out: cannot write to .*/x{250} \(File name too long\)"
    with pytest.raises(InputError, match=why), replacing(tmp_path / ("x" * 250)):
        pass
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_full_disk_is_told_and_nothing_is_written(earlier: Path, jobs: str) -> None:
    """No file may be larger than 2 kB, which is met first by the field's."""
    (earlier.parent / "study.toml").write_text(
        SLOW.replace("0.001", "0.5").replace("solid", "auto")
    )
    command = "run", "study.toml", "--out", "out", "--jobs", jobs
    done = subprocess.run(
        [sys.executable, "-B", "-m", "pinstress", *command],
        cwd=earlier.parent,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)),
    )
    assert done.returncode == 2
    assert done.stderr.startswith("Error: --out: cannot write to ")
    assert os.strerror(errno.EFBIG) in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert (earlier / "results.json").read_text() == "earlier"
    assert names(earlier.parent) == ["out", "study.toml"]


def test_a_full_disk_leaves_no_half_of_a_new_file(tmp_path: Path) -> None:
    """An empty study stayed, which the next `init` would not overwrite."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        with raises(InputError, "cannot-write"):
            write_new(tmp_path / "study.toml", bytes(1000), "")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert names(tmp_path) == []


def test_without_an_exchange_in_one_step_there_are_two(
    earlier: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(output_folder, "RENAME_EXCHANGE", 1 << 20)  # which no file system knows
    with replacing(earlier) as staging:
        (staging / "results.json").write_text("next")
    assert (earlier / "results.json").read_text() == "next"
    assert names(earlier.parent) == ["out"]
    earlier.rename(earlier.parent / ".out.earlier")  # killed between the two
    with pytest.raises(ZeroDivisionError), replacing(earlier):
        raise ZeroDivisionError
    assert (earlier / "results.json").read_text() == "next"
    assert names(earlier.parent) == ["out"]


def test_nothing_is_left_where_nothing_was(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), replacing(tmp_path / "a" / "b" / "out"):
        raise ZeroDivisionError
    assert names(tmp_path) == []


def refused(directory: Path, message: str) -> None:
    with pytest.raises(InputError, match=message), replacing(directory):
        raise AssertionError("must not get here")


@pytest.mark.parametrize("name", [".out.partial", ".out.earlier"])
def test_a_link_is_not_followed_by_what_is_cleared_away(
    name: str, tmp_path: Path, earlier: Path
) -> None:
    """Whether it leads to a folder, to results, or nowhere."""
    for target in ("home", "results", "nowhere"):
        if target != "nowhere":
            (tmp_path / target).mkdir()
            (tmp_path / target / "results.json").write_text("mine")
        if target == "results":
            manifest.complete(tmp_path / target)
        (tmp_path / name).symlink_to(tmp_path / target)
        refused(earlier, f"{name} exists and was not written")
        assert os.readlink(tmp_path / name) == str(tmp_path / target)
        (tmp_path / name).unlink()
    assert names(tmp_path / "home") == ["results.json"]
    assert names(tmp_path / "results") == [manifest.MANIFEST_FILE, "results.json"]
    assert not (tmp_path / "nowhere").exists()


@pytest.mark.parametrize("name", [".out.partial", ".out.earlier"])
def test_a_folder_of_the_users_is_not_cleared_away(
    name: str, tmp_path: Path, earlier: Path
) -> None:
    (tmp_path / name).mkdir()
    (tmp_path / name / "results.json").write_text("mine")
    refused(earlier, f"{name}.* exists and was not written")
    assert (tmp_path / name / "results.json").read_text() == "mine"
    assert (earlier / "results.json").read_text() == "earlier"


def test_links_inside_a_killed_runs_folder_are_removed_as_links(
    tmp_path: Path, earlier: Path
) -> None:
    with writer(earlier) as process:
        process.kill()
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "thesis.doc").write_text("years of work")
    (tmp_path / ".out.partial" / "vtk").symlink_to(tmp_path / "home")
    with replacing(earlier) as staging:
        (staging / "results.json").write_text("next")
    assert (tmp_path / "home" / "thesis.doc").read_text() == "years of work"
    assert names(tmp_path) == ["home", "out"]


def test_a_link_that_the_user_names_leads_to_his_folder(tmp_path: Path) -> None:
    """To another disk, say; the link stays."""
    (tmp_path / "disk").mkdir()
    (tmp_path / "out").symlink_to(tmp_path / "disk" / "results")
    for text in ("one", "two"):
        with replacing(tmp_path / "out") as staging:
            (staging / "results.json").write_text(text)
        assert (tmp_path / "disk" / "results" / "results.json").read_text() == text
    assert (tmp_path / "out").is_symlink()
    assert names(tmp_path / "disk") == ["results"]
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    refused(tmp_path / "loop", "leads back to itself|Too many levels")


def test_a_deleted_current_folder_is_named_as_the_cause(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    refused(Path("out"), "the current folder, which no longer exists")


def test_results_json_alone_does_not_make_a_folder_ours(tmp_path: Path) -> None:
    """`--out .` where another program's results.json lies beside the study."""
    (tmp_path / "results.json").write_text('{"schema": "pinstress-results/2"}')
    (tmp_path / "study.toml").write_text(SLOW)
    refused(tmp_path, r"contains results\.json, study\.toml, but no list of what pinstress wrote")
    assert names(tmp_path) == ["results.json", "study.toml"]


def test_a_file_that_the_user_added_is_named_and_kept(earlier: Path) -> None:
    (earlier / "plots").mkdir()
    (earlier / "plots" / "notes.txt").write_text("mine")
    (earlier / "study.toml").write_text("mine")
    refused(
        earlier, r"contains plots/, study\.toml, plots/notes\.txt, which pinstress did not write"
    )
    assert (earlier / "plots" / "notes.txt").read_text() == "mine"
    (earlier / "plots" / "notes.txt").unlink()
    (earlier / "plots").rmdir()
    (earlier / "study.toml").unlink()
    (earlier / "results.json").write_text("edited: it is ours to replace")
    with replacing(earlier) as staging:
        (staging / "results.json").write_text("next")
    assert (earlier / "results.json").read_text() == "next"


def test_a_file_that_is_added_while_a_run_writes_is_kept_too(earlier: Path) -> None:
    def run() -> None:
        with replacing(earlier) as staging:
            (staging / "results.json").write_text("next")
            (earlier / "notes.txt").write_text("mine")

    with pytest.raises(InputError, match=r"contains notes\.txt, which"):
        run()
    assert (earlier / "notes.txt").read_text() == "mine"
    assert (earlier / "results.json").read_text() == "earlier"
    assert names(earlier.parent) == ["out"]


def test_a_list_that_names_files_elsewhere_removes_none_of_them(tmp_path: Path) -> None:
    """A folder that came from somebody else, with a list and a link that he made."""
    home, out = tmp_path / "home", tmp_path / "out"
    for folder in (home, out):
        folder.mkdir()
        (folder / "thesis.doc").write_text("years of work")
    (out / "results.json").write_text("{}")
    (out / "vtk").symlink_to(home)
    files = [
        "results.json",
        "vtk",
        "vtk/thesis.doc",
        "../home/thesis.doc",
        str(home / "thesis.doc"),
    ]
    (out / manifest.MANIFEST_FILE).write_text(
        json.dumps({"schema": manifest.MANIFEST_SCHEMA, "files": files})
    )
    refused(out, r"contains thesis\.doc, which pinstress did not write")
    (out / "thesis.doc").unlink()
    with replacing(out) as staging:
        (staging / "results.json").write_text("next")
    assert (home / "thesis.doc").read_text() == "years of work"
    assert names(tmp_path) == ["home", "out"]


@each("text", ["", "[]", "{}", '{"schema": 1, "files": []}', "\0", '{"schema'])
def test_a_list_that_is_none_makes_nothing_ours(text: str, tmp_path: Path) -> None:
    (tmp_path / "results.json").write_text("{}")
    (tmp_path / manifest.MANIFEST_FILE).write_text(text)
    refused(tmp_path, "no list of what pinstress wrote")
    assert names(tmp_path) == [manifest.MANIFEST_FILE, "results.json"]


def test_a_list_that_was_being_written_when_its_process_was_killed_is_ours(earlier: Path) -> None:
    """As `plots` and `pdf` write it, into results that are complete."""
    (earlier / f"{manifest.MANIFEST_FILE}.partial").write_text('{"sch')
    manifest.add(earlier, ["more"])
    assert "more" in (manifest.listed(earlier) or set())
    (earlier / f"{manifest.MANIFEST_FILE}.partial").write_text('{"sch')
    with replacing(earlier) as staging:
        (staging / "results.json").write_text("next")
    assert (earlier / "results.json").read_text() == "next"
    assert names(earlier.parent) == ["out"]


def test_a_folder_of_which_all_but_the_list_was_deleted_is_replaced(earlier: Path) -> None:
    """As `rm -r out/*` leaves it."""
    for name in names(earlier):
        if name != manifest.MANIFEST_FILE:
            (earlier / name).unlink()
    with replacing(earlier) as staging:
        (staging / "results.json").write_text("next")
    assert (earlier / "results.json").read_text() == "next"

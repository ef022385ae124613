"""Fixtures that tests in several folders share."""

# ruff: noqa: E402  (the number of threads is limited before numpy is imported)

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from multiprocessing import resource_tracker
from pathlib import Path

import pytest
from hypothesis import settings

from pinbase.processes.threads import hold_threads

hold_threads()  # as the command does: its results are compared with those of this process

from fea.core.material import Material
from geometry import Pin, Segment
from geometry.imported.body_file import BodyFile
from loads import Linkage
from pinbase.platform import portable
from pinstress import load_study
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.file import Study
from tests import seconds
from tests.support.near import scaled
from tests.support.programs.command_line import pinstress
from tests.support.programs.once import Shipped, once
from tests.support.programs.process_group import children
from tests.support.programs.swept import LONG_SWEEP
from tests.support.programs.terminal import on_terminal

os.environ.pop("COLUMNS", None)  # set in the workers of xdist, but seldom by users
os.environ["PINSTRESS_CACHE"] = ""  # tests solve anew, in other processes too

pytest.approx = scaled  # type: ignore[assignment]  # as all tests call it

resource_tracker.ensure_running()  # the tracker of spawned processes, which stays to the end

ROOT = Path(__file__).parent.parent
INCH = 0.0254
LBF = 0.45359237 * 9.80665
PSI = LBF / INCH**2

# By default an example that takes longer than 0.2 s, as any may on a busy machine, fails its
# test.
settings.register_profile("no clock", deadline=None)
settings.load_profile("no clock")


@pytest.hookimpl(tryfirst=True)  # before pytest itself deselects tests by their marks
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect the tests that need other programs, and long ones, unless `-m` names their mark;
    under PINSTRESS_PORTABLE=1 also those that run on Linux only. Mark the tests listed as slow with
    `seconds`.

    This is done here and not in addopts, where any other `-m` would select them again.
    """
    listed = seconds.functions()
    for item in items:
        if item.nodeid.partition("[")[0] in listed:
            item.add_marker(pytest.mark.seconds)
    without = ["long", "peers", "browser", *(["linux"] if portable() else [])]
    for mark in without:
        if mark in config.getoption("markexpr"):
            continue
        left_out = [item for item in items if item.get_closest_marker(mark)]
        if left_out:
            config.hook.pytest_deselected(items=left_out)
            items[:] = [item for item in items if item not in left_out]


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Nothing that is imported meanwhile is garbage, and to look for some took half of the time."""
    gc.disable()
    yield
    gc.freeze()
    gc.enable()


@pytest.fixture(autouse=True)
def _no_process_is_left() -> Iterator[None]:
    """Fail the test that leaves a process behind, rather than one that runs later."""
    before = children()
    yield
    left = children() - before
    for process in left:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    assert not left, "the test has left a process behind"


@pytest.fixture
def read_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Read files of pins in this process, since starting another takes longer than reading one.

    That they are read in another is tested in pinstress/study/model/test_read_body.py.
    """

    def here(work: Callable[..., object], file: BodyFile, *arguments: object) -> object:
        return work(file, *arguments)

    monkeypatch.setattr("pinstress.study.model.imported_pin.apart", here)


@pytest.fixture(scope="session")
def shipped(tmp_path_factory: pytest.TempPathFactory) -> Shipped:
    """Return a function from the name of a shipped study to its folder of results.

    The command runs each study once for all tests. The files "status" and "terminal" beside the
    folder hold its exit status and what it printed on 80 columns.
    """

    def found(study: str) -> Path:
        def run(folder: Path) -> None:
            out, path = folder / "out", ROOT / "studies" / f"{study}.toml"
            command = [sys.executable, "-m", "pinstress", "run", str(path), "--out", str(out)]
            status, printed = on_terminal([*command, "--quiet"], folder)
            assert status in (0, 1), printed
            (folder / "status").write_text(str(status))
            (folder / "terminal").write_text(printed, encoding="utf-8")

        return once(tmp_path_factory, f"study-{study}", run) / "out"

    return found


@pytest.fixture(scope="session")
def whole_sweep(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Return the table that one process writes for LONG_SWEEP, made once for all tests that
    interrupt it.
    """

    def sweep(folder: Path) -> None:
        (folder / "study.toml").write_text(LONG_SWEEP, encoding="utf-8")
        options = "--jobs", "1", "--out", "out"
        made = pinstress("sweep", "study.toml", *options, cwd=folder)
        assert made.returncode == 0, made.stderr

    return (once(tmp_path_factory, "sweep", sweep) / "out" / "designs.parquet").read_bytes()


@pytest.fixture(scope="session")
def gear() -> Study:
    """Return the study of the landing gear as shipped."""
    return load_study(ROOT / "studies" / "grenier2008.toml")


@pytest.fixture(scope="session")
def gear_linkage(gear: Study) -> Linkage:
    return linkage(gear)


@pytest.fixture(scope="session")
def steel() -> Material:
    return Material("steel", 2.0e11, 0.3, 7850.0, 1.0e9)


@pytest.fixture(scope="session")
def cantilever_pin() -> Pin:
    """Return a 20 mm shaft on a 30 mm root with a 5 mm fillet, loaded over its last 20 mm."""
    return Pin(
        "P",
        (Segment(0.02, 0.03), Segment(0.02, 0.02), Segment(0.02, 0.02, connection="P1")),
        fillet=0.005,
    )

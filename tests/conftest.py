"""Fixtures that several rooms share."""

# ruff: noqa: E402  (threads are limited before numpy is imported)

from __future__ import annotations

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

hold_threads()  # as the command does, whose numbers are compared

from fea.core.material import Material
from geometry import Pin, Segment
from geometry.imported.body_file import BodyFile
from loads import Linkage
from pinbase.platform import portable
from pinstress import load_study
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.file import Study
from tests import seconds
from tests.support.programs.command_line import pinstress
from tests.support.programs.once import Shipped, once
from tests.support.programs.process_group import children
from tests.support.programs.swept import LONG_SWEEP
from tests.support.programs.terminal import on_terminal

os.environ.pop("COLUMNS", None)  # which workers of xdist have, and users seldom
os.environ["PINSTRESS_CACHE"] = ""  # what is tested is solved, in other processes too

resource_tracker.ensure_running()  # of processes started anew; it stays to the end

ROOT = Path(__file__).parent.parent
INCH = 0.0254
LBF = 0.45359237 * 9.80665
PSI = LBF / INCH**2

# Else an example that takes longer than 0.2 s, as any may on a busy machine, fails its test.
settings.register_profile("no clock", deadline=None)
settings.load_profile("no clock")


@pytest.hookimpl(tryfirst=True)  # before tests are left out by marks
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Tests that need other programs and long ones are left out unless `-m` names them, and those
    of what Linux alone has under PINSTRESS_PORTABLE=1. Listed ones have the mark `seconds`.

    Here and not in addopts, where any other `-m` would bring them back.
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


@pytest.fixture(autouse=True)
def _no_process_is_left() -> Iterator[None]:
    """A test that leaves a process behind fails, and not one that runs later."""
    before = children()
    yield
    left = children() - before
    for process in left:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    assert not left, "the test has left a process behind"


@pytest.fixture
def read_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files of pins are read in this process: to start another takes longer than to read one.

    That they are read in another is tested in pinstress/study/model/test_read_body.py.
    """

    def here(work: Callable[..., object], file: BodyFile, *arguments: object) -> object:
        return work(file, *arguments)

    monkeypatch.setattr("pinstress.study.model.imported_pin.apart", here)


@pytest.fixture(scope="session")
def shipped(tmp_path_factory: pytest.TempPathFactory) -> Shipped:
    """The folder of results of a shipped study, which the command has run once for all tests; the
    files "status" and "terminal" beside it have how it ended and what it printed in 80 columns.
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
    """The table that one process makes of LONG_SWEEP, once for all tests that interrupt it."""

    def sweep(folder: Path) -> None:
        (folder / "study.toml").write_text(LONG_SWEEP, encoding="utf-8")
        options = "--jobs", "1", "--out", "out"
        made = pinstress("sweep", "study.toml", *options, cwd=folder)
        assert made.returncode == 0, made.stderr

    return (once(tmp_path_factory, "sweep", sweep) / "out" / "designs.parquet").read_bytes()


@pytest.fixture(scope="session")
def gear() -> Study:
    """The landing gear as it ships."""
    return load_study(ROOT / "studies" / "grenier2008.toml")


@pytest.fixture(scope="session")
def gear_linkage(gear: Study) -> Linkage:
    return linkage(gear)


@pytest.fixture(scope="session")
def steel() -> Material:
    return Material("steel", 2.0e11, 0.3, 7850.0, 1.0e9)


@pytest.fixture(scope="session")
def cantilever_pin() -> Pin:
    """20 mm shaft on a 30 mm root, 5 mm fillet, loaded over its last 20 mm."""
    return Pin(
        "P",
        (Segment(0.02, 0.03), Segment(0.02, 0.02), Segment(0.02, 0.02, connection="P1")),
        fillet=0.005,
    )

"""The estimate of memory beside what was measured, and what is done with it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from fea.core import memory
from fea.core.linear_solver import SolveError
from fea.core.memory import (
    allowed_memory,
    local_memory,
    require_memory,
    section_memory,
    solid_memory,
    too_much,
)
from pinbase.processes.free_memory import free_memory
from tests.support.each import each
from tests.support.errors import raises


def solvers(monkeypatch: pytest.MonkeyPatch, cholmod: bool, metis: bool) -> None:
    monkeypatch.setattr(memory, "has_cholmod", lambda: cholmod)
    monkeypatch.setattr(memory, "has_metis", lambda: metis)


@each(
    ("cholmod", "metis", "measured"),
    [
        (True, False, [(17_949, 121), (54_045, 555)]),
        (False, True, [(17_949, 128), (54_045, 616)]),
        (False, False, [(17_949, 166), (38_952, 600), (54_045, 921)]),
    ],
)
def test_other_solvers_take_more(
    cholmod: bool,
    metis: bool,
    measured: list[tuple[int, float]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    solvers(monkeypatch, cholmod, metis)
    for unknowns, megabytes in measured:
        assert megabytes < solid_memory(unknowns) < 1.8 * megabytes


@each(
    ("unknowns", "measured"),
    [(28_509, 212), (58_000, 396), (61_263, 369), (114_552, 791), (128_000, 964), (415_000, 5054)],
)
def test_it_is_near_what_was_measured(
    unknowns: int, measured: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    solvers(monkeypatch, True, True)
    assert 0.95 * measured < solid_memory(unknowns) < 1.4 * measured


@each(
    ("unknowns", "loads", "measured"),
    [(53_748, 10, 222), (107_988, 10, 457), (216_438, 10, 930), (24_708, 294, 1138)],
)
def test_so_it_is_of_a_section(unknowns: int, loads: int, measured: float) -> None:
    assert 0.95 * measured < section_memory(unknowns, loads) < 1.4 * measured
    assert f"{unknowns:,} unknowns" in too_much(unknowns, 0.9 * measured, loads)
    assert not too_much(unknowns, 1.5 * measured, loads)


@each(("unknowns", "measured"), [(52_371, 303), (256_089, 1266)])
def test_and_of_a_local_solid(unknowns: int, measured: float) -> None:
    assert 0.95 * measured < local_memory(unknowns, 6) < 1.4 * measured
    assert not too_much(unknowns, 1.4 * measured, local_loads=6)
    assert too_much(unknowns, 0.9 * measured, local_loads=6)


@pytest.mark.linux
def test_there_is_memory_and_most_of_it_is_allowed() -> None:
    assert 100.0 < free_memory() < 1e8
    assert 0.0 < allowed_memory(None) < 1e8
    assert allowed_memory(12.0) == 12.0


def test_too_large_a_solid_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    solvers(monkeypatch, True, True)
    require_memory("P", 1000, 10.0)
    with raises(SolveError, "memory-limit", "pin P: ", "4,000,000 unknowns", "98 GB"):
        require_memory("P", 4_000_000, 1000.0)


@pytest.mark.linux
def test_where_the_system_says_nothing_4_gb_are_assumed(monkeypatch: pytest.MonkeyPatch) -> None:
    read_text, meminfo = Path.read_text, ""

    def text(self: Path, *how: Any, **more: Any) -> str:
        if not self.is_relative_to("/proc") and not self.is_relative_to("/sys"):
            return read_text(self, *how, **more)  # of libraries that are imported here first
        if meminfo and self.name == "meminfo":
            return meminfo
        raise FileNotFoundError(self)

    monkeypatch.setattr(Path, "read_text", text)
    assert free_memory() == 4096.0
    require_memory("P", 200_000, None)
    require_memory("P", 10**9, math.inf)
    with pytest.raises(SolveError, match=r"3\.2 GB are allowed \(--memory-limit\)"):
        require_memory("P", 10**6, None)
    meminfo = "MemTotal: 9 kB\nMemAvailable:  2048 kB\n"
    assert free_memory() == 2.0
    assert allowed_memory(None) == pytest.approx(1.6)

"""Designs that a cluster solved for a reliability study before it was lost are not solved again.

The cluster is this process, which is lost when the test says so; a real one is in
tests/silent/test_encrypted_cluster.py. The independent values are the rows of an evaluator of which
nothing was kept.
"""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import pinstress.explore.reliability.on_cluster as module
from pinbase.processes.interrupts import Unfinished
from pinstress.analysis.cache import Cache
from pinstress.explore.reliability.on_cluster import design_rows
from pinstress.explore.sweep.batches import DesignProblem, solve_batch
from pinstress.explore.sweep.evaluate import Evaluator
from pinstress.explore.sweep.number import number_at
from pinstress.explore.sweep.workers import BatchQueue
from pinstress.study.reading.errors import InputError
from tests.support.programs.command_line import QUICK
from tests.support.programs.swept import FORCE, STRENGTH, swept

LOADS = f'"{FORCE}" = {{ uniform = [-1000, -500] }}'
COUNT = 9
LOST = InputError("--scheduler: the connection is lost", code="no-scheduler")


@pytest.mark.parametrize("end", [LOST, KeyboardInterrupt()])
def test_what_a_lost_cluster_has_solved_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, end: BaseException
) -> None:
    study = swept(LOADS, text=QUICK)
    problem = DesignProblem.of(study, [number_at(study, FORCE), number_at(study, STRENGTH)])
    values = np.stack([np.linspace(-900.0, -500.0, COUNT), np.linspace(1e9, 2e9, COUNT)], axis=1)
    cluster: Any = SimpleNamespace(workers=1)
    solved: list[int] = []
    most = 4

    def solve_on(_: object, problem: DesignProblem, __: object, work: BatchQueue) -> None:
        while (batch := work.take()) is not None:
            if len(solved) >= most:
                raise end
            solved.extend(batch.designs)
            work.done(solve_batch(problem, batch))

    monkeypatch.setattr(module, "solve_on", solve_on)
    cache, told = Cache(tmp_path, "this program"), list[int]()
    with pytest.raises((InputError, Unfinished), match="are kept in the cache: the same command"):
        design_rows(cluster, problem, cache, values, told.append)
    before, most = list(solved), 10 * COUNT
    assert 4 <= len(before) < COUNT
    rows = design_rows(cluster, problem, cache, values, told.append)
    assert sorted(solved) == list(range(COUNT))  # each one once
    evaluator = Evaluator(study, problem.numbers)
    assert rows == [evaluator.rows(tuple(map(float, design))) for design in values]
    assert told[-1] == COUNT
    for other, of in ((values + 1.0, cache), (values, Cache(tmp_path, "another")), (values, None)):
        solved.clear()  # others are not mistaken for them
        design_rows(cluster, problem, of, other, told.append)
        assert len(solved) == COUNT

"""Sweeps: their table, its bytes, its parts, and the batches in which designs are solved."""

from __future__ import annotations

import json
from collections import Counter
from functools import partial
from multiprocessing import resource_tracker
from pathlib import Path

import numpy as np
import pandas
import pyarrow as pa
import pytest
from pyarrow import parquet
from rich.console import Console

import pinstress
from pinstress import InputError
from pinstress.explore.sweep.batches import (
    BATCH_OVERHEAD_SECONDS,
    MAX_BATCH_DESIGNS,
    TARGET_BATCH_SECONDS,
    Batch,
    Batches,
    DesignProblem,
    SolvedBatch,
    aim_of,
    solve_batch,
)
from pinstress.explore.sweep.connection import connection_to
from pinstress.explore.sweep.number import number_at
from pinstress.explore.sweep.parameters import parameters_of
from pinstress.explore.sweep.parts import BatchFolder, Identity, identity, is_ours
from pinstress.explore.sweep.summary import summary
from pinstress.explore.sweep.sweep import MemoryStore, planned, solved
from pinstress.explore.sweep.table import assembled, facts, write_table
from pinstress.explore.sweep.workers import BatchQueue, failed_rows
from tests.support.programs.command_line import QUICK
from tests.support.programs.swept import DEADLY, DIAMETER, FORCE, STRENGTH, swept
from tests.support.results.made_up_designs import made_up_designs

resource_tracker.ensure_running()  # multiprocessing's, which stays to the end

VARIED = f"""
"{DIAMETER}" = {{ from = "1.5 in", to = "4.5 in", steps = 3 }}
"{FORCE}" = {{ normal = ["-988 lbf", 100], steps = 2 }}
"{STRENGTH}" = {{ normal = ["225 ksi", "5 ksi"], steps = 2 }}
"""


@pytest.fixture(scope="module")
def table() -> pa.Table:
    return pinstress.sweep(swept(VARIED, "", QUICK))


def test_a_row_for_each_design_pin_and_case(table: pa.Table) -> None:
    assert table["design"].to_pylist() == list(range(1, 13))
    assert set(table["pin"].to_pylist()) == {"B"}
    assert table.column_names == [
        "design", "pin", "case", DIAMETER, FORCE, STRENGTH, "max_von_mises", "error_estimate",
        "safety_factor", "outcome", "depends_on", "verdict", "governing_time", "mass", "reason",
        "code", "governs", "surface", "section", "beneath", "beneath_error",
    ]  # fmt: skip
    np.testing.assert_allclose(np.unique(table[DIAMETER]), [1.5, 3.0, 4.5])
    factor = np.array(table["safety_factor"].to_pylist()[:8], float)
    stress = np.array(table["max_von_mises"].to_pylist()[:8], float)
    np.testing.assert_allclose(factor, table[STRENGTH].to_numpy()[:8] / stress, rtol=1e-14)


def test_what_fails_has_a_reason(table: pa.Table) -> None:
    """A band wider than the shoulder next to it, whose fillet is as large as the step."""
    rows = table.slice(8).to_pylist()
    assert {row["code"] for row in rows} == {"fillet-too-large"}
    assert all(row["max_von_mises"] is None and row["verdict"] == "failed" for row in rows)
    assert rows[0]["reason"].startswith("pin B: the fillet between segments 1 and 2")


def test_units_and_the_study_are_in_the_file(table: pa.Table, tmp_path: Path) -> None:
    path = tmp_path / "designs.parquet"
    write_table(table, path)
    read = parquet.read_table(path)
    units = {f.name: f.metadata[b"unit"].decode() for f in read.schema}
    assert units[DIAMETER] == "in"
    assert units["max_von_mises"] == units[STRENGTH] == "psi"
    assert units["mass"] == "lb"
    volume = np.pi / 4.0 * (4.0**2 * 1.5 + 1.5**2 * 2.0)  # in^3, without the fillet
    assert read["mass"][0].as_py() == pytest.approx(0.2836 * volume, rel=0.03)
    assert units["pin"] == ""
    stated = facts(read)
    study = swept(VARIED, "", QUICK)
    assert stated["hash"] == study.sha256
    assert stated["units"] == "in-lbf-s"
    assert stated["required_safety_factor"] == 10.0
    assert stated["parameters"][DIAMETER] == {"unit": "in", "law": "uniform from 1.5 in to 4.5 in"}
    assert json.dumps(stated, ensure_ascii=False).encode() == read.schema.metadata[b"pinstress"]
    assert [p.name for p in tmp_path.iterdir()] == ["designs.parquet"]


def test_pandas_reads_it(table: pa.Table, tmp_path: Path) -> None:
    write_table(table, tmp_path / "designs.parquet")
    frame = pandas.read_parquet(tmp_path / "designs.parquet")
    assert frame.groupby(DIAMETER)["safety_factor"].max().round(3).iloc[0] > 10.0
    assert frame["max_von_mises"].isna().sum() == 4


def test_the_file_has_plain_columns(table: pa.Table, tmp_path: Path) -> None:
    """Numbers and texts that every reader of Parquet knows: none nested, of an extension, or with a
    dictionary as its type.
    """
    write_table(table, tmp_path / "designs.parquet")
    file = parquet.ParquetFile(tmp_path / "designs.parquet")
    kinds = {"INT64": None, "DOUBLE": None, "BYTE_ARRAY": "STRING"}
    for k, name in enumerate(table.column_names):
        column = file.schema.column(k)
        assert (column.name, column.path, column.max_repetition_level) == (name, name, 0)
        logical = column.logical_type.type
        assert logical == (kinds[column.physical_type] or "NONE")
    arrow = {str(field.type) for field in file.schema_arrow}
    assert arrow == {"int64", "double", "string"}


def test_batches_of_any_size_in_any_order_give_the_same_bytes(
    table: pa.Table, tmp_path: Path
) -> None:
    study = swept(VARIED, "", QUICK)
    sweep = planned(study)
    designs = np.random.default_rng(3).permutation(12).tolist()
    store = MemoryStore()
    from pinstress.explore.sweep.table import table_of

    for some in (designs[:1], designs[1:6], designs[6:]):
        batch = Batch(tuple(some), tuple(tuple(sweep.values[i].tolist()) for i in some))
        done = solve_batch(sweep.problem, batch)
        each = sorted(zip(done.batch.designs, batch.values, done.rows, strict=True))
        store.write(table_of(study, sweep.parameters, [(i + 1, v, r) for i, v, r in each]))
    whole = assembled(store.read(table.schema))
    for name, found in (("a", table), ("b", whole)):
        write_table(found, tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_only_what_is_missing_is_solved(table: pa.Table, monkeypatch: pytest.MonkeyPatch) -> None:
    import pinstress.explore.sweep.workers as module

    batches: list[Batch] = []
    whole = solve_batch

    def noted(problem: DesignProblem, batch: Batch) -> SolvedBatch:
        batches.append(batch)
        return whole(problem, batch)

    monkeypatch.setattr(module, "solve_batch", noted)
    store = MemoryStore()
    store.write(table.slice(2, 7))
    told: list[tuple[int, int]] = []
    found = solved(
        planned(swept(VARIED, "", QUICK)), store, jobs=1, report=lambda *x: told.append(x)
    )
    assert found.equals(table, check_metadata=True)
    assert sorted(i for b in batches for i in b.designs) == [0, 1, 9, 10, 11]
    assert told[0] == (7, 12)
    assert told[-1] == (12, 12)


def test_designs_of_the_same_shape_follow_each_other_in_a_batch() -> None:
    study = swept(VARIED)
    numbers = [p.number for p in parameters_of(study)]
    values = np.random.default_rng(1).integers(1, 4, (40, 3)).astype(float)
    batches = Batches(numbers, values, {5, 6}, 2)
    order = []
    for batch in batches:
        batches.learn(SolvedBatch(batch, [], 0.01 * len(batch.designs)))
        order += list(batch.designs)
    assert sorted(order) == sorted(set(range(40)) - {5, 6})
    assert (np.diff(values[order, 0]) >= 0.0).all()


def test_batches_are_as_long_as_they_should_be() -> None:
    numbers = [number_at(swept(VARIED), FORCE)]
    for seconds, size in (
        (0.1, round(TARGET_BATCH_SECONDS / 0.1)),
        (5.0, 1),
        (1e-5, MAX_BATCH_DESIGNS),
    ):
        batches = Batches(numbers, np.zeros((100_000, 1)), set(), 2)
        first = batches.next()
        assert len(first.designs) == 1
        batches.learn(SolvedBatch(first, [], seconds))
        assert len(batches.next().designs) == size


def test_many_processes_get_larger_batches() -> None:
    """So that handing out one to each takes no longer than solving it."""
    assert aim_of(1) == aim_of(250) == TARGET_BATCH_SECONDS
    assert aim_of(1000) == pytest.approx(1000 * BATCH_OVERHEAD_SECONDS)
    problem = planned(swept(VARIED, "", QUICK)).problem
    batches = Batches(problem.numbers, np.zeros((200_000, 2)), set(), 1000)
    batches.learn(SolvedBatch(batches.next(), [], 0.1))
    assert len(batches.next().designs) == round(1000 * BATCH_OVERHEAD_SECONDS / 0.1)


def test_parts_are_of_one_sweep_and_damaged_ones_are_solved_again(
    table: pa.Table, tmp_path: Path
) -> None:
    parts = BatchFolder(tmp_path, Identity("one", "any", 6, "random"))
    assert not parts.there()
    with pytest.raises(InputError) as raised:
        parts.require_same()
    assert raised.value.code == "nothing-to-resume"
    parts.begin()
    parts.require_same()
    parts.write(table.slice(0, 3))
    parts.write(table.slice(3, 4))
    (parts.folder / "00000099.parquet").write_bytes(b"PAR1 and no more")
    found = parts.read(table.schema)
    assert [t.num_rows for t in found] == [3, 4]
    assert parts.count == 2
    with pytest.raises(InputError) as raised:
        BatchFolder(tmp_path, Identity("two", "other", 6, "random")).require_same()
    assert raised.value.code == "other-sweep"
    names = {f"parts/{p.name}" for p in parts.folder.iterdir()} | {"parts/"}
    assert all(map(is_ours, names))
    assert not any(map(is_ours, ("parts/notes.txt", "other/1.parquet", "parts/x.parquet")))
    parts.finish()
    assert parts.finished
    assert not parts.folder.exists()


def test_a_sweep_is_known_by_its_study_vary_pins_and_cases() -> None:
    study = swept(VARIED, "", QUICK)
    other = swept(VARIED.replace("steps = 3", "steps = 4"), "", QUICK)
    known = [
        identity(study, None, None), identity(study, ["B"], None), identity(study, None, ["x"]),
        identity(other, None, None),
    ]  # fmt: skip
    assert len({x.sweep for x in known}) == len({x.but_count for x in known}) == 4
    assert identity(study, None, None) == known[0]
    few, more = (identity(swept(VARIED, f"count = {n}", QUICK), None, None) for n in (200, 300))
    assert few.sweep != more.sweep
    assert few.but_count == more.but_count
    assert (few.count, more.count) == (200, 300)


def test_designs_whose_process_died_are_rows() -> None:
    done = failed_rows((("B", "landing"), ("C", "landing")), Batch((4,), ((1.0,),)))
    assert [(row.pin, row.verdict, row.code) for row in done.rows[0]] == [
        ("B", "failed", "process-died"),
        ("C", "failed", "process-died"),
    ]
    assert Batch((1, 2, 3), ((1.0,), (2.0,), (3.0,))).halves() == (
        Batch((1,), ((1.0,),)),
        Batch((2, 3), ((2.0,), (3.0,))),
    )


def test_a_scheduler_that_does_not_answer_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    import pinstress.explore.sweep.cluster as module

    monkeypatch.setattr(module, "SCHEDULER_TIMEOUT", 0.5)
    connection = connection_to("tcp://127.0.0.1:1")
    assert connection is not None
    with pytest.raises(InputError, match="no scheduler of dask answers at") as raised:
        module.connected(connection, (), print).__enter__()
    assert raised.value.code == "no-scheduler"


def test_a_batch_whose_process_died_is_halved_and_its_last_design_solved_alone() -> None:
    """The design that does it is given up when it does it alone, and no other one."""
    numbers = [number_at(swept(VARIED), FORCE)]
    batches = Batches(numbers, np.zeros((9, 1)), set(), 1)
    batches.learn(SolvedBatch(Batch((0,), ((0.0,),)), [], 1e-3))
    kept: list[tuple[int, ...]] = []
    lost = partial(failed_rows, (("B", "landing"),))
    work = BatchQueue(batches, lambda done: kept.append(done.batch.designs), lost)
    killed = {3}  # beside others by another one's need of memory, and then by its own
    together = [work.take(), work.take()]
    while (batch := together.pop() if together else work.take()) is not None:
        if {DEADLY} & set(batch.designs) or killed & set(batch.designs):
            killed -= set(batch.designs) if len(batch.designs) == 1 else set()
            work.died(batch)
        else:
            work.done(SolvedBatch(batch, [], 0.0))
    assert sorted(i for designs in kept for i in designs) == list(range(9))


def test_rows_that_are_not_converged_are_counted(capsys: pytest.CaptureFixture[str]) -> None:
    """A factor of a row with half of its stress as error is no result like others."""
    table = made_up_designs(40, 2, failing=0.1)
    found = Counter(table["verdict"].to_pylist())
    summary(table, Console(width=200))
    rough = found["unconverged"] + found["singular"]
    told = capsys.readouterr().out
    assert f"not converged (see verdict, error_estimate): B {rough}\n" in told
    assert f" of {40 - found['failed']} solved\n" in told


def test_a_factor_that_is_missed_is_not_rounded_to_it(capsys: pytest.CaptureFixture[str]) -> None:
    """It was "1.500 to 3.000", with one design below 1.5."""
    table = made_up_designs(2, 1, failing=0.0)
    at = table.column_names.index("safety_factor")
    table = table.set_column(at, table.schema.field(at), [pa.array([1.49999, 3.0])])
    summary(table, Console(width=200))
    told = capsys.readouterr().out
    assert "1.49999 to 3.000" in told
    assert "the required factor of 1.5: B 1" in told


def test_a_design_without_stress_is_the_best(capsys: pytest.CaptureFixture[str]) -> None:
    """It was left out, and the best was the next, or none where there was no other."""
    for stresses, factors, told in (
        ([0.0, 500.0, 250.0], [None, 2.0, 4.0], "2.000 to 4.000 2 1"),
        ([500.0, 0.0, 250.0], [None, None, None], "– 1 2"),
    ):
        table = made_up_designs(3, 1, failing=0.0)
        for name, values in ("max_von_mises", stresses), ("safety_factor", factors):
            at = table.column_names.index(name)
            field = table.schema.field(at)
            table = table.set_column(at, field, [pa.array(values, field.type)])
        summary(table, Console(width=200))
        lines = capsys.readouterr().out.splitlines()
        (line,) = (" ".join(line.split()) for line in lines if line.startswith("B"))
        assert line.startswith(f"B {told} 500"), line


UNHELD = """
title = "A pin that is not held in one of two cases"
units = "mm-N-s"
material.steel = { youngs_modulus = "205 GPa", poisson_ratio = 0.3, yield_strength = 600 }
case.pull = { kind = "given", forces = { L = [500, 0], R = [-500, 0] } }
case.push = { kind = "given", forces = { L = [500, 0], R = [-100, 0] } }
analysis = { required_safety_factor = 2, tolerance = 0.2, model = "beam" }
vary.parameters."pin.P.profile[1].length" = { from = 10, to = 11, steps = 2 }
[pin.P]
material = "steel"
profile = [
  { length = 10, diameter = 20, connection = "L" },
  { length = 10, diameter = 20, connection = "R" },
]
"""


def test_pins_that_are_not_held_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    """Nothing is known of their factor in that case, and the factors of others are not all."""
    summary(pinstress.sweep(pinstress.study_from(UNHELD)), Console(width=200))
    told = capsys.readouterr().out
    assert told.startswith("2 designs, 2 failed in some row\n  2 couple-imbalance: for instance")
    assert "P 0 of 0 solved" in told

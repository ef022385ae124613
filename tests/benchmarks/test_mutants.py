"""Mutation testing: every change is one, and is a change."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from benchmarks import mutants as module
from benchmarks import record as record_module
from benchmarks.mutants import FILES, SAME, mutants
from tests.conftest import ROOT

SOURCE = '''
"""Text 1 is left alone."""
FACTOR = -0.5


def area(r: float, on: bool = True) -> float:
    if r <= 0.0 and on:
        return 0
    return FACTOR * r**2
'''


def test_every_operator_comparison_sign_and_number_is_changed_once() -> None:
    changes = {m.change for m in mutants(SOURCE)}
    assert changes == {
        "-0.5 → +0.5",
        "0.5 → 0.55",
        "r <= 0.0 → r < 0.0",
        "r <= 0.0 and on → r <= 0.0 or on",
        "0.0 → 1.0",
        "0 → 1",
        "FACTOR * r ** 2 → FACTOR / r ** 2",
        "r ** 2 → r * 2",
        "2 → 3",
    }


def test_a_mutant_does_something_else() -> None:
    def value(tree: ast.Module) -> float:
        space: dict[str, object] = {}
        exec(compile(ast.fix_missing_locations(tree), "mutant", "exec"), space)
        area = space["area"]
        assert callable(area)
        return float(area(3.0) + 10.0 * area(0.0) + 100.0 * area(0.5) + 1000.0 * area(-1.0))

    true = value(ast.parse(SOURCE))
    same = [m.change for m in mutants(SOURCE) if value(m.tree) == pytest.approx(true)]
    assert same == ["r <= 0.0 → r < 0.0"]  # 0 either way: no test could notice it


def test_files_and_their_tests_are_there() -> None:
    for path, tests in FILES.items():
        assert (ROOT / path).is_file()
        assert all((ROOT / test).exists() for test in tests)


def test_reasons_are_of_lines_that_are_there() -> None:
    lines = {
        line.strip() for path in FILES for line in (ROOT / path).read_text("utf-8").splitlines()
    }
    assert all(line in lines for line, _ in SAME)


def test_files_are_tried_one_by_one_and_rows_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One change that is explained, and one that is not; other files keep what they have."""
    monkeypatch.setattr(module, "FOLDER", tmp_path)
    monkeypatch.setattr(record_module, "FOLDER", tmp_path)
    (tmp_path / "mutants.md").write_text(
        "| `fea/beam/stress_concentration.py` | 9 | 9 | 8 | 1 | |\n"
        "| … line 3: `a → b` | | | | | so |\n"
    )
    changes = [m.change for m in mutants((ROOT / "loads/landing/impulse.py").read_text("utf-8"))]
    passing = {ast.unparse(ast.parse((ROOT / "loads/landing/impulse.py").read_text("utf-8")))}
    monkeypatch.setattr(module, "survives", lambda path, tree, *_: ast.unparse(tree) in passing)
    assert module.main(["--record", "loads/landing/impulse.py"]) == 0
    text = (tmp_path / "mutants.md").read_text("utf-8")
    n = len(changes)
    assert f"| `loads/landing/impulse.py` | {n} | {n} | {n} | 0 | |" in text
    assert (
        "| `fea/beam/stress_concentration.py` | 9 | 9 | 8 | 1 | |\n"
        "| … line 3: `a → b` | | | | | so |\n" in text
    )
    passing |= {
        ast.unparse(m.tree) for m in mutants((ROOT / "loads/landing/impulse.py").read_text("utf-8"))
    }
    assert module.main(["--record", "--most=1", "loads/landing/impulse.py"]) == 1
    text = (tmp_path / "mutants.md").read_text("utf-8")
    assert f"| `loads/landing/impulse.py` | {n} | 1 | 0 | 1 | |" in text
    assert text.count("**not explained**") == 1

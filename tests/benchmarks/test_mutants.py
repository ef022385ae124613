"""Mutation testing: every change is one, and is a change."""

from __future__ import annotations

import ast

import pytest

from benchmarks.mutants import FILES, mutants
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

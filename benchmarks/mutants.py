"""Mutation testing of formulas: `make mutants`, or `python -m benchmarks.mutants loads/energy.py`.

One operator, comparison, sign or number of a file is changed at a time, and the tests that belong
to the file must fail. Nothing is written to the tree: a forked process, in which pytest and the
numeric libraries are loaded already, imports the changed module in place of the file. mutmut does
the like, but neither in tables of numbers nor in properties, where many of these formulas are.
"""

from __future__ import annotations

import ast
import copy
import importlib.util
import os
import random
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.machinery import ModuleSpec
from types import ModuleType

import numpy as np  # loaded once for all
import pytest
import scipy.optimize
import scipy.sparse.linalg
import skfem

from benchmarks.record import record

LOADED = (np, scipy, skfem)
FILES = {
    "fea/notch.py": ("tests/fea/test_notch.py", "tests/fea/test_beam_stress.py"),
    "fea/hand_checks.py": ("tests/fea/test_hand_checks.py",),
    "fea/stepped_beam.py": ("tests/fea/test_stepped_beam.py", "tests/fea/test_beam_stress.py"),
    "fea/elasticity.py": ("tests/fea/test_elasticity.py",),
    "fea/corner.py": ("tests/fea/test_corner.py", "tests/fea/test_corner_determinant.py"),
    "fea/tractions.py": ("tests/fea/test_bearing_pressure.py", "tests/fea/test_harmonic.py"),
    "fea/distributed_load.py": ("tests/validation/test_distributed_load.py",),
    "loads/forces.py": ("tests/loads/test_four_bar.py", "tests/loads/test_slider_crank.py",
                        "tests/loads/test_reactions.py"),
    "loads/energy.py": ("tests/loads/test_four_bar.py", "tests/loads/test_slider_crank.py"),
    "loads/impulse.py": ("tests/loads/test_reactions.py",),
}  # fmt: skip
ARITHMETIC = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
              ast.Pow: ast.Mult, ast.MatMult: ast.Mult}  # fmt: skip
COMPARISON = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
              ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}  # fmt: skip
OFF = 1.1  # times a number
MOST = 40  # mutants of a file, drawn at random
PATIENCE = 10.0  # times what the tests take without a change


@dataclass(frozen=True)
class Mutant:
    """A changed module, and what was changed in words."""

    line: int
    change: str
    tree: ast.Module


def mutants(source: str) -> Iterator[Mutant]:
    """Every single change of a module."""
    tree = ast.parse(source)
    nodes = list(ast.walk(tree))
    for place, node in enumerate(nodes):
        changed = _changed(node)
        if changed is None:
            continue
        other = copy.deepcopy(tree)
        target = list(ast.walk(other))[place]
        for name, value in ast.iter_fields(changed):
            setattr(target, name, value)
        target.__class__ = changed.__class__
        words = f"{ast.unparse(node)} → {ast.unparse(changed)}"
        yield Mutant(getattr(node, "lineno", 0), " ".join(words.split()), other)


def _changed(node: ast.AST) -> ast.expr | None:
    match node:
        case ast.BinOp(left, op, right) if type(op) in ARITHMETIC:
            if isinstance(right, ast.Constant) and isinstance(right.value, str):
                return None
            return ast.BinOp(left, ARITHMETIC[type(op)](), right)
        case ast.Compare(left, [op], right) if type(op) in COMPARISON:
            return ast.Compare(left, [COMPARISON[type(op)]()], right)
        case ast.BoolOp(op, values):
            return ast.BoolOp(ast.Or() if isinstance(op, ast.And) else ast.And(), values)
        case ast.UnaryOp(ast.USub(), operand):
            return ast.UnaryOp(ast.UAdd(), operand)
        case ast.Constant(bool() | str() | None):
            return None
        case ast.Constant(int() as value):
            return ast.Constant(value + 1)
        case ast.Constant(float() as value):
            return ast.Constant(value * OFF if value else 1.0)
    return None


class _Instead:
    """Finds and loads a changed module where its file would be."""

    def __init__(self, name: str, path: str, tree: ast.Module) -> None:
        self.name, self.path, self.tree = name, path, tree

    def find_spec(self, name: str, *_: object) -> ModuleSpec | None:
        if name != self.name:
            return None
        return importlib.util.spec_from_file_location(name, self.path, loader=self)  # type: ignore[arg-type]

    def create_module(self, _: ModuleSpec) -> None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        exec(compile(ast.fix_missing_locations(self.tree), self.path, "exec"), module.__dict__)


def survives(path: str, tree: ast.Module, tests: Sequence[str], limit: float) -> bool:
    """Whether all tests pass with a changed module; not if they take longer than the limit, s."""
    child = os.fork()
    if not child:
        os.setsid()  # with the processes it starts
        sys.meta_path.insert(0, _Instead(path[:-3].replace("/", "."), path, tree))
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        plain = ["-q", "-x", "-p", "no:randomly", "-p", "no:cacheprovider", "-p", "no:cov"]
        os._exit(int(pytest.main([*plain, "-m", "not slow and not peers", *tests])))
    end = time.monotonic() + limit
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status) == 0
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return False


def examined(path: str, most: int) -> str:
    """The mutants of a file that survive its tests, as a part of the table."""
    with open(path, encoding="utf-8") as file:
        source = file.read()
    start = time.monotonic()
    if not survives(path, ast.parse(source), FILES[path], 600.0):
        raise SystemExit(f"{path}: its tests fail without a change")
    limit = PATIENCE * (time.monotonic() - start) + 5.0
    every = list(mutants(source))
    drawn = sorted(random.Random(0).sample(every, min(most, len(every))), key=lambda m: m.line)
    left = [m for m in drawn if survives(path, m.tree, FILES[path], limit)]
    lines = [f"{path}: {len(drawn)} of {len(every)} mutants, {len(left)} survive"]
    return "\n".join(lines + [f"  line {m.line}: {m.change}" for m in left])


def main(arguments: list[str]) -> None:
    """Print the table of all files or those named; --record keeps it, --most=N: so many of each."""
    named = [a for a in arguments if not a.startswith("--")]
    most = next((int(a[7:]) for a in arguments if a.startswith("--most=")), MOST)
    parts = []
    for path in named or FILES:
        parts.append(examined(path, most))
        print(parts[-1], flush=True)
    if "--record" in arguments:
        record("mutants", "\n\n".join(parts), "python -m benchmarks.mutants")


if __name__ == "__main__":
    main(sys.argv[1:])

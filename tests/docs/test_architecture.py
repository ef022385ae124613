"""The page on the architecture names files and functions that are there, and true numbers."""

from __future__ import annotations

import ast
import re

import numpy as np
import pytest

from pinstress.pipeline import solve
from pinstress.plan import prepare
from pinstress.study import Study
from tests.conftest import LBF, ROOT

PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
NAMED = sorted(set(re.findall(r"`([\w/]+\.py)(?:: ([\w.]+))?`", PAGE)))


def defined(tree: ast.Module) -> set[str]:
    """Functions, classes, methods and constants of a module."""
    names = set()
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        if isinstance(node, ast.ClassDef):
            names |= {f"{node.name}.{f.name}" for f in node.body if isinstance(f, ast.FunctionDef)}
        if isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            names |= {t.id for t in targets if isinstance(t, ast.Name)}
    return names


def test_much_is_named() -> None:
    assert len(NAMED) > 50
    assert {path.split("/")[0] for path, _ in NAMED} >= {
        "loads",
        "geometry",
        "fea",
        "reports",
        "pinstress",
    }


@pytest.mark.parametrize(("path", "name"), NAMED, ids=": ".join)
def test_what_is_named_exists(path: str, name: str) -> None:
    text = (ROOT / path).read_text(encoding="utf-8")
    assert not name or name in defined(ast.parse(text))


def test_folders_exist() -> None:
    folders = re.findall(r"`(\w+(?:/\w+)*)/`", PAGE)
    assert len(folders) > 5
    assert all((ROOT / folder).is_dir() for folder in folders)


def test_the_number_is_what_the_page_says(gear: Study) -> None:
    plan = prepare(gear, pins=["E"], cases=["retract"])
    found = solve(plan).pins[0]
    forces = plan.loads["retract"].reactions
    told = re.search(r"E with ([\d.]+) lbf at\s+E1, ([\d.]+) at E2 and ([\d.]+) at E3", PAGE)
    assert told is not None
    at_end = [float(np.linalg.norm(forces.force(c)[-1])) / LBF for c in ("E1", "E2", "E3")]
    assert at_end == pytest.approx([float(x) for x in told.groups()], abs=0.06)
    meshes = re.search(r"excluded zones: ([\d., ]+) psi\s+on", PAGE)
    assert meshes is not None
    maxima = [float(x) for x in meshes[1].split(", ")]
    assert [h.max_von_mises for h in found.history] == pytest.approx(maxima, rel=2e-3)
    assert (found.time, found.verdict, found.left_out) == (4.0, "singular", ("E1",))
    assert f"{maxima[-1]} psi, t = 4 s, `singular`" in PAGE

"""The page on the architecture names files and functions that are there, and true numbers."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path
from types import FrameType

import numpy as np
import pytest

from docs.modules import listed
from pinstress.analysis.plan import prepare
from pinstress.analysis.results import solve
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import Study
from tests.conftest import LBF, ROOT
from tests.support.each import each

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
    assert len(NAMED) > 40
    assert {path.split("/")[0] for path, _ in NAMED} >= {
        "loads",
        "geometry",
        "fea",
        "reports",
        "pinstress",
    }


@each(("path", "name"), NAMED)
def test_what_is_named_exists(path: str, name: str) -> None:
    text = (ROOT / path).read_text(encoding="utf-8")
    assert not name or name in defined(ast.parse(text))


def test_every_module_says_what_it_is() -> None:
    """The list at the end of the page is made from the docstrings of modules."""
    text = "".join(listed())
    assert text.count("| `") > 400
    silent = [line for line in text.splitlines() if re.fullmatch(r"\| `\w+\.py` \|\s*\|", line)]
    assert silent == []


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
    error = re.search(r"the error of the last mesh is ([\d.]+) psi", PAGE)
    assert error is not None
    assert found.error_parts["mesh"] == pytest.approx(float(error[1]), abs=0.06)
    assert (found.time, found.verdict, found.left_out) == (4.0, "singular", ("E1",))
    assert f"{maxima[-1]} psi, t = 4 s, `singular`" in PAGE


@pytest.mark.slow
def test_the_path_is_walked_as_told(tmp_path: Path) -> None:
    """Every function of the path is called on the way of its number, by the command itself."""
    path = PAGE.split("## The path of one number")[1].split("\n## ")[0]
    told = {
        (file, name)
        for file, name in re.findall(r"`([\w/]+\.py): ([\w.]+)`", path)
        if not name.split(".")[-1][0].isupper()
    }
    assert len(told) > 20
    called = set()

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            called.add((frame.f_code.co_filename, frame.f_code.co_qualname))

    command = ["run", str(ROOT / "studies" / "grenier2008.toml"), "--pins", "E"]
    command += [
        "--cases",
        "retract",
        "--jobs",
        "1",
        "--out",
        str(tmp_path / "out"),
    ]
    sys.setprofile(note)
    try:
        assert run_command_line(command) == 1  # singular
    finally:
        sys.setprofile(None)
    missing = {(file, name) for file, name in told if (str(ROOT / file), name) not in called}
    assert not missing

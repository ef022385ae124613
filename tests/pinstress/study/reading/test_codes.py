"""Every error of bad input has a code, which programs can rely on while its message changes."""

from __future__ import annotations

import ast
from pathlib import Path

from tests.conftest import ROOT
from tests.support.each import each

CODE_AT = {"InputError": 3, "ChoiceError": 3, "SolveError": 1, "LayoutError": 1}


def uncoded(path: Path) -> list[str]:
    """The errors raised in a file that have no code."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Raise) or not isinstance(call := node.exc, ast.Call):
            continue
        name = call.func.attr if isinstance(call.func, ast.Attribute) else ast.unparse(call.func)
        place = CODE_AT.get(name, 2 if name == "error" else None)
        coded = any(k.arg == "code" for k in call.keywords)
        if place is not None and not coded and len(call.args) <= place:
            found.append(f"{path.name}:{node.lineno}: {ast.unparse(call)}")
    return found


@each(
    "folder", ["analysis", "cli", "explore/chart", "explore/sweep", "study/model", "study/reading"]
)
def test_every_error_has_a_code(folder: str) -> None:
    files = sorted((ROOT / "pinstress" / folder).glob("*.py"))
    assert files
    assert [error for path in files for error in uncoded(path)] == []


def test_an_error_without_a_code_is_found(tmp_path: Path) -> None:
    path = tmp_path / "made_up.py"
    path.write_text('raise InputError("text")\nraise study.error("text", code="x")\n')
    assert len(uncoded(path)) == 1

"""No two files define a public class of one name."""

from __future__ import annotations

import ast
from collections import defaultdict

from tests.conftest import ROOT

PACKAGES = ("pinstress", "pinbase", "loads", "geometry", "fea", "assess", "reports")


def test_public_classes_have_their_own_names() -> None:
    defined = defaultdict(set)
    for package in PACKAGES:
        for path in (ROOT / package).rglob("*.py"):
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                    defined[node.name].add(path.relative_to(ROOT).as_posix())
    assert len(defined) > 100
    assert {name: sorted(files) for name, files in defined.items() if len(files) > 1} == {}

"""Files and commands that the documentation names are there."""

from __future__ import annotations

import re
from pathlib import Path

from tests.conftest import ROOT
from tests.support.each import each

ROOMS = "loads|geometry|fea|reports|pinstress|studies|examples|tests|benchmarks|docs|scripts"
NAMES = re.findall(
    r'^    "([\w-]+)": ', (ROOT / "benchmarks" / "__main__.py").read_text(), re.MULTILINE
)
PAGES = [*(ROOT / "docs").glob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]


@each("page", PAGES)
def test_named_files_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for path in re.findall(rf"`((?:{ROOMS})/[\w./-]+)", text):
        assert (ROOT / path).exists(), path


@each("page", PAGES)
def test_named_benchmarks_and_targets_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for name in re.findall(r"python -m benchmarks ([a-z][\w-]*)", text):
        assert name in NAMES, name
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    for name in re.findall(r"(?:`|^ +)make ([a-z][\w-]*)", text, re.MULTILINE):
        assert name in targets, name

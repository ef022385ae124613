"""Every module with the first sentence of its docstring, room by room: the end of architecture.md.

A Sphinx extension, so that the list is made with every build and cannot be older than the code.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

ROOT = Path(__file__).parent.parent
PAGE = "architecture"
ROOMS = ("pinbase", "loads", "geometry", "fea", "assess", "reports", "pinstress")


def first_sentence(module: Path) -> str:
    """What a module is, by its own words, on one line; empty without a docstring."""
    text = ast.get_docstring(ast.parse(module.read_text(encoding="utf-8"))) or ""
    paragraph = " ".join(text.split("\n\n")[0].split())
    return re.split(r"(?<=[a-z0-9)`])[.:;](?=\s|$)", paragraph)[0].rstrip(".")


def listed() -> Iterator[str]:
    """A table for each folder that has modules, as Markdown."""
    for room in ROOMS:
        for folder in sorted({p.parent for p in (ROOT / room).rglob("*.py")}):
            modules = [p for p in sorted(folder.glob("*.py")) if p.name != "__init__.py"]
            if not modules:
                continue
            yield f"\n**`{folder.relative_to(ROOT).as_posix()}/`**"
            yield f" {first_sentence(folder / '__init__.py')}\n\n| file | |\n| --- | --- |\n"
            for path in modules:
                said = first_sentence(path).replace("|", "\\|").replace("$", "\\$")
                yield f"| `{path.name}` | {said} |\n"


def setup(app: Sphinx) -> dict[str, bool]:
    """Append the list to its page."""

    def append(_: Sphinx, name: str, source: list[str]) -> None:
        if name == PAGE:
            source[0] += "\n" + "".join(listed())

    app.connect("source-read", append)
    return {"parallel_read_safe": True}

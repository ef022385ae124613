"""The page of failures and its pictures, from the entries."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from benchmarks.failures.asked import ROOT
from benchmarks.failures.entry import Entry
from benchmarks.style import panels

PAGE = ROOT / "docs" / "measured" / "failures.md"
PICTURES = ROOT / "docs" / "images" / "failures"


def page(entries: Iterable[Entry]) -> str:
    """Return the text of all entries."""
    return "\n".join(entry.text for entry in entries).rstrip()


def draw(entry: Entry, directory: Path = PICTURES) -> Path:
    """Draw the picture of an entry, the same bytes on every run; return its path."""
    path = directory / f"{entry.name}.svg"
    with panels(1, entry.panels, height=2.6) as (figure, axes):
        entry.draw(figure, axes)
        figure.savefig(path, metadata={"Date": None})
    return path

"""docs/failures.md and its pictures, from the entries."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from benchmarks.failures.asked import ROOT
from benchmarks.failures.entry import Entry
from benchmarks.style import panels

PAGE = ROOT / "docs" / "failures.md"
PICTURES = ROOT / "docs" / "images" / "failures"
HEAD = """# Where methods fail

`python -m benchmarks failures` computes every number on this page. Pinstress detects every one of
these failures: it rejects the study with the reason, or its verdict is not `converged`, or its
error estimate contains the true value. `tests/failures` checks each entry. The studies are in
`studies/failures`; those without a maximum end with status 1, rejected ones with 2 or 3.
"""


def page(entries: Iterable[Entry]) -> str:
    """The page's text."""
    return "\n".join([HEAD, *(entry.text for entry in entries)])


def draw(entry: Entry, directory: Path = PICTURES) -> Path:
    """The picture of an entry; the same bytes on every run."""
    path = directory / f"{entry.name}.svg"
    with panels(1, entry.panels, height=2.6) as (figure, axes):
        entry.draw(figure, axes)
        figure.savefig(path, metadata={"Date": None})
    return path

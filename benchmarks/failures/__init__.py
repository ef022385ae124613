"""The gallery of failures: where methods go wrong, and what pinstress says there."""

from __future__ import annotations

from benchmarks.failures import corners, elements, holding, locking, mechanisms, shapes
from benchmarks.failures.asked import ROOT
from benchmarks.failures.broken_meshes import write
from benchmarks.failures.entry import Entry
from benchmarks.failures.page import PAGE, PICTURES, draw, page

FAMILIES = (corners, locking, elements, shapes, holding, mechanisms)


def entries() -> tuple[Entry, ...]:
    """All, in the order of the page."""
    return tuple(entry for family in FAMILIES for entry in family.entries())


def failures() -> str:
    """Compute all, write the page and its pictures; returns what was written."""
    write()
    found = entries()
    PICTURES.mkdir(parents=True, exist_ok=True)
    for entry in found:
        draw(entry)
    PAGE.write_text(page(found), encoding="utf-8")
    return f"written: {PAGE.relative_to(ROOT)}, with {len(found)} entries"

"""The gallery of failures: cases in which methods go wrong, and pinstress's answers to them."""

from __future__ import annotations

from benchmarks.failures import corners, elements, holding, locking, mechanisms, shapes
from benchmarks.failures.broken_meshes import write
from benchmarks.failures.entry import Entry
from benchmarks.failures.page import PICTURES, draw, page

FAMILIES = (corners, locking, elements, shapes, holding, mechanisms)


def entries() -> tuple[Entry, ...]:
    """Return all entries, in the order of the page."""
    return tuple(entry for family in FAMILIES for entry in family.entries())


def failures() -> str:
    """Compute all entries and draw their pictures; return the text of the page."""
    write()
    found = entries()
    PICTURES.mkdir(parents=True, exist_ok=True)
    for entry in found:
        draw(entry)
    return page(found)

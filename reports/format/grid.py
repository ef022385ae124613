"""A table of text cells for the page."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Grid:
    """A table of text cells; numeric: which columns are numbers."""

    head: list[str]
    body: list[list[str]]
    numeric: list[bool]

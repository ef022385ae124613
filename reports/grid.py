"""A table of texts for the page."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Grid:
    """A table of texts; numeric: which columns hold numbers."""

    head: list[str]
    body: list[list[str]]
    numeric: list[bool]

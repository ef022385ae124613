"""Texts of studies, edited and written to files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


def edited(text: str, changes: Iterable[tuple[str, str]]) -> str:
    """Return the text with replacements, each of a passage that it contains."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text


def edited_once(text: str, changes: Iterable[tuple[str, str]]) -> str:
    """Return the text with replacements, each of a passage that it contains exactly once."""
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def study_file(folder: Path, text: str) -> Path:
    """Write a study of this text in a folder, and return its path."""
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path

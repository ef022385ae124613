"""Texts of studies, changed and written."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


def edited(text: str, changes: Iterable[tuple[str, str]]) -> str:
    """The text with others in it, each instead of one that it has."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return text


def edited_once(text: str, changes: Iterable[tuple[str, str]]) -> str:
    """The same, each instead of one that it has once."""
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def study_file(folder: Path, text: str) -> Path:
    """The path of a study of this text in a folder."""
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path

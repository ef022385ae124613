"""All values of a study by their keys, as stored in results.json, so that runs can be compared."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from typing import Any

from loads import MB, FileError, read_regular
from pinbase.keys import key_part
from pinstress.study.reading.file import MAX_PATH_LENGTH, Study, raw_study
from pinstress.study.schema.shown import in_toml

MAX_TABLE_SIZE = 256 * MB
FILE_HASH_DIGITS = 12  # number of digits of a file's hash
FILE_MARK = " (SHA-256 "  # follows a value that names a file
IGNORED_TEXTS = "title", "report", "assumptions"  # texts that affect no result


def inputs(study: Study) -> dict[str, str]:
    """Return the values of a study by key, as the study writes them.

    A value that names a file is followed by the beginning of the file's SHA-256.
    """
    raw = raw_study(study)
    return {
        key: _written(study, value)
        for key, value in _leaves(raw, "")
        if key.split(".")[0].split("[")[0] not in IGNORED_TEXTS
    }


def require_unchanged(study: Study, before: dict[str, str]) -> None:
    """Raise InputError if a file that a study names has changed.

    before: `inputs` when the files were read first. A command that reads them more than once would
    otherwise mix results of the old and the new content.
    """
    # Only values that name files are read again: a sweep asks after every batch of designs.
    files = {key for key, text in before.items() if FILE_MARK in text}
    leaves = _leaves(raw_study(study), "") if files else ()
    now = {key: _written(study, value) for key, value in leaves if key in files}
    if changed := [key for key in now if now[key] != before[key]]:
        raise study.error(
            f"{', '.join(changed)}: the file has changed since the command began; start again, or "
            "put the old file back",
            code="changed-since",
        )


def _leaves(node: Any, key: str) -> Iterator[tuple[str, Any]]:
    if isinstance(node, dict):
        for name, inner in node.items():
            part = key_part(name)  # quotes distinguish a name with dots from the parts of a key
            yield from _leaves(inner, f"{key}.{part}" if key else part)
    elif isinstance(node, list) and any(isinstance(x, dict) for x in node):
        for k, inner in enumerate(node, 1):
            yield from _leaves(inner, f"{key}[{k}]")
    else:
        yield key, node


def _written(study: Study, value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_written(study, x) for x in value)}]"
    if not isinstance(value, str):
        return in_toml(value)
    content = _file(study, value)
    if content is None:
        return value
    return f"{value}{FILE_MARK}{hashlib.sha256(content).hexdigest()[:FILE_HASH_DIGITS]})"


def _file(study: Study, name: str) -> bytes | None:
    """Return the content of a file of the study, or None if there is no file of that name."""
    if "." not in name or "\0" in name or len(name) > MAX_PATH_LENGTH:
        return None
    try:
        return read_regular(study.path.parent / name, MAX_TABLE_SIZE)
    except (FileError, FileNotFoundError):
        return None

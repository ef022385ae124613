"""Studies built in Python: from tables as a study file has them, and from another study."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pinbase.errors import ArgumentError
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study, parse_study
from pinstress.study.schema.shown import as_text

KEY_PART_PATTERN = re.compile(r'(?:"([^"]*)"|([^.\["]+))((?:\[\d+\])*)(?:\.|$)')
INDEX_PATTERN = re.compile(r"\[(\d+)\]")
INDEX_RANGE_PATTERN = re.compile(r"\[(\d+)-(\d+)\]")  # neighbours that have a number in common
PLAIN_NAME_PATTERN = re.compile(r'[^.\["]+')
# Between keys of one dimension (geometry.shape.dimensions.KEY_JOINT), not within a name
JOINT_PATTERN = re.compile(r" & (?=profile\[|meridian\[|bore_meridian\[|band\.)")
PIN_PATTERN = re.compile(r'pin\.(?:"[^"]*"|[^.\["]+)\.')
PAIR_KEYS = "edge_radius", "bore_radius"  # of both ends, also where one number stands for both


def study_from(
    tables: Mapping[str, Any] | str, folder: str | os.PathLike[str] = ".", name: str = "study"
) -> Study:
    """Return a study from a dict with the keys of a study file (docs/study-file.md), or from its
    text.

    tables: None for a value means that the key is absent.
    folder: folder of the files that the study refers to.
    name: name of the study in messages and results.

    Raises: InputError as load_study.
    """
    path = Path(folder) / name
    if isinstance(tables, str):
        return parse_study(path, tables)
    if not isinstance(tables, Mapping):
        raise InputError(
            f"{as_text(tables)} is not a study: give a dict or the text of a study file",
            code="not-a-study",
        )
    import tomlkit

    return parse_study(path, tomlkit.dumps(_plain(tables, name)), located=False)


def changed_study(study: Study, changes: Mapping[str, Any]) -> Study:
    """Return the study with other values.

    changes: values by key as in messages: {"pin.E.profile[2].diameter": "1.5 in",
    "analysis.tolerance": 0.01}; for one that stands for several, see `single_keys`. Missing keys
    are added, and tables of lugs. The provenance of replaced values is removed; comments are kept.

    Raises: InputError as load_study, and for a key that does not exist in the study.
    """
    import tomlkit

    document: Any = tomlkit.parse(study.text)
    for key, value in changes.items():
        try:
            for single in single_keys(key):
                _change(study, document, single, value)
        except ArgumentError as error:
            raise study.error(f"{key}: {error}", code=error.code) from None
    return parse_study(study.path, tomlkit.dumps(document), study.located)


def single_keys(key: str) -> Iterator[str]:
    """Yield the keys that a key stands for.

    "pin.E.profile[1-3].diameter" stands for three, and "pin.E.meridian[2][1] & band.B.z[1]" for two
    of pin E.

    Raises: ArgumentError for a range that does not count upwards.
    """
    pin, (first_key, *others) = PIN_PATTERN.match(key), JOINT_PATTERN.split(key)
    if pin is not None and others:
        for part in (first_key, *(pin[0] + other for other in others)):
            yield from single_keys(part)
        return
    match = INDEX_RANGE_PATTERN.search(key)
    if match is None:
        yield key
        return
    first, last = (int(end) for end in match.groups())
    if not 0 < first < last:
        raise ArgumentError(
            f"[{first}-{last}] is no range; the smaller element first", "not-a-range"
        )
    for index in range(first, last + 1):
        yield from single_keys(f"{key[: match.start()]}[{index}]{key[match.end() :]}")


def key_part(name: str) -> str:
    """Return a name as a key has it: in quotes where it has a dot or a bracket."""
    return name if PLAIN_NAME_PATTERN.fullmatch(name) else f'"{name}"'


def key_parts(study: Study, key: str) -> list[str | int]:
    """Return the parts of a key: names, and indices from 0.

    Raises: InputError.
    """
    parts: list[str | int] = []
    at = 0
    while at < len(key):
        match = KEY_PART_PATTERN.match(key, at)
        if match is None:
            raise study.error(
                f"{as_text(key)} is not a key; a key looks like pin.E.profile[2].diameter",
                code="not-a-key",
            )
        parts.append(match[1] if match[1] is not None else match[2])
        parts += [int(i) - 1 for i in INDEX_PATTERN.findall(match[3])]
        at = match.end()
    if not parts:
        raise study.error("'' is not a key", code="not-a-key")
    return parts


def _change(study: Study, document: Any, key: str, value: Any) -> None:
    """Set the value at a key of a document of tomlkit."""
    *parents, last = key_parts(study, key)
    table = document
    for depth, part in enumerate(parents):
        # A lug needs no table: it is known by its connection, and has defaults.
        if depth in (2, 3) and (parents[0], parents[2]) == ("pin", "lug"):
            table.setdefault(part, {})
        owner, table = table, _inside(study, table, part, key)
        if part in PAIR_KEYS and isinstance(table, int | float | str):
            owner[part] = [table, table]
            table = owner[part]
    if isinstance(last, int):
        _inside(study, table, last, key)  # an item that is there
    table[last] = _plain(value, key)


def _inside(study: Study, table: Any, part: str | int, key: str) -> Any:
    if isinstance(table, Mapping) and "value" in table and "provenance" in table:
        table = table["value"]
    try:
        if isinstance(part, int) and part < 0:
            raise IndexError
        return table[part]
    except (KeyError, IndexError, TypeError):
        position = part + 1 if isinstance(part, int) else part
        raise study.error(
            f"{key}: the study has no {as_text(position)} there", code="unknown-key"
        ) from None


def _plain(value: Any, key: str) -> Any:
    """Return a value as TOML has it; numbers of numpy, tuples and paths are accepted.

    Raises: InputError for others.
    """
    if isinstance(value, Mapping):
        return {str(k): _plain(v, f"{key}.{k}") for k, v in value.items() if v is not None}
    if isinstance(value, bool | int | float | str):
        return value
    if hasattr(value, "tolist"):  # of numpy
        return _plain(value.tolist(), key)
    if isinstance(value, tuple | list):
        return [_plain(v, f"{key}[{i}]") for i, v in enumerate(value, 1)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise InputError(
        f"{key}: {as_text(value)} cannot be a value in a study: give a number, text or table",
        code="not-a-value",
    )

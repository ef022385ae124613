"""Studies built in Python from tables with the keys of a study file, or from another study."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pinbase.errors import ArgumentError
from pinbase.keys import QUOTED, key_part, unquoted
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study, parse_study, replaces_fit, unwrapped, with_value
from pinstress.study.reading.materials import looked_up, with_materials
from pinstress.study.schema.lugs import with_lug_defaults
from pinstress.study.schema.shown import as_text

KEY_PART_PATTERN = re.compile(rf'({QUOTED}|[^.\["]+)((?:\[[0-9]+\])*)(?:\.|$)')
INDEX_PATTERN = re.compile(r"\[([0-9]+)\]")
INDEX_RANGE_PATTERN = re.compile(r"\[([0-9]+)-([0-9]+)\]")  # neighbours that share a number
# Separator of the keys of one dimension (geometry.shape.dimensions.KEY_JOINT), outside names
JOINT_PATTERN = re.compile(r" & (?=profile\[|meridian\[|bore_meridian\[|band\.)")
PIN_PATTERN = re.compile(rf'pin\.(?:{QUOTED}|[^.\["]+)\.')
PAIR_KEYS = "edge_radius", "bore_radius"  # pairs for both ends, which one number may abbreviate


def study_from(
    tables: Mapping[str, Any] | str, folder: str | os.PathLike[str] = ".", name: str = "study"
) -> Study:
    """Return a study from a dict with the keys of a study file (docs/study-file.md), or from the
    text of one.

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
    "analysis.tolerance": 0.01}; for keys that stand for several, see `single_keys`. Missing keys
    and tables of lugs are added. The provenance of replaced values is removed; comments are kept.

    Raises: InputError as load_study, and for a key that does not exist in the study.
    """
    import tomlkit

    document: Any = tomlkit.parse(study.text)
    for key, value in changes.items():
        for single in _singles(study, key):
            _change(study, document, single, value)
    return parse_study(study.path, tomlkit.dumps(document), study.located)


def single_keys(key: str) -> Iterator[str]:
    """Yield the single keys that a key stands for.

    "pin.E.profile[1-3].diameter" stands for three keys, and "pin.E.meridian[2][1] & band.B.z[1]"
    for two keys of pin E.

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


def _singles(study: Study, key: str) -> Iterator[str]:
    """Yield the single keys that a key stands for.

    Raises: InputError.
    """
    try:
        yield from single_keys(key)
    except ArgumentError as error:
        raise study.error(f"{key}: {error}", code=error.code) from None


def _change(study: Study, document: Any, key: str, value: Any) -> None:
    """Set the value at a key in a tomlkit document."""
    import tomlkit

    parts = written_parts(document, key_parts(study, key))
    match parts:
        case ["pin", str(pin), "lug", str(connection), *inner]:
            write_lug(document, study, pin, connection, inner[:-1])
        case ["material", str(name), _, *_]:
            _write_material(document, study, name)
    table = _place(study, document, parts, key, split=True)
    if replaces_fit(parts):
        table.pop("fit", None)
    new = _plain(value, key)
    if _is_dotted(document, parts[:-1]):  # a table [...] here would begin at the root
        inline: Any = tomlkit.inline_table()
        inline["new"] = new
        new = inline["new"]
    table[parts[-1]] = new


def _is_dotted(document: Any, parts: Iterable[str | int]) -> bool:
    """Return whether a table of a tomlkit document is written with dotted keys."""
    here = document
    for part in parts:
        here = _unwrapped(here)
        body = getattr(getattr(here, "value", here), "body", ()) if isinstance(part, str) else ()
        if any(key is not None and key.key == part and key.is_dotted() for key, _ in body):
            return True
        here = here[part]
    return False


def write_lug(
    document: Any, study: Study, pin: str, connection: str, inner: Iterable[str | int] = ()
) -> None:
    """Write the empty table of a lug that the study has only through its lug_defaults or a
    connection.

    document: the study as a tomlkit document.
    inner: names of tables within that of the lug, which are written, too.
    """
    import tomlkit

    known = study.table.pin.get(pin)
    if known is None or connection not in (*known.lug, *study.connections(pin)):
        return
    table = document["pin"][pin]
    for name in ("lug", connection, *inner):
        if name not in table:
            table[name] = tomlkit.inline_table()
        table = table[name]


def changed_raw(
    study: Study, raw: Mapping[str, Any], changes: Mapping[str, Any]
) -> Mapping[str, Any]:
    """Return the content of a study (pinstress.study.reading.file.raw_study) with the changes that
    `changed_study` takes. This is a hundred times faster, but gives no text.

    Raises: InputError for a key that does not exist in the study.
    """
    for key, value in changes.items():
        for single in _singles(study, key):
            parts = written_parts(raw, key_parts(study, single))
            complete = with_lug_defaults(dict(raw))
            _place(study, _with_lug(complete, study, parts), parts, single)
            raw = with_value(raw, parts, unwrapped(_plain(value, key), key, [], []))
    named = with_materials(study.path, dict(raw)) if changes else raw
    unchanged = named.get("material") == raw.get("material")
    return raw if unchanged else unwrapped(named, "", [], [])


def _with_lug(raw: dict[str, Any], study: Study, parts: list[str | int]) -> dict[str, Any]:
    """Return a study's content with the table of a lug that it has only through a connection."""
    match parts:
        case ["pin", str(pin), "lug", str(connection), *_] if pin in study.table.pin:
            if connection in study.connections(pin):
                lugs = raw["pin"][pin].get("lug", {})
                return with_value(raw, ["pin", pin, "lug"], {connection: {}, **lugs})
    return raw


def _place(study: Study, table: Any, parts: list[str | int], key: str, split: bool = False) -> Any:
    """Return the table or list that contains the last part of a key.

    split: whether one number for both ends is replaced by two in the table.

    Raises: InputError for a key that does not exist; only the last part may be missing from a
    table.
    """
    for part in parts[:-1]:
        owner, table = table, _inside(study, table, part, key)
        if part in PAIR_KEYS and isinstance(table, int | float | str):
            table = [table, table]
            if split:
                _unwrapped(owner)[part] = table
                table = _unwrapped(owner)[part]
    if isinstance(parts[-1], int):
        table = _unwrapped(table)
        _inside(study, table, parts[-1], key)  # raises unless the element exists
    elif not isinstance(table, Mapping):
        _inside(study, table, parts[-1], key)  # raises
    return table


def _unwrapped(table: Any) -> Any:
    """Return the value of a table { value, provenance }, or any other object itself."""
    wrapped = isinstance(table, Mapping) and "value" in table and "provenance" in table
    return table["value"] if wrapped else table


def _write_material(document: Any, study: Study, name: str) -> None:
    """Write the table of a material that a study only names, with its source."""
    import tomlkit

    stored = looked_up(study.path, document.unwrap()).get(name)
    if stored is not None:
        document.setdefault("material", tomlkit.table())[name] = stored.table


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
        parts.append(unquoted(match[1]))
        parts += [int(i) - 1 for i in INDEX_PATTERN.findall(match[2])]
        at = match.end()
    match parts:
        case []:
            raise study.error("'' is not a key", code="not-a-key")
        case ["pin", str(pin), "lug", str(ear), _, *_] if pin in study.table.pin:
            if link := study.table.pin[pin].shared_lugs.get(ear):
                raise study.error(
                    f"{key}: the lug of this ear is that of {link}, whose keys change both; to "
                    f"change one, give {ear} a lug of its own",
                    code="lug-of-both-ears",
                )
    return parts


def written_parts(content: Any, parts: Iterable[str | int]) -> list[str | int]:
    """Return the parts of a key as the content of a study needs them.

    The index of a list of one element may be left out, and [1] may follow a table where a list
    could be. The "value" of a table { value, provenance } is that which the table stands for.
    """
    written: list[str | int] = []
    here = _unwrapped(content)
    for part in parts:
        if isinstance(part, str) and isinstance(here, list) and len(here) == 1:
            written.append(0)
            here = _unwrapped(here[0])
        if part == 0 and isinstance(here, Mapping):
            continue
        if part == "value" and isinstance(here, int | float | str | list):
            continue
        written.append(part)
        try:
            here = _unwrapped(here[part])
        except (KeyError, IndexError, TypeError):
            here = None
    return written


def _inside(study: Study, table: Any, part: str | int, key: str) -> Any:
    table = _unwrapped(table)
    try:
        if isinstance(part, int) and part < 0:
            raise IndexError
        return table[part]
    except (KeyError, IndexError, TypeError):
        what = f"the study has no {as_text(part)} there"
        if isinstance(part, int):
            count = f"it has {len(table)}" if isinstance(table, list) else "it is not a list"
            what = f"there is no element {part + 1} of its list; {count}, counted from 1"
        raise study.error(f"{key}: {what}", code="unknown-key") from None


def _plain(value: Any, key: str) -> Any:
    """Return a value as TOML can have it; numbers of numpy, tuples and paths are accepted.

    Raises: InputError for other values.
    """
    if isinstance(value, Mapping):
        return {
            str(k): _plain(v, f"{key}.{key_part(str(k))}")
            for k, v in value.items()
            if v is not None
        }
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

"""Names that a study refers to, each of which must exist."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import partial

from pydantic import BaseModel

from pinbase.keys import key_part
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.materials import library
from pinstress.study.schema.shown import as_text, near


def known_name(where: str, what: str, name: str, names: Collection[str]) -> Iterator[Wrong]:
    """Yield an error unless a name exists. what: the kind of thing it names. where: the key with
    the name.
    """
    if name not in names:
        if what == "material":
            names = [*names, *library()]
        code = f"unknown-{what.split()[-1]}"
        hint = partial(near, name, names)
        yield Wrong(f"{where}: no {what} {as_text(name)}; ", hint, code=code, name=name)


def known_names(
    table: BaseModel, key: str, paths: str, what: str, names: Collection[str]
) -> Iterator[Wrong]:
    """Yield an error for each name below a table that does not exist.

    key: of the table.
    paths: keys below it, joined by dots; names in a table of tables and indices of a list are
    skipped.
    what, names: as in `known_name`.
    """
    for path in paths.split():
        for where, name in _named(table, path, key):
            yield from known_name(where, what, name, names)


def _named(node: object, path: str, key: str) -> Iterator[tuple[str, str]]:
    """Yield the names at a path below a node, each with its key; points [x, y] are not names."""
    if isinstance(node, str):
        yield key, node
    elif isinstance(node, BaseModel):
        first, _, rest = path.partition(".")
        yield from _named(getattr(node, first, None), rest, f"{key}.{first}".lstrip("."))
    elif isinstance(node, dict):
        for name, inner in node.items():
            yield from _named(inner, path, f"{key}.{key_part(name)}")
    elif isinstance(node, list | tuple):
        for i, inner in enumerate(node, 1):
            # A single drive may be written without a list, and only tables have indices.
            plain = not isinstance(inner, BaseModel) or (key.endswith(".drive") and not node[1:])
            yield from _named(inner, path, key if plain else f"{key}[{i}]")


def two_bodies(
    where: str, pair: tuple[str, str] | None, bodies: Mapping[str, object]
) -> Iterator[Wrong]:
    """Yield errors unless the two bodies at the key `where` exist and differ."""
    for body in pair or ():
        yield from known_name(f"{where}.bodies", "body", body, bodies)
    if pair is not None and pair[0] == pair[1]:
        text = f"{where}.bodies: {as_text(pair[0])} twice; name two different bodies"
        yield Wrong(text, code="same-body")

"""Keys of a study file as TOML, commands and messages spell them."""

from __future__ import annotations

import re

PLAIN_NAME_PATTERN = re.compile(r"[A-Za-z0-9_-]+")  # that TOML needs no quotes for
# A name in quotes: double ones, in which a backslash escapes, or single ones, which begin a part
QUOTED = r'"(?:[^"\\]|\\.)*"|(?<![^.])\'[^\']*\''
NAME_PATTERN = re.compile(rf"{QUOTED}|[^.\"']+")  # a part of a key


def key_part(name: str) -> str:
    """Return a name as a key has it: in quotes where TOML needs them, single ones around a double
    quote or a backslash, unless the name has a single one, too.
    """
    if PLAIN_NAME_PATTERN.fullmatch(name):
        return name
    escaped = re.sub(r'(["\\])', r"\\\1", name)
    return f"'{name}'" if escaped != name and "'" not in name else f'"{escaped}"'


def names_in(key: str) -> list[str]:
    """Return the names that are the parts of a key, without their quotes."""
    return [unquoted(part) for part in NAME_PATTERN.findall(key)]


def unquoted(part: str) -> str:
    """Return the name that a part of a key is, without its quotes."""
    if len(part) < 2 or part[0] not in "\"'" or part[0] != part[-1]:
        return part
    return re.sub(r"\\(.)", r"\1", part[1:-1]) if part[0] == '"' else part[1:-1]


def lug_key(pin: str, connection: str, *parts: str) -> str:
    """Return the key of the lug of a connection on a pin, or of parts of its table."""
    return ".".join(["pin", key_part(pin), "lug", key_part(connection), *parts])

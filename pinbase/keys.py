"""Keys of a study file as TOML, commands and messages spell them."""

from __future__ import annotations

import re

PLAIN_NAME_PATTERN = re.compile(r"[A-Za-z0-9_-]+")  # a name for which TOML needs no quotes
# A name in double quotes, in which a backslash escapes, or in single quotes, which begin a part.
QUOTED = r'"(?:[^"\\]|\\.)*"|(?<![^.])\'[^\']*\''
NAME_PATTERN = re.compile(rf"{QUOTED}|[^.\"']+")  # a part of a key


def key_part(name: str) -> str:
    """Return a name as a part of a key, in quotes where TOML needs them.

    Double quotes are used, except for a name with a double quote or a backslash: it has single
    quotes, unless the name contains a single quote, too.
    """
    if PLAIN_NAME_PATTERN.fullmatch(name):
        return name
    escaped = re.sub(r'(["\\])', r"\\\1", name)
    return f"'{name}'" if escaped != name and "'" not in name else f'"{escaped}"'


def names_in(key: str) -> list[str]:
    """Return the names that are the parts of a key, without their quotes."""
    return [unquoted(part) for part in NAME_PATTERN.findall(key)]


def unquoted(part: str) -> str:
    """Return a part of a key without its quotes."""
    if len(part) < 2 or part[0] not in "\"'" or part[0] != part[-1]:
        return part
    return re.sub(r"\\(.)", r"\1", part[1:-1]) if part[0] == '"' else part[1:-1]


def lug_key(pin: str, connection: str, *parts: str) -> str:
    """Return the key of the lug of a connection on a pin, or of `parts` within its table."""
    return ".".join(["pin", key_part(pin), "lug", key_part(connection), *parts])

"""Keys of a study file as TOML, commands and messages spell them."""

from __future__ import annotations

import re

PLAIN_NAME_PATTERN = re.compile(r"[A-Za-z0-9_-]+")  # that TOML needs no quotes for
QUOTED = r'"[^"]*"|(?<![^.])\'[^\']*\''  # a name in quotes; single ones begin a part of a key
NAME_PATTERN = re.compile(rf"{QUOTED}|[^.\"']+")  # a part of a key


def key_part(name: str) -> str:
    """Return a name as a key has it: in quotes where TOML needs them, single ones around double."""
    if PLAIN_NAME_PATTERN.fullmatch(name):
        return name
    return f"'{name}'" if '"' in name else f'"{name}"'


def names_in(key: str) -> list[str]:
    """Return the names that are the parts of a key, without their quotes."""
    return [unquoted(part) for part in NAME_PATTERN.findall(key)]


def unquoted(part: str) -> str:
    """Return the name that a part of a key is, without its quotes."""
    return part[1:-1] if part[0] in "\"'" and part[0] == part[-1] else part


def lug_key(pin: str, connection: str, *parts: str) -> str:
    """Return the key of the lug of a connection on a pin, or of parts of its table."""
    return ".".join(["pin", key_part(pin), "lug", key_part(connection), *parts])

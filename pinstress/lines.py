"""On which line of a study file a key stands, for messages that name the key.

tomllib keeps no positions and tomlkit gives none. The text has been read by tomllib already, so it
is valid TOML and its headers, keys and brackets only need to be followed.
"""

from __future__ import annotations

import re
import tomllib
from collections import deque
from collections.abc import Iterable, Sequence
from itertools import count

TOKEN = re.compile(
    r'''"""(?:\\.|[^\\])*?"{3,5} | \'\'\'.*?'{3,5} | "(?:\\.|[^"\\])*" | '[^']*' | \#[^\n]*'''
    r"""| \n | [][{}=,.] | [^][{}=,.\s"'\#]+""",
    re.VERBOSE | re.DOTALL,
)
Place = tuple[str | int, ...]  # keys, and indices from 0 into arrays
Tokens = deque[tuple[str, int]]  # each with the line on which it begins


def places(text: str) -> dict[Place, int]:
    """The line, from 1 on, of every key, table and array element of a valid TOML text. A table
    that has no line of its own has the first of what it contains.
    """
    tokens = _tokens(text)
    found: dict[Place, int] = {}
    sizes: dict[Place, int] = {}  # of the arrays of tables
    table: Place = ()
    while tokens:
        token, line = tokens[0]
        if token == "[":
            table = _header(tokens, sizes)
            _mark(table, line, found)
        elif token == "\n":
            tokens.popleft()
        else:
            _pair(tokens, table, found)
    return found


def lines_of(text: str, messages: Iterable[str]) -> list[int | None]:
    """The line of the key with which each message begins ("pin.B.profile[2].length: ..."), or of
    the nearest table around it that is there; None where there is none. If the message goes on to
    quote a key of that table ("unknown key 'x'"), it is that key's.
    """
    known: dict[str, int] = {}
    everywhere = places(text)
    # Messages leave out the `value` of { value, provenance }, and the index of an only table.
    for unsaid in ((), ("value",), ("value", 0)):
        for place, line in everywhere.items():
            known.setdefault(_said([part for part in place if part not in unsaid]), line)
    return [_line(known, message) for message in messages]


def _line(known: dict[str, int], message: str) -> int | None:
    # [1] also for the one table that may be written without an array
    spellings = (message, message.replace("[1]", ""))
    ends = (":", ".", "[", " in ")
    key = max(
        (k for k in known for m in spellings if m.startswith(tuple(k + end for end in ends))),
        key=len,
        default="",
    )
    quoted = re.search(r"'([^']*)'", message)
    inner = f"{key}.{quoted[1]}".lstrip(".") if quoted else key
    return known.get(inner, known.get(key))


def _said(place: Sequence[str | int]) -> str:
    """A place as messages spell it, which count from 1."""
    return "".join(f"[{p + 1}]" if isinstance(p, int) else f".{p}" for p in place)[1:]


def _tokens(text: str) -> Tokens:
    out: Tokens = deque()
    line, at = 1, 0
    for match in TOKEN.finditer(text + "\n"):
        line += text.count("\n", at, match.start())
        at = match.start()
        if not match[0].startswith("#"):
            out.append((match[0], line))
    return out


def _header(tokens: Tokens, sizes: dict[Place, int]) -> Place:
    """The table that [a.b] or the next [[a.b]] opens."""
    tokens.popleft()
    array = tokens[0][0] == "["
    if array:
        tokens.popleft()
    names = _key(tokens, "]")
    table: Place = ()
    for depth, name in enumerate(names, 1):
        table += (name,)
        if array and depth == len(names):
            tokens.popleft()
            sizes[table] = sizes.get(table, 0) + 1
        if table in sizes:
            table += (sizes[table] - 1,)
    return table


def _key(tokens: Tokens, end: str) -> list[str]:
    """The parts of a dotted key, and past its end."""
    parts = []
    while (token := tokens.popleft()[0]) != end:
        if token[0] in "\"'":
            parts.append(str(tomllib.loads(f"key = {token}")["key"]))
        elif token != ".":
            parts.append(token)
    return parts


def _pair(tokens: Tokens, table: Place, found: dict[Place, int]) -> None:
    line = tokens[0][1]
    place = (*table, *_key(tokens, "="))
    _mark(place, line, found)
    _value(tokens, place, found)


def _value(tokens: Tokens, place: Place, found: dict[Place, int]) -> None:
    """Past a value, and what it contains; what ends it remains."""
    first, _ = tokens.popleft()
    if first not in ("[", "{"):
        while tokens[0][0] not in (",", "]", "}", "\n"):
            tokens.popleft()  # 1.5 and a time of day are several tokens
        return
    for i in count():
        while tokens[0][0] in (",", "\n"):
            tokens.popleft()
        if tokens[0][0] in ("]", "}"):
            tokens.popleft()
            return
        if first == "{":
            _pair(tokens, place, found)
        else:
            _mark((*place, i), tokens[0][1], found)
            _value(tokens, (*place, i), found)


def _mark(place: Place, line: int, found: dict[Place, int]) -> None:
    for depth in range(1, len(place)):
        found.setdefault(place[:depth], line)
    found[place] = line

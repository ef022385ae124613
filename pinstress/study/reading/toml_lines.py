"""The lines of the keys of a study file, for messages that name a key.

tomllib keeps no positions and tomlkit gives none. The text has been read by tomllib before, so it
is valid TOML, and only its headers, keys and brackets need to be followed.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from itertools import count

from pinbase.keys import key_part

# A string without a closing quote is a token up to the end of its line or of the text. Otherwise
# every quote in it would be tried again.
TOKEN_PATTERN = re.compile(
    r'''"""(?:\\.|[^\\])*?(?:"{3,5}|\Z) | \'\'\'.*?(?:'{3,5}|\Z)
    | "(?:\\.|[^"\\\n])*+"? | '[^'\n]*'? | \#[^\n]*'''
    r"""| \n | [][{}=,.] | [^][{}=,.\s"'\#]+""",
    re.VERBOSE | re.DOTALL,
)
KEY_END_PATTERN = re.compile(r"[:.\[]| in ")  # after a key in a message
MAX_KEY_END_LENGTH = 4
QUOTED_PATTERN = re.compile(r"'([^']*)'")
Place = tuple[str | int, ...]  # keys, and indices from 0 into arrays


class Tokens:
    """The tokens of a text in order, each with the line on which it begins.

    They are an iterator, since a list of the tokens of a large file would take gigabytes.
    """

    def __init__(self, text: str) -> None:
        self._rest = _tokens(text)
        self._next = next(self._rest, None)

    def __bool__(self) -> bool:
        return self._next is not None

    @property
    def first(self) -> tuple[str, int]:
        """The next token."""
        assert self._next is not None
        return self._next

    def pop(self) -> tuple[str, int]:
        """Return the next token and advance past it."""
        first = self.first
        self._next = next(self._rest, None)
        return first


def places(text: str) -> dict[Place, int]:
    """Return the line, counted from 1, of every key, table and array element of a valid TOML text.

    A table without a line of its own has the first line of its content.
    """
    tokens = Tokens(text)
    lines: dict[Place, int] = {}
    sizes: dict[Place, int] = {}  # number of tables in each array of tables
    table: Place = ()
    while tokens:
        token, line = tokens.first
        if token == "[":
            table = _header(tokens, sizes)
            _mark(table, line, lines)
        elif token == "\n":
            tokens.pop()
        else:
            _pair(tokens, table, lines)
    return lines


def lines_of(text: str, messages: Iterable[str]) -> list[int | None]:
    """Return the line of the key with which each message begins ("pin.B.profile[2].length: ...").

    If that key is absent, the line is that of the nearest enclosing table, or None. If the message
    then quotes a key of that table ("unknown key 'x'"), the line is that of the quoted key.
    """
    known: dict[str, int] = {}
    everywhere = places(text)
    # Messages leave out the `value` of { value, provenance }, and the index of a single table.
    for unsaid in ((), ("value",), ("value", 0)):
        for place, line in everywhere.items():
            known.setdefault(said([part for part in place if part not in unsaid]), line)
    longest = max(map(len, known), default=0)
    return [_line(known, longest, message) for message in messages]


def _line(known: dict[str, int], longest: int, message: str) -> int | None:
    # [1] may also refer to a single table that is written without an array
    spellings = (message, message.replace("[1]", ""))
    keys = (next(_keys(known, m[: longest + MAX_KEY_END_LENGTH]), "") for m in spellings)
    key = max(keys, key=len)
    quoted = QUOTED_PATTERN.search(message)
    inner = f"{key}.{key_part(quoted[1])}".lstrip(".") if quoted else key
    return known.get(inner, known.get(key))


def _keys(known: dict[str, int], message: str) -> Iterator[str]:
    """Yield the known keys with which a message begins, the longest first.

    Only texts up to a possible end of a key are looked up. This is much faster than comparing the
    message with every key of a large study.
    """
    for end in reversed([m.start() for m in KEY_END_PATTERN.finditer(message)]):
        if message[:end] in known:
            yield message[:end]


def said(place: Sequence[str | int]) -> str:
    """Return a place as messages spell it, with indices from 1."""
    return "".join(f"[{p + 1}]" if isinstance(p, int) else f".{key_part(p)}" for p in place)[1:]


def _tokens(text: str) -> Iterator[tuple[str, int]]:
    line, at = 1, 0
    for match in TOKEN_PATTERN.finditer(text + "\n"):
        line += text.count("\n", at, match.start())
        at = match.start()
        if not match[0].startswith("#"):
            yield match[0], line


def _header(tokens: Tokens, sizes: dict[Place, int]) -> Place:
    """Return the table that [a.b] or the next [[a.b]] opens."""
    tokens.pop()
    array = tokens.first[0] == "["
    if array:
        tokens.pop()
    names = _key(tokens, "]")
    table: Place = ()
    for depth, name in enumerate(names, 1):
        table += (name,)
        if array and depth == len(names):
            tokens.pop()
            sizes[table] = sizes.get(table, 0) + 1
        if table in sizes:
            table += (sizes[table] - 1,)
    return table


def _key(tokens: Tokens, end: str) -> list[str]:
    """Return the parts of a dotted key, and advance past its end."""
    parts = []
    while (token := tokens.pop()[0]) != end:
        if token[0] in "\"'":
            parts.append(str(tomllib.loads(f"key = {token}")["key"]))
        elif token != ".":
            parts.append(token)
    return parts


def _pair(tokens: Tokens, table: Place, lines: dict[Place, int]) -> None:
    line = tokens.first[1]
    place = (*table, *_key(tokens, "="))
    _mark(place, line, lines)
    _value(tokens, place, lines)


def _value(tokens: Tokens, place: Place, lines: dict[Place, int]) -> None:
    """Advance past a value and its content, up to the token that follows it."""
    first, _ = tokens.pop()
    if first not in ("[", "{"):
        while tokens.first[0] not in (",", "]", "}", "\n"):
            tokens.pop()  # 1.5 or a time of day consists of several tokens
        return
    for i in count():
        while tokens.first[0] in (",", "\n"):
            tokens.pop()
        if tokens.first[0] in ("]", "}"):
            tokens.pop()
            return
        if first == "{":
            _pair(tokens, place, lines)
        else:
            _mark((*place, i), tokens.first[1], lines)
            _value(tokens, (*place, i), lines)


def _mark(place: Place, line: int, lines: dict[Place, int]) -> None:
    for depth in range(1, len(place)):
        lines.setdefault(place[:depth], line)
    lines[place] = line

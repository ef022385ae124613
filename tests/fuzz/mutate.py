"""Ways to break a study or a table: each takes the text apart with a seeded random source."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

Mutation = Callable[[str, random.Random], str]

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")
KEY = re.compile(r"(?m)(?:^|(?<=[{,\s]))[A-Za-z_]\w*(?=\s*=)")
STRING = re.compile(r'"[^"\n]*"')
HEADER = re.compile(r"(?m)^\[+[^\]\n]*\]+")
NUMBERS = (
    "0", "-0.0", "1", "-1", "2", "1e-300", "1e300", "-1e300", "1e400", "nan", "inf", "-inf", "1e-9",
    "1e9", "0.5", "3", "9007199254740993", "123456789012345678901234567890", "0x10",
)  # fmt: skip
VALUES = (
    '""', '" "', '"x"', "true", "false", "[]", "{}", "[1, 2, 3]", "[[]]", "1979-05-27", '"1 mm"',
    '"-3 furlong"', '"2 in in"', '"nan"', '"1e400 in"', '"(1"', '"1 ** 9 ** 9 mm"',
    '"B"', '"start"', '"ground"', '"../../etc/passwd"', '"\\u0000"', '"é\\n"', "{ value = 1 }",
    "[nan, inf]", '{ value = 1, provenance = "guess" }',
    '"' + "9" * 5000 + '"', "[" * 200 + "]" * 200,
)  # fmt: skip
CELLS = ("", "nan", "inf", "-1", "x", "1e400", "0", '"', "1,2", "\x00", "é", " ", "1e-320")


def _at(pattern: re.Pattern[str], text: str, rng: random.Random, new: Callable[[str], str]) -> str:
    """The text with one match, drawn at random, made new."""
    found = list(pattern.finditer(text))
    if not found:
        return text
    match = rng.choice(found)
    return text[: match.start()] + new(match[0]) + text[match.end() :]


def number(text: str, rng: random.Random) -> str:
    """Another number."""
    return _at(NUMBER, text, rng, lambda _: rng.choice(NUMBERS))


def scaled(text: str, rng: random.Random) -> str:
    """A number times something, or of the other sign."""
    factor = rng.choice((-1.0, 10.0, 0.1, 1e3, 1e-3, 1e6, 1e-6, 2.0, 0.5))
    return _at(NUMBER, text, rng, lambda old: repr(float(old) * factor))


def swapped(text: str, rng: random.Random) -> str:
    """Two numbers in each other's place."""
    found = list(NUMBER.finditer(text))
    if len(found) < 2:
        return text
    a, b = sorted(rng.sample(found, 2), key=lambda m: m.start())
    return "".join((text[: a.start()], b[0], text[a.end() : b.start()], a[0], text[b.end() :]))


def retyped(text: str, rng: random.Random) -> str:
    """A number or a string of another type."""
    return _at(rng.choice((NUMBER, STRING)), text, rng, lambda _: rng.choice(VALUES))


def renamed(text: str, rng: random.Random) -> str:
    """A key, a table's header or a string with a letter changed, or one of another."""
    pattern = rng.choice((KEY, HEADER, STRING))
    others = [m[0] for m in pattern.finditer(text)]

    def new(old: str) -> str:
        i = rng.randrange(len(old))
        return rng.choice((old[:i] + old[i + 1 :], old[:i] + "x" + old[i:], rng.choice(others)))

    return _at(pattern, text, rng, new)


def line_removed(text: str, rng: random.Random) -> str:
    """Some lines gone."""
    lines = text.splitlines(keepends=True)
    i = rng.randrange(len(lines))
    return "".join(lines[:i] + lines[i + rng.choice((1, 1, 1, 3, 10)) :])


def line_doubled(text: str, rng: random.Random) -> str:
    """A line twice, or somewhere else."""
    lines = text.splitlines(keepends=True)
    line = rng.choice(lines)
    lines.insert(rng.choice((lines.index(line), rng.randrange(len(lines)))), line)
    return "".join(lines)


def table_doubled(text: str, rng: random.Random) -> str:
    """A table twice under another name."""
    tables = re.split(r"(?m)^(?=\[)", text)
    table = rng.choice(tables)
    return text + "\n" + re.sub(r"\.\w+\]", ".twin]", table, count=1)


def table_removed(text: str, rng: random.Random) -> str:
    """A table less."""
    tables = re.split(r"(?m)^(?=\[)", text)
    tables.pop(rng.randrange(len(tables)))
    return "".join(tables)


def cell(text: str, rng: random.Random) -> str:
    """A cell of a table in CSV with something else in it."""
    return _at(re.compile(r"[^,\n]+"), text, rng, lambda _: rng.choice(CELLS))


def truncated(text: str, rng: random.Random) -> str:
    """The beginning only."""
    return text[: rng.randrange(len(text) + 1)]


def letter(text: str, rng: random.Random) -> str:
    """A letter that does not belong there."""
    i = rng.randrange(len(text) + 1)
    return text[:i] + rng.choice("\x00\x07{}[]\"'=,.#\\é−\u202e") + text[i + rng.choice((0, 1)) :]


STUDY: tuple[Mutation, ...] = (
    number, number, number, scaled, scaled, scaled, scaled, scaled, swapped, swapped, swapped,
    retyped, renamed, line_removed, line_removed, line_doubled, table_doubled, table_removed,
    truncated, letter,
)  # fmt: skip
TABLE: tuple[Mutation, ...] = (cell, cell, number, swapped, line_removed, line_doubled, truncated)
ENCODINGS = ("utf-8",) * 20 + ("utf-16", "latin-1", "utf-8-sig")


def mutant(text: str, kinds: tuple[Mutation, ...], rng: random.Random) -> bytes:
    """A text broken in one to three ways, in some encoding."""
    for _ in range(rng.choice((1, 1, 1, 2))):
        text = rng.choice(kinds)(text, rng) if text else text
    return text.encode(rng.choice(ENCODINGS), errors="replace")

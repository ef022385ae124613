"""Ways to break a file beside a study: a table, a CAD file, a mesh. Bytes in, bytes out."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

from tests.fuzz import mutate
from tests.fuzz.mutate import Mutation

Damage = Callable[[bytes, random.Random], bytes]
Columns = list[list[str]]

REFERENCE = re.compile(r"#\d+")
WORD = re.compile(r"[A-Za-z_]{3,}")
WORDS = (
    "CLOSED_SHELL", "ADVANCED_FACE", "PLANE", "CIRCLE", "tetra", "C3D10", "C3D8", "Float64",
    "Int64", "ascii", "binary", "hexahedron", "nan",
)  # fmt: skip


def junk(data: bytes, rng: random.Random) -> bytes:
    """No file of that kind at all: noise, letters, nothing."""
    n = rng.choice((0, 1, 3, 100, 10_000))
    return rng.choice((rng.randbytes(n), b"\0" * n, b"\n" * n, b"Dear pin,\n" * n))


def truncated(data: bytes, rng: random.Random) -> bytes:
    """The beginning only, or all but the end."""
    return data[: rng.choice((rng.randrange(len(data) + 1), len(data) - rng.randrange(1, 300)))]


def flipped(data: bytes, rng: random.Random) -> bytes:
    """Some bits the other way."""
    out = bytearray(data)
    for _ in range(rng.choice((1, 1, 3, 30)) if out else 0):
        out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
    return bytes(out)


def block_removed(data: bytes, rng: random.Random) -> bytes:
    """A stretch gone from the middle."""
    a = rng.randrange(len(data) + 1)
    return data[:a] + data[a + rng.choice((1, 10, 100, 4096)) :]


def block_doubled(data: bytes, rng: random.Random) -> bytes:
    """A stretch twice."""
    a = rng.randrange(len(data) + 1)
    b = a + rng.choice((1, 10, 100, 4096))
    return data[:b] + data[a:b] + data[b:]


def zeroed(data: bytes, rng: random.Random) -> bytes:
    """A stretch of NUL bytes, as a disk may leave them."""
    a = rng.randrange(len(data) + 1)
    n = min(rng.choice((1, 10, 512)), len(data) - a)
    return data[:a] + b"\0" * n + data[a + n :]


def encoded(data: bytes, rng: random.Random) -> bytes:
    """The same text in another encoding, or with other ends of lines."""
    text = data.decode("latin-1")
    return rng.choice((
        text.encode("utf-16"), text.encode("utf-8-sig"), ("é" + text).encode("latin-1"),
        data.replace(b"\n", b"\r\n"), data.replace(b"\n", b"\r"), data.replace(b"\n", b""),
        data.replace(b".", b","),
    ))  # fmt: skip


def renumbered(text: str, rng: random.Random) -> str:
    """A reference of a STEP file, or a whole number, that points somewhere else."""
    found = REFERENCE.findall(text)
    if not found:
        return mutate.number(text, rng)
    at = rng.choice(list(REFERENCE.finditer(text)))
    new = rng.choice((*found, "#0", "#999999"))
    return "".join((text[: at.start()], new, text[at.end() :]))


def reworded(text: str, rng: random.Random) -> str:
    """A keyword of the format that is another's, or misspelt."""
    found = list(WORD.finditer(text))
    if not found:
        return text
    at = rng.choice(found)
    new = rng.choice((*WORDS, at[0][:-1], rng.choice(found)[0]))
    return "".join((text[: at.start()], new, text[at.end() :]))


def _columns(change: Callable[[Columns, random.Random], None]) -> Mutation:
    def changed(text: str, rng: random.Random) -> str:
        columns = [
            list(c) for c in zip(*(x.split(",") for x in text.split("\n") if x), strict=False)
        ]
        if columns:
            change(columns, rng)
        return "\n".join(",".join(row) for row in zip(*columns, strict=True)) + "\n"

    return changed


def _swap(columns: Columns, rng: random.Random) -> None:
    rng.shuffle(columns)


def _double(columns: Columns, rng: random.Random) -> None:
    columns.append(rng.choice(columns))


def _rename(columns: Columns, rng: random.Random) -> None:
    rng.choice(columns)[0] = rng.choice(("", "fx", "FX", "force", "time", "x" * 200_000))


def _text(change: Mutation) -> Damage:
    def changed(data: bytes, rng: random.Random) -> bytes:
        return change(data.decode("latin-1"), rng).encode("latin-1", errors="replace")

    return changed


ANY: tuple[Damage, ...] = (
    junk, truncated, truncated, flipped, flipped, block_removed, block_doubled, zeroed, encoded,
)  # fmt: skip
TEXT = tuple(map(_text, (
    mutate.number, mutate.number, mutate.scaled, mutate.swapped, mutate.line_removed,
    mutate.line_doubled, mutate.letter, renumbered, renumbered, reworded,
)))  # fmt: skip
CSV = tuple(map(_text, (
    mutate.cell, mutate.cell, mutate.number, _columns(_swap), _columns(_double), _columns(_rename),
)))  # fmt: skip


def damaged(data: bytes, table: bool, rng: random.Random) -> bytes:
    """A file broken in one to three ways."""
    kinds = ANY + (CSV * 2 if table else TEXT)
    for _ in range(rng.choice((1, 1, 2, 3))):
        data = rng.choice(kinds)(data, rng) if data else data
    return data

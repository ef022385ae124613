"""Damaged and hostile copies of the files of a results folder, drawn from a seed."""

from __future__ import annotations

import json
import random
import zlib
from base64 import b64decode, b64encode
from collections.abc import Callable, Iterator
from re import search
from typing import Any

DEEP = 100_000
ODD: list[Any] = [
    *(None, True, False, 0, -1, 1, 10**400, -(10**30), 1e308, -1e308, 5e-324, 2.5, "", "x", "\x00"),
    *("../../../etc/passwd", "a/b", "\x1b[2J", "é" * 300, "z" * 100_000, "NaN", [], {}, [[]]),
    *([None], {"a": 1}, [1, 2], [1.0, 2.0, 3.0], ["a", 1], {"": None}, "http://127.0.0.1:9/x"),
]


def damaged_bytes(content: bytes, draw: random.Random) -> bytes:
    """Return the bytes with some replaced, cut off, inserted or removed, or all of them
    replaced.
    """
    at, other = draw.randrange(len(content)), draw.randrange(len(content))
    low, high = sorted((at, other))
    few = bytes(draw.randrange(256) for _ in range(draw.choice((1, 1, 4, 64))))
    return draw.choice(
        [
            content[:at],
            content[:at] + few + content[at + len(few) :],
            content[:at] + few + content[at:],
            content[:low] + content[high:],
            content[:high] + content[low:],
            few,
            b"",
            content + few,
            content[:at] + b"\xff\xfe" + content[at:],
        ]
    )


def damaged_json(content: bytes, draw: random.Random) -> bytes:
    """Return a JSON text with a value or key replaced by an odd one, or all of it replaced."""
    if draw.random() < 0.25:
        return damaged_bytes(content, draw)
    if draw.random() < 0.1:
        return draw.choice(TEXTS)
    found = json.loads(content)
    if draw.random() < 0.08:
        return json.dumps(draw.choice(ODD)).encode()
    for _ in range(draw.choice((1, 1, 1, 3))):
        places = list(_places(found))
        holder, key = draw.choice(places)
        what = draw.randrange(5)
        if what == 0:
            del holder[key]
        elif what == 1 and isinstance(holder, list):
            holder.insert(key, holder[key])
        elif what == 2:
            holder[key] = float(draw.choice(("nan", "inf", "-inf")))
        else:
            holder[key] = draw.choice(ODD)
    return json.dumps(found).encode()


TEXTS = [
    b"[" * DEEP,
    b'{"schema": ' * DEEP,
    b'{"schema": "pinstress-results/2", "pins": ' + b"[" * DEEP + b"]" * DEEP + b"}",
    b'{"schema": "pinstress-results/2", "title": ' + b"9" * 10_000 + b"}",
    b'{"schema": "pinstress-results/1"}',
    b'{"schema": "pinstress-results/3"}',
    b'{"schema": "pinstress-results/one"}',
    b'{"schema": 7}',
    b'"\\ud800"',
    b"\xef\xbb\xbf{}",
    b"null",
]


def _places(node: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every value of a JSON text as its container and its key or index."""
    if isinstance(node, dict | list):
        for key in list(node) if isinstance(node, dict) else range(len(node)):
            yield node, key
            yield from _places(node[key])


def damaged_vtu(content: bytes, draw: random.Random) -> bytes:
    """Return a VTU file with an attribute, an array or bytes replaced by something odd."""
    text = content.decode()
    what = draw.randrange(4)
    if what == 0:
        return damaged_bytes(content, draw)
    if what == 1:
        old = draw.choice(
            ["NumberOfPoints", "NumberOfCells", "NumberOfComponents", "type=", "Name="]
        )
        at = text.find(old)
        begin = text.index('"', at) + 1
        end = text.index('"', begin)
        new = draw.choice(["0", "-1", "9" * 30, "1e9", "", "11", "Float99", "UInt8", "\u0663"])
        return (text[:begin] + new + text[end:]).encode()
    if what == 2:
        bomb = '<!DOCTYPE a [<!ENTITY a "aaaa">]>'
        return draw.choice([text.replace("?>", "?>" + bomb, 1), "<a>" * DEEP]).encode()
    return _other_array(text, draw).encode()


def _other_array(text: str, draw: random.Random) -> str:
    name = draw.choice(["connectivity", "offsets", "types", "displacement", "von Mises"])
    header = text.index(f'Name="{name}')
    begin, end = text.index(">", header) + 1, text.index("<", header)
    return text[:begin] + with_block(_random_block(draw)) + text[end:]


def with_block(content: bytes, stated: int | None = None) -> str:
    """Return an array of a VTU file, of one block.

    stated: its size in the header, if not the actual size
    """
    packed, size = zlib.compress(content), len(content) if stated is None else stated
    header = b"".join(n.to_bytes(8, "little") for n in (1, size, 0, len(packed)))
    return b64encode(header).decode() + b64encode(packed).decode()


def _random_block(draw: random.Random) -> bytes:
    size = draw.choice((0, 1, 4, 40, 80, 120, 10_000_000))
    if size > 1000:
        return bytes(size)
    return b"".join(draw.randrange(256).to_bytes(1, "little") for _ in range(size))


def repacked(page: str, name: str, change: Callable[[bytes], bytes]) -> str:
    """Return a report.html with one of its packed parts changed."""
    found = search(rf'<script type="text/plain" id="{name}">([\w+/=]+)</script>', page)
    assert found is not None
    new = change(zlib.decompress(b64decode(found[1])))
    packed = b64encode(zlib.compress(new)).decode()
    return page[: found.start(1)] + packed + page[found.end(1) :]


def damaged_page(content: bytes, draw: random.Random) -> bytes:
    """Return a report.html with its bytes damaged, or one of its packed parts."""
    if draw.random() < 0.2:
        return damaged_bytes(content, draw)
    name = draw.choice(("plots", "paper"))
    return repacked(content.decode(), name, lambda text: damaged_json(text, draw)).encode()

"""Unpack the numbers that reports.format.packed packs."""

from __future__ import annotations

import zlib
from base64 import b64decode

import numpy as np

from pinbase.dimensions import Floats
from reports.format.template import TEMPLATE_FOLDER

# The types that the page's script can unpack; with any other a view stays empty.
SCRIPT = (TEMPLATE_FOLDER / "packed.js").read_text(encoding="utf-8")
KINDS = SCRIPT.split("const KINDS = {")[1].split("}")[0]


def unpacked(data: dict[str, str]) -> Floats:
    """Return the numbers, unpacked as packed.js does it."""
    assert f"{data['kind']}: " in KINDS, data["kind"]
    content = zlib.decompress(b64decode(data["packed"]))
    kind = np.dtype("<" + data["kind"])
    flat = np.frombuffer(content, np.uint8).reshape(kind.itemsize, -1).T.copy().view(kind)[:, 0]
    if kind.kind != "f":
        flat = np.cumsum(flat, dtype=kind)
    return flat.astype(np.float64)

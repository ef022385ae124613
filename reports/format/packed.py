"""Data inside a page, compressed and encoded as text."""

from __future__ import annotations

import zlib
from base64 import b64encode
from typing import Any

import numpy as np

COMPRESSION_LEVEL = 7  # takes a third of the time of level 9, whose output is 1 % smaller


def deflated(content: bytes) -> str:
    """Return the content compressed by zlib, in base64; `inflated` of packed.js reads it."""
    return b64encode(zlib.compress(content, COMPRESSION_LEVEL)).decode("ascii")


def packed(values: np.ndarray[Any, Any], kind: str) -> dict[str, str]:
    """Return numbers of a NumPy type, little-endian and compressed, as `unpacked` of packed.js
    reads them.

    Integers are stored as differences of successive numbers: the first bytes of all differences,
    then the second bytes, and so on. More of these bytes are equal, so they compress better.
    """
    flat = np.ascontiguousarray(values, dtype=kind).ravel()
    if flat.dtype.kind in "iu" and len(flat):
        flat = np.diff(
            flat, prepend=flat.dtype.type(0)
        )  # overflow wraps, and so does the sum that undoes it
    of_each = flat.astype(kind).view(np.uint8).reshape(-1, flat.dtype.itemsize)
    return {"kind": np.dtype(kind).str[1:], "packed": deflated(of_each.T.tobytes())}

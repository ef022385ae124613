"""A memory of values by the content of all that they depend on, within a number of bytes."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping
from types import NoneType
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")
# As tuples, since unions of types take twice as long to tell, and a memo asks a million times.
SCALARS = (int, float, type, NoneType)
TEXTS = (bytes, str)
COLLECTIONS = (list, tuple, set, frozenset)

# Bytes: the flexibilities and meshes of two or three pins in contact (about 150 MB each).
MAX_MEMO_SIZE = 4 * 10**8


class Memo:
    """Values by their keys; when they exceed a size, those not asked for longest are forgotten.

    A key holds everything that its value depends on, and a value is never changed. So an answer
    is the same to the last bit whatever was asked before.
    max_size: bytes of arrays and texts in all values; the latest value is kept however large.
    made: number of values that were made by `get`.
    """

    def __init__(self, max_size: int = MAX_MEMO_SIZE) -> None:
        self._max_size, self._total, self.made = max_size, 0, 0
        self._values: OrderedDict[Hashable, tuple[Any, int]] = OrderedDict()
        self._latest: Hashable = None  # the key of the value written last

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        """The value of a key, made now unless it is remembered.

        Raises: what `make` raises; then nothing is remembered.
        """
        if key not in self._values:
            value = make()
            self.made += 1
            self.write(key, value)
            return value
        known: T = self.read(key)
        return known

    def read(self, key: Hashable) -> Any:
        """The value of a key; None where it is not remembered."""
        if key not in self._values:
            return None
        self._values.move_to_end(key)
        return self._values[key][0]

    def write(self, key: Hashable, value: object) -> None:
        """Remember a value."""
        if self._latest in self._values:  # it has grown by what was derived from it since
            self._measure(self._latest, self._values[self._latest][0])
        self._measure(key, value)
        self._values.move_to_end(key)
        self._latest = key
        while self._total > self._max_size and len(self._values) > 1:
            self._total -= self._values.popitem(last=False)[1][1]

    def _measure(self, key: Hashable, value: object) -> None:
        size = size_of(value)
        self._total += size - self._values.get(key, (None, 0))[1]
        self._values[key] = value, size


def size_of(value: object) -> int:
    """Bytes of the arrays and texts in a value and in its attributes, each counted once."""
    seen: set[int] = set()

    def size(x: object) -> int:
        # Named tuples in values are unit loads, of names and numbers, in thousands.
        if isinstance(x, SCALARS) or id(x) in seen or hasattr(type(x), "_fields"):
            return 0
        seen.add(id(x))
        if isinstance(x, np.ndarray):
            return x.nbytes
        if isinstance(x, TEXTS):
            return len(x)
        if isinstance(x, COLLECTIONS):  # before mappings, whose abstract type takes longest to tell
            return sum(map(size, x))
        if isinstance(x, Mapping):
            return sum(size(part) for both in x.items() for part in both)
        return sum(map(size, getattr(x, "__dict__", {}).values()))

    return size(value)

"""A cache of values by the content of everything on which they depend, of a limited size."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping
from types import NoneType
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")
# Tuples, because isinstance takes twice as long with unions of types, and a memo calls it a million
# times.
SCALARS = (int, float, type, NoneType)
TEXTS = (bytes, str)
COLLECTIONS = (list, tuple, set, frozenset)

# Bytes; enough for the flexibilities and meshes of two or three pins in contact, 150 MB each.
MAX_MEMO_SIZE = 4 * 10**8


class Memo:
    """A cache of values by their keys; beyond a size, the least recently used values are dropped.

    A key holds everything on which its value depends, and a value is never changed. So a result is
    the same to the last bit, whatever was computed before.
    max_size: bytes of arrays and texts in all values; the latest value is kept, however large.
    made: number of values that `get` has made.
    """

    def __init__(self, max_size: int = MAX_MEMO_SIZE) -> None:
        self._max_size, self._total, self.made = max_size, 0, 0
        self._values: OrderedDict[Hashable, tuple[Any, int]] = OrderedDict()
        self._latest: Hashable = None  # the key of the value written last

    def get(self, key: Hashable, make: Callable[[], T]) -> T:
        """The value of a key; it is made and stored unless it is in the cache.

        Raises: the errors of `make`; then nothing is stored.
        """
        if key not in self._values:
            value = make()
            self.made += 1
            self.write(key, value)
            return value
        known: T = self.read(key)
        return known

    def read(self, key: Hashable) -> Any:
        """The value of a key; None where it is not in the cache."""
        if key not in self._values:
            return None
        self._values.move_to_end(key)
        return self._values[key][0]

    def write(self, key: Hashable, value: object) -> None:
        """Store a value."""
        if self._latest in self._values:  # since then it may have grown by cached properties
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
        # Named tuples are not counted: in values they are unit loads, thousands of them, which
        # consist of names and numbers.
        if isinstance(x, SCALARS) or id(x) in seen or hasattr(type(x), "_fields"):
            return 0
        seen.add(id(x))
        if isinstance(x, np.ndarray):
            return x.nbytes
        if isinstance(x, TEXTS):
            return len(x)
        if isinstance(x, COLLECTIONS):  # before mappings, for which isinstance takes longest
            return sum(map(size, x))
        if isinstance(x, Mapping):
            return sum(size(part) for both in x.items() for part in both)
        return sum(map(size, getattr(x, "__dict__", {}).values()))

    return size(value)

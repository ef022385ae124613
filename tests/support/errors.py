"""Check errors by their code and by the names in their message, not by its wording."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeVar

import pytest

E = TypeVar("E", bound=Exception)


@contextmanager
def raises(kind: type[E], code: str, *named: str) -> Iterator[pytest.ExceptionInfo[E]]:
    """Assert that the block raises an error of this kind with this code, whose message contains all
    of `named`.
    """
    with pytest.raises(kind) as caught:
        yield caught
    codes = getattr(caught.value, "codes", None) or (getattr(caught.value, "code", None),)
    assert code in codes, f"{codes}: {caught.value}"
    for name in named:
        assert name in str(caught.value)

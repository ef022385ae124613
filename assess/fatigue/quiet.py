"""Calls of pyLife without its output and warnings; everything relevant is in the results."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout


@contextmanager
def quiet() -> Iterator[None]:
    """Suppress warnings and printing within a context.

    pyLife 2.3 uses functions that pandas 3 deprecates, takes roots of negative numbers for cycles
    in compression, and prints hints on P_RAJ.
    """
    with warnings.catch_warnings(), redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        yield

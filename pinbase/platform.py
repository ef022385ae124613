"""Which of two ways is taken where operating systems differ: what Linux alone has, or its portable
twin. PINSTRESS_PORTABLE=1 takes the twins on Linux too, so that they are tested.
"""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import Any

PORTABLE_VARIABLE = "PINSTRESS_PORTABLE"


def portable() -> bool:
    """Whether to use nothing but what Windows and macOS have, too."""
    return sys.platform != "linux" or not hasattr(os, "fork") or _requested()


def offered(library: str) -> Any:
    """A compiled library that has no wheels for some systems; None where it is missing."""
    if _requested():
        return None
    try:
        return import_module(library)
    except ImportError:
        return None


def _requested() -> bool:
    return os.environ.get(PORTABLE_VARIABLE) == "1"

"""The choice between features that only Linux has and their portable substitutes.

PINSTRESS_PORTABLE=1 chooses the substitutes on Linux too, so that they can be tested there.
"""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import Any

PORTABLE_VARIABLE = "PINSTRESS_PORTABLE"


def portable() -> bool:
    """Return whether to use only features that Windows and macOS also have."""
    return sys.platform != "linux" or not hasattr(os, "fork") or _requested()


def offered(library: str) -> Any:
    """Return the compiled library of this name, or None where the system does not offer it."""
    if _requested():
        return None
    try:
        return import_module(library)
    except ImportError:
        return None


def _requested() -> bool:
    return os.environ.get(PORTABLE_VARIABLE) == "1"

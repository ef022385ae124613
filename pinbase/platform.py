"""Features that `geometry` and `fea` find only on some operating systems.

PINSTRESS_PORTABLE=1 treats them as missing on Linux too, so that the code for other systems can be
tested there (pinbase/processes/system.py does the same for processes).
"""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any


def portable() -> bool:
    """Whether to use only what every operating system has."""
    return os.name != "posix" or os.environ.get("PINSTRESS_PORTABLE") == "1"


def offered(library: str) -> Any:
    """The compiled library of this name, or None where the system has no wheel for it."""
    if os.environ.get("PINSTRESS_PORTABLE") == "1":
        return None
    try:
        return import_module(library)
    except ImportError:
        return None

"""What not every operating system offers to `geometry` and `fea`. PINSTRESS_PORTABLE=1 takes it as
missing on Linux too, so that what is done without it is tested (as pinbase/processes/system.py
does for the processes).
"""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any


def portable() -> bool:
    """Whether to do without whatever only some systems have."""
    return os.name != "posix" or os.environ.get("PINSTRESS_PORTABLE") == "1"


def offered(library: str) -> Any:
    """A compiled library that has no wheels for some systems; None where it is missing."""
    if os.environ.get("PINSTRESS_PORTABLE") == "1":
        return None
    try:
        return import_module(library)
    except ImportError:
        return None

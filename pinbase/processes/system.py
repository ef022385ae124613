"""Which of two ways is taken where operating systems differ: what Linux alone has, or its portable
twin. PINSTRESS_PORTABLE=1 takes the twins on Linux too, so that they are tested.
"""

from __future__ import annotations

import os
import sys

PORTABLE_VARIABLE = "PINSTRESS_PORTABLE"


def portable() -> bool:
    """Whether to use nothing but what Windows and macOS have, too."""
    return (
        sys.platform != "linux"
        or not hasattr(os, "fork")
        or os.environ.get(PORTABLE_VARIABLE) == "1"
    )

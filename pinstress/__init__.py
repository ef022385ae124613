"""Pinstress: stresses and safety factors of the pins of a linkage.

import pinstress
study = pinstress.load_study("studies/grenier2008.toml")
results = pinstress.run(study)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pinstress.errors import InputError
    from pinstress.found import Found, run
    from pinstress.study import Study, load_study

__version__ = "0.1.0"
__all__ = ["Found", "InputError", "Study", "load_study", "run"]

_HOME = {
    "Found": "pinstress.found",
    "InputError": "pinstress.errors",
    "Study": "pinstress.study",
    "load_study": "pinstress.study",
    "run": "pinstress.found",
}


def __getattr__(name: str) -> Any:
    # on demand, so that `pinstress check` does not wait for the numeric libraries
    if name not in _HOME:
        raise AttributeError(f"module 'pinstress' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOME[name]), name)

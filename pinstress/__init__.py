"""Pinstress: stresses and safety factors of the pins of a linkage.

import pinstress
study = pinstress.load_study("studies/grenier2008.toml")
results = pinstress.run(study)
results["B", "landing"].safety_factor
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pinstress.analysis.engine import Engine
    from pinstress.analysis.plan import prepare
    from pinstress.analysis.results import RunResults, run, solve
    from pinstress.explore.sweep.sweep import sweep
    from pinstress.study.model.load import load_study
    from pinstress.study.reading.errors import InputError
    from pinstress.study.reading.file import Study
    from pinstress.study.reading.in_python import changed_study, study_from
    from pinstress.study.reading.shipped import shipped_studies

__version__ = "0.1.0"
__all__ = [
    "Engine",
    "InputError",
    "RunResults",
    "Study",
    "changed_study",
    "load_study",
    "prepare",
    "run",
    "shipped_studies",
    "solve",
    "study_from",
    "sweep",
]  # fmt: skip

_MODULE_OF = {
    "Engine": "pinstress.analysis.engine",
    "InputError": "pinstress.study.reading.errors",
    "RunResults": "pinstress.analysis.results",
    "Study": "pinstress.study.reading.file",
    "changed_study": "pinstress.study.reading.in_python",
    "load_study": "pinstress.study.model.load",
    "prepare": "pinstress.analysis.plan",
    "run": "pinstress.analysis.results",
    "shipped_studies": "pinstress.study.reading.shipped",
    "solve": "pinstress.analysis.results",
    "study_from": "pinstress.study.reading.in_python",
    "sweep": "pinstress.explore.sweep.sweep",
}


def __getattr__(name: str) -> Any:
    # on demand, so that `pinstress check` does not wait for the numeric libraries
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'pinstress' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_MODULE_OF[name]), name)

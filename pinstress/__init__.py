"""Pinstress: stresses and safety factors of the pins of a linkage.

    import pinstress
    study = pinstress.load_study("studies/one_pin.toml")
    results = pinstress.run(study, tolerance=0.1)
    row = results["B", "landing"]
    row  # <B landing: safe, factor 119.9 ± .. %, 1,877 psi at surface z = 1.743 in>
    row.safety_factor  # float
    row.plot().save("B.svg")  # the pin with the stress along it; notebooks show it
    results.frame()  # a pandas.DataFrame of the safety factors
    thicker = pinstress.changed_study(study, {"pin.B.profile[2].diameter": "2.2 in"})

A study
    load_study(path) -> Study                            read and validate a study file
    study_from(tables or text) -> Study                  from a dict, or the text of a study file
    changed_study(study, {key: value}) -> Study          with other values by their keys
    shipped_studies() -> dict[str, Path]                 the study files that come with pinstress
Results
    run(study, pins=, cases=, tolerance=, ..) -> RunResults
    prepare(study, ..) -> Plan, solve(plan) -> RunResults   the same in two steps
Many designs
    Engine(study).answer({key: value}) -> RunResults     the study solved again, with changes
    curve(study, key, (first, last)) -> FactorCurve      factors of safety against one number
    sweep(study, ..)                                     all designs that [vary] describes
Errors in a study raise InputError, which states where they are and what would be right.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pinstress.analysis.engine import Engine
    from pinstress.analysis.plan import prepare
    from pinstress.analysis.results import RunResults, run, solve
    from pinstress.explore.curve import curve
    from pinstress.explore.sweep.sweep import sweep
    from pinstress.study.model.load import load_study
    from pinstress.study.reading.errors import InputError
    from pinstress.study.reading.file import Study
    from pinstress.study.reading.in_python import changed_study, study_from
    from pinstress.study.reading.shipped import shipped_studies

__version__ = "0.1.0"
_MODULE_OF = {
    "Engine": "pinstress.analysis.engine",
    "InputError": "pinstress.study.reading.errors",
    "RunResults": "pinstress.analysis.results",
    "Study": "pinstress.study.reading.file",
    "changed_study": "pinstress.study.reading.in_python",
    "curve": "pinstress.explore.curve",
    "load_study": "pinstress.study.model.load",
    "prepare": "pinstress.analysis.plan",
    "run": "pinstress.analysis.results",
    "shipped_studies": "pinstress.study.reading.shipped",
    "solve": "pinstress.analysis.results",
    "study_from": "pinstress.study.reading.in_python",
    "sweep": "pinstress.explore.sweep.sweep",
}
__all__ = [*_MODULE_OF]


def __getattr__(name: str) -> Any:
    # Imported on demand, so that `pinstress check` does not load the numeric libraries.
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'pinstress' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_MODULE_OF[name]), name)


def __dir__() -> list[str]:
    return sorted([*__all__, "__doc__", "__version__"])

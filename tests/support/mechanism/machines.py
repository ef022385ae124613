"""The shipped machines, solved, and quantities read from their results."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.file import Study, load_study
from tests.conftest import ROOT

G = 9.80665
STUDIES = ROOT / "studies"


def solved(study: Study) -> dict[str, CaseLoads]:
    mechanism = linkage(study)
    return {name: case_loads(study, name, mechanism) for name in study.table.case}


@cache
def machine(name: str) -> dict[str, CaseLoads]:
    return solved(load_study(STUDIES / f"{name}.toml"))


def drive(case: CaseLoads) -> Any:
    assert case.dynamics is not None
    return case.dynamics.drive


def force(case: CaseLoads, connection: str, at: int = 0) -> complex:
    """Return the force of a connection's pin on the body, as a complex number."""
    x, y, _ = case.reactions.force(connection)[at]
    return complex(-x, -y)


def cross(a: complex, b: complex) -> float:
    return a.real * b.imag - a.imag * b.real


def slope(of: Callable[[float], float], at: float, h: float = 1e-5) -> float:
    return (8 * (of(at + h) - of(at - h)) - (of(at + 2 * h) - of(at - 2 * h))) / (12 * h)

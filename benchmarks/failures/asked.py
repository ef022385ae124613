"""The studies of the gallery, and pinstress's answers to them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from fea.core.material import Material
from pinstress import load_study
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.results import solve
from pinstress.study.model.pins import material
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.numbers import engineering, ratio
from reports.format.ranges import error_words

ROOT = Path(__file__).parents[2]
STUDIES = ROOT / "studies" / "failures"
ROUNDING = 1e-9  # relative; sections under given loads have no error


def command(name: str, verb: str = "run", *more: str) -> str:
    """Return the command that a reader types."""
    return " ".join((f"pinstress {verb} studies/failures/{name}.toml", *more))


@cache
def study(name: str) -> Study:
    """Return a study by the stem of its file."""
    return load_study(STUDIES / f"{name}.toml")


@cache
def plan(name: str) -> Plan:
    """Return the pins and loads of a study, before anything is solved."""
    return prepare(study(name))


def task(name: str, pin: str = "P") -> Task:
    """Return the support and the loads of a pin in all cases of the study."""
    return next(t for t in plan(name).tasks if t.pin.name == pin)


def material_of(name: str, pin: str = "P") -> Material:
    """Return the material of a pin."""
    return material(study(name), study(name).table.pin[pin].material)


@cache
def answer(name: str) -> Results:
    """Return the results of `pinstress run`, with its own choice of model and meshes."""
    return solve(plan(name))


def row(name: str, pin: str = "P", case: str | None = None) -> PinResult:
    """Return one row of the results."""
    rows = (r for r in answer(name).pins if r.pin == pin and case in (None, r.case))
    return next(rows)


def told(found: PinResult, unit: str = "MPa") -> str:
    """Return a row as a sentence: verdict, value with error, note."""
    if found.max_von_mises is None:
        return f"`{found.verdict}`: {found.note}."
    value = f"{engineering(found.max_von_mises)} {unit} ({error_words(found)})"
    return f"`{found.verdict}`, {value}: {found.note}."


def error_of(found: PinResult) -> float:
    """Return the error by meshes, instants and models, without that of the excluded distance."""
    return sum(found.error_parts.values())


def contains(found: PinResult, truth: float) -> bool:
    """Return whether the estimated error contains the true maximum, in the study's unit."""
    if found.max_von_mises is None:
        return False
    return abs(found.max_von_mises - truth) <= error_of(found) + ROUNDING * truth


def surface_contains(found: PinResult, truth: float) -> bool:
    """Return whether the error of the surface's own maximum contains the true one, in the study's
    unit.
    """
    if found.places is None:
        return False
    surface = found.places.surface
    return abs(surface.max_von_mises - truth) <= surface.error_estimate


def off(value: float, truth: float) -> float:
    """Return the relative error in %."""
    share = ratio(value, truth)
    assert share is not None
    return 100.0 * (share - 1.0)

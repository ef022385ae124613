"""Cuts by local solids: known ones, beside the whole solid and CalculiX."""

from __future__ import annotations

import math
import resource
import time

import numpy as np

from benchmarks.cut_calculix import Other, in_calculix_locally
from benchmarks.cut_cost import FURTHER, SHAFT, D, cut_cost, four_point
from benchmarks.random_pins import STEEL
from benchmarks.timing import table
from fea.checks.calculix import installed
from fea.core.peak import Peak
from fea.core.pin_loads import PinLoads
from fea.solve_pin import Asked, Model, Solution, solve_pin
from geometry import CutPin, Hole

HOLE = 0.004
NOMINAL = 32.0 * 1500.0 * 0.02 / (np.pi * D**3)
# Meshes of CalculiX, graded as local solids are, and finer where stress is largest in these: on
# both mouths, on both sides.
OTHERS = (0, 1, 2)
SPOTS = tuple((x, y, 0.08) for x in (0.0095, -0.0095) for y in (0.002, -0.002))
EQUAL = 0.0015  # relative error at which both are compared, about ours
# Largest von Mises stress over the nominal one, and what is known of it: an eighth in CalculiX on
# local meshes, whose stress is read in two ways.
KNOWN = {"tension": (3.395, 0.005), "bending": (3.10, 0.01)}


def cut() -> str:
    """A hole of a fifth of the shaft's diameter in tension and in bending, at the extreme fibre;
    then all kinds of cuts.
    """
    pin = CutPin(SHAFT, (Hole(0.08, HOLE),))
    local = [_row(pin, name, "auto", 0.01) for name in KNOWN]
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    answer = _solved(pin, _loads("bending"), "auto", 0.01).answer
    assert answer is not None
    work = time.process_time()
    answer.maxima(_loads("bending", FURTHER))
    further = 1e3 * (time.process_time() - work)
    rows: list[tuple[object, ...]] = [*local]
    rows += [_row(pin, name, "solid", 0.05) for name in KNOWN]
    told = []
    for (name, _, _, ours, *_), known in zip(local, KNOWN.values(), strict=True):
        if installed():
            found = [in_calculix_locally(pin, _loads(name), k, SPOTS) for k in OTHERS]
            rows += [_other(name, other) for other in found]
            true = known[0] * _nominal(name)
            errors = np.array([abs(other.maximum / true - 1.0) for other in found])
            spent = np.array([other.seconds for other in found])
            slope, start = np.polyfit(np.log(errors), np.log(spent), 1)
            equal = math.exp(start + slope * math.log(EQUAL))
            told.append(f"{name} {equal:.2g} s, {equal / ours:.2g} times ours")
    head = (
        "load", "model", "unknowns", "processor s", "max von Mises, MPa", "±", "true", "verdict",
    )  # fmt: skip
    least = "; ".join(told)
    at_equal = f" CalculiX at an error of {EQUAL:.2%}, by a line through its three: {least}."
    return (
        f"{table(head, rows)}\n\nWith local solids the process takes {memory:.0f} MB at most, and "
        f"{FURTHER} further instants {further:.0f} ms of processor time.{at_equal if told else ''}"
        f"\n\n{cut_cost()}"
    )


def _nominal(name: str) -> float:
    """Pa."""
    return 100e6 if name == "tension" else NOMINAL


def _row(
    pin: CutPin, name: str, model: Model, tolerance: float
) -> tuple[str, str, int, float, str, str, str, str]:
    factor, known = KNOWN[name]
    nominal = _nominal(name) / 1e6
    work = time.process_time()
    peak = _solved(pin, _loads(name), model, tolerance).peak
    spent = time.process_time() - work
    value, error = _stress(peak)
    true = f"{factor * nominal:.1f} ± {known * nominal:.1f}"
    shown = f"{value / 1e6:.1f}", f"{error / 1e6:.1f}", true
    return name, peak.model, peak.dofs, spent, *shown, peak.verdict


def _other(name: str, found: Other) -> tuple[object, ...]:
    factor, known = KNOWN[name]
    nominal = _nominal(name) / 1e6
    true = f"{factor * nominal:.1f} ± {known * nominal:.1f}"
    value = f"{found.maximum / 1e6:.1f}"
    return name, "CalculiX", found.unknowns, found.seconds, value, "", true, ""


def _loads(name: str, count: int = 1) -> PinLoads:
    if name == "bending":
        return four_point(count)
    pull = 100e6 * np.pi * D**2 / 4.0
    size = np.cos(np.arange(count))[:, None, None]
    return PinLoads(name, ("A", "E"), size * np.array([[0, 0, -pull], [0, 0, pull]]))


def _solved(pin: CutPin, loads: PinLoads, model: Model, tolerance: float) -> Solution:
    return solve_pin(pin, STEEL, (), (loads,), Asked(tolerance, model))[0]


def _stress(peak: Peak) -> tuple[float, float]:
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    return peak.max_von_mises, peak.error_estimate

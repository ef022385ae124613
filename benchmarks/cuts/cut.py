"""Cuts with known stress by local solids, compared with the solid model and CalculiX."""

from __future__ import annotations

import math
import resource
import time
from dataclasses import replace

import numpy as np

from assess.opinion.calculix import installed
from benchmarks.cuts.cut_calculix import Other, in_calculix_locally
from benchmarks.cuts.cut_cost import FURTHER, SHAFT, D, cut_cost, four_point
from benchmarks.random_pins import STEEL
from benchmarks.timing import table
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Model, Requirement
from fea.cut.evaluate import cut_result, cut_solution
from fea.cut.field import CutField
from fea.cut.region import loaded_bands, pieces
from fea.harmonic.section_solution import SectionProblem
from fea.singular.singularities import singularities_of
from fea.solve.solve import solve_pin
from fea.support.support import Solution
from geometry import CutPin, Hole

HOLE = 0.004
NOMINAL = 32.0 * 1500.0 * 0.02 / (np.pi * D**3)
# Meshes of CalculiX, graded like those of local solids, and finer where the stress of these is
# largest: at both mouths, on both sides.
OTHERS = (0, 1, 2)
SINGLE = (0, 1, 2)  # our meshes, finer at one of these spots; the others are its images
SPOTS = tuple((x, y, 0.08) for x in (0.0095, -0.0095) for y in (0.002, -0.002))
EQUAL = 0.003  # relative error at which both are compared; the true values are no more accurate
# Largest von Mises stress over the nominal one, and its uncertainty: from an eighth of the shaft in
# CalculiX on local meshes, whose stress is read in two ways.
KNOWN = {"tension": (3.395, 0.005), "bending": (3.10, 0.01)}


def cut() -> str:
    """Return the table of a hole at the extreme fibre, a fifth of the shaft's diameter wide, in
    tension and in bending, followed by the table of all kinds of cuts.
    """
    cost = cut_cost()  # first, since the memory of a new process includes the peak of this one
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
    head = (
        "load", "model", "unknowns", "processor s", "max von Mises, MPa", "±", "true", "verdict",
    )  # fmt: skip
    return (
        f"{table(head, rows)}\n\nWith local solids the process takes {memory:.0f} MB at most, and "
        f"{FURTHER} further instants {further:.0f} ms of processor time.\n\n{_alike(pin)}\n\n"
        f"{cost}"
    )


def _alike(pin: CutPin) -> str:
    """Return the table of single meshes of ours and of CalculiX, all by our mesher, finer at the
    known spots.
    """
    rows, told = [], []
    for name, (factor, _) in KNOWN.items():
        true = factor * _nominal(name)
        ours = [_single(pin, name, level) for level in SINGLE]
        found = [in_calculix_locally(pin, _loads(name), k, SPOTS) for k in _others()]
        both = (("harmonic+local", [one for one, _ in ours]), ("CalculiX", found))
        least = []
        for model, meshes in both:
            for one in meshes:
                off = one.maximum / true - 1.0
                rows.append((name, model, one.unknowns, one.meshing, one.seconds, 100.0 * off))
            fine = [m for m in meshes if abs(m.maximum / true - 1.0) <= EQUAL]
            least.append(min((m.meshing + m.seconds for m in fine), default=math.nan))
        if not found:
            continue
        one, three = found[1], in_calculix_locally(pin, _loads(name), OTHERS[1], SPOTS, 3)
        step = 0.5 * (three.seconds - one.seconds)
        motion = one.meshing + one.seconds + FURTHER * step
        mine = ours[1][0].meshing + ours[1][0].seconds + ours[1][1]
        told.append(
            f"{name}: {least[0]:.2g} s and {least[1]:.2g} s, {least[1] / least[0]:.2g} times ours; "
            f"{FURTHER + 1} instants, on the second mesh of each: {mine:.2g} s and {motion:.3g} s, "
            f"{motion / mine:.2g} times ours"
        )
    head = ("load", "model", "unknowns", "meshing s", "all else, s", "off the true value, %")
    text = (
        f"\n\nProcessor time of the cheapest single mesh that is off by {EQUAL:.1%} at most, ours "
        f"and CalculiX's, and of a motion: {'; '.join(told)}. CalculiX's motion is extrapolated "
        "from three steps; it factors in each of them."
    )
    return f"{table(head, rows)}{text if told else ''}"


def _others() -> tuple[int, ...]:
    return OTHERS if installed() else ()


def _single(pin: CutPin, name: str, level: int) -> tuple[Other, float]:
    """Return the result of one mesh of ours, fine where CalculiX's are, and the time of further
    instants, s.
    """
    loads, bands = _loads(name), loaded_bands(pin, pin.connections)
    zones = singularities_of(pin.profile, STEEL, (), (loads,))
    problem = SectionProblem(pin.profile, STEEL, (), (loads,), zones)
    about = pieces(pin, (), bands=bands)
    first = cut_result(cut_solution(problem, about, 0, (), bands), zones, loads)
    known = replace(first, local_high=SPOTS[:1])
    start = time.process_time()
    solution = cut_solution(problem, about, level, [known], bands)
    found = cut_result(solution, zones, loads)
    spent = time.process_time() - start
    again = time.process_time()
    CutField(solution, zones).maxima(_loads(name, FURTHER))
    return Other(found.unknowns, found.maximum, spent), time.process_time() - again


def _nominal(name: str) -> float:
    """Return the nominal stress, Pa."""
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


def _loads(name: str, count: int = 1) -> PinLoads:
    if name == "bending":
        return four_point(count)
    pull = 100e6 * np.pi * D**2 / 4.0
    size = np.cos(np.arange(count))[:, None, None]
    return PinLoads(name, ("A", "E"), size * np.array([[0, 0, -pull], [0, 0, pull]]))


def _solved(pin: CutPin, loads: PinLoads, model: Model, tolerance: float) -> Solution:
    return solve_pin(pin, STEEL, (), (loads,), Requirement(tolerance, model))[0]


def _stress(peak: Maximum) -> tuple[float, float]:
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    return peak.max_von_mises, peak.error_estimate

"""The effect of modelling choices on the floating pins of the landing gear with fillets: supports,
distribution of the pressure of links, Fourier terms of this pressure, instants of the motion.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from benchmarks import ROOT
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.evaluate import harmonic_result
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.harmonic.superposition import Circumference
from fea.singular.singularities import singularities_of
from fea.solve.refine import MESH_RATIO
from fea.solve.solve import solve_pin
from geometry import Pin
from pinstress import load_study
from pinstress.analysis.plan import prepare
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.pins import material
from pinstress.study.model.tasks import Task

STUDY = ROOT / "studies" / "landing_gear.toml"
CASE = "retract"
PUBLISHED = {"C": "C2", "E": "E1", "F": "F1", "G": "G3", "J": "J3"}  # published clamped bands
TERMS = (1, 2, 4, 6, 8, 10, 12)
TRUE_TERMS = 20
LEVEL = 2  # of the mesh, for comparisons on one mesh
INSTANTS = (6, 11, 21, 51, 101, 201)
TRUE_INSTANTS = 4001


@cache
def _gear() -> tuple[dict[str, Task], CaseLoads, Material]:
    plan = prepare(load_study(STUDY), pins=PUBLISHED, cases=[CASE])
    found = {task.pin.name: task for task in plan.tasks}
    return found, plan.loads[CASE], material(plan.study, plan.study.table.pin["C"].material)


def holding() -> str:
    """Return the table of maxima of the same pin under the same forces, by its support and the
    distribution of the links' pressure.
    """
    found, _, steel = _gear()
    rows = []
    for name, band in PUBLISHED.items():
        pin, (loads,) = found[name].pin, found[name].loads
        free = [c for c in loads.surfaces if c != band]
        keep = [loads.surfaces.index(c) for c in free]
        clamped = PinLoads(CASE, tuple(free), loads.forces[:, keep], loads.moments[:, keep])
        ways = (
            ((band,), clamped),
            ((), replace(loads, distribution="uniform")),
            ((), loads),
        )
        peaks = [solve_pin(pin, steel, held, (way,), Requirement())[0].peak for held, way in ways]
        values = [p.max_von_mises or float("nan") for p in peaks]
        told = [f"{v / 1e6:.2f} {p.verdict}" for v, p in zip(values, peaks, strict=True)]
        rows.append((name, *told, values[0] / values[2], values[1] / values[2]))
    head = ("pin", "clamped, uniform", "balanced, uniform", "balanced, pressure")
    return "\n\n".join(
        (
            "Largest von Mises stress of the retraction, MPa; for singular ones outside the "
            "excluded zones. The ratios are relative to the balanced pin with bearing pressure:",
            table((*head, "clamped / pressure", "uniform / pressure"), rows),
        )
    )


def terms() -> str:
    """Return the table of maxima by the highest harmonic of the bearing pressure, on one mesh."""
    found, _, steel = _gear()
    rows = []
    for name, task in found.items():
        pin, loads = _revolved(task), replace(task.loads[0], terms=TRUE_TERMS)
        singularities = singularities_of(pin, steel, (), (loads,))
        problem = SectionProblem(pin, steel, (), (loads,), singularities)
        solution = harmonic_solution(problem, LEVEL, MESH_RATIO)
        true = harmonic_result(solution, singularities, loads).maximum
        few = (
            harmonic_result(solution, singularities, replace(loads, terms=n)).maximum for n in TERMS
        )
        rows.append((name, *(f"{100.0 * (value / true - 1.0):+.2f}" for value in few)))
    head = ("pin", *(f"n <= {n}" for n in TERMS))
    told = f"Change of the maximum from that with terms up to {TRUE_TERMS}, %:"
    return f"{told}\n\n{table(head, rows)}"


def instants() -> str:
    """Return the table of the error of the maximum over the motion, by the number of evenly spaced
    instants.
    """
    found, given, steel = _gear()
    assert given.reactions.times is not None
    start, end = given.reactions.times[[0, -1]]
    counts = (*INSTANTS, TRUE_INSTANTS)
    rows = []
    for name, task in found.items():
        pin = _revolved(task)
        cases = [task.between[CASE](np.linspace(start, end, n)) for n in counts]
        singularities = singularities_of(pin, steel, (), (cases[-1],))
        problem = SectionProblem(pin, steel, (), (cases[-1],), singularities)
        solution = harmonic_solution(problem, LEVEL, MESH_RATIO)
        among = solution.fields.outside(singularities)
        *few, true = (Circumference(solution.fields, loads).top(among).value for loads in cases)
        rows.append((name, *(f"{100.0 * (value / true - 1.0):+.3f}" for value in few)))
    told = (
        f"Error of the maximum over the retraction relative to that of {TRUE_INSTANTS} instants, %:"
    )
    return f"{told}\n\n{table(('pin', *map(str, INSTANTS)), rows)}"


def _revolved(task: Task) -> Pin:
    assert isinstance(task.pin, Pin)
    return task.pin

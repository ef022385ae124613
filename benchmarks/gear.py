"""Solving the landing gear's nine pins, held in both ways: computing alone, nothing written."""

from __future__ import annotations

import resource
from pathlib import Path

from benchmarks.timing import seconds, table
from fea.harmonic_look import harmonic_look, harmonic_solution
from fea.ladder import STEP, Solution, places_of, solve_pin
from fea.material import Material
from geometry import Pin
from pinstress import load_study
from pinstress.pins import material
from pinstress.pipeline import Plan, prepare

STUDIES = Path(__file__).parent.parent / "studies"
NAMES = ("grenier2008", "grenier2008_improved")
ONE = "E"


def gear() -> str:
    """Seconds and meshes of both studies, two cases each; and of one pin on its first meshes."""
    plans = {name: prepare(load_study(STUDIES / f"{name}.toml")) for name in NAMES}
    first = next(t for t in plans[NAMES[0]].tasks)
    solve_pin(first.pin, _material(plans[NAMES[0]], first.pin.name), first.clamps, first.loads)
    rows = [_whole(name, plan) for name, plan in plans.items()]
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    pins = ("study", "s", "meshes", "unknowns of the largest", "rows known to 2 %", "rows")
    one = ("meshes finer by", "unknowns", "unit loads", "instants", "ms")
    return "\n\n".join(
        (
            table(pins, rows),
            f"Largest memory: {memory:.0f} MB, libraries included.",
            f"Pin {ONE} of the second study, meshing, all unit loads and the maximum over all "
            "instants:",
            table(one, _one(plans[NAMES[1]])),
        )
    )


def _material(plan: Plan, pin: str) -> Material:
    return material(plan.study, plan.study.table.pin[pin].material)


def _whole(name: str, plan: Plan) -> tuple[object, ...]:
    found: list[Solution] = []

    def solve() -> None:
        for task in plan.tasks:
            steel = _material(plan, task.pin.name)
            found.extend(solve_pin(task.pin, steel, task.clamps, task.loads, plan.asked))

    spent = seconds(solve, 1)
    peaks = [s.peak for s in found]
    meshes = {(p.pin, step.dofs) for p in peaks for step in p.history}
    known = sum((p.error_estimate or 0.0) <= 0.02 * (p.max_von_mises or 0.0) for p in peaks)
    return name, spent, len(meshes), max(dofs for _, dofs in meshes), known, len(peaks)


def _one(plan: Plan) -> list[tuple[object, ...]]:
    (task,) = (t for t in plan.tasks if t.pin.name == ONE)
    pin, steel, loads = task.pin, _material(plan, ONE), task.loads[0]
    assert isinstance(pin, Pin)
    places = places_of(pin, steel, task.clamps, (loads,))
    rows: list[tuple[object, ...]] = []
    for level in range(3):
        unknowns: list[int] = []

        def solve(level: int = level, unknowns: list[int] = unknowns) -> None:
            held = tuple(pin.surface(c) for c in task.clamps)
            solution = harmonic_solution(pin, steel, held, (loads,), places, level, STEP)
            unknowns.append(harmonic_look(solution, places, loads).unknowns)

        spent = seconds(solve)
        units = len(loads.coefficients())
        rows.append((f"{STEP**level:.2f}", unknowns[0], units, len(loads), f"{1e3 * spent:.0f}"))
    return rows

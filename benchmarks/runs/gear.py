"""Solution of the landing gear's nine pins in two cases, with all kinds of support: computation
only.
"""

from __future__ import annotations

import resource
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass, replace
from functools import partial

from benchmarks import ROOT
from benchmarks.timing import seconds, table
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.harmonic.evaluate import harmonic_result
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.singular.singularities import singularities_of
from fea.solve.refine import MESH_RATIO
from fea.solve.solve import solve_pin
from geometry import Pin
from pinbase.processes.pool import Job, Tell, in_parallel
from pinbase.records import pack
from pinstress import load_study
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.stored import cache_key
from pinstress.study.model.pins import material
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study

STUDIES = ROOT / "studies"
FLOATING = ("C", "E", "F", "G", "J")
CORES = 2
ONE = "E"


def gear() -> str:
    """Return the tables of times and meshes of the three kinds of support, and of one pin on its
    first meshes.
    """
    published = load_study(STUDIES / "grenier2008.toml")
    improved = prepare(_in_balance(load_study(STUDIES / "landing_gear.toml")))
    ways = {
        "floating pins clamped, as published": prepare(published),
        "floating pins in balance": prepare(_floating(published)),
    }
    _peaks(list(ways.values())[:1], 1)  # imports
    rows = [_whole(way, plan) for way, plan in ways.items()]
    rows.append(_whole("both ways at once", *ways.values()))
    rows.append(_whole("in balance, with fillets and bearing pressure", improved))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    head = ("how", "s", f"s on {CORES} cores", "meshes", "unknowns of the largest")
    one = ("meshes finer by", "unknowns", "unit loads", "instants", "ms")
    return "\n\n".join(
        (
            "Nine pins, two cases, 201 instants of the motion; pins A, B, D and H are clamped "
            "every time, and solved once where both ways are requested together:",
            table((*head, "maxima converged within 2 %", "of"), map(astuple, rows)),
            f"Largest memory: {memory:.0f} MB, libraries included.",
            f"Pin {ONE} in the last way; time of meshing, all unit loads and the maximum over "
            "all instants:",
            table(one, _one(improved)),
        )
    )


def _floating(study: Study) -> Study:
    """Return the study with no clamps on the floating pins."""
    table = study.table
    pins = {
        name: pin.model_copy(update={"clamp": ()}) if name in FLOATING else pin
        for name, pin in table.pin.items()
    }
    cases = {name: case.model_copy(update={"clamp": {}}) for name, case in table.case.items()}
    return replace(study, table=table.model_copy(update={"pin": pins, "case": cases}))


def _in_balance(study: Study) -> Study:
    """Return the study without lugs; pins are clamped where a structure supports them."""
    pins = {
        name: pin.model_copy(update={"lug": {}, "clamp": pin.clamp or _structure(pin.lug)})
        for name, pin in study.table.pin.items()
    }
    return replace(study, table=study.table.model_copy(update={"pin": pins}))


def _structure(lugs: Iterable[str]) -> tuple[str, ...]:
    return tuple(name for name in lugs if name in ("left", "right"))


def _material(plan: Plan, pin: str) -> Material:
    return material(plan.study, plan.study.table.pin[pin].material)


def _peaks(plans: Sequence[Plan], processes: int) -> list[tuple[bytes, Maximum]]:
    """Return the maxima of all plans, each with the key of its task.

    Equal tasks of several plans are solved once, as the cache of a second run would do.
    """

    def job(plan: Plan, task: Task) -> Job[list[Maximum]]:
        def solve(_: Tell) -> list[Maximum]:
            steel = _material(plan, task.pin.name)
            found = solve_pin(task.pin, steel, task.clamps, task.loads, plan.requirement)
            return [s.peak for s in found]

        return Job(task.pin.name, solve)

    asked = [(pack(cache_key(plan, task)), plan, task) for plan in plans for task in plan.tasks]
    work = {key: (plan, task) for key, plan, task in asked}
    order = sorted(work, key=lambda key: -len(work[key][1].pin.connections))  # as in a run
    done = in_parallel([job(*work[key]) for key in order], processes)
    found = dict(zip(order, done, strict=True))
    peaks = [(key, found[key]) for key, _, _ in asked]
    return [(key, peak) for key, own in peaks if isinstance(own, list) for peak in own]


@dataclass(frozen=True)
class _Row:
    way: str
    alone: float
    together: float
    meshes: int
    largest: int
    known: int
    of: int


def _whole(way: str, *plans: Plan) -> _Row:
    found: list[tuple[bytes, Maximum]] = []

    def solve(processes: int) -> None:
        found[:] = _peaks(plans, processes)

    alone, together = (seconds(partial(solve, n), 2) for n in (1, CORES))
    meshes = {(key, step.dofs) for key, p in found for step in p.history}
    known = sum(
        (p.parts.total if p.parts else 0.0) <= 0.02 * (p.max_von_mises or 0.0) for _, p in found
    )
    largest = max(dofs for _, dofs in meshes)
    return _Row(way, alone, together, len(meshes), largest, known, len(found))


def _one(plan: Plan) -> list[tuple[object, ...]]:
    (task,) = (t for t in plan.tasks if t.pin.name == ONE)
    pin, steel, loads = task.pin, _material(plan, ONE), task.loads[0]
    assert isinstance(pin, Pin)
    singularities = singularities_of(pin, steel, task.clamps, (loads,))
    rows: list[tuple[object, ...]] = []
    for level in range(3):
        unknowns: list[int] = []

        def solve(level: int = level, unknowns: list[int] = unknowns) -> None:
            held = tuple(pin.surface(c) for c in task.clamps)
            problem = SectionProblem(pin, steel, held, (loads,), singularities)
            solution = harmonic_solution(problem, level, MESH_RATIO)
            unknowns.append(harmonic_result(solution, singularities, loads).unknowns)

        spent = seconds(solve)
        units = len(loads.coefficients())
        rows.append(
            (f"{MESH_RATIO**level:.2f}", unknowns[0], units, len(loads), f"{1e3 * spent:.0f}")
        )
    return rows

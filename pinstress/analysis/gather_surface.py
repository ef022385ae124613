"""From a pin's solutions to the surfaces that reports show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fea.core.pin_loads import Floats
from fea.core.solution import Answer
from fea.harmonic.evaluate import HarmonicAnswer
from fea.joint.cell_pressure import CellPressure
from fea.solid.evaluate import SolidAnswer
from fea.solve_pin import Solution
from fea.surface_fields import UnitSurface, amounts, excluded, largest_there, unit_surface
from pinstress.analysis.gather_fields import shown_at
from pinstress.model.cases import CaseLoads
from pinstress.model.tasks import Task
from reports.data.surface import Mask, Surface, SurfaceCase

APART = 0.1  # of a zone's size: nearer points show nothing where nothing is to be read


def surfaces_of(
    loads: dict[str, CaseLoads],
    task: Task,
    solutions: Sequence[Solution],
    pressures: Sequence[CellPressure | None],
) -> tuple[Surface, ...]:
    """A pin's surfaces with all the cases that some model with fields solved, one for each mesh:
    cases in contact have their own.

    pressures: of contact with its lugs, by solution.
    """
    together: dict[int, list[tuple[Solution, CellPressure | None]]] = {}
    for solution, pressure in zip(solutions, pressures, strict=True):
        own = id(_unit_fields(solution.answer))
        together.setdefault(own, []).append((solution, pressure))
    found = (_surface(loads, task, each) for each in together.values())
    return tuple(surface for surface in found if surface is not None)


def _unit_fields(answer: Answer | None) -> object:
    """What answers from one mesh share."""
    if isinstance(answer, SolidAnswer):
        return answer.solution.fields
    return answer.fields if isinstance(answer, HarmonicAnswer) else None


def _surface(
    loads: dict[str, CaseLoads],
    task: Task,
    each: Sequence[tuple[Solution, CellPressure | None]],
) -> Surface | None:
    """Of cases solved on one mesh; None where no model has fields."""
    found = [(s, s.answer, p) for s, p in each if s.answer is not None]
    with_fields = [(s, a, p) for s, a, p in found if unit_surface(a) is not None]
    if not with_fields:
        return None
    surface = unit_surface(with_fields[0][1])
    assert surface is not None
    cases = [
        _pressed(_case(loads[s.peak.case], s, a), surface.points, p) for s, a, p in with_fields
    ]
    if surface.revolved:
        keep = _thinned(surface, np.all([c.excluded for c in cases], axis=0))
    else:
        keep = np.ones(len(surface.points), dtype=bool)
    return Surface(
        pin=task.pin.name,
        points=surface.points[keep],
        triangles=surface.triangles,
        n=surface.n,
        even=surface.even,
        stress=surface.stress[keep],
        displacement=surface.displacement[keep],
        yield_strength=task.material.yield_strength,
        cases=tuple(_kept(c, keep) for c in cases),
    )


def _case(case: CaseLoads, solution: Solution, answer: Answer) -> SurfaceCase:
    """At the case's samples and the governing instant."""
    shown = shown_at(solution, case)
    return SurfaceCase(
        case=solution.peak.case,
        times=shown.loads.times,
        instant=shown.instant,
        amounts=amounts(answer, shown.loads),
        maxima=answer.maxima(shown.loads),
        excluded=excluded(answer),
        largest=largest_there(answer, shown.loads, shown.instant),
    )


def _pressed(case: SurfaceCase, points: Floats, pressure: CellPressure | None) -> SurfaceCase:
    if pressure is None:
        return case
    return replace(case, rings=pressure.rings(points), pressure=pressure.pressure)


def _thinned(surface: UnitSurface, excluded: Mask) -> Mask:
    """Which points (P,) to keep: all outside of what every case excludes, and inside those that
    are apart; a mesh has most of its points there.
    """
    x, keep = surface.points, np.ones(len(surface.points), dtype=bool)
    edges = np.flatnonzero(np.diff(excluded.astype(int), prepend=0, append=0)).reshape(-1, 2)
    for first, end in edges.tolist():
        along = _length(x[first:end])
        last = 0.0
        for k in range(first + 1, end - 1):
            keep[k] = along[k - first] - last > APART * along[-1] / 2.0
            last = along[k - first] if keep[k] else last
    return keep


def _length(points: Floats) -> Floats:
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(step)])


def _kept(case: SurfaceCase, keep: Mask) -> SurfaceCase:
    rings = None if case.rings is None else case.rings[keep]
    return replace(case, excluded=case.excluded[keep], largest=case.largest[keep], rings=rings)

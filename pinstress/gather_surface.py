"""From a pin's solutions, in SI, to the surfaces that reports show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fea.answer import Answer
from fea.ladder import Solution
from fea.pin_loads import Floats, PinLoads
from fea.unit_surface import UnitSurface, amounts, excluded, largest_there, unit_surface
from pinstress.build import CaseLoads
from pinstress.pins import material as material_of
from pinstress.study import Study
from pinstress.tasks import Task
from reports.surface import Mask, Surface, SurfaceCase

APART = 0.1  # of a zone's size: nearer points show nothing where nothing is to be read


def surface_of(
    study: Study, loads: dict[str, CaseLoads], task: Task, solutions: Sequence[Solution]
) -> Surface | None:
    """A pin's surface with all the cases that some model with fields solved; None without any."""
    found = [(s, s.answer) for s in solutions if s.answer is not None]
    with_fields = [(s, a) for s, a in found if unit_surface(a) is not None]
    if not with_fields:
        return None
    surface = unit_surface(with_fields[0][1])  # on one mesh, whichever the case
    assert surface is not None
    acting = {x.case: x for x in task.loads}
    cases = [_case(study, loads, acting[s.peak.case], s, a) for s, a in with_fields]
    if surface.revolved:
        keep = _thinned(surface, np.all([c.excluded for c in cases], axis=0))
    else:
        keep = np.ones(len(surface.points), dtype=bool)
    unit = study.system.factor
    strength = material_of(study, study.table.pin[task.pin.name].material).yield_strength
    return Surface(
        pin=task.pin.name,
        points=surface.points[keep] / unit("length"),
        triangles=surface.triangles,
        n=surface.n,
        even=surface.even,
        stress=surface.stress[keep] / unit("stress"),
        displacement=surface.displacement[keep] / unit("length"),
        yield_strength=None if strength is None else strength / unit("stress"),
        cases=tuple(_kept(c, keep) for c in cases),
    )


def _case(
    study: Study,
    loads: dict[str, CaseLoads],
    acting: PinLoads,
    solution: Solution,
    answer: Answer,
) -> SurfaceCase:
    peak, stress = solution.peak, study.system.factor("stress")
    return SurfaceCase(
        case=peak.case,
        times=loads[peak.case].reactions.times,
        instant=peak.instant,
        amounts=amounts(answer, acting),
        maxima=answer.maxima(acting) / stress,
        excluded=excluded(answer),
        largest=largest_there(answer, acting, peak.instant) / stress,
    )


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
    return replace(case, excluded=case.excluded[keep], largest=case.largest[keep])

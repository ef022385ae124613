"""Surfaces of a pin as reports show them, from its solutions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan2

import numpy as np

from fea.beam.model import BeamField
from fea.core.pin_loads import Floats, PinLoads
from fea.core.solution import StressField
from fea.core.zone import Zone
from fea.harmonic.evaluate import HarmonicField
from fea.harmonic.half_section import MeridianPlane
from fea.solve.surface_fields import (
    amounts,
    excluded,
    largest_at,
    largest_there,
    unit_surface,
    unread,
)
from fea.support.cell_pressure import CellPressure
from fea.support.support import Solution
from pinbase.arrays import Ints
from pinstress.analysis.gather.gather_section import half_section
from pinstress.analysis.gather_fields import at_samples
from pinstress.analysis.thinning import fewer_loads, meridian_points
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.tasks import Task
from reports.data.surface import SURFACE_SECTORS, LoadCourse, Mask, Surface, SurfaceCase


def surfaces_of(
    loads: dict[str, CaseLoads],
    task: Task,
    solutions: Sequence[Solution],
    pressures: Sequence[CellPressure | None],
) -> tuple[Surface, ...]:
    """Return a pin's surfaces, one for each mesh, with all cases that a model with fields solved.

    pressures: contact pressure of the lugs, by solution.
    """
    together: dict[int, list[tuple[Solution, CellPressure | None]]] = {}
    for solution, pressure in zip(solutions, pressures, strict=True):
        mesh_id = id(_unit_fields(solution.answer))
        together.setdefault(mesh_id, []).append((solution, pressure))
    surfaces = (_surface(loads, task, group) for group in together.values())
    return tuple(surface for surface in surfaces if surface is not None)


def _unit_fields(answer: StressField | None) -> object:
    """Return the object that answers from one mesh share."""
    if isinstance(answer, HarmonicField):
        return answer.fields
    if answer is None or isinstance(answer, BeamField):
        return None
    from fea.cut.evaluate import CutField
    from fea.solid.evaluate import SolidField

    if isinstance(answer, CutField):
        return answer.solution
    return answer.solution.fields if isinstance(answer, SolidField) else None


def _surface(
    loads: dict[str, CaseLoads],
    task: Task,
    solved: Sequence[tuple[Solution, CellPressure | None]],
) -> Surface | None:
    """Return the surface of the cases solved on one mesh; None where no model has fields."""
    answers = [(s, s.answer, p) for s, p in solved if s.answer is not None]
    with_fields = [(s, a, p) for s, a, p in answers if unit_surface(a) is not None]
    if not with_fields:
        return None
    surface = unit_surface(with_fields[0][1])
    assert surface is not None
    plane = _plane(with_fields[0][1])
    cases = [
        _pressed(_case(loads[s.peak.case], task, s, plane), surface.points, p)
        for s, _, p in with_fields
    ]
    keep = np.ones(len(surface.points), dtype=bool)
    if surface.revolved:
        required = np.any(
            [_own(c, s, surface.points) for c, (s, _, _) in zip(cases, with_fields, strict=True)],
            axis=0,
        )
        surface, cases = fewer_loads(surface, cases)
        keep = meridian_points(surface, cases, required)
        cases = [
            replace(c, unread=_unread(loads[c.case], s, np.flatnonzero(keep), c.location))
            for c, (s, _, _) in zip(cases, with_fields, strict=True)
        ]
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


def _plane(answer: StressField) -> MeridianPlane | None:
    if not isinstance(answer, HarmonicField):
        return None
    return MeridianPlane(answer.fields, answer.singularities)


def _case(
    case: CaseLoads, task: Task, solution: Solution, plane: MeridianPlane | None
) -> SurfaceCase:
    """Return a case's fields at its samples and the governing instant."""
    shown, answer = at_samples(solution, case), solution.answer
    assert answer is not None
    maxima = answer.maxima(shown.loads)
    top, at = float(maxima[shown.instant]), largest_at(answer, shown.loads, shown.instant)
    return SurfaceCase(
        case=solution.peak.case,
        times=shown.loads.times,
        instant=shown.instant,
        amounts=amounts(answer, shown.loads),
        maxima=maxima,
        excluded=excluded(answer),
        largest=largest_there(answer, shown.loads, shown.instant),
        zones=_zones(answer),
        loads=_courses(task, shown.loads),
        section=half_section(plane, shown.loads, shown.instant, top, at) if plane and at else None,
        location=at,
    )


def _unread(
    case: CaseLoads, solution: Solution, points: Ints, at: tuple[float, ...] | None
) -> Mask | None:
    """Return where points (J,) of a meridian are not read, by instant and by angle from a
    location.
    """
    assert solution.answer is not None
    start = 0.0 if at is None else atan2(at[1], at[0])
    turns = start + 2.0 * np.pi * np.arange(SURFACE_SECTORS) / SURFACE_SECTORS
    return unread(solution.answer, at_samples(solution, case).loads, points, turns)


def _zones(answer: StressField) -> Floats:
    singularities: tuple[Zone, ...] = ()
    if isinstance(answer, HarmonicField):
        singularities = answer.singularities
    else:
        from fea.cut.evaluate import CutField

        if isinstance(answer, CutField):
            singularities = answer.singularities
    return np.array([(p.r, p.z, p.radius) for p in singularities]).reshape(-1, 3)


def _courses(task: Task, loads: PinLoads) -> tuple[LoadCourse, ...]:
    """Return the load courses of every band on which a link bears."""
    links = loads.links
    none = np.zeros((len(loads), 3))
    acting = {name: links.forces[:, c] for c, name in enumerate(links.surfaces)}
    acting |= {name: none for name in task.left_out[loads.case] if name not in acting}
    bands = {name: task.pin.band(name) for name in acting}
    return tuple(
        LoadCourse(name, band.middle, band.radius, acting[name], name not in links.surfaces)
        for name, band in bands.items()
    )


def _pressed(case: SurfaceCase, points: Floats, pressure: CellPressure | None) -> SurfaceCase:
    if pressure is None:
        return case
    rings = pressure.rings(points)
    return replace(case, rings=rings, pressure=pressure.pressure, first=pressure.angle)


def _own(case: SurfaceCase, solution: Solution, points: Floats) -> Mask:
    """Return the points (P,) of a meridian that the case needs.

    These are the point of its maximum, if that is on the surface, and those where contact pressure
    jumps.
    """
    required = np.zeros(len(points), dtype=bool)
    if case.rings is not None:
        jumps = np.flatnonzero(np.diff(case.rings))
        required[jumps] = required[jumps + 1] = True
    if case.location is not None:
        x, y, z = case.location
        away = np.hypot(points[:, 0] - np.hypot(x, y), points[:, 2] - z)
        required |= away <= away.min() * (1.0 + 1e-9)
    return required


def _kept(case: SurfaceCase, keep: Mask) -> SurfaceCase:
    rings = None if case.rings is None else case.rings[keep]
    return replace(case, excluded=case.excluded[keep], largest=case.largest[keep], rings=rings)

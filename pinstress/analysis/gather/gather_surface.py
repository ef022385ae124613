"""Surfaces of a pin, as reports show them, from its solutions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.core.unit_surface import SectionPlane, SurfaceField
from fea.support.cell_pressure import CellPressure
from fea.support.support import Solution
from pinbase.arrays import Ints
from pinstress.analysis.gather.gather_section import half_section
from pinstress.analysis.gather_fields import at_samples
from pinstress.analysis.thinning import by_instants, fewer_loads, meridian_points
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.tasks import Task
from reports.data.surface import SURFACE_SECTORS, LoadCourse, Mask, Surface, SurfaceCase


def surfaces_of(
    loads: dict[str, CaseLoads],
    task: Task,
    solutions: Sequence[Solution],
    pressures: Sequence[CellPressure | None],
) -> tuple[Surface, ...]:
    """Return a pin's surfaces, one for each mesh, with all cases that were solved on it by a model
    with fields.

    pressures: contact pressure of the lugs, for each solution.
    """
    together: dict[int, list[_Shown]] = {}
    for solution, pressure in zip(solutions, pressures, strict=True):
        field = None if solution.answer is None else solution.answer.surface()
        if field is not None:
            shown = _Shown(at_samples(solution, loads[solution.peak.case]), field, pressure)
            together.setdefault(id(field.unit), []).append(shown)
    return tuple(_surface(task, group) for group in together.values())


@dataclass(frozen=True)
class _Shown:
    """A case on its surface.

    solution: with loads at the samples. pressure: contact pressure of the lugs.
    """

    solution: Solution
    field: SurfaceField
    pressure: CellPressure | None


def _surface(task: Task, solved: Sequence[_Shown]) -> Surface:
    """Return the surface of the cases solved on one mesh."""
    surface, plane = solved[0].field.unit, solved[0].field.plane
    cases = [_pressed(_case(task, s, plane), surface.points, s.pressure) for s in solved]
    keep = np.ones(len(surface.points), dtype=bool)
    if surface.revolved:
        required = np.any([_own(c, surface.points) for c in cases], axis=0)
        surface, cases = fewer_loads(surface, cases)
        keep = meridian_points(surface, cases, required)
        cases = [
            replace(c, unread=_unread(s, np.flatnonzero(keep), c.location))
            for c, s in zip(cases, solved, strict=True)
        ]
    else:
        surface, cases = by_instants(surface, cases)
    return Surface(
        pin=task.pin.name,
        points=surface.points[keep],
        triangles=surface.triangles,
        n=surface.n,
        even=surface.even,
        stress=surface.stress[keep],
        displacement=surface.displacement[keep],
        yield_strength=None if task.material.hardened else task.material.yield_strength,
        cases=tuple(_kept(c, keep) for c in cases),
    )


def _case(task: Task, of: _Shown, plane: SectionPlane | None) -> SurfaceCase:
    """Return a case's fields at its samples and at the governing instant."""
    loads, instant, field = of.solution.loads, of.solution.instant, of.field
    assert of.solution.answer is not None
    maxima = of.solution.answer.maxima(loads)
    top, at = float(maxima[instant]), field.location(loads, instant)
    return SurfaceCase(
        case=of.solution.peak.case,
        times=loads.times,
        instant=instant,
        amounts=field.amounts(loads),
        maxima=maxima,
        excluded=field.excluded,
        largest=field.largest(loads, instant),
        zones=np.array([(p.r, p.z, p.radius) for p in field.zones]).reshape(-1, 3),
        loads=_courses(task, loads),
        section=half_section(plane, loads, instant, top, at) if plane and at else None,
        location=at,
    )


def _unread(of: _Shown, points: Ints, at: tuple[float, ...] | None) -> Mask | None:
    """Return where the stress at points (J,) of a meridian is not read, by instant and by angle.

    at: the point from whose angle the angles count; from 0 without one.
    """
    start = 0.0 if at is None else atan2(at[1], at[0])
    turns = start + 2.0 * np.pi * np.arange(SURFACE_SECTORS) / SURFACE_SECTORS
    return of.field.unread(of.solution.loads, points, turns)


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


def _own(case: SurfaceCase, points: Floats) -> Mask:
    """Return the points (P,) of a meridian that the case needs.

    These are the point of the case's maximum, if that is on the surface, and points where the
    contact pressure jumps.
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

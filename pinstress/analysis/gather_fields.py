"""Stress fields of pins, as reports show them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.solution import Picture, StressField
from fea.core.voigt import von_mises
from fea.support.cell_pressure import CellPressure
from fea.support.support import Solution
from pinbase.arrays import Floats
from pinstress.analysis.plan import ExtraFields
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.tasks import Task
from reports.data.fields import BandLoad, Field, Still, Volume

MAX_STILLS = 50  # instants of a motion, besides the governing one
MIN_DEPTH = 1e-3  # relative to the radius: points that are less deep belong to the surface


def field(
    task: Task,
    solution: Solution,
    case: CaseLoads,
    also: ExtraFields = None,
    pressure: CellPressure | None = None,
) -> Field | None:
    """Return a pin's field at its governing instant; None if it is not solved, or the model has no
    field.

    also: adds the other instants, at most MAX_STILLS of them, or the whole volume of the pin.
    pressure: contact pressure of the lugs on the pin.
    """
    peak = solution.peak
    solution = at_samples(solution, case)
    loads, governing = solution.loads, solution.instant
    shown = solution.answer.picture(loads, governing) if solution.answer else None
    if solution.answer is None or shown is None:
        return None
    times, contact = loads.times, pressure.at(shown.points) if pressure else None
    pressed = shown.pressed
    if pressed is None and contact is not None:  # a pin with cuts
        pressed = contact > 0.0
    return Field(
        pin=peak.pin,
        case=peak.case,
        points=shown.points,
        cells=shown.cells,
        displacement=shown.displacement,
        stress=shown.stress,
        von_mises=von_mises(shown.stress),
        envelope=shown.envelope,
        cell_type=shown.cell_type,
        yield_strength=None if task.material.hardened else task.material.yield_strength,
        outside=_outside(peak),
        beneath=_beneath(task, peak, shown),
        verdict=peak.verdict,
        time=None if times is None else float(times[governing]),
        loads=_bands(task, loads, governing),
        stills=()
        if times is None or also != "motion"
        else tuple(
            _still(task, solution.answer, loads, i, float(times[i]))
            for i in instants(len(loads), governing)
        ),
        volume=_volume(task, solution, shown.points, pressure) if also == "solid" else None,
        contact_pressure=contact,
        pressed=pressed,
        solids=peak.solids,
    )


def _volume(
    task: Task, solution: Solution, surface: Floats, pressure: CellPressure | None
) -> Volume | None:
    """Return the whole volume of a pin; None for a solid model, whose field includes it already.

    surface: (P, 3) m, points of the surface.
    """
    assert solution.answer is not None
    shown = solution.answer.volume(solution.loads, solution.instant)
    if shown is None:
        return None
    held = solution.held if solution.pressure is not None else None
    profile = (held.pin if held else task.pin).profile
    if profile is not None:
        # Imported here, so that results from the cache load no solver.
        from fea.section.section_stress import SectionField
        from pinstress.analysis.balance import balanced

        clamps = () if task.lugs else tuple(task.pin.surface(name) for name in task.clamps)
        loads = solution.loads.on_rings
        sections = SectionField(profile, task.material, clamps, (loads,))
        shown = balanced(shown, profile, surface, sections.forces_on(loads, solution.instant))
    pressed = shown.pressed
    if pressed is None and pressure is not None:  # a pin with cuts
        pressed = pressure.at(shown.points) > 0.0
    return Volume(
        shown.points,
        shown.cells,
        shown.cell_type,
        shown.displacement,
        shown.stress,
        von_mises(shown.stress),
        pressed,
        dict(shown.more),
    )


def instants(count: int, governing: int) -> list[int]:
    """Return at most MAX_STILLS of `count` instants, evenly spaced, and the governing instant."""
    even = np.linspace(0, count - 1, min(count, MAX_STILLS)).round().astype(int)
    return sorted({*even.tolist(), governing})


def at_samples(solution: Solution, case: CaseLoads) -> Solution:
    """Return a solution with its loads at the samples of the case and at the governing instant
    only.
    """
    if solution.loads.times is None or case.reactions.times is None:
        return solution
    samples = np.flatnonzero(np.isin(solution.loads.times, case.reactions.times))
    shown = np.union1d(samples, [solution.instant])
    instant = int(np.searchsorted(shown, solution.instant))
    return replace(solution, loads=solution.loads.at(shown), instant=instant)


def _still(task: Task, answer: StressField, loads: PinLoads, instant: int, time: float) -> Still:
    # With the loads of one instant, the envelope is of this instant only.
    shown = answer.picture(loads.at(np.array([instant])), 0)
    assert shown is not None
    return Still(
        time,
        shown.displacement.astype(np.float32),
        von_mises(shown.stress).astype(np.float32),
        _bands(task, loads, instant),
        shown.pressed,
    )


def _bands(task: Task, loads: PinLoads, instant: int) -> tuple[BandLoad, ...]:
    """Return every band on which a link bears; held bands carry no load here."""
    out, loads = [], loads.links
    for name in (*loads.surfaces, *task.left_out[loads.case]):
        band, held = task.pin.band(name), name not in loads.surfaces
        force, moment = np.zeros(3), np.zeros(3)
        if not held:
            c = loads.surfaces.index(name)
            force = loads.forces[instant, c]
            moment = loads.moments[instant, c]
        ends = (band.z0, band.z1)
        radius = band.radius
        out.append(BandLoad(name, ends, radius, force, moment, held))
    return tuple(out)


def _outside(peak: Maximum) -> tuple[float, tuple[float, float, float]] | None:
    """Return the largest stress of the surface outside singularities and lug contact, and its
    position.

    The value is returned whether or not the singularities govern.
    """
    places = peak.places
    if places is not None and places.contact is not None:
        return places.surface.max_von_mises, places.surface.location
    if not peak.singular_at or peak.max_von_mises is None or peak.location is None:
        return None
    return peak.max_von_mises, peak.location


def _beneath(
    task: Task, peak: Maximum, shown: Picture
) -> tuple[float, tuple[float, float, float]] | None:
    """Return the row's stress and its position, if that is inside the pin and only the surface is
    shown.
    """
    profile, place = task.pin.profile, peak.location
    if shown.cell_type == "tetra10" or profile is None or peak.max_von_mises is None or not place:
        return None
    r, z = math.hypot(*place[:2]), place[2]
    bore, outer = profile.radii(z)
    if r > (1.0 - MIN_DEPTH) * outer or (bore and r < (1.0 + MIN_DEPTH) * bore):
        return None
    # Walls of cuts and faces of steps are surface, too. A maximum there coincides with a point of
    # the surface except for its angle.
    x, y, at = shown.points.T
    on_surface = np.hypot(np.hypot(x, y) - r, at - z).min() < MIN_DEPTH * outer
    return None if on_surface else (peak.max_von_mises, place)

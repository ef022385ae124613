"""Results of a pin over the ranges of its landing's impulse, and over the stiffness of links."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.harmonic.field import HarmonicField
from fea.harmonic.part_field import PartField
from fea.section.section_stress import SectionField
from fea.support.support import Solution
from geometry import body_of_revolution
from pinbase.dimensions import Floats
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.impulses import ImpulseLoads
from pinstress.study.model.tasks import Task
from reports.data.row import LandingRange, SharingRange

# Relative to the largest force on a pin: smaller forces are left out of ratios of forces.
NEGLIGIBLE_LOAD = 0.01


def landing_range(
    loads: Mapping[str, CaseLoads], task: Task, solution: Solution
) -> LandingRange | None:
    """Return a pin's results over the ranges of its landing's impulse, by superposition."""
    case, over = solution.peak.case, loads[solution.peak.case].range
    if over is None or solution.answer is None:
        return None
    maxima = _maxima(task, solution, task.ranges[case])
    strength = solution.peak.yield_strength(task.material.yield_strength)
    nominal = range_of(task, solution.peak, over, maxima, strength)
    return replace(nominal, spread=_spread(solution.peak))


def _largest_load(task: Task, peak: Maximum, ranged: PinLoads, maxima: Floats) -> float:
    """Return the largest ratio by which a demand on the pin grows over ranges of its loads.

    It is the largest ratio of the forces on a band, or that of the stress. The stress grows more
    than the forces where forces nearly cancel, and with the moments on bands. Bands with next to no
    load are left out, since their checks never govern.

    ranged: the loads over the ranges. maxima: the stress under each, Pa.
    """
    grown = max(float(maxima.max()) / peak.max_von_mises if peak.max_von_mises else 1.0, 1.0)
    nominal = next(x for x in task.loads if x.case == peak.case)
    over, own = (
        np.linalg.norm(x.forces, axis=-1).max(axis=0, initial=0.0) for x in (ranged, nominal)
    )
    if not (loaded := over > NEGLIGIBLE_LOAD * over.max(initial=0.0)).any():
        return grown
    least = NEGLIGIBLE_LOAD * over.max()  # a band may be loaded by the range alone
    return max(grown, float((over[loaded] / np.maximum(own[loaded], least)).max()))


def sharing_range(task: Task, solution: Solution) -> SharingRange | None:
    """Return the range of a pin's maximum over the stiffness of the links that share its loads out
    of the plane, by superposition. For each stiffness, the worst instant counts.
    """
    over, peak = task.shared.get(solution.peak.case), solution.peak.max_von_mises
    if over is None or solution.answer is None or peak is None:
        return None
    stress: dict[str, float] = {}
    maxima = _maxima(task, solution, over.loads)
    for what, value in zip(over.what, maxima.tolist(), strict=True):
        stress[what] = max(stress.get(what, 0.0), value)
    low, high = min(stress, key=stress.__getitem__), max(stress, key=stress.__getitem__)
    ends = min(peak, stress[low]), max(peak, stress[high])
    most = _largest_load(task, solution.peak, over.loads, maxima)
    return SharingRange(
        ends, low if stress[low] < peak else "", high if stress[high] > peak else "", most
    )


def range_of(
    task: Task, peak: Maximum, over: ImpulseLoads, maxima: Floats, strength: float | None
) -> LandingRange:
    """Return the results over a landing's ranges, without the spread over the joint.

    peak: the maximum under the nominal force.
    over: the forces over the ranges.
    maxima: the stress under each force of `over`, Pa.
    strength: the yield strength, Pa.
    """
    return LandingRange(
        pin=peak.pin,
        case=peak.case,
        impulse_time=over.times,
        velocity_change=over.velocities,
        pulses=over.pulses,
        force=over.forces,
        max_von_mises=maxima,
        safety_factor=None if strength is None else strength / maxima,
        nominal=over.nominal,
        nominal_pulse=over.nominal_pulse,
        verdict=peak.verdict,
        error=(peak.error_estimate or 0.0) / (peak.max_von_mises or 1.0),
        largest_load=_largest_load(task, peak, task.ranges[peak.case], maxima),
    )


def _maxima(task: Task, solution: Solution, loads: PinLoads) -> Floats:
    """Return the larger of the stresses of surface and section, Pa, at each instant of other loads
    of a case.
    """
    acting, clamps = solution.pressed(loads), tuple[str, ...]()
    if task.lugs:
        pin = solution.rings
    else:
        pin = body_of_revolution(task.pin)
        clamps = tuple(task.pin.surface(name) for name in task.clamps)
    assert solution.answer is not None
    surface, places = solution.answer.maxima(acting), solution.peak.places
    if places is None or places.section is None or pin is None:
        return surface
    sections = SectionField(pin, task.material, clamps, (acting.on_rings,))
    if task.material.hardened:
        return _as_of_row(task, solution, acting, sections)
    return np.maximum(surface, sections.maxima(acting.on_rings))


def _as_of_row(task: Task, solution: Solution, acting: PinLoads, sections: SectionField) -> Floats:
    """Return the largest stress of a hardened pin at each instant, Pa.

    The stress of each part is scaled as if the part had the strength of the row.
    """
    strength, answer = solution.peak.strength, solution.answer
    assert strength is not None
    assert isinstance(answer, HarmonicField)
    out = np.zeros(len(acting))
    for part in task.material.strength_parts(sections.pin.length):
        field, along = PartField(answer, sections.pin, part), sections.of_part(part)
        stress = np.maximum(field.maxima(acting), along.maxima(acting.on_rings))
        out = np.maximum(out, stress * (strength / part.strength))
    return out


def _spread(peak: Maximum) -> tuple[float, float] | None:
    if peak.interval is None or not peak.max_von_mises:
        return None
    low, high = peak.interval
    return peak.max_von_mises / high, peak.max_von_mises / low if low > 0.0 else np.inf

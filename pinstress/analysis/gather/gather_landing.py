"""Results of a pin over the ranges of its landing's impulse, and over the stiffness of links."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.places import PartPlace, SectionPlace, SurfacePlace
from fea.cut.field import CutField
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


@dataclass(frozen=True)
class StressOverRange:
    """The stress of a pin at T instants of other loads of a case, (T,) Pa each.

    maxima: the larger of surface and section. upper_ends: the largest of them with their errors.
    beneath: contact, None without any.
    """

    maxima: Floats
    upper_ends: Floats
    beneath: Floats | None = None


def landing_range(
    loads: Mapping[str, CaseLoads], task: Task, solution: Solution
) -> LandingRange | None:
    """Return a pin's results over the ranges of its landing's impulse, by superposition."""
    case, over = solution.peak.case, loads[solution.peak.case].range
    if over is None or solution.answer is None:
        return None
    stress = _stresses(task, solution, task.ranges[case])
    strength = solution.peak.yield_strength(task.material.yield_strength)
    nominal = range_of(task, solution.peak, over, stress, strength)
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
    stresses = _stresses(task, solution, over.loads)
    stress, top = (_largest_by(over.what, x) for x in (stresses.maxima, stresses.upper_ends))
    low, high = min(stress, key=stress.__getitem__), max(top, key=top.__getitem__)
    ends = min(peak, stress[low]), max(peak, *stress.values())
    range_ = SharingRange(
        ends,
        low if stress[low] < peak else "",
        high if top[high] > solution.peak.upper_end else "",
        _largest_load(task, solution.peak, over.loads, stresses.maxima),
        top[high],
    )
    if stresses.beneath is None:
        return range_
    deep = _largest_by(over.what, stresses.beneath)
    deepest = max(deep, key=deep.__getitem__)
    return replace(range_, beneath=(deep[low], deep[deepest]), deepest=deepest)


def _largest_by(what: Sequence[str], stress: Floats) -> dict[str, float]:
    """Return the largest stress of each change of the links, Pa."""
    return {
        name: max(x for one, x in zip(what, stress.tolist(), strict=True) if one == name)
        for name in dict.fromkeys(what)
    }


def range_of(
    task: Task, peak: Maximum, over: ImpulseLoads, stress: StressOverRange, strength: float | None
) -> LandingRange:
    """Return the results over a landing's ranges, without the spread over the joint.

    peak: the maximum under the nominal force.
    over: the forces over the ranges.
    stress: the stress under each force of `over`.
    strength: the yield strength, Pa.
    """
    maxima = stress.maxima
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
        error=stress.upper_ends / np.where(maxima > 0.0, maxima, 1.0) - 1.0,
        largest_load=_largest_load(task, peak, task.ranges[peak.case], maxima),
        beneath=stress.beneath,
    )


def _stresses(task: Task, solution: Solution, loads: PinLoads) -> StressOverRange:
    """Return the stress at each instant of other loads of a case."""
    acting, clamps = solution.pressed(loads), tuple[str, ...]()
    if task.lugs:
        pin = solution.rings
    else:
        pin = body_of_revolution(task.pin)
        clamps = tuple(task.pin.surface(name) for name in task.clamps)
    peak, answer = solution.peak, solution.answer
    assert answer is not None
    surface, places = answer.maxima(acting), peak.places
    row, deep = peak.upper_end / (peak.max_von_mises or 1.0), None
    if places is not None and places.contact is not None and not task.material.hardened:
        assert isinstance(answer, HarmonicField | CutField)
        deep = answer.maxima_beneath(acting)
    if places is None or places.section is None or pin is None:
        return StressOverRange(surface, row * surface, deep)
    sections = SectionField(pin, task.material, clamps, (acting.on_rings,))
    if task.material.hardened:
        return _as_of_row(task, solution, acting, sections)
    in_section = sections.maxima(acting.on_rings)
    maxima = np.maximum(surface, in_section)
    ends = [_over(places.surface) * surface, _over(places.section) * in_section, row * maxima]
    return StressOverRange(maxima, np.max(ends, axis=0), deep)


def _over(place: SurfacePlace | SectionPlace | PartPlace) -> float:
    """Return the stress of a place with its error over the stress."""
    return 1.0 + place.error_estimate / (place.max_von_mises or 1.0)


def _as_of_row(
    task: Task, solution: Solution, acting: PinLoads, sections: SectionField
) -> StressOverRange:
    """Return the largest stress of a hardened pin at each instant.

    The stress of each part is scaled as if the part had the strength of the row.
    """
    peak, answer, pin = solution.peak, solution.answer, sections.pin
    assert peak.strength is not None
    assert peak.places is not None
    assert isinstance(answer, HarmonicField)
    maxima, deep = np.zeros(len(acting)), np.zeros(len(acting))
    for part in task.material.strength_parts(pin.length):
        scale = peak.strength / part.strength
        field, along = PartField(answer, pin, part), sections.of_part(part)
        stress = np.maximum(field.maxima(acting), along.maxima(acting.on_rings))
        maxima = np.maximum(maxima, scale * stress)
        if part.part != "case" and peak.places.contact is not None:
            beneath = PartField(answer, pin, part, "beneath").maxima(acting)
            deep = np.maximum(deep, scale * beneath)
    row = peak.upper_end / (peak.max_von_mises or 1.0)
    most = max(row, *map(_over, peak.places.hardened))
    return StressOverRange(maxima, most * maxima, deep if peak.places.contact else None)


def _spread(peak: Maximum) -> tuple[float, float] | None:
    if peak.interval is None or not peak.max_von_mises:
        return None
    low, high = peak.interval
    return peak.max_von_mises / high, peak.max_von_mises / low if low > 0.0 else np.inf

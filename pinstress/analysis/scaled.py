"""Rows of a changed study, scaled from the rows of the study as it is.

Both studies, as it is and as changed, are solved once more on one coarse mesh with rough contact
cells (fea.support.contact.unit_pressures). The two coarse solutions have nearly the same relative
error. So their ratio, place by place, times the row that was solved in full gives the row of the
changed study. This is exact where the change only multiplies all loads of a joint without gaps.
Otherwise the two relative errors may differ; a share of the first one (BIAS_SHARE) covers that.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from assess.judgement import BELOW_YIELD, SAFE
from fea.core.material import Material
from fea.core.peak import ErrorParts, Maximum
from fea.core.places import BandPressure, ContactPlace, Place, Places
from fea.core.requirement import MAX_ROUGH_ERROR, Requirement
from fea.support.contact.contact_place import reached
from fea.support.lugs.lug import LugRange
from fea.support.records import FRICTION, JointResult, Variation, range_ends
from geometry import Pin
from pinbase.arrays import Floats
from pinstress.analysis.gather.gather_landing import StressOverRange, range_of
from pinstress.study.model.impulses import ImpulseLoads
from pinstress.study.model.tasks import Task
from reports.data.row import LandingRange, PinResult
from reports.data.unknowns import least_factor

# Relative: if the ratios of all places agree to this, the change scales all loads by one factor.
PROPORTIONAL_TOLERANCE = 1e-7
# The relative error of the ratio of two coarse solutions, as a share of the relative error of the
# first one, and at least. Tuned on `python -m benchmarks edits`.
BIAS_SHARE, MIN_RATIO_ERROR = 0.5, 0.02
# Where gaps open or arcs narrow, the ratios differ between places: by 1 to 20 % where all of them
# are right within 2 %, by 50 to 80 % where surface stresses on rough cells are wrong by 3 to 50 %.
# The error of a ratio as a share of this spread, and the spread beyond which rows are solved in
# full. Tuned on pin P of studies/clevis.toml and H of landing_gear.toml with clearances of 0 to 2 %
# and loads down to 1 %.
SPREAD_SHARE, MAX_SPREAD = 0.15, 0.4
# Half of a contact arc, degrees: more than one and a half of the rough cells
# (fea.support.contact.resolution.ROUGH). On narrower arcs stress is wrong by up to 50 %, and just
# as wrong on the larger cells that serve to estimate the error.
MIN_HALF_ARC = 25.0
# Relative: a decrease of stress up to which contact arcs keep their width. Chosen by judgement.
MIN_FALL = 0.01
# The factor by which the upper end of a scaled range may be too low: 1.7 was measured, by halving a
# load (tests/pinstress/analysis/test_scaled.py), and 1.3 in other shapes of studies/clevis.toml.
MAX_WIDENING = 2.0
NOMINAL_STRENGTH = 1e9  # Pa: the yield strength in solutions that serve for any strength
CLEARANCE_DIGITS = 12  # decimals to which clearances in metres are compared
SCALED_CODE = "scaled"
RANGE_REMARK = "the range is that of the joint as the study has it"


def scalable(task: Task) -> bool:
    """Return whether rows of a task may be scaled: its pin is in lugs and has no cuts."""
    return bool(task.lugs) and isinstance(task.pin, Pin)


def coarse(requirement: Requirement, lasting: bool, varied: bool) -> Requirement:
    """Return the requirement on the coarse solutions whose ratio is taken.

    lasting: whether the shape is to be solved again under other loads.
    varied: whether the range over the joint is needed, too.
    """
    cells: Literal["unit", "alone"] = "unit" if lasting else "alone"
    return replace(requirement, cells=cells, meshes=1, goal="value", required=None, varied=varied)


def same_shape(one: Task, other: Task) -> bool:
    """Return whether two tasks differ at most in loads, clearances, tilts and ranges, and in
    strengths and names of materials.
    """
    return _shape(one) == _shape(other)


def same_ranges(one: Task, other: Task) -> bool:
    """Return whether two tasks have the same uncertain parameters of their joints, so that the
    range of one task may be scaled with its row to the other.
    """
    return _uncertain_parameters(one) == _uncertain_parameters(other)


def range_may_widen(before: PinResult, row: PinResult, same_shape: bool) -> bool:
    """Return whether a scaled row is safe, but its true range over the joint might not be.

    Pins and lugs of other dimensions or materials have other ranges. Under smaller loads lugs press
    on narrower arcs, over which stress changes more with the clearance.
    """
    if row.joint is None or row.joint.range is None or row.outcome not in (SAFE, BELOW_YIELD):
        return False
    fallen = (row.max_von_mises or 0.0) < (1.0 - MIN_FALL) * (before.max_von_mises or 0.0)
    if same_shape and not fallen:
        return False
    return least_factor(row) < MAX_WIDENING * (row.required or 1.0)


def _uncertain_parameters(task: Task) -> object:
    """Return what the range over the joint follows from: the stated ranges and the friction of the
    lugs, and the clearances as given and at the temperature of the case, from which a range that is
    not stated is derived.
    """

    def rounded(lengths: tuple[float, ...] | None) -> tuple[float, ...] | None:
        return lengths and tuple(round(x, CLEARANCE_DIGITS) for x in lengths)

    return [
        (
            replace(lug.range, clearance=None),
            rounded(lug.range.clearance),
            rounded((lug.clearance, lug.growth)),
            lug.friction,
        )
        for lug in task.lugs
    ]


def _shape(task: Task) -> object:
    task = elastic_task(task)
    eyes = [replace(x, clearance=0.0, growth=0.0, tilt=0.0, range=LugRange()) for x in task.lugs]
    return task.pin, task.material, eyes


def elastic_task(task: Task) -> Task:
    """Return a task whose coarse solution serves for any strengths and names of its materials, and
    for any ranges of its loads.
    """
    lugs, given = (tuple(x.with_materials(_elastic) for x in of) for of in (task.lugs, task.given))
    task = replace(task, material=_elastic(task.material), lugs=lugs, given=given)
    return replace(task, ranges={}, impulses={}, shared={})


def _elastic(material: Material) -> Material:
    return replace(material.elastic_part, yield_strength=NOMINAL_STRENGTH)


def scaled_row(
    row: PinResult,
    before: PinResult,
    now: PinResult,
    task: Task,
    requirement: Requirement,
    over: ImpulseLoads | None = None,
) -> PinResult | None:
    """Return the row of a changed study, not yet assessed, or None if it cannot be scaled.

    row: of the study as it is, solved in full.
    before, now: coarse rows, of the study as it is and of the changed study.
    task, requirement: of the changed study.
    over: the forces over the range of the landing's impulse in the changed study, if any.
    """
    parts = [_comparable(x) for x in (row, before, now)]
    first, coarse_first, coarse_now = parts
    # The range over the stiffness of links is not proportional to the stress.
    if first is None or coarse_first is None or coarse_now is None or task.shared:
        return None
    ratios = {name: coarse_now[name] / coarse_first[name] for name in coarse_now}
    spread = _spread(ratios)
    drift = dict.fromkeys(ratios, 0.0)
    if spread > PROPORTIONAL_TOLERANCE:
        bias = {name: abs(first[name] / coarse_first[name] - 1.0) for name in first}
        least = max(MIN_RATIO_ERROR, SPREAD_SHARE * spread)
        drift = {name: max(least, BIAS_SHARE * x) for name, x in bias.items()}
    places = _places(row, now, ratios, drift, task, requirement)
    peak = _peak(row.maximum, now.maximum, places, requirement.tolerance)
    assert peak.max_von_mises is not None
    joint = now.joint and _joint(row, now, peak, max(drift.values()))
    landing = None
    if row.landing is not None and over is not None:
        landing = _landing(row.landing, over, peak, task)
    return PinResult(peak, joint=joint, landing=landing)


def contact_changed(before: PinResult, now: PinResult) -> bool:
    """Return whether contact differs so much between two coarse rows that their ratio is
    unreliable.
    """
    parts = _comparable(before), _comparable(now)
    if parts[0] is None or parts[1] is None:
        return False
    spread = _spread({name: parts[1][name] / parts[0][name] for name in parts[0]})
    # On narrow arcs both are wrong, and by different parts unless the loads are proportional.
    return spread > MAX_SPREAD or (spread > PROPORTIONAL_TOLERANCE and narrow_arcs(now))


def _spread(ratios: dict[str, float]) -> float:
    return max(ratios.values()) / min(ratios.values()) - 1.0


def narrow_arcs(row: PinResult) -> bool:
    """Return whether a lug presses on an arc too narrow for rough cells."""
    bands = row.joint.bands if row.joint is not None and row.joint.model == "contact" else ()
    return any(0.0 < band.contact_angle < MIN_HALF_ARC for band in bands)


def too_rough(row: PinResult) -> bool:
    """Return whether rough cells cannot resolve the contact in a row that was solved on them: on
    narrow arcs, or at the edges of lugs in which the pin tilts.
    """
    if row.joint is None or row.joint.model != "contact" or row.places is None:
        return False
    surface = row.places.surface
    uneven = surface.error_estimate > MAX_ROUGH_ERROR * surface.max_von_mises
    return uneven or narrow_arcs(row)


def comparable(row: PinResult) -> bool:
    """Return whether a row has bounded stresses at all places, as contact gives them."""
    return _comparable(row) is not None


def _comparable(row: PinResult) -> dict[str, float] | None:
    """Return the stresses of a row by place, Pa, or None if one is missing or unbounded."""
    places = row.places
    if places is None or places.section is None or places.contact is None:
        return None
    stress = {
        "surface": places.surface.max_von_mises,
        "section": places.section.max_von_mises,
        "beneath": places.contact.beneath,
    }
    bounded = row.verdict in ("converged", "unconverged")
    return stress if bounded and min(stress.values()) > 0.0 else None


def _places(
    row: PinResult,
    now: PinResult,
    ratios: dict[str, float],
    drift: dict[str, float],
    task: Task,
    requirement: Requirement,
) -> Places:
    """Return the places of a row, scaled; position and instant of the largest stress come from
    `now`.

    ratios, drift: by place, the ratio of the coarse solutions and the relative error of the ratio.
    """
    assert row.places is not None
    assert now.places is not None
    full, rough = row.places, now.places
    assert full.section is not None
    assert rough.section is not None
    assert full.contact is not None
    assert rough.contact is not None

    def stress(name: str, value: float, error: float) -> tuple[float, float, str]:
        scaled, relative = value * ratios[name], error / value + drift[name]
        known = "converged" if relative <= requirement.tolerance else "unconverged"
        return scaled, relative * scaled, known

    a = stress("surface", full.surface.max_von_mises, full.surface.error_estimate)
    b = stress("section", full.section.max_von_mises, full.section.error_estimate)
    beneath, beneath_error, _ = stress("beneath", full.contact.beneath, full.contact.beneath_error)
    surface = replace(rough.surface, max_von_mises=a[0], error_estimate=a[1], verdict=a[2])
    section = replace(rough.section, max_von_mises=b[0], error_estimate=b[1], verdict=b[2])
    strength, used = task.material.yield_strength, rough.section.plastic_utilisation
    used = None if strength is None or used is None else used * NOMINAL_STRENGTH / strength
    section = replace(section, plastic_utilisation=used)
    depths = tuple((x * ratios["beneath"], depth) for x, depth in full.contact.depths)
    bands = tuple(_band(band, task) for band in rough.contact.bands)
    contact = replace(
        rough.contact, beneath=beneath, beneath_error=beneath_error, depths=depths, edges=(),
        bands=bands,
    )  # fmt: skip
    governs: Place = "section" if b[0] > a[0] else "surface"
    return Places(governs, surface, section, _with_reach(contact, task, requirement))


def _band(band: BandPressure, task: Task) -> BandPressure:
    """Return a band with its utilisation of the bearing strengths of a task's materials."""
    made_of = [task.material, *(x.bearing for x in task.lugs if x.connection == band.name)]
    known = [x.bearing_strength for x in made_of if x.bearing_strength]
    return replace(band, bearing_share=band.mean_pressure / min(known) if known else None)


def _with_reach(contact: ContactPlace, task: Task, requirement: Requirement) -> ContactPlace:
    depths = [contact.depth(x) for x in reached(task.material, requirement.required)]
    reach, required = (*depths, None, None)[:2]
    return replace(contact, reach=reach, reach_required=required)


def _peak(full: Maximum, now: Maximum, places: Places, tolerance: float) -> Maximum:
    """Return the maximum of the row: the larger of surface and section, with an error that covers
    both.
    """
    assert places.section is not None
    both = [(x.max_von_mises, x.error_estimate) for x in (places.surface, places.section)]
    value, own = max(both)
    error = max(own, max(x + e for x, e in both) - value)
    known = error <= tolerance * value
    text = f"scaled from the study as it is: estimated error {error / value:.1%}"
    return replace(
        now,
        verdict="converged" if known else "unconverged",
        note=text,
        max_von_mises=value,
        error_estimate=error,
        history=(),
        why=full.why,
        parts=ErrorParts(0.0, model=error),
        reasons=(SCALED_CODE, *full.reasons),
        places=places,
    )


def has_own_range(row: PinResult) -> bool:
    """Return whether the joint of a row was varied."""
    return (
        row.joint is not None and row.joint.range is not None and bool(row.joint.range.variations)
    )


def _joint(row: PinResult, now: PinResult, peak: Maximum, drift: float) -> JointResult:
    """Return the joint of a coarse solution with its range scaled to the maximum.

    A coarse solution without a range takes the range of `row`, of the study as it is.
    drift: the relative error of the ratios of the coarse solutions.
    """
    joint, source = now.joint, now if has_own_range(now) else row
    assert joint is not None
    if source.joint is None or source.joint.range is None:
        return joint
    largest = peak.max_von_mises or 0.0
    by, deep = largest / (source.max_von_mises or 1.0), _beneath(peak) / _beneath(source.maximum)
    drift, error = (drift, _error_taking_over(peak)) if source is now else (0.0, 0.0)

    def scaled(x: Variation) -> Variation:
        interval = x.interval
        if interval is None and error and x.what != FRICTION:
            interval = (1.0 - error) * x.max_von_mises, (1.0 + error) * x.max_von_mises
        if interval is not None:
            interval = by * (1.0 - drift) * interval[0], by * (1.0 + drift) * interval[1]
        beneath = None if x.beneath is None else x.beneath * deep * (1.0 + drift)
        return replace(x, max_von_mises=by * x.max_von_mises, interval=interval, beneath=beneath)

    variations = tuple(map(scaled, source.joint.range.variations))
    ends = range_ends(largest, variations)
    over = replace(source.joint.range, max_von_mises=ends, variations=variations)
    return replace(joint, range=over, remark=joint.remark if source is now else RANGE_REMARK)


def _error_taking_over(peak: Maximum) -> float:
    """Return the relative error of a surface stress that may exceed the governing section's over
    the range.

    The section itself has hardly any error. The value is 0 where the surface governs, whose row has
    the error.
    """
    places = peak.places
    if places is None or places.governs != "section":
        return 0.0
    return places.surface.error_estimate / places.surface.max_von_mises


def _beneath(peak: Maximum) -> float:
    """Return the stress beneath contact, Pa."""
    assert peak.places is not None
    assert peak.places.contact is not None
    return peak.places.contact.beneath


def _landing(full: LandingRange, over: ImpulseLoads, peak: Maximum, task: Task) -> LandingRange:
    """Return the results over a landing's ranges.

    Each stress per force of the study as it is, interpolated over the force, is multiplied by a
    factor that gives that of the row at the nominal force (pinstress.analysis.landing_scales).
    """
    order = np.argsort(full.force)

    def scaled(stress: Floats, nominal: float) -> Floats:
        force, per_force = full.force[order], (stress / full.force)[order]
        here = np.append(over.forces, over.nominal_force)
        at = here * np.interp(here, force, per_force)
        return np.asarray(at[:-1] * (nominal / at[-1]))

    assert peak.max_von_mises is not None
    maxima = scaled(full.max_von_mises, peak.max_von_mises)
    upper_ends = scaled((1.0 + full.error) * full.max_von_mises, peak.upper_end)
    deep = None if full.beneath is None else scaled(full.beneath, _beneath(peak))
    row = peak.upper_end / peak.max_von_mises
    stress = StressOverRange(maxima, np.maximum(upper_ends, row * maxima), deep)
    return range_of(task, peak, over, stress, task.material.yield_strength)

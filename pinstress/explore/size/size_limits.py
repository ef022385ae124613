"""The largest size that [size] of a study allows a pin, and what would suffice if that is too
small.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from fea.core.peak import Maximum
from pinbase.rounding import rounded_down, rounded_up
from pinstress.explore.size.pin_answers import SizedStudy
from pinstress.explore.size.scaled_study import hole_in_eye, rounded, unit_of_diameter
from pinstress.explore.size.section_law import PinTrial
from pinstress.study.model.lugs import EYE_DIAMETER_RATIO
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.reading.file import Study
from reports.format.numbers import beside_limit, engineering, short

MAX_SHEAR_PLANES = 12  # largest number of shear planes in a proposed arrangement
MAX_WIDENING = 4.0  # largest proposed width of a lug over its present width
ENDLESS = math.inf


@dataclass(frozen=True)
class SizeLimit:
    """The largest scale of a pin. reason: the key that sets it, with its value."""

    scale: float = ENDLESS
    reason: str = ""


def largest_scale(pin: SizedStudy) -> SizeLimit:
    """Return the largest scale that [size] allows a pin."""
    return min(_limits(pin), key=lambda limit: limit.scale, default=SizeLimit())


def _limits(sized: SizedStudy) -> Iterator[SizeLimit]:
    study, name = sized.plan.study, sized.pin
    allowed, table = study.table.size, study.table.pin[name]
    largest = max(table.diameters)
    if allowed.largest_diameter is not None:
        text = f"largest_diameter = {_length(study, allowed.largest_diameter)}"
        yield SizeLimit(_down(sized, allowed.largest_diameter, largest) / largest, text)
    if sized.standard is not None and sized.standard.listed:
        yield SizeLimit(sized.standard.listed[-1] / largest, "series, the last of its list")
    for at, band in _bands(study, name).items():
        lug = table.lug.get(at)
        ring = hole_in_eye(study, name, at) - band if lug else 0.0
        outer = lug.outer_diameter if lug else None
        ratio = allowed.eye_ratio if lug is None else EYE_DIAMETER_RATIO
        if outer is not None:
            ratio = min(allowed.eye_ratio, outer / (band + ring))
        eyes = {}
        if allowed.room is not None:
            eyes[f"room = {_length(study, allowed.room)}"] = allowed.room
        if outer is not None and not allowed.scale_lugs:
            eyes[f"scale_lugs = false, with the eye {at} of {_length(study, outer)}"] = outer
        for text, eye in eyes.items():
            yield SizeLimit(_down(sized, eye / ratio - ring, band) / band, text)


def _bands(study: Study, name: str) -> dict[str, float]:
    """Return the diameters, m, of the bands in eyes."""
    shape = pin_of(study, name)
    names = dict.fromkeys((*shape.connections, *study.table.pin[name].lug))
    return {at: 2.0 * shape.band(at).radius for at in names}


def _down(sized: SizedStudy, diameter: float, now: float) -> float:
    """Return the largest diameter, m, that can be written and is at most the given one; 0 if there
    is none.

    now: the present diameter of the pin, m; the new one is written in the same unit.
    """
    unit = unit_of_diameter(sized.plan.study, sized.pin, now)
    if diameter <= 0.0:
        return 0.0
    if sized.standard is not None:
        return sized.standard.down(diameter, unit)
    return rounded(diameter / unit, None, -1) * unit


def _length(study: Study, length: float) -> str:
    return f"{short(length / study.system.factor('length'))} {study.system.length}"


def too_small(sized: SizedStudy, limit: SizeLimit, trial: PinTrial, worst: Maximum) -> str:
    """Return a text that explains why a pin does not reach its factor within a limit, and what
    would suffice instead.

    trial: the trial at the limit. worst: its governing maximum.
    """
    study, required = sized.plan.study, sized.required
    diameters = [limit.scale * d for d in study.table.pin[sized.pin].diameters]
    about = "" if trial.accuracy == "full" else "about "
    text = (
        f"[size] {limit.reason} limits it to {_length(study, max(diameters))} across, where its "
        f"factor is {about}{beside_limit(trial.factor, required, 4)} instead of {short(required)}"
    )
    return f"{text}; instead, one of: {'; '.join(_instead(sized, limit, trial, worst))}"


def _instead(sized: SizedStudy, limit: SizeLimit, trial: PinTrial, worst: Maximum) -> Iterator[str]:
    """Yield the changes that would reach the factor at the limit, each one by itself.

    Stress is proportional to the loads, and to 1 / time of an impulse. With n shear planes instead
    of m, the moment and the shear force of a section are m / n of the present ones. Beneath
    contact, the pressure is force over diameter and width.
    """
    study, required = sized.plan.study, sized.required
    ratio = required / trial.factor
    strength = study.material_of(sized.pin).yield_strength or 0.0
    stress = study.system.factor("stress")
    needed = engineering(rounded_up(strength * ratio / stress, 4))
    yield (
        f"a yield strength of {needed} {study.system.stress}, not {engineering(strength / stress)}"
    )
    tasks = [t for t in sized.plan.tasks if t.pin.name == sized.pin and worst.case in t.impulses]
    if tasks:
        time = tasks[0].impulses[worst.case].time
        needed = f"{engineering(rounded_up(time * ratio, 4))} {study.system.time}"
        yield f"an impulse in {worst.case} of {needed}, not {short(time)}"
    else:
        yield f"{engineering(rounded_down(1.0 / ratio, 4))} times the loads of {worst.case}"
    if arrangement := _arrangement(sized, trial):
        yield arrangement
    if limit.scale != ENDLESS:
        larger = limit.scale * max(
            (required / x) ** (1.0 / e)
            for x, e in ((trial.row, trial.exponent), (trial.beneath, trial.exponent_at("beneath")))
        )
        largest = larger * max(study.table.pin[sized.pin].diameters)
        across = engineering(rounded_up(largest / study.system.factor("length"), 2), 2)
        yield f"limits that allow about {across} {study.system.length} across"


def _arrangement(sized: SizedStudy, trial: PinTrial) -> str:
    """Return a text with the number of shear planes and the width of the lugs that would suffice;
    empty if such an arrangement is impractical.
    """
    required, parts = sized.required, []
    planes = len(_bands(sized.plan.study, sized.pin)) - 1
    if trial.row < required:
        if planes < 1:
            return ""
        needed = planes + 2 * math.ceil(0.5 * planes * (required / trial.row - 1.0))
        if needed > MAX_SHEAR_PLANES:
            return ""
        parts.append(f"about {needed} shear planes, not {planes}, of the same width in all")
    if trial.beneath < required:
        wider = required / trial.beneath
        if wider > MAX_WIDENING:
            return ""
        parts.append(f"lugs about {engineering(rounded_up(wider, 2), 2)} times as wide in all")
    return " and ".join(parts)

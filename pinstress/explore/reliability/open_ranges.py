"""Ranges that a study leaves open without a law, and by how much they raise the stress of rows."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

import numpy as np

from pinbase.keys import key_part
from pinstress.explore.sweep.number import Path
from pinstress.study.reading.file import Study
from pinstress.study.reading.in_python import changed_study
from reports.data.row import LandingRange, PinResult

CLEARANCE = "clearance"  # of all lugs of a joint, which are varied together
CLEARANCE_KEYS = (CLEARANCE, "interference", "fit")
RANGES = {  # words for the owner of a range
    "landing": "a landing's impulse",
    "strength": "a yield strength",
    CLEARANCE: "the clearances",
}


def with_open_ranges(row: PinResult, laws: Collection[Path], material: str) -> PinResult:
    """Return a row of the study as it is, without the ranges that a law describes.

    laws: paths of the numbers with a law. material: name of the material of the row's pin.
    """
    by_law, joint = _by_law(row, laws, material), row.joint
    if CLEARANCE in by_law and joint is not None and joint.range is not None:
        joint = replace(joint, range=joint.range.without(CLEARANCE, row.max_von_mises or 0.0))
    return replace(
        row,
        joint=joint,
        landing=None if "landing" in by_law else row.landing,
        strength_range=None if "strength" in by_law else row.strength_range,
    )


def without_strength_ranges(study: Study, laws: Collection[Path]) -> Study:
    """Return the study without the ranges of yield strengths that a law describes, because a
    strength outside its range would be refused.
    """
    by_law = [
        name
        for name, material in study.table.material.items()
        if material.range.yield_strength and ("material", name, "yield_strength") in laws
    ]
    keys = [f"material.{key_part(name)}.range" for name in by_law]
    return changed_study(study, {key: {} for key in keys}) if keys else study


def left_out(
    rows: Iterable[PinResult], laws: Collection[Path], materials: Mapping[str, str]
) -> Iterable[str]:
    """Yield a sentence on each range that is left out, because a law describes it.

    materials: the names of the pins' materials, by pin.
    """
    pins = [(owner, r.pin) for r in rows for owner in _by_law(r, laws, materials[r.pin])]
    for owner, name in RANGES.items():
        if some := dict.fromkeys(pin for x, pin in pins if x == owner):
            yield (
                f"The range of {name} is left out, since a law takes its place: a run judges pins "
                f"over it ({', '.join(some)})."
            )


def _by_law(row: PinResult, laws: Collection[Path], material: str) -> set[str]:
    """Return the owners of the row's ranges that a law describes."""
    owners = set()
    if row.landing is not None and _impulse_by_law(row.landing, laws):
        owners.add("landing")
    if row.strength_range is not None and ("material", material, "yield_strength") in laws:
        owners.add("strength")
    if _clearances_by_law(row, laws):
        owners.add(CLEARANCE)
    return owners


def _impulse_by_law(landing: LandingRange, laws: Collection[Path]) -> bool:
    """Whether laws describe everything that varies over the ranges of a landing's impulse."""
    time, velocity = landing.nominal
    ranges = {
        "impulse_time": np.any(landing.impulse_time != time),
        "velocity_change": np.any(landing.velocity_change != velocity),
        "pulse": any(pulse != landing.nominal_pulse for pulse in landing.pulses),
    }
    by_law = {x[-1] for x in laws if x[:2] == ("case", landing.case) and x[-2] == "impulse"}
    return all(key in by_law for key, differs in ranges.items() if differs)


def _clearances_by_law(row: PinResult, laws: Collection[Path]) -> bool:
    """Whether laws describe the clearances of all lugs of a pin in contact, which the range of the
    joint varies together.
    """
    joint = row.joint
    if joint is None or joint.range is None or joint.range.model != "contact":
        return False
    if all(x.what != CLEARANCE for x in joint.range.variations):
        return False
    alike = len({band.clearance for band in joint.bands}) == 1  # no lug has its own clearance
    if alike and any(("lug_defaults", key) in laws for key in CLEARANCE_KEYS):
        return True
    lugs = [("pin", row.pin, "lug", band.name) for band in joint.bands]
    return all(any((*lug, key) in laws for key in CLEARANCE_KEYS) for lug in lugs)

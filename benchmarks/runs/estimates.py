"""The estimated diameters of a run compared with those that `pinstress size` finds, and the stress
over mean pressure of pins with large diameters, which the estimates use.
"""

from __future__ import annotations

import statistics
from collections.abc import Mapping

from benchmarks import ROOT
from benchmarks.timing import table
from pinbase.processes.pool import cores, preload
from pinstress import Study, load_study, run
from pinstress.analysis.plan import prepare
from pinstress.cli.run import RUN_LIBRARIES, RUN_MODELS
from pinstress.explore.size.scaled_study import resized_study
from pinstress.explore.size.size_pin import SizingGoal, SizingResult
from pinstress.explore.size.size_pins import size_pins
from reports.data.overview import PinLine, pin_lines

DISCS = (
    ("landing_gear.toml", "A", "landing"),
    ("landing_gear.toml", "J", "landing"),
    ("clevis.toml", "P", "pull"),
)
DISC_SCALES = 3.0, 4.0


def estimates() -> str:
    """Return the table of the landing gear's failing pins, estimated and sized, and that of large
    diameters.
    """
    preload(*RUN_LIBRARIES, *RUN_MODELS)
    study = load_study(ROOT / "studies" / "landing_gear.toml")
    factor = study.table.analysis.required_safety_factor
    assert factor is not None
    lines = {x.pin: x for x in pin_lines(run(study, jobs=cores())) if x.diameter}
    failing = [name for name, line in lines.items() if line.diameter and line.diameter.needed]
    sized = _sized(study, factor, failing)
    rows = [row for name in failing if (row := _row(lines[name], sized[name]))]
    ratios = [float(row[-1]) for row in rows]
    unit = study.system.length
    head = ("pin", f"as it is, {unit}", f"estimated, {unit}", f"sized, {unit}", "ratio")
    said = (
        f"Largest diameter under a link, for the factor {factor:g}. Of {len(ratios)} pins the "
        f"estimate is {min(ratios):.2f} to {max(ratios):.2f} times what `size` finds, in the "
        f"middle {statistics.median(ratios):.2f} times:"
    )
    return f"{said}\n\n{table(head, rows)}\n\n{_discs()}"


def _discs() -> str:
    """Return the table of pins with several times their diameters: largest stress over largest mean
    pressure.
    """
    rows = [
        (name, pin, scale, f"{_over_pressure(name, pin, case, scale):.2f}")
        for name, pin, case in DISCS
        for scale in DISC_SCALES
    ]
    head = ("study", "pin", "times its diameters", "stress over mean pressure")
    return f"The largest stress of surface, section and beneath contact:\n\n{table(head, rows)}"


def _over_pressure(name: str, pin: str, case: str, scale: float) -> float:
    study = resized_study(load_study(ROOT / "studies" / name), {pin: scale}, None, None)
    row = run(study, pins=[pin], cases=[case])[pin, case]
    assert row.joint is not None
    assert row.places is not None
    assert row.places.contact is not None
    largest = max(row.max_von_mises or 0.0, row.places.contact.beneath)
    return largest / max(band.mean_pressure for band in row.joint.bands)


def _sized(study: Study, factor: float, names: list[str]) -> Mapping[str, SizingResult]:
    plan = prepare(study, pins=names)
    found = size_pins(plan, SizingGoal(factor), (), lambda _: None, cores(), lambda *_: None)
    return {each.pin: each for each in found}


def _row(line: PinLine, sized: SizingResult) -> tuple[str, float, float, float, str] | None:
    """Return the row of a pin; None if no size was found."""
    diameter = line.diameter
    if sized.scale is None or diameter is None or diameter.needed is None:
        return None
    given, needed = diameter.given, diameter.needed
    answer = sized.scale * given
    return line.pin, given, needed, answer, f"{needed / answer:.2f}"

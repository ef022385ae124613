"""What stands beside the safety factors: places without a maximum, and the checks by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from reports.csv_files import write_csv
from reports.results import Results

ZONES = (
    "pin",
    "case",
    "radius",
    "z",
    "kind",
    "between",
    "exponent",
    "exponent_theory",
    "excluded_radius",
    "governs",
    "max_von_mises",
    "advice",
)
CHECKS = (
    "pin",
    "case",
    "check",
    "at",
    "time",
    "stress",
    "strength",
    "factor",
    "formula",
    "source",
)


def write_singular_zones(results: Results, path: Path) -> None:
    """Write every zone of every pin and case; the exponent is empty where it was not measured."""
    write_csv(
        path,
        (*ZONES, "length_unit", "stress_unit"),
        (
            (
                pin.pin,
                pin.case,
                float(np.hypot(*zone.location[:2])),
                zone.location[2],
                zone.kind,
                " / ".join(zone.between),
                zone.exponent,
                zone.exponent_theory,
                zone.excluded,
                zone.governs,
                zone.max_von_mises,
                zone.advice,
                results.units.length,
                results.units.stress,
            )
            for pin in results.pins
            for zone in pin.singular_at
        ),
    )


def write_hand_checks(results: Results, path: Path) -> None:
    """Write every hand check of every pin and case."""
    write_csv(
        path,
        (*CHECKS, "stress_unit", "time_unit"),
        (
            (
                pin.pin,
                pin.case,
                check.name,
                check.at,
                check.time,
                check.stress,
                check.strength,
                check.factor,
                check.formula,
                check.source,
                results.units.stress,
                results.units.time,
            )
            for pin in results.pins
            for check in pin.hand_checks
        ),
    )

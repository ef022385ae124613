"""results.json: what a run found, for programs to read."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from reports.numbers import finite
from reports.results import HandCheck, PinResult, ReactionTable, Results, SingularZone
from reports.terminal_loads import largest

SCHEMA = "pinstress-results/1"


def to_json(results: Results) -> dict[str, Any]:
    """The results as plain JSON values; a number that is none is null."""
    return {
        "schema": SCHEMA,
        "title": results.title,
        "study": results.study,
        "study_sha256": results.study_sha256,
        "units": asdict(results.units),
        "required_safety_factor": finite(results.required_safety_factor),
        "tolerance": finite(results.tolerance),
        "versions": {name: results.versions[name] for name in sorted(results.versions)},
        "pins": [_pin(pin) for pin in results.pins],
        "loads": [_loads(results, table) for table in results.reactions],
        "provenance": [asdict(entry) for entry in results.provenance],
    }


def write_json(results: Results, path: Path) -> None:
    """Write results.json: strict JSON in UTF-8 with every digit of every number."""
    text = json.dumps(to_json(results), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _loads(results: Results, table: ReactionTable) -> dict[str, Any]:
    """One case's mechanics: largest forces, drives, and the checks that were made."""
    moved = next((m for m in results.motion if m.case == table.case), None)
    return {
        "case": table.case,
        "note": table.note,
        "shared": list(table.shared),
        "largest_forces": [
            {"connection": name, "force": finite(force), "time": finite(time)}
            for name, (force, time) in largest(table).items()
        ],
        "drives": [
            {
                "drive": d.name,
                "kind": d.kind,
                "largest": finite(float(np.abs(d.force).max())),
                "mean": finite(d.mean),
                "rms": finite(d.rms),
            }
            for d in results.drive
            if d.case == table.case
        ],
        "power_violation": finite(moved.ledger.violation) if moved else None,
        "largest_condition": finite(float(moved.condition.max())) if moved else None,
    }


def _pin(pin: PinResult) -> dict[str, Any]:
    return {
        "pin": pin.pin,
        "case": pin.case,
        "model": pin.model,
        "max_von_mises": finite(pin.max_von_mises),
        "error_estimate": finite(pin.error_estimate),
        "verdict": pin.verdict,
        "note": pin.note,
        "why": pin.why,
        "location": None if pin.location is None else [finite(x) for x in pin.location],
        "time": finite(pin.time),
        "safety_factor": finite(pin.safety_factor),
        "yields": _truth(pin.yields),
        "meets_required": _truth(pin.meets_required),
        "dofs": int(pin.dofs),
        "seconds": finite(pin.seconds),
        "history": [
            {
                "dofs": int(step.dofs),
                "max_von_mises": finite(step.max_von_mises),
                "seconds": finite(step.seconds),
            }
            for step in pin.history
        ],
        "singular_at": [_zone(zone) for zone in pin.singular_at],
        "hand_checks": [_check(check) for check in pin.hand_checks],
        "held": pin.held,
        "left_out": list(pin.left_out),
    }


def _zone(zone: SingularZone) -> dict[str, Any]:
    return {
        "location": [finite(x) for x in zone.location],
        "kind": zone.kind,
        "between": list(zone.between),
        "exponent": finite(zone.exponent),
        "exponent_theory": finite(zone.exponent_theory),
        "excluded_radius": finite(zone.excluded),
        "governs": bool(zone.governs),
        "max_von_mises": finite(zone.max_von_mises),
        "advice": zone.advice,
    }


def _check(check: HandCheck) -> dict[str, Any]:
    return {
        "name": check.name,
        "at": check.at,
        "time": finite(check.time),
        "stress": finite(check.stress),
        "strength": finite(check.strength),
        "factor": finite(check.factor),
        "formula": check.formula,
        "source": check.source,
    }


def _truth(value: bool | None) -> bool | None:
    # A numpy bool is no JSON value.
    return None if value is None else bool(value)

"""results.json: the results of a run, machine-readable."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from reports.data.decision import DEPENDS, outcome
from reports.data.headline import headline_json
from reports.data.results import (
    Dependence,
    DropRecord,
    HandCheck,
    ReactionTable,
    Results,
    SingularZone,
)
from reports.format.numbers import finite
from reports.format.words import headline
from reports.tables.column import Table, json_of
from reports.tables.strength.fatigue import fatigue_json
from reports.tables.strength.limit_load import limit_load_json
from reports.tables.strength.margins import margins_table
from reports.tables.strength.safety_factors import FactorRow, safety_factors_table
from reports.tables.strength.sensitivities import sensitivities_json
from reports.tables.stress.calculix import opinion_json
from reports.tables.stress.joint import joint_json
from reports.tables.stress.places import places_json

RESULTS_SCHEMA = "pinstress-results/2"


def to_json(results: Results) -> dict[str, Any]:
    """The results as plain JSON values; missing numbers are null."""
    factors = safety_factors_table(results)
    return {
        "schema": RESULTS_SCHEMA,
        "title": results.title,
        "study": results.study,
        "study_sha256": results.study_sha256,
        "units": asdict(results.units),
        "required_safety_factor": finite(results.required_safety_factor),
        "tolerance": finite(results.tolerance),
        "versions": {name: results.versions[name] for name in sorted(results.versions)},
        "headline": _headline(results),
        "pins": [_pin(row, factors) for row in factors.rows],
        "margins": margins_table(results).records(),
        "changes": [asdict(change) for change in results.changes],
        "sensitivities": sensitivities_json(results),
        "fatigue": fatigue_json(results.fatigue),
        "loads": [_loads(results, table) for table in results.reactions],
        "drops": [_drop(d) for d in results.drops],
        "provenance": [asdict(entry) for entry in results.provenance],
        "inputs": results.inputs,
    }


def write_json(results: Results, path: Path) -> None:
    """Write results.json: strict JSON in UTF-8 with all digits."""
    text = json.dumps(to_json(results), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _loads(results: Results, table: ReactionTable) -> dict[str, Any]:
    """One case's loads: maximum forces, drives and checks."""
    moved = next((m for m in results.motion if m.case == table.case), None)
    return {
        "case": table.case,
        "note": table.note,
        "shared": list(table.shared),
        "largest_forces": [
            {
                "connection": p.connection,
                "force": finite(p.force),
                "time": finite(p.time),
                "frictionless": finite(p.frictionless),
            }
            for p in table.largest
        ],
        "drives": [
            {
                "drive": d.name,
                "kind": d.kind,
                "largest": finite(d.largest),
                "mean": finite(d.mean),
                "rms": finite(d.rms),
                "largest_power": finite(d.largest_power),
                "stroke": finite(d.stroke),
                "frictionless": finite(d.effort.frictionless) if d.effort else None,
                "position": finite(d.position[0]) if d.time is None else None,
            }
            for d in results.drive
            if d.case == table.case
        ],
        "unresolved": [[finite(low), finite(high)] for low, high in table.unresolved],
        "power_violation": finite(moved.ledger.violation) if moved else None,
        "largest_condition": finite(moved.worst_condition[0]) if moved else None,
    }


def _drop(d: DropRecord) -> dict[str, Any]:
    single = ("velocity", "weight", "lift", "load_factor", "imbalance", "impulse_time")
    more = ("impulse_force", "equal_impulse_time", "spin_up")
    return {
        "case": d.case,
        "clause": d.clause,
        **{name: finite(getattr(d, name)) for name in (*single, *more)},
        "peaks": {
            name: {"value": finite(peak.value), "time": finite(peak.time)}
            for name, peak in d.peaks.items()
        },
    }


def _pin(of: FactorRow, table: Table[FactorRow]) -> dict[str, Any]:
    """A pin in a case: the columns of the safety factors that say so, and what no table has."""
    row, pin = json_of([c for c in table.columns if c.in_json], of), of.pin
    return {
        **row,
        "max_von_mises_interval": _interval(pin.max_von_mises_interval),
        "error_parts": {part: finite(value) for part, value in pin.error_parts.items()},
        "why": pin.why,
        "location": None if pin.location is None else [finite(x) for x in pin.location],
        "safety_factor_interval": _interval(pin.safety_factor_interval),
        **places_json(pin),
        "depends_on": [_dependence(d) for d in pin.depends_on if outcome(pin) == DEPENDS],
        "safe_within": [_dependence(d) for d in pin.depends_on if outcome(pin) != DEPENDS],
        "dofs": int(pin.dofs),
        "seconds": finite(pin.seconds),
        "history": [
            {
                "dofs": int(step.dofs),
                "max_von_mises": finite(step.max_von_mises),
                "seconds": finite(step.seconds),
                "strain_energy": finite(step.strain_energy),
            }
            for step in pin.history
        ],
        "singular_at": [_zone(zone) for zone in pin.singular_at],
        "hand_checks": [_check(check) for check in pin.hand_checks],
        "joint": joint_json(pin.joint),
        "second_opinion": opinion_json(pin.second_opinion),
        "limit_load": limit_load_json(pin.limit_load),
        "held": pin.held,
        "left_out": list(pin.left_out),
    }


def _headline(results: Results) -> dict[str, Any] | None:
    found = headline_json(results, headline(results))
    if found is not None:
        found["worst"]["factor"] = finite(found["worst"]["factor"])
    return found


def _dependence(d: Dependence) -> dict[str, Any]:
    return {
        "what": d.what,
        "value": d.value,
        "over": d.over,
        "given": finite(d.given),
        "at": finite(d.at),
        "flips_at": finite(d.flips_at),
        "reach": finite(d.reach),
        "safety_factor": finite(d.factor),
    }


def _interval(ends: tuple[float, float | None] | None) -> list[float | None] | None:
    return None if ends is None else [finite(end) for end in ends]


def _zone(zone: SingularZone) -> dict[str, Any]:
    strength = zone.strength
    return {
        "location": [finite(x) for x in zone.location],
        "kind": zone.kind,
        "between": list(zone.between),
        "exponent": finite(zone.exponent),
        "exponent_theory": finite(zone.exponent_theory),
        "excluded_radius": finite(zone.excluded),
        "governs": bool(zone.governs),
        "max_von_mises": finite(zone.max_von_mises),
        "strength": finite(strength.along if strength else None),
        "strength_exponent": finite(strength.exponent if strength else None),
        "notch_stress_intensity": finite(strength.notch if strength else None),
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
        "basis": check.basis,
        "governs": check.governs,
    }

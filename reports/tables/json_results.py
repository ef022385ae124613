"""results.json: the results of a run, machine-readable."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from assess.judgement import DEPENDS
from fea.core.peak import SingularZone
from pinbase.records import plain
from reports.data.drop import DropRecord
from reports.data.headline import headline_json
from reports.data.mechanics import DriveTable, ReactionTable
from reports.data.results import Results
from reports.format.numbers import finite
from reports.format.words import headline
from reports.tables.column import Column, Table, fields, json_of
from reports.tables.loads.wear import wear_table
from reports.tables.loads.wheel import wheel_table
from reports.tables.strength.fatigue import fatigue_json
from reports.tables.strength.lets_go import lets_go_table
from reports.tables.strength.limit_load import limit_load_json
from reports.tables.strength.margins import margins_table
from reports.tables.strength.requirements import requirements_table
from reports.tables.strength.safety_factors import FactorRow, safety_factors_table
from reports.tables.strength.sensitivities import sensitivities_json
from reports.tables.stress.calculix import opinion_json
from reports.tables.stress.joint import joint_json, lugs_table
from reports.tables.stress.places import places_json

RESULTS_SCHEMA = "pinstress-results/2"


# Keys of values that are in no table.
PIN = fields(
    "max_von_mises_interval error_parts why location safety_factor_interval dofs seconds history "
    "held left_out"
)
DEPENDENCE = fields("what value over given at flips_at reach safety_factor=factor")
ZONE: list[Column[SingularZone]] = [
    *fields("location kind between exponent exponent_theory excluded_radius=excluded governs"),
    *fields("max_von_mises strength=strength?.along strength_exponent=strength?.exponent"),
    *fields("notch_stress_intensity=strength?.notch advice"),
]
CHECK = fields(
    "name=method at time stress=demand strength=allowable factor=safety_factor formula "
    "source=clause basis governs"
)
PEAK = fields("connection force time frictionless")
DRIVE: list[Column[DriveTable]] = [
    *fields("drive=name kind largest mean rms largest_power stroke"),
    *fields("effort?.frictionless"),
    Column("position", lambda drive: drive.position[0] if drive.time is None else None),
]
DROP = fields(
    "case clause velocity weight lift load_factor imbalance impulse_time impulse_force "
    "equal_impulse_time spin_up"
)


def to_json(results: Results) -> dict[str, Any]:
    """Return the results as plain JSON values; missing numbers are null."""
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
        "requirements": requirements_table(results).records(),
        "lugs": lugs_table(results).records(),
        "margins": margins_table(results).records(),
        "lets_go": lets_go_table(results).records(),
        "changes": [asdict(change) for change in results.changes],
        "sensitivities": sensitivities_json(results),
        "fatigue": fatigue_json(results.fatigue),
        "loads": [_loads(results, table) for table in results.reactions],
        "wear": wear_table(results).records(),
        "wheel_loads": wheel_table(results).records(),
        "drops": [_drop(d) for d in results.drops],
        "provenance": [asdict(entry) for entry in results.provenance],
        "inputs": results.inputs,
    }


def write_json(results: Results, path: Path) -> None:
    """Write results.json: strict JSON in UTF-8 with all digits."""
    text = json.dumps(to_json(results), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _loads(results: Results, table: ReactionTable) -> dict[str, Any]:
    """Return the loads of one case: maximum forces, drives and checks."""
    posture = next((p for p in results.postures if p.case == table.case), None)
    return {
        "case": table.case,
        "note": table.note,
        "clause": table.clause,
        "shared": list(table.shared),
        "largest_forces": [json_of(PEAK, peak) for peak in table.largest],
        "drives": [json_of(DRIVE, drive) for drive in results.drive if drive.case == table.case],
        "unresolved": plain(table.unresolved),
        "power_violation": finite(posture.violation) if posture else None,
        "largest_condition": finite(posture.worst_condition[0]) if posture else None,
        "least_transmission": [
            {"link": link, "degrees": finite(low), "time": finite(time)}
            for link, (low, time) in (posture.poorest if posture else {}).items()
        ],
    }


def _drop(d: DropRecord) -> dict[str, Any]:
    peaks = {name: {"value": peak.value, "time": peak.time} for name, peak in d.peaks.items()}
    return {**json_of(DROP, d), "peaks": plain(peaks)}


def _pin(of: FactorRow, table: Table[FactorRow]) -> dict[str, Any]:
    """Return a pin in a case: the JSON columns of the safety factors, and values that are in no
    table.
    """
    pin, depends = of.pin, "depends_on" if of.pin.outcome == DEPENDS else "safe_within"
    return {
        **json_of([column for column in table.columns if column.in_json], of),
        **json_of(PIN, pin),
        **places_json(pin),
        "depends_on": [],
        "safe_within": [],
        depends: [json_of(DEPENDENCE, dependence) for dependence in pin.depends_on],
        "singular_at": [json_of(ZONE, zone) for zone in pin.singular_at],
        "hand_checks": [json_of(CHECK, check) for check in pin.hand_checks],
        "joint": joint_json(pin.joint),
        "second_opinion": opinion_json(pin.second_opinion),
        "limit_load": limit_load_json(pin.limit_load),
    }


def _headline(results: Results) -> dict[str, Any] | None:
    decision = headline_json(results, headline(results))
    if decision is not None:
        decision["worst"]["factor"] = finite(decision["worst"]["factor"])
    return decision

"""Names of the units of dimensions."""

from __future__ import annotations

from reports.data.row import Units


def unit_name(dimension: str, units: Units) -> str:
    """Return the name of the unit of a dimension; empty where there is none."""
    names = {
        "time": units.time,
        "force": units.force,
        "length": units.length,
        "stress": units.stress,
        "moment": f"{units.force} {units.length}",
        "velocity": f"{units.length}/{units.time}",
        "acceleration": f"{units.length}/{units.time}²",
        "power": f"{units.force} {units.length}/{units.time}",
        "momentum": f"{units.force} {units.time}",
        "angular momentum": f"{units.force} {units.length} {units.time}",
        "stress velocity": f"{units.stress} {units.length}/{units.time}",
        "force per length": f"{units.force}/{units.length}",
        "curvature": f"1/{units.length}",
        "degrees": "°",
        "rate of turn": f"rad/{units.time}",
        "rate of rate of turn": f"rad/{units.time}²",
    }
    return names.get(dimension, "")

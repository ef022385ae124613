"""From a study to the spectrum and the fatigue data of its materials."""

from __future__ import annotations

from math import inf

from assess.fatigue.assess import FatigueMaterial, Spectrum
from assess.fatigue.fkm import FkmMaterial
from assess.fatigue.sn_curve import SnCurve
from pinstress.study.schema.fatigue import FatigueTable, SnTable
from pinstress.study.schema.pins import MaterialTable


def spectrum(table: FatigueTable) -> Spectrum:
    """Of a study."""
    return Spectrum(table.occurrences, table.method, table.failure_probability, table.life)


def fatigue_material(table: MaterialTable) -> FatigueMaterial:
    """What is given of a material."""
    sn, fkm, ultimate = table.fatigue, table.fkm, table.ultimate_strength
    return FatigueMaterial(
        None if sn is None else _curve(sn, ultimate),
        None if sn is None else sn.mean_stress_sensitivity,
        None
        if fkm is None or ultimate is None
        else FkmMaterial(fkm.group, ultimate, fkm.roughness, fkm.plastic_factor),
    )


def _curve(table: SnTable, ultimate: float | None) -> SnCurve:
    of_rule = {
        "fkm": table.mean_stress_sensitivity,
        "goodman": ultimate,
        "walker": table.walker_exponent,
    }
    return SnCurve(
        (table.knee_stress, table.knee_cycles),
        table.slope,
        inf if table.slope_below is None else table.slope_below,
        table.scatter or 1.0,
        table.failure_probability,
        table.mean_stress,
        of_rule.get(table.mean_stress) or 0.0,
    )

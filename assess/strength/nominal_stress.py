"""Nominal stresses of pin and lugs (`hand_checks`, `lug_checks`) as margins.

Each is checked against yield at limit load, and against the strength at rupture, which the study
may give (shear, bearing, ultimate), at ultimate load. Of the places of a check the worst is kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from assess.strength.margin import Level, Margin, PinMargin, skipped
from assess.strength.records import HandCheck
from assess.strength.situation import LoadFactors
from assess.strength.worst import strength_key
from fea.core.material import Material


def nominal_margins(
    checks: Iterable[HandCheck], materials: Mapping[str, Material], factors: LoadFactors
) -> list[Margin]:
    """Of hand checks on things of `materials`, by name."""
    found: dict[tuple[str, Level, str], Margin] = {}
    for check in checks:
        for made in _both(check, materials[check.material], factors):
            key = made.method, made.level, made.needs
            if key not in found or _used(made) > _used(found[key]):
                found[key] = made
    return list(found.values())


def _used(margin: Margin) -> float:
    return PinMargin("", "", margin).used


def _both(check: HandCheck, material: Material, factors: LoadFactors) -> list[Margin]:
    key = strength_key(material.name, "yield")
    at_yield = _margin(check, "limit", factors, check.strength, key)
    if not check.ruptures:
        return [at_yield]
    strength: float | None = getattr(material, f"{check.ruptures}_strength")
    key = strength_key(material.name, check.ruptures)
    return [at_yield, _margin(check, "ultimate", factors, strength, key)]


def _margin(
    check: HandCheck, level: Level, factors: LoadFactors, strength: float | None, key: str
) -> Margin:
    factor = factors.at(level)
    if strength is None:
        lacks = skipped(check.name, check.source, level, factor, key)
        return replace(lacks, governs=check.governs)
    basis = "; ".join(filter(None, (check.basis, check.formula)))
    return Margin(
        check.name, check.source, level, check.stress, strength, factor,
        at=check.at, time=check.time, basis=basis, governs=check.governs,
    )  # fmt: skip

"""Damage at a critical point under a spectrum, by one of three methods.

signed-von-mises   rainflow of the signed von Mises stress, mean stress, S-N curve
critical-plane     Findley's plane of largest damage                  (`critical_plane`)
fkm-p-ram          local strains by the FKM guideline                 (`fkm`)

The first and the last take one course of stress with a sign. Where none stands for the history
(assess.fatigue.proportional), the critical plane is taken instead, or the history is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import inf, isfinite, prod
from typing import Literal

import numpy as np

from assess.fatigue.critical_plane import findley_k, worst_plane
from assess.fatigue.fkm import FkmMaterial, p_ram_life
from assess.fatigue.flight import Cycles, case_by_case, flight, rainflow
from assess.fatigue.proportional import MAX_RULE_ERROR, SignedCourse, course
from assess.fatigue.records import PointFatigue, PointHistory
from assess.fatigue.sn_curve import SnCurve
from pinbase.arrays import Floats
from pinbase.errors import ArgumentError

Method = Literal["signed-von-mises", "critical-plane", "fkm-p-ram"]
SHOWN_PROBABILITIES = (0.1, 0.5, 0.9)  # of failure, at which lives are reported
TRESCA_RATIO = 2.0 / 3.0**0.5  # largest ratio of Tresca's stress to von Mises stress
# Of Findley's equivalent amplitude over the largest Tresca stress T, where a plane has its shear
# stress, T/2, and its normal stress, T, at different instants: (1 + 2 k)/(k + sqrt(1 + k^2)), which
# is largest at k = 3/4.
FINDLEY_RATIO = 1.25
MIN_SHOWN_AMPLITUDE = 0.01  # of the largest amplitude: smaller ones are not shown


# By what is open of the stress and by case: the largest stress over that of the case.
Growth = Mapping[str, Mapping[str, float]]


@dataclass(frozen=True)
class Spectrum:
    """The load spectrum of a pin and how its damage is assessed.

    occurrences: of cases per unit (a flight, say), in the order in which they follow each other.
    probability: of failure at which damage is assessed, by default that of the S-N data.
    life: design life, in units.
    """

    occurrences: Mapping[str, float]
    method: Method = "signed-von-mises"
    probability: float | None = None
    life: float | None = None


@dataclass(frozen=True)
class FatigueMaterial:
    """Fatigue data of a material: an S-N curve, Findley's mean stress sensitivity, data for FKM."""

    curve: SnCurve | None = None
    sensitivity: float | None = None
    fkm: FkmMaterial | None = None


@dataclass(frozen=True)
class _MethodResult:
    """Damage per unit at each probability (None: the requested one), and the cycles behind it.

    amplitude, mean: Pa, of the largest cycle.
    equivalent: (C,) Pa.
    units: until the spectrum repeats.
    normal: of the critical plane.
    """

    damage: dict[float | None, float]
    amplitude: float
    mean: float
    equivalent: Floats
    units: int
    normal: Floats | None = None


def assess(
    history: PointHistory, spectrum: Spectrum, material: FatigueMaterial
) -> PointFatigue | None:
    """The damage at a point; None where no case of the spectrum acts or the method has no data.

    Raises: ArgumentError where the method cannot see the history and the critical plane, which can,
    lacks data (`unseen-history`).
    """
    known = {case.case: case for case in history.cases}
    cases = [known[name] for name, n in spectrum.occurrences.items() if n > 0.0 and name in known]
    if not cases or (material.fkm if spectrum.method == "fkm-p-ram" else material.curve) is None:
        return None
    often, seen = [spectrum.occurrences[c.case] for c in cases], course(cases)
    method, note = _method(spectrum, seen, material)
    if method == "fkm-p-ram":
        result = _by_fkm(seen.cases, often, spectrum, material)
    elif method == "critical-plane":
        result = _by_plane([c.stress for c in cases], often, spectrum, material)
    else:
        result = _by_sign(seen.cases, often, spectrum, material)
    damage = result.damage[None]
    shown, counts = _collective(result.equivalent, result.units)
    return PointFatigue(
        pin=history.pin,
        point=history.point,
        location=history.location,
        cases=tuple(c.case for c in cases),
        method=method,
        damage=damage,
        life=_life(damage),
        lives=tuple(_life(result.damage[p]) for p in SHOWN_PROBABILITIES if p in result.damage),
        utilisation=None if spectrum.life is None else damage * spectrum.life,
        amplitude=result.amplitude,
        mean=result.mean,
        amplitudes=shown,
        counts=counts,
        note="; ".join(filter(None, (history.chosen, note))),
        normal=None if result.normal is None else history.in_pin_axes(result.normal),
    )


def assess_over(
    history: PointHistory, spectrum: Spectrum, material: FatigueMaterial, growth: Growth
) -> PointFatigue | None:
    """`assess` with the largest damage over what is open of the stress.

    All components of the stress of a case are taken to grow alike, at all instants.

    Raises: ArgumentError, as `assess`.
    """
    point = assess(history, spectrum, material)
    if point is None or not growth:
        return point

    def damage(*what: str) -> float:
        grown = assess(_grown(history, [growth[x] for x in what]), spectrum, material)
        return max(point.damage, grown.damage if grown else 0.0)

    return replace(
        point, largest_damage=damage(*growth), damage_over={what: damage(what) for what in growth}
    )


def _grown(history: PointHistory, growth: Iterable[Mapping[str, float]]) -> PointHistory:
    """A history in which the stress of every case is as many times as large."""
    cases = []
    for case in history.cases:
        times = prod(by_case.get(case.case, 1.0) for by_case in growth)
        stress, plain, signed = (times * x for x in (case.stress, case.von_mises, case.signed))
        cases.append(replace(case, stress=stress, von_mises=plain, signed=signed))
    return replace(history, cases=tuple(cases))


def _method(
    spectrum: Spectrum, seen: SignedCourse, material: FatigueMaterial
) -> tuple[Method, str]:
    """The method that sees the history, and the reason if it is not the requested one."""
    requested, curve = spectrum.method, material.curve
    if requested == "critical-plane":
        return requested, ""
    if seen.stands:
        return requested, seen.note
    if _harmless(TRESCA_RATIO * seen.largest, spectrum, material):
        return requested, "the stress is not proportional, but does no damage in any direction"
    why = (
        f"the stress is not proportional (off by {100.0 * seen.unseen:.0f} % of its largest value, "
        f"above {100.0 * MAX_RULE_ERROR:.0f} %), which {requested} cannot see"
    )
    needs = ""
    if curve is None:
        needs = "an S-N curve"
    elif material.sensitivity is None and curve.rule != "none":
        needs = "the mean_stress_sensitivity of the S-N curve"
    elif spectrum.probability not in (None, curve.probability) and curve.scatter == 1.0:
        needs = "the scatter of the S-N curve"
    if needs:
        raise ArgumentError(f"{why}; the critical plane needs {needs}", "unseen-history")
    return "critical-plane", f"{why}: by the critical plane"


def _harmless(largest: float, spectrum: Spectrum, material: FatigueMaterial) -> bool:
    """Whether a history of any directions does no damage. largest: Tresca stress, Pa."""
    if spectrum.method == "fkm-p-ram":
        assert material.fkm is not None
        both = np.array([0.0, largest, -largest, 0.0])
        return p_ram_life(both, material.fkm, spectrum.probability or 0.5).infinite
    assert material.curve is not None
    most = np.array([FINDLEY_RATIO * largest])
    return not material.curve.life(spectrum.probability).damage(most).any()


def _life(damage: float) -> float | None:
    """Units until damage 1; None without damage."""
    return 1.0 / damage if damage > 0.0 and isfinite(damage) else (0.0 if damage else None)


def _by_sign(
    courses: list[Floats], often: list[float], spectrum: Spectrum, material: FatigueMaterial
) -> _MethodResult:
    """Damage by rainflow of a signed stress and an S-N curve."""
    curve, order = material.curve, flight(often)
    assert curve is not None
    cycles = rainflow(order.sequence([case_by_case(course)[0] for course in courses]))
    equivalent = curve.equivalent(cycles.amplitude, cycles.mean)
    damage = _damage(curve, equivalent, order.units, spectrum.probability)
    return _MethodResult(damage, *_largest(cycles, equivalent), equivalent, order.units)


def _by_plane(
    courses: list[Floats], often: list[float], spectrum: Spectrum, material: FatigueMaterial
) -> _MethodResult:
    """Damage by Findley's critical plane."""
    curve, order = material.curve, flight(often)
    assert curve is not None
    life = curve.life(spectrum.probability)
    worst = worst_plane(courses, order, findley_k(material.sensitivity or 0.0), life)
    damage = _damage(curve, worst.equivalent, order.units, spectrum.probability)
    largest = _largest(worst.shear, worst.equivalent)
    return _MethodResult(damage, *largest, worst.equivalent, order.units, worst.normal)


def _by_fkm(
    courses: list[Floats], often: list[float], spectrum: Spectrum, material: FatigueMaterial
) -> _MethodResult:
    """Damage by the FKM guideline's P_RAM."""
    order, data = flight(often), material.fkm
    assert data is not None
    sequence = order.sequence([case_by_case(course)[0] for course in courses])
    cycles = rainflow(sequence)

    damage: dict[float | None, float] = dict.fromkeys((None, *SHOWN_PROBABILITIES), 0.0)
    if sequence.any():
        # The sequence ends at zero; lives at other probabilities follow from that at 50 %.
        whole = np.append(sequence, 0.0)
        middle = p_ram_life(whole, data)
        requested = middle
        if spectrum.probability not in (None, 0.5):
            requested = p_ram_life(whole, data, spectrum.probability)
        if not requested.infinite:
            damage[None] = _per_unit(requested.repetitions, order.units)
        if not middle.infinite and middle.at is not None:
            damage |= {p: _per_unit(middle.at(p), order.units) for p in SHOWN_PROBABILITIES}
    return _MethodResult(damage, *_largest(cycles, cycles.amplitude), cycles.amplitude, order.units)


def _per_unit(repetitions: float, units: int) -> float:
    return 1.0 / (repetitions * units) if repetitions > 0.0 else inf


def _damage(
    curve: SnCurve, equivalent: Floats, units: int, probability: float | None
) -> dict[float | None, float]:
    """Damage per unit at the requested probability and, with a scatter, at the reported ones."""
    every = (None, *SHOWN_PROBABILITIES) if curve.scatter > 1.0 else (None,)
    return {
        p: curve.damage(equivalent, 1.0 / units, probability if p is None else p) for p in every
    }


def _largest(cycles: Cycles, equivalent: Floats) -> tuple[float, float]:
    """Amplitude and mean of the cycle that is largest at stress ratio -1, Pa."""
    if not len(equivalent):
        return 0.0, 0.0
    k = int(equivalent.argmax())
    return float(cycles.amplitude[k]), float(cycles.mean[k])


def _collective(equivalent: Floats, units: int) -> tuple[Floats, Floats]:
    """Distinct amplitudes (C,), Pa, the largest first, and the occurrences of each per unit."""
    largest = equivalent.max(initial=0.0)
    if not isfinite(largest):
        largest = float(equivalent[equivalent < inf].max(initial=0.0))
    shown = equivalent[(equivalent >= MIN_SHOWN_AMPLITUDE * largest) & (equivalent < inf)]
    scale = largest * 1e-6 or 1.0
    values, counts = np.unique(np.round(shown / scale), return_counts=True)
    return values[::-1] * scale, counts[::-1] / units

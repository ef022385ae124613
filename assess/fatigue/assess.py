"""Damage at a critical point under a spectrum, by one of three methods.

signed-von-mises   rainflow of the signed von Mises stress, mean stress, S-N curve
critical-plane     Findley's plane of largest damage                  (`critical_plane`)
fkm-p-ram          local strains by the FKM guideline                 (`fkm`)

The first and the last method take a single signed stress. Where no signed stress represents the
history (assess.fatigue.proportional), the critical plane is used instead; if its data are missing,
the history is refused.
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
# Largest ratio of Findley's equivalent amplitude to the largest Tresca stress T. In the worst case
# a plane has its shear stress, T/2, and its normal stress, T, at different instants; the ratio is
# then (1 + 2 k)/(k + sqrt(1 + k^2)), which is largest at k = 3/4.
FINDLEY_RATIO = 1.25
MIN_SHOWN_AMPLITUDE = 0.01  # relative to the largest amplitude: smaller ones are not shown


# The ratio of the largest stress to the stress of the case, by source of uncertainty and by case.
Growth = Mapping[str, Mapping[str, float]]


@dataclass(frozen=True)
class Spectrum:
    """The load spectrum of a pin and the way in which its damage is assessed.

    occurrences: how often each load case occurs per unit (for example per flight), in the order in
    which the cases follow each other.
    probability: the failure probability for which damage is assessed, by default that of the S-N
    data.
    life: design life, in units.
    """

    occurrences: Mapping[str, float]
    method: Method = "signed-von-mises"
    probability: float | None = None
    life: float | None = None


@dataclass(frozen=True)
class FatigueMaterial:
    """The fatigue data of a material: S-N curve, Findley's mean stress sensitivity, FKM data."""

    curve: SnCurve | None = None
    sensitivity: float | None = None
    fkm: FkmMaterial | None = None


@dataclass(frozen=True)
class _MethodResult:
    """The damage per unit at each failure probability (None: the requested one), and its cycles.

    amplitude, mean: of the largest cycle, Pa.
    equivalent: (C,) equivalent amplitudes of all cycles, Pa.
    units: the number of units after which the spectrum repeats itself.
    normal: of the critical plane, in the axes of the stresses.
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
    """Return the damage at a point; None if no case of the spectrum was solved or the material
    lacks the data of the method.

    Raises: ArgumentError if the method cannot represent the stress history and the critical plane,
    which can, lacks data (`unseen-history`).
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
    """Return `assess` with the largest damage over the uncertainties of the stress.

    All stress components of a case are assumed to grow by the same ratio, at all instants.

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
    """Return a history in which the stress of each case is multiplied by all its growth ratios."""
    cases = []
    for case in history.cases:
        times = prod(by_case.get(case.case, 1.0) for by_case in growth)
        stress, plain, signed = (times * x for x in (case.stress, case.von_mises, case.signed))
        cases.append(replace(case, stress=stress, von_mises=plain, signed=signed))
    return replace(history, cases=tuple(cases))


def _method(
    spectrum: Spectrum, seen: SignedCourse, material: FatigueMaterial
) -> tuple[Method, str]:
    """Return the method that can represent the history, and a remark on the choice.

    Raises: ArgumentError, as `assess`.
    """
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
    """Whether no history up to a Tresca stress does damage, in whichever directions it acts.

    largest: largest Tresca stress, Pa.
    """
    if spectrum.method == "fkm-p-ram":
        assert material.fkm is not None
        both = np.array([0.0, largest, -largest, 0.0])
        return p_ram_life(both, material.fkm, spectrum.probability or 0.5).infinite
    assert material.curve is not None
    most = np.array([FINDLEY_RATIO * largest])
    return not material.curve.life(spectrum.probability).damage(most).any()


def _life(damage: float) -> float | None:
    """Return the number of units until the damage is 1; None without damage."""
    return 1.0 / damage if damage > 0.0 and isfinite(damage) else (0.0 if damage else None)


def _by_sign(
    courses: list[Floats], often: list[float], spectrum: Spectrum, material: FatigueMaterial
) -> _MethodResult:
    """Return the damage by rainflow counting of a signed stress and an S-N curve."""
    curve, order = material.curve, flight(often)
    assert curve is not None
    cycles = rainflow(order.sequence([case_by_case(course)[0] for course in courses]))
    equivalent = curve.equivalent(cycles.amplitude, cycles.mean)
    damage = _damage(curve, equivalent, order.units, spectrum.probability)
    return _MethodResult(damage, *_largest(cycles, equivalent), equivalent, order.units)


def _by_plane(
    courses: list[Floats], often: list[float], spectrum: Spectrum, material: FatigueMaterial
) -> _MethodResult:
    """Return the damage on Findley's critical plane."""
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
    """Return the damage by P_RAM of the FKM guideline."""
    order, data = flight(often), material.fkm
    assert data is not None
    sequence = order.sequence([case_by_case(course)[0] for course in courses])
    cycles = rainflow(sequence)

    damage: dict[float | None, float] = dict.fromkeys((None, *SHOWN_PROBABILITIES), 0.0)
    if sequence.any():
        # The sequence must end at zero. Lives at other probabilities follow from the life at 50 %.
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
    """Return the damage per unit at the requested probability and, if lives scatter, at the
    reported ones.
    """
    every = (None, *SHOWN_PROBABILITIES) if curve.scatter > 1.0 else (None,)
    return {
        p: curve.damage(equivalent, 1.0 / units, probability if p is None else p) for p in every
    }


def _largest(cycles: Cycles, equivalent: Floats) -> tuple[float, float]:
    """Return amplitude and mean, Pa, of the cycle with the largest equivalent amplitude."""
    if not len(equivalent):
        return 0.0, 0.0
    k = int(equivalent.argmax())
    return float(cycles.amplitude[k]), float(cycles.mean[k])


def _collective(equivalent: Floats, units: int) -> tuple[Floats, Floats]:
    """Return the distinct amplitudes (C,), Pa, the largest first, and how often each occurs per
    unit. Small amplitudes (MIN_SHOWN_AMPLITUDE) and infinite ones are left out.
    """
    largest = equivalent.max(initial=0.0)
    if not isfinite(largest):
        largest = float(equivalent[equivalent < inf].max(initial=0.0))
    shown = equivalent[(equivalent >= MIN_SHOWN_AMPLITUDE * largest) & (equivalent < inf)]
    scale = largest * 1e-6 or 1.0
    values, counts = np.unique(np.round(shown / scale), return_counts=True)
    return values[::-1] * scale, counts[::-1] / units

"""Pins whose loads are prescribed: clamps, and tractions of a given distribution."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.core.equilibrium import NO_SUPPORT, Balance, Carried, out_of_balance
from fea.core.material import Material
from fea.core.peak import Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.verdict import judge
from fea.section.place import found_section
from fea.section.row import row_of
from fea.section.section_stress import SectionField
from fea.support.hardened_row import PartSearch, hardened_row
from fea.support.support import (
    HeldPin,
    PinProblem,
    Progress,
    Solution,
    StressReading,
    UnderLinkLoads,
    silent,
)
from geometry import PinLike, body_of_revolution

MIN_REPORTED_IMBALANCE = 1e-6  # of the largest load: smaller imbalances are not reported


class PrescribedSupport:
    """A support by clamps and prescribed tractions (fea.support.support.Support)."""

    def hold(
        self,
        problem: PinProblem,
        requirement: Requirement,
        coarser: HeldPin | None = None,
        progress: Progress = silent,
    ) -> HeldPrescribed:
        """Hold the pin by its clamps.

        Without clamps, a case whose loads are not in balance is rigid, unless the bands can react
        the imbalance.
        """
        if isinstance(coarser, HeldPrescribed):
            return coarser
        pin = problem.pin
        if problem.clamps:
            return HeldPrescribed(problem, {}, {}, {})
        of = balanced(pin, problem.material, problem.cases, requirement.model)
        return HeldPrescribed(problem, *of)


@dataclass(frozen=True)
class HeldPrescribed(UnderLinkLoads):
    """A pin under prescribed loads (fea.support.support.HeldPin).

    failures: for each case that is rigid, its maximum.
    imbalance: for each case, the relative force and couple that the bands react; None if
    negligible.
    """

    problem: PinProblem
    failures: Mapping[str, Maximum]
    imbalance: Mapping[str, tuple[float, float] | None]
    notes: Mapping[str, Reason]

    @property
    def clamps(self) -> tuple[str, ...]:
        """The names of the clamped surfaces."""
        return tuple(self.pin.surface(name) for name in self.problem.clamps)

    def finished(self, reading: StressReading, requirement: Requirement) -> Solution:
        """The judged solution; for a body of revolution with the largest stress of sections."""
        loads, instant, material = reading.loads, reading.instant, self.problem.material
        case = loads.case
        evidence = replace(reading.evidence, imbalance=self.imbalance.get(case))
        if loads.pressed is not None:
            peak = judge(evidence, requirement.tolerance)
            return Solution(peak, reading.answer, loads, instant, self)
        section = None
        profile = body_of_revolution(self.pin)
        if profile is not None:
            given = self.start(case)
            stress = SectionField(profile, material, self.clamps, (given,))
            between = self.problem.between.get(case)
            section = found_section(stress, given, between, requirement.tolerance)
        peak = row_of(evidence, section, material, requirement.tolerance)
        now = None
        if section is not None and peak.places is not None and peak.places.governs == "section":
            now = section.loads
        if material.hardened and profile is not None:
            search = PartSearch(
                reading, profile, between, evidence, stress, (given, between), requirement.tolerance
            )
            parts = search.of(material.strength_parts(profile.length))
            tolerance = requirement.tolerance
            peak = hardened_row(profile, peak, evidence, parts, tolerance, lambda x: x.loads)
            now = peak.governing
        if now is not None and now.times is not None and loads.times is not None:
            loads = loads.merged(now)
            assert loads.times is not None
            instant = int(np.searchsorted(loads.times, now.times[0]))
        return Solution(peak, reading.answer, loads, instant, self)


def balanced(
    pin: PinLike, material: Material, cases: Sequence[PinLoads], model: str
) -> tuple[dict[str, Maximum], dict[str, tuple[float, float] | None], dict[str, Reason]]:
    """Check the equilibrium of the loads on an unclamped pin.

    Return three mappings by case: the maxima of cases whose imbalance the bands cannot react, the
    relative imbalance that the bands react, and notes on that imbalance.
    """
    balances = {case.case: _balance(pin, case, material) for case in cases}
    shares = {case: imbalance(pin, balance) for case, balance in balances.items()}
    notes = {case: _reacted(share) for case, share in shares.items() if share}
    rigid = {
        case: Maximum(
            pin.name, case, model, "rigid", of.refusal, reasons=(of.code,), imbalance=shares[case]
        )
        for case, of in balances.items()
        if of.refusal
    }
    return rigid, shares, notes


def _balance(pin: PinLike, case: PinLoads, material: Material) -> Balance:
    """The balance of the loads as they are given.

    Couples of contact pressures do not count as an imbalance, since contact balances them.
    """
    pressed = case.links is not case
    carried = Carried(couple=True) if pressed else NO_SUPPORT
    return out_of_balance(pin, case, material.density, carried)


def imbalance(pin: PinLike, balance: Balance) -> tuple[float, float] | None:
    """The force that the bands react, over the largest load, and the couple, over that load times
    the pin's length; None if negligible.
    """
    if not balance.largest:
        return None
    force = balance.force / balance.largest
    couple = balance.couple / balance.largest / pin.length
    return (force, couple) if max(force, couple) >= MIN_REPORTED_IMBALANCE else None


def _reacted(share: tuple[float, float]) -> Reason:
    """The imbalance that the bands react, as the last part of a note."""
    force, couple = share
    return Reason(
        f"; the bearing bands react a residual imbalance: a force of {force:.2g} of the largest "
        f"load and a couple of {couple:.2g} of that load times the length",
        ("imbalance-reacted",),
    )

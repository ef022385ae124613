"""The overview of a run: one line for each pin, the cases that never govern, and estimated
diameters.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from assess.diameter_law import DiameterLaw, disc_factor
from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, SAFE, YIELDS
from reports.data.changes import unsized
from reports.data.decision import beneath_factor, factor_ends, limit, utilisation
from reports.data.envelope import MAX_DETAILED_CASES
from reports.data.headline import JudgedCheck, judged_checks, worst_checks
from reports.data.results import PinShape, Results
from reports.data.row import PinResult
from reports.data.unknowns import Ends, factor_spread

GOOD = (SAFE, BELOW_YIELD)
MAX_LUG_SHARE = 0.75  # pin over outer diameter of a lug; an eighth remains on each side
NEAR_ENOUGH = 1.001  # a smaller scale of the diameters counts as no change


@dataclass(frozen=True)
class Diameter:
    """The diameter with which a pin reaches its factor, as estimated by the law of its section.

    given: the largest diameter of its bands, or of the pin if it has no bands.
    needed: for the pin as described; None where the given diameter suffices or none does.
    whatever: likewise, over all that is open.
    eye: the outer diameter of its smallest lug; None without lugs.
    """

    given: float
    needed: float | None
    whatever: float | None
    eye: float | None = None

    def too_large(self, diameter: float | None) -> bool:
        """Return whether a diameter leaves less than a quarter of the lug."""
        return None not in (diameter, self.eye) and diameter > MAX_LUG_SHARE * self.eye  # type: ignore[operator]


@dataclass(frozen=True)
class PinLine:
    """A pin in the overview.

    row: its worst row.
    check: its worst check, of this row or another.
    case: the case of the check; "all cases" for a check over several.
    error: the ends of the factor by the error of the maximum.
    spread: the ends of the factor over all that is open.
    """

    row: PinResult
    check: JudgedCheck
    case: str
    error: Ends | None
    spread: Ends | None
    diameter: Diameter | None

    @property
    def pin(self) -> str:
        """The name of the pin."""
        return self.check.pin

    @property
    def outcome(self) -> str:
        """The outcome of its worst check."""
        return self.check.outcome


@dataclass(frozen=True)
class QuietCase:
    """A case in which all pins are safe and which governs no pin.

    pins: the number of pins.
    lowest: the row with the lowest factor; None if no row has one.
    """

    case: str
    pins: int
    lowest: PinResult | None


def pin_lines(results: Results) -> list[PinLine]:
    """Return a line for each pin, the worst first; for a single pin a line for each of its cases.

    A single pin with more than MAX_DETAILED_CASES cases has a line for the worst case only.
    """
    shapes = {shape.pin: shape for shape in results.shapes}
    worst = worst_checks(results)
    checks = list(worst.values())
    if len(worst) == 1 and len(results.pins) <= MAX_DETAILED_CASES:
        # In reversed order the worst check comes last, so the dictionaries keep it.
        judged = judged_checks(results)[::-1]
        by_case = {check.case: check for check in judged if check.case}
        over_all = {check.check: check for check in judged if not check.case}
        checks = [*(by_case[row.case] for row in results.pins), *over_all.values()]
    checks.sort(key=lambda check: check.rank)
    return [_line(results, check, shapes.get(check.pin)) for check in checks]


def quiet_cases(results: Results, lines: Sequence[PinLine]) -> list[QuietCase]:
    """Return the cases that govern no pin."""
    governing = {line.row.case for line in lines} | {line.check.case for line in lines}
    quiet = []
    for case in dict.fromkeys(row.case for row in results.pins):
        rows = [row for row in results.pins if row.case == case]
        if case not in governing and all(row.outcome in GOOD for row in rows):
            with_factor = [row for row in rows if row.safety_factor is not None]
            lowest = min(with_factor, key=lambda row: row.safety_factor or 0.0, default=None)
            quiet.append(QuietCase(case, len(rows), lowest))
    return quiet


def _line(results: Results, check: JudgedCheck, shape: PinShape | None) -> PinLine:
    rows = [row for row in results.pins if row.pin == check.pin and check.case in ("", row.case)]
    row = check.row or min(rows, key=lambda row: (-_used(row, limit(row)), row.case))
    error = factor_ends(row) if row.safety_factor else None
    diameter = _diameter(row, shape) if check.row or check.outcome in GOOD else None
    if diameter and check.pin in (change.pin for change in unsized(results.changes)):
        diameter = replace(diameter, needed=None, whatever=None)
    case = check.case or (row.case if len(rows) == 1 else "all cases")
    return PinLine(row, check, case, error, factor_spread(row), diameter)


def _used(row: PinResult, required: float) -> float:
    used = utilisation(row, required)
    return -math.inf if used is None else used[1]


def _diameter(row: PinResult, shape: PinShape | None) -> Diameter | None:
    """Return the diameter that a row needs; None where no law holds, or the outcome is
    not decided.
    """
    if shape is None or not row.safety_factor or row.verdict not in ("converged", "unconverged"):
        return None
    bands = [s[1] for s in shape.segments if s[4] == "band"]
    given = max(bands or [s[1] for s in shape.segments])
    eyes = [band.outer_diameter for band in row.joint.bands] if row.joint else []
    eye = min(eyes, default=None)
    if row.outcome in GOOD:
        return Diameter(given, None, None, eye)
    if row.outcome not in (FAILS, YIELDS, DEPENDS):
        return None
    scales = (_scale(row, whatever) for whatever in (False, True))
    needed, over_all = (given * scale if scale > NEAR_ENOUGH else None for scale in scales)
    # A row that depends is safe as described, apart from stress beneath contact.
    return Diameter(given, None if row.outcome == DEPENDS else needed, over_all, eye)


def diameter_law(row: PinResult) -> DiameterLaw:
    """Return the law by which the factors of a row, with its error, grow with all its diameters."""
    factor, beneath = factor_ends(row)[0], beneath_factor(row)
    pressure = (
        max((band.mean_pressure for band in row.joint.bands), default=0.0) if row.joint else 0.0
    )
    disc = disc_factor(row.yield_strength or 0.0, pressure, min(factor, beneath))
    return DiameterLaw(factor, beneath, row.exponent, disc)


def _scale(row: PinResult, whatever: bool) -> float:
    """Return the scale of all diameters at which a row reaches its factor.

    whatever: whether over all that is open.
    """
    law, required = diameter_law(row), row.required or 1.0
    scale = law.scale(required)
    spread = factor_spread(row)
    if not whatever or spread is None:
        return scale
    share = spread[0] / (row.safety_factor or 1.0)
    lowest = min((d.factor for d in row.depends_on), default=math.inf)
    over = DiameterLaw(math.inf, lowest, row.exponent)
    return max(scale, law.times(share).scale(required), over.scale(required))

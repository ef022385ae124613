"""Changes by which a pin reaches its factor of safety, in strength, diameters or loads.

Stress is proportional to the loads and, in a linear-elastic pin, does not depend on the strength.
An impulse acts together with the other loads, so its permissible time is found by superposing the
unit loads that are solved. Larger pins are solved again at the governing instant on the first mesh
only. The ratio of two such maxima is used, in which most of the error of the mesh cancels: a few
per cent remain (`pinstress size` solves them as a run does).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.core.solution import StressField
from fea.solve.single_mesh import ModelMesh, Problem, result_on
from fea.support.support import Solution
from geometry import GeometryError, Pin, body_of_revolution
from pinstress.analysis.remedies.secant import NoSizeError, smallest
from pinstress.study.model.pins import slenderness
from pinstress.study.model.tasks import Task
from reports.data.changes import Remedy

FIRST_RUNG = ModelMesh("harmonic")
FIRST_MESH_TOLERANCE = 0.04  # relative accuracy of a factor from the first mesh
# Shares of an impulse that are tried in each round, and rounds; each round refines the interval in
# which the limit lies.
IMPULSE_SHARES, SEARCH_ROUNDS = 17, 3
SIZED_BY_COMMAND = "diameters are found by pinstress size"
FROM_FILE = "its shape comes from a file, which has no diameters to change"


@dataclass(frozen=True)
class FailingCase:
    """A case whose factor is too small: its solution, and the permissible share of all loads
    (`permissible_share`).

    The share is for the stress at the upper end of its error, and for the stress beneath contact.
    """

    task: Task
    solution: Solution
    permissible_share: float


def change(requirement: Requirement, task: Task, solutions: tuple[Solution, ...]) -> Remedy | None:
    """Return the change that a pin needs in the worst of its cases.

    None if no case is below the required factor (yield if none is required), counting the error and
    the stress beneath contact; and for a hardened surface, whose case and core would change
    differently.
    """
    strength = None if task.material.hardened else task.material.yield_strength

    def required_of(solution: Solution) -> float:
        return requirement.of_case(solution.peak.case).required or 1.0

    worst = max(solutions, key=lambda s: _deciding_stress(s) * required_of(s))
    peak, required = worst.peak, required_of(worst)
    if strength is None or not peak.max_von_mises:
        return None
    if _deciding_stress(worst) <= strength / required:
        return None
    # With an unknown error, the stress itself is the best estimate of what would suffice.
    high = max(peak.upper_end if peak.bounded else peak.max_von_mises, _beneath(worst))
    failing = FailingCase(task, worst, strength / required / high)
    impulse = task.impulses.get(peak.case)
    problem = _problem(requirement, failing)
    times, why = _diameters(problem, failing, required)
    share = None if impulse is None else _share(failing, impulse.loads)
    return Remedy(
        pin=peak.pin,
        case=peak.case,
        required=required,
        yield_strength=required * high,
        load_factor=failing.permissible_share,
        proportional=not task.lugs,
        diameter_factor=times,
        diameter_note=why,
        impulse_time=None if impulse is None or not share else impulse.time / share,
        given_time=None if impulse is None else impulse.time,
        singular=peak.verdict == "singular",
    )


def _deciding_stress(solution: Solution) -> float:
    """Return the stress that decides whether a case fails, Pa: the larger of the maximum and the
    stress beneath contact.

    The maximum counts with its error unless it is singular or the error is unknown.
    """
    peak = solution.peak
    alone = peak.verdict == "singular" or not peak.bounded
    stress = peak.max_von_mises if alone else peak.upper_end
    return max(stress or 0.0, _beneath(solution))


def _beneath(solution: Solution) -> float:
    """Return the stress beneath contact with its error, Pa; 0 without contact."""
    contact = solution.peak.places and solution.peak.places.contact
    return contact.upper_end if contact else 0.0


def _share(failing: FailingCase, loads: PinLoads) -> float | None:
    """Return the share of an impulse's force that is permissible with the other loads; None if
    there is none.

    loads: two instants, without and with the impulse.
    """
    answer, whole = failing.solution.answer, failing.solution.peak.max_von_mises
    if answer is None or whole is None:
        return None
    if failing.task.lugs:
        return failing.permissible_share
    low, high = 0.0, 1.0
    for _ in range(SEARCH_ROUNDS):
        shares = np.linspace(low, high, IMPULSE_SHARES)
        bad = _maxima(answer, loads, shares) > failing.permissible_share * whole
        first = int(bad.argmax()) if bad.any() else IMPULSE_SHARES - 1
        if not first:
            return None
        low, high = float(shares[first - 1]), float(shares[first])
    return low


def _maxima(answer: StressField, loads: PinLoads, shares: Floats) -> Floats:
    part = shares[:, None, None]
    forces, moments = (x[0] + part * (x[1] - x[0]) for x in (loads.forces, loads.moments))
    body = np.broadcast_to(loads.body[0], (len(shares), 3))
    return answer.maxima(replace(loads, forces=forces, moments=moments, body=body))


def _problem(requirement: Requirement, failing: FailingCase) -> Problem | None:
    """Return the governing instant as a problem for one mesh; None for pins in lugs or with cuts,
    which would take too long.
    """
    task, loads = failing.task, failing.solution.peak.governing
    if task.lugs or not task.pin.revolved or loads is None:
        return None
    return Problem(task.pin, task.material, task.clamps, loads, requirement.distance)


def _diameters(
    problem: Problem | None, failing: FailingCase, required: float
) -> tuple[float | None, str]:
    """Return the factor on all diameters that suffices, or None and the reason.

    A pin must stay longer than wide.
    """
    pin = body_of_revolution(failing.task.pin)
    if failing.task.pin.profile is None or failing.task.pin.source:
        return None, FROM_FILE
    if problem is None or pin is None:
        return None, SIZED_BY_COMMAND
    try:
        return _widening(problem, pin, required * failing.permissible_share, required), ""
    except NoSizeError as error:
        return None, str(error)
    except (GeometryError, ArithmeticError) as error:
        return None, f"a larger pin fails: {error}"


def _widening(problem: Problem, pin: Pin, factor: float, required: float) -> float:
    """Return the factor by which all diameters must grow.

    Raises: NoSizeError, GeometryError, MeshError, SolveError.
    """
    most = slenderness(pin)
    if most <= 1.0:
        raise NoSizeError("it is wider than long already")
    before = result_on(problem, FIRST_RUNG).maximum

    def factor_at(scale: float) -> float:
        if scale == 1.0:
            return factor
        wide = replace(problem, pin=widened(pin, min(scale, most)))
        new_factor = factor * before / result_on(wide, FIRST_RUNG).maximum
        if scale > most and new_factor < required:
            raise NoSizeError(
                f"a pin as wide as long, {most:.2g} times its diameters, has a factor of only "
                f"{new_factor:.2g}: lengthen its bands, strengthen it or reduce its loads"
            )
        return new_factor

    return min(smallest(factor_at, required, close=FIRST_MESH_TOLERANCE).scale, most)


def widened(pin: Pin, scale: float) -> Pin:
    """Return the pin with its diameters, bores and fillets scaled; lengths stay."""
    segments = tuple(s.widened(lambda x: x * scale) for s in pin.segments)
    return replace(pin, segments=segments, fillet=pin.fillet * scale)

"""What would make a pin reach its factor of safety: stronger, larger, or loaded less.

Stress is proportional to the loads and, of a linear-elastic pin, does not depend on the strength.
An impulse acts with the other loads, so its permissible time is found by superposing the unit loads
that are solved. Larger pins are solved again at the governing instant on the first mesh only, and
the ratio of two such maxima is taken, in which most of the error of the mesh cancels: a few parts
in a hundred remain (`pinstress size` solves them as a run does).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.core.solution import StressField
from fea.solve.single_mesh import ModelMesh, Problem, result_on
from fea.support.support import Solution
from geometry import GeometryError, Pin
from pinstress.analysis.remedies.secant import NoSizeError, smallest
from pinstress.study.model.pins import slenderness
from pinstress.study.model.tasks import Task
from reports.data.changes import Remedy

FIRST_RUNG = ModelMesh("harmonic")
FIRST_MESH_TOLERANCE = 0.04  # of the factor: what the first mesh is worth
# Of an impulse tried at a time, each time between the last two
IMPULSE_SHARES, SEARCH_ROUNDS = 17, 3
SIZED_BY_COMMAND = "diameters are found by pinstress size"


@dataclass(frozen=True)
class FailingCase:
    """A case whose factor is too small: its solution, and what part of all loads is permissible, by
    the upper end of its stress where that is a range, and by what lies beneath contact.
    """

    task: Task
    solution: Solution
    part: float


def change(asked: Requirement, task: Task, solutions: tuple[Solution, ...]) -> Remedy | None:
    """What to change of a pin, for the worst of its cases; None where none is below the required
    factor (below yield where none is required) with its error, nor beneath contact.
    """
    strength, required = task.material.yield_strength, asked.required or 1.0
    worst = max(solutions, key=lambda s: max(s.peak.max_von_mises or 0.0, _beneath(s)))
    peak = worst.peak
    if strength is None or not peak.max_von_mises:
        return None
    stress = peak.max_von_mises if peak.verdict == "singular" else peak.upper_end
    if max(stress, _beneath(worst)) <= strength / required:
        return None
    high = max(peak.upper_end, _beneath(worst))
    failing = FailingCase(task, worst, strength / required / high)
    impulse = task.impulses.get(peak.case)
    problem = _problem(asked, failing)
    times, why = _diameters(problem, failing, required)
    share = None if impulse is None else _share(failing, impulse.loads)
    return Remedy(
        pin=peak.pin,
        case=peak.case,
        required=required,
        yield_strength=required * high,
        load_factor=failing.part,
        proportional=not task.lugs,
        diameter_factor=times,
        diameter_note=why,
        impulse_time=None if impulse is None or not share else impulse.time / share,
        given_time=None if impulse is None else impulse.time,
        singular=peak.verdict == "singular",
    )


def _beneath(solution: Solution) -> float:
    """What lies beneath contact with its error, Pa; 0 without any."""
    contact = solution.peak.places and solution.peak.places.contact
    return contact.upper_end if contact else 0.0


def _share(failing: FailingCase, loads: PinLoads) -> float | None:
    """The part of an impulse's force that is permissible with the other loads. loads: without and
    with the impulse.
    """
    answer, whole = failing.solution.answer, failing.solution.peak.max_von_mises
    if answer is None or whole is None:
        return None
    if failing.task.lugs:
        return failing.part
    low, high = 0.0, 1.0
    for _ in range(SEARCH_ROUNDS):
        shares = np.linspace(low, high, IMPULSE_SHARES)
        bad = _maxima(answer, loads, shares) > failing.part * whole
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


def _problem(asked: Requirement, failing: FailingCase) -> Problem | None:
    """The governing instant on one mesh; None where contact or a solid would take too long."""
    task, loads = failing.task, failing.solution.peak.governing
    if task.lugs or not isinstance(task.pin, Pin) or loads is None:
        return None
    return Problem(task.pin, task.material, task.clamps, loads, asked.distance)


def _diameters(
    problem: Problem | None, failing: FailingCase, required: float
) -> tuple[float | None, str]:
    """By how much all diameters must be larger, or why no pin does that is longer than wide."""
    pin = failing.task.pin
    if problem is None or not isinstance(pin, Pin):
        return None, SIZED_BY_COMMAND
    try:
        return _widening(problem, pin, required * failing.part, required), ""
    except NoSizeError as error:
        return None, str(error)
    except (GeometryError, ArithmeticError) as error:
        return None, f"a larger pin fails: {error}"


def _widening(problem: Problem, pin: Pin, factor: float, required: float) -> float:
    """By how much all diameters must be larger. Raises: NoSizeError, GeometryError, MeshError,
    SolveError.
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
    """The pin with its diameters, bores and fillets scaled; lengths stay."""
    segments = tuple(s.widened(lambda x: x * scale) for s in pin.segments)
    return replace(pin, segments=segments, fillet=pin.fillet * scale)

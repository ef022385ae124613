"""The ladder of models: the smallest that answers, on meshes as fine as it takes.

beam      where its error is enough to decide                   (fea.beam_error)
harmonic  any body of revolution                                (fea.harmonic_look)
solid     any other body, and to check the others               (fea.solid_look)
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from fea.answer import Answer
from fea.balance import Balance, out_of_balance
from fea.beam_answer import BeamAnswer
from fea.beam_error import PLAIN
from fea.harmonic_look import HarmonicAnswer, HarmonicSolution, harmonic_look, harmonic_solution
from fea.look import Look
from fea.material import Material
from fea.memory import too_much
from fea.peak import Peak
from fea.pin_loads import PinLoads
from fea.solid_look import SolidAnswer, solid_look, solid_solution
from fea.verdict import FEWEST, Seen, judge
from fea.zones import Place, singular_places
from geometry import Pin, PinLike
from geometry.solid_mesh import MeshSize

Model = Literal["auto", "beam", "harmonic", "solid"]
Goal = Literal["value", "decide"]
Progress = Callable[[str], None]

STEP = 2.0**0.5  # from one mesh to the next
HALF = 2.0  # the same where the mesh is given
MESHES = {"harmonic": 7, "solid": 4}
MOST_UNKNOWNS = {"harmonic": 60_000, "solid": 300_000}
GROWTH = {"harmonic": 2.0, "solid": 3.0}  # power of the ratio with which unknowns grow
TELL = 1e-6  # of the largest load: what bands take up to close the balance is told from here on


@dataclass(frozen=True)
class Asked:
    """What is wanted: the maximum to a `tolerance`, or (goal "decide") only on which side of the
    `required` factor of safety it is. distance: of the local diameter, that is excluded at corners
    and edges of clamps. meshes: at most so many, as the model has it by default. memory: MB that a
    solid may take, by default most of what is free.
    """

    tolerance: float = 0.02
    model: Model = "auto"
    goal: Goal = "value"
    required: float | None = None
    distance: float = 0.1
    meshes: int | None = None
    memory: float | None = None


@dataclass(frozen=True)
class Solution:
    """A peak and what it came from; no answer for a pin that is not held."""

    peak: Peak
    answer: Answer | None


def solve_pin(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    asked: Asked = Asked(),
    progress: Progress = lambda _: None,
) -> tuple[Solution, ...]:
    """Solutions of a pin's cases, one each. clamps: surfaces (by the pin's names) that are held.

    Raises: ValueError for a model that cannot take this pin; MeshError, SolveError.
    """
    if asked.model in ("beam", "harmonic") and not isinstance(pin, Pin):
        raise ValueError(
            f"pin {pin.name} is no body of revolution: only the solid model can take it"
        )
    job = _Job(pin, material, tuple(pin.surface(name) for name in clamps), asked, progress)
    balances = {} if clamps else {c.case: out_of_balance(pin, c, material.density) for c in cases}
    notes = {case: _closing(pin, balance) for case, balance in balances.items()}
    out: dict[str, Solution] = {}
    for case, balance in balances.items():
        if balance.refusal:
            peak = Peak(pin.name, case, asked.model, "rigid", balance.refusal)
            out[case] = Solution(peak, None)
    live = tuple(c for c in cases if c.case not in out)
    if isinstance(pin, Pin) and asked.model in ("auto", "beam"):
        out |= _beam(job, pin, live, notes)
        live = tuple(c for c in live if c.case not in out)
    if live:
        model: Literal["harmonic", "solid"]
        model = "solid" if asked.model == "solid" or not isinstance(pin, Pin) else "harmonic"
        out |= _refined(job, model, live, notes)
    return tuple(out[c.case] for c in cases)


@dataclass(frozen=True)
class _Job:
    pin: PinLike
    material: Material
    held: tuple[str, ...]
    asked: Asked
    progress: Progress


def ratio_of(pin: PinLike) -> float:
    """From one mesh of a pin to the next."""
    return HALF if pin.meshed else STEP


def unknowns_after(pin: PinLike, model: str, unknowns: int) -> float:
    """Of the mesh that comes after one with so many, roughly."""
    grown: float = ratio_of(pin) ** GROWTH[model]
    return unknowns * grown


def decided(asked: Asked, material: Material, maximum: float, error: float) -> bool:
    """Whether the interval of the factor of safety is all on one side of what is required."""
    strength, required = material.yield_strength, asked.required
    if asked.goal != "decide" or strength is None or required is None:
        return False
    limit = strength / required
    return maximum + error < limit or maximum - error > limit


def places_of(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    distance: float = 0.1,
) -> tuple[Place, ...]:
    """Where stress has no bound in any of the cases; of a body of revolution only."""
    if not isinstance(pin, Pin):
        return ()
    acting = {load for case in cases for load in case.coefficients() if load.shears}
    loaded = {load.surface for load in acting}
    if acting and not clamps:  # the balance is closed on all bands
        loaded |= set(pin.connections)
    nu = material.poisson_ratio
    return singular_places(pin, clamps, tuple(sorted(loaded)), nu, distance)


def _places(job: _Job, cases: tuple[PinLoads, ...]) -> tuple[Place, ...]:
    return places_of(job.pin, job.material, job.held, cases, job.asked.distance)


def _beam(
    job: _Job, pin: Pin, cases: tuple[PinLoads, ...], notes: dict[str, str]
) -> dict[str, Solution]:
    """What beams can answer; all cases if no other model is to be asked."""
    asked = job.asked
    if asked.model == "auto" and asked.goal == "value" and asked.tolerance < PLAIN:
        return {}  # a beam is never that exact
    out = {}
    for case in cases:
        places = _places(job, (case,)) if asked.model == "auto" else ()
        if any(p.kind != "edge of a load" for p in places):
            continue  # no maximum where beams know none
        start = time.perf_counter()
        answer = BeamAnswer(pin, job.material, job.held, case)
        found = answer.estimate
        peak = answer.peak(asked.tolerance, time.perf_counter() - start, notes.get(case.case, ""))
        why = "beam: asked for"
        if asked.model == "auto":
            if found.error is None:
                continue
            if decided(job.asked, job.material, found.maximum, found.error):
                why = "beam: the required factor lies outside of what its error leaves open"
            elif peak.verdict == "converged":
                why = "beam: its error is within the tolerance"
            else:
                continue
        out[case.case] = Solution(replace(peak, why=why), answer)
    return out


def _refined(
    job: _Job,
    model: Literal["harmonic", "solid"],
    cases: tuple[PinLoads, ...],
    notes: dict[str, str],
) -> dict[str, Solution]:
    """Finer and finer meshes until every case is known or decided, or a limit is met."""
    pin, asked = job.pin, job.asked
    ratio = ratio_of(pin)
    places = _places(job, cases)
    own = {case.case: _places(job, (case,)) for case in cases}
    seen: dict[str, Seen] = {}
    answers: dict[str, Answer] = {}
    for level in range(asked.meshes or MESHES[model]):
        largest = max((s.looks[-1].unknowns for s in seen.values()), default=0)
        finer = unknowns_after(pin, model, largest)
        if level and finer > MOST_UNKNOWNS[model]:
            break
        if level and model == "solid" and (told := too_much(finer, asked.memory)):
            told = f"; on the next mesh {told}: allow more, or ask for a larger --tolerance"
            notes = {case: notes.get(case, "") + told for case in own}
            break
        job.progress(f"pin {pin.name}, {model} model, mesh {level + 1}")
        start = time.perf_counter()
        look: Callable[[PinLoads], Look]
        if model == "harmonic":
            assert isinstance(pin, Pin)
            last = [s.looks[-1] for s in seen.values()]
            section = harmonic_solution(
                pin, job.material, job.held, cases, places, level, ratio, last
            )
            found, look = places, partial(_own_look, section, places, own)
            answers = {case: HarmonicAnswer(section, mine) for case, mine in own.items()}
        else:
            size = MeshSize().finer(ratio**level)
            solid = solid_solution(
                pin,
                job.material,
                job.held,
                cases,
                places,
                size,
                asked.distance,
                memory=asked.memory,
            )
            before = {case: s.looks[-1] for case, s in seen.items()}
            found, look = solid.places, partial(solid_look, solid, before, ratio)
            answers = dict.fromkeys(own, SolidAnswer(solid))
        for case in cases:
            now = look(case)
            spent = time.perf_counter() - start
            seen[case.case] = _with(
                seen.get(case.case), pin.name, case.case, model, now, spent, ratio
            )
            start = time.perf_counter()
        if all(enough(asked, job.material, s) for s in seen.values()):
            break
    why = _why(job, model)
    peaks = {
        case: judge(s, found, asked.tolerance, notes.get(case, "")) for case, s in seen.items()
    }
    return {
        case: Solution(replace(peak, why=why(seen[case], peak)), answers[case])
        for case, peak in peaks.items()
    }


def _own_look(
    section: HarmonicSolution,
    places: tuple[Place, ...],
    own: Mapping[str, tuple[Place, ...]],
    case: PinLoads,
) -> Look:
    return harmonic_look(section, places, case, own[case.case])


def _with(
    seen: Seen | None, pin: str, case: str, model: str, look: Look, spent: float, ratio: float
) -> Seen:
    looks, seconds = ((), ()) if seen is None else (seen.looks, seen.seconds)
    return Seen(pin, case, model, (*looks, look), (*seconds, spent), ratio)


def enough(asked: Asked, material: Material, seen: Seen) -> bool:
    """Whether these meshes answer what was asked."""
    if len(seen.looks) < FEWEST:
        return False
    maximum = seen.looks[-1].maximum
    return seen.known(asked.tolerance) or decided(asked, material, maximum, seen.error)


def _why(job: _Job, model: str) -> Callable[[Seen, Peak], str]:
    def told(seen: Seen, peak: Peak) -> str:
        if job.asked.model == model:
            chosen = f"{model}: asked for"
        elif model == "solid":
            chosen = "solid: the pin is no body of revolution"
        elif job.asked.goal == "decide":
            chosen = "harmonic: a beam's error leaves the required factor open"
        elif job.asked.tolerance < PLAIN:
            chosen = f"harmonic: a beam is never known to {job.asked.tolerance:.1%}"
        else:
            chosen = f"harmonic: no beam knows this maximum to {job.asked.tolerance:.1%}"
        if seen.known(job.asked.tolerance):
            return f"{chosen}; its error is within the tolerance on {len(seen.looks)} meshes"
        if decided(job.asked, job.material, peak.max_von_mises or 0.0, seen.error):
            return f"{chosen}; its error leaves no doubt on which side of the required factor it is"
        return f"{chosen}; the largest mesh allowed does not reach the tolerance"

    return told


def _closing(pin: PinLike, balance: Balance) -> str:
    """What the bands take up beside the loads, as the end of a note; empty when nothing."""
    if not balance.largest:
        return ""
    force = balance.force / balance.largest
    couple = balance.couple / balance.largest / pin.length
    if max(force, couple) < TELL:
        return ""
    return (
        f"; its bands close the balance, a force of {force:.2g} of the largest load and a couple "
        f"of {couple:.2g} of that times the length"
    )

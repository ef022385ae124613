"""The ladders of meshes of a chart: which are climbed, how far, and what they are measured by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from fea.ladder import MESHES, MOST_UNKNOWNS, STEP, Asked, enough
from fea.linear import SolveError
from fea.look import Look
from fea.rungs import Problem, Rung
from fea.verdict import Seen
from geometry import Pin
from geometry.elements import Element
from pinstress.own_process import Job, Measure, Measured

HARMONIC = (-4, -2, 0, 1, 2, 3)  # levels of meshes (fea.rungs)
FIRST: dict[Element, int] = {"linear": -1, "straight": -3, "curved": -3}
USUAL, FEWEST = 5, 4  # meshes of an element, however large
MOST = 150_000  # unknowns of a solid that is charted; of one that has no other reference:
MOST_BELOW_REFERENCE = 50_000
MOST_OF_REFERENCE = 400_000
ORDER = 10.0  # times the unknowns of the finest that is charted
FEWEST_OF_REFERENCE = 3


@dataclass
class Climb:
    """Rungs climbed so far, in their order. auto: the model that it chooses."""

    problem: Problem
    asked: Asked
    auto: str
    measure: Measure
    runs: int
    tell: Callable[[str], None]
    done: list[tuple[Rung, Measured]] = field(default_factory=list)

    def to(self, rung: Rung, keep: bool = True) -> Measured:
        """Climb a rung; `keep` it as a point of the chart."""
        self.tell(f"{rung.model} model")
        below = self.looks(rung) if rung.model == "harmonic" and rung.level > 0 else ()
        if not keep:  # refined everywhere: it is what the others are measured by
            below = tuple(replace(look, high=()) for look in below)
        runs = self.runs if keep else 1
        found = self.measure(Job(self.problem, rung, below[-1:], runs, reference=not keep))
        if keep:
            self.done.append((rung, found))
        return found

    def drop_repeated(self) -> None:
        """Leave out the last but one where the last is the same mesh, which places that need small
        elements keep from being coarser.
        """
        (_, one), (_, two) = self.done[-2:]
        if one.look and two.look and one.look.unknowns == two.look.unknowns:
            del self.done[-2]

    def looks(self, like: Rung) -> tuple[Look, ...]:
        """Of the same model and element, from a run's first mesh on."""
        return tuple(
            m.look for r, m in self.done
            if (r.model, r.element) == (like.model, like.element) and r.level >= 0 and m.look
        )  # fmt: skip

    def enough(self, model: str, looks: tuple[Look, ...]) -> bool:
        """Whether a run of the model would end here."""
        return enough(self.asked, self.problem.material, self.seen(model, looks))

    def seen(self, model: str, looks: tuple[Look, ...], first: int = 0) -> Seen:
        """Successive meshes as a run sees them."""
        ratio = 2.0 if self.problem.pin.meshed else STEP
        name, case = self.problem.pin.name, self.problem.loads.case
        return Seen(name, case, model, looks, (0.0,) * len(looks), ratio, first)


def climb_harmonic(climb: Climb) -> None:
    """The usual levels, and on to where `auto` ends."""
    for level in HARMONIC:
        found = climb.to(Rung("harmonic", level=level))
        climb.drop_repeated()
    while (
        climb.auto == "harmonic"
        and found.look is not None
        and level + 1 < MESHES["harmonic"]
        and found.look.unknowns * STEP**2 <= MOST_UNKNOWNS["harmonic"]
        and not climb.enough("harmonic", climb.looks(Rung("harmonic")))
    ):
        level += 1
        found = climb.to(Rung("harmonic", level=level))


def climb_solid(climb: Climb, element: Element, meshes: int | None) -> None:
    """Finer and finer meshes, as many as asked for or until they get large, or pass a limit."""
    pin = climb.problem.pin
    step = 2 if pin.meshed else 1  # it can only be halved
    first = 0 if pin.meshed else FIRST[element]
    most = MOST if isinstance(pin, Pin) else MOST_BELOW_REFERENCE
    for k in range(meshes or USUAL):
        found = climb.to(Rung("solid", element, first + step * k))
        if found.over:
            return
        growth = STEP ** (3 * step)
        few = meshes or (2 if pin.meshed else FEWEST)
        if found.look is not None and k + 1 >= few and found.look.unknowns * growth > most:
            return


def harmonic_reference(climb: Climb) -> tuple[Rung, Seen]:
    """Finer and finer than the finest that is charted, until an order larger."""
    level, charted = _finest(climb, "harmonic")
    looks: list[Look] = []
    while len(looks) < FEWEST_OF_REFERENCE or looks[-1].unknowns < ORDER * charted[-1].unknowns:
        level += 1
        found = climb.to(Rung("harmonic", level=level), keep=False)
        if found.look is None:
            raise SolveError(f"the reference, harmonic mesh {level + 1}: {found.failed}")
        looks.append(found.look)
        if looks[-1].unknowns > MOST_OF_REFERENCE:
            break
    first = level - len(looks) + 1
    return Rung("harmonic", level=level), climb.seen("harmonic", tuple(looks), first)


def solid_reference(climb: Climb) -> tuple[Rung, Seen]:
    """The solid model on finer meshes than are charted, as far as its unknowns allow."""
    level, charted = _finest(climb, "solid")
    looks = list(charted)
    step = 2 if climb.problem.pin.meshed else 1
    while (
        looks[-1].unknowns < ORDER * charted[-1].unknowns
        and looks[-1].unknowns * STEP ** (3 * step) <= MOST_OF_REFERENCE
    ):
        found = climb.to(Rung("solid", "curved", level + step), keep=False)
        if found.look is None:
            break
        looks.append(found.look)
        level += step
    if len(looks) == len(charted):
        raise SolveError("no solid mesh finer than those charted could be solved as a reference")
    return Rung("solid", "curved", level), climb.seen("solid", tuple(looks))


def _finest(climb: Climb, model: str) -> tuple[int, tuple[Look, ...]]:
    """The finest level of a model's best element, and all its looks.

    Raises: SolveError when there is none.
    """
    of_it = [(r.level, m) for r, m in climb.done if r.model == model and r.element == "curved"]
    looks = tuple(m.look for _, m in of_it if m.look)
    if not looks:
        raise SolveError(f"no mesh of the {model} model could be solved: {of_it[0][1].failed}")
    return max(level for level, m in of_it if m.look), looks


def chosen(climb: Climb) -> Rung | None:
    """Where `auto` ends; None where it goes on to finer meshes than there are here."""
    model = climb.auto
    if model == "beam":
        return Rung("beam")
    of_it = [
        r for r, m in climb.done
        if r.model == model and r.element == "curved" and r.level >= 0 and m.look
    ]  # fmt: skip
    looks = climb.looks(Rung(model, "curved"))  # type: ignore[arg-type]
    for n, rung in enumerate(of_it, 1):
        if climb.enough(model, looks[:n]):
            return rung
    return of_it[-1] if model == "harmonic" and of_it else None

"""The mesh sequences of a chart: the meshes that are solved, their limits, and the references."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from fea.core.linear_solver import SolveError
from fea.core.mesh_history import MeshHistory
from fea.core.mesh_result import MeshMaximum
from fea.core.requirement import Requirement, accurate_enough
from fea.cut.evaluate import LOCAL_MESHES
from fea.harmonic.evaluate import SECTION_MESHES
from fea.solve.refine import LOCAL_MODEL, MESH_RATIO, sequence_of
from fea.solve.single_mesh import ModelMesh, Problem
from geometry.mesh.elements import Element
from pinstress.explore.chart.measured_process import Measure, Measured, MeasureJob
from pinstress.explore.chart.single_joint import JointProblem, JointRung

HARMONIC_LEVELS = (-4, -2, 0, 1, 2, 3)  # levels of meshes (fea.solve.single_mesh)
FIRST_SOLID_LEVEL: dict[Element, int] = {"linear": -1, "straight": -3, "curved": -3}
# Default and smallest number of meshes of a solid element, however large
SOLID_MESHES, MIN_SOLID_MESHES = 5, 4
MAX_CHARTED_UNKNOWNS = 150_000  # largest number of unknowns of a charted solid
MAX_UNKNOWNS_BELOW_REFERENCE = 50_000  # the same if only a finer solid can be the reference
MAX_REFERENCE_UNKNOWNS = 400_000
REFERENCE_UNKNOWNS_RATIO = 10.0  # unknowns of the reference over those of the finest charted mesh
MIN_REFERENCE_MESHES = 3
ADAPTIVE_MODELS = "harmonic", LOCAL_MODEL, "contact"  # finer meshes where stress is high


@dataclass
class Climb:
    """The sequence of meshes solved so far.

    auto: the model that is chosen automatically.
    """

    problem: Problem | JointProblem
    requirement: Requirement
    auto: str
    measure: Measure
    runs: int
    tell: Callable[[str], None]
    done: list[tuple[ModelMesh | JointRung, Measured]] = field(default_factory=list)

    def to(self, rung: ModelMesh | JointRung, keep: bool = True) -> Measured:
        """Solve a mesh; keep: whether it becomes a point of the chart."""
        self.tell(f"{rung.model} model")
        below = self.results(rung) if rung.model in ADAPTIVE_MODELS and rung.level > 0 else ()
        if not keep:  # the reference is refined everywhere
            below = tuple(replace(result, high=()) for result in below)
        runs = self.runs if keep and rung.model != "calculix" else 1
        measured = self.measure(
            MeasureJob(self.problem, rung, below[-1:], runs, reference=not keep)
        )
        if keep:
            self.done.append((rung, measured))
        return measured

    def drop_repeated(self) -> None:
        """Drop the last mesh but one if the last has the same number of unknowns. This happens
        where places that need small elements keep a mesh from being coarser.
        """
        (_, one), (_, two) = self.done[-2:]
        if one.result and two.result and one.result.unknowns == two.result.unknowns:
            del self.done[-2]

    def results(self, like: ModelMesh | JointRung) -> tuple[MeshMaximum, ...]:
        """Return the results of the same model and element, from the first mesh of a run on."""
        return tuple(
            m.result for r, m in self.done
            if (r.model, r.element) == (like.model, like.element) and r.level >= 0 and m.result
        )  # fmt: skip

    def enough(self, model: str, results: tuple[MeshMaximum, ...]) -> bool:
        """Whether a run of the model would end here."""
        return accurate_enough(self.requirement, self.problem.material, self.seen(model, results))

    def seen(self, model: str, results: tuple[MeshMaximum, ...], first: int = 0) -> MeshHistory:
        """Return successive meshes as a history, as a run sees them."""
        meshes = sequence_of(self.problem.pin, model)
        assert meshes is not None, model
        name, case = self.problem.pin.name, self.problem.loads.case
        return MeshHistory(name, case, model, results, (0.0,) * len(results), meshes, first)


def climb_harmonic(climb: Climb) -> None:
    """Solve the usual levels, and further ones until the level at which a run would end."""
    for level in HARMONIC_LEVELS:
        measured = climb.to(ModelMesh("harmonic", level=level))
        climb.drop_repeated()
    while (
        climb.auto == "harmonic"
        and measured.result is not None
        and level + 1 < SECTION_MESHES.max_meshes
        and measured.result.unknowns * MESH_RATIO**2 <= SECTION_MESHES.max_unknowns
        and not climb.enough("harmonic", climb.results(ModelMesh("harmonic")))
    ):
        level += 1
        measured = climb.to(ModelMesh("harmonic", level=level))


def climb_local(climb: Climb) -> None:
    """Solve all meshes that a run may make."""
    for level in range(LOCAL_MESHES.max_meshes):
        climb.to(ModelMesh(LOCAL_MODEL, level=level))


def climb_solid(climb: Climb, element: Element, meshes: int | None) -> None:
    """Solve increasingly fine meshes: as many as requested, or until they become too large or
    exceed a limit.
    """
    pin = climb.problem.pin
    step = 2 if pin.meshed else 1  # a given mesh can only be refined by halving its elements
    first = 0 if pin.meshed else FIRST_SOLID_LEVEL[element]
    most = MAX_CHARTED_UNKNOWNS if pin.revolved else MAX_UNKNOWNS_BELOW_REFERENCE
    for k in range(meshes or SOLID_MESHES):
        measured = climb.to(ModelMesh("solid", element, first + step * k))
        if measured.over:
            return
        growth = MESH_RATIO ** (3 * step)
        few = meshes or (2 if pin.meshed else MIN_SOLID_MESHES)
        if (
            measured.result is not None
            and k + 1 >= few
            and measured.result.unknowns * growth > most
        ):
            return


def harmonic_reference(climb: Climb) -> tuple[ModelMesh, MeshHistory]:
    """Solve meshes finer than the finest charted one, until one is larger by an order of
    magnitude, and return the last mesh and the mesh history.

    Raises: SolveError if a mesh cannot be solved.
    """
    level, charted = _finest(climb, "harmonic")
    results: list[MeshMaximum] = []
    while (
        len(results) < MIN_REFERENCE_MESHES
        or results[-1].unknowns < REFERENCE_UNKNOWNS_RATIO * charted[-1].unknowns
    ):
        level += 1
        measured = climb.to(ModelMesh("harmonic", level=level), keep=False)
        if measured.result is None:
            raise SolveError(
                f"the reference, harmonic mesh {level + 1}: {measured.failed}", code="no-reference"
            )
        results.append(measured.result)
        if results[-1].unknowns > MAX_REFERENCE_UNKNOWNS:
            break
    first = level - len(results) + 1
    return ModelMesh("harmonic", level=level), climb.seen("harmonic", tuple(results), first)


def local_reference(climb: Climb) -> tuple[ModelMesh, MeshHistory]:
    """Solve one mesh beyond the charted ones, with nearly twice the unknowns of the last one.

    Raises: SolveError if it cannot be solved.
    """
    level, charted = _finest(climb, LOCAL_MODEL)
    finer = ModelMesh(LOCAL_MODEL, level=level + 1)
    measured = climb.measure(MeasureJob(climb.problem, finer, charted[-1:], 1, reference=True))
    if measured.result is None:
        raise SolveError(f"the reference: {measured.failed}", code="no-reference")
    return ModelMesh(LOCAL_MODEL, level=level + 1), climb.seen(
        LOCAL_MODEL, (*charted, measured.result)
    )


def solid_reference(climb: Climb) -> tuple[ModelMesh, MeshHistory]:
    """Solve the solid model on finer meshes than the charted ones, as far as the number of unknowns
    allows.

    Raises: SolveError if no finer mesh could be solved.
    """
    level, charted = _finest(climb, "solid")
    results = list(charted)
    step = 2 if climb.problem.pin.meshed else 1
    while (
        results[-1].unknowns < REFERENCE_UNKNOWNS_RATIO * charted[-1].unknowns
        and results[-1].unknowns * MESH_RATIO ** (3 * step) <= MAX_REFERENCE_UNKNOWNS
    ):
        measured = climb.to(ModelMesh("solid", "curved", level + step), keep=False)
        if measured.result is None:
            break
        results.append(measured.result)
        level += step
    if len(results) == len(charted):
        raise SolveError(
            "no solid mesh finer than those charted could be solved as a reference",
            code="no-reference",
        )
    return ModelMesh("solid", "curved", level), climb.seen("solid", tuple(results))


def _finest(climb: Climb, model: str) -> tuple[int, tuple[MeshMaximum, ...]]:
    """Return the finest level of a model's best element, and all its mesh results.

    Raises: SolveError if there is none.
    """
    of_it = [(r.level, m) for r, m in climb.done if r.model == model and r.element == "curved"]
    results = tuple(m.result for _, m in of_it if m.result)
    if not results:
        raise SolveError(
            f"no mesh of the {model} model could be solved: {of_it[0][1].failed}",
            code="no-mesh-solved",
        )
    return max(level for level, m in of_it if m.result), results


def chosen(climb: Climb) -> ModelMesh | JointRung | None:
    """Return the mesh on which a run with the automatic choice ends; None if that run continues to
    finer meshes than are solved here.
    """
    model = climb.auto
    if model == "beam":
        return ModelMesh("beam")
    of_it = [
        r for r, m in climb.done
        if r.model == model and r.element == "curved" and r.level >= 0 and m.result
    ]  # fmt: skip
    results = climb.results(ModelMesh(model, "curved"))  # type: ignore[arg-type]
    for n, rung in enumerate(of_it, 1):
        if climb.enough(model, results[:n]):
            return rung
    return of_it[-1] if model in ADAPTIVE_MODELS and of_it else None

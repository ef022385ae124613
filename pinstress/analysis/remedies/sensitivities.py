"""Sensitivities of a pin's factor of safety, i.e. its derivatives with respect to dimensions, loads
and material.

They are derivatives of the stress that the row reports: of the section's where it governs,
otherwise of the surface's on its own mesh (assess.derivatives). For a beam, the derivatives on the
first mesh of the harmonic model are scaled to the beam's maximum.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from assess.derivatives.derivatives import derivatives
from assess.derivatives.in_section import section_derivatives
from assess.derivatives.records import Derivatives, SolvedCase
from fea.beam.model import BeamField
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.places import Place
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.singular.singularities import singularities_of
from fea.solve.refine import MESH_RATIO
from fea.support.support import Solution
from geometry import body_of_revolution
from geometry.mesh.gmsh_session import MeshError
from geometry.shape.dimensions import Dimension
from pinbase.arrays import Floats
from pinbase.keys import key_part
from pinstress.analysis.remedies.dimensions import dimensions_of
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from reports.data.sensitivities import PinSensitivities, Sensitivity

if TYPE_CHECKING:
    from assess.derivatives.in_lugs import JointDerivatives, JointParameter
    from pinstress.analysis.remedies.joint_parameters import StudyParameter

MAX_STEP_FRACTION = 0.1  # the largest step of a dimension over the dimension
STEP_FRACTION = 0.01  # step of any other parameter over its value; of a force, over the largest one
POISSON_RATIO_STEP = 0.01
CLEARANCE_STEP = 0.01  # step of a clearance over the step of a dimension
IN_LUGS_NOTE = (
    "held by lugs in contact; derivatives, which take about as long as the solution, "
    "by --sensitivities"
)
NO_CONTACT_NOTE = 'no derivatives of a pin on foundations: analysis.joints = "contact" has them'
HARDENED_NOTE = "not for a pin with a hardened surface, whose case and core have two strengths"
NOT_AXISYMMETRIC_NOTE = "no derivatives, only of bodies of revolution: solve the changed study"


def sensitivities(
    study: Study,
    requirement: Requirement,
    task: Task,
    solutions: Iterable[Solution],
    step: float,
    every: bool = False,
) -> tuple[PinSensitivities, ...]:
    """Return the sensitivities of a task's worst case, or of every case.

    step: the change of a dimension (m) whose effect is shown. It is divided by powers of ten until
    it is at most MAX_STEP_FRACTION of the dimension.
    every: whether to return every case, and the derivatives of pins in lugs, which take long.
    """
    ranked = sorted((s for s in solutions if _largest(s)), key=lambda s: _largest(s), reverse=True)
    dimensions = tuple(dimensions_of(study, task.pin))
    return tuple(
        _of_lugs(study, task, s, step if every else None)
        if task.lugs
        else _of_case(requirement, task, s, dimensions, step)
        for s in ranked[: None if every else 1]
    )


def _largest(solution: Solution) -> float:
    return solution.peak.max_von_mises or 0.0


def differentiated_in_lugs(
    joined: Solution,
    task: Task,
    parameters: Iterable[JointParameter],
    *,
    alone: bool = False,
    place: Place | None = None,
) -> JointDerivatives | None:
    """Return the derivatives of the maximum of a pin in contact, or of the stress at a place, at
    the row's governing instant; None if the row has no maximum or no harmonic model.

    alone: differentiate with respect to the parameters only, not the loads.
    place: where the stress is differentiated; by default where it governs.

    Raises: MeshError, SolveError.
    """
    from assess.derivatives.in_lugs import joint_derivatives
    from fea.support.contact.held import HeldContact

    solution, held, rings = joined, joined.held, joined.rings
    peak, answer = solution.peak, solution.answer
    if rings is None or peak.governing is None or not peak.max_von_mises:
        return None
    assert isinstance(held, HeldContact)
    if not isinstance(answer, HarmonicField):
        return None
    solved = SolvedCase(
        rings,
        task.material,
        (),
        solution.loads.at(np.array([solution.instant])),
        answer.solution,
        answer.singularities,
        (peak.own_error or 0.0) / peak.max_von_mises,
        solution.loads,
    )
    links = peak.governing
    return joint_derivatives(
        solved, held.model, links, parameters, alone=alone, place=place or governing_place(peak)
    )


def governing_place(peak: Maximum) -> Place:
    """Return the place that has the maximum stress."""
    return "surface" if peak.places is None else peak.places.governs


def differentiated(
    requirement: Requirement, task: Task, solution: Solution, dimensions: tuple[Dimension, ...]
) -> Derivatives | None:
    """Return the derivatives of a solution's maximum, or None if it has none.

    Raises: MeshError, SolveError.
    """
    peak, pin, answer = solution.peak, body_of_revolution(task.pin), solution.answer
    if not peak.max_von_mises or peak.governing is None or pin is None:
        return None
    clamps = tuple(pin.surface(name) for name in task.clamps)
    error, history = (peak.own_error or 0.0) / peak.max_von_mises, None
    by_section = governing_place(peak) == "section"
    if isinstance(answer, HarmonicField):
        section, zones, history = answer.solution, answer.singularities, solution.loads
    elif isinstance(answer, BeamField):
        case = (peak.governing,)
        zones = singularities_of(pin, task.material, clamps, case, requirement.distance)
        section = harmonic_solution(
            SectionProblem(pin, task.material, clamps, case, zones), 0, MESH_RATIO
        )
    else:
        return None
    solved = SolvedCase(pin, task.material, clamps, peak.governing, section, zones, error, history)
    if by_section:
        return section_derivatives(solved, dimensions)
    return scaled(derivatives(solved, dimensions), peak.max_von_mises)


def scaled(gradient: Derivatives, maximum: float) -> Derivatives:
    """Return derivatives with the same relative values for another maximum, Pa."""
    times = maximum / gradient.maximum
    if times == 1.0:
        return gradient
    return replace(
        gradient,
        maximum=maximum,
        by_dimension={key: times * x for key, x in gradient.by_dimension.items()},
        by_force={key: times * x for key, x in gradient.by_force.items()},
        by_moment={key: times * x for key, x in gradient.by_moment.items()},
        poisson_ratio=times * gradient.poisson_ratio,
        density=times * gradient.density,
    )


def _of_case(
    requirement: Requirement,
    task: Task,
    solution: Solution,
    dimensions: tuple[Dimension, ...],
    step: float,
) -> PinSensitivities:
    peak = solution.peak
    maximum = peak.max_von_mises or 0.0
    factor = peak.safety_factor(task.material.yield_strength)
    out = PinSensitivities(peak.pin, peak.case, maximum, factor)
    if task.material.hardened:
        return replace(out, note=HARDENED_NOTE)
    if not task.pin.revolved:
        return replace(out, note=NOT_AXISYMMETRIC_NOTE)
    try:
        gradient = differentiated(requirement, task, solution, dimensions)
    except (MeshError, SolveError) as error:
        return replace(out, note=f"no derivatives: {error}")
    if gradient is None or peak.governing is None:
        return replace(out, note=f"no derivatives with the {peak.model} model")
    rows = (
        *_of_dimensions(gradient, dimensions, step),
        *_of_loads(gradient, peak.governing),
        *_of_material(gradient, task.material),
    )
    return _with_rows(out, gradient, rows)


def _with_rows(
    out: PinSensitivities, gradient: Derivatives | JointDerivatives, rows: Iterable[_Parameter]
) -> PinSensitivities:
    return replace(
        out,
        rows=_sorted((replace(x, key=_study_key(out.pin, x.key)) for x in rows), out.factor),
        tied_places=gradient.tied_places,
        tied_times=gradient.tied_times,
        without=tuple((_study_key(out.pin, key), why) for key, why in gradient.without.items()),
    )


def _study_key(pin: str, key: str) -> str:
    """Return the key of a parameter in the study; keys of dimensions lack the pin's table."""
    others = "force ", "moment ", "material."
    return key if key.startswith(others) else f"pin.{key_part(pin)}.{key}"


def _of_lugs(study: Study, task: Task, joined: Solution, step: float | None) -> PinSensitivities:
    """Return the sensitivities of a pin in contact. step: None to return only the note on how to
    get them.
    """
    from pinstress.analysis.remedies.joint_parameters import joint_parameters

    peak = joined.peak
    maximum, strength = peak.max_von_mises or 0.0, task.material.yield_strength
    factor, links = peak.safety_factor(strength), peak.governing
    out = PinSensitivities(peak.pin, peak.case, maximum, factor)
    if not task.pin.revolved:
        return replace(out, note=NOT_AXISYMMETRIC_NOTE)
    if joined.rings is None or links is None:
        return replace(out, note=NO_CONTACT_NOTE)
    if step is None:
        return replace(out, note=IN_LUGS_NOTE)
    try:
        parameters = [x.of_joint for x in joint_parameters(study, task)]
        gradient = differentiated_in_lugs(joined, task, parameters)
    except (MeshError, SolveError) as error:
        return replace(out, note=f"no derivatives: {error}")
    if gradient is None:
        return replace(out, note=f"no derivatives with the {peak.model} model")
    rows = [
        *_of_forces(gradient.by_force, "force", links.surfaces, links.forces[0], maximum),
        *_of_forces(gradient.by_moment, "moment", links.surfaces, links.moments[0], maximum),
        *_of_joint(joint_parameters(study, task), gradient.by_parameter, maximum, step),
    ]
    if strength is not None:
        key = f"material.{key_part(task.material.name)}.yield_strength"
        change = STEP_FRACTION * strength
        rows.append(_Parameter(key, "stress", strength, change, 0.0, 1.0 / strength))
    return _with_rows(replace(out, changing=gradient.changing), gradient, rows)


def _of_joint(
    parameters: Iterable[StudyParameter], by: dict[str, float], maximum: float, step: float
) -> Iterator[_Parameter]:
    for parameter in parameters:
        one, kind = parameter.of_joint, parameter.kind
        if one.key not in by:
            continue
        if one.key.endswith(".clearance"):
            change = CLEARANCE_STEP * step
        elif kind == "length":
            change = _small_step(step, one.value)
        else:
            change = POISSON_RATIO_STEP if kind == "1" else STEP_FRACTION * one.value
        stress = by[one.key]
        yield _Parameter(one.key, kind, one.value, change, stress, -stress / maximum)


def _small_step(step: float, value: float) -> float:
    """Return a step (m) of a dimension, reduced by powers of ten until it is small relative to the
    dimension.
    """
    while step > MAX_STEP_FRACTION * value:
        step /= 10.0
    return step


@dataclass(frozen=True)
class _Parameter:
    """A parameter as in Sensitivity. relative: the derivative of the factor divided by the
    factor.
    """

    key: str
    kind: str
    value: float
    step: float
    stress: float
    relative: float

    @property
    def effect(self) -> float:
        """The relative effect of the step on the factor."""
        return self.relative * self.step

    def sensitivity(self, factor: float | None) -> Sensitivity:
        """Return the sensitivity of a given factor."""
        of_factor = None if factor is None else factor * self.relative
        after = None if factor is None else factor * (1.0 + self.effect)
        return Sensitivity(
            self.key, self.kind, self.value, self.step, self.stress, of_factor, after
        )


def _of_dimensions(
    gradient: Derivatives, dimensions: tuple[Dimension, ...], step: float
) -> Iterator[_Parameter]:
    for dimension in dimensions:
        if dimension.key in gradient.by_dimension:
            change = _small_step(step, dimension.value)
            stress = gradient.by_dimension[dimension.key]
            relative = -stress / gradient.maximum
            yield _Parameter(dimension.key, "length", dimension.value, change, stress, relative)


def _sorted(rows: Iterable[_Parameter], factor: float | None) -> tuple[Sensitivity, ...]:
    """Return the sensitivities, the largest effects first."""
    return tuple(row.sensitivity(factor) for row in sorted(rows, key=lambda x: -abs(x.effect)))


def _of_loads(gradient: Derivatives, loads: PinLoads) -> Iterator[_Parameter]:
    for kind, by, given in (
        ("force", gradient.by_force, loads.forces[0]),
        ("moment", gradient.by_moment, loads.moments[0]),
    ):
        yield from _of_forces(by, kind, loads.surfaces, given, gradient.maximum)


def _of_forces(
    by: dict[tuple[str, str], float],
    kind: str,
    surfaces: tuple[str, ...],
    given: Floats,
    maximum: float,
) -> Iterator[_Parameter]:
    for (surface, axis), stress in by.items():
        value = float(given[surfaces.index(surface), "xyz".index(axis)])
        step = STEP_FRACTION * float(np.abs(given).max())
        if step:
            relative = -stress / maximum
            yield _Parameter(f"{kind} {surface} {axis}", kind, value, step, stress, relative)


def _of_material(gradient: Derivatives, material: Material) -> Iterator[_Parameter]:
    rho, strength = material.density, material.yield_strength
    for name, kind, value, step, stress in (
        ("youngs_modulus", "stress", material.youngs_modulus, None, gradient.youngs_modulus),
        ("poisson_ratio", "1", material.poisson_ratio, POISSON_RATIO_STEP, gradient.poisson_ratio),
        ("density", "density", rho, None, gradient.density),
        ("yield_strength", "stress", strength, None, 0.0),
    ):
        if value is not None:
            relative = 1.0 / value if name == "yield_strength" else 0.0 - stress / gradient.maximum
            change = STEP_FRACTION * value if step is None else step
            yield _Parameter(
                f"material.{key_part(material.name)}.{name}", kind, value, change, stress, relative
            )

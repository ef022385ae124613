"""From what the rooms found, in SI, to the plain data that reports are made from."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np

from fea.envelope import envelope
from fea.peak import Peak
from fea.refine import Solution
from fea.stress import von_mises
from pinstress.build import CaseLoads
from pinstress.gather_loads import drive_position, mechanics
from pinstress.pins import material as material_of
from pinstress.pins import outline, weight
from pinstress.published import Published
from pinstress.study import Study
from pinstress.tasks import Task
from reports import results as plain

PACKAGES = ("pinstress", "numpy", "scipy", "scikit-fem", "gmsh", "meshio", "cvxopt", "pymetis")


def results(
    study: Study,
    loads: dict[str, CaseLoads],
    solutions: list[tuple[Task, Solution]],
    beam: plain.BeamCheck | None,
    published: Published,
    tolerance: float,
) -> plain.Results:
    """Everything a run found."""
    table, system = study.table, study.system
    tasks = {task.pin.name: task for task, _ in reversed(solutions)}
    return plain.Results(
        title=table.title,
        study=study.path.name,
        study_sha256=study.sha256,
        units=plain.Units(system.length, system.force, system.stress, system.time),
        required_safety_factor=table.analysis.required_safety_factor,
        tolerance=tolerance,
        pins=tuple(_pin_result(study, loads, task, s.peak, published) for task, s in solutions),
        shapes=tuple(_shape(study, tasks[name]) for name in table.pin if name in tasks),
        **mechanics(study, loads, published),
        beam_check=beam,
        provenance=tuple(plain.Provenance(s.key, s.kind, s.note) for s in study.provenance),
        published_source=table.published.source if table.published else "",
        assumptions=tuple(table.assumptions),
        versions={name: version(name) for name in PACKAGES},
    )


def _pin_result(
    study: Study,
    loads: dict[str, CaseLoads],
    task: Task,
    peak: Peak,
    published: Published,
) -> plain.PinResult:
    unit = study.system.factor
    material = material_of(study, study.table.pin[peak.pin].material)
    required = study.table.analysis.required_safety_factor
    factor = peak.safety_factor(material.yield_strength)
    meets = None
    if factor is not None and required is not None:
        # a peak that is no value decides nothing, whichever side of the limit it is on
        meets = factor >= required if peak.verdict != "unconverged" else None
    case = loads[peak.case]
    times = case.reactions.times
    positions = drive_position(study, case)
    position = None if positions is None else float(positions[peak.instant])
    theirs = published.peaks.get((peak.pin, peak.case), (None, None))
    return plain.PinResult(
        pin=peak.pin,
        case=peak.case,
        model=peak.model,
        verdict=peak.verdict,
        note=peak.note,
        max_von_mises=_scaled(peak.max_von_mises, unit("stress")),
        error_estimate=_scaled(peak.error_estimate, unit("stress")),
        location=tuple(x / unit("length") for x in peak.location) if peak.location else None,  # type: ignore[arg-type]
        time=None if times is None or peak.location is None else float(times[peak.instant]),
        position=position if peak.location else None,
        safety_factor=factor,
        yields=None if factor is None else factor < 1.0,
        meets_required=meets,
        dofs=peak.dofs,
        seconds=peak.seconds,
        history=tuple(
            plain.MeshStep(h.dofs, h.max_von_mises / unit("stress"), h.seconds)
            for h in peak.history
        ),
        held=", ".join(task.clamps) or "nothing (loads in balance)",
        left_out=task.left_out[peak.case],
        published_max_von_mises=theirs[0],
        published_safety_factor=theirs[1],
    )


def _scaled(value: float | None, factor: float) -> float | None:
    return None if value is None else value / factor


def _shape(study: Study, task: Task) -> plain.PinShape:
    unit = study.system.factor
    pin, name = task.pin, study.table.pin[task.pin.name].material
    density = material_of(study, name).density
    held = {pin.surface(c) for c in task.clamps}
    segments = tuple(
        (length / unit("length"), diameter / unit("length"), bore / unit("length"), label,
         "held" if label in held else kind)
        for length, diameter, bore, label, kind in outline(pin)
    )  # fmt: skip
    heavy = weight(pin, density) / unit("force") if density else None
    return plain.PinShape(pin.name, segments, name, heavy)


def landing_range(
    study: Study, loads: dict[str, CaseLoads], task: Task, solution: Solution
) -> plain.LandingRange | None:
    """A pin over the ranges of its landing's impulse: unit fields superposed, nothing solved."""
    case, over = solution.peak.case, loads[solution.peak.case].range
    if over is None or solution.fields is None:
        return None
    unit = study.system.factor
    maxima = envelope(solution.fields, task.ranges[case]).maxima
    strength = material_of(study, study.table.pin[task.pin.name].material).yield_strength
    return plain.LandingRange(
        pin=task.pin.name,
        case=case,
        impulse_time=over.times / unit("time"),
        velocity_change=over.velocities / unit("velocity"),
        force=over.forces / unit("force"),
        max_von_mises=maxima / unit("stress"),
        safety_factor=None if strength is None else strength / maxima,
        nominal=(over.nominal[0] / unit("time"), over.nominal[1] / unit("velocity")),
        verdict=solution.peak.verdict,
    )


def field(study: Study, solution: Solution) -> plain.Field | None:
    """A pin's field at its governing instant; None when it was not solved."""
    fields, found = solution.fields, solution.envelope
    if fields is None or found is None:
        return None
    unit = study.system.factor
    stress = fields.stress @ found.coefficients / unit("stress")
    over_all = np.full(len(stress), np.nan)
    over_all[fields.surface.nodes] = found.field / unit("stress")
    return plain.Field(
        pin=solution.peak.pin,
        case=solution.peak.case,
        points=fields.space.nodes / unit("length"),
        cells=fields.space.elements,
        displacement=fields.displacement @ found.coefficients / unit("length"),
        stress=stress,
        von_mises=von_mises(stress),
        envelope=over_all,
    )

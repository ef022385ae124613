"""From what the rooms found, in SI, to the plain data that reports are made from."""

from __future__ import annotations

from importlib.metadata import version

from fea.hand_checks import hand_checks
from fea.ladder import Solution
from fea.peak import Peak, SingularZone
from fea.pin_loads import Floats
from fea.tensor import von_mises
from geometry import CutPin, Pin
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
    rows: list[tuple[Task, Peak]],
    beam: plain.BeamCheck | None,
    published: Published,
    tolerance: float,
) -> plain.Results:
    """Everything a run found. rows: each peak with its task, in the order of the table."""
    table, system = study.table, study.system
    tasks = {task.pin.name: task for task, _ in reversed(rows)}
    return plain.Results(
        title=table.title,
        study=study.path.name,
        study_sha256=study.sha256,
        units=plain.Units(system.length, system.force, system.stress, system.time),
        required_safety_factor=table.analysis.required_safety_factor,
        tolerance=tolerance,
        pins=tuple(_pin_result(study, loads, task, peak, published) for task, peak in rows),
        shapes=tuple(_shape(study, tasks[name]) for name in table.pin if name in tasks),
        **mechanics(study, loads, published),
        beam_check=beam,
        provenance=tuple(plain.Provenance(s.key, s.kind, s.note) for s in study.provenance),
        published_source=table.published.source if table.published else "",
        assumptions=tuple(table.assumptions),
        versions={name: version(name) for name in PACKAGES},
        study_text=study.text,
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
    meets = _meets(peak, material.yield_strength, required)
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
        why=peak.why,
        singular_at=tuple(_zone(study, zone) for zone in peak.singular_at),
        hand_checks=_hand_checks(study, task, peak.case, times),
    )


def _meets(peak: Peak, strength: float | None, required: float | None) -> bool | None:
    """Whether the required factor is reached; None where that is open. Outside of singular places
    too little is too little, but enough there says nothing of the places themselves.
    """
    if strength is None or required is None or peak.max_von_mises is None:
        return None
    stress, error, limit = peak.max_von_mises, peak.error_estimate or 0.0, strength / required
    if peak.verdict == "converged":
        return stress <= limit
    if stress - error > limit:
        return False
    return True if stress + error <= limit and peak.verdict == "unconverged" else None


def _zone(study: Study, zone: SingularZone) -> plain.SingularZone:
    unit = study.system.factor
    x, y, z = (a / unit("length") for a in zone.location)
    return plain.SingularZone(
        location=(x, y, z),
        kind=zone.kind,
        between=zone.between,
        exponent=zone.exponent,
        exponent_theory=zone.exponent_theory,
        excluded=zone.excluded / unit("length"),
        governs=zone.governs,
        max_von_mises=zone.max_von_mises / unit("stress"),
        advice=zone.advice,
    )


def _hand_checks(
    study: Study, task: Task, case: str, times: Floats | None
) -> tuple[plain.HandCheck, ...]:
    """Of a pin with a profile; a pin that is cut is checked as if it were not."""
    pin = task.pin.profile if isinstance(task.pin, CutPin) else task.pin
    if not isinstance(pin, Pin):
        return ()
    material = material_of(study, study.table.pin[pin.name].material)
    loads = next(x for x in task.loads if x.case == case)
    stress = study.system.factor("stress")
    return tuple(
        plain.HandCheck(
            name=c.name,
            at=c.at,
            time=None if times is None else float(times[c.instant]),
            stress=c.stress / stress,
            strength=None if c.strength is None else c.strength / stress,
            factor=c.factor,
            formula=c.formula,
            source=c.source,
        )
        for c in hand_checks(pin, material, loads, task.clamps)
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
    if over is None or solution.answer is None:
        return None
    unit = study.system.factor
    maxima = solution.answer.maxima(task.ranges[case])
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


def field(study: Study, task: Task, solution: Solution) -> plain.Field | None:
    """A pin's field at its governing instant; None if not solved, or if the model has none."""
    peak, unit = solution.peak, study.system.factor
    loads = next(x for x in task.loads if x.case == peak.case)
    shown = solution.answer.picture(loads, peak.instant) if solution.answer else None
    if shown is None:
        return None
    strength = material_of(study, study.table.pin[peak.pin].material).yield_strength
    stress = shown.stress / unit("stress")
    return plain.Field(
        pin=peak.pin,
        case=peak.case,
        points=shown.points / unit("length"),
        cells=shown.cells,
        displacement=shown.displacement / unit("length"),
        stress=stress,
        von_mises=von_mises(stress),
        envelope=shown.envelope / unit("stress"),
        cell_type=shown.cell_type,
        yield_strength=_scaled(strength, unit("stress")),
        outside=_outside(study, peak),
    )


def _outside(study: Study, peak: Peak) -> tuple[float, tuple[float, float, float]] | None:
    if peak.verdict != "singular" or peak.max_von_mises is None or peak.location is None:
        return None
    unit = study.system.factor
    x, y, z = (a / unit("length") for a in peak.location)
    return peak.max_von_mises / unit("stress"), (x, y, z)

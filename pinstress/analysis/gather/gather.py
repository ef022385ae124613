"""Results for reports, gathered in SI units from the solutions and assessments of a run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from importlib.metadata import version

import numpy as np

from assess.diameter_law import section_exponent
from assess.margin import PinMargin
from fea.core.peak import Maximum
from fea.support.records import JointResult
from geometry import Cut, Flat, Hole, Passage, PinLike, Recess, Slot
from geometry.shape.cut_edges import drawn
from pinbase.records import in_units
from pinstress.analysis.assessed.situations import factor_assumption
from pinstress.analysis.cache import REQUIRED_PACKAGES
from pinstress.analysis.mechanics.gather_loads import drive_position, mechanics, position_unit
from pinstress.analysis.mechanics.gather_sequences import with_sequences
from pinstress.analysis.plan import Plan, all_loads
from pinstress.analysis.stored import PinOutcome
from pinstress.study.model.cases import CaseLoads, at_time
from pinstress.study.model.mechanism.linkage import fit_note
from pinstress.study.model.pins import far_ends, outline, weight
from pinstress.study.model.requirements import stated_requirements
from pinstress.study.model.sequence import chosen_cases
from pinstress.study.model.tasks import Task, assumed_distribution, taper_assumption
from pinstress.study.model.temperature import temperature_assumption
from pinstress.study.reading.file import Study, named_materials
from pinstress.study.reading.inputs import inputs
from pinstress.study.reading.published_tables import Published, read_published
from pinstress.study.schema.shown import listed
from pinstress.study.schema.tables import ReportTable
from reports.data.changes import Remedy
from reports.data.dependence import depends_on
from reports.data.results import (
    CutShape,
    Fatigue,
    LugSketch,
    PinShape,
    Provenance,
    Results,
    ShankSketch,
    TitleBlock,
)
from reports.data.row import SI, GoverningLoad, PinResult, Units
from reports.data.sensitivities import PinSensitivities

WITHOUT_FRICTION_NOTE = (
    "Pins slide in their lugs without friction, which would lower their bending (by 15 to 24 % on "
    "a clevis with coefficients of 0.1 to 0.3): the safe side while a load grows, not in a cycle."
)


def _in_lugs(study: Study) -> bool:
    """Return whether lugs support any pin."""
    joints = study.table.analysis.joints
    return joints in ("contact", "foundation") or (
        joints == "auto" and any(pin.lug for pin in study.table.pin.values())
    )


def materials_assumption(study: Study) -> tuple[str, ...]:
    """Return a sentence for each material that the study only names."""
    return tuple(
        f"Material {x.name} is that of {x.file}: {x.source}." for x in named_materials(study)
    )


def shanks_assumption(rows: Iterable[PinResult]) -> tuple[str, ...]:
    """Return a sentence for each way in which the directions of shanks were assumed."""
    lugs: dict[str, dict[str, None]] = {}
    for row in rows:
        for lug in row.joint.lugs if row.joint else ():
            if lug.assumed:
                lugs.setdefault(lug.assumed, {})[lug.connection] = None
    return tuple(
        f"Stress of the lugs at {listed(connections)}: {assumed}."
        for assumed, connections in lugs.items()
    )


def results_of(plan: Plan, outcomes: list[PinOutcome]) -> Results:
    """Return a plan's results from the outcomes of its tasks."""
    study = plan.study
    outcomes = [
        replace(outcome, histories=with_sequences(study, plan.loads, outcome.histories))
        for outcome in outcomes
    ]
    pins, cases = list(study.table.pin), list(plan.loads)
    rows = [
        (task, row)
        for task, outcome in zip(plan.tasks, outcomes, strict=True)
        for row in outcome.rows
    ]
    rows.sort(key=lambda row: (pins.index(row[1].pin), cases.index(row[1].case)))
    results = _results(study, plan.loads, rows, plan.published, plan.requirement.tolerance)
    fatigue: Fatigue | None = None
    fatigue_margins: list[PinMargin] = []
    if study.table.fatigue is not None:
        from pinstress.analysis.gather.gather_fatigue import fatigue_of  # imports SciPy

        fatigue, fatigue_margins = fatigue_of(plan, outcomes)
    results = replace(
        results,
        stated=stated_requirements(
            study, [(row.pin, row.case) for _, row in rows], plan.pins, list(plan.loads)
        ),
        beam_check=next((x.beam_check for x in outcomes if x.beam_check is not None), None),
        surfaces=tuple(surface for outcome in outcomes for surface in outcome.surfaces),
        changes=_worst_changes(outcomes),
        sensitivities=_in_order(outcomes, pins, cases, plan.sensitive),
        histories=tuple(history for outcome in outcomes for history in outcome.histories),
        fatigue=fatigue,
        spectrum_margins=tuple(fatigue_margins),
    )
    return _in_study_units(results, study)


def rows_of(plan: Plan, outcomes: list[PinOutcome]) -> dict[tuple[str, str], PinResult]:
    """Return the rows of a plan by pin and case, as `results_of` has them."""
    study, factor, units = plan.study, plan.study.system.factor, units_of(plan.study)
    rows = (
        _completed(study, plan.loads[row.case], task, row, plan.published)
        for task, outcome in zip(plan.tasks, outcomes, strict=True)
        for row in outcome.rows
    )
    return {(row.pin, row.case): in_units(replace(row, units=units), factor) for row in rows}


def _worst_changes(outcomes: list[PinOutcome]) -> tuple[Remedy, ...]:
    """Return one remedy for each pin, for its worst case; the pin with the lowest factor comes
    first.
    """
    remedies = sorted((x.remedy for x in outcomes if x.remedy), key=lambda x: x.load_factor)
    return tuple({remedy.pin: remedy for remedy in reversed(remedies)}.values())[::-1]


def _in_order(
    outcomes: list[PinOutcome], pins: list[str], cases: list[str], every: bool
) -> tuple[PinSensitivities, ...]:
    """Return the sensitivities in the order of the rows.

    every: whether to keep all cases; otherwise only the worst case of each pin is kept.
    """
    rows = [row for outcome in outcomes for row in outcome.sensitivities]
    if not every:
        rows = list({row.pin: row for row in sorted(rows, key=lambda row: row.maximum)}.values())
    return tuple(sorted(rows, key=lambda row: (pins.index(row.pin), cases.index(row.case))))


def _in_study_units(results: Results, study: Study) -> Results:
    return results.in_units(units_of(study), study.system.factor)


def units_of(study: Study) -> Units:
    """Return the units of a study's results."""
    s = study.system
    return Units(s.length, s.force, s.stress, s.time)


def loads_only(study: Study, cases: Iterable[str] | None = None) -> Results:
    """Return the mechanics of a study without stresses.

    Raises: InputError for bad input.
    """
    published = read_published(study)
    loads = all_loads(study, chosen_cases(study, cases))
    tolerance = study.table.analysis.tolerance
    return _in_study_units(_results(study, loads, [], published, tolerance), study)


def _results(
    study: Study,
    loads: dict[str, CaseLoads],
    rows: list[tuple[Task, PinResult]],
    published: Published,
    tolerance: float,
) -> Results:
    """Return the results of a run that follow from its loads and rows, in SI units.

    rows: each with its task, in the order of the table.
    """
    table = study.table
    tasks = {task.pin.name: task for task, _ in reversed(rows)}
    return Results(
        title=table.title,
        study=study.path.name,
        study_sha256=study.sha256,
        units=SI,
        required_safety_factor=table.analysis.required_safety_factor,
        tolerance=tolerance,
        pins=tuple(_completed(study, loads[row.case], task, row, published) for task, row in rows),
        shapes=tuple(
            shape_of_task(tasks[name], [row.maximum for _, row in rows if row.pin == name])
            for name in table.pin
            if name in tasks
        ),
        **mechanics(study, loads, published),
        provenance=tuple(Provenance(**asdict(source)) for source in study.provenance),
        published_source=table.published.source if table.published else "",
        assumptions=(
            *table.assumptions,
            *materials_assumption(study),
            *factor_assumption(study, (row for _, row in rows)),
            *filter(None, [assumed_distribution(study, (task for task, _ in rows))]),
            *taper_assumption(task for task, _ in rows),
            *shanks_assumption(row for _, row in rows),
            *fit_note(study),
            *temperature_assumption(study),
            *((WITHOUT_FRICTION_NOTE,) if _in_lugs(study) else ()),
            *(f"Possible mistake: {q}" for q in study.questions),
        ),
        versions={name: version(name) for name in REQUIRED_PACKAGES},
        study_text=study.text,
        inputs=inputs(study),
        title_block=_title_block(table.report),
    )


def _title_block(given: ReportTable) -> TitleBlock:
    date = "" if given.date is None else given.date.isoformat()
    return TitleBlock(given.revision, date, given.prepared, given.checked, given.approved)


def _completed(
    study: Study, case: CaseLoads, task: Task, row: PinResult, published: Published
) -> PinResult:
    """Return a row with its support, loads, position of the drive and published values."""
    time = row.maximum.time
    here = case if time is None else at_time(case, time)
    assert here is not None
    positions = drive_position(study, here) if row.location else None
    published_stress, published_factor = published.peaks.get((row.pin, row.case), (None, None))
    return replace(
        row,
        held=_held(task, row.joint),
        left_out=task.left_out[row.case],
        position=None if positions is None else float(positions[0]),
        position_unit=position_unit(study, here),
        loads=_governing_loads(task, case, here, time),
        shank_angles=tuple(_shank_angles(task, row.case, time)),
        exponent=section_exponent(task.pin, row.places.section if row.places else None),
        depends_on=depends_on(row),
        published_max_von_mises=published_stress,
        published_safety_factor=published_factor,
    )


def _shank_angles(task: Task, case: str, time: float | None) -> Iterator[tuple[str, float]]:
    """Yield the known directions of the shanks, degrees, each with the name of its lug."""
    now = None if time is None else np.array([time])
    turning = task.shanks.get(case, {})
    for lug in task.lugs:
        if lug.connection in turning:
            yield lug.connection, math.degrees(turning[lug.connection].at(now, 1)[0])
        elif lug.shank is not None and lug.shank.angle is not None:
            yield lug.connection, math.degrees(lug.shank.angle)


def _held(task: Task, joint: JointResult | None) -> str:
    if task.lugs:
        return f"its lugs ({joint.model if joint else 'contact'})"
    return ", ".join(task.clamps) or "nothing (loads in balance)"


def _governing_loads(
    task: Task, case: CaseLoads, here: CaseLoads, time: float | None
) -> tuple[GoverningLoad, ...]:
    """Return the loads at the instant that governs, also where forces jump.

    A motion without a solution has no governing instant, and no loads.
    """
    r = here.reactions
    if time is not None and case.moving is not None:
        r = case.moving.at(np.array([time]))[0]
    elif r.times is not None and time is None:
        return ()
    return tuple(
        GoverningLoad(name, r.bodies[c], r.forces[0, c], r.moments[0, c])
        for c, name in enumerate(r.connections)
        if name in task.pin.connections
    )


def shape_of_task(task: Task, peaks: Sequence[Maximum]) -> PinShape:
    """Return the pin of a task as it is drawn, in SI units.

    peaks: the maxima of the pin; the local solids on which they were solved are drawn.
    """
    pin, density = task.pin, task.material.density
    held = {pin.surface(c) for c in task.clamps}
    segments = tuple(
        (length, diameter, bore, label, "held" if label in held else kind)
        for length, diameter, bore, label, kind in outline(pin)
    )
    heavy = weight(pin, density) if density else None
    cuts = tuple(cut_shapes(pin))
    solids = tuple(dict.fromkeys(ends for peak in peaks for ends in peak.solids))
    made_of = task.material.name
    return PinShape(
        pin.name, segments, made_of, heavy, far_ends(pin), cuts, solids, tuple(_lug_sketches(task))
    )


def _lug_sketches(task: Task) -> Iterator[LugSketch]:
    """Yield the lugs that support the pin of a task, in the order of z."""
    for lug in sorted(task.lugs, key=lambda lug: task.pin.band(lug.connection).z0):
        band, bushing, shank = task.pin.band(lug.connection), lug.bushing, lug.shank
        yield LugSketch(
            lug.connection,
            (band.z0, band.z1),
            lug.outer_diameter,
            lug.clearance,
            lug.material.name,
            lug.edge_radius,
            bushing.thickness if bushing else 0.0,
            bushing.interference if bushing else 0.0,
            ShankSketch(shank.shape, shank.width, shank.length, shank.end) if shank else None,
        )


def cut_shapes(pin: PinLike) -> Iterator[CutShape]:
    """Yield the cuts of a pin as reports draw them, in SI."""
    for name, cut in pin.cuts.items():
        assert pin.profile is not None
        drawing = drawn(cut, pin.profile)
        size, offset, depth = _cut_sizes(cut)
        low, high = (cut.z, cut.z) if isinstance(cut, Hole) else _cut_ends(cut)
        lines = tuple((tuple((z, x) for z, x in at.tolist()), hide) for at, hide in drawing.lines)
        yield CutShape(
            name,
            (max(low, 0.0), min(high, pin.length)),
            size,
            offset,
            depth,
            math.degrees(cut.angle),
            lines,
            drawing.notches,
            math.degrees(cut.tilt) if isinstance(cut, Hole) else 0.0,
        )


def _cut_ends(cut: Cut) -> tuple[float, float]:
    assert isinstance(cut, Flat | Slot | Passage | Recess)
    return cut.z0, cut.z1


def _cut_sizes(cut: Cut) -> tuple[float, float, float | None]:
    """Return the diameter, width or distance of a cut, its offset and its depth (None: through)."""
    if isinstance(cut, Flat):
        return cut.distance, 0.0, None
    if isinstance(cut, Slot):
        return cut.width, 0.0, cut.depth
    if isinstance(cut, Hole):
        return cut.diameter, cut.offset, cut.depth
    if isinstance(cut, Recess):
        return cut.width, 0.0, None
    assert isinstance(cut, Passage)
    return cut.diameter, cut.offset, None if cut.mouth == "both" else cut.z1 - cut.z0

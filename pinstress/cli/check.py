"""Description of the analyses that a study requests, without solving."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from functools import partial

from geometry import PinLike
from loads import Linkage, Reactions, jump_times
from loads.forces.sharing import undetermined
from loads.motion.four_bar import four_bar
from loads.motion.mobility import Mobility
from loads.space.linkage import SpaceLinkage
from pinbase.counted import counted
from pinstress.explore.sweep.correlations import correlations_of
from pinstress.explore.sweep.parameters import parameters_of, require_laws
from pinstress.explore.sweep.sample import designs_of
from pinstress.study.model.balance import other_warnings, unheld
from pinstress.study.model.cases import CaseLoads, case_loads
from pinstress.study.model.hardened import require_strengths
from pinstress.study.model.lost_fits import lost_fit_warnings
from pinstress.study.model.lugs import lugs
from pinstress.study.model.mechanism.drives import span
from pinstress.study.model.mechanism.linkage import (
    AnyLinkage,
    any_linkage,
    determined,
    fit_note,
    fit_offer,
)
from pinstress.study.model.pins import far_ends, outline, shape_notes, weight
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.sequence import require_times
from pinstress.study.model.tasks import (
    Task,
    assumed_distribution,
    require_models,
    taper_assumption,
    tasks,
)
from pinstress.study.model.temperature import temperature_assumption
from pinstress.study.reading.errors import Errors
from pinstress.study.reading.file import Study, named_materials
from pinstress.study.reading.published_tables import read_published
from pinstress.study.schema.cases import GivenCase, MotionCase
from pinstress.study.schema.landing import DropCase, GroundCase
from pinstress.study.schema.pins import PinTable
from pinstress.study.schema.require import RequireTable, level_of
from pinstress.study.schema.units import UnitSystem
from pinstress.study.schema.vary import VaryTable

MAX_SHOWN_JUMPS = 6


@dataclass(frozen=True)
class Examination:
    """Everything known of a valid study before it is solved.

    lines: of the summary.
    unheld: the unconstrained pins, and why they would not be solved.
    warnings: about unbalanced loads at other pins, lost fits, and designs that cannot be built.
    """

    lines: list[str]
    loads: dict[str, CaseLoads]
    tasks: list[Task]
    unheld: list[str]
    warnings: list[str]


def examine(study: Study) -> Examination:
    """Read all files of a valid study and compute its loads.

    Raises: InputError for errors that involve several tables.
    """
    table = study.table
    lines = [f"{study.path}: {table.title}", f"units {study.system.name}"]
    for stored in named_materials(study):
        lines.append(f"material {stored.name}: that of {stored.file} ({stored.source})")
    wrong = Errors(study.path)
    wrong.attempt(lambda: read_published(study))
    mechanism = wrong.attempt(lambda: any_linkage(study)) if table.mechanism else None
    if mechanism is not None:
        described = wrong.attempt(partial(_mechanism, study, mechanism))
        lines += described or []
        mechanism = mechanism if described else None  # its cases would repeat the error
    loads: dict[str, CaseLoads] = {}
    for name, case in table.case.items():
        if mechanism is not None or isinstance(case, GivenCase):
            # Without extremes: here the mechanism only has to be able to follow its drives.
            case_result = wrong.attempt(partial(case_loads, study, name, mechanism, extremes=False))
            loads |= {} if case_result is None else {name: case_result}
    lines += [
        f"case {name}: {_words(study, name, case)}{_nothing(case.reactions)}"
        for name, case in loads.items()
    ]
    times = {name: case.reactions.times for name, case in loads.items()}
    wrong.attempt(partial(require_times, study, times))
    for name, sequence in table.sequence.items():
        steps = ", ".join(f"{step.repeat} × {step.case}" for step in sequence.steps)
        lines.append(f"sequence {name}: {steps}")
    pins = {name: wrong.attempt(partial(pin_of, study, name)) for name in table.pin}
    valid_pins = [pin for pin in pins.values() if pin is not None]
    lines += [wrong.attempt(partial(_pin, study, pin)) or "" for pin in valid_pins]
    wrong.tell()
    todo = tasks(study, valid_pins, loads) if valid_pins else []
    require_models(study, todo, table.analysis.model)
    a = table.analysis
    goal = (
        f", required safety factor {a.required_safety_factor:g}" if a.required_safety_factor else ""
    )
    lines.append(f"model {a.model}, tolerance {a.tolerance:g}{goal}")
    lines += filter(None, [assumed_distribution(study, todo)])
    lines += taper_assumption(todo)
    lines += map(_requirement, table.require)
    lines += fit_note(study) + temperature_assumption(study)
    warnings = other_warnings(study, todo) + lost_fit_warnings(study, todo)
    if table.vary is not None or "reliability" in table.model_fields_set:
        lines += _varied(study, todo)
        warnings += _impossible(study) if todo else []
    loose = [line for task in todo for line in unheld(study, task).values()]
    return Examination(lines, loads, todo, loose, warnings)


def _requirement(table: RequireTable) -> str:
    """Describe a requirement: "requires rupture at ultimate load, factor 1.5: pin E in landing"."""
    level = "" if table.check == "fatigue" else f" at {level_of(table)} load"
    pins = f"pin{'s' * (len(table.pins) > 1)} {', '.join(table.pins)}" if table.pins else "all pins"
    cases = f" in {', '.join(table.cases)}" if table.cases else ""
    return f"requires {table.check}{level}, factor {table.factor:g}: {pins}{cases}"


def _sampled(vary: VaryTable) -> bool:
    """Return whether [vary] describes the designs of a sweep; distributions alone are for
    `reliability`.
    """
    return bool(vary.model_fields_set & {"sample", "count"}) or any(
        law.steps is not None or law.from_ is not None for law in vary.parameters.values()
    )


def _varied(study: Study, todo: list[Task]) -> list[str]:
    """Describe what `sweep` and `reliability` would do, as far as the study requests them."""
    vary = study.table.vary
    sampled = vary is not None and _sampled(vary)
    parameters = parameters_of(study, sampled)
    correlations_of(study, parameters, sampled)
    many = f"{len(parameters)} number{'s' * (len(parameters) > 1)}"
    lines = []
    if vary is not None and sampled:
        steps = math.prod(p.steps or 1 for p in parameters)
        count = steps if vary.sample == "grid" else vary.count
        lines.append(f"varies {many} in {counted(count, 'design')} ({vary.sample})")
    if not sampled or "reliability" in study.table.model_fields_set:
        require_laws(study)
        require_strengths(study, (task.pin.name for task in todo))
        a = study.table.reliability
        lines.append(
            f"reliability: {many} scatter, a factor below {a.factor:g} is failure; "
            f"{a.samples:,} plain and {a.importance_samples:,} importance samples"
        )
    return lines


def _impossible(study: Study) -> list[str]:
    """Return warnings about designs that cannot be built.

    Raises: InputError for given forces that vary independently and so lose their equilibrium.
    """
    from pinstress.explore.sweep.evaluate import Evaluator  # imports the solvers
    from pinstress.explore.sweep.possible import drawn, impossible_designs

    vary = study.table.vary
    sampled = vary is not None and _sampled(vary)
    parameters = parameters_of(study, sampled)
    if vary is not None and sampled:
        values = designs_of(vary, parameters, correlations_of(study, parameters))
    else:
        values = drawn(study, parameters)
    return impossible_designs(study, Evaluator(study, parameters), parameters, values)


def _pin(study: Study, pin: PinLike) -> str:
    """Describe a pin in a line: size, links in the order of z, supports."""
    name, p, system = pin.name, study.table.pin[pin.name], study.system
    ways = dict.fromkeys(study.clamps(name, case) for case in study.table.case)
    supports = dict.fromkeys(support_of(study, pin, way) for way in ways)
    density = study.table.material[p.material].density
    heavy = ""
    if density:
        heavy = f", {weight(pin, density) / system.factor('force'):.4g} {system.force}"
    links = sorted(pin.connections, key=lambda connection: pin.band(connection).z0)
    return (
        f"pin {name}: {p.material}, {_size(pin, system)}, {_form(p)}{heavy}; "
        f"loaded at {', '.join(links) or 'nothing'}; {' or '.join(supports)}"
        + (f"; {notes}" if (notes := shape_notes(pin)) else "")
    )


def _size(pin: PinLike, system: UnitSystem) -> str:
    """Return the length and the least and largest diameter of a pin."""
    parts, length = outline(pin), system.factor("length")
    diameters = [d for _, d, *_ in parts] + [d for d, _ in far_ends(pin)]
    ends = dict.fromkeys(f"{d / length:.4g}" for d in (min(diameters), max(diameters)))
    long = sum(part[0] for part in parts) / length
    return f"{long:.4g} {system.length} long, ⌀ {' to '.join(ends)}"


def support_of(study: Study, pin: PinLike, clamps: tuple[str, ...]) -> str:
    """Describe the support of a pin with these clamps."""
    if lugs(study, pin, clamps):
        beam = study.table.analysis.joints == "foundation"
        return f"{'on foundations in' if beam else 'in contact with'} its lugs"
    return f"clamped at {', '.join(clamps)}" if clamps else "not clamped: its loads must balance"


def _form(pin: PinTable) -> str:
    if pin.geometry is not None:
        return f"from {pin.geometry}"
    shape = (pin.profile, "segment") if pin.meridian is None else (pin.meridian, "corner")
    cuts = ((len(getattr(pin, what)), what) for what in ("hole", "flat", "slot", "passage"))
    parts = ((len(shape[0] or ()), shape[1]), *cuts)
    return ", ".join(f"{n} {what}{'s' * (n > 1)}" for n, what in parts if n)


def _mechanism(study: Study, mechanism: AnyLinkage) -> list[str]:
    if isinstance(mechanism, SpaceLinkage):
        return _in_space(study, mechanism)
    mobility = determined(study, mechanism)
    lines = [
        f"mechanism: {counted(len(mechanism.bodies), 'body', 'bodies')}, "
        f"{counted(len(mechanism.joints), 'joint')}, "
        f"{counted(len(mechanism.connections), 'connection')}{_teeth(mechanism)}, "
        + (f"driven by {', '.join(mechanism.driven)}" if mechanism.driven else "no drive")
    ]
    movable = _counted(mobility)
    if ring := four_bar(mechanism):
        drawn = "crossed" if ring.crossed else "open"
        movable += f"; four-bar {'-'.join(ring.joints)}: {ring.kind}, drawn {drawn}"
    if not mobility.redundant:
        return [*lines, movable]
    if mobility.shared and not mechanism.sharing:
        error = undetermined(mechanism, mobility)
        raise study.error(f"mechanism: {error}{fit_offer(study, error)}", code=error.code)
    rule = ", ".join(f"{'/'.join(s.connections)}" for s in mechanism.sharing)
    return [*lines, movable + _redundant(mobility, f"the sharing rule for {rule}")]


def _in_space(study: Study, linkage: SpaceLinkage) -> list[str]:
    mobility, mechanism = determined(study, linkage), study.table.mechanism
    assert mechanism is not None
    kinds = Counter(joint.kind for joint in linkage.joints)
    joints = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
    rule = "a sharing rule" if linkage.sharing else "the stiffness of the links"
    return [
        f"mechanism in space: {counted(len(mechanism.body), 'body', 'bodies')}, joints: {joints}, "
        + (f"driven by {', '.join(linkage.driven)}" if linkage.driven else "no drive"),
        _counted(mobility) + _redundant(mobility, rule) * bool(mobility.redundant),
    ]


def _counted(mobility: Mobility) -> str:
    by_count = f" by rank, {mobility.kutzbach} by count (Kutzbach)"
    return f"mobility {mobility.degrees}" + by_count * (mobility.kutzbach != mobility.degrees)


def _redundant(mobility: Mobility, rule: str) -> str:
    shared = ", ".join(mobility.shared)
    return f"; {mobility.redundant} redundant: the forces at {shared} follow {rule}"


def _teeth(mechanism: Linkage) -> str:
    pairs = len(mechanism.teeth)
    return f", {pairs} pair{'s' * (pairs > 1)} of teeth" if pairs else ""


def _nothing(reactions: Reactions) -> str:
    """Return a note if a case loads no pin."""
    loaded = reactions.forces.any() or reactions.moments.any()
    return "" if loaded else "; every force and moment on the pins is zero"


def _words(study: Study, name: str, loads: CaseLoads) -> str:
    case, reactions = study.table.case[name], loads.reactions
    if isinstance(case, GivenCase):
        many = "one instant"
        if reactions.times is not None and len(reactions) > 1:
            jumps = ", ".join(f"{t:g} s" for t in jump_times(reactions.times)[:MAX_SHOWN_JUMPS])
            many = f"{len(reactions):,} instants" + f", jump at t = {jumps}" * bool(jumps)
        return f"given, {many}, connections {', '.join(reactions.connections)}"
    if isinstance(case, DropCase):
        return f"drop, {case.samples:,} instants over {case.duration:g} s, ground on {case.body}"
    if isinstance(case, GroundCase):
        return f"ground, {f'14 CFR {case.rule}' if case.rule else 'stated factors'}, on {case.body}"
    applied = ", ".join(dict.fromkeys(load.body for load in case.apply))
    if isinstance(case, MotionCase):
        also = f", loads on {applied}" if applied else ""
        return f"motion, {case.samples:,} instants over {span(study):g} s{also}"
    return f"{case.kind}, {f'loads on {applied}' if applied else 'gravity only'}"

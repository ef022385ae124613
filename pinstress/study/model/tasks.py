"""Tasks to solve, each a pin with its constraints and its loads in every case."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fea.core.material import Material
from fea.core.over_time import Between
from fea.core.pin_loads import Distribution, Floats, PinLoads
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, PinLike
from loads import Reactions
from pinbase.keys import key_part
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.clevis import Ears, on_ears
from pinstress.study.model.hardened import pin_material
from pinstress.study.model.lugs import AssumedLugs, assumed_lugs, given_lugs, known_lugs, lugs
from pinstress.study.model.moving_loads import MovingLoads, acting
from pinstress.study.model.temperature import rise_of
from pinstress.study.reading.errors import Errors
from pinstress.study.reading.file import Study
from pinstress.study.schema.shown import listed

if TYPE_CHECKING:
    from fea.lug.in_joint import ShankAngle


@dataclass(frozen=True)
class PinImpulse:
    """Loads on a pin at two instants: without an impulse and with it.

    time: duration of the impulse, s.
    """

    time: float
    loads: PinLoads


@dataclass(frozen=True)
class SharedLoads:
    """Loads on a pin with other stiffnesses of the links that share them.

    what: the difference in stiffness for each instant of the loads. The instants are those at which
    the force or the moment of one of the pin's links is largest.
    """

    what: tuple[str, ...]
    loads: PinLoads


@dataclass(frozen=True)
class Task:
    """A pin of a material, clamped in one way, in lugs of one temperature, with its loads in all
    cases of that kind.

    left_out: for each case, the connections whose force and moment are not applied because their
    band is clamped.
    ranges: for each case with ranges of its impulse, the loads over them.
    between: for each case that is a motion, the loads at any times.
    lugs: those that support the pin, if any.
    surroundings: lugs in which the pin may sit if none support it.
    impulses: for each case that has an impulse.
    given: the lugs that the study gives, whether they support the pin or not.
    shanks: by case and connection, the angles of the shanks of lugs.
    shared: by case, the loads with other stiffnesses of links.
    rise: of the temperature of the cases above that of the study's dimensions, K, if it changes the
    fit of the lugs; otherwise 0.
    """

    pin: PinLike
    material: Material
    clamps: tuple[str, ...]
    loads: tuple[PinLoads, ...]
    left_out: dict[str, tuple[str, ...]]
    ranges: dict[str, PinLoads]
    between: dict[str, Between]
    lugs: tuple[Lug, ...] = ()
    surroundings: AssumedLugs | None = None
    impulses: dict[str, PinImpulse] = field(default_factory=dict)
    given: tuple[Lug, ...] = ()
    shanks: dict[str, dict[str, ShankAngle]] = field(default_factory=dict)
    rise: float = 0.0
    shared: dict[str, SharedLoads] = field(default_factory=dict)

    @property
    def also(self) -> dict[str, PinLoads]:
        """The loads under which stress is needed in addition to those of the case itself,
        by case.
        """
        return {case: x.loads for case, x in self.shared.items()} | self.ranges

    def of_case(self, loads: PinLoads) -> Task:
        """The same pin with the loads of one of its cases only."""
        return replace(self, loads=(loads,))


def tasks(study: Study, pins: list[PinLike], loads: dict[str, CaseLoads]) -> list[Task]:
    """Return the tasks of the pins that any case loads.

    Raises: InputError when there is nothing to solve, or when all loads on a pin are at its clamps.
    """
    out = []
    for pin in pins:
        ways: dict[tuple[tuple[str, ...], float], dict[str, CaseLoads]] = {}
        for case, given in loads.items():
            way = study.clamps(pin.name, case), _rise(study, pin, case)
            ways.setdefault(way, {})[case] = given
        for (clamps, rise), cases in ways.items():
            task = _task(study, pin, clamps, rise, cases)
            if task.loads:
                out.append(task)
    if not study.table.pin:
        raise study.error(
            "the study has no pins; use pinstress loads for the reactions only", code="no-pins"
        )
    if not out:
        many = "s" if len(loads) > 1 else ""
        raise study.error(
            f"case{many} {', '.join(loads)} {'do' if many else 'does'} not load "
            f"pin{'s' if len(pins) > 1 else ''} {', '.join(pin.name for pin in pins)}",
            code="not-loaded",
        )
    return out


def _rise(study: Study, pin: PinLike, case: str) -> float:
    """Return the rise of temperature in a case, K, if it changes the fits of a pin; otherwise 0.

    If data for the change are missing, the rise is returned; making the lugs then reports what is
    missing.
    """
    rise, profile, joints = rise_of(study, case), pin.profile, study.table.analysis.joints
    in_lugs = study.table.pin[pin.name].lug or joints in ("contact", "foundation")
    if not (rise and in_lugs and profile):
        return 0.0
    try:
        hot = known_lugs(study, profile, rise)
    except ArgumentError:
        return rise
    outgrown = (lug.bushing.outgrown for lug in hot if lug.bushing)
    return rise if any(lug.growth for lug in hot) or any(outgrown) else 0.0


def _task(
    study: Study,
    pin: PinLike,
    clamps: tuple[str, ...],
    rise: float,
    loads: dict[str, CaseLoads],
) -> Task:
    """Return the task of a pin in the cases that have these clamps and this rise of temperature."""
    constrained = {pin.surface(c) for c in clamps}
    made_of = pin_material(study, pin)
    cases: list[PinLoads] = []
    left_out: dict[str, tuple[str, ...]] = {}
    ranges: dict[str, PinLoads] = {}
    between: dict[str, Between] = {}
    impulses: dict[str, PinImpulse] = {}
    shared: dict[str, SharedLoads] = {}
    for case, given in loads.items():
        here = [c for c in pin.connections if c in given.reactions.connections]
        if not here:
            continue
        applied = [c for c in here if c not in constrained]
        if not applied:
            raise study.error(
                f"case.{key_part(case)}: every load on pin {pin.name} is at a clamped band "
                f"({', '.join(here)}), so no load acts on it; clamp another surface",
                code="not-loaded",
            )
        left_out[case] = tuple(c for c in here if c in constrained)
        spread = study.table.case[case].distribution
        heavy = not clamps and bool(made_of.density)
        ears = _ears(study, pin, constrained, applied)
        build = partial(_pin_loads, case, given, applied, spread, heavy, ears)
        if given.moving is None:
            cases.append(build(given.reactions))
        else:
            between[case] = partial(_at, build, given.moving)
            cases.append(between[case](given.moving.instants))
        if given.range is not None:
            ranges[case] = build(given.range.reactions)
        if given.shared:
            shared[case] = _shared(given, applied, build)
        if given.impulse is not None:
            impulses[case] = PinImpulse(given.impulse.time, build(given.impulse.reactions))
    hot = cases[0].case if cases and rise else None
    in_lugs = lugs(study, pin, clamps, hot) if cases else ()
    around = assumed_lugs(study, pin, clamps, rise) if cases and not in_lugs else None
    given_ones = given_lugs(study, pin, in_lugs, hot) if cases else ()
    return Task(
        pin, made_of, clamps, tuple(cases), left_out, ranges, between, in_lugs, around, impulses,
        given_ones, _shanks(study, pin, loads, cases, in_lugs), rise, shared,
    )  # fmt: skip


def _shared(given: CaseLoads, applied: list[str], build: Callable[..., PinLoads]) -> SharedLoads:
    """Return the loads on a pin with other stiffnesses of links, at the worst instants of each."""
    parts: list[PinLoads] = []
    what: list[str] = []
    for text, other in given.shared:
        if other.space is not None:
            reactions, accelerations = other.reactions, other.space.accelerations
        else:
            assert other.dynamics is not None
            reactions, accelerations = acting(other.dynamics)
        which = [reactions.connections.index(c) for c in applied]
        sizes = [np.linalg.norm(x[:, which], axis=2) for x in (reactions.forces, reactions.moments)]
        rows = np.unique(np.concatenate([size.argmax(axis=0) for size in sizes]))
        parts.append(build(reactions.at(rows), accelerations[rows]))
        what += [text] * len(rows)
    forces, moments, body = (
        np.concatenate([getattr(part, key) for part in parts])
        for key in ("forces", "moments", "body")
    )
    loads = replace(parts[0], forces=forces, moments=moments, body=body, times=None)
    return SharedLoads(tuple(what), loads)


def _shanks(
    study: Study,
    pin: PinLike,
    loads: dict[str, CaseLoads],
    cases: list[PinLoads],
    in_lugs: tuple[Lug, ...],
) -> dict[str, dict[str, ShankAngle]]:
    if not any(lug.shank for lug in in_lugs):
        return {}
    from pinstress.study.model.shanks import shank_angles  # imports the elements of lugs

    return {case.case: shank_angles(study, pin.name, loads[case.case]) for case in cases}


def assumed_distribution(study: Study, todo: Iterable[Task]) -> str:
    """Return a sentence on the load distribution of the cases that state none; empty if every case
    states it, or lugs carry the loads.

    todo: the tasks of an analysis.
    """
    applied = (loads for task in todo if not task.lugs for loads in task.loads)
    prescribed = {loads.case for loads in applied if loads.forces[..., :2].any()}
    assumed = [
        name
        for name, case in study.table.case.items()
        if name in prescribed and "distribution" not in case.model_fields_set
    ]
    if not assumed:
        return ""
    many = len(assumed) > 1
    return (
        f"Case{'s' * many} {listed(assumed)} state{'s' * (not many)} no distribution: forces act "
        'as bearing pressure on the loaded half of their bands ("cosine").'
    )


def taper_assumption(todo: Iterable[Task]) -> tuple[str, ...]:
    """Return a sentence on clamps on cones, which hold a pin more firmly than a tapered seat; empty
    without such clamps.

    todo: the tasks of an analysis.
    """
    tapers = dict.fromkeys(
        f"{name} of pin {task.pin.name}"
        for task in todo
        if task.pin.profile is not None
        for name in task.clamps
        for segment, label in zip(task.pin.profile.segments, task.pin.profile.labels, strict=True)
        if segment.cone and label == task.pin.surface(name)
    )
    if not tapers:
        return ()
    return (
        f"The clamp on the cone {listed(list(tapers))} holds it in every direction, as if bonded; "
        "a tapered seat only presses on it, so it holds no pull out of the taper.",
    )


def require_models(study: Study, todo: Iterable[Task], model: str) -> None:
    """Raise InputError for tasks that a model cannot solve, with all of them."""
    wrong = Errors(study.path)
    for task in todo:
        wrong.attempt(partial(_require_model, study, model, task))
    wrong.tell()


def _require_model(study: Study, model: str, task: Task) -> None:
    """Raise InputError for a task that a model cannot solve."""
    pin = task.pin.name
    if model in ("beam", "harmonic") and not task.pin.revolved:
        raise study.error(
            f"pin {pin} is not a body of revolution, which the {model} model needs: use auto or "
            "solid",
            at=f"pin.{key_part(pin)}",
            code="not-of-revolution",
        )
    if not task.lugs:
        return
    beam = study.table.analysis.joints == "foundation"
    how, fits = ("on foundations in", "beam") if beam else ("in contact with", "harmonic")
    if model not in ("auto", fits):
        raise study.error(
            f"pin {pin} is {how} its lugs, which requires the {fits} model: use auto or {fits}, "
            f'or analysis.joints = "prescribed" for the {model} model',
            at=f"pin.{key_part(pin)}",
            code="model-without-contact",
        )


def _at(build: Callable[..., PinLoads], moving: MovingLoads, times: Floats) -> PinLoads:
    return build(*moving.at(times))


def _pin_loads(
    case: str,
    given: CaseLoads,
    applied: list[str],
    distribution: Distribution,
    heavy: bool,
    ears: dict[str, Ears],
    reactions: Reactions,
    accelerations: Floats | None = None,
) -> PinLoads:
    """Return the loads on a pin at some connections.

    heavy: whether the pin's own weight acts.
    ears: of the links that are clevises, by connection.
    accelerations: (T, J, 2) m/s^2 of the joints, by default those at the case's instants.
    """
    body = _own_weight(given, applied[0], reactions, accelerations) if heavy else np.zeros(3)
    forces = np.stack([reactions.in_pin_axes(c) for c in applied], axis=1)
    moments = np.stack([reactions.moment_in_pin_axes(c) for c in applied], axis=1)
    surfaces, forces, moments = on_ears(applied, forces, moments, ears)
    return PinLoads(
        case, surfaces, forces, moments, distribution, body, times=reactions.times,
        tilting=surfaces if given.knows_moments else None,
    )  # fmt: skip


def _ears(study: Study, pin: PinLike, constrained: set[str], applied: list[str]) -> dict[str, Ears]:
    """Return the ears of a pin's clevises that bear loads.

    Raises: InputError for a clamped ear.
    """
    out = {}
    for connection, other in study.table.pin[pin.name].ears.items():
        if other in constrained:
            raise study.error(
                f"pin {pin.name}: the ear {other} of {connection} is clamped, and so takes an "
                "unknown part of its link's load: clamp another surface, or give the pin lugs",
                code="clamped-ear",
            )
        if connection in applied:
            out[connection] = Ears(other, *(pin.band(x).middle for x in (connection, other)))
    return out


def _own_weight(
    case: CaseLoads, connection: str, reactions: Reactions, accelerations: Floats | None
) -> Floats:
    """Return gravity minus the pin's acceleration, (T, 3) m/s^2 in pin axes; zero without a
    mechanism.

    The weight of a clamped pin would go into its clamp, as loads on a clamped band do.
    """
    if case.space is not None:
        known = case.space.accelerations if accelerations is None else accelerations
        at = known[:, reactions.connections.index(connection)]
        if len(at) != len(reactions):  # the range of an impulse, all at the case's only instant
            at = np.broadcast_to(at, (len(reactions), 3))
        return reactions.to_pin_axes(case.space.gravity - at, connection)
    if case.dynamics is None:
        return np.zeros(3)
    linkage = case.dynamics.motion.linkage
    if accelerations is None:
        _, accelerations = acting(case.dynamics)
    for k, joint in enumerate(linkage.joints):
        if any(c.name == connection for c in joint.connections):
            across = np.zeros((len(reactions), 3))
            across[:, :2] = np.array(linkage.gravity) - accelerations[:, k]
            return reactions.to_pin_axes(across, connection)
    return np.zeros(3)

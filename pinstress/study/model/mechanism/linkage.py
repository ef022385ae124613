"""Linkage of a study's mechanism."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TypeVar

import numpy as np

from loads import (
    GROUND,
    Body,
    Connection,
    Joint,
    Linkage,
    LinkageError,
    Parallel,
    Sharing,
    Slider,
    Turn,
)
from loads.linkage.mass_properties import flat_bar, round_bar
from loads.motion.mobility import Mobility, require_determined
from pinstress.study.model.mechanism.drawing import Drawing
from pinstress.study.model.mechanism.drives import drive_table, mechanism_of
from pinstress.study.model.mechanism.gears import gears, rack
from pinstress.study.model.mechanism.joint_layout import LayoutError, Point, places
from pinstress.study.model.pins import pin
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.file import Study
from pinstress.study.schema.mechanism import (
    BodyTable,
    JointTable,
    RotaryDrive,
    SharingTable,
    SliderTable,
    StopTable,
    drive_name,
)

A = TypeVar("A")
B = TypeVar("B")
STANDARD_GRAVITY = 9.80665


def linkage(study: Study) -> Linkage:
    """Return the linkage of the study's mechanism.

    Raises: InputError with all its contradictions.
    """
    mechanism = mechanism_of(study)
    g = float(np.hypot(*mechanism.gravity)) or STANDARD_GRAVITY
    try:
        unit, factor = study.system.length, study.system.factor("length")

        def shown(length: float) -> str:
            return f"{length / factor:.6g} {unit}"

        drawing = Drawing(mechanism, places(mechanism, shown), shown)
        return _assembled(study, drawing, g)
    except LayoutError as error:
        raise study.error(str(error), code=error.code) from None
    except LinkageError as error:
        raise study.errors(_wrong(error)) from None


def _wrong(error: LinkageError) -> list[Wrong]:
    return [
        Wrong(
            f"mechanism: {problem}",
            at=".".join(map(str, ("mechanism", *problem.at))),
            code=problem.code,
        )
        for problem in error.each
    ]


def determined(study: Study, mechanism: Linkage) -> Mobility:
    """Return the mobility of a mechanism whose drives determine every position.

    Raises: InputError where they do not, or where a sharing rule applies to no indeterminate force.
    """
    try:
        return require_determined(mechanism)
    except LinkageError as error:
        raise study.errors(_wrong(error)) from None


def _assembled(study: Study, drawing: Drawing, g: float) -> Linkage:
    mechanism = drawing.mechanism
    wrong: list[LinkageError] = []

    def each(make: Callable[[A], B], of: Iterable[A]) -> tuple[B, ...]:
        parts = []
        for one in of:
            try:
                parts.append(make(one))
            except LinkageError as error:
                wrong.extend(error.each)
        return tuple(parts)

    bodies = each(lambda b: _body(drawing, *b, g), mechanism.body.items())
    sliders = each(lambda s: _slider(drawing, *s), mechanism.slider.items())
    turning = [d for d in mechanism.drive if isinstance(d, RotaryDrive)]
    turns = each(lambda d: _turn(study, drawing, d), turning)
    meshing = each(lambda g: gears(*g, drawing), mechanism.gear.items())
    meshing += each(lambda r: rack(*r, drawing, sliders), mechanism.rack.items())
    if wrong:
        raise LinkageError.all(wrong)
    return Linkage(
        bodies=bodies,
        joints=tuple(
            Joint(
                name,
                drawing.at[name],
                tuple(Connection(c, body, _circle(j)) for c, body in j.connections.items()),
                j.fixed_in,
                _pin_mass(study, name, j.weight, g) if j.fixed_in is None else 0.0,
            )
            for name, j in mechanism.joint.items()
        ),
        sliders=sliders,
        turns=(*turns, *(_stop(*item) for item in mechanism.stop.items())),
        driven=tuple(drive_name(d) for d in mechanism.drive),
        gravity=mechanism.gravity,
        sharing=tuple(
            Sharing(tuple(s.connections), tuple(s.stiffness or ()))
            for s in mechanism.sharing
            if s.connections is not None
        ),
        parallel=tuple(_parallel(s) for s in mechanism.sharing if s.parallel is not None),
        teeth=meshing,
    )


def _circle(joint: JointTable) -> float:
    """Return the radius of the friction circle, m."""
    mu = joint.friction or 0.0
    return 0.5 * (joint.diameter or 0.0) * mu / math.hypot(1.0, mu)


def _stop(name: str, stop: StopTable) -> Turn:
    base, body = stop.bodies
    return Turn(name, body, 0.0, base, stop.carries)


def _parallel(rule: SharingTable) -> Parallel:
    by_area = rule.areas is not None
    shares = rule.areas if rule.areas is not None else rule.stiffness or []
    return Parallel(tuple(rule.parallel or ()), tuple(shares), "areas" if by_area else "stiffness")


def _slider(drawing: Drawing, name: str, s: SliderTable) -> Slider:
    start, end = (drawing.at[p] if isinstance(p, str) else p for p in s.joints)
    right = "list the bodies in the order of their joints, or give the point as [x, y]"
    for body, place in zip(s.bodies, s.joints, strict=True):
        if isinstance(place, str):
            drawing.require_on(place, body, ("slider", name), right)
    return Slider(name, *s.bodies, start, end, s.direction, s.friction, s.bearing)


def _turn(study: Study, drawing: Drawing, drive: RotaryDrive) -> Turn:
    """Return the driven angle; of its values a turn apart, the drawn one is nearest to the
    start.
    """
    at, drawn = ("drive", drive_name(drive)), 0.0
    right = "the line gives its angle; name two of its joints"
    for body, line, sign in (
        (drive.body, drive.line, 1.0),
        (drive.against, drive.against_line, -1.0),
    ):
        if line is None:
            continue
        for joint in line:
            drawing.require_on(joint, body, at, right)
        if line[0] == line[1]:
            text = f"{' '.join(at)}: the line needs two different joints"
            raise LinkageError(text, "same-joint", at)
        drawn += sign * _direction(line, drawing.at)
    start = drive.start if drive.law != "table" else drive_table(study, drive).values[0]
    if drive.line is not None and start is not None:
        drawn += 2.0 * math.pi * round((start - drawn) / (2.0 * math.pi))
    return Turn(drive_name(drive), drive.body, drawn, drive.against)


def _direction(line: tuple[str, str], at: dict[str, Point]) -> float:
    (x1, y1), (x2, y2) = (at[j] for j in line)
    return math.atan2(y2 - y1, x2 - x1)


def _body(drawing: Drawing, name: str, b: BodyTable, g: float) -> Body:
    at = drawing.at
    if b.bar is not None:
        (x1, y1), (x2, y2) = (at[j] for j in b.bar.joints)
        length = math.hypot(x2 - x1, y2 - y1)
        if b.bar.section is not None:
            mass, inertia = flat_bar(length, *b.bar.section, b.bar.density)
        else:
            mass, inertia = round_bar(length, b.bar.diameter or 0.0, b.bar.density)
        middle = (0.5 * (x1 + x2), 0.5 * (y1 + y2))
        return Body(name, mass, middle, inertia if b.inertia is None else b.inertia)
    mass = b.mass if b.mass is not None else (b.weight or 0.0) / g
    centre = b.centre
    if centre is None:
        on = [
            at[key]
            for key, j in drawing.mechanism.joint.items()
            if j.fixed_in == name or name in j.connections.values()
        ]
        if len(on) not in (1, 2):
            raise LinkageError(
                f"body {name}: a body with {len(on)} joints needs a centre = [x, y]",
                "missing-centre",
                ("body", name),
            )
        centre = (sum(x for x, _ in on) / len(on), sum(y for _, y in on) / len(on))
    return Body(name, mass, centre, b.inertia)


def _pin_mass(study: Study, joint: str, weight: float | None, gravity: float) -> float:
    """Return the mass of a floating pin: as stated, or of the profile of that name, or zero."""
    if weight is not None:
        return weight / gravity
    if joint not in study.table.pin:
        return 0.0
    density = study.table.material[study.table.pin[joint].material].density
    return density * pin(study, joint).volume if density else 0.0


def ground_joint(linkage: Linkage) -> str:
    """Return the joint about which moments on the ground are taken: the first that stands still."""
    for joint in linkage.joints:
        if joint.fixed_in == GROUND or any(c.body == GROUND for c in joint.connections):
            return joint.name
    return linkage.joints[0].name

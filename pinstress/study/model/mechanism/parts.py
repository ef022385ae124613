"""Bodies, sliders and rotations of a linkage, from their tables."""

from __future__ import annotations

import math

import numpy as np

from loads import GROUND, Body, LinkageError, Slider, Turn
from loads.linkage.mass_properties import flat_bar, round_bar
from pinstress.study.model.mechanism.drawing import Drawing, joints_on
from pinstress.study.model.mechanism.drives import drive_table
from pinstress.study.model.mechanism.joint_layout import Point
from pinstress.study.model.mechanism.masses import body_mass
from pinstress.study.reading.file import Study
from pinstress.study.schema.drives import RotaryDrive, drive_name
from pinstress.study.schema.mechanism import BodyTable, MechanismTable, SliderTable, StopTable
from pinstress.study.schema.tables import AnyMechanism


def body_anywhere(item: tuple[str, BodyTable]) -> Body:
    """Return a substitute for a body whose centre is unknown."""
    return Body(item[0], 0.0, (0.0, 0.0), item[1].inertia)


def turn_by_any_angle(drive: RotaryDrive) -> Turn:
    """Return a substitute for a driven angle whose value as drawn is unknown."""
    return Turn(drive_name(drive), drive.body, 0.0, drive.against)


def stop_turn(name: str, stop: StopTable) -> Turn:
    """Return the rotation that a stop blocks."""
    base, body = stop.bodies
    return Turn(name, body, 0.0, base, stop.carries)


def slider_of(drawing: Drawing, name: str, s: SliderTable) -> Slider:
    """Return a slider between its two points, as drawn."""
    start, end = (drawing.at[p] if isinstance(p, str) else p for p in s.joints)
    return Slider(name, *s.bodies, start, end, s.direction, s.friction, s.bearing)


def require_on_slider(drawing: Drawing, name: str, s: SliderTable) -> None:
    """Raise LinkageError unless the bodies of a slider are at its joints."""
    right = "list the bodies in the order of their joints, or give the point as [x, y]"
    for body, place in zip(s.bodies, s.joints, strict=True):
        if isinstance(place, str):
            drawing.require_on(place, body, ("slider", name), right)


def turn_of(study: Study, drawing: Drawing, drive: RotaryDrive) -> Turn:
    """Return the driven angle. Of its equivalent values, full turns apart, the drawn one is the
    nearest to the start of the drive.
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


def missing_centre(body: str, joints: int, form: str) -> LinkageError:
    """Return the error for a body with mass whose centre does not follow from its joints."""
    text = f"body {body}: a body with {joints} joint{'s' * (joints != 1)} needs a centre = {form}"
    return LinkageError(text, "missing-centre", ("body", body))


def geared(mechanism: AnyMechanism) -> set[str]:
    """Return the bodies with teeth around a joint."""
    pairs = {body for gear in mechanism.gear.values() for body in gear.bodies}
    return pairs | {rack.pinion for rack in mechanism.rack.values()}


def knows_centre(mechanism: AnyMechanism, name: str) -> bool:
    """Return whether the centre of mass of a body is stated or follows from its bar or joints.

    Two joints suffice. One joint suffices for a gear. In a plane, one joint also suffices for a
    body that slides and never rotates (on the ground, or with a stated inertia of 0), and for a
    point mass whose angle neither a drive, a stop nor a weld acts on.
    """
    body = mechanism.body[name]
    joints = len(joints_on(mechanism, name))
    stated = body.centre is not None or body.bar is not None
    if stated or joints != 1:
        return stated or joints == 2
    if name in geared(mechanism) or not isinstance(mechanism, MechanismTable) or body.inertia:
        return name in geared(mechanism)
    slides = [slider.bodies for slider in mechanism.slider.values() if name in slider.bodies]
    turned = {d.body for d in mechanism.drive if isinstance(d, RotaryDrive)}
    turned |= {end for stop in mechanism.stop.values() for end in stop.bodies}
    turned |= {end for n, b in mechanism.body.items() if b.welded_to for end in (n, b.welded_to)}
    if slides:  # a stated inertia of 0 says that it never rotates
        return body.inertia is not None or any(GROUND in pair for pair in slides)
    return name not in turned


def body_of(study: Study, drawing: Drawing, name: str, b: BodyTable) -> Body:
    """Return a body with its mass, centre and inertia; those of a bar follow from its section.

    Raises: LinkageError for a missing centre.
    """
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
    mass = body_mass(study, name, b, float(np.hypot(*drawing.mechanism.gravity)))
    centre = b.centre
    if centre is None:
        on = [at[key] for key in joints_on(drawing.mechanism, name)]
        if not on or (mass and not knows_centre(drawing.mechanism, name)):
            raise missing_centre(name, len(on), "[x, y]")
        centre = (sum(x for x, _ in on) / len(on), sum(y for _, y in on) / len(on))
    return Body(name, mass, centre, b.inertia)

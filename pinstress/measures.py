"""Single quantities of a case by name: what published values are set beside."""

from __future__ import annotations

import math

import numpy as np

from loads import Dynamics, Slider
from loads.linkage import Floats
from pinstress.build import CaseLoads
from pinstress.errors import InputError
from pinstress.published import Published, PublishedRow
from pinstress.study import Study
from reports import results as plain

# quantity: what it is of, and its dimension
QUANTITIES = {
    "force_x": ("connection", "force"),
    "force_y": ("connection", "force"),
    "force": ("connection", "force"),
    "moment_x": ("connection", "energy"),
    "moment_y": ("connection", "energy"),
    "moment_z": ("connection", "energy"),
    "angle": ("body", "deg"),
    "angular_velocity": ("body", "rad/s"),
    "angular_acceleration": ("body", "rad/s^2"),
    "centre_vx": ("body", "velocity"),
    "centre_vy": ("body", "velocity"),
    "centre_ax": ("body", "acceleration"),
    "centre_ay": ("body", "acceleration"),
    "drive_force": ("drive", "force"),
    "drive_torque": ("drive", "energy"),
    "drive_velocity": ("drive", "drive"),
    "drive_acceleration": ("drive", "drive"),
}


def published_values(
    study: Study, loads: dict[str, CaseLoads], published: Published
) -> tuple[plain.PublishedValue, ...]:
    """The study's published single values with ours. Raises: InputError for an unknown one."""
    rows = [row for row in published.values if row.case in loads]
    return tuple(_beside(study, row, loads[row.case]) for row in rows)


def _beside(study: Study, row: PublishedRow, case: CaseLoads) -> plain.PublishedValue:
    if row.quantity not in QUANTITIES:
        known = ", ".join(QUANTITIES)
        raise InputError(f"{row.where}: no quantity {row.quantity!r}; there are {known}")
    of, dimension = QUANTITIES[row.quantity]
    instant = _instant(study, row, case)
    try:
        if of == "connection":
            c = case.reactions.connections.index(row.name)
            value = _of_connection(row.quantity, case, instant, c)
        elif case.dynamics is None:
            raise InputError(f"{row.where}: case {row.case} has no mechanism")
        elif of == "body":
            value = _of_body(row, case.dynamics)[instant]
        else:
            value = _of_drive(row, case.dynamics)[instant]
    except (IndexError, KeyError, ValueError):  # a particle has no angle
        raise InputError(
            f"{row.where}: case {row.case} has no {of} {row.name!r} with {row.quantity}"
        ) from None
    if dimension in ("deg", "rad/s", "rad/s^2"):
        unit, factor = dimension, math.pi / 180.0 if dimension == "deg" else 1.0
    else:
        unit, factor = _unit(study, row, dimension, case)
    return plain.PublishedValue(
        row.case, row.time, row.quantity, row.name, float(value) / factor, row.value, unit,
        row.reason,
    )  # fmt: skip


def _unit(study: Study, row: PublishedRow, dimension: str, case: CaseLoads) -> tuple[str, float]:
    s = study.system
    if dimension == "drive":
        assert case.dynamics is not None
        slides = isinstance(_drive(row, case.dynamics), Slider)
        second = row.quantity.endswith("acceleration")
        if not slides:
            return ("rad/s^2" if second else "rad/s"), 1.0
        dimension = "acceleration" if second else "velocity"
    names = {
        "force": s.force,
        "energy": f"{s.force} {s.length}",
        "velocity": f"{s.length}/{s.time}",
        "acceleration": f"{s.length}/{s.time}^2",
    }
    return names[dimension], s.factor(dimension)


def _instant(study: Study, row: PublishedRow, case: CaseLoads) -> int:
    times = case.reactions.times
    if times is None or row.time is None:
        return 0
    return int(np.abs(times / study.system.factor("time") - row.time).argmin())


def _of_connection(quantity: str, case: CaseLoads, t: int, c: int) -> float:
    r = case.reactions
    if quantity == "force":
        return float(r.magnitudes[t, c])
    values = r.moments if quantity.startswith("moment") else r.forces
    return float(values[t, c, "xyz".index(quantity[-1])])


def _of_body(row: PublishedRow, dynamics: Dynamics) -> Floats:
    motion, linkage = dynamics.motion, dynamics.motion.linkage
    i = linkage.index[row.name]
    match row.quantity:
        case "angular_velocity":
            return motion.angular_velocity(row.name)
        case "angular_acceleration":
            return motion.angular_acceleration(row.name)
        case "angle":
            joints = linkage.joints_on(row.name)
            (x1, y1), (x2, y2) = joints[0].at, joints[1].at
            angle = math.atan2(y2 - y1, x2 - x1) + motion.angle(row.name)
            # of the angles a turn apart, the one nearest to the published
            near = math.radians(row.value)
            return angle + 2.0 * math.pi * np.round((near - angle) / (2.0 * math.pi))
    _, velocity, acceleration = motion.centres
    z = (velocity if "_v" in row.quantity else acceleration)[:, i]
    return np.asarray(z.real if row.quantity.endswith("x") else z.imag)


def _drive(row: PublishedRow, dynamics: Dynamics) -> object:
    drives = {d.name: d for d in dynamics.motion.linkage.drives}
    return drives[row.name]


def _of_drive(row: PublishedRow, dynamics: Dynamics) -> Floats:
    k = dynamics.motion.linkage.driven.index(row.name)
    values = {
        "drive_velocity": dynamics.motion.speeds,
        "drive_acceleration": dynamics.motion.rates,
    }.get(row.quantity, dynamics.drive)
    return np.asarray(values[:, k])

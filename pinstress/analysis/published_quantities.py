"""Single quantities of a case by name, for comparison with published values."""

from __future__ import annotations

import math

import numpy as np

from loads import Dynamics, Slider
from pinbase.arrays import Floats
from pinstress.study.model.cases import CaseLoads, at_time
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.reading.published_tables import Published, PublishedRow
from reports.data.mechanics import PublishedValue

# quantity: the kind of object that it belongs to, and its dimension
PUBLISHED_QUANTITIES = {
    "force_x": ("connection", "force"),
    "force_y": ("connection", "force"),
    "force": ("connection", "force"),
    "moment_x": ("connection", "energy"),
    "moment_y": ("connection", "energy"),
    "moment_z": ("connection", "energy"),
    "angle": ("body", "degrees"),
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
) -> tuple[PublishedValue, ...]:
    """Return the study's published single values with the computed ones.

    Raises: InputError for an unknown quantity.
    """
    rows = [row for row in published.values if row.case in loads]
    return tuple(_beside(study, row, loads[row.case]) for row in rows)


def _beside(study: Study, row: PublishedRow, case: CaseLoads) -> PublishedValue:
    if row.quantity not in PUBLISHED_QUANTITIES:
        known = ", ".join(PUBLISHED_QUANTITIES)
        raise InputError(
            f"{row.where}: no quantity {row.quantity!r}; there are {known}", code="unknown-quantity"
        )
    of, dimension = PUBLISHED_QUANTITIES[row.quantity]
    if row.time is not None:
        instant_loads = at_time(case, row.time * study.system.factor("time"))
        if instant_loads is None:
            raise InputError(
                f"{row.where}: case {row.case} has no time {row.time:g}", code="unknown-time"
            )
        case = instant_loads
    try:
        if of == "connection":
            c = case.reactions.connections.index(row.name)
            value = _of_connection(row.quantity, case, c)
        elif case.dynamics is None:
            raise InputError(f"{row.where}: case {row.case} has no mechanism", code="no-mechanism")
        elif of == "body":
            value = _of_body(row, case.dynamics)[0]
        else:
            value = _of_drive(row, case.dynamics)[0]
    except (IndexError, KeyError, ValueError):  # a particle has no angle
        raise InputError(
            f"{row.where}: case {row.case} has no {of} {row.name!r} with {row.quantity}",
            code="unknown-name",
        ) from None
    if dimension == "drive":
        dimension = _of_rate(row, case)
    ours = float(np.degrees(value)) if dimension == "degrees" else float(value)
    unit = study.system.unit(dimension)
    return PublishedValue(
        row.case, row.time, row.quantity, row.name, ours, row.value, unit, row.reason, dimension
    )


def _of_rate(row: PublishedRow, case: CaseLoads) -> str:
    """Return the dimension of a drive's velocity or acceleration."""
    assert case.dynamics is not None
    second = row.quantity.endswith("acceleration")
    if isinstance(_drive(row, case.dynamics), Slider):
        return "acceleration" if second else "velocity"
    return "rad/s^2" if second else "rad/s"


def _of_connection(quantity: str, case: CaseLoads, c: int) -> float:
    r = case.reactions
    if quantity == "force":
        return float(r.magnitudes[0, c])
    values = r.moments if quantity.startswith("moment") else r.forces
    return float(values[0, c, "xyz".index(quantity[-1])])


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
            # of the equivalent angles, full turns apart, the one nearest to the published angle
            near = math.radians(row.value)
            return angle + 2.0 * math.pi * np.round((near - angle) / (2.0 * math.pi))
    _, velocity, acceleration = motion.centres
    z = (velocity if "_v" in row.quantity else acceleration)[:, i]
    return np.asarray(z.real if row.quantity.endswith("x") else z.imag)


def _drive(row: PublishedRow, dynamics: Dynamics) -> object:
    return {d.name: d for d in dynamics.actuators}[row.name]


def _of_drive(row: PublishedRow, dynamics: Dynamics) -> Floats:
    k = [a.name for a in dynamics.actuators].index(row.name)
    _, speeds, rates = dynamics.course
    values = {"drive_velocity": speeds, "drive_acceleration": rates}.get(
        row.quantity, dynamics.drive
    )
    return np.asarray(values[:, k])

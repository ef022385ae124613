"""Tables of reactions and drives along a motion, of bodies in space, and of the checks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from operator import attrgetter

import numpy as np

from assess.opinion.records import BeamCheck
from pinbase.dimensions import Floats
from reports.data.mechanics import DriveTable, ReactionTable
from reports.data.motion import BodyMotion, MotionCheck
from reports.data.results import Results
from reports.tables.column import ArrayTable, Column, Table, fields


def _component(name: str, key: str, k: int, dimension: str) -> Column[ReactionTable]:
    return Column(key, lambda table: getattr(table, name)[:, :, k].ravel(), dimension)


def _names(name: str) -> Callable[[ReactionTable], list[str]]:
    """Return a function that gives the names by connection, repeated at every instant."""
    return lambda table: [*getattr(table, name)] * len(table.forces)


REACTION_COLUMNS: list[Column[ReactionTable]] = [
    *fields("case"),
    Column(
        "time", lambda t: None if t.times is None else t.times.repeat(len(t.connections)), "time"
    ),
    Column("connection", _names("connections")),
    Column("body", _names("bodies")),
    *(_component("forces", f"f{x}", k, "force") for k, x in enumerate("xyz")),
    *(_component("moments", f"m{x}", k, "moment") for k, x in enumerate("xyz")),
]
BEAM_CHECK_COLUMNS: list[Column[BeamCheck]] = [
    *fields("z", "length"),
    *fields("shear", "force"),
    *fields("moment", "moment"),
    *fields("beam_axial_stress fea_axial_stress fea_axial_stress_axis_load", "stress"),
]
MOTION_CHECK_COLUMNS: list[Column[MotionCheck]] = [
    *fields("time", "time"),
    *fields("speed", "velocity"),
    *fields("acceleration", "acceleration"),
    *fields("closed_form_speed", "velocity"),
    *fields("closed_form_acceleration", "acceleration"),
]

# Vectors of a body in space: beginning of the keys of their columns -> attribute and dimension
BODY_VECTORS = {
    "": ("centre", "length"),
    "v": ("velocity", "velocity"),
    "a": ("acceleration", "acceleration"),
    "coriolis_": ("coriolis", "acceleration"),
    "omega_": ("spin", "rate of turn"),
    "alpha_": ("spin_rate", "rate of rate of turn"),
    "p": ("momentum", "momentum"),
    "p_rate_": ("momentum_rate", "force"),
    "L": ("angular_momentum", "angular momentum"),
    "L_rate_": ("angular_momentum_rate", "moment"),
}


def reactions_table(results: Results) -> Table[ReactionTable]:
    """Return the forces and moments on the pins in world axes, a line for each instant and
    connection.
    """
    return ArrayTable("reactions", REACTION_COLUMNS, results.reactions)


def reactions_pin_axes_table(results: Results) -> Table[ReactionTable]:
    """Return the forces and moments in the axes of each pin, which turn with the body that carries
    it.
    """
    turned = [
        replace(t, forces=_in_pin_axes(t, t.forces), moments=_in_pin_axes(t, t.moments))
        for t in results.reactions
    ]
    return ArrayTable("reactions_pin_axes", REACTION_COLUMNS, turned)


def _in_pin_axes(table: ReactionTable, vectors: Floats) -> Floats:
    turn = np.zeros(vectors.shape[:2]) if table.turn is None else table.turn
    if turn.ndim > 2:
        return np.asarray((vectors[:, :, None, :] @ turn)[:, :, 0])
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = np.moveaxis(vectors, 2, 0)
    return np.stack([c * x + s * y, c * y - s * x, z], axis=2)


def drive_table(results: Results) -> Table[DriveTable]:
    """Return the drives in every case, with the case in the first column."""
    turning = any(table.kind != "slider" for table in results.drive)

    def of_kind(key: str, sliding: str, rotary: str) -> Column[DriveTable]:
        """Return a column whose dimension depends on the kind of drive, if there are
        rotary drives.
        """

        def by_kind(table: DriveTable) -> str:
            return sliding if table.kind == "slider" else rotary

        return Column(key, attrgetter(key), by_kind if turning else sliding)

    columns = [
        *fields("case"),
        *fields("time", "time"),
        of_kind("position", "length", "degrees"),
        of_kind("velocity", "velocity", "rate of turn"),
        of_kind("acceleration", "acceleration", "rate of rate of turn"),
        of_kind("force", "force", "moment"),
        *fields("power", "power"),
        Column("work", lambda table: None if table.time is None else table.work, "moment"),
        *fields("kinetic_energy potential_energy", "moment"),
        *fields("drive=name kind"),
    ]
    return ArrayTable("drive", columns, results.drive)


def beam_check_table(check: BeamCheck) -> Table[BeamCheck]:
    """Return shear, moment and axial stresses along the cantilever pin."""
    return ArrayTable("beam_check", BEAM_CHECK_COLUMNS, [check])


def motion_check_table(check: MotionCheck) -> Table[MotionCheck]:
    """Return a joint's speed and acceleration, from the linkage and in closed form."""
    return ArrayTable("motion_check", MOTION_CHECK_COLUMNS, [check])


def bodies_table(results: Results) -> Table[BodyMotion]:
    """Return motion and momenta of bodies in space, a line for each instant and body."""

    def component(name: str, k: int) -> Callable[[BodyMotion], Floats]:
        return lambda table: getattr(table, name)[:, k]

    columns: list[Column[BodyMotion]] = [
        *fields("case"),
        *fields("time", "time"),
        *fields("body"),
        *(
            Column(f"{key}{axis}", component(name, k), dimension)
            for key, (name, dimension) in BODY_VECTORS.items()
            for k, axis in enumerate("xyz")
        ),
        *fields("kinetic_energy", "moment"),
    ]
    return ArrayTable("bodies", columns, results.bodies)

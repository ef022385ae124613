"""Tables of a linkage's motion: bodies, joints, transmission angles, checks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reports.data.results import LinkageMotion, Results
from reports.format.files.csv import Cell
from reports.tables.table import Table

BODY_COLUMNS = ("x", "y", "angle_deg", "vx", "vy", "omega", "ax", "ay", "alpha")
JOINT_COLUMNS = ("x", "y", "vx", "vy", "ax", "ay")
PATH_COLUMNS = ("x", "y", "vx", "vy", "speed", "curvature")
LINKAGE_CHECK_COLUMNS = (
    "shaking_fx",
    "shaking_fy",
    "shaking_moment",
    "condition",
    "power_drives",
    "power_gravity",
    "power_applied",
    "power_friction",
    "kinetic_rate",
)


def linkage_tables(results: Results) -> list[Table]:
    """Motion, joints, transmission, linkage, sliders and, where points are named, paths of all
    cases.
    """
    paths = [("paths", ("case", "time", "point", *PATH_COLUMNS), _paths)]
    return [
        Table.of(name, columns, (row for m in results.motion for row in rows(m)))
        for name, columns, rows in (
            ("motion", ("case", "time", "body", *BODY_COLUMNS), _bodies),
            ("joints", ("case", "time", "joint", *JOINT_COLUMNS), _joints),
            ("transmission", ("case", "time", "link", "degrees"), _transmission),
            ("linkage", ("case", "time", *LINKAGE_CHECK_COLUMNS), _checks),
            ("sliders", ("case", "time", "slider", "normal", "couple", "friction"), _sliders),
            *(paths if any(m.paths for m in results.motion) else ()),
        )
    ]


def _instants(motion: LinkageMotion) -> Iterator[tuple[int, list[Cell]]]:
    for t in range(len(motion.condition)):
        yield t, [motion.case, None if motion.time is None else float(motion.time[t])]


def _bodies(m: LinkageMotion) -> Iterator[list[Cell]]:
    for t, head in _instants(m):
        for b, body in enumerate(m.bodies):
            turn = (m.angle, m.angular_velocity, m.angular_acceleration)
            line: list[Cell] = []
            for vector, scalar in zip((m.centre, m.velocity, m.acceleration), turn, strict=True):
                line += [float(vector[t, b, 0]), float(vector[t, b, 1]), float(scalar[t, b])]
            yield [*head, body, *line]


def _joints(m: LinkageMotion) -> Iterator[list[Cell]]:
    for t, head in _instants(m):
        for j, joint in enumerate(m.joints):
            vectors = (m.joint_position, m.joint_velocity, m.joint_acceleration)
            yield [*head, joint, *(float(x) for v in vectors for x in v[t, j])]


def _transmission(m: LinkageMotion) -> Iterator[list[Cell]]:
    for t, head in _instants(m):
        for link, degrees in m.transmission.items():
            yield [*head, link, float(degrees[t])]


def _sliders(m: LinkageMotion) -> Iterator[list[Cell]]:
    for t, head in _instants(m):
        for slider, forces in m.slider_forces.items():
            yield [
                *head,
                slider,
                *map(float, (forces.normal[t], forces.couple[t], forces.friction[t])),
            ]


def _paths(m: LinkageMotion) -> Iterator[list[Cell]]:
    for t, head in _instants(m):
        for name, p in m.paths.items():
            at, along = p.position[t], p.velocity[t]
            bend = float(p.curvature[t]) if np.isfinite(p.curvature[t]) else None
            yield [*head, name, *map(float, (*at, *along, p.speed[t])), bend]


def _checks(m: LinkageMotion) -> Iterator[list[Cell]]:
    p = m.ledger
    for t, head in _instants(m):
        powers = (p.drives, p.gravity, p.applied, p.friction, p.kinetic_rate)
        shaking = (*m.shaking_force[t], m.shaking_moment[t], m.condition[t])
        yield [*head, *(float(x) for x in shaking), *(float(x[t]) for x in powers)]

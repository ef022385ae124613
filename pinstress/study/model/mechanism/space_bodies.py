"""Bodies of a study's mechanism in space, with their masses, centres and inertia."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from loads import LinkageError
from loads.space.linkage import Inertia, RigidBody, Vector
from pinbase.arrays import Floats
from pinstress.study.model.mechanism.masses import body_mass
from pinstress.study.model.mechanism.parts import knows_centre, missing_centre
from pinstress.study.reading.file import Study
from pinstress.study.schema.space import SpaceBarTable, SpaceBodyTable, SpaceMechanismTable

# The least component across a bar of a unit vector that gives a direction across it
MIN_ACROSS = math.sin(math.radians(1.0))


def body_in_space(
    study: Study, mechanism: SpaceMechanismTable, name: str, b: SpaceBodyTable
) -> RigidBody:
    """Return a body with its mass, centre and inertia; those of a bar follow from its section.

    Raises: LinkageError for a missing mass or centre.
    """
    stated = None if b.inertia is None else _tensor(b.inertia)
    if b.bar is not None:
        first, second = (np.array(mechanism.joint[j].at) for j in b.bar.joints)
        mass, inertia = _bar(name, b.bar, second - first)
        centre: Vector = tuple((0.5 * (first + second)).tolist())
        return RigidBody(name, mass, centre, inertia if stated is None else stated)
    mass = body_mass(study, name, b, math.hypot(*mechanism.gravity))
    middle = b.centre
    if middle is None:
        on = [
            joint.at
            for joint in mechanism.joint.values()
            if name in (joint.fixed_in, *joint.connections.values())
        ]
        if not on or (mass and not knows_centre(mechanism, name)):
            raise missing_centre(name, len(on), "[x, y, z]")
        middle = tuple(np.mean(on, axis=0).tolist())
    body = RigidBody(name, mass, middle)
    return body if stated is None else replace(body, inertia=stated)


def _tensor(entries: list[float]) -> Inertia:
    xx, yy, zz, xy, xz, yz = (*entries, 0.0, 0.0, 0.0)[:6]
    return (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)


def _bar(name: str, bar: SpaceBarTable, along: Floats) -> tuple[float, Inertia]:
    """Return the mass (kg) and the inertia (kg m^2, world axes as drawn) of a bar.

    along: (3,) m, from the first joint to the second.
    """
    length = float(np.linalg.norm(along))
    if not length:
        raise LinkageError(
            f"body {name}: the two joints of its bar coincide", "same-joint", ("body", name)
        )
    e = along / length
    if bar.section is None or bar.depth_along is None:
        d = bar.diameter or 0.0
        mass = bar.density * math.pi / 4.0 * d**2 * length
        axial, across = mass * d**2 / 8.0, mass * (length**2 / 12.0 + d**2 / 16.0)
        return mass, _rows(axial * np.outer(e, e) + across * (np.eye(3) - np.outer(e, e)))
    depth, width = bar.section
    mass = bar.density * depth * width * length
    a = np.array(bar.depth_along) / np.linalg.norm(bar.depth_along)
    a = a - (a @ e) * e
    if not np.linalg.norm(a) > MIN_ACROSS:
        raise LinkageError(
            f"body {name}: depth_along is along the bar; give a direction across it",
            "no-direction",
            ("body", name),
        )
    a = a / np.linalg.norm(a)
    b = np.cross(e, a)
    squares = {"e": depth**2 + width**2, "a": length**2 + width**2, "b": length**2 + depth**2}
    tensor = sum(
        mass / 12.0 * squares[key] * np.outer(axis, axis)
        for key, axis in (("e", e), ("a", a), ("b", b))
    )
    return mass, _rows(np.asarray(tensor))


def _rows(tensor: Floats) -> Inertia:
    xx, yy, zz = (tuple(row) for row in tensor.tolist())
    return xx, yy, zz

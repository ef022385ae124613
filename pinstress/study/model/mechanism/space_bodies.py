"""Masses, centres and inertias of the bodies of a study's mechanism in space."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from loads import LinkageError
from loads.space.linkage import Inertia, RigidBody, Vector
from pinbase.arrays import Floats
from pinstress.study.model.mechanism.masses import body_mass
from pinstress.study.reading.file import Study
from pinstress.study.schema.space import SpaceBarTable, SpaceBodyTable, SpaceMechanismTable

MIN_ACROSS = 1.0 - math.cos(math.radians(1.0))  # part across a bar of a direction that is across


def rigid_body(
    study: Study, mechanism: SpaceMechanismTable, name: str, b: SpaceBodyTable
) -> RigidBody:
    """Return a body by its table: mass, centre and inertia are stated, or those of its bar.

    Raises: LinkageError, InputError.
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
        if not on or (len(on) > 2 and mass):
            raise LinkageError(
                f"body {name}: a body with {len(on)} joints needs a centre = [x, y, z]",
                "missing-centre",
                ("body", name),
            )
        middle = tuple(np.mean(on, axis=0).tolist())
    body = RigidBody(name, mass, middle)
    return body if stated is None else replace(body, inertia=stated)


def _tensor(entries: list[float]) -> Inertia:
    xx, yy, zz, xy, xz, yz = (*entries, 0.0, 0.0, 0.0)[:6]
    return (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)


def _bar(name: str, bar: SpaceBarTable, along: Floats) -> tuple[float, Inertia]:
    """Return mass (kg) and inertia (kg m^2, world axes as drawn) of a bar from its first to its
    second joint, `along` (3,) m.
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

"""Forces on a linkage in space, from a study's loads, springs and tables."""

from __future__ import annotations

import math
from collections.abc import Sequence

from loads import Clock, Measure, Varying
from loads.space.acting import Coordinate, SpaceForce, SpaceSpring
from loads.space.ground import GroundInertia, TurningGround
from loads.space.linkage import SpaceLinkage, Vector
from loads.space.motion import SpaceMotion
from pinbase.keys import key_part
from pinstress.study.model.impulses import nominal_size
from pinstress.study.model.mechanism.forces import (
    angle_column,
    column,
    curve,
    line_law,
    require_centre,
    torsion_law,
)
from pinstress.study.model.mechanism.space import length_name, place, space_mechanism, spring_name
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import ApplyTable, MechanismCase
from pinstress.study.schema.drives import drive_name
from pinstress.study.schema.forces import ForceLawTable

NOTHING: Vector = (0.0, 0.0, 0.0)


def springs_in_space(study: Study, linkage: SpaceLinkage) -> tuple[SpaceSpring, ...]:
    """Return the springs and dampers of a mechanism.

    Raises: InputError.
    """
    mechanism = space_mechanism(study)
    drawn = {m.name: m.drawn for m in linkage.measured}
    out = []
    for name, spring in mechanism.spring.items():
        along = spring_name(name)
        out.append(SpaceSpring(name, along, line_law(study, name, spring, drawn[along])))
    for name, torsion in mechanism.torsion_spring.items():
        along = spring_name(name, "torsion spring")
        out.append(SpaceSpring(name, along, torsion_law(study, name, torsion)))
    return tuple(out)


def ground_inertia(case: MechanismCase) -> GroundInertia | None:
    """Return the inertia forces due to the motion of the ground in a case; None if the ground is at
    rest.
    """
    if (moved := case.ground_motion) is None:
        return None
    straight = moved.path == "straight"
    return GroundInertia(
        TurningGround(
            moved.velocity, moved.acceleration, moved.axis, moved.rate, moved.rate_change, straight
        )
    )


def applied_in_space(
    study: Study, name: str, case: MechanismCase, linkage: SpaceLinkage
) -> list[tuple[SpaceForce, ...]]:
    """Return the loads of a case; a load with tables gives several forces.

    Raises: InputError.
    """
    return [load_in_space(study, name, k, case.apply[k], linkage) for k in range(len(case.apply))]


def load_in_space(
    study: Study,
    case: str,
    number: int,
    table: ApplyTable,
    linkage: SpaceLinkage,
    size: float | None = None,
) -> tuple[SpaceForce, ...]:
    """Return load number `number` of a case, from 0.

    size: of its impulse, N, by default as stated.

    Raises: InputError.
    """
    force = NOTHING if table.force is None else vector(table.force)
    if table.impulse is not None:
        nominal = nominal_size(table.impulse)
        force = along(table.impulse.direction, nominal if size is None else size)
    if table.at is None:
        if any(force) or table.force_law is not None:
            require_centre(study, f"case.{key_part(case)}.apply[{number + 1}]", table.body)
        at = next(body.centre for body in linkage.bodies if body.name == table.body)
    else:
        stated = table.at if isinstance(table.at, str) else vector(table.at)
        at = place(space_mechanism(study), stated)
    begin = table.begin or -math.inf  # a load from time 0 acts at time 0, too
    end = math.inf if table.end is None else table.end

    def acting(
        force: Vector, couple: Vector, factor: Varying[SpaceMotion] | None = None
    ) -> SpaceForce:
        return SpaceForce(
            table.body, at, force, couple, table.follows, times=factor, begin=begin, end=end
        )

    couple = table.moments
    out = [acting(force, couple)] if any(force) or any(couple) else []
    laws = (("force_law", "force", table.direction), ("couple_law", "moment", table.couple_axis))
    for key, value, direction in laws:
        law: ForceLawTable | None = getattr(table, key)
        if law is not None and direction is not None:
            where = f"case.{key_part(case)}.apply[{number + 1}].{key}"
            factor = _factor(study, where, law, value)
            one = along(direction, 1.0)
            force, couple = (one, NOTHING) if value == "force" else (NOTHING, one)
            out.append(acting(force, couple, factor))
    return tuple(out)


def vector(components: Sequence[float]) -> Vector:
    """Return three components as a vector."""
    x, y, z = components
    return x, y, z


def along(direction: Sequence[float], size: float) -> Vector:
    """Return the vector of a size in a direction."""
    x, y, z = direction
    scale = size / math.hypot(x, y, z)
    return x * scale, y * scale, z * scale


def _factor(
    study: Study, where: str, law: ForceLawTable, value: str
) -> Varying[SpaceMotion] | None:
    measure: Measure[SpaceMotion] = Clock()
    if law.length_between is not None:
        measure = Coordinate(length_name(law.length_between))
        x = column(study, "length", "length")
    elif law.position_of is not None:
        measure = Coordinate(law.position_of)
        drive = next(d for d in space_mechanism(study).drive if drive_name(d) == law.position_of)
        slides = drive.slides
        x = column(study, "position", "length") if slides else angle_column("position_deg")
    else:
        x = column(study, "time", "time")
    table = curve(study, where, law, x, (value, value))
    return None if table is None else Varying(measure, table)

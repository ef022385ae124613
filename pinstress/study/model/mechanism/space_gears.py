"""Meshing teeth of the gears and racks of a study in space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from loads import LinkageError
from loads.space.gears import Flanks, GearWheel, Mesh, axes_distance, gears_in_space, rack_in_space
from loads.space.linkage import ToothContact, unit
from pinbase.arrays import Floats
from pinstress.study.model.mechanism.drawing import shown_length
from pinstress.study.model.mechanism.gears import NAME_JOINT_REMEDY, require_reach, sizes_of
from pinstress.study.reading.file import Study
from pinstress.study.schema.gears import SpaceGearTable
from pinstress.study.schema.space import SpaceMechanismTable, drivable


def gear_in_space(study: Study, mechanism: SpaceMechanismTable, name: str) -> Mesh:
    """Return a pair of gears.

    Raises: LinkageError.
    """
    table, key = mechanism.gear[name], ("gear", name)
    wheels = tuple(
        _wheel(mechanism, body, joint, key)
        for body, joint in zip(table.bodies, table.joints, strict=True)
    )
    first, second = wheels
    on = [_on(mechanism, joint) for joint in table.joints]
    carriers = [b for b in on[0] if b in on[1] and b not in table.bodies]
    if not carriers:
        raise LinkageError(
            f"gear {name}: no third body has both joints {' and '.join(table.joints)}, which would "
            "keep them in place; add such a carrier (or the ground) to them",
            "no-carrier",
            key,
        )
    if (distance := axes_distance(first, second)) is not None:
        require_reach(name, table, distance, lambda length: shown_length(study, length))
    return gears_in_space(
        name,
        (first, second),
        carriers[0],
        sizes_of(table),
        _radius(table),
        Flanks(table.pressure_angle, table.helix_angle),
        table.at,
    )


def rack_of(study: Study, mechanism: SpaceMechanismTable, name: str) -> Mesh:
    """Return a gear and a rack.

    Raises: LinkageError.
    """
    table, key = mechanism.rack[name], ("rack", name)
    pinion = _wheel(mechanism, table.pinion, table.joint, key)
    slide = mechanism.joint[table.slide]
    (connection,) = drivable(slide)[:1]
    base, moving = (
        slide.fixed_in or next(iter(slide.connections.values())),
        (slide.connections[connection]),
    )
    pair = (base, moving)
    carriers = [b for b in pair if b in _on(mechanism, table.joint)]
    if len(carriers) != 1 or table.pinion in pair or len(drivable(slide)) > 1:
        raise LinkageError(
            f"rack {name}: joint {table.slide} joins {' and '.join(_on(mechanism, table.slide))}; "
            f"one of two must have joint {table.joint}, about which {table.pinion} turns, and the "
            "other is the rack",
            "no-carrier",
            key,
        )
    assert slide.axis is not None
    body = moving if carriers[0] == base else base
    along = unit(slide.axis)
    return rack_in_space(
        name,
        pinion,
        (body, connection, along if body == moving else -along),
        carriers[0],
        table.pitch_radius if table.side == "left" else -table.pitch_radius,
        Flanks(table.pressure_angle, table.helix_angle),
        table.at,
    )


def teeth_axes(teeth: ToothContact) -> Floats:
    """Return the axes at the contact of teeth as drawn, (3, 3), as columns: out of the first gear,
    along its pitch circle, and perpendicular to both.
    """
    normal = np.array(teeth.normal)
    across = np.cross(normal, teeth.along)
    across = across / np.linalg.norm(across)
    return np.stack([normal, np.cross(across, normal), across], axis=1)


def _radius(table: SpaceGearTable) -> float | None:
    """Return the pitch radius of the first gear, m; None if only numbers of teeth are given."""
    if table.radii is not None:
        return table.radii[0]
    if table.module is not None and table.teeth is not None:
        return 0.5 * table.module * table.teeth[0]
    return None


def _on(mechanism: SpaceMechanismTable, joint: str) -> Sequence[str]:
    """Return the bodies at a joint, including the one that carries the pin."""
    j = mechanism.joint[joint]
    return [*([j.fixed_in] if j.fixed_in else []), *j.connections.values()]


def _wheel(
    mechanism: SpaceMechanismTable, body: str, joint: str, key: tuple[str, str]
) -> GearWheel:
    """Return a gear about its joint.

    Raises: LinkageError if the body is not on the joint.
    """
    if body not in (on := _on(mechanism, joint)):
        raise LinkageError(
            f"{' '.join(key)}: joint {joint} is not on {body} but on {', '.join(on)}; "
            f"{NAME_JOINT_REMEDY}",
            "joint-not-on-body",
            key,
        )
    table = mechanism.joint[joint]
    assert table.axis is not None
    return GearWheel(body, table.at, unit(table.axis))

"""Meshing teeth of the gears and racks of a study in a plane."""

from __future__ import annotations

import math
from collections.abc import Callable

from loads import Gear, LinkageError, Rack, Slider, Teeth, gear_pair, rack_and_pinion
from pinstress.study.model.mechanism.drawing import Drawing
from pinstress.study.schema.gears import GearTable, RackTable

# Relative to the distance of the centres: the largest gap or overlap of pitch circles
CENTRE_DISTANCE_TOLERANCE = 1e-3
NAME_JOINT_REMEDY = "name the joint about which it turns"


def gears(name: str, table: GearTable, drawing: Drawing) -> Teeth:
    """Return a pair of gears.

    Raises: LinkageError.
    """
    key = ("gear", name)
    for body, joint in zip(table.bodies, table.joints, strict=True):
        drawing.require_on(joint, body, key, NAME_JOINT_REMEDY)
    first, second = (drawing.on(joint) for joint in table.joints)
    carriers = [b for b in first if b in second and b not in table.bodies]
    if not carriers:
        raise LinkageError(
            f"gear {name}: no third body has both joints {' and '.join(table.joints)}, which would "
            "keep the centres at their distance; add such a carrier (or the ground) to them",
            "no-carrier",
            key,
        )
    radii = sizes_of(table)
    centres = (drawing.at[table.joints[0]], drawing.at[table.joints[1]])
    require_reach(name, table, math.dist(*centres), drawing.shown)
    pair = (Gear(table.bodies[0], table.joints[0]), Gear(table.bodies[1], table.joints[1]))
    return gear_pair(name, pair, carriers[0], centres, radii, table.pressure_angle)


def sizes_of(table: GearTable) -> tuple[float, float]:
    """Return the pitch radii of gears, or the numbers of teeth; negative for a ring gear."""
    first, second = table.teeth or table.radii or (1.0, 1.0)
    if not table.internal:
        return first, second
    return (-first, second) if first > second else (first, -second)


def require_reach(
    name: str, table: GearTable, distance: float, shown: Callable[[float], str]
) -> None:
    """Raise LinkageError for pitch circles of stated size that do not touch.

    distance: of the centres, m. shown: formats a length (m) as text.
    """
    if table.teeth is not None and table.module is None:
        return
    unit = 1.0 if table.module is None else 0.5 * table.module
    needed = abs(unit * sum(sizes_of(table)))
    if abs(needed - distance) > CENTRE_DISTANCE_TOLERANCE * distance:
        raise LinkageError(
            f"gear {name}: the pitch circles touch when their centres are {shown(needed)} apart, "
            f"but the joints are {shown(distance)} apart; correct one of them (of gears with "
            "shifted profiles give teeth alone, and the pressure angle at work)",
            "gears-apart",
            ("gear", name),
        )


def rack(name: str, table: RackTable, drawing: Drawing, sliders: tuple[Slider, ...]) -> Teeth:
    """Return a gear and a rack.

    Raises: LinkageError.
    """
    key = ("rack", name)
    drawing.require_on(table.joint, table.pinion, key, NAME_JOINT_REMEDY)
    slider = next(s for s in sliders if s.name == table.slider)
    pair = (slider.base, slider.moving)
    carriers = [b for b in pair if b in drawing.on(table.joint)]
    if len(carriers) != 1 or table.pinion in pair:
        raise LinkageError(
            f"rack {name}: slider {slider.name} joins {' and '.join(pair)}; one of them must have "
            f"joint {table.joint}, about which {table.pinion} turns, and the other is the rack",
            "no-carrier",
            key,
        )
    toothed = pair[1] if carriers[0] == pair[0] else pair[0]
    radius, (x, y) = table.pitch_radius, slider.axis
    left = radius if table.side == "left" else -radius
    sides = (Gear(table.pinion, table.joint), Rack(toothed, slider.name))
    centre, to_rack = drawing.at[table.joint], (-left * y, left * x)
    return rack_and_pinion(name, sides, carriers[0], centre, to_rack, table.pressure_angle)

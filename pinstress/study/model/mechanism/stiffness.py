"""The stiffness of the links that state a section or a stiffness."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from loads import LinkageError
from loads.space.stiffness import LinkStiffness, flat_link, round_link
from pinbase.arrays import Floats
from pinstress.study.schema.mechanism import BarTable, BodyTable, LinkStiffnessTable
from pinstress.study.schema.space import SpaceBarTable, SpaceBodyTable, SpaceLinkStiffnessTable

RIGID = LinkStiffness(math.inf, math.inf, math.inf, math.inf)


def stated_stiffness(
    tables: Mapping[str, LinkStiffnessTable],
    bodies: Mapping[str, BodyTable | SpaceBodyTable],
    joints: Mapping[str, Sequence[Floats]],
) -> dict[str, LinkStiffness]:
    """Return the stiffness of the links that state one, by body; a bar without one has that of its
    section.

    joints: vectors from the centre of mass of each body to its joints, m.

    Raises: LinkageError for a stated stiffness of a link whose joints are all at its centre of
    mass.
    """
    stated = {
        name: _stiffness(table)
        if table.stiffness is None
        else _bar_like(name, table, joints.get(name, ()))
        for name, table in tables.items()
    }
    for name, body in bodies.items():
        if body.bar is not None and name not in stated:
            stated[name] = _of_bar(body.bar)
    return stated


def _bar_like(name: str, table: LinkStiffnessTable, joints: Sequence[Floats]) -> LinkStiffness:
    """Return the round bar that deflects as much as stated at the farthest joint of a link."""
    assert table.stiffness is not None
    arm = max((float(np.linalg.norm(joint)) for joint in joints), default=0.0)
    if not arm:
        raise LinkageError(
            f"body {name}: all its joints are at its centre of mass, where it has no stiffness; "
            "give a diameter, section, or rigid = true",
            "no-arm",
            ("link_stiffness", name),
        )
    inertia = table.stiffness * arm**3 / (3.0 * table.youngs_modulus)
    return round_link((64.0 * inertia / math.pi) ** 0.25, table.youngs_modulus)


def _of_bar(bar: BarTable) -> LinkStiffness:
    depth = bar.depth_along if isinstance(bar, SpaceBarTable) else None
    section = LinkStiffnessTable(diameter=bar.diameter, section=bar.section)
    return replace(_stiffness(section), depth=depth)


def _stiffness(table: LinkStiffnessTable) -> LinkStiffness:
    if table.section is not None:
        depth = table.depth_along if isinstance(table, SpaceLinkStiffnessTable) else None
        return replace(flat_link(*table.section, table.youngs_modulus), depth=depth)
    if table.diameter is not None:
        return round_link(table.diameter, table.youngs_modulus, table.bore)
    return RIGID

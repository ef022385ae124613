"""Stiffness of the links that state a section."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from loads.space.stiffness import LinkStiffness, flat_link, round_link
from pinstress.study.schema.mechanism import BarTable, BodyTable, LinkStiffnessTable
from pinstress.study.schema.space import SpaceBarTable, SpaceBodyTable, SpaceLinkStiffnessTable

RIGID = LinkStiffness(math.inf, math.inf, math.inf, math.inf)


def stated_stiffness(
    tables: Mapping[str, LinkStiffnessTable], bodies: Mapping[str, BodyTable | SpaceBodyTable]
) -> dict[str, LinkStiffness]:
    """Return the stiffness of the links that state one, by body; else a bar has its section's."""
    stated = {name: _stiffness(table) for name, table in tables.items()}
    for name, body in bodies.items():
        if body.bar is not None and name not in stated:
            stated[name] = _of_bar(body.bar)
    return stated


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

"""Where pins lie along their axes so that links are straight."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from loads.linkage.linkage import Linkage
from loads.linkage.parts import GROUND
from pinbase.arrays import Floats


def straight(
    linkage: Linkage, middles: Mapping[str, float], stated: Mapping[str, float]
) -> tuple[dict[str, float], dict[str, float]]:
    """Place pins along z so that each link meets all its pins at one height, as near as can be.

    linkage: planar.
    middles: z of the middle of a connection's band from the start of its pin, m; 0 of others.
    stated: z of the start of a joint's pin, m.

    Returns: z of every connection, m, and of every body how far its connections lie from its
    middle plane, m. Where no z is stated the mean of all connections is at z = 0.
    """
    free = [j.name for j in linkage.joints if j.name not in stated]
    bodies = [b.name for b in linkage.bodies]
    rows, sides = list[Floats](), list[float]()
    for joint, connection in linkage.connections:
        if connection.body == GROUND:
            continue
        row = np.zeros(len(free) + len(bodies))
        if joint.name in stated:
            sides.append(-stated[joint.name] - middles.get(connection.name, 0.0))
        else:
            row[free.index(joint.name)] = 1.0
            sides.append(-middles.get(connection.name, 0.0))
        row[len(free) + bodies.index(connection.body)] = -1.0
        rows.append(row)
    for slider in linkage.sliders:  # one body slides along the other at the same height
        if GROUND not in (slider.base, slider.moving):
            row = np.zeros(len(free) + len(bodies))
            row[len(free) + bodies.index(slider.base)] = 1.0
            row[len(free) + bodies.index(slider.moving)] = -1.0
            rows.append(row)
            sides.append(0.0)
    placed = np.linalg.lstsq(np.array(rows), np.array(sides), rcond=None)[0].tolist()
    start = {**dict(zip(free, placed, strict=False)), **stated}
    at = {c.name: start[j.name] + middles.get(c.name, 0.0) for j, c in linkage.connections}
    if not stated:
        mean = sum(at.values()) / len(at)
        at = {name: z - mean for name, z in at.items()}
    return at, {body: _spread(linkage, body, at) for body in bodies}


def _spread(linkage: Linkage, body: str, at: Mapping[str, float]) -> float:
    """Largest distance of a body's connections from their middle plane, m."""
    z = [at[c.name] for _, c in linkage.connections if c.body == body]
    return 0.5 * (max(z) - min(z)) if z else 0.0

"""Where pins lie along their axes so that links are straight."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from loads.linkage.linkage import Linkage
from loads.linkage.parts import GROUND
from pinbase.arrays import Floats


def straight(
    linkage: Linkage,
    middles: Mapping[str, float],
    stated: Mapping[str, float],
    roots: Mapping[str, float] | None = None,
) -> tuple[dict[str, float], dict[str, float]]:
    """Place pins along z so that each link meets all its pins at one height, as near as can be.

    linkage: planar.
    middles: z of the middle of a connection's band from the start of its pin, m; 0 of others.
    stated: z of the start of a joint's pin, m.
    roots: z at which the body that carries a joint's pin holds it, from its start, m; of others
    the mean of the links on it. Where a pin's z is stated it may lie beside the body.

    Returns: z of every connection, m, and of every body how far its connections and the pins that
    it carries lie from its middle plane, m. Links that no z places have theirs at z = 0 in the
    mean.
    """
    free = [j.name for j in linkage.joints if j.name not in stated]
    bodies = [b.name for b in linkage.bodies]
    rows, sides = list[Floats](), list[float]()
    fixed = {j.name: j.fixed_in for j in linkage.joints if j.name in free}
    meetings = _meetings(linkage, middles, roots or {}, fixed)
    for body, joint, height in meetings:
        row = np.zeros(len(free) + len(bodies))
        if joint in stated:
            sides.append(-stated[joint] - height)
        else:
            row[free.index(joint)] = 1.0
            sides.append(-height)
        row[len(free) + bodies.index(body)] = -1.0
        rows.append(row)
    for slider in linkage.sliders:  # one body slides along the other at the same height
        if GROUND not in (slider.base, slider.moving):
            row = np.zeros(len(free) + len(bodies))
            row[len(free) + bodies.index(slider.base)] = 1.0
            row[len(free) + bodies.index(slider.moving)] = -1.0
            rows.append(row)
            sides.append(0.0)
    placed, _, rank, _ = np.linalg.lstsq(np.array(rows), np.array(sides), rcond=None)
    loose = np.linalg.svd(np.array(rows))[2][rank:].T  # what still moves along z
    placed = (
        placed - loose @ np.linalg.lstsq(loose[len(free) :], placed[len(free) :], rcond=None)[0]
    )
    start = {**dict(zip(free, placed.tolist(), strict=False)), **stated}
    at = {c.name: start[j.name] + middles.get(c.name, 0.0) for j, c in linkage.connections}
    askew = {}
    for body in bodies:
        z = [start[joint] + height for b, joint, height in meetings if b == body]
        askew[body] = 0.5 * (max(z) - min(z)) if z else 0.0
    return at, askew


def _meetings(
    linkage: Linkage,
    middles: Mapping[str, float],
    roots: Mapping[str, float],
    carriers: Mapping[str, str | None],
) -> list[tuple[str, str, float]]:
    """Every body on a joint but the ground, the joint, and the body's height on its pin, m.

    carriers: of the pins that lie where their carriers are, by joint.
    """
    out = [(c.body, j.name, middles.get(c.name, 0.0)) for j, c in linkage.connections]
    for joint in linkage.joints:
        if (carrier := carriers.get(joint.name)) is not None:
            mean = float(np.mean([middles.get(c.name, 0.0) for c in joint.connections]))
            out.append((carrier, joint.name, roots.get(joint.name, mean)))
    return [meeting for meeting in out if meeting[0] != GROUND]

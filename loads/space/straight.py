"""Positions of pins along their axes at which links are straight."""

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
    """Place pins along z so that each link meets all its pins at one height, as nearly as possible.

    linkage: planar linkage.
    middles: z of the middle of a connection's band from the start of its pin, m, by connection; 0
    for others.
    stated: z of the start of a pin, m, by joint.
    roots: z from the start of a pin at which its body carries it, m, by joint; for others the mean
    of the links on the pin. A pin whose z is stated may lie beside the body that carries it.

    Returns the z of every connection, m; and for every body the largest distance of its connections
    and of the pins that it carries from its middle plane, m. Links whose z nothing determines have
    a mean z of 0.
    """
    # Unknowns: the starts of the pins whose z is not stated, then the middle planes of the bodies.
    # Each body on a pin gives an equation: its height on the pin is in its middle plane.
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
    # Movements along z that nothing determines are chosen so that the middle planes of the bodies
    # are as close to z = 0 as possible.
    loose = np.linalg.svd(np.array(rows))[2][rank:].T
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
    """Every body (except the ground) on a joint, the joint, and the body's height on its pin, m.

    carriers: body that carries the pin, by joint, of the pins whose z is not stated.
    """
    out = [(c.body, j.name, middles.get(c.name, 0.0)) for j, c in linkage.connections]
    for joint in linkage.joints:
        if (carrier := carriers.get(joint.name)) is not None:
            mean = float(np.mean([middles.get(c.name, 0.0) for c in joint.connections]))
            out.append((carrier, joint.name, roots.get(joint.name, mean)))
    return [meeting for meeting in out if meeting[0] != GROUND]

"""Pitch points and forces of gears in space, and the rows of their equations."""

from __future__ import annotations

import numpy as np

from loads.space.linkage import SpaceLinkage
from loads.space.pose import BODY_COORDINATES, SpacePose, turning
from pinbase.arrays import Floats


def pitch_points(linkage: SpaceLinkage, pose: SpacePose) -> list[tuple[Floats, Floats, Floats]]:
    """Pitch point (m), force per newton along the pitch circles, and normal of all teeth.

    They are (T, 3) each.
    """
    out = []
    for _, _, teeth in linkage.teeth:
        k = linkage.index[teeth.carrier]
        turn = pose.rotation[:, k]
        at = pose.centre[:, k] + pose.arm(k, teeth.at)
        out.append((at, turn @ np.array(teeth.along), turn @ np.array(teeth.normal)))
    return out


def write_tooth_rows(linkage: SpaceLinkage, pose: SpacePose, scale: Floats, J: Floats) -> None:
    """Write the speeds at which teeth slide along the pitch circles into the rows of the ratios.

    scale: (n,) length per unit of each coordinate.
    J: (T, ratios, n), rows of the ratios, for scaled coordinates; overwritten.
    """
    turns = turning(pose.turn)
    points = pitch_points(linkage, pose)
    for (k, _, teeth), (at, along, _) in zip(linkage.teeth, points, strict=True):
        J[:, k] = 0.0
        for body, sign in zip(teeth.bodies, (1.0, -1.0), strict=True):
            if (b := linkage.index[body]) == len(linkage.bodies):
                continue  # the ground does not move
            columns = slice(BODY_COORDINATES * b, BODY_COORDINATES * (b + 1))
            couple = np.cross(at - pose.centre[:, b], along)
            on_parameters = np.einsum("tj,tjk->tk", couple, turns[:, b])
            by_body = np.concatenate([along, on_parameters], axis=1) / scale[columns]
            J[:, k, columns] += sign * by_body


def tooth_forces(
    linkage: SpaceLinkage, pose: SpacePose, f: Floats, spread: Floats | None = None
) -> Floats:
    """Force (T, G, 3) N on the first body of all teeth.

    f: (T, ratios) N, multipliers of the ratios.
    spread: (T, G) N, forces that push the teeth apart; by default none.
    """
    out = np.zeros((len(f), len(linkage.teeth), 3))
    for g, (_, along, normal) in enumerate(pitch_points(linkage, pose)):
        out[:, g] = f[:, linkage.teeth[g][0], None] * along
        if spread is not None:
            out[:, g] -= spread[:, g, None] * normal
    return out

"""Changes of frame between a pin and a piece about its cuts."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from fea.core.pin_loads import Unit
from fea.core.voigt import rotation
from fea.harmonic.fields import MeridianFields
from geometry.mesh.cut_piece import Piece
from pinbase.arrays import Floats


def in_pin(moved: Floats, piece: Piece) -> Floats:
    """The rigid-body motions (2, 6, L) about the pin's origin, from those in the frame of a piece.

    moved: (2, 6, L) translations (m) and rotations (rad) of both ends of the piece.
    """
    turn = turn_of(piece.angle)
    shift, spin = (np.einsum("ab,ebl->eal", turn, x) for x in np.split(moved, 2, axis=1))
    arm = np.array([0.0, 0.0, piece.origin])
    shift = shift - np.cross(spin, arm[:, None], axisa=1, axisb=0, axisc=1)
    return np.concatenate([shift, spin], axis=1)


def turn_of(angle: float | Floats) -> Floats:
    """The rotation matrices (.., 3, 3) about z by angles (..), rad."""
    turn = np.zeros((*np.shape(angle), 3, 3))
    turn[..., 0, 0] = turn[..., 1, 1] = np.cos(angle)
    turn[..., 1, 0] = np.sin(angle)
    turn[..., 0, 1] = -turn[..., 1, 0]
    turn[..., 2, 2] = 1.0
    return turn


def on_skin(fields: MeridianFields, r: Floats, z: Floats) -> Floats:
    """The stress amplitudes (.., 6, K), Pa, at points (r, z), m, of the outline.

    They are interpolated between the two nearest of the fields' points on the outline.
    """
    skin = fields.points[: fields.skin]
    at = np.stack([r, z], axis=-1)
    near = np.asarray(cKDTree(skin).query(at, 4)[1])
    first = near[..., 0]
    step = skin[near] - skin[first][..., None, :]
    apart = np.linalg.norm(step, axis=-1)
    # The nearest point that does not coincide with the first one, as points do at ends of edges.
    other = np.take_along_axis(
        near, (apart > 1e-9 * np.ptp(skin[:, 1])).argmax(axis=-1)[..., None], -1
    )[..., 0]
    along = skin[other] - skin[first]
    part = np.sum((at - skin[first]) * along, axis=-1) / np.maximum(
        np.sum(along**2, axis=-1), 1e-300
    )
    part = np.clip(part, 0.0, 1.0)[..., None, None]
    stress = fields.stress[: fields.skin]
    return np.asarray((1.0 - part) * stress[first] + part * stress[other])


def cartesian(amplitude: Floats, angle: Floats, turned: float, units: tuple[Unit, ...]) -> Floats:
    """The stress (.., 6, L), Pa, along the axes of a frame that is turned about z.

    amplitude: (.., 6, L) Pa, along r, theta and z.
    angle: (..) rad, of the points in that frame.
    turned: rad, of the frame.
    """
    n, phase = (np.array(x) for x in ([load.n for load, _ in units], [p for _, p in units]))
    psi = n * (angle[..., None] + turned) - phase * np.pi / 2.0
    shears = np.array([False, False, False, True, False, True])[:, None]
    polar = amplitude * np.where(shears, np.sin(psi)[..., None, :], np.cos(psi)[..., None, :])
    return np.asarray(rotation(turn_of(angle)) @ polar)

"""The displacements of a pin with cuts: those of the uncut pin and those that the cuts add.

The ends of a local solid are free (fea.cut.local_model), and its cuts move them rigidly relative to
each other. So the pin below a piece stays in place, the pin above moves with the piece's upper end
relative to the lower, and finally the whole is moved back so that its first clamp stays in place.
"""

from __future__ import annotations

import numpy as np

from fea.core.local_fit import continuation
from fea.core.pin_loads import Unit
from fea.harmonic.fields import MeridianFields
from fea.solid.nodal_loads import vectors
from pinbase.arrays import Floats


def rigid(motion: Floats, x: Floats) -> Floats:
    """The displacements (P, 3, L), m, of points (P, 3), m, by rigid-body motions.

    motion: (6, L) translation (m) and rotation (rad) about the origin.
    """
    shift, turn = np.split(motion, 2)
    out = np.empty((len(x), 3, motion.shape[1]))
    for k in range(3):  # the cross product by components, since these arrays may be large
        after, before = (k + 1) % 3, (k + 2) % 3
        np.multiply(turn[after], x[:, [before]], out=out[:, k])
        out[:, k] -= turn[before] * x[:, [after]]
        out[:, k] += shift[k]
    return out


def axis_kept(moved: Floats, length: float) -> Floats:
    """The rigid-body motion (6, L), about the pin's start, that keeps both ends of its axis in
    place.

    A pin without clamps is supported like this (fea.harmonic.model).
    moved: (6, L) the motion of the pin's end while its start stays in place.
    length: m.
    """
    out = np.zeros_like(moved)
    out[3] = moved[3] - moved[1] / length
    out[4] = moved[4] + moved[0] / length
    return out


def displacement(
    fields: MeridianFields, r: Floats, z: Floats, angle: Floats, units: tuple[Unit, ...]
) -> Floats:
    """The displacement (P, 3, L), m, of the uncut pin under unit loads.

    r, z, angle: (P,) of the points, m and rad.
    """
    known = fields.points[: len(fields.displacement)]
    columns = [fields.loads.index(load) for load, _ in units]
    at = np.stack([r, z], axis=1)
    amplitude = np.asarray(
        continuation(known, at) @ fields.displacement[..., columns].reshape(len(known), -1)
    ).reshape(len(at), 3, -1)
    return of_units(amplitude, angle, units)


def of_units(amplitude: Floats, angle: Floats, units: tuple[Unit, ...]) -> Floats:
    """The displacements (P, 3, L), m, along x, y, z from amplitudes (P, 3, L) along r, theta and z.

    angle: (P,) rad, of the points.
    """
    n, phase = (np.array(x) for x in ([load.n for load, _ in units], [p for _, p in units]))
    turn = angle[:, None]
    return vectors(amplitude, n * turn - phase * np.pi / 2.0, turn, 1)

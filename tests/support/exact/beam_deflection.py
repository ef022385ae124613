"""Deflections of a stepped beam, by exact integration of its internal forces.

phi' = M / (E I)    u' = phi + V / (kappa G A)    w' = N / (E A)    beta' = T / (G J)
"""

from __future__ import annotations

import numpy as np

from fea.beam.timoshenko import AXIAL, MOMENT, SHEAR, TORQUE, InternalForces, compliances
from fea.core.material import Material
from pinbase.arrays import Floats


def deflections(forces: InternalForces, material: Material, z: Floats) -> Floats:
    """Return the deflection u along x (m), slope phi (rad), shift w along the axis (m) and twist
    beta (rad) at z (S,) in m: (S, 4, K).

    They are zero within clamps; for an unconstrained pin, zero at z = 0.
    """
    lengths = np.diff(forces.stations)
    soft = np.array([compliances(s, material) for s in forces.sections])
    K = forces.coefficients.shape[-1]
    out = np.zeros((len(lengths), 6, 4, K))  # powers of s
    for span in forces.spans:
        backwards = span.right and not span.left
        cells = range(span.first, span.last)
        value = np.zeros((4, K))
        for c in reversed(cells) if backwards else cells:
            out[c] = _cell(forces.coefficients[c], soft[c], value)
            if backwards:  # the start is shifted so that the end has the known value
                rise = _value(out[c], lengths[c]) - value
                turn = rise[1]
                out[c, 0] -= rise
                out[c, 0, 0] += turn * lengths[c]
                out[c, 1, 0] -= turn
                value = out[c, 0]
            else:
                value = _value(out[c], lengths[c])
    cells_at = np.searchsorted(forces.stations[1:-1], z, side="right")
    powers = (z - forces.stations[cells_at])[:, None] ** np.arange(6)
    found = np.einsum("sp,spqk->sqk", powers, out[cells_at])
    at_end = z >= forces.stations[-1]
    found[at_end] = _value(out[-1], lengths[-1])
    return np.asarray(found)


def _cell(f: Floats, soft: Floats, start: Floats) -> Floats:
    """Return the coefficients (6, 4, K) in one cell, from forces f (4, 4, K) and values (4, K) at
    its start.
    """
    out = np.zeros((6, *f.shape[1:]))
    by = np.arange(1.0, 5.0)[:, None]
    out[1:5, 1] = soft[MOMENT] * f[:, MOMENT] / by
    out[1:5, 2] = soft[AXIAL] * f[:, AXIAL] / by
    out[1:5, 3] = soft[TORQUE] * f[:, TORQUE] / by
    out[0] = start
    out[1:5, 0] = (out[:4, 1] + soft[SHEAR] * f[:, SHEAR]) / by
    out[5, 0] = out[4, 1] / 5.0
    return out


def _value(cell: Floats, s: float) -> Floats:
    return np.asarray(np.einsum("p,pqk->qk", s ** np.arange(6), cell))

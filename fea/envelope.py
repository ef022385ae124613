"""The maximum over all instants and the whole surface, by superposing unit fields.

Von Mises squared is a quadratic form of the stress, so at every point it is c . M c with the
instant's loads c: two matrix products cover any number of instants.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.solid import PinLoads, UnitFields
from fea.stress import VON_MISES

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Envelope:
    """maximum: largest von Mises stress, Pa, at `node` and `instant`. field: (S,) each surface
    node's largest over all instants. coefficients: (L,) loads at the governing instant, N.
    """

    maximum: float
    node: int
    instant: int
    location: tuple[float, float, float]
    field: Floats
    coefficients: Floats


def envelope(fields: UnitFields, loads: PinLoads) -> Envelope:
    """Largest von Mises stress over the surface and all instants of a case."""
    nodes = fields.surface.nodes
    s = fields.stress[nodes]
    c = fields.coefficients(loads)
    a, b = np.triu_indices(c.shape[1])
    form = np.einsum("nik,ij,njl->nkl", s, VON_MISES, s, optimize=True)[:, a, b]
    pairs = c[:, a] * c[:, b] * np.where(a == b, 1.0, 2.0)
    squares = form @ pairs.T
    field = np.sqrt(np.maximum(squares.max(axis=1), 0.0))
    where, when = np.unravel_index(int(np.argmax(squares)), squares.shape)
    x, y, z = fields.space.nodes[nodes[where]]
    return Envelope(
        maximum=float(field[where]),
        node=int(nodes[where]),
        instant=int(when),
        location=(float(x), float(y), float(z)),
        field=field,
        coefficients=c[when],
    )

"""Derivatives of the largest stress in each part of a pin, on one mesh and with shared matrices.

The parts show which place may govern next, in addition to the one that governs now.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from assess.derivatives.derivatives import Adjoint
from assess.derivatives.records import SolvedCase
from fea.core.pin_loads import PinLoads
from fea.harmonic.free_surface import reader
from fea.harmonic.superposition import Crest
from geometry.mesh.outline_motion import NodeMotion, OtherShapeError
from geometry.shape.dimensions import Dimension
from pinbase.arrays import Floats, Mask

Parts = Sequence[tuple[str, Mask]]


@dataclass(frozen=True)
class PartTop:
    """The largest stress at any instant of a case in a part of the pin, outside its zones."""

    part: str
    case: str
    top: Crest


def halves(stations: Sequence[float], points: Floats) -> Parts:
    """Return the first and the second half of every segment: their names and the masks (S,) of the
    points in them.

    stations: the ends of the segments, m.
    points: (S, 2) r and z, m.
    """
    out = []
    last = len(stations) - 2
    for k, (a, b) in enumerate(pairwise(stations)):
        middle = 0.5 * (a + b)
        low = -np.inf if k == 0 else a
        high = np.inf if k == last else b
        z = points[:, 1]
        out.append((f"segment {k + 1}, start", (z >= low) & (z < middle)))
        out.append((f"segment {k + 1}, end", (z >= middle) & (z < high)))
    return out


class PartsOfSection:
    """The largest stress in each part of a pin, for load cases solved on one mesh, and its
    derivatives by dimensions.
    """

    def __init__(self, dimensions: tuple[Dimension, ...]) -> None:
        self._dimensions = dimensions
        self._first: Adjoint | None = None
        self._motions: dict[tuple[object, ...], list[NodeMotion]] = {}

    def tops(self, solved: SolvedCase, loads: PinLoads, parts: Parts) -> list[PartTop]:
        """Return the largest stress in each part that has points outside the excluded zones.

        loads: at all instants.
        """
        around = reader(solved.solution.fields, loads, solved.material.poisson_ratio)
        outside = around.fields.outside(solved.zones)
        return [
            PartTop(part, loads.case, around.top(outside & mask))
            for part, mask in parts
            if (outside & mask).any()
        ]

    def slopes(self, solved: SolvedCase, loads: PinLoads, part_top: PartTop, mask: Mask) -> Floats:
        """Return the derivatives (n,), Pa/m, of a part's largest stress by the n dimensions; 0 for
        a dimension without a derivative.

        mask: (S,) points of the part.

        Raises: SolveError.
        """
        now = replace(solved, loads=loads.at(np.array([part_top.top.instant])), history=None)
        adjoint = Adjoint(now, mask, self._first)
        self._first = self._first or adjoint
        zones = tuple(solved.zones)
        if zones not in self._motions:
            self._motions[zones] = self._moving(adjoint)
        by_key = adjoint.by_motions(self._motions[zones])
        return np.array([by_key.get(d.key, 0.0) for d in self._dimensions])

    def _moving(self, adjoint: Adjoint) -> list[NodeMotion]:
        """Return the motion of the outline for each dimension that has one."""
        out = []
        for dimension in self._dimensions:
            try:
                out.append(adjoint.outline_nodes.motion(dimension))
            except OtherShapeError:
                continue
        return out

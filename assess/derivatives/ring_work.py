"""The derivative of the flexibility of a pin or lug on its rings by shape and material.

For each harmonic the flexibility is C = f^T K^-1 f over the area of the rings; f are the forces of
a unit pressure on each ring. With pressures p and l and their displacements u and v, the work
l^T C p changes by - (v^T K u)' and by the change of the forces. The forces of a ring are
proportional to its area. The caller accounts for this area, because its p and l are forces on
cells. The reaction that guides a lug also changes with the shape of the lug.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from assess.derivatives.virtual_work import shape_gradient, work
from fea.core.material import Material
from fea.harmonic.assembly import around, elasticity
from fea.support.contact.flexibility import RingBody
from geometry.mesh.outline_motion import DIFFERENCE_STEPS, rate_of
from pinbase.arrays import Floats


@dataclass(frozen=True)
class Pair:
    """Two pressures of harmonic n on the rings, p and l (R,); `times` multiplies their work."""

    n: int
    times: float
    p: Floats
    l: Floats  # noqa: E741


@dataclass(frozen=True)
class _SolvedPair:
    """The forces without reactions and the displacements of a pair, (unknowns, 2), for p and l."""

    n: int
    times: float
    forces: Floats
    u: Floats


class RingWork:
    """Derivatives of minus the sum of the works l^T C p, N m, for a body and all identical bodies.
    The forces on the rings do not change.

    pairs: the pairs of pressures of each body, by the name of the body.
    """

    def __init__(self, on: RingBody, pairs: Mapping[str, Sequence[Pair]]) -> None:
        self.on, self.space = on, on.body.space
        self._solved_pairs: dict[str, list[_SolvedPair]] = {name: [] for name in pairs}
        every = sorted(((x.n, name, x) for name, some in pairs.items() for x in some), key=_order)
        # All pairs of a harmonic are solved together, then assigned to their bodies.
        for n, same in groupby(every, key=_order):
            some = list(same)
            forces = on.forces(n) @ np.stack([y for *_, x in some for y in (x.p, x.l)], axis=1)
            u = on.body.displace(n, on.balanced(n, forces))
            for k, (_, name, x) in enumerate(some):
                both = slice(2 * k, 2 * k + 2)
                solved = _SolvedPair(n, x.times / around(n), forces[:, both], u[:, both])
                self._solved_pairs[name].append(solved)
        D = self._elastic(on.body.materials)
        self._gradient = {
            name: sum(
                (x.times * shape_gradient(self.space, D, x.n, *x.u.T) for x in some),
                np.zeros((len(self.space.nodes), 2)),
            )
            for name, some in self._solved_pairs.items()
        }

    def by_shape(self, name: str, velocity: Floats) -> float:
        """Return the derivative along a motion of the nodes with velocity (N, 2)."""
        return float(np.sum(self._gradient[name] * velocity))

    def by_reaction(
        self, name: str, velocity: Floats, lengths: Sequence[float], step: float
    ) -> float:
        """Return the part of the derivative by shape that is due to the reaction of a guide.

        lengths: the length of the body, m, at each of DIFFERENCE_STEPS times `step`.
        """
        total, outline = 0.0, self.on.body.outline
        for x in self._solved_pairs[name]:
            if self.on.guided and x.n == 1:
                moved = (
                    self.on.reacted(
                        outline.moved(self.space.nodes + at * step * velocity), length, x.forces
                    )
                    for at, length in zip(DIFFERENCE_STEPS, lengths, strict=True)
                )
                total -= x.times * float(np.sum(rate_of(list(moved), step) * x.u[:, ::-1]))
        return total

    def by_material(self, name: str, rates: Sequence[Floats]) -> float:
        """Return the derivative by material.

        rates: (6, 6) derivative of the elasticity of each part of the body.
        """
        D = self._by_element(rates)
        return sum(x.times * work(self.space, D, x.n, *x.u.T) for x in self._solved_pairs[name])

    def _elastic(self, materials: Material | Sequence[Material]) -> Floats:
        parts = (materials,) if isinstance(materials, Material) else materials
        return self._by_element([elasticity(one) for one in parts])

    def _by_element(self, of_parts: Sequence[Floats]) -> Floats:
        return of_parts[0] if self.space.parts is None else np.stack(of_parts)[self.space.parts]


def _order(one: tuple[int, str, Pair]) -> int:
    return one[0]

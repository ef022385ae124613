"""How the flexibility of a pin or of a lug on its rings changes with its shape and its material.

Of each harmonic it is C = f^T K^-1 f over the area of the rings, f the forces of a pressure of one
on each. With pressures p and l and their displacements u and v the work l^T C p changes by
- (v^T K u)' and by what forces do. Those of a ring go with its area, of which whoever has p and l
as forces on cells has to know; the reaction that guides a lug turns with its shape, too.
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
    """Pressures of harmonic n on rings, p and l (R,), and how often their work counts."""

    n: int
    times: float
    p: Floats
    l: Floats  # noqa: E741


@dataclass(frozen=True)
class _Answered:
    """A pair's forces without reactions and displacements, of p and of l, (unknowns, 2)."""

    n: int
    times: float
    forces: Floats
    u: Floats


class RingWork:
    """Of a body, and of the pairs of each of those that are like it, by name: rates of minus the
    sum of their works l^T C p, N m, the forces on the rings as they are.
    """

    def __init__(self, on: RingBody, pairs: Mapping[str, Sequence[Pair]]) -> None:
        self.on, self.space = on, on.body.space
        self._answered: dict[str, list[_Answered]] = {name: [] for name in pairs}
        every = sorted(((x.n, name, x) for name, some in pairs.items() for x in some), key=_order)
        for n, same in groupby(every, key=_order):
            some = list(same)
            forces = on.forces(n) @ np.stack([y for *_, x in some for y in (x.p, x.l)], axis=1)
            u = on.body.displace(n, on.balanced(n, forces))
            for k, (_, name, x) in enumerate(some):
                both = slice(2 * k, 2 * k + 2)
                found = _Answered(n, x.times / around(n), forces[:, both], u[:, both])
                self._answered[name].append(found)
        D = self._elastic(on.body.materials)
        self._gradient = {
            name: sum(
                (x.times * shape_gradient(self.space, D, x.n, *x.u.T) for x in some),
                np.zeros((len(self.space.nodes), 2)),
            )
            for name, some in self._answered.items()
        }

    def by_shape(self, name: str, velocity: Floats) -> float:
        """With the nodes' velocity (N, 2)."""
        return float(np.sum(self._gradient[name] * velocity))

    def by_reaction(
        self, name: str, velocity: Floats, lengths: Sequence[float], step: float
    ) -> float:
        """What the reaction of a guide adds to that; lengths: of the body, m, at PLACES times a
        step.
        """
        total, outline = 0.0, self.on.body.outline
        for x in self._answered[name]:
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
        """With the rate (6, 6) of the elasticity of each part."""
        D = self._by_element(rates)
        return sum(x.times * work(self.space, D, x.n, *x.u.T) for x in self._answered[name])

    def _elastic(self, materials: Material | Sequence[Material]) -> Floats:
        each = (materials,) if isinstance(materials, Material) else materials
        return self._by_element([elasticity(one) for one in each])

    def _by_element(self, each: Sequence[Floats]) -> Floats:
        return each[0] if self.space.parts is None else np.stack(each)[self.space.parts]


def _order(one: tuple[int, str, Pair]) -> int:
    return one[0]

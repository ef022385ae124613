"""The change of a pin's or lug's flexibility on its rings with its shape and material.

For each harmonic the flexibility is C = f^T K^-1 f over the area of the rings, f the forces of a
unit pressure on each. With pressures p and l and their displacements u and v the work l^T C p
changes by - (v^T K u)' and by the change of forces. The forces of a ring are proportional to its
area, which the caller accounts for, who has p and l as forces on cells; the reaction that guides a
lug turns with its shape, too.
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
    """Pressures of harmonic n on rings, p and l (R,), and how many times their work counts."""

    n: int
    times: float
    p: Floats
    l: Floats  # noqa: E741


@dataclass(frozen=True)
class _SolvedPair:
    """A pair's forces without reactions, and displacements, (unknowns, 2) each, of p and l."""

    n: int
    times: float
    forces: Floats
    u: Floats


class RingWork:
    """Rates of minus the sum of works l^T C p, N m, for a body and all bodies like it.

    pairs: those of each body, by its name. The forces on the rings stay as they are.
    """

    def __init__(self, on: RingBody, pairs: Mapping[str, Sequence[Pair]]) -> None:
        self.on, self.space = on, on.body.space
        self._solved_pairs: dict[str, list[_SolvedPair]] = {name: [] for name in pairs}
        every = sorted(((x.n, name, x) for name, some in pairs.items() for x in some), key=_order)
        # All pairs of a harmonic are solved at once, then sorted by body.
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
        """The rate with the nodes' velocity (N, 2)."""
        return float(np.sum(self._gradient[name] * velocity))

    def by_reaction(
        self, name: str, velocity: Floats, lengths: Sequence[float], step: float
    ) -> float:
        """The part of that rate by the reaction of a guide.

        lengths: of the body, m, at DIFFERENCE_STEPS times a step.
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
        """The rate with the rates (6, 6) of the elasticity of each part."""
        D = self._by_element(rates)
        return sum(x.times * work(self.space, D, x.n, *x.u.T) for x in self._solved_pairs[name])

    def _elastic(self, materials: Material | Sequence[Material]) -> Floats:
        parts = (materials,) if isinstance(materials, Material) else materials
        return self._by_element([elasticity(one) for one in parts])

    def _by_element(self, of_parts: Sequence[Floats]) -> Floats:
        return of_parts[0] if self.space.parts is None else np.stack(of_parts)[self.space.parts]


def _order(one: tuple[int, str, Pair]) -> int:
    return one[0]

"""Forces in every connection and slider, from the forces that bodies need and those at closures.

Cutting one member of the tree splits off the items beyond it: the force through it is what these
items need, less what closures and teeth bring to them. No system is solved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loads.linkage.linkage import Turn
from loads.motion.loop_equations import Loops, cross
from pinbase.arrays import Complex, Floats


@dataclass(frozen=True)
class Members:
    """Weights (members, items) and (members, closures and teeth) of the two contributions."""

    from_items: Floats
    from_closures: Floats

    def forces(self, needed: Complex, closing: Complex) -> Complex:
        """(T, members) N, from (T, items) and (T, closures and teeth)."""
        return np.asarray(needed @ self.from_items.T + closing @ self.from_closures.T)


def connection_members(loops: Loops) -> Members:
    """For the force of the pin on the body at every connection."""
    return _members(loops, slides=False, count=len(loops.linkage.connections))


def slider_members(loops: Loops) -> Members:
    """For the force of the base on the moving body at every slider."""
    return _members(loops, slides=True, count=len(loops.linkage.sliders))


def _members(loops: Loops, slides: bool, count: int) -> Members:
    linkage = loops.linkage
    needs = np.zeros((count, len(linkage.items)))
    bodies, carriers, _ = loops.closing_ends
    brings = np.zeros((count, len(bodies)))
    for edge in loops.tree:
        if edge.slides is slides:
            sign = 1.0 if edge.forward else -1.0
            needs[edge.which, list(edge.away)] = sign
            for k, (body, carrier) in enumerate(zip(bodies, carriers, strict=True)):
                brings[edge.which, k] = -sign * ((body in edge.away) - (carrier in edge.away))
    for k, (closes, which) in enumerate(loops.closing):
        if closes is slides:
            brings[which, k] = 1.0
    return Members(needs, brings)


def slider_couple(
    loops: Loops,
    which: int,
    about: Complex,
    centres: Complex,
    needed: Complex,
    couples: Floats,
    closing_at: Complex,
    closing: Complex,
    torques: Sequence[tuple[Turn, Floats]],
) -> Floats:
    """Couple of the base on the moving body of a slider about points (T,), (T,) N m.

    centres, needed, couples: (T, items) places, forces and couples that the items need. closing_at,
    closing: (T, closures and teeth) places and forces. torques: (T,) of every turn that is held. A
    slider that closes a loop of sliders alone is taken to carry no couple.
    """
    edge = next((e for e in loops.tree if e.slides and e.which == which), None)
    out = np.zeros(len(about))
    if edge is None:
        return out
    away = list(edge.away)
    p = about[:, None]
    out += np.sum(couples[:, away] + cross(centres[:, away] - p, needed[:, away]), axis=1)
    for k, (body, carrier) in enumerate(zip(*loops.closing_ends[:2], strict=True)):
        side = (body in edge.away) - (carrier in edge.away)
        out -= side * cross(closing_at[:, k] - about, closing[:, k])
    index = loops.linkage.index
    for turn, torque in torques:
        side = (index[turn.body] in edge.away) - (index[turn.base] in edge.away)
        out -= side * torque
    return out if edge.forward else -out

"""Forces in every connection and slider, from the forces that items require and those at closures.

A cut through one member of the spanning tree separates the items beyond the member. The force in
the member is the force that these items require, less the forces of closures and teeth on them. No
system of equations is solved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loads.linkage.parts import Turn
from loads.motion.complex_points import cross
from loads.motion.loop_equations import Loops
from pinbase.arrays import Complex, Floats


@dataclass(frozen=True)
class Members:
    """Weights from which the forces in members follow.

    from_items: (members, items), weights of the forces that items require.
    from_closures: (members, closures and teeth), weights of the forces at closures and teeth.
    """

    from_items: Floats
    from_closures: Floats

    def forces(self, needed: Complex, closing: Complex) -> Complex:
        """Forces in the members, (T, members) N, complex.

        needed: (T, items) N, forces that the items require.
        closing: (T, closures and teeth) N, forces at closures and teeth.
        """
        return np.asarray(needed @ self.from_items.T + closing @ self.from_closures.T)


def connection_members(loops: Loops) -> Members:
    """The weights for the force of the pin on the body at every connection."""
    return _members(loops, slides=False, count=len(loops.linkage.connections))


def slider_members(loops: Loops) -> Members:
    """The weights for the force of the base on the moving body at every slider."""
    return _members(loops, slides=True, count=len(loops.linkage.sliders))


def _members(loops: Loops, slides: bool, count: int) -> Members:
    """The weights for all sliders (`slides`) or all connections."""
    linkage = loops.linkage
    from_items = np.zeros((count, len(linkage.items)))
    bodies, carriers, _ = loops.closing_ends
    from_closures = np.zeros((count, len(bodies)))
    for edge in loops.tree:
        if edge.slides is slides:
            sign = 1.0 if edge.forward else -1.0
            from_items[edge.which, list(edge.away)] = sign
            # A closure counts where only one of its ends is beyond the cut.
            for k, (body, carrier) in enumerate(zip(bodies, carriers, strict=True)):
                side = (body in edge.away) - (carrier in edge.away)
                from_closures[edge.which, k] = -sign * side
    for k, (closes, which) in enumerate(loops.closing):
        if closes is slides:
            from_closures[which, k] = 1.0
    return Members(from_items, from_closures)


def loops_of_sliders(loops: Loops) -> dict[int, tuple[str, ...]]:
    """The names of all sliders of a loop that consists of sliders only, by each one's number."""
    out = dict[int, tuple[str, ...]]()
    for (slides, which), body, carrier in zip(loops.closing, *loops.closing_ends[:2], strict=False):
        if slides:
            between = {e.which for e in loops.tree if (body in e.away) != (carrier in e.away)}
            loop = sorted(between | {which})
            out |= dict.fromkeys(loop, tuple(loops.linkage.sliders[k].name for k in loop))
    return out


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
    """Couple of the base on the moving body of a slider, (T,) N m.

    A slider that closes a loop consisting of sliders only (`loops_of_sliders`) is assumed to carry
    no couple. Only its own friction depends on this assumption.
    which: number of the slider.
    about: (T,) points about which the couple is taken, complex, m.
    centres: (T, items) centres of mass, complex, m.
    needed, couples: (T, items) forces (N, complex) and couples (N m) that the items require.
    closing_at, closing: (T, closures and teeth) points (m) and forces (N) there, complex.
    torques: every turn that is held, with its torque (T,) N m.
    """
    edge = next((e for e in loops.tree if e.slides and e.which == which), None)
    out = np.zeros(len(about))
    if edge is None:
        return out
    away = list(edge.away)
    # Moments about the points for the items beyond the slider: what they require, less closures,
    # teeth and torques that act on them from this side of the cut.
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

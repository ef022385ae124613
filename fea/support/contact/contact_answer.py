"""What given cells in contact answer: everything is linear in the loads as long as they touch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pinbase.arrays import Floats, Ints


@dataclass(frozen=True)
class AdjointContact:
    """The contact of given cells and its adjoint, for a weighted sum of the cells' forces.

    force: (U,) N.
    motion: rigid motions (Y,).
    by_gap: decrease of the sum per gap at each cell, (U,).
    by_required: increase of the sum per required resultant of each motion, (Y,).
    """

    force: Floats
    motion: Floats
    by_gap: Floats
    by_required: Floats


@dataclass(frozen=True)
class Answer:
    """The linear response of one active set of cells to the rigid motions.

    rows: numbers of the cells in contact, (A,).
    force: (U,) N without rigid motions.
    yielding: how much each rigid motion takes off the forces, (U, Y).
    system, right: equations (Y, Y), (Y,) of the motions, without the required resultants.
    open: (U,) m, the gaps before any load. compliance: (U, U) m/N.
    motions: change of the gap by each motion, (U, Y).
    reach: the largest change of a gap by each motion, (Y,), 1 where it moves nothing.
    """

    rows: Ints
    force: Floats
    yielding: Floats
    system: Floats
    right: Floats
    open: Floats
    compliance: Floats
    motions: Floats
    reach: Floats

    def on_springs(self, pull: Floats, stiffness: float) -> tuple[Floats, Callable[[], Floats]]:
        """The forces, and what gives the gaps, where springs, N/m of what each motion moves at
        most, hold the lugs and the pin, and pull with given resultants as long as nothing moves.
        """
        springs = stiffness * self.reach**2
        scale = np.outer(self.reach, self.reach)
        system = (self.system + np.diag(springs)) / scale
        motion, lost = np.zeros(len(pull)), self.right - pull
        for _ in range(2):  # once more for round-off, as `under`
            motion += np.linalg.solve(system, lost / self.reach) / self.reach
            force = self.force - self.yielding @ motion
            lost = self.motions.T @ force - pull - springs * motion

        def gaps() -> Floats:
            pressed = force[self.rows] @ self.compliance[self.rows]
            gap = self.open + pressed + self.motions @ motion
            gap[self.rows] = 0.0
            return np.asarray(gap)

        return force, gaps

    @cached_property
    def _gaps(self) -> tuple[Floats, Floats]:
        """The gaps (U,) without rigid motions, and what each of these adds to them, (U, Y)."""
        both = np.column_stack([self.yielding[self.rows], self.force[self.rows]])
        change = (both.T @ self.compliance[self.rows]).T  # symmetric
        gap, moving = self.open + change[:, -1], self.motions - change[:, :-1]
        gap[self.rows], moving[self.rows] = 0.0, 0.0
        return gap, moving

    def motion(self, lost: Floats) -> Floats:
        """The motions (Y,) of least size that make up for lost resultants."""
        modes, compliance = self._modes
        solved = modes @ (compliance * (modes.T @ (lost / self.reach)))
        return np.asarray(solved / self.reach, dtype=np.float64)

    @cached_property
    def _modes(self) -> tuple[Floats, Floats]:
        """The modes of the equations of the motions, (Y, Y), and the compliance of each, (Y,), zero
        where nothing moves.
        """
        # Every motion counts as what it moves at most: otherwise a turn, whose numbers are those
        # of a shift over a length, is taken for one that moves nothing where few cells touch.
        stiffness, modes = np.linalg.eigh(self.system / np.outer(self.reach, self.reach))
        size = np.abs(stiffness)
        moves = size > len(size) * np.finfo(np.float64).eps * size.max(initial=0.0)
        return modes, np.divide(1.0, stiffness, out=np.zeros_like(stiffness), where=moves)

    def under(self, required: Floats) -> tuple[Floats, Floats, Floats]:
        """The forces, gaps and rigid motions with which the cells have the required resultants."""
        motion, lost = np.zeros(len(required)), self.right - required
        for _ in range(2):  # once more for round-off: forces are small where gaps are large
            motion += self.motion(lost)
            force = self.force - self.yielding @ motion
            lost = self.motions.T @ force - required
        gap, moving = self._gaps
        return force, gap + moving @ motion, motion

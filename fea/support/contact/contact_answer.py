"""The response of given cells in contact, which is linear in the loads as long as they touch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pinbase.arrays import Floats, Ints, Mask

# Relative to the stiffest motion: below this stiffness no cell in contact resists a motion.
FREE_STIFFNESS = 1e-9


@dataclass(frozen=True)
class AdjointContact:
    """The contact of given cells and its adjoint, for a weighted sum of the cells' forces.

    force: forces of the cells, (U,) N.
    motion: rigid motions, (Y,).
    by_gap: decrease of the sum per unit of gap at each cell, (U,).
    by_required: increase of the sum per unit of the required resultant of each motion, (Y,).
    """

    force: Floats
    motion: Floats
    by_gap: Floats
    by_required: Floats


@dataclass(frozen=True)
class Answer:
    """The linear response of one active set of cells to the rigid motions.

    rows: numbers of the cells in contact, (A,).
    force: forces of the cells without rigid motions, (U,) N.
    yielding: decrease of the forces per unit of each rigid motion, (U, Y).
    system, right: matrix (Y, Y) and right-hand side (Y,) of the equations of the motions, without
    the required resultants.
    open: gaps before loading, (U,) m.
    compliance: displacements of cells under forces on cells, (U, U) m/N.
    motions: change of the gaps by each motion, (U, Y).
    reach: largest change of a gap by each motion, (Y,); 1 where the motion changes no gap.
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
        """Return the forces of the cells, (U,) N, where springs hold the lugs and the pin, and a
        function that returns the gaps, (U,) m.

        pull: resultants with which the springs pull as long as nothing moves, (Y,).
        stiffness: of the springs, N/m, for the largest gap change of each motion.
        """
        springs = stiffness * self.reach**2
        scale = np.outer(self.reach, self.reach)
        system = (self.system + np.diag(springs)) / scale
        motion, lost = np.zeros(len(pull)), self.right - pull
        for _ in range(2):  # the second pass removes round-off, as in `under`
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
        """The gaps without rigid motions, (U,), and their change by each motion, (U, Y)."""
        both = np.column_stack([self.yielding[self.rows], self.force[self.rows]])
        change = (both.T @ self.compliance[self.rows]).T  # symmetric
        gap, moving = self.open + change[:, -1], self.motions - change[:, :-1]
        gap[self.rows], moving[self.rows] = 0.0, 0.0
        return gap, moving

    def motion(self, lost: Floats) -> Floats:
        """The smallest motions (Y,) that make up for missing resultants (Y,)."""
        modes, compliance, _ = self._modes
        solved = modes @ (compliance * (modes.T @ (lost / self.reach)))
        return np.asarray(solved / self.reach, dtype=np.float64)

    @cached_property
    def _modes(self) -> tuple[Floats, Floats, Mask]:
        """The eigenvectors (Y, Y) of the equations of the motions, the compliance of each mode,
        (Y,), zero where it is lost in round-off, and a mask (Y,) of those that no cell resists.
        """
        # Motions are scaled by the largest gap change that they cause. Otherwise a turn, whose
        # unit differs from that of a shift, would look like a mode without stiffness where few
        # cells touch.
        stiffness, modes = np.linalg.eigh(self.system / np.outer(self.reach, self.reach))
        size = np.abs(stiffness)
        moves = size > len(size) * np.finfo(np.float64).eps * size.max(initial=0.0)
        compliance = np.divide(1.0, stiffness, out=np.zeros_like(stiffness), where=moves)
        return modes, compliance, size < FREE_STIFFNESS * size.max(initial=0.0)

    def freely(self, required: Floats) -> tuple[Floats, Floats] | None:
        """The gaps (U,), m, without the motions that no cell in contact resists, and the rates (U,)
        at which they change by such motions along the missing resultants; None without such
        motions.
        """
        modes, compliance, free = self._modes
        if not free.any():
            return None
        lost = modes.T @ ((self.right - required) / self.reach)
        parts = np.column_stack([np.where(free, 0.0, compliance * lost), np.where(free, lost, 0.0)])
        gap, moving = self._gaps
        held, rate = (moving @ (modes @ parts / self.reach[:, None])).T
        return gap + held, rate

    def under(self, required: Floats) -> tuple[Floats, Floats, Floats]:
        """The forces, gaps and rigid motions with which the cells have the required resultants."""
        motion, lost = np.zeros(len(required)), self.right - required
        for _ in range(2):  # the second pass removes round-off: forces are small in wide gaps
            motion += self.motion(lost)
            force = self.force - self.yielding @ motion
            lost = self.motions.T @ force - required
        gap, moving = self._gaps
        return force, gap + moving @ motion, motion

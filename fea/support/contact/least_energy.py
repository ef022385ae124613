"""The cells in contact by descent of the energy, which ends from any start.

Cells that push a pin, held on springs, minimise a strictly convex energy over pressures that are
not negative. The active set here only ever steps to less energy, so that it meets no set of cells
twice, and there are finitely many; where round-off decides what is less, the steps are counted
instead. It takes more steps than the one of
fea.support.contact.contact, which may run in circles where hardly more cells touch than hold the
pin.

Source: Lawson & Hanson, Solving Least Squares Problems (1974), chapter 23 (nonnegative least
squares), here with several cells a step, as long as they take energy away.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fea.core.linear_solver import SolveError
from pinbase.arrays import Floats, Mask

# Of the largest gap or the step: a smaller overlap is round-off, and cells within it of the first
# one that opens open together.
ROUND_OFF = 1e-12
# Minima met before the descent is given up, per cell. Of 400 random light loads none met more than
# 0.08, and nonnegative least squares is commonly given 3.
MAX_MINIMA_PER_CELL = 1.0
FEASIBLE_RESIDUAL = 1e-6  # of the largest resultant: ten times the tolerance of HiGHS


# Forces (U,), N, over given cells in contact, and what gives the gaps (U,), m, under them.
Least = Callable[[Mask], tuple[Floats, Callable[[], Floats]]]


def unsettled() -> SolveError:
    """The error that no set of cells in contact was found."""
    return SolveError("contact does not settle", "contact-unsettled")


def require_forces(resultants: Floats, required: Floats) -> None:
    """Raise unless some forces of the cells, none of them negative, have the required resultants.

    resultants: of a unit force of each cell, (Y, U).
    required: (Y,), the largest of them 1.

    Raises: SolveError.
    """
    from scipy.optimize import linprog  # takes long to import

    # By the least sum of residuals, a linear program. `scipy.optimize.nnls` is not to be trusted
    # here: from SciPy 1.15 on it returns a residual of 0.0 for resultants that no forces have
    # (scipy/scipy#25389), and the descent then has no minimum to end at.
    count, cells = resultants.shape
    residual = np.hstack([np.eye(count), -np.eye(count)])
    least = linprog(
        np.repeat([0.0, 1.0], [cells, 2 * count]),
        A_eq=np.hstack([resultants, residual]),
        b_eq=required,
    )
    if least.x is None or least.fun is None:
        raise unsettled()
    if least.fun > FEASIBLE_RESIDUAL:
        raise SolveError(
            "the links leave a couple on the pin that no lug reacts: give a lug the stiffness of "
            "its tilt, or the links their moments",
            "couple-not-reacted",
        )


def least_energy_cells(
    force: Floats,
    least: Least,
    energy: Callable[[Floats], float],
    chosen: Callable[[Floats, Mask, Mask], Mask],
) -> tuple[Mask, Floats]:
    """The cells (U,) in contact where the energy is least, and their forces (U,), N.

    force: any to begin with, (U,) N, none of them negative.
    least: forces (U,) N, of any sign, with which the energy is least over given cells in contact,
    and what gives their gaps (U,) m.
    energy: of forces (U,).
    chosen: which of the cells that overlap to close at once, by gaps, overlapping cells and cells
    in contact.

    Raises: SolveError where round-off hides the minimum.
    """
    active, force, gap = _descent(force > 0.0, force, least, energy)
    minima = {active.tobytes()}
    while len(minima) < MAX_MINIMA_PER_CELL * len(force):
        overlaps = ~active & (gap < -ROUND_OFF * np.abs(gap).max())
        if not overlaps.any():
            return active, force
        deepest = np.zeros_like(active)
        deepest[int(np.where(overlaps, gap, np.inf).argmin())] = True
        # Closing the deepest cell alone always takes energy away; closing several may not, where
        # all of them open again.
        for closing in (chosen(gap, overlaps, active), deepest):
            next_active, next_force, gap = _descent(active | closing, force, least, energy)
            if next_active.tobytes() not in minima:
                break
        else:
            return active, force  # within round-off
        active, force = next_active, next_force
        minima.add(active.tobytes())
    raise unsettled()


def _descent(
    active: Mask, force: Floats, least: Least, energy: Callable[[Floats], float]
) -> tuple[Mask, Floats, Floats]:
    """The cells, forces and gaps of a minimum over some of the given cells, reached from forces
    that are not negative.
    """
    active, now = active.copy(), energy(force)
    while True:
        minimum, gaps = least(active)
        opening = np.flatnonzero(active & (minimum <= 0.0))
        if not len(opening):
            return active, minimum, gaps()
        # All cells that would pull open at once where that takes energy away.
        clipped = np.maximum(minimum, 0.0)
        if (after := energy(clipped)) < now:
            active[opening], force, now = False, clipped, after
            continue
        # Else as far towards the minimum as no cell pulls; the first one that would is opened.
        step = np.zeros(len(opening))
        loaded = force[opening] > 0.0
        at = opening[loaded]
        step[loaded] = force[at] / (force[at] - minimum[at])
        force = np.maximum(force + step.min() * (minimum - force), 0.0)
        opened = opening[step <= step.min() + ROUND_OFF]
        active[opened], force[opened] = False, 0.0
        now = energy(force)

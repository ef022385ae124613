"""The cells in contact by descent of the energy, which ends from any start.

The forces of the cells on a pin that is held by springs minimise a strictly convex energy under the
constraint that none is negative. The active set here steps only to lower energy. It therefore meets
no set of cells twice, and it ends, since there are finitely many sets. Where round-off decides
which energy is lower, a limit on the number of minima ends it instead. It takes more steps than the
active set of fea.support.contact.contact, which may cycle where barely more cells touch than are
needed to hold the pin.

Source: Lawson & Hanson, Solving Least Squares Problems (1974), chapter 23 (nonnegative least
squares), here with several cells a step, as long as they take energy away.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fea.core.linear_solver import SolveError
from pinbase.arrays import Floats, Mask

# An overlap below this fraction of the largest gap is round-off. Cells that open within this
# fraction of a step after the first one open together with it.
ROUND_OFF = 1e-12
# Minima per cell after which the descent is given up. None of 400 random light loads took more than
# 0.08; for nonnegative least squares a limit of 3 is usual.
MAX_MINIMA_PER_CELL = 1.0
FEASIBLE_RESIDUAL = 1e-6  # of the largest resultant: ten times the tolerance of HiGHS


# A function that returns, for given cells in contact, the forces (U,), N, of least energy and a
# function for the gaps (U,), m.
Least = Callable[[Mask], tuple[Floats, Callable[[], Floats]]]


def unsettled() -> SolveError:
    """The error that no set of cells in contact was found."""
    return SolveError("contact does not settle", "contact-unsettled")


def require_forces(resultants: Floats, required: Floats) -> None:
    """Raise an error unless non-negative forces of the cells exist with the required resultants.

    resultants: of a unit force on each cell, (Y, U).
    required: required resultants, (Y,), scaled so that the largest is 1.

    Raises: SolveError.
    """
    from scipy.optimize import linprog  # takes long to import

    # The smallest sum of absolute residuals is a linear program. `scipy.optimize.nnls` cannot be
    # used: from SciPy 1.15 on it returns a residual of 0.0 for resultants that no forces have
    # (scipy/scipy#25389), and the descent would then have no minimum.
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
    cells_to_close: Callable[[Floats, Mask, Mask], Mask],
) -> tuple[Mask, Floats]:
    """The cells (U,) in contact where the energy is least, and their forces (U,), N.

    force: initial forces, (U,) N, none of them negative.
    least: returns the forces (U,) N, of any sign, that minimise the energy over given cells in
    contact, and a function for the gaps (U,) m.
    energy: returns the energy of forces (U,).
    cells_to_close: returns the cells to close together, from gaps, overlapping cells and cells in
    contact.

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
        # Closing several cells may not lower the energy, since all of them may open again. Closing
        # the deepest cell alone always does.
        for closing in (cells_to_close(gap, overlaps, active), deepest):
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
    """The cells, forces and gaps of a minimum over a subset of the given cells.

    force: initial forces, (U,) N, none of them negative.
    """
    active, now = active.copy(), energy(force)
    while True:
        minimum, gaps = least(active)
        opening = np.flatnonzero(active & (minimum <= 0.0))
        if not len(opening):
            return active, minimum, gaps()
        # All cells that would pull are opened at once if that lowers the energy.
        clipped = np.maximum(minimum, 0.0)
        if (after := energy(clipped)) < now:
            active[opening], force, now = False, clipped, after
            continue
        # Otherwise the forces move towards the minimum until the first of these cells has no force;
        # that cell opens.
        step = np.zeros(len(opening))
        loaded = force[opening] > 0.0
        at = opening[loaded]
        step[loaded] = force[at] / (force[at] - minimum[at])
        force = np.maximum(force + step.min() * (minimum - force), 0.0)
        opened = opening[step <= step.min() + ROUND_OFF]
        active[opened], force[opened] = False, 0.0
        now = energy(force)

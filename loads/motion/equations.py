"""Interface of the equations of a linkage, in the plane or in space, for following a motion."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from loads.motion.least_squares import Factors
from pinbase.arrays import Floats

MIN_PARTICIPATION = 1e-6  # relative to the largest component of a null vector


CLOSING_GEARS = (("the ratios of its gears", "the gears"),)  # of Equations.closing_conditions


class Equations(Protocol):
    """The equations of a linkage: those of its joints and gears, then those of its D drives.

    There are `rows` equations, in m, for n = `columns` coordinates, which are all zero as drawn.
    A pose holds the position at coordinates (T, n) of T instants; it can be indexed by instants.
    """

    linkage: Any  # a Linkage or SpaceLinkage
    drawn_drives: Floats

    @property
    def columns(self) -> int:
        """Number of coordinates."""
        ...

    @property
    def guides(self) -> int:
        """Number of equations without those of the drives."""
        ...

    @property
    def scale(self) -> Floats:
        """Length per unit of each coordinate, (n,)."""
        ...

    def parts(self, count: int) -> list[slice]:
        """Slices that divide `count` instants into batches whose matrices take little memory."""
        ...

    @property
    def drive_scale(self) -> Floats:
        """Length per unit of each drive, (D,)."""
        ...

    def pose(self, q: Floats) -> Any:
        """The position of the linkage at coordinates q (T, n)."""
        ...

    def residual(self, q: Floats, pose: Any, drives: Floats) -> Floats:
        """Violation of every equation, (T, rows) m; drives: (T, D) values of the drives."""
        ...

    def jacobian(self, pose: Any) -> Floats:
        """Derivatives of the residual by the scaled coordinates, (T, rows, n), dimensionless."""
        ...

    def factors(self, pose: Any) -> Factors:
        """Orthogonal factors of the Jacobian at T instants."""
        ...

    def bend_side(self, pose: Any, rates: Floats) -> Floats:
        """Right-hand side (T, rows) of the accelerations that are quadratic in rates (T, n)."""
        ...

    # --- names for messages -----------------------------------------------------------------------

    @property
    def kutzbach(self) -> int:
        """Degrees of freedom by counting links and joints."""
        ...

    @property
    def along_lengths(self) -> tuple[bool, ...]:
        """Whether each drive moves along a length; otherwise it turns an angle."""
        ...

    @property
    def closing_conditions(self) -> tuple[tuple[str, str], ...]:
        """Pairs (condition, input to check): what redundant links need to close besides lengths."""
        ...

    def moving(self, pose: Any, rates: Floats, least: float = MIN_PARTICIPATION) -> tuple[str, ...]:
        """Names of the bodies that move in any of k motions.

        pose: pose of a single instant. rates: (k, n) rates of the coordinates.
        least: speed above which a body moves, relative to the fastest body.
        """
        ...

    def advice(self, pose: Any, rates: Floats) -> str:
        """Advice on how to stop motions possible with locked drives; "" where there is none.

        pose: pose of a single instant. rates: (k, n) rates of the coordinates, one row per motion.
        """
        ...

    def stressed(self, pose: Any, multipliers: Floats) -> tuple[str, ...]:
        """Names of the connections and teeth that carry any of k self-equilibrated sets of forces.

        pose: pose of a single instant. multipliers: (rows, k), one column per set.
        """
        ...

    def apart(self, q: Floats, drives: Floats) -> tuple[tuple[str, ...], float]:
        """Names of the members that do not meet at coordinates q (n,), and the largest gap, m.

        drives: (D,) values.
        """
        ...


def drive_side(equations: Equations, rates: Floats) -> Floats:
    """Right-hand side (T, rows) from the rates (T, D) of the drives; zero in the other rows."""
    fixed = np.zeros((len(rates), equations.guides))
    return np.concatenate([fixed, equations.drive_scale * rates], axis=1)

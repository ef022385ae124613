"""A Timoshenko beam on Winkler foundations in its lugs, without discretisation.

With u the deflection relative to the bore, psi the slope of the section relative to the lug, k the
stiffness of the foundation per length, and q the other loads per length along x,

    u' = psi + V / (kappa G A)    psi' = M / (E I)    M' = -V    V' = k u - q

The state at the end of a piece is that at its start times the exponential of a matrix, exactly. The
states at all stations and the shifts and tilts of the lugs are solved for together. A stiffness
matrix, which contains 12 E I / h^3, is ill conditioned for short pieces; this system is not.

Sources: M. Hetenyi, Beams on Elastic Foundation (1946), ch. II and V; S. P. Timoshenko, Phil. Mag.
41 (1921) 744, for the shear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from fea.core.pin_loads import Floats

# Components of the state. REACTION_INTEGRAL is the integral of k u along the piece, and
# REACTION_DOUBLE_INTEGRAL the integral of that integral.
U, PSI, M, V, REACTION_INTEGRAL, REACTION_DOUBLE_INTEGRAL, UNIT_LOAD = range(7)
STATE_COUNT = 4
# Largest length of a piece over the foundation's length 1 / lambda, so that exponentials remain
# moderate.
MAX_FOUNDATION_LENGTHS = 1.0


@dataclass(frozen=True)
class SupportedBeam:
    """The N pieces of a beam between stations (N + 1,) m.

    bending: 1 / (E I), (N,) 1 / (N m^2).
    shear: 1 / (kappa G A), (N,) 1 / N.
    foundation: stiffness per length, (N,) N/m^2; 0 outside lugs.
    mass: per length, (N,) kg/m.
    lug: number of the lug that holds each piece, -1 for none, (N,).
    """

    stations: Floats
    bending: Floats
    shear: Floats
    foundation: Floats
    mass: Floats
    lug: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.lug)


@dataclass(frozen=True)
class Response:
    """The reactions of the lugs on the pieces of a beam under P unit loads: a force of 1 N on each
    lug, a body force of 1 m/s^2, and a couple of 1 N m on each lug.

    A positive couple is a moment about y, the sum of forces along x times their z. Fixed lugs react
    the remainder of each load; a force on a fixed lug has no effect, nor has a couple on a guided
    lug.
    force: along x on each piece, (N, P) N.
    moment: of the forces along x about the middle of each piece, (N, P) N m.
    """

    force: Floats
    moment: Floats


def refined(stations: Floats, bending: Floats, foundation: Floats) -> Floats:
    """The stations, m, with pieces divided that are long compared with their foundation's length.

    bending: 1 / (E I) of the pieces, (N,). foundation: their stiffness per length, (N,) N/m^2.
    """
    length = np.diff(stations)
    waves = length * (foundation * bending / 4.0) ** 0.25
    counts = np.maximum(1, np.ceil(waves / MAX_FOUNDATION_LENGTHS)).astype(int)
    cuts = [
        a + h * np.arange(n) / n
        for a, h, n in zip(stations[:-1], length, counts.tolist(), strict=True)
    ]
    return np.concatenate([*cuts, stations[-1:]])


def respond(
    beam: SupportedBeam, middles: Floats, tilt: Sequence[float], fixed: Sequence[int] = (0,)
) -> Response:
    """The response of a beam in its lugs.

    middles: z of the middles of the lugs, (B,) m.
    tilt: tilt stiffness of the lugs, (B,) N m/rad; inf: guided, 0: free.
    fixed: numbers of the fixed lugs. If there is only one and all lugs are free to tilt, it is
    guided and reacts the remaining couple.
    """
    length = float(beam.stations[-1] - beam.stations[0]) / len(beam)
    stiff = 1.0 / float(beam.bending.max() * length**2)  # N; scales all numbers to about 1
    held = np.asarray(tilt, dtype=float) / (stiff * length)
    if len(fixed) == 1 and not held.any():
        held[fixed[0]] = np.inf
    unit = replace(
        beam,
        stations=beam.stations / length,
        bending=beam.bending * stiff * length**2,
        shear=beam.shear * stiff,
        foundation=beam.foundation * length**2 / stiff,
        mass=beam.mass * length,
    )
    response = _System(unit, np.asarray(middles) / length, held, fixed).solve()
    per = np.ones(response.force.shape[1])
    per[len(middles) + 1 :] = 1.0 / length  # couples of 1 N m instead of 1 N times `length`
    return Response(response.force * per, response.moment * length * per)


class _System:
    """The system of equations for the states (w, phi, M, V) at all stations and the shift and tilt
    of each lug.

    w and phi are absolute: they include shift and tilt of the lug.
    """

    def __init__(
        self, beam: SupportedBeam, middles: Floats, tilt: Floats, fixed: Sequence[int]
    ) -> None:
        self.beam, self.middles, self.tilt, self.fixed = beam, middles, tilt, fixed
        self.lengths = np.diff(beam.stations)
        self.steps = expm(_rates(beam) * self.lengths[:, None, None])
        self.motions = STATE_COUNT * (len(beam) + 1)  # number of the first shift of a lug
        self.size = self.motions + 2 * len(middles)
        self.starts = np.stack([self._against(i, 0) for i in range(len(beam))])

    def solve(self) -> Response:
        matrix, loads = np.zeros((self.size, self.size)), np.zeros((self.size, self._loads))
        for i, step in enumerate(self.steps):
            rows = slice(STATE_COUNT * i, STATE_COUNT * (i + 1))
            matrix[rows] = self._against(i, 1) - step[:STATE_COUNT, :STATE_COUNT] @ self.starts[i]
            loads[rows, self._body] = step[:STATE_COUNT, UNIT_LOAD]
        last = self.motions - STATE_COUNT
        free = [M, V, last + M, last + V]  # M and V are zero at both ends
        matrix[last + np.arange(STATE_COUNT), free] = 1.0
        self._hold(matrix[self.motions :], loads[self.motions :])
        return self._response(np.asarray(np.linalg.solve(matrix, loads), dtype=np.float64))

    @property
    def _body(self) -> int:
        """The number of the body force among the loads; forces come before it, couples after."""
        return len(self.middles)

    @property
    def _loads(self) -> int:
        return 2 * len(self.middles) + 1

    def _against(self, i: int, end: int) -> Floats:
        """The state at the start (0) or end (1) of a piece relative to its lug, as a matrix
        (STATE_COUNT, size) on the unknowns.
        """
        out, lug = np.zeros((STATE_COUNT, self.size)), int(self.beam.lug[i])
        at = STATE_COUNT * (i + end)
        out[:, at : at + STATE_COUNT] = np.eye(STATE_COUNT)
        if lug >= 0:
            shift, arm = self.motions + 2 * lug, self.beam.stations[i + end] - self.middles[lug]
            out[:2, shift : shift + 2] = [[-1.0, -arm], [0.0, -1.0]]
        return out

    def _hold(self, rows: Floats, loads: Floats) -> None:
        """Set the equations of each lug: its force, or no shift if it is fixed, and its couple."""
        for b, stiffness in enumerate(self.tilt.tolist()):
            force, couple = self._reactions(b)
            if b in self.fixed:
                rows[2 * b] = np.eye(self.size)[self.motions + 2 * b]
            else:
                rows[2 * b], loads[2 * b, b] = force[:-1], 1.0
                loads[2 * b, self._body] = -force[-1]
            turn = np.eye(self.size)[self.motions + 2 * b + 1]
            if np.isfinite(stiffness):  # scaled, so that extreme stiffnesses do no harm
                turn = (stiffness * turn + couple[:-1]) / (1.0 + stiffness)
                loads[2 * b + 1, self._body] = -couple[-1] / (1.0 + stiffness)
                loads[2 * b + 1, self._body + 1 + b] = 1.0 / (1.0 + stiffness)
            rows[2 * b + 1] = turn

    def _reactions(self, lug: int) -> tuple[Floats, Floats]:
        """The force and the couple about its middle that a lug exerts on the beam, (size + 1,)
        each.

        Both are linear in the unknowns and, with the last coefficient, in the body force.
        """
        force, couple = np.zeros(self.size + 1), np.zeros(self.size + 1)
        for i in np.flatnonzero(self.beam.lug == lug).tolist():
            whole = np.column_stack([self.starts[i], np.zeros(STATE_COUNT)])
            sums = (
                self.steps[i][[REACTION_INTEGRAL, REACTION_DOUBLE_INTEGRAL], :STATE_COUNT] @ whole
            )
            sums[:, -1] = self.steps[i][[REACTION_INTEGRAL, REACTION_DOUBLE_INTEGRAL], UNIT_LOAD]
            force -= sums[0]
            couple -= (self.beam.stations[i + 1] - self.middles[lug]) * sums[0] - sums[1]
        return force, couple

    def _response(self, x: Floats) -> Response:
        sums = self.steps[:, [REACTION_INTEGRAL, REACTION_DOUBLE_INTEGRAL], :STATE_COUNT] @ (
            self.starts @ x
        )  # (N, 2, P)
        of_body = self.steps[:, [REACTION_INTEGRAL, REACTION_DOUBLE_INTEGRAL], UNIT_LOAD]
        sums[:, :, self._body] += of_body
        half = 0.5 * self.lengths[:, None]
        return Response(-sums[:, 0], sums[:, 1] - half * sums[:, 0])


def _rates(beam: SupportedBeam) -> Floats:
    """The matrices (N, 7, 7) of the derivatives of the state along each piece.

    The state is (u, psi, M, V, REACTION_INTEGRAL, REACTION_DOUBLE_INTEGRAL, 1).
    """
    out = np.zeros((len(beam), 7, 7))
    out[:, U, PSI], out[:, U, V], out[:, PSI, M] = 1.0, beam.shear, beam.bending
    out[:, M, V], out[:, V, U], out[:, V, UNIT_LOAD] = -1.0, beam.foundation, -beam.mass
    out[:, REACTION_INTEGRAL, U], out[:, REACTION_DOUBLE_INTEGRAL, REACTION_INTEGRAL] = (
        beam.foundation,
        1.0,
    )
    return out

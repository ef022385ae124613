"""A Timoshenko beam that rests on Winkler foundations in its lugs, without discretisation.

With u the deflection against the bore, psi the slope of the section against the lug, k the
stiffness of the foundation per length and q what else loads the beam along x,

    u' = psi + V / (kappa G A)    psi' = M / (E I)    M' = -V    V' = k u - q

so a piece takes the state at its start to that at its end by the exponential of a matrix, exactly.
The states at all stations, the shifts of the lugs and their tilts are found together. Unlike a
system of stiffnesses, which holds 12 E I / h^3, this one is well conditioned with short pieces.

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

# REACTION_INTEGRAL: the integral of k u; REACTION_DOUBLE_INTEGRAL: the integral of that.
U, PSI, M, V, REACTION_INTEGRAL, REACTION_DOUBLE_INTEGRAL, UNIT_LOAD = range(7)
STATE_COUNT = 4
# Of a foundation's length 1 / lambda: a piece is no longer, so that exponentials remain moderate.
MAX_FOUNDATION_LENGTHS = 1.0


@dataclass(frozen=True)
class SupportedBeam:
    """The pieces (N,) of a beam between stations (N + 1,) m.

    bending: 1 / (E I), 1 / (N m^2).
    shear: 1 / (kappa G A), 1 / N.
    foundation: N/m^2, 0 outside lugs.
    mass: kg/m.
    lug: number of the lug that holds each, -1 for none.
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
    """The reaction of the lugs on the pieces of a beam under P loads: one newton on each lug, a
    body force of 1 m/s^2, and a couple of 1 N m on each lug.

    A couple turns a force along x towards z; on a guided lug it does nothing.

    force: (N, P), N, and moment: (N, P), N m, about the middles of the pieces, of forces along x.
    The fixed lugs react the remainder of each load; one newton on one of them does nothing.
    """

    force: Floats
    moment: Floats


def refined(stations: Floats, bending: Floats, foundation: Floats) -> Floats:
    """The stations, m, with pieces (N,) cut where they are long for the foundation they are on."""
    length = np.diff(stations)
    waves = length * (foundation * bending / 4.0) ** 0.25
    counts = np.maximum(1, np.ceil(waves / MAX_FOUNDATION_LENGTHS)).astype(int)
    cuts = [
        a + h * np.arange(n) / n
        for a, h, n in zip(stations[:-1], length, counts.tolist(), strict=True)
    ]
    return np.concatenate([*cuts, stations[-1:]])


def respond(
    beam: SupportedBeam, middles: Floats, tilt: Sequence[float], still: Sequence[int] = (0,)
) -> Response:
    """The response of a beam in its lugs.

    middles: of the lugs, (B,) m.
    tilt: N m/rad of the lugs' tilt, inf guided, 0 free.
    still: the fixed lugs; where there is one, and all are free to tilt, it is guided and reacts the
    remaining couple.
    """
    length = float(beam.stations[-1] - beam.stations[0]) / len(beam)
    stiff = 1.0 / float(beam.bending.max() * length**2)  # N; makes numbers near 1 of all
    held = np.asarray(tilt, dtype=float) / (stiff * length)
    if len(still) == 1 and not held.any():
        held[still[0]] = np.inf
    unit = replace(
        beam,
        stations=beam.stations / length,
        bending=beam.bending * stiff * length**2,
        shear=beam.shear * stiff,
        foundation=beam.foundation * length**2 / stiff,
        mass=beam.mass * length,
    )
    response = _System(unit, np.asarray(middles) / length, held, still).solve()
    per = np.ones(response.force.shape[1])
    per[len(middles) + 1 :] = 1.0 / length  # of 1 N m, instead of one newton times `length`
    return Response(response.force * per, response.moment * length * per)


class _System:
    """The states (w, phi, M, V) at all stations, then shift and tilt of each lug, as one vector."""

    def __init__(
        self, beam: SupportedBeam, middles: Floats, tilt: Floats, still: Sequence[int]
    ) -> None:
        self.beam, self.middles, self.tilt, self.still = beam, middles, tilt, still
        self.lengths = np.diff(beam.stations)
        self.steps = expm(_rates(beam) * self.lengths[:, None, None])
        self.motions = STATE_COUNT * (len(beam) + 1)  # where the lugs' begin
        self.size = self.motions + 2 * len(middles)
        self.starts = np.stack([self._against(i, 0) for i in range(len(beam))])

    def solve(self) -> Response:
        matrix, loads = np.zeros((self.size, self.size)), np.zeros((self.size, self._loads))
        for i, step in enumerate(self.steps):
            rows = slice(STATE_COUNT * i, STATE_COUNT * (i + 1))
            matrix[rows] = self._against(i, 1) - step[:STATE_COUNT, :STATE_COUNT] @ self.starts[i]
            loads[rows, self._body] = step[:STATE_COUNT, UNIT_LOAD]
        last = self.motions - STATE_COUNT
        free = [M, V, last + M, last + V]  # nothing acts on the ends
        matrix[last + np.arange(STATE_COUNT), free] = 1.0
        self._hold(matrix[self.motions :], loads[self.motions :])
        return self._response(np.asarray(np.linalg.solve(matrix, loads), dtype=np.float64))

    @property
    def _body(self) -> int:
        """The number of the load that is the body force; forces come before it, couples after."""
        return len(self.middles)

    @property
    def _loads(self) -> int:
        return 2 * len(self.middles) + 1

    def _against(self, i: int, end: int) -> Floats:
        """The state at the start (0) or end (1) of a piece against its lug, (STATE_COUNT, size)."""
        out, lug = np.zeros((STATE_COUNT, self.size)), int(self.beam.lug[i])
        at = STATE_COUNT * (i + end)
        out[:, at : at + STATE_COUNT] = np.eye(STATE_COUNT)
        if lug >= 0:
            shift, arm = self.motions + 2 * lug, self.beam.stations[i + end] - self.middles[lug]
            out[:2, shift : shift + 2] = [[-1.0, -arm], [0.0, -1.0]]
        return out

    def _hold(self, rows: Floats, loads: Floats) -> None:
        """Add the equations of the lugs: a force, or no shift, and a couple each."""
        for b, stiffness in enumerate(self.tilt.tolist()):
            force, couple = self._reactions(b)
            if b in self.still:
                rows[2 * b] = np.eye(self.size)[self.motions + 2 * b]
            else:
                rows[2 * b], loads[2 * b, b] = force[:-1], 1.0
                loads[2 * b, self._body] = -force[-1]
            turn = np.eye(self.size)[self.motions + 2 * b + 1]
            if np.isfinite(stiffness):  # scaled so that very stiff and very soft are harmless
                turn = (stiffness * turn + couple[:-1]) / (1.0 + stiffness)
                loads[2 * b + 1, self._body] = -couple[-1] / (1.0 + stiffness)
                loads[2 * b + 1, self._body + 1 + b] = 1.0 / (1.0 + stiffness)
            rows[2 * b + 1] = turn

    def _reactions(self, lug: int) -> tuple[Floats, Floats]:
        """The force and the couple about its middle that a lug exerts on the beam, (size + 1,)
        each.

        They are linear in the states and, last, in the body force.
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
    """The matrices (N, 7, 7) that give the derivatives of each piece's state.

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

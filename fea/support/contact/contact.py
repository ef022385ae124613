"""Frictionless contact of a pin with its lugs, on cells: rings of the bands times sectors.

With pressure p >= 0 on the cells, the gap to the bore is, on the average of a cell,

    g = clearance / 2 + edge rounding + C p + (shift of the lug + z turn of the pin) . e_r >= 0

and p g = 0. C is the flexibility of pin and lugs together, harmonic by harmonic, the half-plane's
beyond, under pressures that are even on every cell, and averaged over cells, so that it is
symmetric. A lug whose tilt is elastic adds the tilt that the pressures' couple makes. Shifts and
turn are the multipliers of what equilibrium asks: the resultant on the bands of a link is its
force, and the couples on the pin are in balance. It is a linear complementarity problem with a
positive definite matrix; a primal-dual active set solves it, from any start, in few steps. As long
as the same cells are in contact everything is linear in the loads: what a set of cells answers is
found once and kept, so that neighbouring instants take next to nothing.

Sources: Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865 (the active set); Ciavarella &
Decuzzi, Int. J. Solids Struct. 38 (2001) 4507 (the plane problem that tests compare with).
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats
from fea.support.bands import Bands
from pinbase.arrays import Ints

Mask = NDArray[np.bool_]

# Limits of the iteration and of the continuation from larger loads, chosen by judgement. They
# decide whether and how soon contact is found; the contact itself is unique.
MAX_ACTIVE_SET_STEPS = 60
LOAD_GROWTH, MAX_LOAD_FACTOR = 16.0, 1e12  # times the loads, where these do not settle
LOAD_REDUCTION, MIN_LOAD_REDUCTION = 2.0, 1.01  # factors by which they become smaller again
# A cell belongs to the first guess if the cosine between its normal and the load is larger.
FACING_COSINE = 0.3
# Round-off of double precision, with a margin chosen by judgement.
BALANCE_TOLERANCE = 1e-9  # of the largest force
CLOSING_FORCE_ROUND_OFF = 1e-12  # of the forces that would close the gaps
SIGN_TOLERANCE = 1e-12  # of the largest pressure or gap: a wrong sign below it is round-off
# Of the stiffness of the cells: holds a lug that has lost all contact, and is far too soft to
# change that of a lug in contact.
SOFT_SPRING_STIFFNESS = 1e-13
TAIL_HARMONICS_PER_SECTOR = 40  # times the sectors: harmonics of the half-plane that are summed
# Numbers kept of the responses of sets of cells, counted by one value of each cell and motion.
MAX_KEPT_NUMBERS = 4_000_000


@dataclass(frozen=True)
class ContactState:
    """The contact of a pin at one instant.

    pressure: (R, M), Pa, on the cells.
    gap: (R, M), m.
    shift: (B, 2), m, of the lugs against the pin along x and y.
    turn: (2,), slopes dx / dz and dy / dz of the pin.
    steps: number of active-set steps.
    angle: of the first cells' middle from the x axis, rad.
    """

    pressure: Floats
    gap: Floats
    shift: Floats
    turn: Floats
    steps: int
    angle: float = 0.0

    @property
    def active(self) -> Mask:
        """A mask (R, M) of the cells in contact."""
        return self.gap <= 0.0

    def times(self, factor: float) -> ContactState:
        """The state under so many times the loads, valid where there is no gap before loading."""
        return ContactState(
            factor * self.pressure,
            factor * self.gap,
            factor * self.shift,
            factor * self.turn,
            0,
            self.angle,
        )

    def turned(self, angle: float) -> ContactState:
        """The state turned about the axis by an angle, rad."""
        turn = rotation(angle).T
        return replace(
            self, shift=self.shift @ turn, turn=self.turn @ turn, angle=self.angle + angle
        )


def rotation(angle: float) -> Floats:
    """The matrix (2, 2) that rotates columns (x, y) by an angle, rad."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


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
class _Answer:
    """The linear response of one active set of cells to the rigid motions.

    force, gap: (U,) N and (U,) m without rigid motions.
    yielding, moving: how much each rigid motion takes off the forces and adds to the gaps, (U, Y).
    system, right: equations (Y, Y), (Y,) of the motions, without the required resultants.
    motions: change of the gap by each motion, (U, Y).
    reach: the largest change of a gap by each motion, (Y,), 1 where it moves nothing.
    """

    force: Floats
    yielding: Floats
    gap: Floats
    moving: Floats
    system: Floats
    right: Floats
    motions: Floats
    reach: Floats

    def motion(self, lost: Floats) -> Floats:
        """The motions (Y,) of least size that make up for lost resultants."""
        # Every motion counts as what it moves at most: otherwise a turn, whose numbers are those
        # of a shift over a length, is taken for one that moves nothing where few cells touch.
        system = self.system / np.outer(self.reach, self.reach)
        solved = np.linalg.lstsq(system, lost / self.reach)[0]
        return np.asarray(solved / self.reach, dtype=np.float64)

    def under(self, required: Floats) -> tuple[Floats, Floats, Floats]:
        """The forces, gaps and rigid motions with which the cells have the required resultants."""
        motion, lost = np.zeros(len(required)), self.right - required
        for _ in range(2):  # once more for round-off: forces are small where gaps are large
            motion += self.motion(lost)
            force = self.force - self.yielding @ motion
            lost = self.motions.T @ force - required
        return force, self.gap + self.moving @ motion, motion


class ContactProblem:
    """One pin in its lugs, ready for any loads.

    flexibility: (N + 1, R, R) m/Pa by harmonic, of pin and lugs together, on means over rings.
    tail: n u_n / p_n of both together for higher harmonics, m/Pa, (R,).
    tilt: (B,) N m/rad, stiffness of the lugs' tilt, inf where guided, 0 where free.
    sectors: M, of equal angles, the first about x.
    besides: (U, U) m/N, further displacement of cells under forces on cells, of a body that is not
    alike in all directions.
    gone: (U,) the cells that are not there.
    """

    def __init__(
        self,
        bands: Bands,
        flexibility: Floats,
        tail: Floats,
        tilt: Sequence[float],
        sectors: int,
        besides: Floats | None = None,
        gone: Mask | None = None,
    ) -> None:
        self.bands, self.sectors = bands, sectors
        self.angles = 2.0 * np.pi * np.arange(sectors) / sectors
        self.area = self.cells_area(bands)
        mean = np.sinc(1.0 / sectors)  # of cos and sin over a sector
        e_r = mean * np.stack([np.cos(self.angles), np.sin(self.angles)], axis=1)
        self._e_r = np.tile(e_r, (len(bands.z), 1))  # (U, 2)
        self._link = np.repeat(bands.links[bands.band], sectors)
        self._count = int(bands.links.max()) + 1
        self._tail = float(np.max(tail))
        self._fixed = self._of_cells(flexibility, tail)
        if besides is not None:
            self._fixed = self._fixed + besides
        # A gap as wide as the pin never closes.
        self._beyond = 0.0 if gone is None else gone * bands.radius.max()
        self._fit(bands, tilt)

    def cells_area(self, bands: Bands) -> Floats:
        """The areas of all cells of bands with as many rings, (U,) m^2."""
        return np.repeat(bands.length * bands.radius, self.sectors) * 2.0 * np.pi / self.sectors

    def changed(self, gap: Floats, tilt: Sequence[float]) -> ContactProblem:
        """The same problem with another initial gap (R,), m, and another tilt stiffness."""
        other = copy.copy(self)
        other._fit(replace(self.bands, gap=gap), tilt)
        return other

    def _fit(self, bands: Bands, tilt: Sequence[float]) -> None:
        self.bands = bands
        self._open = np.repeat(bands.gap, self.sectors) + self._beyond
        self._motions, tilts = self.rigid(bands, tilt)
        self._compliance = self._fixed + tilts @ tilts.T if tilts.size else self._fixed
        self._soft = SOFT_SPRING_STIFFNESS / np.abs(self._compliance).max()
        largest = np.abs(self._motions).max(axis=0)  # a turn counts as the shift at the far end
        self._reach = np.where(largest > 0.0, largest, 1.0)
        self._answers: dict[bytes, _Answer] = {}

    @property
    def closed(self) -> bool:
        """Whether pin and bores fit everywhere before any load."""
        return not self.bands.gap.any()

    def factors(self, n: Ints) -> Floats:
        """Factors (N,) of harmonics in the mean displacement of a cell under pressure on a cell."""
        return np.asarray(
            np.where(n == 0, 1.0, 2.0) / self.sectors * np.sinc(n / self.sectors) ** 2
        )

    def tail_weights(self, first: int) -> Floats:
        """Coefficients (M,) of cos(n a) on the sectors that sum the series u_n = p_n / n from
        harmonic `first` on.
        """
        n = np.arange(first, TAIL_HARMONICS_PER_SECTOR * self.sectors)
        terms = self.factors(n) / n
        return np.asarray(np.bincount(n % self.sectors, terms, self.sectors), dtype=np.float64)

    def _of_cells(self, flexibility: Floats, tail: Floats) -> Floats:
        """Mean displacement of cells under forces on cells, (U, U) m/N."""
        M, n = self.sectors, np.arange(len(flexibility))
        # The flexibility depends on the angle between two cells alone: it is summed over harmonics
        # for each angle, the half-plane's beyond, and then laid out for all pairs of cells.
        waves = np.cos(np.outer(n, self.angles)) * self.factors(n)[:, None]  # (N + 1, M)
        apart = np.tensordot(flexibility, waves, (0, 0))  # (R, R, M)
        weights = self.tail_weights(len(flexibility))
        near = weights @ np.cos(np.outer(np.arange(M), self.angles))  # the same a turn further on
        apart[np.arange(len(tail)), np.arange(len(tail))] += tail[:, None] * near
        turn = (np.arange(M)[:, None] - np.arange(M)) % M
        rings = len(tail)
        full = apart[:, :, turn].transpose(0, 2, 1, 3).reshape(rings * M, rings * M)
        return np.asarray(full / self.area)

    def rigid(self, bands: Bands, tilt: Sequence[float]) -> tuple[Floats, Floats]:
        """Changes of the gap by the motions of lugs and pin, on bands with as many rings.

        The first value, (U, Y), is that of motions without stiffness: shifts of the lugs, turn of
        the pin, tilts of the free lugs. The second, (U, S), is that of sprung tilts over the root
        of their stiffness, so that its product with itself is their compliance.
        """
        columns = [self._e_r * (self._link == k)[:, None] for k in range(self._count)]
        band, z = (np.repeat(x, self.sectors) for x in (bands.band, bands.z))
        middle = 0.5 * (z.min() + z.max())
        columns.append(self._e_r * (z - middle)[:, None])
        elastic = [np.zeros((len(z), 0))]
        for b, stiffness in enumerate(tilt):
            arm = (z - bands.middles[b]) * (band == b)
            column = self._e_r * arm[:, None]
            if stiffness == 0.0:
                columns.append(column)
            elif np.isfinite(stiffness):
                elastic.append(column / math.sqrt(stiffness))
        return np.hstack(columns), np.hstack(elastic)

    def solve(
        self, forces: Floats, couple: tuple[float, float] = (0.0, 0.0), start: Mask | None = None
    ) -> ContactState:
        """The contact under forces (L, 2), N, of the links on the pin, along x and y.

        couple: N m, along x and y, on the pin by anything but transverse forces at the bands,
        moments of links included.
        start: cells (R, M) in contact at a neighbouring instant.

        Raises: SolveError where the active set does not settle.
        """
        forces = np.asarray(forces, dtype=np.float64)
        required = self.required_resultants(forces, couple)
        first = self._facing(forces) if start is None else start.ravel().copy()
        state = self._settled(required, first) or self._from_larger(required, forces)
        if state is None:
            raise SolveError(
                f"contact does not settle in {MAX_ACTIVE_SET_STEPS} steps", "contact-unsettled"
            )
        return state

    def _settled(self, required: Floats, active: Mask) -> ContactState | None:
        """The contact found from a first set of cells in contact; None where the sets do not
        settle.
        """
        # Each step solves the linear contact of the guessed cells, then corrects the guess: cells
        # in tension open, cells that penetrate close. This is a semismooth Newton method
        # (Hintermueller et al.), which needs few steps even from a poor guess.
        seen: set[bytes] = set()
        for step in range(1, MAX_ACTIVE_SET_STEPS + 1):
            answer = self._answer(active)
            force, gap, motion = answer.under(required)
            wrong_force = active & (force < -SIGN_TOLERANCE * np.abs(force).max(initial=0.0))
            wrong_gap = ~active & (gap < -SIGN_TOLERANCE * np.abs(gap).max(initial=0.0))
            if not (wrong_force | wrong_gap).any():
                self._require_balance(force, required, answer)
                return self._state(force, gap, motion, step)
            # Where fewer cells touch than hold the pin, it turns far and most of the others
            # penetrate: only the deepest of each band is then near to those that will touch.
            loose = wrong_gap & (self._open > 0.0)
            if np.count_nonzero(loose) > np.count_nonzero(active):
                wrong_gap = (wrong_gap & ~loose) | self._deepest(gap, loose)
            key = active.tobytes()
            # A set that comes back is a cycle. Changing the first wrong cell alone, as in Murty's
            # least-index method, leads out of it.
            if key in seen:
                first = int(np.flatnonzero(wrong_force | wrong_gap)[0])
                active[first] = not active[first]
            else:
                active = (active & ~wrong_force) | wrong_gap
            seen.add(key)
        return None

    def _deepest(self, gap: Floats, among: Mask) -> Mask:
        """A mask of the cell of least gap of each band, among some."""
        out, rings = np.zeros_like(among), len(self.bands.z)
        shallow = np.where(among, gap, np.inf).reshape(rings, self.sectors)
        for band in range(int(self.bands.band.max()) + 1):
            rows = np.flatnonzero(self.bands.band == band)
            cell = int(shallow[rows].argmin())
            out[rows[cell // self.sectors] * self.sectors + cell % self.sectors] = True
        return out & among

    def _from_larger(self, required: Floats, forces: Floats) -> ContactState | None:
        """The contact found by continuation from larger loads, under which it settles, down to the
        given ones.

        With small loads and large gaps few cells touch, far from the first guess.
        """
        # Up: under a larger load gaps matter less and most facing cells touch, which the first
        # guess has. Down: each contact is the start of the next smaller load; where that does not
        # settle the reduction is made smaller.
        times, state = 1.0, None
        while state is None and times < MAX_LOAD_FACTOR:
            times *= LOAD_GROWTH
            state = self._settled(times * required, self._facing(times * forces))
        factor = LOAD_REDUCTION
        while state is not None and times > 1.0 and factor > MIN_LOAD_REDUCTION:
            smaller = max(1.0, times / factor)
            next_state = self._settled(smaller * required, state.active.ravel().copy())
            if next_state is None:
                factor = math.sqrt(factor)
            else:
                times, state = smaller, next_state
        return state if times == 1.0 else None

    def _answer(self, active: Mask) -> _Answer:
        """The response of given cells in contact, kept for later instants."""
        key = np.packbits(active).tobytes()
        if key not in self._answers:
            if len(self._answers) * self._motions.size > MAX_KEPT_NUMBERS:
                self._answers.clear()
            self._answers[key] = self._compute_answer(active)
        return self._answers[key]

    def _compute_answer(self, active: Mask) -> _Answer:
        # On the cells in contact the gap is zero: C p = -open - G y. One factorisation of C serves
        # the initial gaps and every rigid motion y, which are then the only unknowns left.
        C, G = self._compliance, self._motions
        rows = np.flatnonzero(active)
        force, yielding = np.zeros(len(active)), np.zeros(G.shape)
        system, right = self._soft * np.diag(self._reach**2), np.zeros(G.shape[1])
        C = C[rows]  # symmetric
        if len(rows):
            factor = cho_factor(C[:, rows], lower=True, check_finite=False, overwrite_a=True)
            given = np.column_stack([G[rows], -self._open[rows]])
            solved = cho_solve(factor, given, check_finite=False)
            yielding[rows], force[rows] = solved[:, :-1], solved[:, -1]
            system, right = system + G[rows].T @ solved[:, :-1], G[rows].T @ solved[:, -1]
        both = np.column_stack([yielding[rows], force[rows]])
        change = (both.T @ C).T
        gap, moving = self._open + change[:, -1], G - change[:, :-1]
        gap[rows], moving[rows] = 0.0, 0.0
        return _Answer(force, yielding, gap, moving, system, right, G, self._reach)

    def required_resultants(
        self, forces: Floats, couple: tuple[float, float] = (0.0, 0.0)
    ) -> Floats:
        """The resultants (Y,) that the cells' forces must have on the rigid motions.

        Their sign is negative since the cells push the pin against e_r.
        """
        out = np.zeros(self._motions.shape[1])
        count = self._count
        out[: 2 * count] = -np.asarray(forces, dtype=float).ravel()
        mx, my = couple  # x: by forces along -y at z, y: by forces along x at z
        out[2 * count : 2 * count + 2] = my, -mx
        return out

    def _require_balance(self, force: Floats, required: Floats, answer: _Answer) -> None:
        """Check that the cells' forces have the required resultants.

        Raises: SolveError where they have not.
        """
        # A couple counts as the force at the far end that makes it, so that all residuals are
        # forces.
        residual = np.abs(self._motions.T @ force - required) / self._reach
        lost = residual.max(initial=0.0)
        if lost <= BALANCE_TOLERANCE * np.abs(required).max(initial=force.max(initial=0.0)):
            return
        if lost <= CLOSING_FORCE_ROUND_OFF * np.abs(answer.force).max():
            raise SolveError(
                "the loads are so small for the clearance that contact is lost in round-off",
                "loads-too-small",
            )
        raise SolveError(
            "the links leave a couple on the pin that no lug reacts", "couple-not-reacted"
        )

    def adjoint(self, active: Mask, wanted: Floats, required: Floats) -> AdjointContact:
        """The sensitivity of a sum of the cells' forces, weighted by `wanted` (U,), to gaps and
        loads.

        active: the cells (R, M) in contact.
        required: the required resultants of the rigid motions.
        """
        # The problem is symmetric: the adjoint is the same contact with `wanted` as its right-hand
        # side and no resultants.
        rows = np.flatnonzero(active)
        answer = self._answer(active.ravel())
        force, _, motion = answer.under(required)
        C, G = self._compliance[np.ix_(rows, rows)], self._motions[rows]
        dual = np.zeros(len(force))
        dual[rows] = cho_solve(cho_factor(C, lower=True, check_finite=False), wanted[rows])
        of_motion, lost = np.zeros(len(required)), G.T @ dual[rows]
        for _ in range(2):  # once more for round-off, as contact itself
            of_motion += answer.motion(lost)
            lost = G.T @ (dual[rows] - answer.yielding[rows] @ of_motion)
        return AdjointContact(force, motion, dual - answer.yielding @ of_motion, of_motion)

    def _facing(self, forces: Floats) -> Mask:
        """A mask of the cells that face the load of their band, as far around as it presses."""
        size = np.linalg.norm(forces, axis=1)
        towards = -np.einsum("ua,ua->u", self._e_r, forces[self._link])
        cosine = self._contact_cosine(size)[self._link] * np.linalg.norm(self._e_r[0])
        return np.asarray((towards > cosine * size[self._link]) & (size[self._link] > 0.0))

    def _contact_cosine(self, size: Floats) -> Floats:
        """The cosine (L,) of the half angle of contact by the size (L,), N, of the links' forces,
        if these were even along their bands: a guess.
        """
        # Persson's plane contact in the limit of large gaps, E* gap / Q = 2 / (pi tan^2(half / 2)),
        # too wide for small ones; 4 R / E* is the tail of pin and lug together.
        gap, length = np.full(len(size), np.inf), np.zeros(len(size))
        link = self.bands.links[self.bands.band]
        np.minimum.at(gap, link, self.bands.gap)
        np.add.at(length, link, self.bands.length)
        per_length = 4.0 * self.bands.radius.max() / self._tail * gap * length
        half = 2.0 * np.arctan2(np.sqrt(2.0 * size), np.sqrt(np.pi * np.maximum(per_length, 0.0)))
        nearest = math.cos(1.01 * math.pi / self.sectors)  # one cell at least
        return np.asarray(np.clip(np.cos(half), FACING_COSINE, nearest))

    def _state(self, force: Floats, gap: Floats, motion: Floats, steps: int) -> ContactState:
        shape = (len(self.bands.z), self.sectors)
        count = self._count
        return ContactState(
            np.maximum(force / self.area, 0.0).reshape(shape),
            np.maximum(gap, 0.0).reshape(shape),
            motion[: 2 * count].reshape(count, 2)[self.bands.links],
            motion[2 * count : 2 * count + 2],
            steps,
        )

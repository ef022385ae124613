"""Frictionless contact of a pin with its lugs on cells, which are rings of the bands times sectors.

With pressure p >= 0 on the cells, the mean gap between pin and bore over a cell is

    g = clearance / 2 + edge rounding + C p + (shift of the lug + z turn of the pin) . e_r >= 0

and p g = 0. C is the flexibility of pin and lugs together under pressures that are uniform on each
cell. It is computed harmonic by harmonic, with that of a half-plane for the highest harmonics, and
averaged over cells, so that it is symmetric. A lug whose tilt is elastic adds the tilt that the
couple of the pressures causes. Shifts and turn are the Lagrange multipliers of equilibrium: the
resultant on the bands of a link is the link's force, and the couples on the pin are in balance.

This is a linear complementarity problem with a positive definite matrix. A primal-dual active set
solves it in few steps. Where the cells in contact leave the pin or a lug free to move, as one line
of cells does across the line, it moves until the next cells touch. The active set may cycle where
barely more cells touch than are needed to hold the pin; then a descent of the energy finds the
cells (fea.support.contact.least_energy). As long as the same cells are in contact, everything is
linear in the loads. The response of each set of cells is therefore computed once and kept, so that
neighbouring instants cost almost nothing.

Sources: Hintermueller, Ito & Kunisch, SIAM J. Optim. 13 (2002) 865 (the active set); Ciavarella &
Decuzzi, Int. J. Solids Struct. 38 (2001) 4507 (the plane problem that tests compare with).
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property, partial

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats
from fea.support.bands import Bands
from fea.support.contact.contact_answer import AdjointContact, Answer
from fea.support.contact.contact_state import ContactState
from fea.support.contact.first_cells import cell_loads, facing_cells
from fea.support.contact.least_energy import least_energy_cells, require_forces, unsettled
from fea.support.contact.sectors import CellFlexibility, Sectors
from pinbase.arrays import Mask

# Limits of the iteration and of the descent, chosen by judgement. They decide how soon contact is
# found; the contact itself is unique.
MAX_ACTIVE_SET_STEPS = 20
# Springs hold the pin during the descent. SPRING_FORCE is the force of the first springs, relative
# to the loads, when they stretch by the largest gap and the elastic displacement. SPRING_SOFTENING
# is the factor on their stiffness where they have passed on too little of the loads. Of 400 random
# light loads in loose lugs none took more than five rounds.
SPRING_FORCE, SPRING_SOFTENING, MAX_SPRING_ROUNDS = 1e-3, 1e-3, 30
# The x and y parts of required resultants and rigid motions, which come in pairs.
ALONG_X, ALONG_Y = slice(0, None, 2), slice(1, None, 2)
# Round-off of double precision, with a margin chosen by judgement.
BALANCE_TOLERANCE = 1e-9  # of the largest force
CLOSING_FORCE_ROUND_OFF = 1e-12  # of the forces that would close the gaps
SIGN_TOLERANCE = 1e-12  # of the largest pressure or gap: a wrong sign below it is round-off
# A spring, relative to the stiffness of the cells, that holds a lug which has lost all contact. It
# is far too soft to change the contact of any other lug.
SOFT_SPRING_STIFFNESS = 1e-13
# Responses of sets of cells that are kept, counted as one number for each cell and motion.
MAX_KEPT_NUMBERS = 4_000_000
MAX_KEPT_STATES = 64  # solved states that are kept: single instants are requested repeatedly


class ContactProblem:
    """The contact problem of one pin in its lugs, ready for any loads.

    flexibility: mean displacements of rings, by harmonic, pin and lugs together, (N + 1, R, R)
    m/Pa.
    tail: n u_n / p_n of pin and lugs together for higher harmonics, (R,) m/Pa.
    tilt: tilt stiffness of the lugs, (B,) N m/rad; inf where guided, 0 where free.
    sectors: number M of equal sectors; the first is centred on x.
    added: displacement of cells under forces on cells that a body without rotational symmetry
    adds, (U, U) m/N.
    removed: mask (U,) of the cells that cuts have removed.
    """

    def __init__(
        self,
        bands: Bands,
        flexibility: Floats,
        tail: Floats,
        tilt: Sequence[float],
        sectors: int,
        added: Floats | None = None,
        removed: Mask | None = None,
    ) -> None:
        self.bands, self.sectors, self._cells = bands, sectors, Sectors(sectors)
        self._count = int(bands.links.max()) + 1
        self._tail = float(np.max(tail))
        area = self.cells_area(bands)
        self._elastic = CellFlexibility(flexibility, tail, area[::sectors], sectors, added)
        # A gap as wide as the pin never closes.
        self._removed_gap = 0.0 if removed is None else removed * bands.radius.max()
        self._even = added is None and removed is None
        self._fit(bands, tilt)

    @property
    def angles(self) -> Floats:
        """The angles (M,) of the middles of the sectors, rad."""
        return self._cells.angles

    def cells_area(self, bands: Bands) -> Floats:
        """The areas of all cells, (U,) m^2, on bands with as many rings as this problem has."""
        of_ring = bands.length * bands.radius * 2.0 * np.pi / self.sectors
        return np.outer(of_ring, self._cells.sizes).ravel()

    def changed(self, gap: Floats, tilt: Sequence[float]) -> ContactProblem:
        """The same problem with another initial gap (R,), m, and another tilt stiffness."""
        other = copy.copy(self)
        other._fit(replace(self.bands, gap=gap), tilt)
        return other

    def freed(self, bands: Mask) -> ContactProblem:
        """The same problem with the lugs of a mask (B,) free to tilt, kept for later loads."""
        key = bands.tobytes()
        if not bands.any():
            return self
        if key not in self._freed:
            tilt = [0.0 if free else k for free, k in zip(bands, self.tilt, strict=True)]
            self._freed[key] = self.changed(self.bands.gap, tilt)
        return self._freed[key]

    @cached_property
    def mirrored(self) -> ContactProblem:
        """The same problem for loads in the plane of x and the axis, where contact is symmetric."""
        other = copy.copy(self)
        other._cells = Sectors(self.sectors, mirrored=True)
        other._fit(self.bands, self.tilt)
        return other

    def _fit(self, bands: Bands, tilt: Sequence[float]) -> None:
        self.bands, self.tilt = bands, tuple(tilt)
        self._freed: dict[bytes, ContactProblem] = {}
        self.area = self.cells_area(bands)
        self._e_r = np.tile(self._cells.normals, (len(bands.z), 1))  # (U, 2)
        self._link = np.repeat(bands.links[bands.band], len(self._cells))
        self._open = np.repeat(bands.gap, len(self._cells)) + self._removed_gap
        self._motions, self._tilts = self.rigid(bands, tilt)
        largest = np.abs(self._motions).max(axis=0)  # a turn counts as the shift at the far end
        self._reach = np.where(largest > 0.0, largest, 1.0)
        self._answers: dict[bytes, Answer] = {}
        self._states: dict[bytes, ContactState] = {}
        for made in ("_compliance", "mirrored"):
            self.__dict__.pop(made, None)

    @cached_property
    def _compliance(self) -> Floats:
        """The mean displacements of the cells under forces on the cells, (U, U) m/N."""
        fixed = self._elastic.of(self._cells)
        return fixed + self._tilts @ self._tilts.T if self._tilts.size else fixed

    @property
    def _softest(self) -> float:
        """The largest compliance, m/N; of a positive definite matrix it is on the diagonal."""
        return float(self._compliance.diagonal().max())

    @property
    def closed(self) -> bool:
        """Whether the gap is zero everywhere before loading."""
        return not self.bands.gap.any()

    def rigid(self, bands: Bands, tilt: Sequence[float]) -> tuple[Floats, Floats]:
        """The changes of the gap by rigid motions, on bands with as many rings as this problem has.

        The first array, (U, Y), is for motions without stiffness: shifts of the lugs, turn of the
        pin, tilts of free lugs. The second, (U, S), is for elastic tilts, each divided by the root
        of its stiffness, so that the array times its transpose is the compliance of the tilts.
        """
        # With symmetry about x, nothing moves along y.
        e_r = self._e_r[:, :1] if self._cells.mirrored else self._e_r
        columns = [e_r * (self._link == k)[:, None] for k in range(self._count)]
        band, z = (np.repeat(x, len(self._cells)) for x in (bands.band, bands.z))
        columns.append(e_r * (z - bands.middle)[:, None])
        elastic = [np.zeros((len(z), 0))]
        for b, stiffness in enumerate(tilt):
            arm = (z - bands.middles[b]) * (band == b)
            column = e_r * arm[:, None]
            if stiffness == 0.0:
                columns.append(column)
            elif np.isfinite(stiffness):
                elastic.append(column / math.sqrt(stiffness))
        return np.hstack(columns), np.hstack(elastic)

    def solve(
        self,
        forces: Floats,
        couple: tuple[float, float] = (0.0, 0.0),
        start: Mask | None = None,
        moments: Floats | None = None,
    ) -> ContactState:
        """Return the contact under forces of the links.

        forces: on the pin, along x and y, (L, 2) N.
        couple: on the pin along x and y, by everything but the lugs, N m.
        start: mask (R, M) of the cells in contact at a neighbouring instant.
        moments: on the pin along x and y, by the lugs that are free to tilt, (B, 2) N m.

        Raises: SolveError where no cells in contact are found, or no contact can react the loads.
        """
        forces = np.asarray(forces, dtype=np.float64)
        required = self.required_resultants(forces, couple, moments)
        if self._cells.mirrored:
            required = required[ALONG_X]
        elif self._even and self._along_x(required):
            return self.mirrored.solve(forces, couple, start, moments)
        if start is None and (known := self._states.get(required.tobytes())) is not None:
            return known
        guess = self.first_cells(forces, moments) if start is None else self._cells.first(start)
        state = self._settled(required, guess) or self._by_energy(required, guess)
        if state is None:
            raise unsettled()
        if len(self._states) == MAX_KEPT_STATES:
            self._states.clear()
        self._states[required.tobytes()] = state
        return state

    def _along_x(self, required: Floats) -> bool:
        """Whether the required resultants lie in the plane of x and the pin's axis."""
        size = np.abs(required) / self._reach
        return bool(size[ALONG_Y].max() <= BALANCE_TOLERANCE * size.max())

    def _settled(self, required: Floats, active: Mask) -> ContactState | None:
        """Return the contact that the active set finds from a guess; None if it does not settle."""
        # Each step solves the linear contact of the guessed cells, then corrects the guess: cells
        # in tension open, cells that penetrate close. This is a semismooth Newton method
        # (Hintermueller et al.), which needs few steps even from a poor guess.
        seen: set[bytes] = set()
        for step in range(1, MAX_ACTIVE_SET_STEPS + 1):
            answer = self._answer(active)
            force, gap, motion = answer.under(required)
            wrong_force = active & (force < -SIGN_TOLERANCE * np.abs(force).max(initial=0.0))
            wrong_gap = ~active & (gap < -SIGN_TOLERANCE * np.abs(gap).max(initial=0.0))
            freely = answer.freely(required)
            if not (wrong_force | wrong_gap).any():
                if self._balances(force, required, answer):
                    return self._state(force, gap, motion, step)
                if freely is None:  # loads that the cells cannot react, as those of a free lug
                    return None
            if (key := active.tobytes()) in seen:
                return None  # a cycle
            seen.add(key)
            if freely is None:
                closing = self._cells_to_close(gap, wrong_gap, active)
            else:
                closing = self._first_to_touch(*freely, active) & ~active
            active = (active & ~wrong_force) | closing
        return None

    def _first_to_touch(self, gap: Floats, rate: Floats, active: Mask) -> Mask:
        """A mask (U,) of the cells that touch first in each band when the gaps change at a rate.

        Cells that overlap and that the motion does not change are in it, too.
        """
        # The motion along the way starts anywhere, so that gaps may be negative. Not only the first
        # cell closes, but its sector on all rings in contact: one ring alone would take the whole
        # force and turn the pin.
        size = SIGN_TOLERANCE * np.abs(rate).max(initial=0.0)
        overlap = (gap < -SIGN_TOLERANCE * np.abs(gap).max(initial=0.0)) & (np.abs(rate) <= size)
        way, closing = np.full(len(gap), np.inf), rate < -size
        np.divide(gap, -rate, out=way, where=closing)
        first = self._deepest(way, closing).reshape(len(self.bands.z), -1)
        touched = active.reshape(first.shape).any(axis=1)
        for ring, k in np.argwhere(first):
            first[touched & (self.bands.band == self.bands.band[ring]), k] = True
        return np.asarray(overlap | first.ravel())

    def _cells_to_close(self, gap: Floats, overlaps: Mask, active: Mask) -> Mask:
        """A mask of the overlapping cells to close in the next step."""
        # Where fewer cells touch than are needed to hold the pin, the pin turns far and most other
        # cells overlap. Only the deepest cell of each band is then near those that will touch.
        loose = overlaps & (self._open > 0.0)
        if np.count_nonzero(loose) <= np.count_nonzero(active):
            return overlaps
        return np.asarray((overlaps & ~loose) | self._deepest(gap, loose))

    def _deepest(self, gap: Floats, among: Mask) -> Mask:
        """A mask of the cell with the smallest gap in each band, among the given cells."""
        out, rings = np.zeros_like(among), len(self.bands.z)
        shallow = np.where(among, gap, np.inf).reshape(rings, -1)
        for band in range(int(self.bands.band.max()) + 1):
            rows = np.flatnonzero(self.bands.band == band)
            cell = int(shallow[rows].argmin())
            ring, k = divmod(cell, len(self._cells))
            out[rows[ring] * len(self._cells) + k] = True
        return out & among

    def _by_energy(self, required: Floats, first: Mask) -> ContactState | None:
        """Return the contact that descent of the energy finds; None where round-off hides it.

        Descent finds every contact that exists. first: mask of the cells in contact at the start.

        Raises: SolveError where no forces of the cells have the required resultants.
        """
        size = float(np.abs(required / self._reach).max())
        require_forces((self._motions / self._reach).T, required / self._reach / (size or 1.0))
        # Springs hold the pin and the lugs. They first pull with the loads; each round adds the
        # part of the loads that has not reached the cells, until nothing is missing (the method of
        # multipliers). Small parts need softer springs, so that the pin moves across the gaps.
        give = float(np.abs(self.bands.gap).max()) + size * self._softest
        spring, pull, missing = SPRING_FORCE * (size or 1.0) / give, required, required
        force = np.maximum(self._answer(first).on_springs(pull, spring)[0], 0.0)
        for _ in range(MAX_SPRING_ROUNDS):
            least = partial(self._on_springs, pull=pull, spring=spring)
            energy = partial(self._energy, pull=pull, spring=spring)
            cells, force = least_energy_cells(force, least, energy, self._cells_to_close)
            if (state := self._settled(required, cells)) is not None:
                return state
            before, missing = missing, required - self._motions.T @ force
            pull = pull + missing
            if np.abs(missing / self._reach).max() > 0.1 * np.abs(before / self._reach).max():
                spring *= SPRING_SOFTENING
        return None

    def _on_springs(
        self, active: Mask, pull: Floats, spring: float
    ) -> tuple[Floats, Callable[[], Floats]]:
        return self._answer(active).on_springs(pull, spring)

    def _energy(self, force: Floats, pull: Floats, spring: float) -> float:
        """The energy, N m, of cell forces (U,), N, with springs, N/m; it is least in contact."""
        rows = np.flatnonzero(force)
        some = force[rows]
        stretched = (self._motions[rows].T @ some - pull) / self._reach
        elastic = 0.5 * float(some @ (self._compliance[np.ix_(rows, rows)] @ some))
        return elastic + float(self._open[rows] @ some + 0.5 * stretched @ stretched / spring)

    def _answer(self, active: Mask) -> Answer:
        """The response of given cells in contact; it is kept for later instants."""
        key = np.packbits(active).tobytes()
        if key not in self._answers:
            if len(self._answers) * self._motions.size > MAX_KEPT_NUMBERS:
                self._answers.clear()
            self._answers[key] = self._compute_answer(active)
        return self._answers[key]

    def _compute_answer(self, active: Mask) -> Answer:
        # On the cells in contact the gap is zero: C p = -open - G y. One factorisation of C serves
        # the initial gaps and every rigid motion. The motions y are then the only unknowns left.
        C, G = self._compliance, self._motions
        rows = np.flatnonzero(active)
        force, yielding = np.zeros(len(active)), np.zeros(G.shape)
        soft = SOFT_SPRING_STIFFNESS / self._softest
        system, right = soft * np.diag(self._reach**2), np.zeros(G.shape[1])
        if len(rows):
            between = C[np.ix_(rows, rows)]
            factor = cho_factor(between, lower=True, check_finite=False, overwrite_a=True)
            given = np.column_stack([G[rows], -self._open[rows]])
            solved = cho_solve(factor, given, check_finite=False)
            yielding[rows], force[rows] = solved[:, :-1], solved[:, -1]
            system, right = system + G[rows].T @ solved[:, :-1], G[rows].T @ solved[:, -1]
        return Answer(rows, force, yielding, system, right, self._open, C, G, self._reach)

    def required_resultants(
        self,
        forces: Floats,
        couple: tuple[float, float] = (0.0, 0.0),
        moments: Floats | None = None,
    ) -> Floats:
        """The resultants (Y,) that the cells' forces must have, by rigid motion, under the loads of
        `solve`. The links' forces change sign, since the cells push the pin against e_r.
        """
        mx, my = couple  # x: by forces along -y at z, y: by forces along x at z
        free = np.array(self.tilt) == 0.0
        of_free = np.zeros(2 * np.count_nonzero(free))
        if moments is not None:
            of_free = (moments[free][:, ::-1] * [-1.0, 1.0]).ravel()
        return np.concatenate([-np.asarray(forces, dtype=float).ravel(), [my, -mx], of_free])

    def _balances(self, force: Floats, required: Floats, answer: Answer) -> bool:
        """Whether the cells' forces have the required resultants.

        Raises: SolveError where round-off hides whether they do.
        """
        # A couple counts as a force on the longest lever arm, so that all residuals are forces.
        residual = np.abs(self._motions.T @ force - required) / self._reach
        lost = residual.max(initial=0.0)
        if lost <= BALANCE_TOLERANCE * np.abs(required).max(initial=force.max(initial=0.0)):
            return True
        if lost <= CLOSING_FORCE_ROUND_OFF * np.abs(answer.force).max():
            raise SolveError(
                "the loads are so small for the clearance that contact is lost in round-off",
                "loads-too-small",
            )
        return False

    def adjoint(self, active: Mask, wanted: Floats, required: Floats) -> AdjointContact:
        """The sensitivity of a weighted sum of the cells' forces to gaps and loads.

        active: mask (R, M) of the cells in contact.
        wanted: weights of the forces in the sum, (U,).
        required: required resultants of the rigid motions, (Y,).
        """
        # The problem is symmetric: the adjoint is the same contact with `wanted` as its right-hand
        # side and zero resultants.
        rows = np.flatnonzero(active)
        answer = self._answer(active.ravel())
        force, _, motion = answer.under(required)
        C, G = self._compliance[np.ix_(rows, rows)], self._motions[rows]
        dual = np.zeros(len(force))
        dual[rows] = cho_solve(cho_factor(C, lower=True, check_finite=False), wanted[rows])
        of_motion, lost = np.zeros(len(required)), G.T @ dual[rows]
        for _ in range(2):  # the second pass removes round-off, as in Answer.under
            of_motion += answer.motion(lost)
            lost = G.T @ (dual[rows] - answer.yielding[rows] @ of_motion)
        return AdjointContact(force, motion, dual - answer.yielding @ of_motion, of_motion)

    def first_cells(self, forces: Floats, moments: Floats | None = None) -> Mask:
        """A mask (U,) of the cells that are likely to touch under the loads of `solve`."""
        acting = cell_loads(self.bands, len(self._cells), forces, moments)
        return facing_cells(self.bands, self._tail, self.sectors, self._e_r, acting)

    def _state(self, force: Floats, gap: Floats, motion: Floats, steps: int) -> ContactState:
        count, cells = self._count, self._cells
        if cells.mirrored:
            motion = np.stack([motion, np.zeros_like(motion)], axis=1).ravel()
        return ContactState(
            cells.all_round(np.maximum(force / self.area, 0.0)),
            cells.all_round(np.maximum(gap, 0.0)),
            motion[: 2 * count].reshape(count, 2)[self.bands.links],
            motion[2 * count : 2 * count + 2],
            steps,
        )

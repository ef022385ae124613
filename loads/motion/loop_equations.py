"""The loop equations of a planar linkage, assembled from its data, for all instants at once.

A spanning tree of connections and sliders joins all bodies to the ground; every connection or
slider beyond the tree closes a loop. Bodies that slide on each other rotate together: they share a
frame. With u = exp(i angle) of each frame and x = extension of each slider since the drawing, the
position of every point of the linkage is, in complex numbers, a sum of fixed vectors that rotate
with frames and slide along axes,

    z = sum over frames of u A + sum over sliders of x u_f e B,

so a loop equation is a vanishing sum of the same kind (the vector loop of the textbooks, e.g.
Norton, Design of Machinery, ch. 4 and 6), and its derivatives are explicit. The coordinates are the
frames' angles and the sliders' extensions, which are few, however many bodies and pins there are.
Angles are scaled by a typical length, so that all columns are lengths.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from loads.linkage.gears import gap_weights, row
from loads.linkage.linkage import Linkage
from loads.linkage.parts import Slider, Turn
from loads.motion.complex_points import PointMotion, Points, Pose, number
from loads.motion.least_squares import Factors, Step, elimination
from loads.motion.spanning_tree import LENGTH_ROUND_OFF, ends_of, frames, shortest, spanning_tree
from pinbase.arrays import Complex, Floats, Ints

MATRIX_BATCH_ENTRIES = 2**20  # entries of the matrices of a batch of instants: 8 MB


class Loops:
    """The loop and drive equations of one linkage.

    Coordinates q (T, n) are the angles (rad) of all frames but the ground's, then the extensions
    (m) of the sliders. There are two rows per closure (x of all closures, then y of all), one row
    per pair of teeth, and one row per drive. All multipliers are in N. The multiplier of a closure
    is the force of the pin on the body, or of the base on the moving body; that of teeth is the
    force on the first body along the pitch circle; that of a drive is its force, or its torque over
    the length scale.
    """

    def __init__(self, linkage: Linkage) -> None:
        self.linkage = linkage
        self.frames, self.frame = frames(linkage)
        self.tree, self.closing = spanning_tree(linkage)
        self._root, self._slid = self._chains()
        self.gaps = self._gaps()
        self._combined = shortest(np.concatenate([self.gaps.turning[1:], self.gaps.sliding]))
        self.drawn_drives = np.array([d.drawn for d in linkage.drives])
        fixed = [row(self.linkage, self.frame, t) for t in linkage.teeth]
        fixed += [self.along(d) for d in linkage.drives]
        self._fixed_rows = np.array(fixed).reshape(len(fixed), self.columns)

    @property
    def columns(self) -> int:
        """Number of coordinates."""
        return self.frames - 1 + len(self.linkage.sliders)

    @property
    def rows(self) -> int:
        """Number of equations."""
        return self.guides + len(self.linkage.driven)

    @property
    def guides(self) -> int:
        """Number of equations without those of the drives."""
        return 2 * len(self.closing) + len(self.linkage.teeth)

    def parts(self, count: int) -> list[slice]:
        """Slices that divide `count` instants into batches whose matrices take little memory."""
        size = max(1, MATRIX_BATCH_ENTRIES // max(1, self.rows * self.columns))
        return [slice(k, min(k + size, count)) for k in range(0, max(count, 1), size)]

    @cached_property
    def scale(self) -> Floats:
        """Length per unit of each coordinate, (n,): m for an angle, 1 for an extension."""
        out = np.ones(self.columns)
        out[: self.frames - 1] = self.linkage.length_scale
        return out

    @cached_property
    def slider_frame(self) -> Ints:
        """Frame with which each slider rotates, (S,)."""
        index = self.linkage.index
        return np.array([self.frame[index[s.base]] for s in self.linkage.sliders], dtype=np.int64)

    def along(self, drive: Slider | Turn) -> Floats:
        """Derivative (n,) of a drive's value by the coordinates, both scaled to lengths."""
        row = np.zeros(self.columns)
        if isinstance(drive, Slider):
            row[self.frames - 1 + self.linkage.sliders.index(drive)] = 1.0
            return row
        for body, sign in ((drive.body, 1.0), (drive.base, -1.0)):
            f = self.frame[self.linkage.index[body]]
            if f:
                row[f - 1] += sign
        return row

    def unit(self, drive: Slider | Turn) -> float:
        """Length per unit of a drive: 1 for a slider, m per rad for a turn."""
        return 1.0 if isinstance(drive, Slider) else self.linkage.length_scale

    @cached_property
    def drive_scale(self) -> Floats:
        """Length per unit of each drive, (D,)."""
        return np.array([self.unit(drive) for drive in self.linkage.drives])

    def points(self, items: Ints, drawn: Complex) -> Points:
        """Points fixed in items.

        items: (N,) numbers of the items. drawn: (N,) positions as drawn, complex, m.
        """
        turning = self._root[:, items].copy()
        turning[self.frame[items], np.arange(len(items))] += drawn
        return Points(turning, self._slid[:, items])

    @cached_property
    def centres(self) -> Points:
        """Centres of mass of all items."""
        at = np.array([number(item.centre) for item in self.linkage.items])
        return self.points(np.arange(len(at)), at)

    # --- kinematics -------------------------------------------------------------------------------

    def pose(self, q: Floats) -> Pose:
        """The position of the linkage at coordinates q (T, n)."""
        angles = self.frames - 1
        turn = np.ones((len(q), self.frames), dtype=complex)
        np.exp(1j * q[:, :angles], out=turn[:, 1:])
        return Pose(turn, turn[:, self.slider_frame] * self._drawn_axes, q[:, angles:])

    @cached_property
    def _drawn_axes(self) -> Complex:
        """Directions of the sliders as drawn, (S,) complex unit vectors."""
        return np.array([number(s.axis) for s in self.linkage.sliders], dtype=complex)

    def place(self, pose: Pose, points: Points) -> Complex:
        """Positions of points, (T, N) complex, m."""
        return self.places(pose).of(points)

    def places(self, pose: Pose) -> PointMotion:
        """The positions, m, as a linear function of any points."""
        return PointMotion(pose.turn, pose.axis * pose.extension)

    def partials(self, pose: Pose, points: Points) -> Complex:
        """Derivatives of the positions of points by the coordinates, (T, n, N) complex."""
        angles = self.frames - 1
        out = np.empty((len(pose.turn), self.columns, points.turning.shape[1]), dtype=complex)
        out[:, :angles] = pose.turn[:, 1:, None] * (1j * points.turning[1:])
        out[:, angles:] = pose.axis[:, :, None] * points.sliding
        # A frame also rotates the axes of the sliders on it.
        for s, f in enumerate(self.slider_frame):
            if f:
                out[:, f - 1] += (1j * pose.extension[:, s, None]) * out[:, angles + s]
        return out

    def velocities(self, pose: Pose, rates: Floats, points: Points) -> Complex:
        """Velocities of points, (T, N) complex, at rates (T, n): `partials` times the rates."""
        return self.speeds(pose, rates).of(points)

    def speeds(self, pose: Pose, rates: Floats) -> PointMotion:
        """The velocities at rates (T, n), as a linear function of any points."""
        angles = self.frames - 1
        omega = np.zeros((len(rates), self.frames))
        omega[:, 1:] = rates[:, :angles]
        slide = rates[:, angles:] + 1j * omega[:, self.slider_frame] * pose.extension
        return PointMotion(1j * omega * pose.turn, pose.axis * slide)

    def along_coordinates(self, pose: Pose, forces: Complex, points: Points) -> Floats:
        """Generalised forces (T, n) that do the same work as forces (T, N) N on points."""
        on_frames = np.conj(1j * pose.turn) * (forces @ np.conj(points.turning).T)
        on_sliders = np.conj(pose.axis) * (forces @ points.sliding.T)
        out = np.concatenate([on_frames.real[:, 1:], on_sliders.real], axis=1)
        # Forces across a slider's axis turn the frame that carries it.
        for s, f in enumerate(self.slider_frame):
            if f:
                out[:, f - 1] += pose.extension[:, s] * on_sliders.imag[:, s]
        return out

    def bends(self, pose: Pose, rates: Floats, points: Points) -> Complex:
        """Centripetal and Coriolis accelerations of points at rates (T, n), (T, N) complex.

        They are the part of the accelerations that is quadratic in the rates.
        """
        return self.curvatures(pose, rates).of(points)

    def curvatures(self, pose: Pose, rates: Floats) -> PointMotion:
        """The `bends` at rates (T, n), as a linear function of any points."""
        angles = self.frames - 1
        omega = np.zeros((len(rates), self.frames))
        omega[:, 1:] = rates[:, :angles]
        spin = omega[:, self.slider_frame]
        slide = pose.axis * (2j * spin * rates[:, angles:] - spin**2 * pose.extension)
        return PointMotion(-(omega**2 * pose.turn), slide)

    # --- the equations ----------------------------------------------------------------------------

    def residual(self, q: Floats, pose: Pose, drives: Floats) -> Floats:
        """Violation of every equation, (T, rows) m, at coordinates q (T, n) and their pose.

        drives: (T, D) values of the drives, m or rad.
        """
        gap = self.place(pose, self.closures)
        lag = (q * self.scale) @ self._fixed_rows.T
        lag[:, len(self.linkage.teeth) :] -= self.drive_scale * (drives - self.drawn_drives)
        return np.concatenate([gap.real, gap.imag, lag], axis=1)

    def jacobian(self, pose: Pose) -> Floats:
        """Derivatives of the residual by the scaled coordinates, (T, rows, n), dimensionless."""
        angles, count = self.frames - 1, len(self.closing)
        # Instants come last: the few nonzeros of the pattern are then contiguous.
        J = np.zeros((self.rows, self.columns, len(pose.turn)))

        def add(rows: Ints, columns: Ints | int, slopes: Complex) -> None:
            J[rows, columns] += slopes.real
            J[count + rows, columns] += slopes.imag

        f, k, slopes = self._turning_slopes
        add(k, f, slopes * pose.turn.T[1 + f])
        sliding = self.closures.sliding
        for s, frame in enumerate(self.slider_frame):
            k = np.flatnonzero(sliding[s])
            along = sliding[s, k, None] * pose.axis[:, s]
            add(k, angles + s, along)
            if frame:
                add(k, frame - 1, 1j / self.scale[frame - 1] * pose.extension[:, s] * along)
        J[2 * count :] = self._fixed_rows[:, :, None]
        return np.moveaxis(J, -1, 0)

    @cached_property
    def _turning_slopes(self) -> tuple[Ints, Ints, Complex]:
        """The N nonzero terms of the closures that rotate with frames.

        Returns the frame of each term (without the ground's, counted from 0), its closure, (N,)
        each, and the derivative of the closure by the scaled angle over the frame's direction,
        (N, 1).
        """
        turning = self.closures.turning[1:]
        f, k = np.nonzero(turning)
        return f, k, (1j / self.scale[f] * turning[f, k])[:, None]

    def factors(self, pose: Pose) -> Factors:
        """Orthogonal factors of the Jacobian at T instants."""
        return Factors(self._elimination, self.jacobian(pose))

    @cached_property
    def _elimination(self) -> tuple[Step, ...]:
        """The steps of elimination for the Jacobian's pattern of nonzeros."""
        turns, slides = self.closures.turning[1:] != 0.0, self.closures.sliding != 0.0
        for s, f in enumerate(self.slider_frame):
            if f:
                turns[f - 1] |= slides[s]
        closing = np.concatenate([turns, slides]).T
        pattern = np.concatenate([closing, closing, self._fixed_rows != 0.0])
        return elimination(pattern)

    def bend_side(self, pose: Pose, rates: Floats) -> Floats:
        """Right-hand side (T, rows) of the accelerations that are quadratic in rates (T, n).

        It is zero in the rows of teeth and drives, which are linear in the coordinates.
        """
        bend = self.bends(pose, rates, self.closures)
        zero = np.zeros((len(rates), len(self._fixed_rows)))
        return -np.concatenate([bend.real, bend.imag, zero], axis=1)

    # --- assembly ---------------------------------------------------------------------------------

    def _chains(self) -> tuple[Complex, Floats]:
        """The point of each item that coincides with the origin as drawn.

        Returns `turning`, (F, items + ground), and `sliding`, (S, items + ground), of Points.
        """
        linkage = self.linkage
        count = len(linkage.index)
        turning = np.zeros((self.frames, count), dtype=complex)
        sliding = np.zeros((len(linkage.sliders), count))
        # Each edge displaces all items beyond it, seen from the ground.
        for edge in self.tree:
            ends = ends_of(linkage, edge.slides, edge.which)
            outer, inner = ends if edge.forward else ends[::-1]
            away = list(edge.away)
            if edge.slides:
                sliding[edge.which, away] += 1.0 if edge.forward else -1.0
                continue
            at = number(linkage.connections[edge.which][0].at)
            turning[self.frame[inner], away] += at
            turning[self.frame[outer], away] -= at
        return turning, sliding

    @cached_property
    def closing_ends(self) -> tuple[Ints, Ints, Complex]:
        """Items at the two ends of every closure, then of all teeth, and their positions as drawn.

        The force acts on the first item (the body), and its reaction on the second item (the
        carrier, or the second body of the teeth). Positions are complex, m.
        """
        linkage, index = self.linkage, self.linkage.index
        ends = [ends_of(linkage, *c) for c in self.closing]
        ends += [(index[t.bodies[0]], index[t.bodies[1]]) for t in linkage.teeth]
        sliders, connections = linkage.sliders, linkage.connections
        at = [number(sliders[k].end if s else connections[k][0].at) for s, k in self.closing]
        at += [number(t.at) for t in linkage.teeth]
        acts, reacts = np.array(ends, dtype=np.int64).reshape(-1, 2).T
        return acts, reacts, np.array(at, dtype=complex)

    @cached_property
    def closing_points(self) -> Points:
        """Points at which forces of closures and teeth act; pitch points are fixed in carriers."""
        acts, _, at = self.closing_ends
        carriers = [self.linkage.index[t.carrier] for t in self.linkage.teeth]
        return self.points(np.array([*acts[: len(self.closing)], *carriers], dtype=np.int64), at)

    def closing_forces(self, pose: Pose, f: Floats, spread: Floats | None = None) -> Complex:
        """Forces at the members that close loops and at teeth, (T, closing and teeth) N, complex.

        f: (T, rows) multipliers, N.
        spread: (T, teeth) N, radial forces that push the gears apart; None for no such forces.
        """
        k = len(self.closing)
        closing = (f[:, :k] + 1j * f[:, k : 2 * k]) @ self._combined.T
        if not self.linkage.teeth:
            return np.asarray(closing)
        frames = [self.frame[self.linkage.index[t.carrier]] for t in self.linkage.teeth]
        normal = pose.turn[:, frames] * np.array([number(t.normal) for t in self.linkage.teeth])
        tooth = normal * (1j * f[:, 2 * k : self.guides] - (0.0 if spread is None else spread))
        return np.concatenate([closing - tooth @ self._gap_weights, tooth], axis=1)

    @cached_property
    def _gap_weights(self) -> Floats:
        """Motion of the teeth per gap at the members that close loops, (teeth, closing)."""
        return gap_weights(self.linkage, self.closing)

    @cached_property
    def closures(self) -> Points:
        """The loop equations: sums and differences of the gaps, chosen to have few nonzeros."""
        turning, sliding = self.gaps.turning @ self._combined, self.gaps.sliding @ self._combined
        turning[np.abs(turning) < LENGTH_ROUND_OFF * self.linkage.length_scale] = 0.0
        return Points(turning, sliding)

    def _gaps(self) -> Points:
        """The gap of each member that closes a loop, which vanishes where the loop is closed."""
        body, carrier, at = self.closing_ends
        members = slice(len(self.closing))  # without the teeth
        gap = self.points(body[members], at[members]) - self.points(carrier[members], at[members])
        for k, (slides, which) in enumerate(self.closing):
            if slides:
                gap.sliding[which, k] -= 1.0
        return gap

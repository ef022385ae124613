"""The balance of forces of a driven linkage, linear in the forces that its bodies require."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from loads.forces.acting import Load, balance
from loads.forces.holding import holding
from loads.forces.sharing import shares
from loads.linkage.parts import Slider, Turn
from loads.motion.complex_points import number
from loads.motion.joint_forces import connection_members, slider_couple, slider_members
from loads.motion.motion import Motion
from pinbase.arrays import Complex, Floats


class ForceBalance:
    """The balance of forces of one motion, linear in the forces that the bodies require.

    hold: names of the sliders and turns that hold the linkage. rubs: whether friction acts.
    """

    def __init__(
        self, motion: Motion, applied: tuple[Load, ...], hold: Sequence[str], rubs: bool
    ) -> None:
        self.motion, self.applied, self.loops = motion, applied, motion.loops
        self.rubs = rubs
        self.held = holding(motion, hold)
        self.connections = connection_members(self.loops)
        self.slides = slider_members(self.loops)
        self.shared = motion.mobility.shared
        self.needed, self.couples = self._needs()
        self.no_forces, self.no_couples = np.zeros_like(self.needed), np.zeros_like(self.couples)
        self.no_spread = np.zeros((len(motion), len(motion.linkage.teeth)))

    def _needs(self) -> tuple[Complex, Floats]:
        """Forces and couples that joints and drives must exert on the items, (T, items) each.

        The force is m a - weight - applied forces, N, complex; the couple about the centre of mass
        is I a - applied couples, N m.
        """
        motion = self.motion
        _, _, acceleration = motion.centres
        needed = motion.masses * (acceleration - number(motion.linkage.gravity))
        couples = motion.inertias * motion.spin_rate
        for i, force, couple in balance(motion, self.applied):
            needed[:, i] -= force
            couples[:, i] -= couple
        return needed, couples

    def generalised(self, needed: Complex, couples: Floats) -> Floats:
        """The required forces and couples as generalised forces, (T, n) N (N m for angles)."""
        loops = self.loops
        out = loops.along_coordinates(self.motion.pose, needed, loops.centres)
        for i in range(len(loops.linkage.items)):
            if f := loops.frame[i]:
                out[:, f - 1] += couples[:, i]
        return out

    def closing(self, f: Floats, spread: Floats | None = None) -> Complex:
        """Forces (T, closing and teeth) N at the members that close loops, and at teeth.

        f: (T, rows) multipliers. spread: (T, teeth) N, radial forces of teeth.
        """
        return self.loops.closing_forces(self.motion.pose, f, spread)

    def drives(self, f: Floats) -> Floats:
        """Forces (N) and torques (N m) of the actuators, (T, A)."""
        return self.held.forces(f[:, f.shape[1] - self.held.weights.shape[2] :])

    def multipliers(
        self, generalised: Floats, needed: Complex, spread: Floats | None = None
    ) -> Floats:
        """Multipliers (T, rows) that balance generalised forces, by the sharing rules.

        generalised: (T, n) N (N m for angles).
        needed: (T, items) N, required forces from which the generalised forces follow.
        spread: (T, teeth) N, radial forces of teeth.
        """
        factors = self.held.factors
        f = factors.solve_transposed(generalised / self.loops.scale)
        if not self.shared:
            return f
        # Null vectors of J^T are self-equilibrated sets of forces. The sharing rules determine the
        # amounts in which they are added.
        null = factors.null
        no_forces = np.zeros((1, needed.shape[1]), dtype=complex)
        closing = [self.closing(null[:, :, i]) for i in range(null.shape[2])]
        loose = np.stack([self.everywhere(no_forces, c) for c in closing], axis=2)
        forces = self.everywhere(needed, self.closing(f, spread))
        amounts = shares(self.loops.linkage, forces, loose, self.motion.mobility)
        return f + (null @ amounts[..., None])[..., 0]

    def everywhere(self, needed: Complex, closing: Complex) -> Complex:
        """Forces on the bodies at all connections and teeth, (T, connections and teeth) N."""
        teeth = closing[:, len(self.loops.closing) :]
        return np.concatenate([self.connections.forces(needed, closing), teeth], axis=1)

    def slider_forces(
        self, closing: Complex, f: Floats, needed: Complex, couples: Floats
    ) -> tuple[Floats, Floats]:
        """Normal force (N) and couple (N m) at every slider, (T, S) each."""
        loops, pose = self.loops, self.motion.pose
        sliders = loops.linkage.sliders
        if not sliders:
            return np.zeros((len(f), 0)), np.zeros((len(f), 0))
        force = self.slides.forces(needed, closing)
        normal = np.real(np.conj(1j * pose.axis) * force)
        centres, _, _ = self.motion.centres
        closing_at = loops.place(pose, loops.closing_points)
        forces = zip(self.held.actuators, self.drives(f).T, strict=True)
        torques = [(a, force) for a, force in forces if isinstance(a, Turn)]
        couple = np.stack(
            [
                slider_couple(
                    loops, k, self._end(s), centres, needed, couples, closing_at, closing, torques
                )
                for k, s in enumerate(sliders)
            ],
            axis=1,
        )
        return normal, couple

    def _end(self, slider: Slider) -> Complex:
        """Position of a slider's end, (T,) m."""
        index = self.loops.linkage.index
        item, at = np.array([index[slider.moving]]), np.array([number(slider.end)])
        return self.loops.place(self.motion.pose, self.loops.points(item, at))[:, 0]

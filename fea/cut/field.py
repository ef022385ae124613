"""A cut pin on one mesh: the uncut pin, local solids about its cuts, and the stress of both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fea.core.mesh_result import MeshMaximum
from fea.core.pin_loads import Loads, PinLoads
from fea.core.solution import Picture, StressPoints
from fea.core.unit_surface import SpaceSurface, UnitSurface
from fea.core.zone import Zone
from fea.cut.body import body
from fea.cut.local_fields import MAX_REFINED_RISE, LocalFields, point_of
from fea.cut.shown import ShownCut, shown
from fea.cut.shown_free import free_picture, stress_points
from fea.cut.supports import ClampMotions, ClampReaction
from fea.harmonic.beneath import Beneath, Steps, beneath, depths, stairs
from fea.harmonic.field import HarmonicField
from fea.harmonic.fields import MeridianFields
from fea.harmonic.section_solution import HarmonicSolution
from fea.solid.superposition import squares
from pinbase.arrays import Floats, Mask


@dataclass(frozen=True)
class CutSolution:
    """The solution of a cut pin: the uncut pin, and the local solids about the cuts.

    section: the uncut pin, which is not read where it is cut.
    uncut: its fields without that restriction.
    reactions: the motions of redundant clamps that loads cause.
    first_clamp: the first clamp, if any.
    """

    section: HarmonicSolution
    pieces: tuple[LocalFields, ...]
    uncut: MeridianFields
    reactions: ClampMotions
    first_clamp: ClampReaction | None = None

    @property
    def corners(self) -> tuple[Zone, ...]:
        """The sharp inner corners of the cuts, as zones."""
        return tuple(c.singularity for piece in self.pieces for c in piece.corners)

    def idle(self, results: Sequence[tuple[PinLoads, MeshMaximum]]) -> tuple[LocalFields, ...]:
        """The pieces that need no finer mesh.

        These are pieces whose stress can in no case reach the maximum, nor, in a motion, vary as
        much as in another piece.
        """
        out = set(range(len(self.pieces)))
        for loads, result in results:
            all_loads = self.reactions.with_motions(loads)
            swings = [
                piece.swing(all_loads) * (1.0 + MAX_REFINED_RISE / piece.finer**2)
                for piece in self.pieces
            ]
            for k, piece in enumerate(self.pieces):
                most = piece.may_reach(all_loads, result.maximum)
                if most or (len(loads) > 1 and swings[k] >= max(swings) / (1.0 + MAX_REFINED_RISE)):
                    out.discard(k)
        return tuple(self.pieces[k] for k in sorted(out))

    @cached_property
    def shown(self) -> ShownCut:
        """The surface of the pieces and of the uncut pin between them; the first clamp does not
        move.
        """
        return shown(self.section.fields, self.pieces, self.first_clamp)

    @cached_property
    def unit_surface(self) -> UnitSurface:
        """The unit fields of the whole surface, for views."""
        cut = self.shown
        return UnitSurface.in_space(cut.points, cut.triangles, cut.stress, cut.displacement)


class CutField:
    """The stress of a cut pin under any combination of its unit loads (fea.core.solution)."""

    def __init__(self, solution: CutSolution, singularities: tuple[Zone, ...]) -> None:
        self.solution, self.singularities = solution, singularities
        self.section = HarmonicField(solution.section, singularities)

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest von Mises stress (T,), Pa, at every instant outside the singularities.

        least: Pa; where the stress does not exceed it, any value up to it may be returned.
        """
        loads = self.solution.reactions.with_motions(loads)
        local = np.max([piece.largest(loads)[0] for piece in self.solution.pieces], axis=0)
        uncut = self.section.maxima(loads, max(least, float(local.min())))
        return np.asarray(np.maximum(local, uncut))

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest von Mises stress over all instants, Pa, and the number of its instant."""
        loads = self.solution.reactions.with_motions(loads)
        value, instant = self.section.largest(loads)
        for piece in self.solution.pieces:
            here, _ = piece.largest(loads)
            if here.max() > value:
                value, instant = float(here.max()), int(here.argmax())
        return value, instant

    def beneath(self, loads: PinLoads) -> Beneath:
        """The largest von Mises stress beneath contact (fea.harmonic.beneath).

        It is searched in the pin without cuts, also where it is cut, and on the surface about the
        cuts.
        """
        assert loads.pressed is not None
        deepest = beneath(self.solution.uncut, loads, self.singularities)
        for piece in self.solution.pieces:
            value, point = piece.beneath(loads, loads.pressed)
            t = int(value.argmax())
            if value[t] > deepest.value:
                deepest = Beneath(float(value[t]), point_of(piece.points[point[t]]), t)
        return deepest

    def depths(self, loads: PinLoads, instant: int, least: float) -> Steps:
        """The distances from pressed cells that stresses reach at an instant
        (fea.harmonic.beneath).
        """
        pressed = loads.pressed
        assert pressed is not None
        steps = [*depths(self.solution.uncut, loads, instant, self.singularities, least)]
        for piece in self.solution.pieces:
            steps += piece.depths(loads, pressed, instant, least)
        return stairs(*np.array(steps).reshape(-1, 2).T)

    def picture(self, loads: PinLoads, instant: int) -> Picture:
        """The surface at one instant, with its envelope over all instants."""
        surface, c = self.solution.shown, self.coefficients(loads)
        if loads.pressed is not None:
            stress, envelope, pressed = free_picture(surface, c, loads.pressed, instant)
            moved = surface.displacement @ c[instant]
            return Picture(
                surface.points, surface.triangles, "triangle", moved, stress, envelope, pressed
            )
        largest = np.zeros(len(surface.points))
        envelope_squared = squares(surface.stress)
        for k in range(0, len(c), 64):
            np.maximum(largest, envelope_squared(c[k : k + 64]).max(axis=1), out=largest)
        return Picture(
            points=surface.points,
            cells=surface.triangles,
            cell_type="triangle",
            displacement=surface.displacement @ c[instant],
            stress=surface.stress @ c[instant],
            envelope=np.sqrt(largest),
        )

    def coefficients(self, loads: Loads) -> Floats:
        """The amount of each unit load of the surface at each instant, (T, L)."""
        return self.solution.pieces[0].coefficients(self.solution.reactions.with_motions(loads))

    @property
    def read(self) -> Mask:
        """A mask (P,) of the points of the surface that are searched for the maximum, outside of
        zones.
        """
        section = self.section.fields.outside(self.singularities)
        return self.solution.shown.read_in(section)

    def points(self, loads: PinLoads) -> StressPoints:
        """The stress at points of the surface, for fatigue."""
        surface, amounts = self.solution.shown, self.coefficients(loads)
        if len(amounts) < amounts.shape[1]:  # the stress at the instants takes less memory
            surface = replace(surface, stress=surface.stress @ amounts.T)
            amounts = np.eye(len(amounts))
        return stress_points(surface, self.read, amounts, loads.pressed, self.solution.section.nu)

    def surface(self) -> SpaceSurface:
        """The whole surface for views."""
        unit = self.solution.unit_surface
        return SpaceSurface(unit, ~self.read, self.coefficients, self.singularities)

    def volume(self, loads: PinLoads, instant: int) -> Picture:
        """The whole body at one instant."""
        solution, all_loads = self.solution, self.solution.reactions.with_motions(loads)
        assert isinstance(all_loads, PinLoads)
        return body(solution.uncut, solution.pieces, solution.first_clamp, all_loads, instant)

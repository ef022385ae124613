"""Stress at any points of a pin and at all instants of a case, the same for every model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from assess.fatigue.pressed_points import CutStandIns, StandIns, replaced
from fea.beam.model import BeamField
from fea.core.pin_loads import PinLoads
from fea.core.solution import StressField
from fea.harmonic.evaluate import HarmonicField
from fea.harmonic.free_surface import surface_points
from fea.harmonic.stress_at import Stress, stress_at
from pinbase.arrays import Floats, Ints, Mask

if TYPE_CHECKING:
    from fea.cut.evaluate import CutField


@dataclass(frozen=True)
class StressPoints:
    """Points (S, 3), m, where a model knows the stress, of a body of revolution at theta = 0.

    surface: (S,) those at which fatigue is looked for: on the surface, outside of singularities.
    count: of instants.
    at: gives the stress (J, T, 6), Pa, at points (J,) turned by angles (J,), rad, at instants (T,)
    by their numbers. Angles have no effect on bodies that are not of revolution.
    """

    points: Floats
    surface: Mask
    revolved: bool
    count: int
    at: Stress


def stress_points(answer: StressField | None, loads: PinLoads) -> StressPoints | None:
    """The stress points of a solution in its case; None where nothing was solved."""
    if isinstance(answer, HarmonicField):
        return _harmonic(answer, loads)
    if answer is None:
        return None
    # Imported for pins that are not solved by the harmonic model alone.
    from fea.cut.evaluate import CutField
    from fea.solid.evaluate import SolidField
    from fea.support.foundation.held import FoundationField

    if isinstance(answer, BeamField | FoundationField):
        return _beam(answer.points, answer.harmonics(loads), len(loads))
    if isinstance(answer, CutField):
        return _cut(answer, loads)
    if isinstance(answer, SolidField):
        fields, surface = answer.solution.fields, answer.solution.outside.copy()
        surface[len(fields.surface.nodes) :] = False
        return _solid(fields.points, fields.read, surface, fields.coefficients(loads))
    return None


def _harmonic(answer: HarmonicField, loads: PinLoads) -> StressPoints:
    """The stress points of the surface; where lugs press on it, by the rules of pressed_points."""
    if loads.pressed is None:
        fields = answer.fields
        surface = fields.outside(answer.singularities)
        surface[fields.skin :] = False
        at = stress_at(fields, loads)
        return StressPoints(_at_zero(fields.points), surface, True, len(loads), at)
    of = surface_points(answer.fields, loads.pressed.rings, answer.solution.nu)
    stands, plain = StandIns(of, loads.pressed), np.flatnonzero(of.relieved < 0)
    at = replaced(stress_at(of.fields, loads), stands.rows)
    surface = of.fields.outside(answer.singularities)[plain]
    return StressPoints(
        _at_zero(of.fields.points[plain]), surface, True, len(loads),
        lambda rows, angles, instants: at(plain[rows], angles, instants),
    )  # fmt: skip


def _cut(answer: CutField, loads: PinLoads) -> StressPoints:
    """The stress points of a pin with cuts."""
    cut, amounts = answer.surface, answer.coefficients(loads)
    if loads.pressed is None:
        return _solid(cut.points, cut.stress, cut.read, amounts)
    stands = CutStandIns(answer, loads.pressed)
    every = _solid(stands.points, stands.stress, cut.read, amounts)

    def substitutes(rows: Ints, _: Floats, instants: Ints) -> Ints:
        return np.stack([stands.rows(rows, t) for t in instants.tolist()], axis=1)

    at = replaced(every.at, substitutes)
    return StressPoints(cut.points, cut.read, False, len(amounts), at)


def _beam(points: Floats, stress: Floats, count: int) -> StressPoints:
    """The stress points of a beam.

    stress: (3, S, 6, T) Pa, constant, times cos theta, times sin theta.
    """

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        constant, cosine, sine = stress[:, rows][..., instants]
        c, s = (x[:, None, None] for x in (np.cos(angles), np.sin(angles)))
        return np.asarray((constant + c * cosine + s * sine).swapaxes(1, 2))

    return StressPoints(_at_zero(points), points[:, 0] > 0.0, True, count, at)


def _solid(points: Floats, stress: Floats, surface: Mask, amounts: Floats) -> StressPoints:
    """The stress points of unit stresses (S, 6, L) in amounts (T, L)."""

    def at(rows: Ints, _: Floats, instants: Ints) -> Floats:
        return np.asarray((stress[rows] @ amounts[instants].T).swapaxes(1, 2))

    return StressPoints(points, surface, False, len(amounts), at)


def _at_zero(points: Floats) -> Floats:
    r, z = points.T
    return np.stack([r, np.zeros_like(r), z], axis=1)

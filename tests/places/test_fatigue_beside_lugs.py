"""Fatigue sees fillets, and the free side, beside the edges of lugs that press by turns."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from assess.fatigue.critical_points import stress_histories
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.solution import StressPoints
from fea.core.voigt import von_mises
from fea.harmonic.field import HarmonicField
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_in_lugs
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem, Solution
from geometry import CutPin, Hole, Pin, Segment
from pinbase.arrays import Floats

D, F, RHO = 0.02, 30e3, 0.001
STEEL = Material("steel", 2.1e11, 0.3, yield_strength=9e8)
PULL = F * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
REVERSED = PinLoads("cycle", tuple("ABC"), np.concatenate([PULL, -PULL]), times=np.arange(2.0))


def pin(wide: float) -> Pin:
    """A clevis pin whose middle is thicker; its fillets end 0.005 d from the outer lugs."""
    gap = 0.05 * D + 0.005 * D
    return Pin(
        "P",
        (
            *(Segment(0.004, D), Segment(0.01, D, connection="A"), Segment(gap, D, fillet=RHO)),
            *(Segment(0.001, wide * D), Segment(0.02, wide * D, connection="B")),
            *(Segment(0.001, wide * D, fillet=RHO), Segment(gap, D)),
            *(Segment(0.01, D, connection="C"), Segment(0.004, D)),
        ),
    )


@cache
def solved(wide: float, hole: float = 0.0) -> Solution:
    """Under a force that reverses."""
    lugs = tuple(Lug(n, 0.06, STEEL, 2e-5, 0.0, 0.0 if n == "B" else np.inf) for n in "ABC")
    cut = CutPin(pin(wide), (Hole(0.5 * pin(wide).length, hole, np.pi / 2.0),)) if hole else None
    given = PinProblem(cut or pin(wide), STEEL, lugs, (REVERSED,))
    return solve_in_lugs(given, Requirement(0.05, cells="rough", meshes=1))[0]


def test_the_critical_point_is_in_the_fillet_with_the_range_of_the_surface() -> None:
    """By symmetry the second instant does at the angle 0 what the first does on the other side,
    so that the range follows from the stress of the first alone, at both angles.
    """
    found = solved(1.15)
    places = found.peak.places
    assert places is not None
    (*_, z) = places.surface.location
    ends = pin(1.15).stations
    assert min(abs(z - end) for end in (ends[3], ends[6])) < RHO
    points = stress_histories("P", (found,))
    first = points[0]
    assert "range" in first.chosen
    assert min(abs(first.location[2] - end) for end in (ends[3], ends[6])) < RHO
    stress = first.cases[0].stress
    swing = float(von_mises(stress[0] - stress[1]))
    assert isinstance(found.answer, HarmonicField)
    fields = found.answer.fields
    around = Circumference(fields, found.loads.at(np.array([0])))
    r, z = fields.points[: fields.skin].T
    fillet = np.flatnonzero((z > ends[3] - 0.9 * RHO) & (z < ends[3]) & (r > 0.5 * D))
    one, other = around.stress(fillet, 0, np.array([0.0, np.pi])).swapaxes(0, 1)
    assert swing == pytest.approx(float(von_mises(one - other).max()), rel=0.03)
    assert swing > 1.6 * places.surface.max_von_mises
    assert len({round(abs(p.location[2] - 0.5 * pin(1.15).length), 4) for p in points}) > 1


def test_an_idle_case_has_no_critical_point() -> None:
    """Nothing is largest in it: the middle of the pin's end was a critical point."""
    idle = PinLoads("idle", tuple("ABC"), np.zeros((1, 3, 3)))
    lugs = tuple(Lug(n, 0.06, STEEL, 2e-5) for n in "ABC")
    given = PinProblem(pin(1.0), STEEL, lugs, (idle, PinLoads("pull", idle.surfaces, PULL)))
    points = stress_histories("P", solve_in_lugs(given, Requirement(0.1, cells="rough", meshes=1)))
    assert points
    assert not any("idle" in point.chosen for point in points)


def test_a_point_beside_an_edge_has_both_halves_of_its_range() -> None:
    """On the plain pin, just beside and just under the edges of the middle lug, where that and
    the outer ones press by turns: the range of bending, from the moment of contact there. With the
    last free value kept while a lug presses it would be half.
    """
    found = solved(1.0)
    assert found.answer is not None
    known = found.answer.points(found.loads)
    assert found.joint is not None
    edge = pin(1.0).band("B").z0
    rows = np.flatnonzero(known.surface & (np.abs(known.points[:, 2] - edge) < 0.04 * D))
    z, moment = np.array(found.joint.bending_moments).T
    bending = 32.0 * np.interp(known.points[rows, 2], z, moment) / (np.pi * D**3)
    used = _swing(known, known.points[rows]) / 2.0 / bending
    assert 0.7 < used.min() < used.max() < 1.25


def _swing(known: StressPoints, points: Floats) -> Floats:
    """Von Mises stress of what both instants differ by, at points at the angle 0."""
    rows = np.array([int(np.linalg.norm(known.points - p, axis=1).argmin()) for p in points])
    stress = known.at(rows, np.zeros(len(rows)), np.array([0, 1]))
    return von_mises(stress[:, 0] - stress[:, 1])


@pytest.mark.long
@pytest.mark.slow
def test_of_a_pin_with_cuts_too() -> None:
    """A hole amid the thick part changes little in the fillets: in the local solid about it they
    have the range that they have in the pin without it.
    """
    swing = []
    for found in (solved(1.15), solved(1.15, 0.05 * D)):
        assert found.answer is not None
        known = found.answer.points(found.loads)
        r, z = np.hypot(*known.points.T[:2]), known.points[:, 2]
        fillet = known.surface & (z < pin(1.15).stations[3]) & (r < 0.52 * D) & (r > 0.5 * D)
        swing.append(float(_swing(known, known.points[fillet]).max()))
    assert swing[1] == pytest.approx(swing[0], rel=0.05)

"""Cuts away from each other: a local solid for each, as fine as its stress may matter."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.cut import region
from fea.cut.field import CutField
from fea.cut.local_fields import LocalFields
from fea.solve.single_mesh import ModelMesh, Problem, result_on
from fea.solve.solve import solve_pin
from fea.support.support import Solution
from geometry import CutPin, Hole, Pin, Segment

STEEL = Material("steel", 210e9, 0.3, 500e6, 0.0)
D = 0.02


def shaft(*cuts: Hole, second: float = D) -> CutPin:
    """Three thick bands, a shaft of D between the first two, one of `second` after."""
    ends = [Segment(0.03, 0.04, connection=name) for name in "ABC"]
    parts = (ends[0], Segment(0.12, D), ends[1], Segment(0.12, second), ends[2])
    return CutPin(Pin("shaft", parts, 0.003), cuts)


def pulled(first: list[float], second: list[float]) -> PinLoads:
    """Tension of the first and the second shaft at instants, N."""
    a, b = np.array(first), np.array(second)
    forces = np.zeros((len(a), 3, 3))
    forces[:, :, 2] = np.stack([-a, a - b, b], axis=1)
    return PinLoads("case", ("A", "B", "C"), forces)


def parts(found: Solution) -> tuple[LocalFields, ...]:
    assert isinstance(found.answer, CutField)
    return found.answer.solution.pieces


def test_two_pieces_answer_as_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Holes 0.6 diameters apart, each with its own symmetry; the error knows the rest."""
    pin = shaft(Hole(0.08, 0.004), Hole(0.096, 0.003, 0.5 * np.pi))
    problem, rung = Problem(pin, STEEL, (), pulled([3e4], [0.0])), ModelMesh("harmonic+local")
    assert len(region.pieces(pin, ())) == 2
    two = result_on(problem, rung)
    monkeypatch.setattr(region, "MERGE_DISTANCE", 1.0)
    assert len(region.pieces(pin, ())) == 1
    one = result_on(problem, rung)
    assert two.at_once < 0.5 * one.at_once
    scatter = 0.02 * one.maximum  # of first meshes
    assert abs(two.maximum - one.maximum) < two.truncated + scatter
    assert one.truncated < two.truncated < 0.1 * two.maximum


def test_a_piece_that_cannot_govern_stays_coarse() -> None:
    """The same holes in shafts of one and one and a half diameters: 2.25 times the stress."""
    loads = pulled([3e4], [3e4])
    both = shaft(Hole(0.09, 0.004), Hole(0.24, 0.004), second=1.5 * D)
    found = solve_pin(both, STEEL, (), (loads,), Requirement(0.02))[0]
    fine, coarse = parts(found)
    assert fine.finer > 2.0
    assert coarse.finer == 1.0
    one = solve_pin(
        shaft(Hole(0.09, 0.004), second=1.5 * D), STEEL, (), (loads,), Requirement(0.02)
    )[0]
    assert found.peak.verdict == "converged"
    assert found.peak.max_von_mises == pytest.approx(one.peak.max_von_mises, rel=1e-3)


def test_a_piece_that_a_clamp_reaches_has_no_mirror_across_the_axis() -> None:
    """The start is so near that it belongs to the piece, of which the image would reach a clamp."""
    d = 0.2 * D
    hole = Hole(1.6 * D + d / 2.0, d)
    free = hole.z + 1.5 * D + d / 2.0  # 0.1 D longer than the piece

    def mirrors(length: float) -> tuple[str, ...]:
        pin = Pin("p", (Segment(length, D), Segment(D, D, name="clamp")))
        (piece,) = region.pieces(CutPin(pin, (hole,)), ("clamp",))
        return piece.mirrors

    assert mirrors(free) == ("x", "y")
    assert mirrors(free + 0.2 * D) == ("x", "y", "z")
    for length in (0.07, 0.3 + 0.1, 0.1 + 0.7):  # of both ends, whatever their round-off
        pin = CutPin(Pin("p", (Segment(length, 1.0),)), (Hole(0.5 * length, 0.2 * length),))
        for clamp in ("start", "end"):
            (piece,) = region.pieces(pin, (clamp,))
            assert piece.mirrors == ("x", "y")


@pytest.mark.slow
def test_a_piece_whose_stress_swings_does_not() -> None:
    """For fatigue: a constant load on one hole, half of it to and fro on the other."""
    pin = shaft(Hole(0.09, 0.004), Hole(0.24, 0.004))
    swinging = solve_pin(pin, STEEL, (), (pulled([3e4, 3e4], [1.5e4, -1.5e4]),), Requirement(0.02))[
        0
    ]
    assert all(part.finer > 2.0 for part in parts(swinging))
    constant = solve_pin(pin, STEEL, (), (pulled([3e4], [1.5e4]),), Requirement(0.02))[0]
    assert [part.finer > 2.0 for part in parts(constant)] == [True, False]


def test_the_surface_shows_no_piece_over_the_mouths_of_another() -> None:
    """Holes a diameter apart, each within the piece of the other, which does not have it."""
    pin = shaft(Hole(0.08, 0.004), Hole(0.1, 0.004))
    found = solve_pin(pin, STEEL, (), (pulled([3e4], [0.0]),), Requirement(0.2, meshes=1))[0]
    assert isinstance(found.answer, CutField)
    assert len(parts(found)) == 2
    shown = found.answer.solution.shown
    middles = shown.points[shown.triangles].mean(axis=1)
    for z in (0.08, 0.1):
        for x in (-0.5 * D, 0.5 * D):
            assert np.linalg.norm(middles - [x, 0.0, z], axis=1).min() > 0.0015
    x, y, z = middles[np.abs(middles[:, 2] - 0.09) < 0.003].T
    assert np.ptp(np.sort(np.arctan2(y, x))) > 6.0  # the surface between them is whole
    assert np.diff(np.sort(z)).max() < 0.002


@pytest.mark.slow
def test_a_run_joins_holes_that_disturb_each_other() -> None:
    pin = shaft(Hole(0.08, 0.004), Hole(0.096, 0.003, 0.5 * np.pi))
    found = solve_pin(pin, STEEL, (), (pulled([3e4], [0.0]),), Requirement(0.02))[0]
    assert len(parts(found)) == 1
    assert found.peak.verdict == "converged"

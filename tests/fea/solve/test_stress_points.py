"""Every field of stress answers for itself, and two of its answers agree: the largest von Mises
stress of the tensors that it gives to fatigue is the maximum of a row.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.pressed import ARC_COUNT
from fea.core.requirement import Model, Requirement
from fea.core.solution import StressField
from fea.core.voigt import von_mises
from fea.solve.solve import solve, solve_in_lugs, solve_pin
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import CutPin, Flat, Pin, Segment

FORCES = np.array([[[30.0, -70.0, 20.0]], [[500.0, 200.0, -900.0]]])  # two instants, one band
MOMENTS = np.array([[[0.0, 0.0, 0.0]], [[1.0, -2.0, 3.0]]])
LOADS = PinLoads("c", ("P1",), FORCES, MOMENTS)
D = 0.02
BANDS = ((None, 2), ("A", 10), (None, 1), ("B", 20), (None, 1), ("C", 10), (None, 2))
CLEVIS = Pin("P", tuple(Segment(1e-3 * x, D, connection=name) for name, x in BANDS))
PULL = PinLoads("c", tuple("ABC"), 1e4 * np.array([[[-0.5, 0, 0], [1.0, 0, 0], [-0.5, 0, 0]]] * 2))


def agree(
    answer: StressField, loads: PinLoads, turns: int, below: float, above: float = 0.0
) -> None:
    """At all points where fatigue looks, and at angles about the axis, at both instants.

    below, above: how much the largest of these may be below or above the maximum, relative.
    """
    known = answer.points(loads)
    assert known.count == len(loads)
    rows = np.repeat(np.flatnonzero(known.surface), turns)
    angles = np.tile(np.linspace(0.0, 2.0 * np.pi, turns, endpoint=False), known.surface.sum())
    stress = known.at(rows, angles, np.arange(len(loads)))
    assert stress.shape == (len(rows), len(loads), 6)
    largest = von_mises(stress).max(axis=0)
    maxima = answer.maxima(loads)
    assert (largest <= maxima * (1.0 + above + 1e-9)).all()
    assert largest[1] >= (1.0 - below) * maxima[1]
    # Of some instants alone, in any order, it is the same.
    assert np.array_equal(known.at(rows[:9], angles[:9], np.array([1, 0])), stress[:9, ::-1])


@pytest.mark.parametrize(("model", "below"), [("beam", 1e-4), ("harmonic", 1e-4), ("solid", 0.1)])
def test_a_shouldered_pin(cantilever_pin: Pin, steel: Material, model: Model, below: float) -> None:
    """Angles are a degree apart, between which stress is up to 1e-4 larger; the maximum of a solid
    is also looked for inside, on the rims of what is excluded, and is the mean over nine directions
    of loads, which scatter by 2 % on this mesh.
    """
    requirement = Requirement(model=model, meshes=1)
    (found,) = solve_pin(cantilever_pin, steel, ("start",), (LOADS,), requirement)
    assert found.answer is not None
    solid = model == "solid"
    agree(found.answer, LOADS, 1 if solid else 360, below, 0.03 if solid else 0.0)
    assert (found.answer.surface() is None) is (model == "beam")
    assert (found.answer.volume(LOADS, 1) is None) is (model != "harmonic")


def test_a_pin_with_a_flat(steel: Material) -> None:
    shaft = Pin("P", (Segment(0.05, D), Segment(0.01, D, connection="P1")))
    pin = CutPin(shaft, (Flat(0.02, 0.03, 0.007, 0.0, 0.002),))
    (found,) = solve_pin(pin, steel, ("start",), (LOADS,), Requirement(meshes=1))
    assert found.peak.model == "harmonic+local"
    assert found.answer is not None
    agree(found.answer, LOADS, 1, 0.01)
    assert found.peak.solids


def test_a_beam_on_foundations(steel: Material) -> None:
    lugs = tuple(Lug(n, 0.06, steel, 2e-5) for n in "ABC")
    given = PinProblem(CLEVIS, steel, lugs, (PULL,))
    (found,) = solve(given, Requirement(0.5, joints="foundation"))
    assert found.peak.model == "foundation"
    assert found.answer is not None
    agree(found.answer, PULL, 360, 1e-4)
    assert found.answer.surface() is None


def test_lugs_that_press_by_turns(steel: Material) -> None:
    """The second load is the first one turned by half a turn, and so is all that is said of it:
    also of points on which lugs press, which have the stress of others, and of those that are not
    read. No stress is larger than the maximum, and none is that of the pressure, which is the
    radial stress of what a lug presses on.
    """
    lugs = tuple(Lug(n, 0.06, steel, 2e-5, tilt=0.0 if n == "B" else np.inf) for n in "ABC")
    loads = replace(PULL, forces=PULL.forces * [[[1.0]], [[-1.0]]], times=np.arange(2.0))
    requirement = Requirement(0.05, cells="rough", meshes=1)
    (found,) = solve_in_lugs(PinProblem(CLEVIS, steel, lugs, (loads,)), requirement)
    assert found.answer is not None
    agree(found.answer, found.loads, ARC_COUNT, 0.05)
    known, angle = found.answer.points(found.loads), np.radians(25.0)
    rows = np.flatnonzero(known.surface)
    one, other = (
        known.at(rows, np.full(len(rows), angle + turn), np.array(instants))
        for turn, instants in ((0.0, [0, 1]), (np.pi, [1, 0]))
    )
    np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-6 * np.abs(one).max())
    assert found.pressure is not None
    on_shaft = np.hypot(*known.points[rows, :2].T) > 0.499 * D
    largest = float(found.pressure.pressure.max())
    assert np.abs(one[on_shaft, :, 0]).max() < 0.05 * largest
    shown = found.answer.surface()
    assert shown is not None
    every = np.arange(len(shown.unit.points))
    unread = shown.unread(found.loads, every, np.array([angle, angle + np.pi]))
    assert unread is not None
    assert np.array_equal(unread[0, :, 0], unread[1, :, 1])
    assert 0.1 < unread.mean() < 0.9

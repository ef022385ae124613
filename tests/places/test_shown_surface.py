"""The picture of a pin in its lugs: each side of a pressed ring by itself (quick; files of whole
runs: test_vtu.py).
"""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.pressed import PressedArcs
from fea.core.requirement import Requirement
from fea.core.solution import Picture
from fea.core.voigt import von_mises
from fea.harmonic.field import HarmonicField
from fea.harmonic.free_surface import FreeSurface
from fea.harmonic.revolve import revolve_solid
from fea.harmonic.shown_surface import _first, sectors_of
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_in_lugs
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem, Solution
from geometry import Pin, Segment
from tests.support.each import each

D, F = 0.02, 30e3
STEEL = Material("steel", 2.1e11, 0.3, yield_strength=9e8)
PIN = Pin(
    "P",
    (
        *(Segment(0.004, D), Segment(0.016, D, connection="A"), Segment(1e-4, D)),
        *(Segment(0.016, D, connection="B"), Segment(0.004, D)),
    ),
)
# Between two instants the force turns by a right angle.
FORCES = F * np.array([[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]])
TURNING = PinLoads("turning", ("A", "B"), FORCES, times=np.array([0.0, 1.0]))


@pytest.fixture(scope="module")
def found() -> Solution:
    """In single shear, in rigidly guided lugs that nearly touch."""
    lugs = tuple(Lug(n, 0.05, STEEL, 2e-5, 0.0, np.inf) for n in "AB")
    requirement = Requirement(0.05, cells="rough", meshes=1)
    return solve_in_lugs(PinProblem(PIN, STEEL, lugs, (TURNING,)), requirement)[0]


@pytest.fixture(scope="module")
def answer(found: Solution) -> HarmonicField:
    assert isinstance(found.answer, HarmonicField)
    return found.answer


def picture(found: Solution, instant: int) -> Picture:
    assert found.answer is not None
    shown = found.answer.picture(found.loads, instant)
    assert shown is not None
    assert shown.pressed is not None
    return shown


def test_the_free_surface_has_no_steps(found: Solution, answer: HarmonicField) -> None:
    """Of both sides of the ends of rings the first one, as it was shown before, has more than 1.2
    times the largest stress of the free surface.
    """
    loads = found.loads
    around = answer.reader(loads)
    assert isinstance(around.region, FreeSurface)
    # under pressure, relieved of it, stress is read but not shown: there a picture is masked
    plain = around.fields.outside(answer.singularities) & (around.region.relieved < 0)
    largest, every = around.maxima(plain), answer.maxima(loads)
    for instant in range(len(loads)):
        shown = picture(found, instant)
        assert shown.pressed is not None
        free = von_mises(shown.stress)[~shown.pressed]
        assert 0.97 * largest[instant] < free.max() < 1.001 * every[instant]
    angles = 2.0 * np.pi * np.arange(72) / 72
    first = _first(answer.fields.points[: answer.fields.skin])
    raw = von_mises(Circumference(answer.fields, loads).stress(np.flatnonzero(first), 0, angles))
    now = picture(found, 0).pressed
    assert now is not None
    assert raw.ravel()[~now].max() > 1.2 * largest[0]


def test_the_envelope_is_of_what_is_free_at_some_instant(found: Solution) -> None:
    first, second = (picture(found, instant) for instant in (0, 1))
    assert first.pressed is not None
    assert second.pressed is not None
    np.testing.assert_allclose(first.points, second.points)
    always = first.pressed & second.pressed
    once = first.pressed & ~second.pressed
    assert once.any()
    assert np.isfinite(first.envelope[~first.pressed]).all()
    assert (first.envelope >= von_mises(first.stress) * (1.0 - 1e-9))[~first.pressed].all()
    # where it is pressed now, but not then, the other instant counts, but for a cell around
    known = once & np.isfinite(first.envelope)
    assert known.sum() > 0.5 * once.sum()
    assert first.envelope[known] == pytest.approx(von_mises(second.stress)[known], rel=1e-6)
    assert np.isnan(first.envelope[always]).all()


def test_the_solid_shows_what_its_surface_does(found: Solution, answer: HarmonicField) -> None:
    skin, body = picture(found, 0), revolve_solid(answer.fields, found.loads, 0, 0.3)
    where = {tuple(p): k for k, p in enumerate(np.round(skin.points, 12).tolist())}
    pairs = [
        (k, where[tuple(p)])
        for k, p in enumerate(np.round(body.points, 12).tolist())
        if tuple(p) in where and np.hypot(*p[:2]) > 1e-6  # on the axis all angles are one place
    ]
    mine, theirs = np.array(pairs).T
    assert len(mine) > 1000
    np.testing.assert_allclose(body.stress[mine], skin.stress[theirs], rtol=1e-9, atol=1.0)
    assert body.pressed is not None
    assert skin.pressed is not None
    assert (body.pressed[mine] == skin.pressed[theirs]).all()
    assert not np.delete(body.pressed, mine).any()  # inside


@each(("cells", "sectors"), [(24, 72), (36, 72), (48, 90), (64, 120)])
def test_every_cell_has_two_points(found: Solution, cells: int, sectors: int) -> None:
    pressed = found.loads.pressed
    assert isinstance(pressed, PressedArcs)
    few = np.zeros((len(pressed.rings), cells), dtype=bool)
    some = PressedArcs.of(pressed.rings, [few], [0.0])
    assert sectors_of(some) == sectors
    assert sectors_of(some) * some.sector >= 2 * 360
    assert sectors_of(None) == 60

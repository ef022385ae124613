"""A section's fields turned about the axis: the body in wedges, beside its surface in quads."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.revolve import revolve_solid
from fea.harmonic.shown_surface import VIEW_SECTORS
from fea.solve.solve import solve_pin
from geometry import Pin, Segment

NU = 0.3  # does not matter without lugs
PIN = Pin("P", (Segment(0.02, 0.02, bore=0.008), Segment(0.01, 0.02, connection="B")))
LOADS = PinLoads("c", ("B",), np.array([[[0.0, 0.0, 0.0]], [[300.0, -400.0, 200.0]]]))


@pytest.fixture(scope="module")
def answer(steel: Material) -> HarmonicField:
    requirement = Requirement(model="harmonic", meshes=1)
    (found,) = solve_pin(PIN, steel, ("start",), (LOADS,), requirement)
    assert isinstance(found.answer, HarmonicField)
    return found.answer


def volumes(wedges: Floats) -> Floats:
    """Of wedges (M, 6, 3), signed: two triangles in VTK's order, in three tetrahedra."""
    a, b, c, d, e, f = wedges.transpose(1, 0, 2)
    parts = ((a, b, c, d), (b, c, d, e), (c, d, e, f))
    sixfold = [np.linalg.det(np.stack([q - p, r - p, s - p], axis=1)) for p, q, r, s in parts]
    return np.asarray(np.sum(sixfold, axis=0) / 6.0)


def test_wedges_fill_the_body(answer: HarmonicField) -> None:
    """60 sectors lose sin x / x of a circle, x = 6 deg: 0.18 %."""
    picture = revolve_solid(answer.fields, LOADS, 1, NU)
    assert picture.cell_type == "wedge"
    size = np.abs(volumes(picture.points[picture.cells]))
    x = 2.0 * np.pi / VIEW_SECTORS
    assert size.sum() == pytest.approx(PIN.volume * np.sin(x) / x, rel=1e-9)
    assert np.isnan(picture.envelope).all()


def test_the_body_shows_what_its_surface_does(answer: HarmonicField) -> None:
    """At points of the surface that are corners of triangles; without load, nothing."""
    skin, body = answer.picture(LOADS, 1), revolve_solid(answer.fields, LOADS, 1, NU)
    where = {tuple(p): k for k, p in enumerate(np.round(skin.points, 12).tolist())}
    pairs = [
        (k, where[tuple(p)])
        for k, p in enumerate(np.round(body.points, 12).tolist())
        if tuple(p) in where
    ]
    mine, theirs = np.array(pairs).T
    assert len(mine) > 20 * VIEW_SECTORS
    largest = np.linalg.norm(skin.displacement, axis=1).max()
    gap = body.displacement[mine] - skin.displacement[theirs]
    assert np.abs(gap).max() < 1e-9 * largest
    still = revolve_solid(answer.fields, LOADS, 0, NU)
    assert not still.displacement.any()
    assert not still.stress.any()

"""Local solids about recesses, beside those about the same cuts as known ones."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fea.cut.inner_corners import inner_corners
from fea.cut.local_model import LocalModel
from fea.cut.region import pieces, refusal
from geometry import Bottom, CutPin, Hole, Slot
from geometry.mesh.cut_piece import piece_mesh
from tests.fea.cut.test_cut_kinds import HOLE, MIDDLE, STEEL, bent, cut, solved, von_mises
from tests.support.pins.plain_pins import SHAFT
from tests.support.pins.recesses import as_recesses

BLIND = replace(HOLE, angle=0.0, depth=0.006, bottom=Bottom(3.0, 0.001))
KEYWAY = Slot(MIDDLE - 0.006, MIDDLE + 0.006, 0.005, 0.003, 0.0, 0.0008)


@pytest.mark.parametrize(
    "one", [BLIND, pytest.param(KEYWAY, marks=[pytest.mark.slow, pytest.mark.long])]
)
def test_a_recess_has_the_stress_of_the_cut_that_it_is(one: Hole | Slot) -> None:
    pin = cut(one)
    known, other = (pieces(made, ()) for made in (pin, as_recesses(pin)))
    assert [len(known), len(other)] == [1, 1]
    assert not other[0].mirrors
    largest = [float(von_mises(solved(about, bent, 1.4)).max()) for (about,) in (known, other)]
    assert largest[1] == pytest.approx(largest[0], rel=0.02)


def test_its_sharp_corners_are_found() -> None:
    pin = as_recesses(cut(replace(BLIND, bottom=Bottom())))
    (about,) = pieces(pin, ())
    model = LocalModel(about, piece_mesh(about, 1.0), STEEL)
    (corner,) = inner_corners(model, model.faces.points, 0.1)
    assert corner.singularity.between == ("recess 1 face 1", "recess 1 fillet 2")
    assert "a radius" in corner.singularity.advice


def test_one_in_a_loaded_end_face_is_refused() -> None:
    pin = as_recesses(cut(replace(KEYWAY, z0=SHAFT.length - 0.01, z1=SHAFT.length, radius=0.0)))
    reason = refusal(pin, (), ("end",))
    assert reason is not None
    assert reason.codes == ("recess-in-loaded",)


def test_one_that_opens_under_a_clamp_is_refused() -> None:
    pin = as_recesses(CutPin(cut(BLIND).profile, [replace(BLIND, z=MIDDLE)]))
    band = next(b.name for b in pin.profile.bands if b.z0 < MIDDLE < b.z1)
    reason = refusal(pin, (band,), ())
    assert reason is not None
    assert "recess 1" in str(reason)

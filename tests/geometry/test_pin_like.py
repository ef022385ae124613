"""What all pins show alike: a turned one and the same one cut."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from geometry import CutPin, Flat, GeometryError, Hole, Pin, PinLike, Segment, body_of_revolution
from geometry.imported.body_file import BodyFile
from geometry.imported.imported_pin import SolidBody
from geometry.mesh.gmsh_session import gmsh_model
from pinstress.study.model.pins import weight
from tests.support.errors import raises

TURNED = Pin(
    "P",
    (
        Segment(0.02, 0.03, name="root"),
        Segment(0.03, 0.02, connection="P1"),
        Segment(0.01, 0.02, bore=0.005, connection="P2", name="tip"),
    ),
    fillet=0.004,
)

CUT = CutPin(TURNED, (Hole(0.03, 0.003), Flat(0.045, 0.05, 0.009)))


@pytest.mark.parametrize("pin", [TURNED, CUT], ids=["turned", "cut"])
def test_both_have_one_face(pin: PinLike) -> None:
    assert pin.name == "P"
    assert (pin.length, *pin.ends) == pytest.approx((0.06, 0.0, 0.06))
    assert pin.connections == ("P1", "P2")
    assert not pin.meshed
    band = pin.band("P1")
    assert (band.z0, band.z1, band.radius) == pytest.approx((0.024, 0.05, 0.01))
    assert (band.length, band.middle) == pytest.approx((0.026, 0.037))
    assert band.area == pytest.approx(2.0 * math.pi * 0.01 * 0.026)
    assert [pin.surface(n) for n in ("start", "root", "tip")] == ["start", "root", "P2"]
    with raises(GeometryError, "unknown-surface", "'P3'", "start, end, root, P1, P2"):
        pin.surface("P3")


def test_only_one_is_the_same_all_round() -> None:
    assert TURNED.revolved
    assert not CUT.revolved
    whole = CutPin(TURNED)
    assert whole.revolved
    assert whole.volume == TURNED.volume


def test_profile_and_cuts(tmp_path: Path) -> None:
    """A model asks a pin for these two, whatever it is: a body of revolution is its own profile
    and has no cuts; a pin with no cut left is one, too; a square bar from a file has no profile.
    """
    assert TURNED.profile is TURNED
    assert not TURNED.cuts
    assert body_of_revolution(TURNED) is TURNED
    assert CUT.profile is TURNED
    assert list(CUT.cuts) == ["hole 1", "flat 1"]
    assert body_of_revolution(CUT) is None
    assert body_of_revolution(CutPin(TURNED)) is TURNED
    with gmsh_model("P") as gmsh:
        gmsh.model.occ.addBox(0.0, 0.0, 0.0, 1.0, 1.0, 4.0)
        gmsh.model.occ.synchronize()
        gmsh.write(str(tmp_path / "bar.step"))
    body: PinLike = SolidBody(BodyFile("P", tmp_path / "bar.step", 0.01, ()))
    assert body.profile is None
    assert not body.cuts
    assert body_of_revolution(body) is None


def test_a_cut_takes_its_volume() -> None:
    """The flat is a circular segment 5 mm long; the hole a cylinder between two round walls, here
    to 1 %, its walls being nearly plane across 3 mm of 20.
    """
    r, d, length = 0.01, 0.009, 0.005
    flat = length * (r**2 * math.acos(d / r) - d * math.sqrt(r**2 - d**2))
    hole = math.pi * 0.0015**2 * 2.0 * r
    assert TURNED.volume - CUT.volume == pytest.approx(flat + hole, rel=0.01)


def test_weight_and_bore() -> None:
    assert weight(TURNED, 7850.0) == pytest.approx(7850.0 * 9.80665 * TURNED.volume, rel=1e-15)
    assert weight(TURNED, 1000.0, 2.0) == pytest.approx(2000.0 * TURNED.volume, rel=1e-15)
    bored = TURNED.with_bore("P1", 0.004)
    assert TURNED.volume - bored.volume == pytest.approx(0.03 * math.pi * 0.002**2, rel=1e-12)
    inner = bored.band("bore P1")
    assert (inner.z0, inner.z1, inner.radius) == pytest.approx((0.02, 0.05, 0.002))


def test_nothing_is_no_pin() -> None:
    with raises(GeometryError, "no-segments"):
        Pin("P", ())
    with raises(GeometryError, "negative", "segment 1"):
        Pin("P", (Segment(0.02, 0.03, fillet=-0.001),))

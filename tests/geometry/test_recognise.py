"""CAD bodies that are recognised as profiles with holes and flats, and those that are not."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from geometry import Bottom, Cut, CutPin, Flat, Hole, Passage, Pin, Segment, Slot, meridian
from geometry.imported.body_file import BodyFile
from geometry.imported.cad_mesh import cad_volume
from geometry.imported.recognise import NotTurnedError, RecognisedProfile, recognised_profile
from geometry.mesh.cut_solid import cut_solid
from geometry.mesh.gmsh_session import gmsh_model
from geometry.mesh.revolve import revolve
from tests.support.each import sampled
from tests.support.errors import raises
from tests.support.pins.pin_files import MM

PROFILES = {
    "stepped": Pin("P", (Segment(20.0, 30.0), Segment(40.0, 20.0)), fillet=4.0),
    "sharp": Pin("P", (Segment(20.0, 30.0), Segment(40.0, 20.0))),
    "plain": Pin("P", (Segment(60.0, 20.0),)),
    "cone": Pin("P", (Segment(9, 18, end_diameter=20), Segment(30, 20), Segment(9, 25)), fillet=1),
    "tube": Pin("P", (Segment(30.0, 20.0, bore=8.0), Segment(30.0, 20.0, bore=12.0))),
    "blind": Pin(
        "P", (Segment(30, 20, bore=8), Segment(4, 20, bore=8, end_bore=0), Segment(9, 20))
    ),
    "blind from the end": Pin(
        "P", (Segment(9, 20), Segment(4, 20, bore=0, end_bore=8), Segment(30, 20, bore=8))
    ),
    "centred": Pin(
        "P",
        (
            Segment(3, 20, bore=6, end_bore=3),
            Segment(2, 20, bore=3, end_bore=0),
            Segment(30, 20),
            Segment(2, 20, bore=0, end_bore=3),
            Segment(4, 20, bore=3, end_bore=6),
        ),
    ),
    "bolt": Pin("P", (Segment(8, 30, edge_radii=(1, 2)), Segment(50, 20, edge_radii=(0, 10)))),
    "groove": Pin(
        "P", (Segment(9, 20, fillet=1.1), Segment(2.2, 17.8, fillet=1.1), Segment(9, 20))
    ),
    "rounded bore": Pin(
        "P",
        (
            Segment(30.0, 20.0, bore=8.0, bore_radii=(1.0, 0.0)),
            Segment(30.0, 20.0, bore=12.0, bore_radii=(0.5, 0.0)),
        ),
    ),
}
Change = Callable[[Any, int], object]


def _as_drawn(gmsh: Any, solid: int) -> None:
    pass


def turn(gmsh: Any, solid: int) -> None:
    gmsh.model.occ.rotate([(3, solid)], 1, 2, 3, 0.3, 1, 0.2, 1.1)
    gmsh.model.occ.translate([(3, solid)], 10, -20, 5)


def _splines(gmsh: Any, solid: int) -> None:
    """Every face as an exact rational spline, as some programs write them."""
    gmsh.model.occ.convertToNURBS([(3, solid)])


def step(pin: Pin | CutPin, path: Path, change: Change = _as_drawn) -> BodyFile:
    """A STEP file of a pin in mm, changed before it is written."""
    with gmsh_model("P") as gmsh:
        if isinstance(pin, CutPin):
            _, solid = cut_solid(gmsh, pin.profile, pin.cuts)
        else:
            _, solid = revolve(gmsh, meridian(pin))
        change(gmsh, solid)
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    return BodyFile("P", path, MM, ())


def same(found: RecognisedProfile, pin: Pin) -> None:
    """The outline is the pin's: as long edge by edge, and as large."""
    same_outline(found.pin("P"), pin.scaled(MM))


def same_outline(made: Pin, wanted: Pin) -> None:
    assert made.volume == pytest.approx(wanted.volume, rel=1e-9)
    ours, theirs = ([(*e.start, *e.end) for e in meridian(p) if e.name] for p in (made, wanted))
    near = [min(math.dist(a, b) for b in theirs) for a in ours]
    assert max(near) < 1e-9


@pytest.mark.parametrize("name", PROFILES)
def test_a_turned_body_is_its_profile(name: str, tmp_path: Path) -> None:
    same(recognised_profile(step(PROFILES[name], tmp_path / "pin.step")), PROFILES[name])


@pytest.mark.parametrize("name", sampled(["cone", "bolt", "rounded bore"], every=2))
def test_a_turned_body_of_spline_surfaces_is_its_profile(name: str, tmp_path: Path) -> None:
    """OpenCASCADE's own volume of it is up to 1 % wrong."""
    file = step(PROFILES[name], tmp_path / "pin.step", _splines)
    assert cad_volume(file) == pytest.approx(PROFILES[name].scaled(MM).volume, rel=1e-6)
    same(recognised_profile(file), PROFILES[name])


@pytest.mark.parametrize("name", ["stepped", "cone", "tube"])
def test_its_axis_may_lie_anyhow(name: str, tmp_path: Path) -> None:
    """Either end may be the start, as nothing in the file says which."""
    file = step(PROFILES[name], tmp_path / "pin.step", turn)
    profile = recognised_profile(file)
    assert not profile.upright
    found = profile.pin("P")
    assert found.volume == pytest.approx(PROFILES[name].volume * MM**3, rel=1e-8)
    lengths = sorted(s.length / MM for s in found.segments)
    assert lengths == pytest.approx(sorted(s.length for s in PROFILES[name].segments))


def _halves(gmsh: Any, solid: int) -> None:
    """Cylinders in two halves, as CAD programs write them."""
    box = gmsh.model.occ.addBox(-50, -50, -100, 100, 50, 300)
    gmsh.model.occ.fragment([(3, solid)], [(3, box)])
    gmsh.model.occ.synchronize()
    box_parts = [
        v for v in gmsh.model.getEntities(3) if gmsh.model.occ.getMass(*v) > 50 * 100 * 200
    ]
    gmsh.model.occ.remove(box_parts, recursive=True)
    gmsh.model.occ.synchronize()
    halves = gmsh.model.getEntities(3)
    gmsh.option.setNumber("Geometry.OCCUnionUnify", 0)
    gmsh.model.occ.fuse(halves[:1], halves[1:])


@pytest.mark.parametrize("name", ["stepped", "tube", "groove"])
def test_faces_may_be_split(name: str, tmp_path: Path) -> None:
    file = step(PROFILES[name], tmp_path / "pin.step", _halves)
    assert file.path.read_text().count("ADVANCED_FACE") > len(meridian(PROFILES[name]))
    same(recognised_profile(file), PROFILES[name])


def test_holes_and_flats_become_features(tmp_path: Path) -> None:
    hole, flat = Hole(30.0, 4.0, math.pi / 6.0), Flat(45.0, 55.0, 8.0, -math.pi / 3.0)
    pin = CutPin(PROFILES["stepped"], (hole, flat))
    found = recognised_profile(step(pin, tmp_path / "pin.step"))
    same(found, PROFILES["stepped"])
    a, b = found.cuts
    assert isinstance(a, Hole)
    assert isinstance(b, Flat)
    assert (a.z, a.diameter, a.angle) == pytest.approx((0.03, 0.004, math.pi / 6.0))
    assert (b.z0, b.z1, b.distance, b.angle) == pytest.approx((0.045, 0.055, 0.008, -math.pi / 3.0))


CUTS: dict[str, Cut] = {
    "rounded flat": Flat(45.0, 55.0, 8.0, 0.4, 1.0),
    "flat at the end": Flat(50.0, 60.0, 8.0, 0.4, 1.0),
    "blind": Hole(40.0, 4.0, 0.5, 8.0),
    "tip": Hole(40.0, 4.0, 3.0, 8.0, Bottom(math.radians(118.0))),
    "rounded bottom": Hole(40.0, 4.0, -2.0, 8.0, Bottom(radius=0.5)),
    "rounded tip": Hole(40.0, 4.0, -2.0, 12.0, Bottom(math.radians(118.0), 0.5)),
    "beside": Hole(40.0, 4.0, 0.5, offset=-3.0),
    "oblique": Hole(40.0, 4.0, 0.5, tilt=-0.4),
    "oblique beside": Hole(40.0, 4.0, -0.5, offset=2.0, tilt=0.3),
    "rounded mouths": Hole(40.0, 4.0, 0.3, mouth_radius=0.6),
    "countersunk": Hole(40.0, 4.0, 0.3, chamfer=0.6),
    "keyway": Slot(30.0, 45.0, 5.0, 3.0, 0.3),
    "rounded keyway": Slot(30.0, 45.0, 5.0, 3.0, 0.3, 0.6),
    "open keyway": Slot(45.0, 60.0, 5.0, 3.0, 0.3, 0.6),
    "square keyway": Slot(30.0, 45.0, 5.0, 3.0, 0.3, 0.0, False),
    "slot": Slot(35.0, 45.0, 5.0, None, 0.3),
    "passage": Passage(0.0, 60.0, 3.0, 5.0, 0.3),
    "blind passage": Passage(0.0, 30.0, 3.0, 5.0, 0.3, "start", Bottom(math.radians(118.0))),
    "rounded passage": Passage(30.0, 60.0, 3.0, 5.0, 0.3, "end", Bottom(radius=0.5)),
}


@pytest.mark.parametrize("name", CUTS)
def test_a_cut_is_recognised(name: str, tmp_path: Path) -> None:
    """And the volume of what is made of it is that of the body, or it would not be."""
    cut = CUTS[name]
    found = recognised_profile(step(CutPin(PROFILES["stepped"], [cut]), tmp_path / "pin.step"))
    same(found, PROFILES["stepped"])
    (made,) = found.cuts
    assert isinstance(made, Hole | Flat | Slot | Passage)
    bottom, wanted = (getattr(c, "bottom", Bottom()) for c in (made.scaled(1e3), cut))
    assert (bottom.tip, bottom.radius) == pytest.approx((wanted.tip, wanted.radius), abs=1e-5)
    plain = made.scaled(1e3)
    if isinstance(plain, Hole | Passage):
        plain = replace(plain, bottom=wanted)
    turn = 1.0 if cut.half_turn else 0.5
    assert math.sin(turn * (plain.angle - cut.angle)) == pytest.approx(0.0, abs=1e-6)
    assert plain.turned(cut.angle).like(cut, 1e-5), plain


def test_a_splined_end_is_its_slots(tmp_path: Path) -> None:
    """Walls and floors of opposite slots face each other, and are not those of one."""
    slots = [Slot(45.0, 60.0, 3.0, 2.0, k * math.pi / 4.0, 0.0, False) for k in range(8)]
    file = step(CutPin(PROFILES["sharp"], slots), tmp_path / "pin.step")
    found = recognised_profile(file)
    same(found, PROFILES["sharp"])
    assert len(found.cuts) == 8
    for made in found.cuts:
        assert sum(made.scaled(1e3).like(slot, 1e-5) for slot in slots) == 1


def test_cuts_of_several_kinds_of_a_body_that_lies_anyhow(tmp_path: Path) -> None:
    """A hole that comes out in a flat, one into a bore, a keyway opposite, all turned."""
    tube = Pin("P", (Segment(30.0, 20.0, bore=8.0), Segment(30.0, 20.0, bore=8.0)))
    cuts = (
        Hole(15.0, 4.0, 0.3), Flat(10.0, 20.0, 8.0, 0.3), Hole(40.0, 3.0, 1.0, 8.0),
        Slot(30.0, 45.0, 4.0, 3.0, 2.8, 0.4), Passage(0.0, 60.0, 2.0, 7.0, -1.5),
    )  # fmt: skip
    file = step(CutPin(tube, cuts), tmp_path / "pin.step", turn)
    found = recognised_profile(file)
    assert sorted(cut.what for cut in found.cuts) == ["flat", "hole", "hole", "passage", "slot"]


INCH = (
    "( CONVERSION_BASED_UNIT('INCH',#9001) LENGTH_UNIT() NAMED_UNIT(#9002) )",
    "#9001 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9003);\n"
    "#9002 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
    "#9003 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );\nENDSEC;\nEND-ISO",
)


def test_a_file_in_inches(tmp_path: Path) -> None:
    """The unit is in the file's header, and what is read is in millimetres."""
    cut = CUTS["keyway"]
    file = step(CutPin(PROFILES["stepped"], [cut]), tmp_path / "pin.step")
    text = file.path.read_text()
    (before,) = set(re.findall(r"\( *LENGTH_UNIT\(\) NAMED_UNIT\(\*\) SI_UNIT\([^)]*\) *\)", text))
    text = text.replace(before, INCH[0]).replace("ENDSEC;\nEND-ISO", INCH[1])
    file.path.write_text(text)
    found = recognised_profile(file)
    same(found, PROFILES["stepped"].scaled(25.4))
    (made,) = found.cuts
    assert made.scaled(1e3 / 25.4).like(cut, 1e-5)


def test_a_dome_may_have_its_poles_aside(tmp_path: Path) -> None:
    """A sphere's normals are undefined at its own poles, which are not on the pin's axis here."""
    with gmsh_model("P") as gmsh:
        occ = gmsh.model.occ
        bar, ball = occ.addCylinder(0, 0, 0, 30, 0, 0, 5), occ.addSphere(30, 0, 0, 5)
        occ.fuse([(3, bar)], [(3, ball)])
        occ.synchronize()
        gmsh.write(str(tmp_path / "dome.brep"))
    found = recognised_profile(BodyFile("P", tmp_path / "dome.brep", MM, ()))
    (segment,) = found.pin("P").segments
    assert (segment.length, segment.diameter) == pytest.approx((0.035, 0.01))
    assert segment.edge_radii == pytest.approx((0.0, 0.005))


def test_where_it_starts_and_what_its_cylinders_are_called(tmp_path: Path) -> None:
    def lift(gmsh: Any, solid: int) -> None:
        gmsh.model.occ.translate([(3, solid)], 0, 0, -12.5)

    found = recognised_profile(step(PROFILES["sharp"], tmp_path / "pin.step", lift))
    assert found.start == -12.5
    first, second = sorted(found.surfaces.values())
    assert (*first, *second) == pytest.approx((0.0, 0.02, 0.02, 0.06))


def test_a_start_at_the_origin_has_no_minus(tmp_path: Path) -> None:
    """`import` wrote "z = 0 is -0 mm along it"."""

    def sink(gmsh: Any, solid: int) -> None:
        gmsh.model.occ.translate([(3, solid)], 0, 0, -1e-12)

    found = recognised_profile(step(PROFILES["sharp"], tmp_path / "pin.step", sink))
    assert str(found.start) == "0.0"


def _box(gmsh: Any, solid: int) -> None:
    box = gmsh.model.occ.addBox(5, 5, 5, 10, 10, 10)
    gmsh.model.occ.fuse([(3, solid)], [(3, box)])


def test_other_bodies_are_not_turned(tmp_path: Path) -> None:
    with raises(NotTurnedError, "not-turned", "pin.step"):
        recognised_profile(step(PROFILES["sharp"], tmp_path / "pin.step", _box))

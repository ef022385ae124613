"""CAD bodies with heads of bolts, square ends and tangs, drawn as extruded polygons."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from geometry import CutPin, Flat
from geometry.imported.body_file import BodyFile
from geometry.imported.recognise import NotTurnedError, recognised_profile
from geometry.mesh.gmsh_session import gmsh_model
from tests.support.pins.pin_files import MM


def prism(occ: Any, sides: int, across: float, z: float, length: float) -> list[tuple[int, int]]:
    """An extruded regular polygon about the z-axis."""
    radius = across / 2.0 / math.cos(math.pi / sides)
    at = [0.3 + 2.0 * math.pi * k / sides for k in range(sides)]
    points = [occ.addPoint(radius * math.cos(a), radius * math.sin(a), z) for a in at]
    lines = [occ.addLine(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)]
    base = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    return [part for part in occ.extrude([(2, base)], 0, 0, length) if part[0] == 3]


def cylinder(occ: Any, diameter: float, z: float, length: float) -> list[tuple[int, int]]:
    return [(3, occ.addCylinder(0, 0, z, 0, 0, length, diameter / 2.0))]


def _hexagon(occ: Any) -> float:
    occ.fuse(cylinder(occ, 20, 0, 80), prism(occ, 6, 30, -13, 13))
    return 100 * math.pi * 80 + 13 * 1.5 / math.sqrt(3) * 900


def _chamfered(occ: Any) -> float:
    """A nut at the end of a bolt, turned at 30 degrees as nuts are."""
    cone = occ.addCone(0, 0, -13, 0, 0, 13, 14.25, 14.25 + 13 * math.sqrt(3))
    nut, _ = occ.intersect(prism(occ, 6, 30, -13, 13), [(3, cone)])
    (solid, *_), _ = occ.fuse(cylinder(occ, 20, 0, 80), nut)
    return float(occ.getMass(*solid))


def _in_the_middle(occ: Any) -> float:
    occ.fuse(cylinder(occ, 20, 0, 100), prism(occ, 6, 30, 40, 12))
    return 100 * math.pi * 88 + 12 * 1.5 / math.sqrt(3) * 900


def _square_end(occ: Any) -> float:
    """Its edges lie within the shaft, whose shoulder reaches in to the middles of its sides."""
    occ.fuse(cylinder(occ, 30, 0, 60), prism(occ, 4, 18, 60, 20))
    return 225 * math.pi * 60 + 18 * 18 * 20


def _oblong_end(occ: Any) -> float:
    occ.fuse(cylinder(occ, 30, 0, 60), [(3, occ.addBox(-6, -10, 60, 12, 20, 15))])
    return 225 * math.pi * 60 + 12 * 20 * 15


def _tang(occ: Any) -> float:
    """Two flats up to a shoulder, of which no circle is left but the arcs between them."""
    tang, _ = occ.intersect(cylinder(occ, 20, 60, 20), [(3, occ.addBox(-6, -20, 60, 12, 40, 20))])
    occ.fuse(cylinder(occ, 30, 0, 60), tang)
    cap = 100 * math.acos(0.6) - 6 * 8
    return 225 * math.pi * 60 + 20 * (100 * math.pi - 2 * cap)


def _turned_square(occ: Any) -> float:
    """A square whose corners are turned off: its four flats are no two slots."""
    square, _ = occ.intersect(prism(occ, 4, 22, 60, 20), cylinder(occ, 28, 60, 20))
    occ.fuse(cylinder(occ, 30, 0, 60), square)
    cap = 196 * math.acos(11 / 14) - 11 * math.sqrt(196 - 121)
    return 225 * math.pi * 60 + 20 * (196 * math.pi - 4 * cap)


def drawn(build: Callable[[Any], float], path: Path) -> tuple[BodyFile, float]:
    """A STEP file of a body in mm, and its volume, m^3."""
    with gmsh_model("P") as gmsh:
        volume = build(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    return BodyFile("P", path, MM, ()), volume * MM**3


@pytest.mark.parametrize(
    ("build", "flats", "distances"),
    [
        (_hexagon, 6, {15.0}),
        (_chamfered, 6, {15.0}),
        (_in_the_middle, 6, {15.0}),
        (_square_end, 4, {9.0}),
        (_oblong_end, 4, {6.0, 10.0}),
        (_tang, 2, {6.0}),
        (_turned_square, 4, {11.0}),
    ],
)
def test_prisms_are_flats_of_the_cylinder_through_their_edges(
    build: Callable[[Any], float], flats: int, distances: set[float], tmp_path: Path
) -> None:
    file, volume = drawn(build, tmp_path / "pin.step")
    profile = recognised_profile(file)
    cuts = [cut for cut in profile.cuts if isinstance(cut, Flat)]
    assert {round(cut.distance / MM, 6) for cut in cuts} == distances
    assert len(cuts) == len(profile.cuts) == flats
    pin = CutPin(profile.pin("P"), profile.cuts)
    assert pin.volume == pytest.approx(volume, rel=1e-6)


def test_a_prism_beside_the_axis_is_none(tmp_path: Path) -> None:
    def beside(occ: Any) -> float:
        occ.fuse(cylinder(occ, 30, 0, 60), [(3, occ.addBox(-6, -10, 60, 14, 20, 15))])
        return 0.0

    file, _ = drawn(beside, tmp_path / "pin.step")
    with pytest.raises(NotTurnedError, match="form no outline"):
        recognised_profile(file)

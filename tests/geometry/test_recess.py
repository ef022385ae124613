"""Recesses: what a CAD body lacks of its profile and is no known cut."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geometry import CutPin, Hole, Pin, Recess, Segment, Slot
from geometry.imported.cad_mesh import cad_volume
from geometry.imported.recognise import NotTurnedError, recognised_profile
from tests.geometry.test_recognise import PROFILES, Change, same, step, turn
from tests.support.errors import raises
from tests.support.pins.recesses import as_recesses

SHAFT = Pin("P", (Segment(0.06, 0.02),))


def _pocket(gmsh: Any, solid: int) -> None:
    """An ellipsoid, milled out of the thinner part."""
    occ = gmsh.model.occ
    ball = occ.addSphere(0, 0, 0, 1)
    occ.dilate([(3, ball)], 0, 0, 0, 3, 3.5, 6)
    occ.translate([(3, ball)], 0, 10, 40)
    occ.cut([(3, solid)], [(3, ball)])


def _drill(x: float, y: float, dz: float) -> Change:
    """A blind hole from outside to z = 30 + dz, as deep as the axis is, beside the axis by y."""

    def change(gmsh: Any, solid: int) -> None:
        drill = gmsh.model.occ.addCylinder(-20, y, 30, x, 0, dz, 2)
        gmsh.model.occ.cut([(3, solid)], [(3, drill)])

    return change


@pytest.mark.parametrize("change", [_pocket, _drill(20, 3, 0), _drill(20, 0, 10)])
def test_a_solid_of_no_known_kind_is_a_recess(change: Change, tmp_path: Path) -> None:
    file = step(PROFILES["sharp"], tmp_path / "pin.step", change)
    found = recognised_profile(file)
    same(found, PROFILES["sharp"])
    (recess,) = found.cuts
    assert isinstance(recess, Recess)
    made = CutPin(found.pin("P"), found.cuts)
    assert made.volume == pytest.approx(cad_volume(file), rel=1e-5)


def test_known_cuts_beside_a_recess_stay_known(tmp_path: Path) -> None:
    """Also where the body lies anyhow."""

    def change(gmsh: Any, solid: int) -> None:
        _pocket(gmsh, solid)
        ((_, solid),) = gmsh.model.occ.getEntities(3)
        turn(gmsh, solid)

    file = step(CutPin(PROFILES["sharp"], [Hole(10.0, 4.0, 0.3)]), tmp_path / "pin.step", change)
    found = recognised_profile(file)
    assert sorted(cut.what for cut in found.cuts) == ["hole", "recess"]
    made = CutPin(found.pin("P"), found.cuts)
    assert made.volume == pytest.approx(cad_volume(file), rel=1e-5)


def test_grooves_with_slanted_walls_are_recesses(tmp_path: Path) -> None:
    """Their walls were taken as flats, which cut everything away."""

    def spline(gmsh: Any, solid: int) -> None:
        occ, tools = gmsh.model.occ, []
        for k in range(8):
            x = [(8.0, -1.0), (12.0, -2.5), (12.0, 2.5), (8.0, 1.0)]
            points = [occ.addPoint(*at, 45.0) for at in x]
            sides = [
                occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1], strict=True)
            ]
            face = occ.addPlaneSurface([occ.addCurveLoop(sides)])
            tools += [e for e in occ.extrude([(2, face)], 0, 0, 30.0) if e[0] == 3]
            occ.rotate(tools[-1:], 0, 0, 0, 0, 0, 1, k * math.pi / 4.0)
        occ.cut([(3, solid)], tools)

    found = recognised_profile(step(PROFILES["plain"], tmp_path / "pin.step", spline))
    assert [cut.what for cut in found.cuts] == 8 * ["recess"]


def test_a_body_that_lacks_too_many_is_a_solid(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Reading a file has its limit of time."""
    monkeypatch.setattr("geometry.imported.removed_solids.MAX_SOLIDS", 0)
    with raises(NotTurnedError, "not-turned", "face"):
        recognised_profile(step(PROFILES["sharp"], tmp_path / "pin.step", _pocket))


def test_a_boss_is_none(tmp_path: Path) -> None:
    def boss(gmsh: Any, solid: int) -> None:
        cylinder = gmsh.model.occ.addCylinder(0, 0, 40, 0, 14, 0, 4)
        gmsh.model.occ.fuse([(3, solid)], [(3, cylinder)])

    with raises(NotTurnedError, "not-turned", "stands out"):
        recognised_profile(step(PROFILES["plain"], tmp_path / "pin.step", boss))


@pytest.mark.parametrize(
    "cut",
    [
        Hole(0.03, 0.006, 0.7),
        Slot(0.05, 0.06, 0.004, 0.003, 2.0, 0.0, False),
        Slot(0.0, 0.02, 0.004, 0.003, -3.0, 0.0, False),
    ],
)
def test_what_it_takes_of_the_surface_is_within_its_mouth(cut: Hole | Slot) -> None:
    """Also where it goes on to an end of the pin."""
    around, z = np.meshgrid(np.linspace(-3.1, 3.1, 60), np.linspace(0.001, 0.0591, 60))
    x = np.stack([0.01 * np.cos(around), 0.01 * np.sin(around), z], axis=-1).reshape(-1, 3)
    made = as_recesses(CutPin(SHAFT, [cut]))
    (recess,) = made.cuts.values()
    assert isinstance(recess, Recess)
    wanted = cut.takes(x, 0.01)
    assert (recess.takes(x, 0.01) == wanted).mean() > 0.999
    c, s = math.cos(0.4), math.sin(0.4)
    there = x @ [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]] - [0.0, 0.0, 0.01]
    assert (recess.moved(0.01, 0.4).takes(there, 0.01) == wanted).mean() > 0.999


def test_a_recess_that_is_turned_and_moved_is_the_same_elsewhere() -> None:
    """Beside the hole of which it is made, turned and moved by hand."""
    angle, shift, chance = 0.7, 0.004, np.random.default_rng(2)
    (recess,) = as_recesses(CutPin(SHAFT, [Hole(0.03, 0.006, 0.3)])).cuts.values()
    assert isinstance(recess, Recess)
    moved = recess.turned(recess.angle + angle).along(lambda a, b: (a + shift, b + shift))
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    assert moved.extent == pytest.approx([z + shift for z in recess.extent])
    assert (moved.size, moved.faces) == (recess.size, ())
    for ours, before in zip(
        moved.lines(moved.solid.mouth), recess.lines(recess.solid.mouth), strict=True
    ):
        assert ours == pytest.approx(before @ turn + [0.0, 0.0, shift], abs=1e-12)
        # On the cylinder about the drill's own axis, turned with it.
        along = np.array([math.cos(0.3 + angle), math.sin(0.3 + angle), 0.0])
        off = np.cross(ours - [0.0, 0.0, 0.03 + shift], along)
        assert np.linalg.norm(off, axis=1) == pytest.approx(0.003, rel=1e-3)
    theta, z = chance.uniform(-math.pi, math.pi, 400), chance.uniform(0.02, 0.045, 400)
    x = np.stack([0.01 * np.cos(theta), 0.01 * np.sin(theta), z], axis=1)
    off = np.cross(x - [0.0, 0.0, 0.03 + shift], along)
    distance = np.linalg.norm(off, axis=1)
    clear = np.abs(distance - 0.003) > 2e-5
    assert (moved.takes(x, 0.01) == (distance < 0.003))[clear].all()
    (wall, part) = moved.nearest_part(ours)
    assert wall < 2e-4
    (surface,) = moved.surfaces(SHAFT)
    assert surface.part == part
    gap, spacing = np.abs(distance - 0.003), max(f.spacing for f in moved.solid.faces) * moved.unit
    assert (surface.off(x) <= gap + 1e-6).all()
    assert (surface.off(x) >= gap - spacing - 1e-6).all()
    assert moved.mirrored("x") is moved
    assert not moved.like(moved, 1e-6)
    moved.check(SHAFT, "recess 1", ("recess", 1))

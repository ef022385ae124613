"""`pinstress import`, and CAD files that runs take as profiles."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from geometry import CutPin, Flat, Hole, Pin
from geometry.imported.imported_pin import SolidBody
from pinstress import load_study
from pinstress.cli.commands import run_command_line
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.pins import shape_notes
from pinstress.study.reading.errors import InputError
from tests.geometry.test_recognise import (
    PROFILES,
    Change,
    _as_drawn,
    _box,
    same_outline,
    step,
    turn,
)
from tests.support.described import describe
from tests.support.errors import raises

HEAD = """
title = "From CAD"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
"""
OTHER = """
[pin.X]
material = "steel"
clamp = ["start"]
profile = [{ length = 5, diameter = 5, connection = "X" }]
[case.push]
kind = "given"
forces = { X = [0, 1] }
"""
USED = """
[pin.P]
material = "steel"
clamp = ["start"]
geometry = "pin.step"
band.B = { z = [45, 60] }
[case.push]
kind = "given"
forces = { B = [0.0, 1000.0] }
"""


def imported(file: Path, capsys: pytest.CaptureFixture[str], *more: str) -> str:
    assert run_command_line(["import", str(file), *more]) == 0
    return capsys.readouterr().out


@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize("name", PROFILES)
def test_what_is_written_is_the_same_pin(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = step(PROFILES[name], tmp_path / "a pin.step").path
    (tmp_path / "study.toml").write_text(HEAD + OTHER + imported(file, capsys))
    found = pin_of(load_study(tmp_path / "study.toml"), "a pin")
    assert isinstance(found, Pin)
    same_outline(found, PROFILES[name].scaled(1e-3))


@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize("change", [_as_drawn, turn])
def test_holes_and_flats_are_written(
    change: Change, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pin = CutPin(PROFILES["stepped"], (Hole(40.0, 4.0, 0.5), Flat(45.0, 55.0, 8.0, 0.5)))
    file = step(pin, tmp_path / "pin.step", change).path
    out = tmp_path / "study.toml"
    text = imported(file, capsys, "--pin", "C", "--unit", "mm", "--material", "steel")
    out.write_text(HEAD + OTHER + text)
    found = pin_of(load_study(out), "C")
    assert isinstance(found, CutPin)
    assert found.volume == pytest.approx(pin.volume * 1e-9, rel=1e-5)
    assert found.cuts["hole 1"].size == pytest.approx(0.004)
    gap = (found.cuts["flat 1"].angle - found.cuts["hole 1"].angle) % math.pi
    assert min(gap, math.pi - gap) == pytest.approx(0.0, abs=1e-6)
    assert "segment 2: diameter 20 mm, straight from z = 24 to 60 mm" in text


@pytest.mark.usefixtures("read_here")
def test_a_name_cannot_write_into_the_study(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = step(PROFILES["plain"], tmp_path / "pin.step").path
    file = file.rename(tmp_path / "x\n[pin.evil] #\x7f.step")
    capsys.readouterr()
    text = imported(file, capsys, "--pin", "P")
    assert list(tomllib.loads(text)["pin"]) == ["P"]
    file = file.rename(tmp_path / "Bölzen.step")
    assert imported(file, capsys).startswith('# From "Bölzen.step":')


@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize(
    ("name", "more", "code"),
    [
        ("gone.step", (), "does not exist"),
        ("text.step", (), "cannot be read as geometry"),
        ("mesh.msh", (), "is not a CAD file"),
        ("box.step", (), "geometry = "),
        ("pin.step", ("--pin", "a/b"), "cannot be part of a file name"),
        ("pin.step", ("--out", "text.step"), "exists already"),
        (".", (), "--pin: "),
        ("pin.step", ("--material", "a\nb"), "--material: "),
    ],
)
def test_what_cannot_be_imported_is_one_message(
    name: str,
    more: tuple[str, ...],
    code: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    step(PROFILES["sharp"], tmp_path / "pin.step")
    step(PROFILES["sharp"], tmp_path / "box.step", _box)
    (tmp_path / "text.step").write_text("Dear pin,\n")
    (tmp_path / "mesh.msh").write_text("")
    capsys.readouterr()
    assert run_command_line(["import", name, *more]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert code in said.err
    assert said.err.count("Error") == 1


@pytest.mark.usefixtures("read_here")
def test_a_run_takes_a_turned_body_as_a_profile(tmp_path: Path) -> None:
    """It says so; without a fillet its band is what the file's z says."""
    step(PROFILES["stepped"], tmp_path / "pin.step")
    (tmp_path / "study.toml").write_text(HEAD + USED)
    study = load_study(tmp_path / "study.toml")
    found = pin_of(study, "P")
    assert isinstance(found, Pin)
    assert (found.band("B").z0, found.band("B").z1) == pytest.approx((0.045, 0.06))
    assert "pin.step is taken as a profile: 3 segments" in shape_notes(found)
    assert "is taken as a profile" in describe(study)[0]


def _lying(gmsh: Any, solid: int) -> None:
    """What was x, y, z is y, z, x; then it is moved."""
    gmsh.model.occ.rotate([(3, solid)], 0, 0, 0, 1, 1, 1, math.tau / 3.0)
    gmsh.model.occ.translate([(3, solid)], 7, -20, 5)


@pytest.mark.usefixtures("read_here")
def test_a_run_takes_a_lying_body_in_its_own_axes(tmp_path: Path) -> None:
    """Bands are where the file has them along its axis, and angles count from the x that is told.
    A band beside its cylinder is refused, as a solid would be about another axis.
    """
    drilled = CutPin(PROFILES["stepped"], (Hole(30.0, 4.0, 0.4),))
    step(drilled, tmp_path / "pin.step", _lying)
    (tmp_path / "study.toml").write_text(HEAD + USED.replace("[45, 60]", "[52, 67]"))
    study = load_study(tmp_path / "study.toml")
    found = pin_of(study, "P")
    assert isinstance(found, CutPin)
    assert found.profile.volume == pytest.approx(drilled.profile.volume * 1e-9, rel=1e-9)
    assert (found.band("B").z0, found.band("B").z1) == pytest.approx((0.045, 0.06))
    assert found.cuts["hole 1"].angle == pytest.approx(0.4)
    assert "z is along (1, 0, 0) of the file, and x along (0, 1, 0)" in shape_notes(found)
    (tmp_path / "study.toml").write_text(HEAD + USED.replace("[45, 60]", "[17, 37]"))
    own = "z of bands counts from the file's origin"
    with raises(InputError, "not-turned", "here extends from z = 0.027 to 0.067 m", own):
        pin_of(load_study(tmp_path / "study.toml"), "P")


@pytest.mark.slow
@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize(
    ("used", "change", "why"),
    [
        (USED.replace("[45, 60]", "[10, 30]"), _as_drawn, "band B is not on one cylinder"),
        (USED.replace('["start"]', '["face 3"]'), _as_drawn, "has no surface 'face 3'"),
        (USED, _box, "a part of it stands out of its faces of revolution"),
    ],
)
def test_otherwise_it_is_a_solid_and_says_why(
    used: str, change: Change, why: str, tmp_path: Path
) -> None:
    step(replace(PROFILES["sharp"]), tmp_path / "pin.step", change)
    (tmp_path / "study.toml").write_text(HEAD + used)
    found = pin_of(load_study(tmp_path / "study.toml"), "P")
    assert isinstance(found, SolidBody)
    assert why in shape_notes(found)


MERIDIAN = """
[pin.M]
material = "steel"
meridian = [[0, 14], [5, 15], [35, 15], [55, 10, 1], [85, 10, 1]]
bore_meridian = [[0, 2], [85, 2]]
band.C = { z = BAND }
"""


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("BAND", "[56, 84]"), None),
        (("BAND", "[36, 50]"), "study.toml:12: pin M: band C is on a cone"),
        (("BAND", "[30, 36]"), "study.toml:12: pin M: band C is not on one cylinder"),
        (("BAND", "[84, 90]"), "study.toml:12: pin M: band C is not on the pin"),
        (("{ z = BAND }", '{ surface = "a" }'), "pin.M: band C: with meridian give z"),
        (("[5, 15]", "[5]"), "pin.M.meridian[2]: must have at least 2 elements"),
        (("[5, 15]", "[5, 15, 1, 1]"), "pin.M.meridian[2]: must have at most 3 elements"),
        (("[35, 15]", "[2, 15]"), "study.toml:10: pin M: meridian goes back"),
        (("[0, 2]", "[1, 2]"), "study.toml:11: pin M: bore_meridian must begin at z = 0"),
        (
            ("bore_meridian = [[0, 2], [85, 2]]", 'geometry = "a.step"'),
            "pin.M: give one of profile",
        ),
        (
            ("bore_meridian = [[0, 2], [85, 2]]", "fillet = 1"),
            "fillet can only be used with profile",
        ),
    ],
)
def test_a_meridian_in_a_study(
    change: tuple[str, str], said: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (HEAD + MERIDIAN + '[case.p]\nkind = "given"\nforces = { C = [0, 1] }').replace(*change)
    path = tmp_path / "study.toml"
    path.write_text(text.replace("BAND", "[56, 84]"))
    status = run_command_line(["check", str(path)])
    assert status == (1 if said is None else 2)
    found = capsys.readouterr()
    if said is None:
        assert re.search(r"pin M: steel, \S+ mm long, .*5 corners", found.out)
        length = math.pi / 3.0
        cones = length * 5 * (14**2 + 14 * 15 + 15**2) + length * 20 * (15**2 + 150 + 100)
        whole = cones + math.pi * (30 * 15**2 + 30 * 100 - 85 * 2**2)
        made = pin_of(load_study(path), "M").volume * 1e9
        assert made == pytest.approx(whole, rel=1e-3)  # but for two radii of 1 mm
    else:
        assert said in found.err

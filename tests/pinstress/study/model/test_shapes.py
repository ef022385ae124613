"""Pins with holes and flats, and pins from files, in a study: read, refused, run."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import pytest

from geometry import CutPin, Flat, Hole, Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from pinstress import InputError, load_study
from pinstress.cli.commands import run_command_line
from pinstress.study.model.pins import pin as pin_of
from tests.conftest import ROOT
from tests.support.described import describe
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.pin_files import write_mesh, write_step
from tests.support.study_text import study_file

STUDY = """
title = "A pin of any shape"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
yield_strength = "350 MPa"

[pin.P]
material = "steel"
clamp = ["start"]
SHAPE

[case.push]
kind = "given"
forces = { B = [0.0, 1000.0] }

[analysis]
tolerance = 0.5
"""
PROFILE = """profile = [
  { length = 20.0, diameter = 30.0 },
  { length = 40.0, diameter = 20.0, connection = "B" },
]
fillet = 4.0
"""
CUT = (
    PROFILE
    + """hole = [{ z = 45.0, diameter = "4 mm", angle = "90 deg" }]
flat = [{ z = [50.0, 60.0], distance = 8.0, angle = "30 deg" }]
"""
)
FILE = """geometry = "pin.step"
[pin.P.band]
B = { z = [40.0, 60.0] }
root = { z = [0.0, 10.0], connection = false }
"""


def write(folder: Path, shape: str) -> Path:
    return study_file(folder, STUDY.replace("SHAPE", shape))


def test_holes_and_flats_are_read(tmp_path: Path) -> None:
    study = load_study(write(tmp_path, CUT))
    found = pin_of(study, "P")
    assert isinstance(found, CutPin)
    assert not found.revolved
    assert found.cuts["hole 1"] == Hole(0.045, 0.004, math.pi / 2)
    assert found.cuts["flat 1"] == Flat(0.05, 0.06, 0.008, 30.0 * math.pi / 180.0)
    assert "2 segments, 1 hole, 1 flat, " in describe(study)[0]
    turned = pin_of(load_study(write(tmp_path, PROFILE)), "P")
    assert isinstance(turned, Pin)
    assert turned.revolved


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["cut", "step", "mesh"])
def test_runs(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """To results, drawing and field. The third mesh of the solid has 231,000 unknowns, whose factor
    and matrices took 3.6 GB in this process: two are enough.
    """
    monkeypatch.chdir(tmp_path)
    pin = Pin("P", (Segment(20.0, 30.0), Segment(40.0, 20.0, connection="B")), fillet=4.0)
    if kind == "step":
        write_step(pin, tmp_path / "pin.step")
    if kind == "mesh":
        small = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="B")), fillet=0.004)
        write_mesh(solid_mesh(small, MeshSize(across=2.0)), tmp_path / "pin.msh")
    write(
        tmp_path,
        CUT if kind == "cut" else FILE.replace("step", "msh" if kind == "mesh" else "step"),
    )
    limit = ["--memory-limit", "1000"]
    assert run_command_line(["run", "study.toml", *limit]) in (0, 1)
    (found,) = json.loads((tmp_path / "out/study/results.json").read_text())["pins"]
    assert found["model"] == ("harmonic" if kind == "step" else "solid")
    assert 10.0 < found["max_von_mises"] < 100.0
    assert (tmp_path / "out/study/vtk/P_push.vtu").is_file()
    assert "P" in (tmp_path / "out/study/report.html").read_text()


@each(
    ("shape", "code", "named"),
    [
        (PROFILE + FILE, "give-one", "pin.P: "),
        ("", "give-one", "pin.P: "),
        (PROFILE + "[pin.P.band]\nB = { z = [0.0, 1.0] }", "key-not-applicable", "pin.P: band"),
        ("fillet = 1.0\n" + FILE, "key-not-applicable", "pin.P: fillet"),
        (FILE.replace("{ z = [40.0, 60.0] }", "{}"), "give-one", "pin.P.band.B: "),
        (FILE.replace("z =", "zz ="), "unknown-key", "'zz'; did you mean 'z'?"),
        (PROFILE + 'geometry_unit = "in"', "key-not-applicable", "pin.P: geometry_unit"),
        (FILE.replace('"pin.step"', '"pin.step"\ngeometry_unit = "mile"'), "not-a-choice",
         "geometry_unit: "),
        (CUT.replace('"90 deg"', "90"), "missing-unit", "hole[1].angle: "),
    ],
)  # fmt: skip
def test_bad_tables(shape: str, code: str, named: str, tmp_path: Path) -> None:
    with raises(InputError, code, named):
        load_study(write(tmp_path, shape))


@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize(
    ("shape", "code", "named"),
    [
        (CUT.replace('"4 mm"', "20.0"), "hole-too-large", "hole 1"),
        (CUT.replace("distance = 8.0", "distance = 10.5"), "cuts-nothing", "flat 1"),
        (FILE.replace("pin.step", "gone.step"), "no-such-file", "gone.step"),
        (FILE.replace("pin.step", "study.toml"), "unreadable-geometry", "study.toml"),
        (FILE + "[pin.P.lug.B]\nclearance = 0.1", "key-not-applicable", "pinstress import"),
        (FILE.replace("40.0, 60.0", "70.0, 80.0"), "band-not-found", "z = 70 and 80"),
        pytest.param(
            FILE.replace("z = [0.0, 10.0]", 'surface = "foot"'),
            "unknown-surface",
            "'foot'",
            marks=pytest.mark.slow,
        ),
        pytest.param(FILE, "unknown-surface", "'side'", marks=pytest.mark.slow),
    ],
)
def test_bad_shapes(
    shape: str, code: str, named: str, tmp_path: Path, step: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "pin.step").write_bytes(step.read_bytes())
    path = write(tmp_path, shape)
    if shape == FILE:
        path.write_text(path.read_text().replace('clamp = ["start"]', 'clamp = ["side"]'))
    with raises(InputError, code, named):
        pin_of(load_study(path), "P")


@pytest.fixture(scope="module")
def step(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pin = Pin("P", (Segment(20.0, 30.0), Segment(40.0, 20.0)), fillet=4.0)
    return write_step(pin, tmp_path_factory.mktemp("step") / "pin.step")


def test_a_file_over_which_opencascade_crashes_is_one_message(tmp_path: Path, step: Path) -> None:
    """In a process of its own, as here other threads may run, beside which there is none."""
    text = step.read_text()
    known = "= DIRECTION('',(0.,1.))"
    assert known in text
    (tmp_path / "pin.step").write_text(text.replace(known, known.replace("DIR", "DAR"), 1))
    done = subprocess.run(
        [sys.executable, "-m", "pinstress", "check", str(write(tmp_path, FILE))],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("Error") == 1
    assert "pin P: reading pin.step failed" in done.stderr


def test_a_beam_check_needs_a_profile(tmp_path: Path) -> None:
    path = write(tmp_path, CUT)
    path.write_text(path.read_text() + '[beam_check]\npin = "P"\ncase = "push"\naxis_bore = 1.0\n')
    assert run_command_line(["run", str(path), "--out", str(tmp_path / "out")]) == 2

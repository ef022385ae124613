"""A platform on six legs (Gough and Stewart), whose legs' forces are those of six equations: the
legs end in joints that carry no moment, so that round-off is all that their moments are.
"""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from pinbase.arrays import Floats
from pinstress import load_study
from pinstress.analysis.gather.gather import loads_only
from pinstress.analysis.plan import all_loads
from reports.text.loads import print_loads

BASE, TOP, HEIGHT = 1.0, 0.6, 1.2
GRAVITY, MASS = 9.80665, 500.0
STROKES = (0.05, 0.05, 0.08, 0.02, -0.03, 0.06)
FORCE, POINT = np.array([3e3, -2e3, -1e4]), np.array([0.1, 0.2, 1.3])
COUPLE = np.array([1e3, 0.0, 2e3])


def circle(radius: float, degrees: list[int], z: float) -> Floats:
    angle = np.radians(degrees)
    return np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.full(len(angle), z)], axis=1
    )


FEET = circle(BASE, [10, 110, 130, 230, 250, 350], 0.0)
HEADS = circle(TOP, [50, 70, 170, 190, 290, 310], HEIGHT)


def study() -> str:
    text = f"""
title = "A platform on six legs"
units = "m-N-s"
[mechanism]
dimension = 3
gravity = [0, 0, {-GRAVITY}]
[mechanism.body.plate]
mass = {MASS}
centre = [0, 0, {HEIGHT + 0.1}]
inertia = [20, 20, 40]
[case.hold]
kind = "static"
[[case.hold.apply]]
body = "plate"
at = {POINT.tolist()}
force = {FORCE.tolist()}
couple = {COUPLE.tolist()}
[case.move]
kind = "motion"
samples = 11
"""
    for k, (foot, head) in enumerate(zip(FEET, HEADS, strict=True)):
        leg = head - foot
        level = np.cross(leg, [0.0, 0.0, 1.0])
        text += f"""
[mechanism.joint.B{k}]
at = {foot.tolist()}
kind = "universal"
axis = {level.tolist()}
second_axis = {np.cross(leg, level).tolist()}
fixed_in = "ground"
connections = {{ b{k} = "cylinder{k}" }}
[mechanism.joint.S{k}]
at = {(0.6 * foot + 0.4 * head).tolist()}
kind = "prismatic"
axis = {leg.tolist()}
fixed_in = "cylinder{k}"
connections = {{ s{k} = "rod{k}" }}
[mechanism.joint.P{k}]
at = {head.tolist()}
kind = "spherical"
fixed_in = "rod{k}"
connections = {{ p{k} = "plate" }}
[mechanism.body.cylinder{k}]
mass = 0
centre = {foot.tolist()}
[mechanism.body.rod{k}]
mass = 0
centre = {head.tolist()}
[[mechanism.drive]]
slide = "S{k}"
start = 0
end = {STROKES[k]}
duration = 1
law = "cycloidal"
"""
    return text


def test_the_forces_of_a_platform_on_six_legs(tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text(study(), encoding="utf-8")
    read = load_study(path)
    loads = all_loads(read, ["hold", "move"])
    along = (HEADS - FEET) / np.linalg.norm(HEADS - FEET, axis=1)[:, None]
    columns = np.concatenate([along.T, np.cross(HEADS, along).T])
    weight = np.array([0.0, 0.0, -GRAVITY * MASS])
    moment = np.cross(POINT, FORCE) + COUPLE + np.cross([0.0, 0.0, HEIGHT + 0.1], weight)
    expected = np.linalg.solve(columns, -np.concatenate([FORCE + weight, moment]))
    held = loads["hold"].reactions
    for k, force in enumerate(expected):
        vector = held.forces[0, held.connections.index(f"p{k}")]
        assert vector == pytest.approx(-force * along[k], abs=1e-9 * abs(expected).max())
    peaks = loads["move"].peaks
    assert peaks is not None
    assert not len(peaks.unresolved)
    # On the terminal a slide without a load has none, not round-off.
    out = StringIO()
    print_loads(loads_only(read), Console(file=out, width=80))
    lines = [line.split() for line in out.getvalue().splitlines() if " s0 " in line]
    assert [line[4] for line in lines] == ["0", "0"]

"""A linkage of parallel axes as one in space and as one in the plane."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from pinstress import load_study
from pinstress.analysis.mechanics.gather_loads import mechanics
from pinstress.analysis.plan import all_loads
from pinstress.study.reading.published_tables import Published
from reports.data.results import Results
from reports.data.row import SI
from reports.plots.all import all_plots
from reports.tables.all import load_tables
from reports.tables.json_results import to_json
from reports.text.loads import remarks
from tests.pinstress.study.model.test_space import solved
from tests.support.study_text import edited, edited_once, study_file

FOUR_BAR = """
title = "A four-bar"
units = "m-N-s"
[mechanism.joint.O]
at = [0, 0]
fixed_in = "ground"
connections = { O1 = "crank" }
[mechanism.joint.P]
at = [0.1, 0.2]
fixed_in = "crank"
connections = { P1 = "coupler" }
[mechanism.joint.Q]
at = [0.5, 0.3]
weight = 4
connections = { Q1 = "coupler", Q2 = "rocker" }
[mechanism.joint.R]
at = [0.4, 0]
fixed_in = "ground"
connections = { R1 = "rocker" }
[mechanism.body.crank]
bar = { joints = ["O", "P"], diameter = 0.02, density = "7850 kg/m^3" }
[mechanism.body.coupler]
mass = 3
centre = [0.3, 0.4]
inertia = 0.05
[mechanism.body.rocker]
bar = { joints = ["Q", "R"], diameter = 0.03, density = "7850 kg/m^3" }
[mechanism.spring.s]
bodies = ["ground", "coupler"]
joints = [[0, 0.5], "Q"]
stiffness = 500
damping = 20
[mechanism.drive]
body = "crank"
start = "0 deg"
end = "25 deg"
duration = 0.2
[case.move]
kind = "motion"
samples = 31
[[case.move.apply]]
body = "coupler"
at = [0.3, 0.4]
force = [10, -40]
couple = 3
follows = true
"""


def _in_space(planar: str) -> str:
    """A planar study, stated with three coordinates."""
    text = re.sub(r"\[(-?[\d.]+), (-?[\d.]+)\]", r"[\1, \2, 0]", planar)
    changes = (
        ("[mechanism.joint.O]", '[mechanism]\ndimension = 3\ngravity = [0, "-9.80665 m/s^2", 0]\n'
         "[mechanism.joint.O]"),
        ("\nconnections", "\naxis = [0, 0, 1]\nconnections"),
        ("inertia = 0.05", "inertia = [0.02, 0.03, 0.05]"),
        ('body = "crank"\nstart', 'joint = "O"\nstart'),
        ("couple = 3", "couple = [0, 0, 3]"),
    )  # fmt: skip
    return edited(text, changes)


# The crank turns fully, so that the rocker turns back twice, against friction; the spring's table
# has rows within its travel.
TURNING = (
    ("at = [0.1, 0.2]", "at = [0.05, 0.09]"),
    ("at = [0.5, 0.3]\nweight = 4", 'at = [0.35, 0.3]\nfixed_in = "rocker"'),
    ('connections = { Q1 = "coupler", Q2 = "rocker" }', 'connections = { Q1 = "coupler" }'),
    ('connections = { R1 = "rocker" }',
     'connections = { R1 = "rocker" }\nfriction = 0.3\ndiameter = 0.05'),
    ('end = "25 deg"\nduration = 0.2', 'end = "400 deg"\nduration = 2'),
    ("stiffness = 500", 'force = { table = "spring.csv" }'),
    ("samples = 31", "samples = 7"),
)  # fmt: skip


def test_largest_forces_are_resolved_where_friction_turns_back(tmp_path: Path) -> None:
    """As in the plane: friction jumps and the spring has kinks between the instants; the same
    without friction.
    """
    table = "length,force\n0.1,20\n0.35,10\n0.4,-40\n0.9,-50\n"
    (tmp_path / "spring.csv").write_text(table, encoding="utf-8")
    text = edited_once(FOUR_BAR, TURNING)
    plane, space = solved(tmp_path, text)["move"], solved(tmp_path, _in_space(text))["move"]
    assert plane.peaks is not None
    assert space.peaks is not None
    assert not len(plane.peaks.unresolved)
    assert not len(space.peaks.unresolved)
    assert plane.frictionless is not None
    assert space.frictionless is not None
    for c, peak in plane.peaks.force.items():
        assert space.peaks.force[c].value == pytest.approx(peak.value, rel=1e-7)
        smooth = plane.frictionless.peaks.force[c].value
        assert space.frictionless.peaks.force[c].value == pytest.approx(smooth, rel=1e-7)
    assert plane.over is not None
    assert space.space is not None
    assert space.space.efforts is not None
    ours, theirs = space.space.efforts[0], plane.over.drives[0]
    assert ours.rms == pytest.approx(theirs.rms, rel=1e-7)
    assert ours.work == pytest.approx(theirs.work, abs=1e-7 * np.abs(theirs.work).max())
    smooth = space.frictionless.drives[0].largest.value
    assert ours.largest.value != pytest.approx(smooth, rel=0.01)


def test_a_linkage_of_parallel_axes_is_that_in_the_plane(tmp_path: Path) -> None:
    """The same linkage stated with three coordinates: same forces in the plane, same drive."""
    text = _in_space(FOUR_BAR)
    plane, space = solved(tmp_path, FOUR_BAR)["move"], solved(tmp_path, text)["move"]
    assert plane.dynamics is not None
    assert space.space is not None
    ours, theirs = space.reactions, plane.reactions
    assert ours.connections == theirs.connections
    size = theirs.magnitudes.max()
    assert ours.forces == pytest.approx(theirs.forces, abs=1e-9 * size)
    drive = plane.dynamics.drive
    assert space.space.dynamics.drive == pytest.approx(drive, abs=1e-9 * np.abs(drive).max())
    for c in ("O1", "P1", "R1"):  # a floating pin keeps the world's axes in the plane alone
        assert ours.in_pin_axes(c) == pytest.approx(theirs.in_pin_axes(c), abs=1e-9 * size)
    assert plane.peaks is not None
    assert space.peaks is not None
    for c, peak in plane.peaks.force.items():
        assert space.peaks.force[c].value == pytest.approx(peak.value, rel=1e-7)
    assert plane.over is not None
    assert space.space.efforts is not None
    assert space.space.efforts[0].rms == pytest.approx(plane.over.drives[0].rms, rel=1e-6)


def test_a_case_says_how_near_the_linkage_comes_to_a_dead_point(tmp_path: Path) -> None:
    """The crank turns towards the line of coupler and rocker, where it cannot drive them: the same
    transmission angle as in the plane, in tables, on the page and on the terminal.
    """
    plane = load_study(study_file(tmp_path, FOUR_BAR))
    made = mechanics(plane, all_loads(plane, ["move"]), Published())
    study = load_study(study_file(tmp_path, _in_space(FOUR_BAR)))
    loads = all_loads(study, ["move"])
    parts = mechanics(study, loads, Published())
    (posture,), (flat,) = parts["space_postures"], made["motion"]
    condition, at = posture.worst_condition
    assert condition > 5.0
    assert at in posture.time
    assert posture.violation < 1e-12
    assert [*posture.transmission] == [*flat.transmission] == ["coupler at Q"]
    angles = posture.transmission["coupler at Q"]
    assert angles == pytest.approx(flat.transmission["coupler at Q"], abs=1e-7)
    low, when = posture.poorest["coupler at Q"]
    assert (low, when) == pytest.approx(flat.poorest["coupler at Q"], abs=1e-6)
    results = Results("", "", "", SI, None, 0.02, (), **parts)
    table = next(t for t in load_tables(results) if t.name == "transmission")
    assert len(table) == len(angles)
    (case,) = to_json(results)["loads"]
    assert case["least_transmission"][0]["degrees"] == low
    assert case["largest_condition"] == condition
    assert any("maximum condition number" in line for line in remarks(results))
    assert "transmission.move" in all_plots(results)

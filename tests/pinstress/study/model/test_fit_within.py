"""Redundant links drawn 1.5 mm off: what the refusal says, and joints moved by `fit_within`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pinstress import load_study
from pinstress.analysis.gather.gather import loads_only
from pinstress.cli.check import examine
from pinstress.study.model.cases import case_loads
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from tests.support.each import each
from tests.support.programs.command_line import run_here
from tests.support.study_text import study_file

WEIGHT, CENTRE = 1000.0, 230.0  # N; mm along the coupler
STUDY = """
title = "A table on three cranks"
units = "mm-N-s"
[mechanism]
FIT
[mechanism.joint]
A = { at = [0, 0], connections = { A1 = "crank 1" }, fixed_in = "ground" }
B = { at = [300, 100], connections = { B1 = "crank 2" }, fixed_in = "ground" }
C = { at = [601.5, 0], connections = { C1 = "crank 3" }, fixed_in = "ground" }
D = { at = [0, 200], connections = { D1 = "crank 1" }, fixed_in = "table" }
E = { at = [300, 300], connections = { E1 = "crank 2" }, fixed_in = "table" }
F = { at = [600, 200], connections = { F1 = "crank 3" }, fixed_in = "table" }
[mechanism.body]
"crank 1" = { mass = 0.0, inertia = 0.0 }
"crank 2" = { mass = 0.0, inertia = 0.0 }
"crank 3" = { mass = 0.0, inertia = 0.0 }
table = { weight = 1000.0, centre = [230, 200], inertia = 0.0 }
[mechanism.drive]
name = "motor"
body = "crank 1"
line = ["A", "D"]
start = "90 deg"
end = "60 deg"
duration = 2
[[mechanism.sharing]]
connections = ["D1", "E1", "F1"]
stiffness = [1, 2, 1]
[case.swing]
kind = "motion"
[case.rest]
kind = "static"
position = "70 deg"
"""
SHARING = STUDY[STUDY.index("[[mechanism.sharing]]") : STUDY.index("[case.swing]")]


def cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def written(folder: Path, fit: str = "", text: str = STUDY) -> Study:
    path = study_file(folder, text.replace("FIT", fit))
    return load_study(path)


@each("rule", ["with a sharing rule", "without"])
def test_the_refusal_says_the_gap_and_the_key(rule: str, tmp_path: Path) -> None:
    """Cranks of 200 mm, the third 1.5 mm off to the side: their mean needs a movement of 0.5 mm."""
    text = STUDY if rule == "with a sharing rule" else STUDY.replace(SHARING, "")
    with pytest.raises(InputError) as refused:
        examine(written(tmp_path, text=text))
    line = refused.value.lines[0]
    starts = ("study.toml:4: mechanism", "case.swing: the linkage closes only as drawn")
    assert any(start in line for start in starts)
    gap = line.split("miss each other by up to ")[1].split(" mm; they meet if")[0]
    assert 0.05 < float(gap) < 1.5
    assert line.endswith("the joints move by up to 0.5 mm: fit_within = 0.51 in [mechanism]")


def test_lengths_are_in_the_units_of_the_study(tmp_path: Path) -> None:
    text = STUDY.replace("mm-N-s", "in-lbf-s")
    with pytest.raises(InputError) as refused:
        examine(written(tmp_path, text=text))
    assert "move by up to 0.5 in: fit_within = 0.51 in [mechanism]" in refused.value.lines[0]


def test_what_it_offers_is_enough_and_little_less_is_not(tmp_path: Path) -> None:
    study = written(tmp_path, "fit_within = 0.51")
    examined = examine(study)
    (note,) = (line for line in examined.lines if "fit_within" in line)
    assert note.startswith("Joints are moved so that ")
    for name, x in {"C": -0.5, "F": 0.5, "A": 0.25, "B": 0.25, "D": -0.25, "E": -0.25}.items():
        assert f"{name} by ({x} mm, 0 mm)" in note
    assert note in loads_only(study).assumptions
    with pytest.raises(InputError, match=r"0\.5 mm, more than fit_within = 0\.49 mm") as refused:
        examine(written(tmp_path, "fit_within = 0.49"))
    assert "study.toml:5: mechanism" in refused.value.lines[0]


def test_commands_say_that_joints_are_moved(tmp_path: Path) -> None:
    """The forces are not those of the linkage as drawn, also where no pin is solved."""
    written(tmp_path, "fit_within = 0.51")
    answer = run_here("loads", "study.toml", cwd=tmp_path)
    assert answer.returncode == 0
    assert "Warning: Joints are moved so that " in answer.stderr
    pin = """
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.F]
material = "steel"
profile = [{ length = 100, diameter = 10, connection = "F1" }]
clamp = ["start"]
"""
    written(tmp_path, "fit_within = 0.51", STUDY + pin)
    options = "--model", "beam", "--cases", "rest", "--tolerance", "0.9", "--vtk", "none"
    answer = run_here("run", "study.toml", *options, cwd=tmp_path)
    assert "Warning: Joints are moved so that " in answer.stderr, answer.stderr


def test_links_that_fit_stay_as_drawn(tmp_path: Path) -> None:
    study = written(tmp_path, "fit_within = 1.0", STUDY.replace("601.5", "600"))
    assert [joint.at for joint in linkage(study).joints] == [
        (0.0, 0.0), (0.3, 0.1), (0.6, 0.0), (0.0, 0.2), (0.3, 0.3), (0.6, 0.2),
    ]  # fmt: skip
    assert not any("fit_within" in line for line in examine(study).lines)


def test_reactions_are_shared_as_stated(tmp_path: Path) -> None:
    """By springs in parallel: cranks without mass pull along themselves, but for the driven one,
    and forces along them balance the weight's part along them and its moment about D, with the
    least sum of force^2 / stiffness.
    """
    study = written(tmp_path, "fit_within = 1.0")
    fitted = linkage(study)
    reactions = case_loads(study, "rest", fitted).reactions
    force = {name: reactions.force(name)[0, :2] for name in ("D1", "E1", "F1")}
    at = {joint.name: np.array(joint.at) for joint in fitted.joints}
    crank = at["D"] - at["A"]
    turned = np.radians(70.0)
    u, v = (np.array([np.cos(t), np.sin(t)]) for t in (turned, turned + np.pi / 2.0))
    assert np.hypot(*crank) == pytest.approx(np.hypot(0.5, 200.0) * 1e-3, rel=1e-9)
    up = np.array([0.0, WEIGHT])
    arms = [cross(at[name] - at["D"], u) for name in "DEF"]
    balance = np.array([[1.0, 1.0, 1.0], arms])
    side = np.array([up @ u, cross(np.array([0.001 * CENTRE, 0.2]) - at["D"], up)])
    stiffness = np.diag([1.0, 2.0, 1.0])
    along = stiffness @ balance.T @ np.linalg.solve(balance @ stiffness @ balance.T, side)
    for name, pull in zip(("D1", "E1", "F1"), along, strict=True):
        assert force[name] @ u == pytest.approx(pull, rel=1e-7)  # cranks are parallel to 1e-9
    assert force["D1"] @ v == pytest.approx(up @ v, rel=1e-7)
    assert abs(force["E1"] @ v) < 1e-6 * WEIGHT
    assert abs(force["F1"] @ v) < 1e-6 * WEIGHT

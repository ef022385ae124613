"""Gears and racks of a study: what is drawn of them, and how a study describes them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from pinstress.analysis.gather.gather import loads_only
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import load_study, parse_study
from reports.animation.page import render_animation
from reports.data.skeleton import planar_skeleton
from reports.plots.loads.linkage import linkage_plot
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.errors import raises

PLANETARY = ROOT / "studies" / "planetary.toml"
RECIPES = (ROOT / "docs" / "recipes.md").read_text(encoding="utf-8")
GATE = re.search(r"# gate\.toml\n(.*?)```", RECIPES, re.DOTALL)


def gate(old: str = "", new: str = "") -> str:
    assert GATE is not None
    assert old in GATE[1]
    return GATE[1].replace(old, new, 1)


def test_pitch_circles_turn_with_their_gears() -> None:
    results = loads_only(load_study(PLANETARY), cases=["lift"])
    (motion,) = results.motion
    circles = {c.body: c for c in motion.pitch}
    assert {b: round(c.radius, 9) for b, c in circles.items()} == {
        "sun": 48.0, "planet1": 48.0, "planet2": 48.0, "planet3": 48.0, "ground": 144.0,
    }  # fmt: skip
    for body, angle in zip(motion.bodies, motion.angle.T, strict=True):
        if body in circles:
            z = circles[body].ends @ np.array([1.0, 1j])
            turned = (z[:, 1] - z[:, 0]) / (z[0, 1] - z[0, 0])
            expected = np.exp(1j * np.radians(angle - angle[0]))
            assert np.abs(turned - expected).max() < 1e-9
    assert {"sun_planet1", "planet3_ring"} <= {*motion.joints}
    page = render_animation(planar_skeleton(motion), results)
    assert page.count("data-pitch=") == 5
    axes = linkage_plot(motion, results.units).spec["encoding"]
    assert axes["y"]["scale"]["domain"][1] > 144.0


def test_the_pitch_line_of_a_rack_touches_its_gear_all_the_time() -> None:
    results = loads_only(parse_study(Path("gate.toml"), gate()))
    (motion,) = results.motion
    line = next(c for c in motion.pitch if not c.round)
    assert line.body == "gate"
    touch = motion.joint_position[:, motion.joints.index("teeth")]
    assert touch == pytest.approx(np.tile([0.0, -40.0], (len(touch), 1)))
    low, high = line.ends[:, 0], line.ends[:, 1]
    assert low[:, 1] == pytest.approx(-40.0)
    assert np.all(low[:, 0] <= -40.0 + 1e-9)
    assert np.all(high[:, 0] >= 40.0 - 1e-9)
    travel = low[-1, 0] - low[0, 0]
    assert travel == pytest.approx(40.0 * 1.5 * np.pi)


def test_radii_and_teeth_give_the_same_gears() -> None:
    text = PLANETARY.read_text(encoding="utf-8")
    radii = text.replace("teeth = [24, 24]\nmodule = 4 ", "radii = [48, 48] ")
    assert radii != text
    ours, theirs = (linkage(parse_study(PLANETARY, t)).teeth for t in (text, radii))
    for one, two in zip(ours, theirs, strict=True):
        assert one.at == pytest.approx(two.at)
        assert one.normal == pytest.approx(two.normal)


@each(
    ("old", "new", "code", "named"),
    [
        ("teeth = 16\nmodule = 5", "teeth = 16", "give-both", "module"),
        ("teeth = 16\nmodule = 5", "", "give-one", "radius"),
        ('slider = "guide"', 'slider = "rail"', "unknown-slider", "'rail'"),
        ('pinion = "pinion"', 'pinion = "gate"', "joint-not-on-body", "is not on gate"),
        ('bodies = ["ground", "gate"]', 'bodies = ["pinion", "gate"]', "no-carrier", "the rack"),
        ('side = "right"', 'side = "below"', "not-a-choice", "left"),
        ('body = "pinion"', 'body = "pinion"\nagainst_line = ["A", "A"]', "give-both", "line"),
    ],
)
def test_what_is_wrong_with_a_rack_is_named(old: str, new: str, code: str, named: str) -> None:
    with raises(InputError, code, named):
        linkage(parse_study(Path("gate.toml"), gate(old, new)))

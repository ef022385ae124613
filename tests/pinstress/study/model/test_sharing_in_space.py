"""Redundant joints in space share by the stated stiffness of links; rows have the range over links
of which none is stated.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import pinstress
from pinstress import load_study
from pinstress.analysis.plan import all_loads
from pinstress.study.model.cases import CaseLoads
from pinstress.study.reading.errors import InputError
from tests.support.each import each

# Two arms that stand on the ground, parallel hinges, and a beam that is pushed along them.
ARMS = """
title = "A beam on two arms"
units = "m-N-s"
[mechanism]
dimension = 3
gravity = [0, 0, 0]
[mechanism.joint.A]
at = [-0.5, 0, 0]
axis = [0, 0, 1]
fixed_in = "ground"
connections = { A1 = "left" }
[mechanism.joint.B]
at = [0.5, 0, 0]
axis = [0, 0, 1]
fixed_in = "ground"
connections = { B1 = "right" }
[mechanism.joint.C]
at = [-0.5, 1, 0]
axis = [0, 0, 1]
fixed_in = "beam"
connections = { C1 = "left" }
[mechanism.joint.D]
at = [0.5, 1, 0]
axis = [0, 0, 1]
fixed_in = "beam"
connections = { D1 = "right" }
[mechanism.body]
left = { mass = 1 }
right = { mass = 1 }
beam = { mass = 1 }
[mechanism.drive]
joint = "A"
[case.push]
kind = "static"
[[case.push.apply]]
body = "beam"
at = [AT, 1, 0]
force = [0, 0, 100]
"""  # fmt: skip
RIGID = "[mechanism.link_stiffness.beam]\nrigid = true\n"


def _loads(folder: Path, more: str = "", at: float = 0.0, arms: str = ARMS) -> CaseLoads:
    path = folder / "arms.toml"
    path.write_text(arms.replace("AT", repr(at)) + more, encoding="utf-8")
    return all_loads(load_study(path), ["push"])["push"]


def _arms(left: str, right: str) -> str:
    arms = zip(("left", "right"), (left, right), strict=True)
    return RIGID + "".join(f"[mechanism.link_stiffness.{n}]\n{text}\n" for n, text in arms)


@each(
    ("left", "right", "ratio"),
    [
        ("diameter = 0.05", "diameter = 0.05", 1.0),
        ("diameter = 0.05", "diameter = 0.05\nyoungs_modulus = 840e9", 4.0),
        ("stiffness = 1e5", "stiffness = 3e5", 3.0),
        # Torsion, of the same square or depth, is alike in both, and does not enter.
        ("section = [0.02, 0.06]\ndepth_along = [1, 0, 0]",
         "section = [0.06, 0.02]\ndepth_along = [0, 0, 3]", 1.0),
        ("section = [0.02, 0.06]\ndepth_along = [0, 0, 1]",
         "section = [0.06, 0.02]\ndepth_along = [0, 0, 1]", 9.0),
    ],
)  # fmt: skip
def test_two_arms_share_by_their_stated_stiffness(
    tmp_path: Path, left: str, right: str, ratio: float
) -> None:
    """Pushed where it does not turn, a rigid beam gives both arms the same displacement and slope,
    so their forces are as their stiffness along z.
    """
    x = 0.5 * (ratio - 1.0) / (ratio + 1.0)
    found = _loads(tmp_path, _arms(left, right), x)
    assert found.reactions.force("A1")[0, 2] == pytest.approx(100.0 / (1.0 + ratio), rel=1e-6)
    assert found.reactions.force("B1")[0, 2] == pytest.approx(
        100.0 * ratio / (1.0 + ratio), rel=1e-6
    )
    assert not found.shared  # all is stated


def test_a_stated_stiffness_is_that_of_a_round_bar(tmp_path: Path) -> None:
    """Of an arm of 1 m, held at its middle: 3 E I / (0.5 m)^3."""
    bar = 3.0 * 210e9 * np.pi / 64.0 * 0.05**4 / 0.5**3
    one, other = (
        _loads(tmp_path, _arms(left, "diameter = 0.06"), 0.2).reactions
        for left in ("diameter = 0.05", f"stiffness = {bar}")
    )
    assert other.forces == pytest.approx(one.forces, abs=1e-9)
    assert other.moments == pytest.approx(one.moments, abs=1e-9)


def test_a_bar_is_as_stiff_as_its_section(tmp_path: Path) -> None:
    """An arm of twice the diameter carries 16 times the load."""
    bars = (
        "left = { mass = 1 }",
        'left = { bar = { joints = ["A", "C"], diameter = 0.05, density = 7850 } }',
        "right = { mass = 1 }",
        'right = { bar = { joints = ["B", "D"], diameter = 0.1, density = 7850 } }',
    )
    text = ARMS.replace(*bars[:2]).replace(*bars[2:]).replace("AT", repr(0.5 * 15 / 17)) + RIGID
    path = tmp_path / "bars.toml"
    path.write_text(text, encoding="utf-8")
    found = all_loads(load_study(path), ["push"])["push"]
    assert found.reactions.force("A1")[0, 2] == pytest.approx(100.0 / 17.0, rel=1e-6)
    assert not found.shared


def test_links_of_no_stated_stiffness_are_varied(tmp_path: Path) -> None:
    """Both arms, a tenth and ten times as stiff, and both in torsion; all carry the load."""
    found = _loads(tmp_path, RIGID)
    ways = [(name, how) for how in ("stiffer", "more flexible") for name in ("left", "right")]
    assert {f"{name} 10 times {how}" for name, how in ways} < {what for what, _ in found.shared}
    alone = [what for what, _ in found.shared if "than the rest" not in what]
    assert len(alone) == 6
    on_a = [x.reactions.force("A1")[0, 2] for _, x in found.shared]
    for _, x in found.shared:
        total = x.reactions.force("A1") + x.reactions.force("B1")
        assert total[0] == pytest.approx([0.0, 0.0, 100.0], abs=1e-6)
    assert min(on_a) < 35.0 < 65.0 < max(on_a)


def test_groups_of_links_in_space_raise_what_one_alone_does_not(tmp_path: Path) -> None:
    """Three arms, pushed at the one in the middle: the moment on A1 is a fifth larger with a stiff
    left arm and a stiff beam than with either.
    """
    third = """
[mechanism.joint.E]
at = [0.7, 0, 0]
axis = [0, 0, 1]
fixed_in = "ground"
connections = { E1 = "third" }
[mechanism.joint.F]
at = [0.7, 1, 0]
axis = [0, 0, 1]
fixed_in = "beam"
connections = { F1 = "third" }
[mechanism.body.third]
mass = 1
"""
    arms = ARMS.replace("beam = { mass = 1 }", "beam = { mass = 1, centre = [0, 1, 0] }")
    found = _loads(tmp_path, third, 0.5, arms)
    k = found.reactions.connections.index("A1")
    on_a = {what: np.linalg.norm(x.reactions.moments[0, k]) for what, x in found.shared}
    alone = max(moment for what, moment in on_a.items() if "than the rest" not in what)
    both = on_a["left, beam 10 times stiffer than the rest"]
    assert both == max(on_a.values()) > 1.15 * alone


@each(
    ("more", "words"),
    [
        ("[mechanism.link_stiffness.bem]\nrigid = true\n", "no body 'bem'"),
        ("[mechanism.link_stiffness.beam]\nsection = [0.1, 0.2]\n", "needs depth_along"),
        ("[mechanism.link_stiffness.beam]\nstiffness = 1e5\nrigid = true\n", "give one of"),
        ("[mechanism.link_stiffness.beam]\ndiameter = 0.1\ndepth_along = [0, 0, 1]\n",
         "round one has none"),
        (_arms("rigid = true", "rigid = true"), "on rigid links"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_stated_stiffness(tmp_path: Path, more: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        _loads(tmp_path, more)
    assert words in str(error.value)


PIN = """
[material.steel]
youngs_modulus = "200 GPa"
poisson_ratio = 0.3
yield_strength = "400 MPa"
[analysis]
tolerance = 0.1
required_safety_factor = 1.5
[pin.A]
material = "steel"
clamp = ["start"]
fillet = 0.002
profile = [
  { length = 0.02, diameter = 0.03 },
  { length = 0.02, diameter = 0.02, connection = "A1" },
]
"""


def test_a_row_has_the_range_over_the_stiffness_of_links(tmp_path: Path) -> None:
    path = tmp_path / "pin.toml"
    text = ARMS.replace("AT", "0").replace("force = [0, 0, 100]", "force = [500, 0, 200]")
    path.write_text(text + RIGID + PIN, encoding="utf-8")
    (row,) = pinstress.run(load_study(path)).pins
    assert row.sharing is not None
    low, high = row.sharing.max_von_mises
    assert row.max_von_mises is not None
    assert low < 0.9 * row.max_von_mises
    assert high > 1.1 * row.max_von_mises
    assert np.isfinite(row.sharing.largest_load)

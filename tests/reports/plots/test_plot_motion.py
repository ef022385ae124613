"""Plots of a motion: the linkage, its bodies, and what acts on it."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reports.data.motion import LinkageMotion
from reports.data.results import Results
from reports.plots.draw import draw
from reports.plots.loads.histories import drive_plot
from reports.plots.loads.linkage import linkage_plot
from reports.plots.loads.motion import motion_plots
from reports.plots.spec import Plot

ODD = ("$x_1^2$", "<b>&", "a.b/../c", "_hidden", "µ " + 60 * "long ")


def plots(motion: LinkageMotion, results: Results) -> dict[str, Plot]:
    found = [linkage_plot(motion, results.units), *motion_plots(motion, results.units)]
    return {plot.name: plot for plot in found}


@pytest.fixture(scope="module")
def made(results: Results) -> dict[str, Plot]:
    """The plots of the motions as they are."""
    return {name: plot for m in results.motion for name, plot in plots(m, results).items()}


def headings(plot: Plot) -> list[str]:
    return [view["title"] for view in plot.spec["vconcat"]]


def named(plot: Plot) -> list[dict[str, Any]]:
    """The rows of the names on a linkage."""
    parts = [part["data"]["values"] for part in plot.spec["layer"]]
    return [row for rows in parts for row in rows if "px" in row]


def many(motion: LinkageMotion, number: int) -> LinkageMotion:
    """The same with many bodies that turn, each at its own speed."""
    factor = np.linspace(0.5, 2.0, number)
    turn = {
        name: getattr(motion, name)[:, :1] * factor
        for name in ("angle", "angular_velocity", "angular_acceleration")
    }
    return replace(
        motion,
        bodies=tuple(f"body {k}" for k in range(number)),
        links=(("O", "A"),) * number,
        **turn,
    )


def test_one_scale_in_both_directions(made: dict[str, Plot]) -> None:
    for case in ("retract", "landing"):
        spec = made[f"linkage.{case}"].spec
        spans = [np.ptp(spec["encoding"][axis]["scale"]["domain"]) for axis in "xy"]
        assert spans[0] / spec["width"] == pytest.approx(spans[1] / spec["height"])


def test_positions_paths_and_names(results: Results, made: dict[str, Plot]) -> None:
    plot, motion = made["linkage.retract"], results.motion[0]
    assert {row["name"] for row in named(plot)} == {*"OABQR", "crank", "coupler", "rocker"}
    text = json.dumps(plot.spec)
    assert "start, t = 0 s" in text
    assert "end, t = 4 s" in text
    rows = [row for part in plot.spec["layer"] for row in part["data"]["values"]]
    path = [(row["x"], row["y"]) for row in rows if row.get("key") == "path" and row["of"] == "A"]
    assert np.array(path) == pytest.approx(motion.joint_position[:, 1], rel=1e-5, abs=1e-9)


def test_names_stay_in_the_picture(made: dict[str, Plot]) -> None:
    spec = made["linkage.retract"].spec
    for row in named(made["linkage.retract"]):
        assert 0.0 < row["px"] < spec["width"]
        assert 0.0 < row["py"] < spec["height"]


def test_a_full_turn_is_drawn_once(results: Results) -> None:
    motion = results.motion[0]
    there = motion.joint_position
    back = np.concatenate([there[::2], there[-3::-2]])
    text = json.dumps(plots(replace(motion, joint_position=back), results)["linkage.retract"].spec)
    assert "start, t = 0 s, and end, t = 4 s" in text


def test_one_instant_gives_one_plot(made: dict[str, Plot]) -> None:
    assert [name for name in made if name.endswith("landing")] == ["linkage.landing"]
    assert "start" not in json.dumps(made["linkage.landing"].spec)


def test_only_bodies_that_turn_are_drawn(made: dict[str, Plot]) -> None:
    plot = made["bodies.retract"]
    assert plot.caption == "retract: rotating bodies; not rotating: coupler, roller"
    unit = "angular velocity [rad/s]"
    assert headings(plot) == ["angle [deg]", unit, "angular acceleration [rad/s²]"]
    # Crank and rocker turn as one.
    assert f"crank, rocker, {unit}" in plot.spec["usermeta"]["columns"]


def test_many_bodies_take_several_plots(results: Results) -> None:
    found = plots(many(results.motion[0], 16), results)
    names = [name for name in found if name.startswith("bodies")]
    assert names == ["bodies.retract", "bodies-2.retract", "bodies-3.retract"]
    assert "rotating bodies, 3 of 3" in found["bodies-3.retract"].caption
    assert "body 15, angle [deg]" in found["bodies-3.retract"].spec["usermeta"]["columns"]


def test_guidance_and_condition(made: dict[str, Plot]) -> None:
    plot = made["transmission.retract"]
    assert "below 40 deg" in plot.caption
    angles, condition = plot.spec["vconcat"]
    assert {"datum": 40.0, "type": "quantitative"} in [
        part.get("encoding", {}).get("y") for part in angles["layer"]
    ]
    assert '"type": "log"' in json.dumps(condition)


def test_dead_points_and_no_angles_are_drawn(results: Results, tmp_path: Path) -> None:
    motion = results.motion[0]
    none = np.full_like(motion.condition, np.nan)
    dead = motion.condition.copy()
    dead[10] = np.inf
    odd = [
        replace(motion, transmission={"rod": none}, condition=dead),
        replace(motion, transmission={}, condition=none),
        replace(motion, condition=1e9 * motion.condition),
    ]
    found = [plots(m, results)["transmission.retract"] for m in odd]
    assert [len(plot.spec["vconcat"]) for plot in found] == [1, 1, 2]
    assert len(draw([replace(p, name=str(k)) for k, p in enumerate(found)], tmp_path)) == 6


def test_shaking_names_its_joint(made: dict[str, Plot]) -> None:
    assert headings(made["shaking.retract"]) == ["force [lbf]", "moment about O [lbf·in]"]


def test_ledger_shows_what_acts(made: dict[str, Plot]) -> None:
    plot = made["ledger.retract"]
    assert "1.2×10⁻¹⁵" in plot.caption
    shown = plot.spec["usermeta"]["columns"]
    assert {"drives, power [lbf·in/s]", "gravity, power [lbf·in/s]"} <= set(shown)
    assert not any("friction" in name for name in shown)


def test_nothing_moves_and_odd_names(results: Results, tmp_path: Path) -> None:
    motion = results.motion[0]
    still = {
        name: np.zeros_like(getattr(motion, name))
        for name in ("angular_velocity", "angular_acceleration", "condition", "shaking_force")
    }
    names = dict(zip(motion.joints, ODD, strict=True))
    ledger = replace(
        motion.ledger, drives=still["condition"], gravity=still["condition"],
        kinetic_rate=still["condition"], violation=0.0,
    )  # fmt: skip
    odd = replace(
        motion,
        case="../$odd<.case",
        bodies=ODD[:4],
        joints=ODD,
        ground=ODD[:1],
        links=tuple(tuple(names[j] for j in link) for link in motion.links),
        transmission={ODD[4]: motion.transmission["coupler at B"]},
        shaking_about=ODD[4],
    )
    for m in (odd, replace(odd, **still, ledger=ledger)):
        paths = draw(plots(m, results).values(), tmp_path)
        assert all(path.parent == tmp_path and path.exists() for path in paths)
        assert all(re.fullmatch(r"[\w%.-]+", path.name) for path in paths)


def test_a_rotary_drive_has_angle_and_torque(results: Results) -> None:
    (slider,) = results.drive
    rotary = replace(slider, name="crank", kind="rotary")
    made = [
        drive_plot(drive, results.units)
        for drive in (slider, replace(slider, name="second"), rotary)
    ]
    assert [p.name for p in made] == [
        *("drive.retract", "drive.retract.second", "drive.retract.crank")
    ]
    assert headings(made[2])[:2] == ["angle [deg]", "torque [lbf·in]"]
    shown = made[2].spec["usermeta"]["columns"]
    assert {f"{n}, torque [lbf·in]" for n in ("torque", "mean 900.0", "RMS 943.4")} <= set(shown)
    assert headings(made[0])[:2] == ["position [in]", "force [lbf]"]


def test_springs_are_drawn_from_end_to_end(results: Results) -> None:
    motion = results.motion[0]
    a = motion.joint_position[:, motion.joints.index("A")]
    foot = np.broadcast_to([-30.0, 40.0], a.shape)
    springs = {"rope": np.stack([foot, a], axis=1)}
    spec = plots(replace(motion, springs=springs), results)["linkage.retract"].spec
    rows = [row for part in spec["layer"] for row in part["data"]["values"]]
    for k, of in ((0, "0.spring rope"), (-1, f"{len(a) - 1}.spring rope")):
        x, y = zip(*((row["x"], row["y"]) for row in rows if row.get("of") == of), strict=True)
        assert (x[0], y[0]) == (-30.0, 40.0)
        assert (x[-1], y[-1]) == pytest.approx(a[k])
    low, high = spec["encoding"]["x"]["scale"]["domain"]
    assert low < -30.0 < high


def test_no_name_lies_on_a_slider(results: Results) -> None:
    """That of a cylinder's foot lay on the cylinder and its support."""
    motion = results.motion[0]
    foot = motion.joint_position[:, motion.joints.index("Q")]
    bare = place_of_name(motion, "Q", results)
    slides = {"jack": np.stack([foot, foot + 3.0 * (bare - foot[0])], axis=1)}
    placed = place_of_name(replace(motion, slides=slides), "Q", results)
    assert np.linalg.norm(placed - bare) > 0.5 * np.linalg.norm(bare - foot[0])


def place_of_name(motion: LinkageMotion, name: str, results: Results) -> np.ndarray:
    """The middle (2,) of a joint's name, in the study's unit."""
    plot = plots(motion, results)[f"linkage.{motion.case}"]
    (row,) = (row for row in named(plot) if row["name"] == name)
    (x0, x1), (y0, y1) = (plot.spec["encoding"][axis]["scale"]["domain"] for axis in "xy")
    x, y = row["px"] / plot.spec["width"], 1.0 - row["py"] / plot.spec["height"]
    return np.array([x0 + x * (x1 - x0), y0 + y * (y1 - y0)])

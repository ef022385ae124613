from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from reports.data.results import LinkageMotion, Results
from reports.format import style
from reports.plots import curves as plot_curves
from reports.plots import drive as plot_drive
from reports.plots import linkage as plot_linkage
from reports.plots import motion as plot_motion
from reports.plots.reactions import along

ODD = ("$x_1^2$", "<b>&", "a.b/../c", "_hidden", "µ " + 60 * "long ")


@pytest.fixture
def seen(monkeypatch: pytest.MonkeyPatch) -> dict[str, Figure]:
    """The figures by name, kept instead of written."""
    return keep_figures(monkeypatch)


@pytest.fixture(scope="module")
def drawn(results: Results) -> dict[str, Figure]:
    """The figures of the motions as they are."""
    with pytest.MonkeyPatch.context() as patch:
        figures = keep_figures(patch)
        for motion in results.motion:
            draw(motion, results)
    return figures


def keep_figures(monkeypatch: pytest.MonkeyPatch) -> dict[str, Figure]:
    figures: dict[str, Figure] = {}

    def keep(figure: Figure, directory: Path, name: str) -> list[Path]:
        figures[name] = figure
        return [directory / (name + ".svg")]

    for module in (plot_drive, plot_linkage, plot_motion):
        monkeypatch.setattr(module, "save", keep)
    return figures


def texts(figure: Figure) -> list[str]:
    found = [figure.get_suptitle()]
    for axes in figure.axes:
        found += [axes.get_xlabel(), axes.get_ylabel(), axes.get_title(loc="left")]
        found += [t.get_text() for t in axes.texts]
    for legend in figure.legends:
        found += [t.get_text() for t in legend.get_texts()]
    return found


def draw(motion: LinkageMotion, results: Results) -> list[Path]:
    nowhere = Path()
    paths = plot_linkage.linkage_plot(motion, results.units, nowhere)
    return paths + plot_motion.motion_plots(motion, results.units, nowhere)


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


def test_positions_paths_and_names(drawn: dict[str, Figure]) -> None:
    figure = drawn["linkage.retract"]
    found = texts(figure)
    assert [found.count(name) for name in "OABQR"] == [1, 2, 2, 1, 2]
    assert {"x [in]", "y [in]", "start, t = 0 s", "end, t = 4 s", "path of a joint"} <= set(found)
    assert {"slider", "ground joint", "crank", "coupler", "rocker"} <= set(found)
    (axes,) = figure.axes
    assert axes.get_aspect() == 1.0


def test_names_hide_no_name_and_stay_in_the_axes(
    results: Results, drawn: dict[str, Figure]
) -> None:
    for motion in results.motion:
        (axes,) = drawn[f"linkage.{motion.case}"].axes
        boxes = [text.get_window_extent() for text in axes.texts]
        frame = axes.get_window_extent()
        for i, box in enumerate(boxes):
            assert frame.x0 <= box.x0 < box.x1 <= frame.x1
            assert frame.y0 <= box.y0 < box.y1 <= frame.y1
            assert not any(box.overlaps(other) for other in boxes[:i])


def test_a_full_turn_is_drawn_once(results: Results, seen: dict[str, Figure]) -> None:
    motion = results.motion[0]
    there = motion.joint_position
    back = np.concatenate([there[::2], there[-3::-2]])
    draw(replace(motion, joint_position=back), results)
    found = texts(seen["linkage.retract"])
    assert "start, t = 0 s, and end, t = 4 s" in found
    assert found.count("A") == 1


def test_one_instant_gives_one_figure(drawn: dict[str, Figure]) -> None:
    assert [name for name in drawn if name.endswith("landing")] == ["linkage.landing"]
    assert "start" not in " ".join(texts(drawn["linkage.landing"]))


def test_only_bodies_that_turn_are_drawn(drawn: dict[str, Figure]) -> None:
    found = texts(drawn["bodies.retract"])
    assert found[0] == "retract: rotating bodies\n(not rotating: coupler, roller)"
    # Crank and rocker turn as one.
    assert found.count("crank, rocker") == 3
    assert {"angle [deg]", "angular velocity\n[rad/s]", "time [s]"} <= set(found)


def test_many_bodies_take_several_figures(results: Results, seen: dict[str, Figure]) -> None:
    draw(many(results.motion[0], 16), results)
    names = [name for name in seen if name.startswith("bodies")]
    assert names == ["bodies.retract", "bodies-2.retract", "bodies-3.retract"]
    assert "rotating bodies, 3 of 3" in texts(seen["bodies-3.retract"])[0]
    assert texts(seen["bodies-3.retract"]).count("body 15") == 3


def test_guidance_and_condition(drawn: dict[str, Figure]) -> None:
    figure = drawn["transmission.retract"]
    assert "below 40 deg" in figure.get_suptitle()
    angles, condition = figure.axes
    assert any(np.all(line.get_ydata() == 40.0) for line in angles.lines)
    assert condition.get_yscale() == "log"


def test_dead_points_and_no_angles_are_drawn(results: Results, seen: dict[str, Figure]) -> None:
    motion = results.motion[0]
    none = np.full_like(motion.condition, np.nan)
    dead = motion.condition.copy()
    dead[10] = np.inf
    draw(replace(motion, transmission={"rod": none}, condition=dead), results)
    assert len(seen["transmission.retract"].axes) == 1
    draw(replace(motion, transmission={}, condition=none), results)
    draw(replace(motion, condition=1e9 * motion.condition), results)


def test_shaking_names_its_joint(drawn: dict[str, Figure]) -> None:
    found = texts(drawn["shaking.retract"])
    assert {"force [lbf]", "moment about O\n[lbf·in]", "Fx", "Fy"} <= set(found)


def test_ledger_shows_what_acts(drawn: dict[str, Figure]) -> None:
    found = texts(drawn["ledger.retract"])
    assert "1.2×10⁻¹⁵" in found[0]
    assert {"drives", "gravity", "sum of powers", "power [lbf·in/s]"} <= set(found)
    assert "friction" not in found


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
        paths = plot_linkage.linkage_plot(m, results.units, tmp_path)
        paths += plot_motion.motion_plots(m, results.units, tmp_path)
        assert all(path.parent == tmp_path and path.exists() for path in paths)
        assert all(re.fullmatch(r"[\w%.-]+", path.name) for path in paths)


def test_a_rotary_drive_has_angle_and_torque(results: Results, seen: dict[str, Figure]) -> None:
    (slider,) = results.drive
    rotary = replace(slider, name="crank", kind="rotary")
    for drive in (slider, replace(slider, name="second"), rotary):
        plot_drive.drive_plot(drive, results.units, Path())
    assert list(seen) == ["drive.retract", "drive.retract.second", "drive.retract.crank"]
    found = set(texts(seen["drive.retract.crank"]))
    assert {"angle [deg]", "torque [lbf·in]", "torque", "mean 900.0", "RMS 943.4"} <= found
    assert {"position [in]", "force [lbf]"} <= set(texts(seen["drive.retract"]))


def test_reactions_are_drawn_against_what_the_drive_has(results: Results) -> None:
    table = results.reactions[0]
    assert along(table, results.units)[1] == "drive position [in]"
    turned = replace(table, position_unit="deg")
    assert along(turned, results.units)[1] == "drive position [deg]"


def test_long_names_are_clipped() -> None:
    assert style.clipped("crank") == "crank"
    assert style.clipped(30 * "x") == 23 * "x" + "…"


def test_curves_that_coincide_share_a_label(results: Results, seen: dict[str, Figure]) -> None:
    time = np.linspace(0.0, 1.0, 5)
    with style.panels(1) as (_, (axes,)):
        plot_curves.curves(axes, time, {"a": time, "b": time + 1e-9, "c": 2.0 * time})
        assert [line.get_label() for line in axes.lines[:2]] == ["a, b", "c"]

"""Plots as Vega-Lite specifications: what they show is what was found; drawn into files."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from pinbase.dimensions import Floats
from reports.data.results import Results
from reports.plots import spec as parts
from reports.plots.all import all_plots
from reports.plots.draw import draw
from reports.plots.loads import linkage
from reports.plots.loads.reactions import along, bars, reaction_plot
from reports.plots.spec import Abscissa, Panel, Plot, Spec, clipped, curves, still
from reports.plots.stress.refinement import pin_refinement_plot
from reports.plots.theme import (
    SERIES_COLOURS,
    SERIES_DASHES,
    THEME_COLOURS,
    dashes,
    on_page,
    on_paper,
)
from tests.support.results.made_up_run import ranged
from tests.support.results.rows import with_landing, with_values

DIGITS = 1e-5  # relative: six are written


@pytest.fixture(scope="module")
def plots(results: Results) -> dict[str, Plot]:
    results = with_landing(results, ranged("A"), ranged("B", "singular", 2.0))
    return all_plots(results)


def columns(plot: Spec) -> dict[str, Floats]:
    """The data of a plot by heading."""
    rows = list(csv.reader(plot["data"]["values"].split("\n")))[1:]
    values = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows])
    return dict(zip(plot["usermeta"]["columns"], values.T, strict=True))


def inside(plot: Any) -> Iterator[Spec]:
    """All objects within a specification."""
    if isinstance(plot, dict):
        yield plot
    for part in plot.values() if isinstance(plot, dict) else plot if isinstance(plot, list) else ():
        yield from inside(part)


def _kind(part: Spec) -> object:
    mark = part.get("mark")
    return mark.get("type") if isinstance(mark, dict) else None


def test_there_is_a_plot_of_everything(plots: dict[str, Plot]) -> None:
    pins = "ABCDEFGHJ"
    assert set(plots) == {
        *(f"reactions.retract.{pin}" for pin in pins),
        *("reactions.landing", "drive.retract", "linkage.retract", "linkage.landing"),
        *("bodies.retract", "transmission.retract", "shaking.retract", "ledger.retract"),
        "landing-range.landing",
        *("beam-diagrams", "beam-stress", "motion-check", "refinement.retract"),
        *("refinement.landing", *(f"refinement-pin.{pin}" for pin in pins)),
    }
    assert all(name == plot.name and plot.caption for name, plot in plots.items())


def test_specifications_are_plain_and_ask_for_nothing(plots: dict[str, Plot]) -> None:
    for plot in plots.values():
        json.dumps(plot.spec, allow_nan=False)
        assert not any("url" in part for part in inside(plot.spec))
        assert {"data", "usermeta", "title"} <= set(plot.spec)


def test_reactions_are_those_of_the_table(results: Results, plots: dict[str, Plot]) -> None:
    table = results.reactions[0]
    found = columns(plots["reactions.retract.B"].spec)
    members = [c for c, pin in enumerate(table.pins) if pin == "B"]
    assert found["drive position [in]"] == pytest.approx(table.position, rel=DIGITS)
    for k, name in enumerate(("drag brace B", "strut B (shared)")):
        size, fx, mz = (found[f"{name}, {q}"] for q in ("force [lbf]", "Fx [lbf]", "Mz [lbf·in]"))
        assert size == pytest.approx(table.magnitudes[:, members[k]], rel=DIGITS)
        assert fx == pytest.approx(table.forces[:, members[k], 0], rel=DIGITS, abs=1e-9)
        assert mz == pytest.approx(table.moments[:, members[k], 2], rel=DIGITS, abs=1e-9)
    assert not any("Fz" in heading for heading in found)  # zero


def test_largest_forces_and_the_governing_instant_are_marked(results: Results) -> None:
    table = results.reactions[0]
    plot = reaction_plot(table, "A", results.units, governs=2.5)
    marks = [part for part in inside(plot.spec) if _kind(part) == "point"]
    peaks = marks[0]["data"]["values"]
    expected = [peak.force for peak in table.largest[:2]]
    assert [row["y"] for row in peaks] == pytest.approx(expected, rel=DIGITS)
    lines = [p for p in inside(plot.spec) if p.get("data", {}).get("values") == [{"x": 2.5}]]
    assert len(lines) == len(plot.spec["vconcat"])


def test_bars_have_their_published_values(results: Results, plots: dict[str, Plot]) -> None:
    table = results.reactions[1]
    rows = plots["reactions.landing"].spec["data"]["values"]
    sizes = [peak.force for peak in table.largest]
    assert [row["force"] for row in rows] == pytest.approx(sizes, rel=DIGITS)
    assert {r["name"]: r["published"] for r in rows if r["published"]} == table.published
    zero = replace(table, forces=np.zeros_like(table.forces), published={}, peaks=())
    assert "type" not in bars(zero, results.units).spec["encoding"]["x"]["scale"]


def test_refinement_is_the_deviation_from_the_finest_mesh(results: Results) -> None:
    pin = results.pins[3]
    plot = pin_refinement_plot("D", [pin], results.units)
    rows = plot.spec["data"]["values"]
    last = pin.history[-1].max_von_mises
    expected = [100.0 * (step.max_von_mises / last - 1.0) for step in pin.history]
    assert [row["y"] for row in rows] == pytest.approx(expected, rel=DIGITS, abs=1e-12)
    assert rows[-1]["y"] == 0.0
    assert {row["row"] for row in rows} == {"retract, unconverged"}
    assert len(plot.spec["vconcat"]) == 1  # no strain energy


def test_refinement_has_the_strain_energy(results: Results) -> None:
    pin = results.pins[3]
    steps = [
        replace(s, strain_energy=e) for s, e in zip(pin.history, (9.0, 9.9, 10.0), strict=True)
    ]
    spec = pin_refinement_plot("D", [with_values(pin, history=tuple(steps))], results.units).spec
    rows = spec["data"]["values"]
    assert [row["e"] for row in rows] == pytest.approx([-10.0, -1.0, 0.0], rel=DIGITS)
    assert len(spec["vconcat"]) == 2
    assert len(spec["usermeta"]["columns"]) == len(rows[0])


def test_the_beam_check_has_its_curves(results: Results, plots: dict[str, Plot]) -> None:
    check = results.beam_check
    assert check is not None
    found = columns(plots["beam-stress"].spec)
    stress = "axial stress, tension side [psi]"
    assert found[f"beam theory, {stress}"] == pytest.approx(check.beam_axial_stress, rel=DIGITS)
    assert "is cut off" in plots["beam-stress"].caption
    shear = columns(plots["beam-diagrams"].spec)["shear [lbf]"]
    assert shear == pytest.approx(check.shear, rel=DIGITS, abs=1e-9)


def test_curves_that_coincide_share_a_name() -> None:
    x = np.linspace(0.0, 1.0, 5)
    panel = Panel("y", {"a": x, "b": x + 1e-9, "c": 2.0 * x, "none": np.full(5, np.nan)})
    found = curves("t", Abscissa("x", x), [panel])
    assert found["usermeta"]["columns"] == ["x", "a, b, y", "c, y"]
    other = Panel("z", {"a": x, "b": -x, "c": x, "none": x})
    several = curves("t", Abscissa("x", x), [panel, other], common=True)
    assert several["usermeta"]["columns"][1:5] == ["a, y", "b, y", "c, y", "none, y"]
    assert columns(several)["none, y"].tolist() != columns(several)["none, z"].tolist()


def test_gaps_are_empty_cells() -> None:
    made = parts.table({"x": np.array([1.0, 2.0]), "y": np.array([np.nan, 1 / 3])})
    assert made["values"] == "x,y\n1,\n2,0.333333"


def test_reactions_are_drawn_against_what_the_drive_has(results: Results) -> None:
    table = results.reactions[0]
    assert along(table, results.units).heading == "drive position [in]"
    assert along(replace(table, position_unit="deg"), results.units).heading == (
        "drive position [deg]"
    )
    assert along(replace(table, position=None), results.units).heading == "time [s]"


def test_no_two_curves_look_alike() -> None:
    looks = [
        (SERIES_COLOURS[k % len(SERIES_COLOURS)], str(dash)) for k, dash in enumerate(dashes(49))
    ]
    assert len(set(looks)) == 49
    assert len(SERIES_DASHES) == len(SERIES_COLOURS)


def test_paper_and_page_differ_in_colours_alone() -> None:
    light = {name: colour for name, (colour, _) in THEME_COLOURS.items()}
    page = json.dumps(on_page()["style"])
    for name, colour in light.items():
        page = page.replace(f'"var(--{name})"', f'"{colour}"')
    assert json.loads(page) == on_paper()["style"]


def test_stills_have_nothing_for_a_pointer(plots: dict[str, Plot]) -> None:
    moving = plots["drive.retract"].spec
    assert any("params" in part for part in inside(moving))
    assert not any("params" in part for part in inside(still(moving)))


def test_long_names_are_clipped() -> None:
    assert clipped("crank") == "crank"
    assert clipped(30 * "x") == 23 * "x" + "…"


def test_names_that_begin_alike_stay_apart() -> None:
    """Of two curves with the same first 47 letters the first was not drawn."""
    one, other = (f"{50 * 'x'} {end}" for end in "ab")
    x = np.linspace(0.0, 1.0, 5)
    found = curves("t", Abscissa("x", x), [Panel("y", {one: x, other: -x, 60 * "z": 2.0 * x})])
    assert found["usermeta"]["columns"][1:3] == [f"{one}, y", f"{other}, y"]
    assert found["usermeta"]["columns"][3] == f"{47 * 'z'}…, y"


def test_files_are_the_same_bytes_on_every_run(plots: dict[str, Plot], tmp_path: Path) -> None:
    some = [plots[name] for name in ("motion-check", "linkage.landing")]
    first, again = draw(some, tmp_path / "a"), draw(some, tmp_path / "b")
    assert [p.name for p in first] == [f"{p.name}{e}" for p in some for e in (".svg", ".png")]
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in again]
    for path in first:
        if path.suffix == ".svg":
            assert ElementTree.parse(path).getroot().tag.endswith("svg")
        else:
            assert path.read_bytes().startswith(b"\x89PNG")


def test_odd_names_and_zero_forces_are_drawn(results: Results, tmp_path: Path) -> None:
    moving, static = results.reactions
    odd = replace(
        moving,
        case="$x_1",
        position=None,
        connections=('a/b "$ \\', "<b>.[0]"),
        bodies=moving.bodies[:2],
        pins=("../P", "../P"),
        forces=np.zeros((201, 2, 3)),
        moments=np.zeros((201, 2, 3)),
    )
    zero = replace(static, case="zero", forces=np.zeros_like(static.forces), published={})
    found = all_plots(Results("t", "s", "0", results.units, None, 0.1, (), reactions=(odd, zero)))
    paths = draw(found.values(), tmp_path)
    assert len(paths) == 4
    assert all(path.parent == tmp_path and path.exists() for path in paths)


def test_many_points_are_drawn_where_curves_bend() -> None:
    """Straight lines between the points drawn pass all others, also of a curve that goes back and
    forth, jumps, or has gaps.
    """
    t = np.linspace(0.0, 1.0, 20_001)
    exact = {
        "x": np.sin(12.0 * t),
        "time, s": t,
        "wave, y": 10.0 * np.sin(40.0 * t) * np.exp(-3.0 * t),
        "jump, y": np.where(t < 0.3, 1.0, 2.0),
        "gap, y": np.where((t > 0.5) & (t < 0.6), np.nan, t**2),
        "condition, c": 10.0 ** (2.0 + np.sin(9.0 * t)),
    }
    panels = [
        Panel("s", {"time": t}),
        Panel("y", {key: exact[f"{key}, y"] for key in ("wave", "jump", "gap")}),
        Panel("c", {"condition": exact["condition, c"]}, scale={"type": "log"}),
    ]
    drawn = columns(curves("t", Abscissa("x", exact["x"]), panels))
    at = np.rint(drawn["time, s"] * 20_000).astype(int)
    assert len(at) < 1500
    for heading, values in exact.items():
        some = drawn[heading]
        if heading == "condition, c":
            some, values = np.log10(some), np.log10(values)
        between = np.interp(np.arange(20_001), at, some)
        assert np.array_equal(np.isnan(between), np.isnan(values))
        assert np.nanmax(np.abs(between - values)) < 6e-4 * (18.0 if heading[-1] == "y" else 2.0)


def test_a_path_of_many_instants_keeps_its_shape() -> None:
    """A joint that runs five times round a circle, and stops."""
    turn = 10.0 * np.pi * np.minimum(np.linspace(0.0, 1.5, 20_001), 1.0)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    path = linkage._path(circle, 2e-4)
    assert len(path) < 1500
    assert np.array_equal(path[[0, -1]], circle[[0, -1]])
    middle = 0.5 * (path[1:] + path[:-1])
    assert np.abs(np.linalg.norm(middle, axis=1) - 1.0).max() < 6e-4
    few = circle[::20]
    assert linkage._path(few, 2e-4) is few

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reports.data.results import PinShape, Results
from reports.data.row import Units
from reports.files import write_reports
from reports.format.file_names import animation_name, plot_name
from reports.format.numbers import engineering
from reports.page.page import MAX_PINS_AT_ONCE, render, write_page
from reports.page.pin_drawing import draw_pin
from reports.page.scripts import plots_of
from reports.plots.all import all_plots
from tests.support.results.html_page import EVIL, parse
from tests.support.results.rows import with_values

LIBRARY = re.compile(r'<script type="text/plain" id="libraries">.*?</script>', re.S)
ANIMATION = '<!DOCTYPE html><p title="&lt;">moves & "turns"</p>'


@pytest.fixture(scope="module")
def small(results: Results) -> Results:
    """Few plots, so that tests are quick."""
    return replace(
        results,
        reactions=results.reactions[1:],
        pins=results.pins[-9:],
        motion=results.motion[1:],
    )


@pytest.fixture(scope="module")
def written(small: Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_reports(small, tmp_path_factory.mktemp("out"))


def test_writes_everything(written: Path) -> None:
    assert written.name == "report.html"
    found = {path.name for path in written.parent.iterdir()}
    assert found >= {
        "results.json",
        "safety_factors.csv",
        "safety_factors.md",
        "reactions.csv",
        "reactions_published.csv",
        "drive.csv",
        "beam_check.csv",
        "motion_check.csv",
        "report.html",
    }


def test_page_is_self_contained(written: Path) -> None:
    page = parse(written)
    text = LIBRARY.sub("", written.read_text(encoding="utf-8"))
    assert "link" not in page.tags
    assert all(a.startswith(("data:", "#")) for a in page.addresses)  # of scripts, too
    outside = re.sub(r'xmlns=("|&#34;)http://www.w3.org/2000/svg\1', "", text)
    assert not re.search(r"https?://|url\((?!#)|@import", outside)


def test_anchors_lead_somewhere(written: Path) -> None:
    page = parse(written)
    anchors = [a[1:] for a in page.addresses if a.startswith("#")]
    assert len(anchors) > 10
    assert set(anchors) <= set(page.ids)


def specs(page: Path) -> dict[str, Any]:
    """The plots of a page by their names."""
    return {plot.name: plot.spec for plot in plots_of(page.read_text(encoding="utf-8"))}


def test_page_has_every_plot_as_it_is_drawn_into_files(small: Results, written: Path) -> None:
    expected = {name: plot.spec for name, plot in all_plots(small).items()}
    assert len(expected) == 15  # 8 of them are the refinements of single pins
    assert specs(written) == expected
    shown = re.findall(r'data-plot="([^"]+)"', written.read_text(encoding="utf-8"))
    assert sorted(shown) == sorted(expected)


def test_every_plot_is_described(written: Path) -> None:
    text = written.read_text(encoding="utf-8")
    labels = re.findall(r'<div class="drawn" role="img" aria-label="([^"]{10,})"', text)
    assert len(labels) == text.count('<figure class="plot"') > 10


def test_title_block_and_what_to_do_without_scripts(written: Path) -> None:
    text = written.read_text(encoding="utf-8")
    block = text.split('class="title-block"')[1].split("</table>")[0]
    for words in ("Nose landing gear", "ab" * 32, "Revision", "Prepared", "Checked", "Approved"):
        assert words in block
    assert "CSV files" in text.split("<noscript>")[1].split("</noscript>")[0]


def test_page_says_the_outcome(written: Path) -> None:
    text = parse(written).text
    assert "pins miss the required factor 1.5" in text
    assert "not decided" in text
    assert "0.9346" in text
    assert "ab" * 32 in text
    assert "Links are rigid." in text


def test_names_are_shown_and_not_run(small: Results, written: Path, tmp_path: Path) -> None:
    first = with_values(small.pins[0], pin=EVIL, case=EVIL, note=EVIL, held=EVIL, left_out=(EVIL,))
    table = replace(small.reactions[0], case=EVIL, note=EVIL, shared=(EVIL,))
    table = replace(table, connections=(EVIL, *table.connections[1:]), published={EVIL: 1.0})
    shape = PinShape(EVIL, ((1.0, 1.0, 0.0, EVIL, EVIL),), EVIL, None)
    odd = replace(
        small,
        title=EVIL,
        study=EVIL,
        units=Units("<i>", "<i>", "<i>", "<i>"),
        pins=(first, *small.pins[1:3]),
        shapes=(shape,),
        reactions=(table,),
        drive=(),
        beam_check=None,
        motion_check=None,
        assumptions=(EVIL,),
        published_source=EVIL,
        versions={EVIL: EVIL},
    )
    page = parse(write_reports(odd, tmp_path))
    assert page.tags.count("script") == parse(written).tags.count("script")
    assert "i" not in page.tags
    assert EVIL in page.text


def test_moments_are_shown_where_there_are_any(small: Results, tmp_path: Path) -> None:
    table = small.reactions[0]
    moments = np.zeros_like(table.forces)
    for size, shown in ((0.0, False), (987.6, True)):
        moments[-1, 0] = [0.6 * size, 0.0, -0.8 * size]
        with_moments = replace(small, reactions=(replace(table, moments=moments),))
        text = parse(write_page(with_moments, tmp_path)).text
        assert (f"moment [{small.units.force}·{small.units.length}]" in text) is shown
        assert ("987.6" in text) is shown


@pytest.fixture(scope="module")
def moving(results: Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of motions."""
    directory = tmp_path_factory.mktemp("moving")
    case = "up & 100%.down"
    motion = replace(results.motion[0], case=case)
    (directory / animation_name(case)).write_text(ANIMATION, encoding="utf-8")
    drives = tuple(replace(results.drive[0], name=name, kind="rotary") for name in ("a.b", "c"))
    table = replace(results.reactions[0], position_unit="deg")
    pins = tuple(replace(pin, position_unit="deg") for pin in results.pins)
    found = replace(results, motion=(motion,), drive=drives, reactions=(table,))
    found = replace(found, pins=pins)
    return write_page(found, directory)


def test_motions_have_a_section(moving: Path) -> None:
    page, text = parse(moving), moving.read_text(encoding="utf-8")
    assert {"motion", "motion-check", "published", "drive"} <= set(page.ids)
    assert all(page.ids.count(name) == 1 for name in ("motion", "published", "drive"))
    kinds = ("linkage", "bodies", "transmission", "shaking", "ledger")
    names = {plot_name(kind, "up & 100%.down") for kind in kinds}
    assert names | {"drive.retract.a%2Eb", "drive.retract.c"} <= set(specs(moving))
    for label in (
        "up &amp; 100%.down: the linkage from start to end, with the paths of its joints",
        "retract: angle, torque, power and energies of drive a.b",
    ):
        assert re.search(f'aria-label="[^"]*{re.escape(label)}', text)


def test_animation_is_in_the_page_where_there_is_one(
    moving: Path, small: Results, tmp_path: Path
) -> None:
    (found,) = parse(moving).within
    assert found == ANIMATION
    assert not parse(write_page(small, tmp_path)).within


def test_a_page_of_loads_opens_with_the_motion(results: Results, tmp_path: Path) -> None:
    cases = tuple(replace(results.motion[0], case=case) for case in ("first", "second"))
    (tmp_path / animation_name("first")).write_text(ANIMATION, encoding="utf-8")
    alone = replace(results, pins=(), shapes=(), surfaces=(), motion=cases)
    path = write_page(alone, tmp_path)
    text, page = path.read_text(encoding="utf-8"), parse(path)
    assert "No pin was solved" not in page.text
    assert page.within == [ANIMATION]
    before, _, after = text.partition("<iframe")
    assert "<details" not in before.split("<main")[1]  # nothing is to be opened first
    assert 'id="motion"' in before
    assert "<summary><h2>second</h2></summary>" in after
    largest = max(p.force for table in results.reactions for p in table.largest)
    assert f"Largest force: {engineering(largest)} lbf of strut on the pin at strut J" in page.text


def test_published_values_stand_beside_ours(moving: Path) -> None:
    text = " ".join(re.sub(r"<[^>]*>", " ", moving.read_text(encoding="utf-8")).split())
    assert "Comparison with published values" in text
    assert "angular velocity rocker rad/s 0.510000 0.500000 0.98039 cut" in text


def test_positions_of_a_rotary_drive_are_angles(moving: Path) -> None:
    assert re.search(r"drive position [\d.]+ deg", parse(moving).text)


def test_empty_results_make_a_page(small: Results, tmp_path: Path) -> None:
    bare = Results("t", "s.toml", "0", small.units, None, 0.02, ())
    text = parse(write_reports(bare, tmp_path)).text
    assert "No pin was solved." in text


def test_drawing_has_dimensions_and_labels(results: Results) -> None:
    svg = draw_pin(results.shapes[0], results.units)
    for text in ("drag brace A", "strut A", "⌀1.5 / 0.25", ">1.25<", "2.875 in"):
        assert text in svg


def test_a_gap_as_thick_as_its_neighbour_has_no_label(results: Results) -> None:
    """It has its length alone; a collar has its diameter."""
    bands = (1.0, 2.0, 0.0, "A", "band"), (1.0, 2.0, 0.0, "B", "band")
    gap, collar = (0.05, 2.0, 0.0, "", "plain"), (0.25, 3.0, 0.0, "", "plain")
    svg = draw_pin(PinShape("P", (bands[0], gap, bands[1], collar), "steel", None), results.units)
    assert svg.count(">⌀2<") == 2
    assert svg.count(">⌀3<") == 1
    assert ">0.05<" in svg


def test_drawing_of_nothing_is_empty(results: Results) -> None:
    assert draw_pin(PinShape("A", (), "steel", None), results.units) == ""


def test_folded_parts_of_many_pins_are_text_to_scripts(small: Results, tmp_path: Path) -> None:
    """Each in a noscript element, next to that of the message on disabled scripts."""
    first = small.pins[0]
    pins = tuple(with_values(first, pin=f"{EVIL}{k}") for k in range(MAX_PINS_AT_ONCE + 1))
    many = replace(small, pins=pins, shapes=(), surfaces=())
    page = render(many, tmp_path)
    assert page.count("<noscript>") == page.count('<details class="fold"') + 1 > MAX_PINS_AT_ONCE
    assert not re.search(r"<noscript>(?:(?!</noscript>).)*<noscript>", page, re.S)
    assert render(replace(many, pins=pins[:MAX_PINS_AT_ONCE]), tmp_path).count("<noscript>") == 1

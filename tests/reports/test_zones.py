"""Singular zones and checks by hand: the same numbers in JSON, CSV and page, all text escaped."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from html import unescape
from math import hypot
from pathlib import Path

import pytest

from reports.data.results import Results
from reports.files import write_reports
from reports.format.file_names import plot_name
from reports.format.numbers import engineering
from reports.page.pin_drawing import draw_pin
from reports.plots.all import all_plots
from reports.tables.json_results import to_json
from reports.tables.stress.singular_zones import ShownZone, circles, pin_zones
from tests.support.results.html_page import EVIL, parse
from tests.support.results.judged_results import judged, row, zones
from tests.support.results.rows import with_values


@pytest.fixture(scope="module")
def found() -> Results:
    return judged()


@pytest.fixture(scope="module")
def written(found: Results, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_reports(found, tmp_path_factory.mktemp("out"))


def read(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def cells(page: str, heading: str) -> list[list[str]]:
    """Rows of the first table after a heading."""
    body = page.split(heading, 1)[1].split("<tbody>", 1)[1].split("</tbody>", 1)[0]
    rows = re.findall(r"<tr>(.*?)</tr>", body)
    return [[unescape(c) for c in re.findall(r"<td[^>]*>(.*?)</td>", r)] for r in rows]


def test_zones_agree(found: Results, written: Path) -> None:
    rows = read(written.parent / "singular_zones.csv")
    pins = to_json(found)["pins"]
    flat = [(p, z) for p in pins for z in p["singular_at"]]
    assert len(rows) == len(flat) == 12
    for line, (p, z) in zip(rows, flat, strict=True):
        assert (line["pin"], line["case"], line["verdict"]) == (p["pin"], p["case"], p["verdict"])
        assert [float(line[k]) for k in "xyz"] == z["location"]
        assert float(line["radius"]) == hypot(*z["location"][:2])
        assert line["between"] == " / ".join(z["between"])
        for name in ("exponent", "exponent_theory", "excluded_radius", "max_von_mises"):
            assert (float(line[name]) if line[name] else None) == z[name]
        assert line["governs"] == ("yes" if z["governs"] else "no")
        assert (line["kind"], line["advice"]) == (z["kind"], z["advice"])
    # the page has four digits of the same
    page = written.read_text(encoding="utf-8").split("<h3>sharp")[1]
    clamp, corner, load = cells(page, "Stress singularities")
    z = pins[1]["singular_at"][0]
    assert corner == [
        "2", "0.2500", "0.5000", "head / drag brace A", "a sharp corner", "0.432 / 0.456",
        engineering(z["excluded_radius"]), engineering(z["max_von_mises"]), "–", "yes",
        z["advice"],
    ]  # fmt: skip
    assert (clamp[0], clamp[5], clamp[9]) == ("1", "– / 0.289", "no")
    assert (load[0], load[5]) == ("3", "– / logarithm")


def test_a_circle_has_one_number_in_all_cases(found: Results) -> None:
    by_case = pin_zones(found, "A")
    assert [[z.number for z in by_case[c]] for c in ("fine", "sharp")] == [[2, 1, 3]] * 2
    every = circles(z for case in by_case.values() for z in case)
    assert [(z.number, z.place.governs) for z in every] == [(1, False), (2, True), (3, False)]


def test_hand_checks_agree(found: Results, written: Path) -> None:
    rows = read(written.parent / "hand_checks.csv")
    flat = [(p, c) for p in to_json(found)["pins"] for c in p["hand_checks"]]
    assert len(rows) == len(flat) == 9
    for line, (p, c) in zip(rows, flat, strict=True):
        for name in ("time", "stress", "strength", "factor"):
            assert (float(line[name]) if line[name] else None) == c[name]
        assert [line[k] for k in ("check", "at", "formula", "source")] == [
            c[k] for k in ("name", "at", "formula", "source")
        ]
        assert (float(line["safety_factor"]), line["verdict"]) == (p["safety_factor"], p["verdict"])
    page = written.read_text(encoding="utf-8").split("<h3>weak")[1]
    model, shear, bending, bearing = cells(page, "Hand checks")
    assert model[0] == "harmonic model, maximum von Mises stress, outside the excluded zones"
    assert model[5] == "1.25 (singular)"
    assert shear[:6] == ["single shear, mean", "gap", "2", "1,235", "68,130", "55.18"]
    assert bending[5] == bearing[4] == bearing[5] == "–"
    text = (written.parent / "hand_checks.md").read_text(encoding="utf-8")
    for cell in ("## A, weak", "1.25 (singular)", "68,130", "V / A"):
        assert cell in text


def test_page_says_what_singular_is(written: Path) -> None:
    page = parse(written)
    text = " ".join(page.text.split())
    assert "Maximum von Mises stress outside the excluded zones 47,200 psi" in text
    assert "Safety factor 2.50 (singular)." in text
    assert "Safety factor 0.800 (singular, beyond yield)." in text
    pins = text.split("How to read the pins")[1].split("How to read the table")[0]  # once for all
    assert pins.count("linear elasticity is not valid and") == 1
    assert pins.count("the stress has no maximum") == 1
    assert "harmonic: a beam is never known to 2.0%" in text
    assert "the largest stress grows without bound" in text


def test_no_factor_without_its_verdict(written: Path) -> None:
    """Everywhere on the page: in a sentence in brackets behind it, in a table in its row."""
    text = " ".join(parse(written).text.split())
    assert re.findall(r"[Ss]afety factor [\d.,]++(?! \()", text) == []
    page = written.read_text(encoding="utf-8")
    head = re.search(r'id="factors".*?</thead>', page, re.S)
    assert head is not None
    assert head.group().index(">result<") < head.group().index(">safety factor")
    assert page.count("</span> (singular)") + page.count("</span>: singular") > 0


def test_refinement_plot_of_the_pin(found: Results) -> None:
    assert plot_name("refinement-pin", "A") in all_plots(found)
    single = replace(found, pins=tuple(with_values(p, history=p.history[:1]) for p in found.pins))
    beam = replace(single, pins=(with_values(single.pins[0], history=()), *single.pins[1:]))
    assert not any(name.startswith("refinement") for name in all_plots(beam))


def test_page_shows_the_refinement_of_the_pin(written: Path) -> None:
    text = written.read_text(encoding="utf-8")
    assert text.count('data-plot="refinement-pin.A"') == 1


def test_drawing_marks_the_zones(found: Results) -> None:
    all_zones = pin_zones(found, "A")["sharp"]
    svg = draw_pin(found.shapes[0], found.units, circles(all_zones))
    rings = re.findall(r'<circle class="zone" cx="([\d.]+)" cy="([\d.]+)"[^>]*fill="([^"]+)"', svg)
    assert len(rings) == 6
    for words in ("1 edge of a clamp<", "2 sharp corner, governs<", "3 edge of a load<"):
        assert words in svg
    x = [float(ring[0]) for ring in rings]
    assert x[2] - x[0] == pytest.approx((x[4] - x[0]) * 0.25 / 1.5, abs=0.02)
    # same scale across as along: the ring's distance from the axis
    y = [float(ring[1]) for ring in rings]
    assert (y[3] - y[2]) / (x[4] - x[2]) == pytest.approx(1.0 / 1.25, rel=1e-3)
    assert [ring[2] for ring in rings].count("none") == 4  # only what governs is filled
    assert "zone" not in draw_pin(found.shapes[0], found.units)


def test_drawing_stripes_what_is_excluded_of_the_walls(found: Results) -> None:
    """At a step the disc reaches into both segments; nothing outside of the section is drawn."""
    (zone,) = [z for z in circles(pin_zones(found, "A")["sharp"]) if z.number == 2]
    svg = draw_pin(found.shapes[0], found.units, [zone])
    walls = re.findall(r'<svg x="([\d.]+)" y="[\d.]+" width="([\d.]+)" height="[\d.]+">', svg)
    discs = re.findall(r'cx="(-?[\d.]+)" cy="-?[\d.]+" r="([\d.]+)" fill="url\(#excluded\)"', svg)
    assert len(discs) == len(walls) == 4
    ring = float(re.findall(r'class="zone" cx="([\d.]+)"', svg)[0])
    assert [float(x) + float(w[0]) for (x, _), w in zip(discs, walls, strict=True)] == (
        pytest.approx([ring] * 4, abs=0.02)
    )
    scale = float(walls[-1][1]) / found.shapes[0].segments[1][0]
    assert float(discs[0][1]) == pytest.approx(scale * zone.place.excluded, abs=0.02)


def test_the_edge_of_a_lug_is_drawn_like_the_others(found: Results) -> None:
    """In theory a power, and not measured."""
    lug = replace(zones()[1], kind="the edge of a lug", exponent_theory=0.226, governs=True)
    zone = ShownZone(1, lug)
    assert zone.exponents == "– / 0.226"
    assert "1 edge of a lug, governs<" in draw_pin(found.shapes[0], found.units, [zone])


def test_advice_and_names_are_shown_and_not_run(found: Results, tmp_path: Path) -> None:
    zone = replace(zones()[0], kind=EVIL, between=(EVIL, EVIL), advice=EVIL)
    check = replace(found.pins[0].hand_checks[0], method=EVIL, at=EVIL, formula=EVIL, clause=EVIL)
    made = row(EVIL, "singular", 2.0, None, singular_at=(zone,), margins=(check,), why=EVIL)
    page = write_reports(replace(found, pins=(made,)), tmp_path)
    assert EVIL not in page.read_text(encoding="utf-8")
    assert parse(page).text.count(EVIL) >= 10
    assert "<script" not in (tmp_path / "hand_checks.md").read_text(encoding="utf-8")
    formula = replace(zone, advice="=1+1")
    made = with_values(made, singular_at=(formula,))
    write_reports(replace(found, pins=(made,)), tmp_path)
    assert read(tmp_path / "singular_zones.csv")[0]["advice"] == "'=1+1"


def test_without_zones_and_checks_nothing_is_written(found: Results, tmp_path: Path) -> None:
    bare = replace(found, pins=(found.pins[-1],))
    page = write_reports(bare, tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    assert not names & {"hand_checks.csv", "hand_checks.md", "singular_zones.csv"}
    assert "Stress singularities" not in page.read_text(encoding="utf-8")

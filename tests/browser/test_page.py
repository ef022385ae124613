"""The landing gear's report as a whole."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from typing import Any

import pytest

from tests.browser.conftest import STUDIES, run
from tests.support.each import sampled
from tests.support.results.browser_page import errors, opened, screen, unfold, wait

pytestmark = pytest.mark.browser

AXE = Path(__file__).parent / "axe" / "axe.min.js"
LARGEST = 3e6  # bytes
NUMBERS = ("time", "max_von_mises", "error_estimate", "safety_factor", "utilisation")
ROWS = """
return [...document.querySelectorAll("#factors tbody tr")].map(
  (row) => [...row.cells].map((cell) => cell.dataset.value ?? cell.textContent));
"""
HEADS = 'return [...document.querySelectorAll("#factors thead th")].map((h) => h.textContent);'
BROKEN = """
return [...document.querySelectorAll('a[href^="#"]')].map((a) => a.getAttribute("href"))
  .filter((href) => !document.getElementById(decodeURIComponent(href.slice(1))));
"""
WIDER = """
return ["#factors .wide", "#factors table", "html"].filter((name) => {
  const box = document.querySelector(name);
  return box.scrollWidth > box.clientWidth + 1;
});
"""
REQUESTS = "return performance.getEntriesByType('resource').map((r) => r.name);"
FAULTS = """
const done = arguments[arguments.length - 1];
axe.run(document, { iframes: true }).then((found) => done(found.violations
  .filter((v) => ["serious", "critical"].includes(v.impact))
  .map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 200)).join(" | ")}`)));
"""


@pytest.fixture
def page(browser: Any, gear_run: Path) -> Any:
    """Opened anew, since tests change it."""
    opened(browser, gear_run)
    return browser


def column(page: Any, name: str) -> int:
    return next(k for k, head in enumerate(page.execute_script(HEADS)) if head.startswith(name))


def sort_by(page: Any, name: str) -> list[str]:
    """Click on a heading; the column's values then."""
    k = column(page, name)
    page.find_elements("css selector", "#factors thead th button")[k].click()
    return [row[k] for row in page.execute_script(ROWS)]


def test_page_is_one_file_that_asks_for_nothing(page: Any, gear_run: Path) -> None:
    assert (gear_run / "report.html").stat().st_size < LARGEST
    assert page.execute_script("return document.readyState") == "complete"
    outside = [r for r in page.execute_script(REQUESTS) if not r.startswith("data:")]
    assert outside == []
    assert errors(page) == []


def test_every_anchor_leads_somewhere(page: Any) -> None:
    assert len(page.find_elements("css selector", 'a[href^="#"]')) > 20
    assert page.execute_script(BROKEN) == []


def test_columns_sort_both_ways(page: Any) -> None:
    unfold(page)
    first = [float(v) for v in sort_by(page, "safety factor")]
    assert first == sorted(first)
    assert len(set(first)) > 10
    second = [float(v) for v in sort_by(page, "safety factor")]
    assert second == first[::-1]
    heads = page.find_elements("css selector", "#factors thead th")
    sorts = [head.get_attribute("aria-sort") for head in heads]
    assert sorts.count("descending") == 1
    assert sorts.count("none") == len(sorts) - 1
    times = sort_by(page, "time")
    assert times.index("") == sum(t != "" for t in times)  # rows without a time are the last
    assert [float(t) for t in times if t] == sorted(float(t) for t in times if t)
    assert sort_by(page, "pin") == sorted("ABCDEFGHJ" * 2)


@pytest.mark.parametrize("width", [1400, 390])
def test_the_safety_factors_fit_the_screen(page: Any, width: int) -> None:
    """All of the table on a desktop; cards on a phone."""
    with screen(page, width):
        unfold(page)
        assert page.execute_script(WIDER) == []
        rows = page.find_elements("css selector", "#factors tbody tr")
        assert len(rows) == 18
        assert all(row.is_displayed() for row in rows)


def test_the_worst_row_is_the_first(page: Any) -> None:
    """Of a range, by its upper end."""
    unfold(page)
    result, used = column(page, "result"), column(page, "utilisation")
    rows = page.execute_script(ROWS)
    order = [["fails", "not decided", "safe"].index(row[result]) for row in rows]
    assert order == sorted(order)
    written = page.execute_script(ROWS.replace("cell.dataset.value ?? ", ""))
    failing = [
        float(re.findall(r"[\d.,]+", text[used])[-1].replace(",", ""))
        for row, text in zip(rows, written, strict=True)
        if row[result] == "fails"
    ]
    assert len(failing) > 3
    assert failing == sorted(failing, reverse=True)
    header = page.find_element("css selector", "header").text
    assert f"6 of 9 pins miss the required factor 10 (landing): {rows[0][0]}, " in header


def test_page_csv_and_json_have_the_same_numbers(page: Any, gear_run: Path) -> None:
    with (gear_run / "safety_factors.csv").open(encoding="utf-8", newline="") as file:
        table = {(r["pin"], r["case"]): r for r in csv.DictReader(file)}
    found = json.loads((gear_run / "results.json").read_text(encoding="utf-8"))["pins"]
    names = {"time": "time", "max_von_mises": "max von", "error_estimate": "±"}
    names |= {"safety_factor": "safety", "utilisation": "utilisation"}
    at = {key: column(page, name) for key, name in names.items()}
    pin, case = column(page, "pin"), column(page, "case")
    rows = page.execute_script(ROWS)
    assert len(rows) == len(table) == len(found) == 18
    for row in rows:
        told = table[row[pin], row[case]]
        assert [row[at[key]] for key in NUMBERS] == [told[key] for key in NUMBERS]
    for entry in found:
        told = table[entry["pin"], entry["case"]]
        for key in ("time", "max_von_mises", "error_estimate", "safety_factor"):
            assert (float(told[key]) if told[key] else None) == entry[key]


def test_animations_are_inside(page: Any) -> None:
    unfold(page)
    frames = page.find_elements("css selector", "iframe")
    assert len(frames) == 2
    page.execute_script("arguments[0].scrollIntoView();", frames[0])
    wait(page, lambda: frames[0].get_attribute("srcdoc"))
    page.switch_to.frame(frames[0])
    try:
        wait(page, lambda: page.find_element("css selector", "#play").is_displayed())
        before = page.find_element("css selector", "#time").text
        page.find_element("css selector", "#on").click()
        assert page.find_element("css selector", "#time").text != before
    finally:
        page.switch_to.default_content()


def test_long_names_cut_off_no_column_of_forces(browser: Any, tmp_path: Path) -> None:
    """Beside the animation there is room for 28 rem; upper_brace pushed the last column out."""
    out = run(STUDIES / "main_gear.toml", tmp_path / "out", "--no-pictures", command="loads")
    browser.get((out / "animation_retract.html").as_uri())
    forces = browser.find_element("css selector", "section.numbers")
    with screen(browser, 1098):  # what it has in the page
        assert "upper_brace" in forces.text
        script = "return arguments[0].scrollWidth - arguments[0].clientWidth;"
        assert browser.execute_script(script, forces) == 0


def test_no_two_regions_have_one_name(browser: Any, tmp_path: Path) -> None:
    """With all open, on a phone: all tables of values were "Values", those of a case "landing"."""
    opened(browser, run(STUDIES / "one_pin.toml", tmp_path / "out", "--no-pictures"))
    with screen(browser, 390):
        browser.execute_script(
            "for (const d of document.querySelectorAll('details')) d.open = true;"
        )
        script = """return [...document.querySelectorAll("[role=region]")]
          .filter((e) => e.checkVisibility()).map((e) => e.getAttribute("aria-label"));"""
        wait(browser, lambda: len(browser.execute_script(script)) > 5)
        names = browser.execute_script(script)
        assert len({*names}) == len(names), names


@pytest.mark.parametrize("shade", sampled(["light", "dark"], every=2))
def test_axe_finds_nothing_serious(page: Any, shade: str) -> None:
    unfold(page)
    features = [{"name": "prefers-color-scheme", "value": shade}]
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    page.execute_script(AXE.read_text(encoding="utf-8"))
    page.set_script_timeout(120)
    found = page.execute_async_script(FAULTS)
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    assert found == []


def test_shade_can_be_changed(page: Any) -> None:
    body = page.find_element("css selector", "body")

    def paper() -> str:
        return str(body.value_of_css_property("background-color"))

    page.execute_script("scrollTo(0, 0);")
    before = paper()
    page.find_element("id", "shade").click()
    assert paper() != before
    page.find_element("id", "shade").click()
    assert paper() == before


def test_page_is_whole_without_scripts(page: Any, gear_run: Path) -> None:
    page.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        opened(page, gear_run)
        assert not page.find_elements("css selector", "th button")
        assert len(page.find_elements("css selector", "#factors tbody tr")) == 18
        assert not any(v.is_displayed() for v in page.find_elements("css selector", "[data-view]"))
        told = page.find_element("css selector", "noscript p")
        assert "CSV files" in told.get_attribute("textContent")
        (first,) = page.find_elements("css selector", "#reactions > summary")
        first.click()  # folded parts open without scripts, too
        assert page.find_element("css selector", "#reactions table").is_displayed()
        assert not page.find_element("id", "shade").is_displayed()
        assert not page.find_elements("css selector", ".drawn svg")
    finally:
        page.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})

"""The first screen of the main job answers three questions in its first 900 px, by visible text:
which pins fail and why, which diameter, and whether the error is small enough.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.browser.test_pins import WIDER
from tests.support.each import sampled
from tests.support.programs.command_line import QUICK, run_here
from tests.support.results.browser_page import errors, opened, screen

pytestmark = pytest.mark.browser

FIRST_SCREEN = 900  # px
# The text of all that lies within the first screen and can be seen, in reading order.
SEEN = """
const height = arguments[0], texts = [];
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
for (let node = walker.nextNode(); node; node = walker.nextNode()) {
  const range = document.createRange();
  range.selectNodeContents(node);
  const boxes = [...range.getClientRects()].filter((r) => r.width > 1 && r.height > 1);
  if (!boxes.length || boxes.some((r) => r.bottom > height || r.right > innerWidth)) continue;
  if (node.parentElement.checkVisibility()) texts.push(node.textContent);
}
return texts.join(" ").replace(/\\s+/g, " ");
"""
ROWS = """
return [...document.querySelectorAll("table.lines tbody tr")].map((tr) => ({
  pin: tr.querySelector("th").textContent, outcome: tr.querySelector(".outcome").textContent.trim(),
  required: parseFloat(getComputedStyle(tr.querySelector(".bar")).getPropertyValue("--required")),
  factor: parseFloat(tr.querySelector(".bar b").style.left),
  low: parseFloat(tr.querySelector(".bar i").style.left),
  bottom: tr.getBoundingClientRect().bottom,
}));
"""

# Names as drawings have them, with and without spaces.
LONG_CASE = {"case.landing": 'case."maximum braked landing, 25.493(b), aft centre of gravity"'}
LONG = (
    LONG_CASE,
    {"pin.B": 'pin."Drag brace upper attachment pin LH-3221-0047-A"'},
    {"pin.B": 'pin."Hubzylinderlagerungsbolzen_am_Ausleger_Nr_0815"', **LONG_CASE},
)
UPRIGHT = """
const head = document.querySelector(".matrix thead th:last-child");
return getComputedStyle(head).writingMode === "vertical-rl";
"""
# Texts of the table of pins that lie on a neighbour's.
OVERLAPS = """
const faults = [];
for (const tr of document.querySelectorAll("table.lines tbody tr")) {
  const rects = [...tr.children].filter((cell) => cell.textContent.trim()).map((cell) => {
    const range = document.createRange();
    range.selectNodeContents(cell);
    return range.getBoundingClientRect();
  });
  for (const [i, a] of rects.entries()) for (const b of rects.slice(i + 1))
    if (a.left < b.right - 1 && b.left < a.right - 1
      && a.top < b.bottom - 1 && b.top < a.bottom - 1)
      faults.push(tr.textContent.slice(0, 60));
}
return faults;
"""

# Numbers above the axis of factors that touch another one.
ON_AXIS = """
const spans = [...document.querySelectorAll("th.axis span[aria-hidden]")];
const boxes = spans.map((e) => e.getBoundingClientRect());
return boxes.length && boxes.some((a, i) => boxes.slice(i + 1).some(
  (b) => a.left < b.right + 2 && b.left < a.right + 2));
"""


@pytest.fixture
def page(browser: Any, shipped: Callable[[str], Path]) -> Any:
    opened(browser, shipped("landing_gear"))
    browser.execute_script("scrollTo(0, 0)")
    return browser


def test_three_questions_are_answered_in_the_first_screen(page: Any) -> None:
    with screen(page, 1400):
        text = page.execute_script(SEEN, FIRST_SCREEN)
        bottoms = page.execute_script(
            "return [...document.querySelectorAll('.note')].map("
            "(e) => e.getBoundingClientRect().bottom)"
        )
    assert len(bottoms) == 3
    assert max(bottoms) <= FIRST_SCREEN
    # Which pins fail, and why?
    assert "5 of 9 pins miss the required factor 10 (landing): E, J, A, D, G." in text
    assert "194,000 lbf goes J–E–A to the frame; others at most 35,700." in text
    assert "Shear dominates E, bending J, A, D and G." in text
    assert "surface, step beside E2" in text
    assert "Largest von Mises stress [psi]: E 195,000, J 152,000" in text
    assert "plastic bending and shear, ultimate load, landing" in text  # which J misses
    # Which diameter?
    assert "2 → 2.74" in text
    assert "would not fit lugs of 5.00 in outer diameter" in text
    assert "pinstress size landing_gear.toml --pins E,J,A,D,G" in text
    # Is the error small enough?
    assert "Error of the maxima up to 1.8 %." in text
    assert "Even G has 2.5 times the permitted stress." in text
    assert "E, J and A fail at all open values; D and G fail as described and are safe at" in text
    assert "F and H are safe as described and fail at some." in text
    assert "Measure first: force over time at landing" in text
    assert "ultimate load, not checked: rupture, 3 more need ultimate_strength; bearing" in text


def test_the_linkage_shows_each_pin_with_its_factor_and_the_load(page: Any) -> None:
    linkage = page.find_element("css selector", "svg.linkage")
    text = linkage.text.split()
    for pin, factor in (("E", "1.15"), ("J", "1.48"), ("C", "294")):
        assert text[text.index(pin) + 1] == factor
    assert "194,100" in text
    assert len(linkage.find_elements("css selector", ".pin.fails")) == 5
    assert len(linkage.find_elements("css selector", ".load")) == 1
    link = linkage.find_element("css selector", "a[href]")
    target = (link.get_dom_attribute("href") or "").partition("#")[2]
    assert page.find_element("id", target)


@pytest.mark.parametrize("width", sampled([1400, 1024, 390], every=2))
def test_bars_stand_on_their_side_of_the_requirement(page: Any, width: int) -> None:
    with screen(page, width):
        rows = page.execute_script(ROWS)
        assert page.execute_script(WIDER) == []
    assert [row["pin"] for row in rows] == list("EJADGFHBC")
    for row in rows:
        safe = row["outcome"].endswith("safe")
        assert (row["factor"] > row["required"]) is (not row["outcome"].endswith("fails"))
        assert (row["low"] > row["required"]) is safe
    if width == 390:
        assert rows[0]["bottom"] < FIRST_SCREEN
    assert errors(page) == []


@pytest.mark.parametrize("width", [1400, 1300, 1050])
def test_numbers_above_the_axis_do_not_touch(page: Any, width: int) -> None:
    """Where the columns beside it leave the axis as narrow as it may be."""
    with screen(page, width):
        assert page.execute_script(ON_AXIS) is False


def test_numbers_on_a_phone_say_what_they_are(page: Any) -> None:
    """There the table has no heads: "2 → 8.88" and "0.44 to 4.4" stood alone, and the diameters of
    pins that depend were left out.
    """
    with screen(page, 390):
        labels = page.execute_script(
            "const tr = document.querySelectorAll('table.lines tbody tr')[arguments[0]];"
            "return Object.fromEntries(['diameter', 'range', 'whatever'].map((name) => {"
            "  const cell = tr.querySelector(`.${name}`);"
            "  const shown = cell.checkVisibility() && cell.textContent.trim();"
            "  return [name, [getComputedStyle(cell, '::before').content, shown]]}));",
            5,
        )
    assert labels["diameter"][0].replace('" "', "") == '"diameter [in] "'
    assert labels["range"] == ['"open range "', "4.1 to 52"]
    assert labels["whatever"][0] == '"diameter over open range "'
    assert float(labels["whatever"][1].rstrip(" †")) > 2.0


def test_no_column_is_pushed_out(page: Any) -> None:
    """Beside a scroll bar, on 1280 px, the last column of diameters was cut off."""
    for width in (1265, 1215, 1009, 760, 320):
        with screen(page, width):
            assert not page.execute_script(WIDER), width


def test_linkage_and_requirements_share_a_narrow_screen(page: Any) -> None:
    with screen(page, 1024):
        linkage, matrix = (
            page.find_element("css selector", name).rect for name in (".machine svg", ".matrix")
        )
    assert linkage["x"] + linkage["width"] <= matrix["x"]
    assert linkage["y"] + linkage["height"] < FIRST_SCREEN


def test_the_keyboard_goes_to_the_parts_and_to_each_pin_once(page: Any) -> None:
    """There were 48 stops before the parts, 9 of them in the drawing, in no order."""
    from selenium.webdriver import ActionChains, Keys

    with screen(page, 1400):
        page.execute_script("document.activeElement.blur(); scrollTo(0, 0)")
        keys = ActionChains(page)
        keys.send_keys(Keys.TAB).perform()
        first = page.switch_to.active_element
        assert first.text == "Skip to the parts of the report"
        keys.send_keys(Keys.ENTER).perform()
        assert page.switch_to.active_element.get_dom_attribute("id") == "content"
        keys.send_keys(Keys.TAB).perform()
        inside = "return document.querySelector('main').contains(document.activeElement)"
        assert page.execute_script(inside)
        stops = page.execute_script(
            "return [...document.querySelectorAll('.first-screen a')].filter("
            "(a) => a.tabIndex >= 0).map((a) => a.textContent)"
        )
        page.execute_script("document.activeElement.blur(); scrollTo(0, 0); location.hash = ''")
    assert stops == [*"EJADGFHBC", "Words"]


def test_the_first_screen_on_paper(page: Any) -> None:
    with screen(page, 1400, media="print"):
        shown = page.execute_script(
            "return [...document.querySelectorAll('.verdict, .lines, .matrix, .note')]"
            ".every((e) => e.checkVisibility())"
        )
    assert shown


def test_the_main_job_in_twenty_lines(shipped: Callable[[str], Path]) -> None:
    """Which pins fail, why, what to do, and what to measure, on a terminal of 80 columns: here,
    where that study is run for other tests.
    """
    printed = (shipped("landing_gear").parent / "terminal").read_text(encoding="utf-8")
    lines = printed.splitlines()
    # The command stays whole, on one line but where the path of the study is a long one.
    first = next(k for k, line in enumerate(lines) if line.startswith("Do:"))
    after = next(k for k, line in enumerate(lines) if line.startswith("Error:"))
    assert len(lines) - (after - first - 1) <= 20
    assert max(map(len, lines[:first] + lines[after:])) <= 80
    text = " ".join(printed.split())
    for words in (
        "5 of 9 pins miss the required factor 10 (landing): E, J, A, D, G.",
        "194,000 lbf goes J–E–A to the frame; others at most 35,700.",
        "Shear dominates E, bending J, A, D and G.",
        "pinstress size ",
        " --pins E,J,A,D,G",
        "Measure first: force over time at landing",
        "lacks ultimate, shear, bearing strength",
    ):
        assert words in text


@pytest.mark.parametrize("names", LONG, ids=["case", "pin", "pin and case"])
def test_long_names_wrap_and_push_nothing_out(
    browser: Any, tmp_path: Path, names: dict[str, str]
) -> None:
    study = QUICK
    for name, long in names.items():
        study = study.replace(f"[{name}]", f"[{long}]")
    (tmp_path / "long.toml").write_text(study)
    run = run_here("run", "long.toml", "--out", "out", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    opened(browser, tmp_path / "out")
    for width in (1400, 1024, 390):
        with screen(browser, width):
            assert browser.execute_script(WIDER) == [], width
            assert browser.execute_script(OVERLAPS) == [], width
            upright = browser.execute_script(UPRIGHT)
            assert upright == ("pin.B" in names), width
    assert errors(browser) == []


def test_factors_are_whole_on_the_smallest_phone(browser: Any, tmp_path: Path) -> None:
    """Beside a long outcome, where no diameter is estimated, they had 8 px, and were cut off."""
    sharp = QUICK.replace("fillet = 0.4 ", "fillet = 0.0 ").replace("pin.B", "pin.constructor")
    (tmp_path / "sharp.toml").write_text(sharp)
    run = run_here("run", "sharp.toml", "--out", "out", cwd=tmp_path)
    assert run.returncode == 1, run.stderr
    opened(browser, tmp_path / "out")
    with screen(browser, 320):
        (cell,) = browser.find_elements("css selector", ".lines .factor:not(th)")
        assert cell.get_property("scrollWidth") <= cell.get_property("clientWidth")
        assert browser.execute_script("return innerWidth") == 320

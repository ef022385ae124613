"""The plots of the landing gear's report: drawn when they are seen, on a screen and on paper."""

from __future__ import annotations

import re
from base64 import b64decode
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tests.support.each import sampled
from tests.support.results.browser_page import errors, opened, screen, unfold, wait

pytestmark = pytest.mark.browser

PLOT = "reactions.retract.E"
PAGES = 12  # of the summary on paper
BACK = "arguments[0].scrollIntoView({ block: 'center' });"
LIBRARY = "return typeof window.vega;"
TEXTS = "return [...arguments[0].querySelectorAll('svg text')].map((t) => t.textContent);"
INK = """
const text = [...arguments[0].querySelectorAll("svg text")].find((t) => t.textContent);
return getComputedStyle(text).fill;
"""
NARROW = "return [document.documentElement.scrollWidth, document.documentElement.clientWidth];"


@pytest.fixture
def page(browser: Any, gear_run: Path) -> Any:
    """Opened anew, since tests change it."""
    opened(browser, gear_run)
    return browser


def figure(page: Any, name: str) -> Any:
    """A plot, scrolled to and drawn."""
    unfold(page)
    found = page.find_element("css selector", f'figure[data-plot="{name}"]')
    page.execute_script(BACK, found)
    wait(page, lambda: found.find_elements("css selector", ".drawn svg"))
    return found


def paper(page: Any) -> bytes:
    printed = page.execute_cdp_cmd("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})
    return b64decode(printed["data"])


def test_nothing_is_drawn_before_it_is_seen(page: Any) -> None:
    assert page.find_elements("css selector", "figure.plot")
    assert page.execute_script(LIBRARY) == "undefined"
    figure(page, PLOT)
    assert page.execute_script(LIBRARY) == "object"
    drawn = len(page.find_elements("css selector", ".drawn svg"))
    assert 0 < drawn < len(page.find_elements("css selector", ".drawn")) // 2


@pytest.mark.parametrize("step", sampled([8, 1], every=2))
def test_every_plot_can_be_drawn_without_eval(page: Any, step: int) -> None:
    """The names of its curves are in it, and the console has nothing to say."""
    unfold(page)
    figures = page.find_elements("css selector", "figure.plot")
    assert len(figures) > 40
    for found in figures[::step]:
        page.execute_script(BACK, found)
        wait(page, partial(found.find_elements, "css selector", ".drawn svg"))
        assert len(page.execute_script(TEXTS, found)) > 3
    assert errors(page) == []


def test_values_under_the_pointer(page: Any) -> None:
    from selenium.webdriver import ActionChains

    found = figure(page, PLOT)
    drawing = found.find_element("css selector", "svg")
    ActionChains(page).move_to_element_with_offset(drawing, 40, -100).perform()
    told = wait(page, lambda: page.find_element("id", "pointed").text)
    lines = dict(line.split(": ") for line in told.split("\n"))
    assert list(lines) == ["at", "E1", "E2", "E3"]
    assert all(re.fullmatch(r"[−\d.,]+", value) for value in lines.values())


def test_values_as_a_table(page: Any) -> None:
    found = figure(page, PLOT)
    found.find_element("css selector", ".values summary").click()
    rows = wait(page, lambda: found.find_elements("css selector", ".values tbody tr"))
    heads = [h.text for h in found.find_elements("css selector", ".values th")]
    assert heads[:3] == ["drive position [in]", "E1, force [lbf]", "E2, force [lbf]"]
    assert len(rows) > 100
    link = found.find_element("css selector", ".values a")
    assert link.get_attribute("href").startswith("data:text/csv")


def test_colours_follow_the_page(page: Any) -> None:
    found = figure(page, PLOT)
    before = page.execute_script(INK, found)
    page.execute_script("document.getElementById('shade').click();")
    assert page.execute_script(INK, found) != before
    page.execute_script("document.getElementById('shade').click();")
    assert page.execute_script(INK, found) == before


def test_a_link_opens_what_it_leads_into(page: Any) -> None:
    page.execute_script("document.querySelector('nav a[href=\"#refinement\"]').click();")
    wait(page, lambda: page.find_element("id", "refinement").get_attribute("open"))


def test_the_summary_on_paper_is_short_and_has_a_title_block(page: Any) -> None:
    short = len(re.findall(rb"/Type\s*/Page\b", paper(page)))
    assert 2 < short <= PAGES
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    block = page.find_element("css selector", ".title-block")
    assert block.is_displayed()
    assert not page.find_element("css selector", "#motion").is_displayed()
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


@pytest.mark.parametrize(
    ("run", "pages"), sampled([("clevis_run", 5), ("gear_run", PAGES)], every=2)
)
def test_all_that_is_open_is_drawn_on_paper(
    browser: Any, run: str, pages: int, request: pytest.FixtureRequest
) -> None:
    opened(page := browser, request.getfixturevalue(run))
    page.find_element("id", "unfold").click()
    assert len(re.findall(rb"/Type\s*/Page\b", paper(page))) > pages
    drawn = page.find_elements("css selector", ".drawn svg")
    assert len(drawn) == len(page.find_elements("css selector", ".drawn"))
    assert errors(page) == []


def test_a_phone_shows_all_of_a_plot(page: Any) -> None:
    with screen(page, 390, 800):
        found = figure(page, "surface.landing.E")
        drawing = found.find_element("css selector", "svg")
        assert drawing.rect["width"] <= 390
        whole, shown = page.execute_script(NARROW)
        assert whole <= shown

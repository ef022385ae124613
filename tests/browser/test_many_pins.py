"""The report of many pins: what is folded is made when it is opened."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest

from benchmarks.runs.page import many_pins
from reports.page.overview import MAX_MATRIX_PINS
from reports.page.page import MAX_PINS_AT_ONCE
from tests.browser.conftest import run
from tests.browser.test_pins import WIDER
from tests.support.results.browser_page import errors, opened, screen, view, wait

pytestmark = pytest.mark.browser

PINS = MAX_PINS_AT_ONCE + 2
NODES_OF_A_PIN = 170  # drawing, headings, rows of the tables that are not folded
NODES_OF_THE_REST = 600
NODES = "return document.querySelectorAll('*').length;"
FIGURES = "return document.querySelectorAll('figure.plot').length;"
VIEWS = "return document.querySelectorAll('[data-view]').length;"


@pytest.fixture(scope="module")
def many_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("many")
    study = folder / "many.toml"
    study.write_text(many_pins(PINS), encoding="utf-8")
    return run(study, folder / "out", "--vtk", "none")


@pytest.fixture
def page(browser: Any, many_run: Path) -> Any:
    opened(browser, many_run)
    return browser


def test_folded_parts_are_text_at_first(page: Any) -> None:
    assert page.execute_script(NODES) < PINS * NODES_OF_A_PIN + NODES_OF_THE_REST
    assert page.execute_script(FIGURES) == page.execute_script(VIEWS) == 0
    assert page.execute_script("return typeof window.vega;") == "undefined"
    assert errors(page) == []


def test_requirements_of_many_pins_fit_the_screen(page: Any) -> None:
    for width in (1400, 1024, 390):
        with screen(page, width):
            # Many pins take some time to be laid out anew.
            assert wait(page, lambda: not page.execute_script(WIDER)), width
            assert page.execute_script(
                "return document.documentElement.scrollWidth <= innerWidth"
            ), width
    heads = page.find_elements("css selector", ".matrix thead th")
    assert len(heads) == 2 + MAX_MATRIX_PINS


def test_a_pin_that_is_opened_is_made_alone(page: Any) -> None:
    section = page.find_elements("css selector", "section.pin")[-1]
    for part in section.find_elements("css selector", "details.fold > summary"):
        page.execute_script("arguments[0].click();", part)
    for made, shown in (("figure.plot", ".drawn svg"), ("[data-view]", "[data-is=told]")):
        within = wait(page, partial(section.find_elements, "css selector", made))[0]
        wait(page, partial(_text_in_view, page, within, shown))
    assert page.execute_script(VIEWS) == 1
    figures = section.find_elements("css selector", "figure.plot")
    assert page.execute_script(FIGURES) == len(figures) == 3  # two cases, and refinement
    assert errors(page) == []


def _text_in_view(page: Any, within: Any, selector: str) -> str:
    """The text of a part that is drawn in view, out of which what is drawn above may push it."""
    page.execute_script("arguments[0].scrollIntoView();", within)
    return _text(within, selector)


def _text(within: Any, selector: str) -> str:
    return "".join(found.text for found in within.find_elements("css selector", selector))


def test_all_parts_can_be_opened_at_once(page: Any) -> None:
    page.find_element("id", "unfold").click()
    assert page.execute_script(VIEWS) == PINS
    assert page.execute_script(FIGURES) == 3 * PINS + 4  # bars and refinement of each case
    assert not page.find_elements("css selector", "details > noscript")
    assert view(page, "P000").is_displayed()
    assert errors(page) == []


def test_a_link_makes_what_it_leads_to(page: Any) -> None:
    page.execute_script("document.querySelector('nav a[href=\"#reactions\"]').click();")
    wait(page, lambda: page.find_elements("css selector", "#reactions tbody tr"))


def test_a_search_for_text_opens_the_part_that_has_it(page: Any, many_run: Path) -> None:
    """A text fragment of an address is searched as by Ctrl+F."""
    section = page.find_elements("css selector", "section.pin")[PINS // 2]
    part = section.find_elements("css selector", "details.fold")[0]
    text = part.find_element("css selector", ".words").get_property("textContent")
    words = " ".join(text.split()[:6])
    assert not part.get_property("open")
    page.get("about:blank")
    page.get(f"{(many_run / 'report.html').as_uri()}#:~:text={quote(words)}")
    opened_parts = "details.fold[open] table, details.fold[open] figure, details.fold[open] p"
    wait(page, lambda: page.find_elements("css selector", opened_parts))
    assert not page.find_elements("css selector", "details.fold[open] > .words")
    assert errors(page) == []


def test_without_scripts_the_parts_open_too(page: Any, many_run: Path) -> None:
    page.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        opened(page, many_run)
        summary = page.find_elements("css selector", "section.pin details.fold > summary")[
            0
        ]  # what lets go first
        summary.click()
        table = summary.find_element("xpath", "..//table")
        assert table.is_displayed()
    finally:
        page.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})

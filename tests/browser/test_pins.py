"""The pins of the landing gear in its lugs, as they are drawn and laid out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.docs.test_captions import build_docs
from tests.support.each import in_turn, sampled
from tests.support.results.browser_page import SCREEN, errors, opened, screen, slide, unfold, wait

pytestmark = pytest.mark.browser

AXE = Path(__file__).parent / "axe" / "axe.min.js"
MAX_SCREENS_OF_PINS = 4.3  # of nine pins at 1400 px, drawn with their lugs to scale
MAX_SCREENS = 8.0  # of the page
# Elements wider than the page that do not scroll by themselves.
WIDER = """
const width = document.documentElement.clientWidth;
return [...document.querySelectorAll("main *, header *")].filter((e) => !e.closest(".wide, svg"))
  .filter((e) => e.checkVisibility() && e.getBoundingClientRect().right > width + 1)
  .map((e) => e.outerHTML.slice(0, 80));
"""
# Texts of drawings that leave their picture, or lie on another text.
TEXTS = """
const faults = [];
for (const svg of document.querySelectorAll("svg.pin")) {
  const box = svg.getBoundingClientRect();
  const all = [...svg.querySelectorAll("text")].filter((t) => !t.closest("svg svg"));
  const rects = all.map((t) => t.getBoundingClientRect());
  rects.forEach((r, i) => {
    const out = r.left < box.left - 1 || r.right > box.right + 1 || r.bottom > box.bottom + 1;
    if (out) faults.push(`${all[i].textContent} leaves`);
    rects.slice(i + 1).forEach((q, k) => {
      const over = Math.min(r.right, q.right) - Math.max(r.left, q.left);
      const across = Math.min(r.bottom, q.bottom) - Math.max(r.top, q.top);
      const [a, b] = [all[i].textContent, all[i + 1 + k].textContent];
      if (over > 2 && across > 4) faults.push(`${a} on ${b}`);
    });
  });
}
return faults;
"""
DRAWN = """
const done = arguments[arguments.length - 1];
requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done)));
"""
FAULTS = """
const done = arguments[arguments.length - 1];
axe.run(document, { iframes: true }).then((found) => done(found.violations
  .map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 200)).join(" | ")}`)));
"""
by_shade = in_turn("shade", ["light", "dark"])


@pytest.fixture
def page(browser: Any, shipped: Callable[[str], Path]) -> Any:
    opened(browser, shipped("landing_gear"))
    return browser


def test_nine_closed_pins_take_few_screens(page: Any) -> None:
    with screen(page, 1400):
        (pins,) = page.find_elements("css selector", ".pins")
        assert len(pins.find_elements("css selector", "section.pin")) == 9
        assert pins.size["height"] < MAX_SCREENS_OF_PINS * SCREEN
        whole = page.execute_script("return document.documentElement.scrollHeight;")
        assert whole < MAX_SCREENS * SCREEN
        assert not page.find_elements("css selector", "main details[open]")


@pytest.mark.parametrize("width", sampled([1400, 1024, 390], every=2))
def test_pins_fit_the_screen(page: Any, width: int) -> None:
    with screen(page, width):
        assert page.execute_script(WIDER) == []
        sections = page.find_elements("css selector", "section.pin")
        columns = {section.location["x"] for section in sections}
        assert len(columns) == (1 if width < 500 else 2)
    assert errors(page) == []


def test_no_words_of_a_drawing_lie_on_others(page: Any) -> None:
    with screen(page, 1400):
        assert page.execute_script(TEXTS) == []


def test_every_pin_shows_its_governing_place_and_forces(page: Any) -> None:
    for section in page.find_elements("css selector", "section.pin"):
        assert len(section.find_elements("css selector", "svg .governs")) == 1
        assert section.find_elements("css selector", "svg .load")
        assert section.find_elements("css selector", "svg .surface")
        assert section.find_elements("css selector", "svg .section")
        lines = section.find_elements("css selector", "table.cases tbody tr")
        assert [line.text.split()[0] for line in lines] == ["landing", "retract"]


def test_a_pin_opens_by_keyboard_where_it_is(page: Any) -> None:
    from selenium.webdriver import Keys

    with screen(page, 1400):
        section = page.find_element("id", "pin-2")  # in the right column
        summary = section.find_elements("css selector", ".more > details > summary")[1]
        page.execute_script("arguments[0].scrollIntoView({ block: 'center' });", summary)
        before = page.execute_script("return arguments[0].getBoundingClientRect().top;", summary)
        narrow = section.size["width"]
        page.execute_script("arguments[0].focus();", summary)
        summary.send_keys(Keys.ENTER)
        wait(page, lambda: section.size["width"] > 1.5 * narrow)
        wait(
            page,
            lambda: (
                abs(
                    page.execute_script("return arguments[0].getBoundingClientRect().top;", summary)
                    - before
                )
                < 3
            ),
        )
        summary.send_keys(Keys.ENTER)
        wait(page, lambda: section.size["width"] == narrow)


def test_paper_has_the_drawings_and_lines_but_nothing_closed(page: Any) -> None:
    with screen(page, 718, media="print"):
        assert page.execute_script(WIDER) == []
        for section in page.find_elements("css selector", "section.pin"):
            assert section.find_element("css selector", "svg.pin").is_displayed()
            assert section.find_element("css selector", "table.cases").is_displayed()
            assert not any(
                part.is_displayed() for part in section.find_elements("css selector", "summary")
            )


def faults(page: Any) -> list[str]:
    """What axe finds once the page is laid out for its screen."""
    page.execute_async_script(DRAWN)
    page.execute_script(AXE.read_text(encoding="utf-8"))
    page.set_script_timeout(300)
    return list(page.execute_async_script(FAULTS))


@pytest.mark.parametrize(
    ("shade", "open_"),
    sampled([("dark", True), ("light", True), ("dark", False), ("light", False)], every=4),
)
def test_axe_finds_nothing(page: Any, shade: str, open_: bool) -> None:
    """CI has the light one of the same parts of a page in test_page.py."""
    with screen(page, 1400, shade=shade):
        if open_:
            unfold(page)
        assert faults(page) == []


def test_axe_finds_nothing_on_a_phone(page: Any) -> None:
    """Where tables scroll sideways."""
    with screen(page, 390):
        assert faults(page) == []


@by_shade
def test_axe_finds_nothing_in_the_documentation(browser: Any, tmp_path: Path, shade: str) -> None:
    """On a page like ours: with contents, code that is too wide, and captions."""
    build_docs(tmp_path, f"One\n===\n\n::\n\n   {'word ' * 60}\n\nPart\n----\n\ntext\n")
    for name in ("index.html", "one.html"):
        browser.get((tmp_path / "out" / name).as_uri())
        with screen(browser, 1400, shade=shade):
            assert faults(browser) == []


@by_shade
def test_axe_finds_nothing_on_a_page_of_loads(
    browser: Any, shipped_loads: Path, shade: str
) -> None:
    """With all parts unfolded, and its animation."""
    opened(browser, shipped_loads)
    with screen(browser, 1400, shade=shade):
        unfold(browser)
        assert faults(browser) == []


def test_a_page_of_loads_shows_its_motion_first(browser: Any, shipped_loads: Path) -> None:
    opened(browser, shipped_loads)
    with screen(browser, 1400):
        frame = browser.find_element("css selector", "main iframe")
        wait(browser, lambda: frame.get_attribute("srcdoc"))
        assert frame.location["y"] < 0.4 * SCREEN
        browser.switch_to.frame(frame)
        try:
            wait(browser, lambda: browser.find_element("css selector", "#play").is_displayed())
            (size,) = browser.find_elements("css selector", "[data-size-of]")
            before = size.get_attribute("transform")
            slide(browser, browser.find_element("css selector", "#seek"), 120)
            wait(browser, lambda: size.get_attribute("transform") != before)
            assert size.text.endswith(" N")
            shown = browser.find_element("css selector", '[data-show="applied"]')
            shown.click()
            assert not size.is_displayed()
        finally:
            browser.switch_to.default_content()
    assert errors(browser) == []

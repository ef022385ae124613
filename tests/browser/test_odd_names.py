"""A study whose title and names hold markup, quotes, emoji and right-to-left text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.browser.conftest import ODD, PIN
from tests.support.results.browser_page import canvas, colours, errors, opened, view

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def page(browser: Any, odd_run: Path) -> Any:
    opened(browser, odd_run)
    return browser


def test_texts_are_shown_as_typed_and_run_nothing(page: Any) -> None:
    assert page.title == f"{ODD}: pin stresses"
    assert page.find_element("css selector", "h1").text == ODD
    shown = [h.text for h in page.find_elements("css selector", "h2")]
    assert f"Pin {PIN}" in shown
    assert not page.find_elements("css selector", 'img[src="x"]')
    assert page.find_element("css selector", "#factors tbody td").text == PIN
    assert errors(page) == []


def test_the_pin_is_drawn(page: Any) -> None:
    root = view(page, PIN)
    assert PIN in canvas(root).get_attribute("aria-label")
    assert colours(page, root) > 1000


def test_an_address_with_a_per_cent_sign_stops_no_script(page: Any, odd_run: Path) -> None:
    """It cannot be decoded, which ended all that follows: buttons, frames, plots."""
    page.get("about:blank")
    page.get(f"{(odd_run / 'report.html').as_uri()}#50%")
    assert page.find_element("id", "shade").text in ("Dark", "Light")
    assert errors(page) == []

"""Contact pressure on the view of a pin in its lugs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from reports.format.numbers import engineering
from tests.support.results.browser_page import errors, opened, part, pixels, slide, view, wait

pytestmark = pytest.mark.browser

LARGEST = """
const found = unpacked(JSON.parse(arguments[0].querySelector("script").textContent));
return found.then((data) => {
  const chosen = caseOf(data.cases[0]);
  return Math.max(...pressing(surfaceOf(data.surfaces[0]), chosen));
});
"""


@pytest.fixture
def page(browser: Any, clevis_run: Path) -> Any:
    opened(browser, clevis_run)
    return browser


def largest(folder: Path) -> float:
    (row,) = json.loads((folder / "results.json").read_text(encoding="utf-8"))["pins"]
    return max(float(band["largest_pressure"]) for band in row["joint"]["bands"])


def test_the_view_can_show_the_pressure(page: Any, clevis_run: Path) -> None:
    from selenium.webdriver.support.ui import Select

    root = view(page, "P")
    before = pixels(page, root)
    Select(part(root, "colour")).select_by_visible_text("contact pressure")
    wait(page, lambda: pixels(page, root) != before)
    assert part(root, "unit").text == "contact pressure [MPa]"
    assert part(root, "ticks").text.split()[-1] == engineering(largest(clevis_run), 3)
    assert page.execute_script(LARGEST, root) == pytest.approx(largest(clevis_run), rel=1e-6)
    assert errors(page) == []


def test_at_another_instant_stress_is_shown_again(page: Any) -> None:
    """The pressure is known at the governing instant, to which choosing it returns."""
    from selenium.webdriver.support.ui import Select

    root = view(page, "P")
    time, colour = part(root, "time"), Select(part(root, "colour"))
    governing = time.get_property("value")
    slide(page, time, 0)
    colour.select_by_visible_text("contact pressure")
    assert time.get_property("value") == governing != "0"
    slide(page, time, 0)
    assert colour.first_selected_option.text == "von Mises stress"
    assert part(root, "unit").text == "von Mises stress [MPa]"

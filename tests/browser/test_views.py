"""The views of pins that can be turned, in the landing gear's report."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from reports.format.numbers import engineering, short
from tests.support.browser_page import (
    canvas,
    colours,
    errors,
    maximum,
    opened,
    part,
    pixels,
    slide,
    view,
    views,
    wait,
)

pytestmark = pytest.mark.browser

# Largest stress of all vertices that are not excluded, at some instants of every case of a view.
VERTICES = """
const data = JSON.parse(arguments[0].querySelector("script").textContent);
const surface = surfaceOf(data);
return surface.cases.map((c) => {
  const last = c.maxima.length - 1, some = new Set([0, last >> 2, last >> 1, last, c.instant]);
  return { case: c.name, beneath: c.beneath, instant: c.instant, at: [...some].map((k) => {
    const { value } = superposed(surface, c, k);
    let most = 0;
    value.forEach((v, i) => {
      if (!c.excluded[Math.floor(i / surface.around)]) most = Math.max(most, v);
    });
    return [k, most, c.maxima[k]];
  }) };
});
"""


@pytest.fixture
def page(browser: Any, gear_run: Path) -> Any:
    opened(browser, gear_run)
    return browser


def result(folder: Path, pin: str, case: str) -> dict[str, Any]:
    pins = json.loads((folder / "results.json").read_text(encoding="utf-8"))["pins"]
    (found,) = (p for p in pins if (p["pin"], p["case"]) == (pin, case))
    return dict(found)


def test_a_pin_is_drawn_in_many_colours_and_turns(page: Any) -> None:
    from selenium.webdriver import ActionChains, Keys

    root = view(page, "A")
    assert colours(page, root) > 1000
    before = pixels(page, root)
    drag = ActionChains(page).move_to_element(canvas(root)).click_and_hold()
    drag.move_by_offset(120, 40).release().perform()
    wait(page, lambda: pixels(page, root) != before)
    after = pixels(page, root)
    canvas(root).send_keys(Keys.ARROW_LEFT)
    wait(page, lambda: pixels(page, root) != after)
    part(root, "reset").click()
    wait(page, lambda: pixels(page, root) == before)
    assert errors(page) == []


def test_the_maximum_told_is_the_computed_one(page: Any, gear_run: Path) -> None:
    root = view(page, "B")
    found = result(gear_run, "B", "retract")
    assert maximum(root) == found["max_von_mises"]
    told = part(root, "told").text
    low, high = (engineering(end, 3) for end in found["max_von_mises_interval"])
    assert f"{engineering(found['max_von_mises'])} psi ({low} to {high} over half" in told
    low, high = (engineering(end, 3) for end in found["safety_factor_interval"])
    assert f"safety factor {low} to {high} (singular)" in told
    assert f"t = {short(found['time'])} s, the governing instant" in told
    before = pixels(page, root)
    slide(page, part(root, "time"), 0)
    assert maximum(root) < found["max_von_mises"]
    assert "governing" not in part(root, "told").text
    wait(page, lambda: pixels(page, root) != before)
    part(root, "governs").click()
    assert maximum(root) == found["max_von_mises"]


def test_cases_colours_and_deformation_can_be_chosen(page: Any, gear_run: Path) -> None:
    from selenium.webdriver.support.ui import Select

    root = view(page, "J")
    Select(part(root, "case")).select_by_visible_text("landing")
    found = result(gear_run, "J", "landing")
    assert maximum(root) == found["max_von_mises"]
    factor = " to ".join(engineering(end, 3) for end in found["safety_factor_interval"])
    assert f"{factor} (singular, beyond yield)" in part(root, "told").text
    assert not part(root, "when").is_displayed()
    before = pixels(page, root)
    Select(part(root, "colour")).select_by_visible_text("safety factor")
    wait(page, lambda: pixels(page, root) != before)
    assert part(root, "unit").text == "safety factor (singular, beyond yield)"
    least = engineering(found["safety_factor"], 3)
    assert part(root, "ticks").text.split()[-1] == least
    before = pixels(page, root)
    slide(page, part(root, "deform"), 100)
    assert part(root, "deformed").text.startswith("×")
    wait(page, lambda: pixels(page, root) != before)
    assert errors(page) == []


@pytest.mark.parametrize("pin", list("ABCDEFGHJ"))
def test_what_is_coloured_is_what_was_computed(page: Any, pin: str) -> None:
    """At the governing instant the surface has the maximum, unless that is inside; never more."""
    for root in views(page, pin):
        for case in page.execute_script(VERTICES, root):
            for instant, most, largest in case["at"]:
                assert most <= largest * (1.0 + 1e-4)
                if instant == case["instant"] and not case["beneath"]:
                    assert most > largest * (1.0 - 2e-3)  # between two of 72 sectors

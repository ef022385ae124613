"""The animation of linkages in space: turned by keyboard, mouse and buttons, played and paused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pinbase.dimensions import Floats
from reports.animation.page import render_animation
from tests.support.results.browser_page import errors, screen, wait
from tests.support.results.space_results import landing_gear, rssr

pytestmark = pytest.mark.browser

AXE = Path(__file__).parent / "axe" / "axe.min.js"
JOINTS = """
return [...document.querySelectorAll("[data-joint]")].map(
  (g) => g.getAttribute("transform").match(/-?[\\d.]+/g).map(Number));
"""
BOXES = """
return [...document.querySelectorAll("[data-joint] text")].map((text) => {
  const { left, right, top, bottom } = text.getBoundingClientRect();
  return [left, right, top + 3, bottom - 3];
});
"""
FAULTS = """
const done = arguments[arguments.length - 1];
axe.run(document).then((found) => done(found.violations
  .filter((v) => ["serious", "critical"].includes(v.impact))
  .map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 200)).join(" | ")}`)));
"""
RIGHT, UP, NEAR = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # the front view


@pytest.fixture
def page(browser: Any, tmp_path: Path) -> Any:
    """The animation of a crank and rocker in space, at half a second."""
    return shown(browser, tmp_path, rssr())


def shown(browser: Any, folder: Path, results: Any) -> Any:
    path = folder / "animation.html"
    path.write_text(render_animation(results.skeletons[0], results), encoding="utf-8")
    browser.get_log("browser")
    browser.get(f"{path.as_uri()}#t=0.5")
    return browser


def expected(page: Any, azimuth: float, elevation: float, k: int) -> Floats:
    """The places (J, 2) of the joints at an instant: turned about the vertical, then tilted."""
    data = json.loads(page.find_element("id", "data").get_attribute("textContent"))
    position = rssr().space[0].position
    middle = 0.5 * (position.reshape(-1, 3).min(axis=0) + position.reshape(-1, 3).max(axis=0))
    p = data["places"]["scale"] * (position[k] - middle)
    a, e = np.radians([azimuth, elevation])
    right, near, up = p @ RIGHT, p @ NEAR, p @ UP
    turned, forward = right * np.cos(a) - near * np.sin(a), right * np.sin(a) + near * np.cos(a)
    return np.stack([480.0 + turned, 280.0 - (up * np.cos(e) - forward * np.sin(e))], axis=1)


def joints(page: Any) -> Floats:
    return np.array(page.execute_script(JOINTS))


def press(page: Any, *keys: str) -> None:
    page.find_element("css selector", ".scene").send_keys(*keys)


def view(page: Any) -> str:
    return str(page.find_element("id", "view").text)


def test_it_opens_in_the_isometric_view(page: Any) -> None:
    assert view(page) == "Isometric"
    isometric = np.degrees(np.arctan(np.sqrt(0.5)))
    assert joints(page) == pytest.approx(expected(page, 45.0, isometric, 18), abs=0.02)
    assert errors(page) == []


def test_buttons_show_the_views_of_a_drawing(page: Any) -> None:
    for name, azimuth, elevation in (("Front", 0, 0), ("Right side", 90, 0), ("Top", 0, 90)):
        page.find_element("xpath", f"//button[text()='{name}']").click()
        assert view(page) == name
        assert joints(page) == pytest.approx(expected(page, azimuth, elevation, 18), abs=0.02)


def test_arrow_keys_turn_it_and_leave_the_time(page: Any) -> None:
    from selenium.webdriver.common.keys import Keys

    time = page.find_element("id", "time").text
    page.find_element("xpath", "//button[text()='Front']").click()
    press(page, Keys.ARROW_LEFT, Keys.ARROW_LEFT, Keys.ARROW_DOWN)
    assert view(page) == "azimuth 10°, elevation 5°"
    assert joints(page) == pytest.approx(expected(page, 10.0, 5.0, 18), abs=0.02)
    assert page.find_element("id", "time").text == time
    for _ in range(30):
        press(page, Keys.ARROW_DOWN)
    assert view(page) == "azimuth 10°, elevation 90°"  # it stops above
    press(page, "0")
    assert view(page) == "Isometric"


def test_zooming_keeps_the_middle_and_the_scale_bar(page: Any) -> None:
    before = joints(page) - [480.0, 280.0]
    bar = page.find_element("css selector", ".keys > path").get_attribute("d")
    press(page, "+")
    assert joints(page) - [480.0, 280.0] == pytest.approx(1.2 * before, abs=0.03)
    after = page.find_element("css selector", ".keys > path").get_attribute("d")
    long, short = (float(d.split("H")[1].split("V")[0]) for d in (after, bar))
    assert long == pytest.approx(1.2 * short, abs=0.01)


def test_the_mouse_turns_it(page: Any) -> None:
    from selenium.webdriver import ActionChains

    page.find_element("xpath", "//button[text()='Front']").click()
    scene = page.find_element("id", "scene")
    drag = ActionChains(page).move_to_element_with_offset(scene, 200, -120).click_and_hold()
    drag.move_by_offset(-40, 20).release().perform()
    assert view(page) == "azimuth 20°, elevation 10°"


def test_a_click_on_a_joint_still_selects_it(page: Any) -> None:
    from selenium.webdriver import ActionChains

    ActionChains(page).move_to_element(
        page.find_element("css selector", "[data-joint='2'] .pin")
    ).click().perform()
    assert page.find_element("css selector", "#callout b").text == "Q"
    x, y, z = rssr().space[0].position[18, 2]
    told = page.find_element("css selector", "#callout small").text
    numbers = [float(part.split()[1].replace("−", "-")) for part in told.split(", ")]
    assert numbers == pytest.approx([x, y, z], abs=0.06)


def test_it_plays_and_pauses(page: Any) -> None:
    """The joints follow the motion while the view stays, and stand while it is paused."""
    from selenium.webdriver.common.keys import Keys

    page.find_element("xpath", "//button[text()='Top']").click()
    start = joints(page)
    press(page, Keys.SPACE)
    wait(page, lambda: np.abs(joints(page) - start).max() > 5.0)
    assert np.abs(joints(page)[0] - start[0]).max() == 0.0  # on the ground
    press(page, Keys.SPACE)
    assert page.find_element("id", "play").get_attribute("aria-label") == "Play"
    paused = joints(page)
    page.execute_async_script(
        "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));"
    )
    assert np.array_equal(joints(page), paused)
    assert view(page) == "Top"
    press(page, Keys.END)
    assert joints(page) == pytest.approx(expected(page, 0.0, 90.0, 72), abs=0.02)


def test_names_do_not_overlap_however_it_is_turned(browser: Any, tmp_path: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    page = shown(browser, tmp_path, landing_gear())
    for _ in range(6):
        boxes = page.execute_script(BOXES)
        for i, (left, right, top, bottom) in enumerate(boxes):
            for a, b, c, d in boxes[:i]:
                assert right <= a or b <= left or bottom <= c or d <= top, view(page)
        press(page, *[Keys.ARROW_LEFT] * 12)


def test_numbers_beside_curves_are_whole_on_a_phone(browser: Any, tmp_path: Path) -> None:
    """Their letters are larger there: the first of "−51,100" was cut off."""
    page = shown(browser, tmp_path, landing_gear())
    page.execute_script("document.querySelector('.strip .y').textContent = '−51,100'")
    with screen(page, 320):
        cut = page.execute_script(
            "return [...document.querySelectorAll('.strip text')].filter((text) => {"
            "  const svg = text.closest('svg'), whole = getComputedStyle(svg).overflow;"
            "  const edge = whole === 'visible' ? document.body : svg;"
            "  return text.getBoundingClientRect().left < edge.getBoundingClientRect().left;"
            "}).map((text) => text.textContent);"
        )
    assert cut == []


def test_axes_turn_with_the_linkage(page: Any) -> None:
    """The crank's pin is upright from the front, and its ring alone from above."""
    path = "return document.querySelector('[data-axis=\"0\"] path').getAttribute('d');"

    def run() -> Floats:
        ends = page.execute_script(path)[1:].replace(",", " ").split()
        return np.asarray(np.abs(np.diff(np.array(ends, dtype=float).reshape(2, 2), axis=0)[0]))

    page.find_element("xpath", "//button[text()='Front']").click()
    assert run() == pytest.approx([0.0, 68.0], abs=0.02)
    page.find_element("xpath", "//button[text()='Top']").click()
    assert run() == pytest.approx([0.0, 0.0], abs=0.02)


def test_accessible_and_dark(browser: Any, tmp_path: Path) -> None:
    page = shown(browser, tmp_path, landing_gear())
    for shade in ("light", "dark"):
        media = [{"name": "prefers-color-scheme", "value": shade}]
        page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": media})
        page.execute_script(AXE.read_text(encoding="utf-8"))
        assert page.execute_async_script(FAULTS) == []
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})

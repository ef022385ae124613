"""The views of pins that can be turned, in the landing gear's report."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from reports.format.numbers import engineering, short
from tests.support.each import sampled
from tests.support.programs.command_line import QUICK, run_here
from tests.support.results.browser_page import (
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
# A view sums harmonics of all points at once, a run those of the largest by themselves.
ROUND_OFF = 1e-12
VERTICES = """
const found = unpacked(JSON.parse(arguments[0].querySelector("script").textContent));
return found.then((data) => data.cases.map(caseOf).map((c) => {
  const surface = surfaceOf(data.surfaces[c.surface]), { places } = meshOf(surface, c);
  const last = c.maxima.length - 1, some = new Set([0, last >> 2, last >> 1, last, c.instant]);
  return { case: c.name, beneath: c.beneath, instant: c.instant, at: [...some].map((k) => {
    const { value } = superposed(surface, c, k);
    let most = 0;
    value.forEach((v, i) => {
      const r = Math.hypot(places[3 * i], places[3 * i + 1]), z = places[3 * i + 2];
      const within = c.zones.some((o) => Math.hypot(r - o[0], z - o[1]) < o[2] * (1 - 1e-5));
      if (!within) most = Math.max(most, v);
    });
    return [k, most, c.maxima[k]];
  }) };
}));
"""


@pytest.fixture
def page(browser: Any, gear_run: Path) -> Any:
    opened(browser, gear_run)
    return browser


def result(folder: Path, pin: str, case: str) -> dict[str, Any]:
    pins = json.loads((folder / "results.json").read_text(encoding="utf-8"))["pins"]
    (found,) = (p for p in pins if (p["pin"], p["case"]) == (pin, case))
    return dict(found)


def probed(root: Any) -> float:
    """The stress at the probe."""
    return float(part(root, "probed").get_attribute("data-value"))


def marked(root: Any) -> tuple[float, float]:
    """Where in the picture the maximum is, in pixels from its upper left corner."""
    told = part(root, "told")
    return float(told.get_attribute("data-x")), float(told.get_attribute("data-y"))


def changed(page: Any, root: Any, before: str) -> None:
    """Wait until the picture is another one."""
    wait(page, lambda: pixels(page, root) != before)


def test_a_pin_is_drawn_in_many_colours_and_turns(page: Any) -> None:
    from selenium.webdriver import ActionChains, Keys

    root = view(page, "A")
    assert colours(page, root) > 1000
    before, at = pixels(page, root), marked(root)
    drag = ActionChains(page).move_to_element(canvas(root)).click_and_hold()
    drag.move_by_offset(120, 40).release().perform()
    wait(page, lambda: pixels(page, root) != before)
    after = pixels(page, root)
    canvas(root).send_keys(Keys.ARROW_LEFT)
    wait(page, lambda: pixels(page, root) != after)
    part(root, "reset").click()
    wait(page, lambda: marked(root) == at)  # pixels may differ: smoothing of letters changes
    assert errors(page) == []


def test_the_maximum_told_is_the_computed_one(page: Any, gear_run: Path) -> None:
    """Colours are of the surface; where a section has more stress, it is told beside."""
    from selenium.webdriver.support.ui import Select

    root = view(page, "B")
    Select(part(root, "case")).select_by_visible_text("retract")
    found = result(gear_run, "B", "retract")
    surface = found["surface"]
    assert found["governs"] == "section"
    assert maximum(root) == pytest.approx(surface["max_von_mises"], rel=ROUND_OFF)
    assert surface["max_von_mises"] < found["max_von_mises"]
    told = part(root, "told").text
    error = engineering(surface["error_estimate"], 2)
    assert f"{engineering(surface['max_von_mises'])} psi (± {error})" in told
    assert f"safety factor {engineering(surface['safety_factor'], 3)} (singular)" in told
    low, high = (engineering(end, 3) for end in found["max_von_mises_interval"])
    assert f"The section at z = 0 in governs: {engineering(found['max_von_mises'])} psi" in told
    assert f"({low} to {high} over half" in told
    low, high = (engineering(end, 3) for end in found["safety_factor_interval"])
    assert f"safety factor {low} to {high}." in told
    assert f"t = {short(found['time'])} s, the governing instant" in told
    before = pixels(page, root)
    slide(page, part(root, "time"), 0)
    assert maximum(root) < surface["max_von_mises"]
    assert "govern" not in part(root, "told").text
    wait(page, lambda: pixels(page, root) != before)
    part(root, "governs").click()
    assert maximum(root) == pytest.approx(surface["max_von_mises"], rel=ROUND_OFF)


def test_cases_colours_and_deformation_can_be_chosen(page: Any, gear_run: Path) -> None:
    from selenium.webdriver.support.ui import Select

    root = view(page, "J")
    found = result(gear_run, "J", "landing")
    assert maximum(root) == pytest.approx(found["max_von_mises"], rel=ROUND_OFF)
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


@pytest.mark.parametrize("pin", sampled("BACEDFJGH", every=5))
def test_what_is_coloured_is_what_was_computed(page: Any, pin: str) -> None:
    """At the governing instant the surface has the maximum, unless that is inside; never more."""
    for root in views(page, pin):
        for case in page.execute_script(VERTICES, root):
            for instant, most, largest in case["at"]:
                assert most <= largest * (1.0 + 1e-4)
                if instant == case["instant"] and not case["beneath"]:
                    assert most > largest * (1.0 - 2e-3)


@pytest.mark.parametrize("pin", sampled("BACEDFJGH", every=5))
def test_it_opens_on_the_case_that_governs_with_the_probe_at_its_maximum(
    page: Any, gear_run: Path, pin: str
) -> None:
    """A maximum inside the pin is shown by cutting it open."""
    from selenium.webdriver.support.ui import Select

    root = view(page, pin)
    found = min(
        (result(gear_run, pin, case) for case in ("retract", "landing")),
        key=lambda row: float(row["safety_factor"]),
    )
    assert Select(part(root, "case")).first_selected_option.text == found["case"]
    found = found["surface"]
    assert maximum(root) == pytest.approx(found["max_von_mises"], rel=ROUND_OFF)
    at = [float(part(root, "z").get_property("value"))]
    assert at[0] == pytest.approx(found["location"][2], rel=1e-4, abs=1e-4)
    if not part(root, "beneath").is_displayed():
        assert probed(root) == pytest.approx(found["max_von_mises"], rel=0.01)
    assert part(root, "cut").is_selected() or probed(root) == pytest.approx(
        found["max_von_mises"], rel=0.01
    )
    if not part(root, "cut").is_selected():
        part(root, "cut").click()
    assert probed(root) == pytest.approx(found["max_von_mises"], rel=0.01)
    wait(page, lambda: part(root, "told").get_attribute("data-seen") == "true")
    assert errors(page) == []


def test_the_pointer_probes_what_is_under_it(page: Any, gear_run: Path) -> None:
    from selenium.webdriver import ActionChains

    root = view(page, "J")
    surface = canvas(root)
    x, y = marked(root)
    half = surface.size["width"] / 2, surface.size["height"] / 2
    page.execute_script("arguments[0].scrollIntoView({ block: 'center' });", surface)
    over = ActionChains(page)
    over.move_to_element_with_offset(surface, round(x - half[0]), round(y - half[1])).perform()
    # A pixel off, it may be in the excluded zone that the maximum borders on.
    wait(page, lambda: part(root, "tip").is_displayed())
    over.move_to_element_with_offset(surface, round(x - half[0]) + 4, round(y - half[1])).click()
    over.perform()
    largest = result(gear_run, "J", "landing")["max_von_mises"]
    assert 0.9 * largest < probed(root) <= 1.0001 * largest
    assert part(root, "tip").text.startswith("von Mises stress")
    assert "psi, safety factor" in part(root, "tip").text
    over.move_to_element_with_offset(surface, 5 - int(half[0]), 5 - int(half[1])).click().perform()
    assert part(root, "probed").text == "No point of the pin is there."


def test_the_keyboard_does_it_all(page: Any, gear_run: Path) -> None:
    """Case, instant, view, cut and probe without a pointer."""
    from selenium.webdriver import ActionChains, Keys
    from selenium.webdriver.support.ui import Select

    root = view(page, "E")
    before = pixels(page, root)
    for keys in ((Keys.ARROW_UP,), ("+",), (Keys.SHIFT, Keys.ARROW_LEFT)):
        ActionChains(page).move_to_element(canvas(root)).perform()
        page.execute_script("arguments[0].focus();", canvas(root))
        pressing = ActionChains(page)
        for key in keys[:-1]:
            pressing.key_down(key)
        pressing.send_keys(keys[-1])
        for key in keys[:-1]:
            pressing.key_up(key)
        pressing.perform()
        changed(page, root, before)
        before = pixels(page, root)
    part(root, "cut").send_keys(Keys.SPACE)
    assert part(root, "cut").is_selected()
    wait(page, lambda: part(root, "radius").is_displayed())
    largest = result(gear_run, "E", "landing")["max_von_mises"]
    at_maximum = probed(root)
    assert at_maximum == pytest.approx(largest, rel=0.01)
    surface = float(part(root, "radius").get_property("value"))
    part(root, "radius").clear()
    part(root, "radius").send_keys(f"{1.0005 * surface:.6f}")  # beyond it by round-off
    assert probed(root) == pytest.approx(largest, rel=0.02)
    part(root, "radius").clear()
    part(root, "radius").send_keys("0.1")
    assert probed(root) < 0.5 * largest
    assert "radius 0.1 in" in part(root, "probed").text
    part(root, "cut").send_keys(Keys.SPACE)
    part(root, "angle").clear()
    part(root, "angle").send_keys("45")
    assert "angle 45°" in part(root, "probed").text
    part(root, "maximum").send_keys(Keys.ENTER)
    assert probed(root) == pytest.approx(largest, rel=0.01)
    Select(part(root, "case")).select_by_visible_text("retract")
    told = part(root, "told").text
    part(root, "time").send_keys(Keys.ARROW_LEFT)
    assert part(root, "told").text != told
    assert errors(page) == []


def test_loads_and_limits_are_told(page: Any, gear_run: Path) -> None:
    root = view(page, "E")
    assert "E2 194,800 lbf" in part(root, "loads").text
    assert "E1 clamped" in part(root, "loads").text
    assert "required factor 10" in part(root, "marks").text
    assert "yield" in part(root, "marks").text
    *ticks, last = part(root, "ticks").text.split()
    assert ticks == ["0", "200,000", "400,000"]
    assert last == engineering(result(gear_run, "E", "landing")["max_von_mises"], 3)


def test_a_moved_slider_closes_the_cut(page: Any) -> None:
    """A section is known at the governing instant, undeformed."""
    from selenium.webdriver.support.ui import Select

    root = view(page, "J")
    Select(part(root, "case")).select_by_visible_text("retract")
    part(root, "cut").click()
    slide(page, part(root, "time"), 0)
    assert not part(root, "cut").is_selected()
    part(root, "cut").click()
    assert "the governing instant" in part(root, "told").text
    slide(page, part(root, "deform"), 50)
    assert not part(root, "cut").is_selected()


def test_without_webgl_the_page_says_so(page: Any, gear_run: Path) -> None:
    source = "HTMLCanvasElement.prototype.getContext = () => null;"
    command = {"source": source}
    added = page.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", command)
    try:
        opened(page, gear_run)
        said = page.find_elements("css selector", "[data-unseen]")
        assert len(said) == 9
        assert "WebGL 2" in said[0].get_property("textContent")
        assert not any(text.get_property("hidden") for text in said)
        assert not any(v.is_displayed() for v in page.find_elements("css selector", "[data-view]"))
    finally:
        page.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", added)


def test_maxima_along_the_pin_are_a_table(page: Any, gear_run: Path) -> None:
    """For those who see no picture: the largest of the segments is that of the surface."""
    root = view(page, "J")
    rows = root.find_elements("xpath", "following-sibling::details[@class='along'][1]//tbody/tr")
    cells = [
        [cell.get_property("textContent") for cell in row.find_elements("css selector", "td")]
        for row in rows
    ]
    assert "J2" in [row[0] for row in cells]
    largest = max(float(row[5].replace(",", "")) for row in cells if row[5] != "–")
    assert largest == pytest.approx(result(gear_run, "J", "landing")["max_von_mises"], rel=2e-3)


def test_an_instant_without_load_has_no_factor(browser: Any, tmp_path: Path) -> None:
    """Its factor is infinite, which ended the script: the numbers of the instant before stayed."""
    (tmp_path / "loads.csv").write_text("connection,fx,fy,time\nB,0,0,0\nB,0,-900,1\n")
    stated = next(line for line in QUICK.splitlines() if line.startswith("forces"))
    (tmp_path / "study.toml").write_text(QUICK.replace(stated, 'table = "loads.csv"'))
    run = run_here("run", "study.toml", "--out", "out", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    opened(browser, tmp_path / "out")
    root = view(browser, "B")
    slide(browser, part(root, "time"), 0)
    told = part(root, "told").text
    assert "t = 0 s: maximum von Mises stress" in told
    assert " 0 psi; safety factor – (converged)." in told
    assert part(root, "probed").text.startswith("von Mises stress 0 psi, safety factor –; z = ")
    assert errors(browser) == []

"""Contact pressure on the view of a pin in its lugs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from reports.format.numbers import engineering
from tests.support.results.browser_page import errors, opened, part, pixels, slide, view, wait

pytestmark = pytest.mark.browser

DATA = "unpacked(JSON.parse(arguments[0].querySelector('script').textContent))"
PRESSURES = f"""
return {DATA}.then((data) => {{
  const chosen = caseOf(data.cases[0]), surface = surfaceOf(data.surfaces[0]);
  const at = meshOf(surface, chosen).places, turn = 180 / Math.PI;
  const vertices = [...pressing(surface, chosen)].map((p, v) =>
    [at[3 * v + 2], turn * Math.atan2(at[3 * v + 1], at[3 * v]), p]);
  return {{ top: chosen.pressure.top, vertices }};
}});
"""
READ = f"""
return {DATA}.then((data) => {{
  const chosen = caseOf(data.cases[0]), surface = surfaceOf(data.surfaces[0]);
  return chosen.maxima.map((largest, k) => {{
    const {{ value }} = superposed(surface, chosen, k), unread = unreadOf(surface, chosen, k);
    const seen = Math.max(...value.filter((_, v) => !unread[v]));
    return [unread.reduce((n, x) => n + x, 0), seen, largest];
  }});
}});
"""


@pytest.fixture
def page(browser: Any, clevis_run: Path) -> Any:
    opened(browser, clevis_run)
    return browser


def pressed(folder: Path) -> list[list[float]]:
    """Cells with pressure: z from and to, angle from and to in degrees."""
    (row,) = json.loads((folder / "results.json").read_text(encoding="utf-8"))["pins"]
    return [cell for band in row["contact"]["bands"] for cell in band["pressed"]]


def test_the_view_can_show_the_pressure(page: Any, clevis_run: Path) -> None:
    from selenium.webdriver.support.ui import Select

    root = view(page, "P")
    before = pixels(page, root)
    Select(part(root, "colour")).select_by_visible_text("cell mean pressure")
    wait(page, lambda: pixels(page, root) != before)
    assert part(root, "unit").text == "cell mean pressure [MPa]"
    found = page.execute_script(PRESSURES, root)
    assert f"≥ {engineering(found['top'], 3)}" in part(root, "ticks").text
    # most of what is pressed is below the last colour, and all of it is in cells with pressure
    some = [v for v in found["vertices"] if v[2] > 0.0]
    assert 0.5 < sum(p <= found["top"] for _, _, p in some) / len(some) < 1.0
    cells = pressed(clevis_run)
    for z, angle, _ in some:
        assert any(
            z0 - 1e-3 <= z <= z1 + 1e-3 and abs((angle - (a0 + a1) / 2 + 180) % 360 - 180) < 6.0
            for z0, z1, a0, a1 in cells
        )
    assert errors(page) == []


def test_what_lugs_press_on_is_hidden_and_nothing_shown_exceeds_the_maximum(page: Any) -> None:
    """At the edges of lugs colours would say how small cells are."""
    root = view(page, "P")
    assert part(root, "lugs").is_displayed()
    assert "of the surface" in part(root, "told").text
    cases = page.execute_script(READ, root)
    assert len(cases) >= 2
    for hidden, seen, largest in cases:
        assert seen <= 1.005 * largest  # thinning leaves 8e-3 of a point's own stress
        assert hidden > 0


def test_at_another_instant_stress_is_shown_again(page: Any) -> None:
    """The pressure is known at the governing instant, to which choosing it returns."""
    from selenium.webdriver.support.ui import Select

    root = view(page, "P")
    time, colour = part(root, "time"), Select(part(root, "colour"))
    governing = time.get_property("value")
    slide(page, time, 0)
    colour.select_by_visible_text("cell mean pressure")
    assert time.get_property("value") == governing != "0"
    slide(page, time, 0)
    assert colour.first_selected_option.text == "von Mises stress"
    assert part(root, "unit").text == "von Mises stress [MPa]"

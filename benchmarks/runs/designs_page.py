"""The page of designs in Chromium: its size, the time until it can be used, and the time of a frame
while brushing; and the same lines drawn by Vega, which the report contains.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

import pyarrow as pa

from benchmarks.runs.page import chromium
from benchmarks.timing import table
from pinstress.explore.sweep.design_columns import designs_of
from pinstress.explore.sweep.page import render_designs
from reports.format.template import VENDOR_FOLDER
from tests.support.results.made_up_designs import made_up_designs

if TYPE_CHECKING:
    from selenium.webdriver import Chrome

COUNTS = (1_000, 10_000, 100_000)
BY_VEGA = 10_000
PARAMETERS = 5  # with mass, stress and factor 8 axes
STEPS = 40
STEPS_OF_VEGA = 8
READY = "return performance.getEntriesByName('ready')[0]?.startTime;"
# A range moves up along the axis of the first column, one step in every frame. The script returns
# for every step the time of the scripts, and that from frame to frame, ms.
BRUSH = """
const [steps, done] = arguments, scripts = [], frames = [], scale = page.now().values[0];
let low = Infinity, high = -Infinity, k = 0, before = 0;
for (const v of scale) { low = Math.min(low, v); high = Math.max(high, v); }
const step = (moment) => {
  if (before) frames.push(moment - before);
  before = moment;
  if (k > steps) return done([scripts.slice(1), frames.slice(1)]);
  const start = performance.now(), from = low + (0.6 * k * (high - low)) / steps;
  page.ranges.set(0, [from, from + 0.4 * (high - low)]);
  page.redraw(false, true);
  scripts.push(performance.now() - start);
  k++;
  requestAnimationFrame(step);
};
requestAnimationFrame(step);
"""
VEGA = """
const [steps, done] = arguments;
(async () => {
  for (let k = 0; k < steps; k++) await view.signal("low", (0.6 * k) / steps).runAsync();
  done();
})();
"""


def designs_page() -> str:
    """Return the table of sizes, times and frames of pages of few and of many designs."""
    with tempfile.TemporaryDirectory() as folder:
        rows = [_row(count, Path(folder) / f"{count}.html") for count in COUNTS]
        by_vega = _vega(made_up_designs(BY_VEGA, PARAMETERS), Path(folder) / "vega.html")
    head = ("designs", "MB", "ready, s", "processor, ms", "scripts: least, ms", "median")
    told = (
        f"{PARAMETERS + 3} axes, and {STEPS} steps of a range that moves along one of them. Of "
        "each step the processor time of the page's thread, which other work does not "
        "stretch, and the time by the clock, which it does:"
    )
    vega = f"The lines of {BY_VEGA:,} designs by Vega on a canvas: {by_vega:.0f} ms of processor."
    return f"{told}\n\n{table((*head, 'frame: least, ms', 'median'), rows)}\n\n{vega}"


def _row(count: int, path: Path) -> tuple[object, ...]:
    designs = designs_of(made_up_designs(count, PARAMETERS))
    path.write_text(render_designs(designs), encoding="utf-8")
    browser = _opened(path)
    try:
        ready = _until(browser) / 1e3
        before = _processor(browser)
        scripts, frames = browser.execute_async_script(BRUSH, STEPS)
        spent = 1e3 * (_processor(browser) - before) / STEPS
        size = path.stat().st_size / 1e6
        spread = [spent, min(scripts), median(scripts), min(frames), median(frames)]
        return (count, size, ready, *(float(f"{t:.3g}") for t in spread))
    finally:
        browser.quit()


def _opened(path: Path) -> Chrome:
    browser = chromium()
    browser.set_script_timeout(300)
    browser.execute_cdp_cmd("Performance.enable", {"timeDomain": "threadTicks"})
    browser.get(path.as_uri())
    return browser


def _processor(browser: Chrome) -> float:
    """Return the processor time of the page's thread, s."""
    told = browser.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
    return float(next(m["value"] for m in told if m["name"] == "TaskDuration"))


def _until(browser: Chrome) -> float:
    from selenium.webdriver.support.ui import WebDriverWait

    return float(WebDriverWait(browser, 120).until(lambda _: browser.execute_script(READY)))


def _vega(designs: pa.Table, path: Path) -> float:
    """Return the time of a step by Vega, ms; lines in a range are dark, the others light, as on the
    page.
    """
    found = designs_of(designs)
    columns = [c.values for c in found.parameters]
    columns += [c.values for c in found.results if c.key in ("mass", "max_von_mises")]
    columns += [c.values for c in found.results if c.key == "safety_factor"]
    lines = [
        {"d": d, "k": k, "y": float(c[d]) / float(max(c[c == c])), "first": float(columns[0][d])}
        for d in range(len(found.numbers))
        for k, c in enumerate(columns)
        if c[d] == c[d]
    ]
    grouped = {"facet": {"name": "lines", "data": "points", "groupby": "d"}}
    chosen = "inrange(datum.first / 30, [low, low + 0.4])"
    mark = {
        "type": "line",
        "from": {"data": "lines"},
        "encode": {
            "enter": {"x": {"scale": "x", "field": "k"}, "y": {"scale": "y", "field": "y"}},
            "update": {
                "stroke": [{"test": chosen, "value": "#0b5cad"}, {"value": "#e3e6ea"}],
                "strokeOpacity": {"value": 0.2},
            },
        },
    }
    spec = {
        "width": 1300,
        "height": 300,
        "signals": [{"name": "low", "value": 0}],
        "data": [{"name": "points", "values": lines}],
        "scales": [
            {"name": "x", "type": "linear", "domain": [0, len(columns) - 1], "range": "width"},
            {"name": "y", "type": "linear", "domain": [0, 1], "range": "height"},
        ],
        "marks": [{"type": "group", "from": grouped, "marks": [mark]}],
    }
    scripts = "".join(
        f"<script>{text}</script>"
        for text in (
            (VENDOR_FOLDER / "vega.min.js").read_text(encoding="utf-8"),
            f"const spec = {json.dumps(spec)}; let view = new vega.View(vega.parse(spec), "
            "{renderer: 'canvas', container: '#v'}); view.runAsync()"
            ".then(() => performance.mark('ready'));",
        )
    )
    path.write_text(f"<!DOCTYPE html><div id='v'></div>{scripts}", encoding="utf-8")
    browser = _opened(path)
    try:
        _until(browser)
        before = _processor(browser)
        browser.execute_async_script(VEGA, STEPS_OF_VEGA)
        return 1e3 * (_processor(browser) - before) / STEPS_OF_VEGA
    finally:
        browser.quit()

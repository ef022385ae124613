"""The page of a study of many pins in Chromium: opened, the last pin's 3D view shown, all parts
unfolded.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.timing import table

if TYPE_CHECKING:
    from selenium.webdriver import Chrome

PINS = (10, 100)
CASES = ("static", "gust")
RUNS = 3
HEAD = """
title = "Many pins"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
density = "7850 kg/m^3"
yield_strength = "355 MPa"

[analysis]
required_safety_factor = 2
tolerance = 0.05
"""
PIN = """
[pin.{0}]
material = "steel"
clamp = ["start"]
profile = [
  {{ length = 20, diameter = {2}, name = "root" }},
  {{ length = 25, diameter = {1}, connection = "{0}.1" }},
  {{ length = 5, diameter = {1} }},
  {{ length = 25, diameter = {1}, connection = "{0}.2" }},
]
fillet = 3
"""
LOADED = """
const done = arguments[arguments.length - 1];
const { loadEventEnd } = performance.getEntriesByType("navigation")[0];
requestAnimationFrame(() => setTimeout(() => done(loadEventEnd), 0));
"""
NODES = "return document.querySelectorAll('*').length;"
HEAP = "return performance.memory.usedJSHeapSize / 1e6;"
OPEN_PIN = "document.querySelector('section.pin:last-of-type details.fold').open = true;"
VIEW = "return document.querySelector('section.pin:last-of-type [data-is=told]')?.textContent;"
SCROLL = "document.querySelector('section.pin:last-of-type').scrollIntoView();"
# The time from a click to the next frame, for which a reader waits.
FRAME = """
const done = arguments[arguments.length - 1], start = performance.now();
document.getElementById("unfold").click();
requestAnimationFrame(() => setTimeout(() => done(performance.now() - start), 0));
"""


def many_pins(number: int) -> str:
    """Return a study of `number` stepped pins, all different, under two static cases."""
    names = [f"P{k:03d}" for k in range(number)]
    pins = [PIN.format(name, 20 + 0.2 * k, 40 + 0.2 * k) for k, name in enumerate(names)]
    cases = []
    for case, part in zip(CASES, (300, 900), strict=True):
        forces = ", ".join(
            f'"{name}.1" = [{500 + 10 * k}, -{part}], "{name}.2" = [{-200 - 7 * k}, 150]'
            for k, name in enumerate(names)
        )
        cases.append(f'[case.{case}]\nkind = "given"\nforces = {{ {forces} }}\n')
    return "\n".join([HEAD, *pins, *cases])


def page() -> str:
    """Return the table of size, nodes, memory and times of pages of few and of many pins."""
    with tempfile.TemporaryDirectory() as folder:
        rows = [_row(number, Path(folder) / str(number)) for number in PINS]
    head = ("pins", "MB", "nodes", "loaded, s", "scripts' memory, MB")
    more = ("3D view of the last pin, s", "all parts open, s", "nodes then")
    return f"Minimum of {RUNS} openings:\n\n{table((*head, *more), rows)}"


def _row(number: int, folder: Path) -> tuple[object, ...]:
    folder.mkdir()
    study = folder / "many.toml"
    study.write_text(many_pins(number), encoding="utf-8")
    command = [sys.executable, "-m", "pinstress", "run", str(study), "--out", str(folder / "out")]
    subprocess.run([*command, "--vtk", "none", "--quiet"], capture_output=True, check=False)
    report = folder / "out" / "report.html"
    found = [_opened(report) for _ in range(RUNS)]
    nodes, later = found[0][0], found[0][-1]
    least = [min(column) for column in list(zip(*found, strict=True))[1:-1]]
    size = report.stat().st_size / 1e6
    return (number, size, nodes, *least, later)


def _opened(report: Path) -> tuple[Any, ...]:
    """Return the measurements of a page in a browser.

    These are: nodes, time until loaded, s, memory of scripts, MB, time until the last pin's view is
    drawn, s, time until all parts are open, s, and the number of nodes then.
    """
    browser = chromium()
    try:
        browser.get(report.as_uri())
        loaded = browser.execute_async_script(LOADED) / 1e3
        nodes, heap = browser.execute_script(NODES), browser.execute_script(HEAP)
        view = _until(browser, SCROLL + OPEN_PIN, lambda: browser.execute_script(VIEW))
        everything = browser.execute_async_script(FRAME) / 1e3
        later = browser.execute_script(NODES)
        return nodes, loaded, heap, view, everything, later
    finally:
        browser.quit()


def _until(browser: Chrome, script: str, ready: Callable[[], object]) -> float:
    start = time.perf_counter()
    browser.execute_script(script)
    while not ready():
        time.sleep(0.005)
    return time.perf_counter() - start


def chromium() -> Chrome:
    """Return a headless browser with WebGL in software."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium") or "chromium"
    arguments = ["--headless", "--window-size=1400,900", "--use-angle=swiftshader"]
    arguments += ["--enable-unsafe-swiftshader", "--enable-precise-memory-info"]
    for argument in [*arguments, *(["--no-sandbox"] if os.geteuid() == 0 else [])]:
        options.add_argument(argument)
    return webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))

"""A browser without network, and the pages that it opens from disk."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tests.support.pins.clevis import CLEVIS
from tests.support.programs.once import once
from tests.support.study_text import edited

ROOT = Path(__file__).parents[2]
STUDIES = ROOT / "studies"
ODD = 'Ünit <img src=x onerror="document.title=1"> & "q" \' 😀 שלום {{ 1 }}'
PIN = "bolt &'😀שלום"  # which may be no part of a path
WITHOUT_NETWORK = ("--host-resolver-rules=MAP * ~NOTFOUND", "--disable-background-networking")
WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium, headless, with WebGL in software and nothing to reach but files."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = _program("chromium")
    for argument in ("--headless", "--window-size=1300,1000", *WITHOUT_NETWORK, *WEBGL):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(_program("chromedriver")))
    try:
        yield driver
    finally:
        driver.quit()


def _program(name: str) -> str:
    path = shutil.which(name)
    assert path is not None, f"{name} is missing: make test-browser installs it or says how"
    return path


@pytest.fixture(scope="session")
def gear_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the landing gear's run, as the command writes it."""
    study = STUDIES / "grenier2008.toml"
    return once(tmp_path_factory, "gear", lambda folder: run(study, folder / "out")) / "out"


@pytest.fixture(scope="session")
def shipped_loads(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the excavator's loads, as the command writes it."""
    study = STUDIES / "excavator.toml"
    command = partial(run, study, command="loads")
    return once(tmp_path_factory, "loads", lambda folder: command(folder / "out")) / "out"


@pytest.fixture(scope="session")
def odd_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study whose names and texts are not to be taken for markup."""
    directory = tmp_path_factory.mktemp("odd")
    text = (STUDIES / "one_pin.toml").read_text(encoding="utf-8")
    quoted = _quoted(ODD)
    changes = {
        'title = "One pin"': f"title = {quoted}\nassumptions = [{quoted}]",
        "[pin.B]": f'[pin."{PIN}"]',
        'name = "root"': f"name = {_quoted('root ' + ODD)}",
        'connection = "B"': f"connection = {quoted}",
        "B = [0.0, -988.86]": f"{quoted} = [0.0, -988.86]",
        '"AISI 4340"': quoted,
    }
    study = directory / "odd.toml"
    study.write_text(edited(text, changes.items()), encoding="utf-8")
    return run(study, directory / "out")


@pytest.fixture(scope="session")
def clevis_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a pin in its lugs under loads at three instants; the second governs."""
    return once(tmp_path_factory, "clevis", _run_clevis) / "out"


def _run_clevis(directory: Path) -> None:
    stated = next(line for line in CLEVIS.splitlines() if line.startswith("forces"))
    study = directory / "clevis.toml"
    study.write_text(CLEVIS.replace(stated, 'table = "loads.csv"'), encoding="utf-8")
    rows = [
        f"{name},{part * size},0,{time}"
        for time, size in enumerate((20000, 50000, 10000))
        for name, part in (("L", -0.5), ("M", 1.0), ("R", -0.5))
    ]
    table = "\n".join(["connection,fx,fy,time", *rows])
    (directory / "loads.csv").write_text(table + "\n", encoding="utf-8")
    run(study, directory / "out")


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def run(study: Path, out: Path, *options: str, command: str = "run") -> Path:
    """The folder of a study's run, as the command writes it."""
    words = [sys.executable, "-m", "pinstress", command, str(study), "--out", str(out), *options]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    return out

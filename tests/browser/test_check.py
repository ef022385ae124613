"""The page of `pinstress check --open`: laid out on any screen, and accessible."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.browser.test_pins import AXE, FAULTS, WIDER
from tests.conftest import ROOT
from tests.support.each import sampled
from tests.support.programs.command_line import run_here
from tests.support.results.browser_page import errors, screen

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def check_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of the landing gear."""
    folder = tmp_path_factory.mktemp("check")
    study = ROOT / "studies" / "landing_gear.toml"
    assert run_here("check", str(study), "--out", "check.html", cwd=folder).returncode == 0
    return folder / "check.html"


@pytest.fixture
def page(browser: Any, check_page: Path) -> Any:
    browser.get(check_page.as_uri())
    return browser


@pytest.mark.parametrize("width", sampled([1400, 1024, 390], every=2))
def test_it_fits_and_shows_linkage_pins_and_rows(page: Any, width: int) -> None:
    with screen(page, width):
        assert page.execute_script(WIDER) == []
        assert len(page.find_elements("css selector", "svg.linkage")) == 2
        assert len(page.find_elements("css selector", "svg.pin")) == 9
        assert len(page.find_elements("css selector", "tbody tr")) == 18
        first = page.find_element("css selector", "svg.linkage")
        assert first.location["y"] + first.size["height"] < 900
    assert errors(page) == []


@pytest.mark.parametrize("shade", ["light", "dark"])
def test_axe_finds_nothing(page: Any, shade: str) -> None:
    with screen(page, 1400, shade=shade):
        page.execute_script(AXE.read_text(encoding="utf-8"))
        page.set_script_timeout(300)
        assert page.execute_async_script(FAULTS) == []

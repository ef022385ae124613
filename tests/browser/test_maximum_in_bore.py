"""The probe at a maximum in a bore, which cannot be struck from outside."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from reports.format.numbers import engineering
from tests.browser.conftest import STUDIES, run
from tests.support.results.browser_page import errors, opened, part, view

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def tube_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The shipped clevis with a wide bore, which lugs make oval: it is most stressed inside."""
    folder = tmp_path_factory.mktemp("tube")
    text = (STUDIES / "clevis.toml").read_text(encoding="utf-8")
    study = folder / "tube.toml"
    study.write_text(text.replace("diameter = 20", "diameter = 20, bore = 12"), encoding="utf-8")
    return run(study, folder / "out")


def test_the_probe_reads_it_where_it_is(browser: Any, tube_run: Path) -> None:
    (row,) = json.loads((tube_run / "results.json").read_text(encoding="utf-8"))["pins"]
    x, y, _ = row["surface"]["location"]
    assert abs((x * x + y * y) ** 0.5 - 6.0) < 1e-6  # what the test is about
    opened(browser, tube_run)
    root = view(browser, "P")
    part(root, "maximum").click()
    told = part(root, "probed").text
    assert told.startswith(f"von Mises stress {engineering(row['surface']['max_von_mises'])} MPa")
    assert "radius 6 mm" in told
    assert errors(browser) == []

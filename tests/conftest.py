"""Fixtures that several rooms share."""

from __future__ import annotations

from pathlib import Path

import pytest

from fea.material import Material
from geometry import Pin, Segment
from loads import Linkage
from pinstress import load_study
from pinstress.mechanism import linkage
from pinstress.study import Study

ROOT = Path(__file__).parent.parent
INCH = 0.0254
LBF = 0.45359237 * 9.80665
PSI = LBF / INCH**2


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Tests that need other programs are left out unless `-m` names them.

    Here and not in addopts, where any other `-m` would bring them back.
    """
    for mark in ("peers", "browser"):
        if mark in config.getoption("markexpr"):
            continue
        left_out = [item for item in items if item.get_closest_marker(mark)]
        if left_out:
            config.hook.pytest_deselected(items=left_out)
            items[:] = [item for item in items if item not in left_out]


@pytest.fixture(scope="session")
def gear() -> Study:
    """The landing gear as it ships."""
    return load_study(ROOT / "studies" / "grenier2008.toml")


@pytest.fixture(scope="session")
def gear_linkage(gear: Study) -> Linkage:
    return linkage(gear)


@pytest.fixture(scope="session")
def steel() -> Material:
    return Material("steel", 2.0e11, 0.3, 7850.0, 1.0e9)


@pytest.fixture(scope="session")
def cantilever_pin() -> Pin:
    """20 mm shaft on a 30 mm root, 5 mm fillet, loaded over its last 20 mm."""
    return Pin(
        "P",
        (Segment(0.02, 0.03), Segment(0.02, 0.02), Segment(0.02, 0.02, connection="P1")),
        fillet=0.005,
    )

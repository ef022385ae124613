"""Contact pressure at points of a surface is that of the cell on which they are."""

from __future__ import annotations

import numpy as np
import pytest

from fea.support.bands import Bands
from fea.support.cell_pressure import CellPressure

RADIUS = 0.01


@pytest.fixture(scope="module")
def cells() -> CellPressure:
    """A band from z = 0 to 0.03 in two rings, one from 0.05 to 0.06 on a larger radius."""
    bands = Bands(
        np.array([0.005, 0.02, 0.055]), np.array([0.01, 0.02, 0.01]),
        np.array([RADIUS, RADIUS, 2 * RADIUS]), np.array([0, 0, 1]), np.zeros(3),
    )  # fmt: skip
    return CellPressure(bands, np.arange(24.0).reshape(3, 8) + 100.0)


def point(angle: float, z: float, radius: float = RADIUS) -> list[float]:
    t = np.radians(angle)
    return [radius * np.cos(t), radius * np.sin(t), z]


@pytest.mark.parametrize(
    ("angle", "z", "radius", "pressure"),
    [
        (0.0, 0.005, RADIUS, 100.0),
        (22.0, 0.005, RADIUS, 100.0),
        (23.0, 0.005, RADIUS, 101.0),
        (-22.0, 0.005, RADIUS, 100.0),
        (-23.0, 0.005, RADIUS, 107.0),
        (180.0, 0.029, RADIUS, 112.0),
        (90.0, 0.0, RADIUS, 102.0),  # on the band's end
        (90.0, 0.03, RADIUS, 110.0),
        (90.0, 0.0301, RADIUS, 0.0),
        (90.0, 0.055, RADIUS, 0.0),  # inside of the larger band
        (90.0, 0.055, 2 * RADIUS, 118.0),
        (90.0, 0.005, 0.9 * RADIUS, 0.0),
        (0.0, 0.005, 0.0, 0.0),
    ],
)
def test_points(
    cells: CellPressure, angle: float, z: float, radius: float, pressure: float
) -> None:
    assert cells.at(np.array([point(angle, z, radius)])).tolist() == [pressure]


def test_the_pressure_has_the_forces_of_its_cells(cells: CellPressure) -> None:
    """Integrated over points in the middle of many small parts."""
    angles = (np.arange(720) + 0.5) * 0.5
    points = np.array([point(a, 0.02) for a in angles])
    mean = cells.at(points).mean()
    assert mean == pytest.approx(cells.pressure[1].mean(), rel=1e-12)

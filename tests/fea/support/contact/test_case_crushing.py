"""Stress beneath pressure against the line contact of Hertz, in closed form.

Reference: K. L. Johnson, Contact Mechanics (1985), (4.49); von Mises 0.558 p0 at 0.70 b, nu = 0.3.
"""

import numpy as np
import pytest

from fea.support.contact.case_crushing import beneath_strips, pressed_most


def on_axis(z: np.ndarray, nu: float) -> np.ndarray:
    """Von Mises stress over p0 below the middle of a line contact, z in half widths."""
    root = np.sqrt(1.0 + z**2)
    along, down = -((1.0 + 2.0 * z**2) / root - 2.0 * z), -1.0 / root
    across = nu * (along + down)
    square = (along - down) ** 2 + (down - across) ** 2 + (across - along) ** 2
    return np.asarray(np.sqrt(0.5 * square))


def pressure(count: int, half: float, width: float) -> np.ndarray:
    x = (np.arange(count) - count // 2) * width / half
    return np.asarray(np.sqrt(np.maximum(1.0 - x**2, 0.0)))


def test_line_contact_of_hertz() -> None:
    count, half = 4096, 1.0
    width = 40.0 * half / count
    depths = np.array([0.5, 0.7, 1.0, 1.5, 2.0])
    stress = beneath_strips(pressure(count, half, width), width, depths, 0.3)
    assert stress == pytest.approx(on_axis(depths, 0.3), rel=2e-3)
    assert stress[1] == pytest.approx(0.558, abs=1e-3)


def test_core_deeper_than_that_is_crushed_by_less() -> None:
    width = 0.01
    p = pressure(4096, 1.0, width)
    at = np.linspace(0.3, 2.0, 35)
    stress = beneath_strips(p, width, at, 0.3)
    assert at[stress.argmax()] == pytest.approx(0.7, abs=0.06)
    # A core with half of p0 as its strength is safe from 1.5 half widths on, not from 0.5.
    assert stress[at >= 1.5].max() == pytest.approx(
        float(on_axis(np.array([1.5]), 0.3)[0]), rel=5e-3
    )
    assert stress[at >= 1.5].max() < 0.50 < stress[at >= 0.5].max()


def test_a_lug_of_a_structure_is_pressed_most_where_no_link_pulls_most() -> None:
    """It takes what two links leave, most of it where these pull alike."""
    first, second = np.array([10.0, 8.0, -9.0]), np.array([-9.0, 8.0, 10.0])
    along = np.stack([first, second, -first - second], axis=1)
    forces = np.stack([along, np.zeros_like(along)], axis=2)
    assert pressed_most(forces).tolist() == [0, 1, 2]
    assert pressed_most(forces[:, :2]).tolist() == [0, 2]

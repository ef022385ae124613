"""What the drives of a case at one instant exert."""

from __future__ import annotations

import numpy as np

from pinstress.analysis.mechanics.gather_space import drives


def test_round_off_of_a_drive_beside_a_strong_one_is_zero() -> None:
    """It was printed as a power of −221.1×10⁻¹² N mm/s of a drive at rest."""
    at_rest = np.zeros((1, 3))
    energies = np.zeros(1), np.zeros(1)
    exerted = np.array([[3e4, -8e3, -1e-34]]), np.array([[5e3, -2e-13, 1e-6]])
    names = [("boom", True), ("stick", True), ("bucket", True)]
    tables = drives("jerk", names, None, (at_rest,) * 3, exerted, energies, None)
    assert [float(t.force[0]) for t in tables] == [3e4, -8e3, 0.0]
    assert [float(t.power[0]) for t in tables] == [5e3, 0.0, 1e-6]

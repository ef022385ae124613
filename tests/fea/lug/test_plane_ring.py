"""A ring under pressures inside and outside against closed forms in plane stress."""

import numpy as np
import pytest

from fea.core.material import Material
from fea.lug.plane_contact import in_plane_stress
from fea.lug.plane_ring import ring_fields
from fea.support.foundation.plane_contact import lug_harmonics

BRONZE = Material("bronze", 110e9, 0.34)
A, B = 0.01, 0.013


@pytest.mark.parametrize(("outer", "close"), [(B, 1e-9), (2.0 * A, 1e-5), (1.05 * A, 1e-8)])
def test_pressure_in_the_bore_is_michells(outer: float, close: float) -> None:
    ring = ring_fields(A, outer, BRONZE, 12)
    exact = lug_harmonics(A, outer, in_plane_stress(BRONZE))
    for n in (0, *range(2, 13)):
        assert ring.flexibility[n, 0, 0] == pytest.approx(exact[n], rel=close)


def test_even_pressures_are_lames() -> None:
    ring = ring_fields(A, B, BRONZE, 0)
    E, nu, area = BRONZE.youngs_modulus, BRONZE.poisson_ratio, B * B - A * A
    hoop = [[(B * B + A * A) / area, -2.0 * B * B / area]]
    hoop += [[2.0 * A * A / area, -(B * B + A * A) / area]]
    moves = [[A / E * (hoop[0][0] + nu), -2.0 * A * B * B / (E * area)]]
    moves += [[-2.0 * B * A * A / (E * area), B / E * ((B * B + A * A) / area - nu)]]
    assert ring.hoop[0] == pytest.approx(np.array(hoop), rel=1e-9)
    assert ring.flexibility[0] == pytest.approx(np.array(moves), rel=1e-9)


def test_a_force_passes_through_the_wall_as_timoshenko_has_it() -> None:
    """Pressure cos theta in the bore in balance with one outside: the terms r^3, 1 / r,
    r ln r and r theta sin theta, the last two in the ratio that gives one value of displacement.
    """
    nu = BRONZE.poisson_ratio
    D = -A / 2.0
    C = -D * (1.0 - nu) / 2.0
    a, b = np.linalg.solve([[2.0 * r, -2.0 / r**3] for r in (A, B)], [-C / r for r in (A, B)])
    exact = [6.0 * a * r + 2.0 * b / r**3 + C / r for r in (A, B)]
    hoop = ring_fields(A, B, BRONZE, 1).hoop[1] @ np.array([1.0, A / B])
    assert hoop == pytest.approx(np.array(exact), rel=1e-8)


def test_work_is_reciprocal_and_short_waves_stay_at_their_wall() -> None:
    ring = ring_fields(A, B, BRONZE, 48)
    both = ring.flexibility * np.array([A, B])[:, None]  # work per angle
    assert both == pytest.approx(both.transpose(0, 2, 1), rel=1e-9, abs=1e-24)
    # what gets through is about 4 n ln(B / A) (A / B)^n: 2e-4
    assert ring.hoop[48] == pytest.approx(-np.eye(2), abs=3e-4)

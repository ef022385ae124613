"""A ring under pressure in its bore, and about a bushing, against closed forms."""

import numpy as np
import pytest

from fea.core.material import Material
from fea.lug.plane_contact import in_plane_stress
from fea.lug.plane_fields import HARMONICS, Elasticity, plane_fields
from fea.support.foundation.plane_contact import lug_harmonics
from geometry import ArgumentError
from geometry.shape.lug_outline import LugOutline

STEEL = Material("steel", 1.0, 0.3)


def test_even_pressure_stresses_a_ring_as_a_tube() -> None:
    fields = plane_fields(LugOutline("ring", 2.0, 6.0), Elasticity(0.3))
    assert fields.bore.hoop[0] == pytest.approx((9.0 + 1.0) / (9.0 - 1.0), rel=3e-3)


def test_flexibility_of_a_ring_is_that_of_michells_solution() -> None:
    """Two derivations: finite elements, and series in powers of r, of plane stress."""
    fields = plane_fields(LugOutline("ring", 2.0, 6.0), Elasticity(0.3), 192)
    exact = lug_harmonics(1.0, 3.0, in_plane_stress(STEEL))
    for n in (0, *range(2, 9)):
        for k in {n, HARMONICS + n if n else n}:  # cosine, sine
            assert fields.flexibility[k, k] == pytest.approx(exact[n], rel=2e-3)
    others = fields.flexibility - np.diag(np.diag(fields.flexibility))
    held = [1, HARMONICS + 1]  # a shift of the whole ring, by the unknowns that hold it
    others[held] = 0.0
    assert np.abs(others).max() < 2e-3 * exact[2]


def test_short_waves_stress_a_bore_as_a_half_plane() -> None:
    """There the hoop stress is the negative pressure."""
    fields = plane_fields(LugOutline("ring", 2.0, 6.0), Elasticity(0.3), 192)
    for n in (6, 8, 10):
        wave = np.cos(n * fields.bore.angles)
        assert fields.bore.hoop[n] == pytest.approx(-wave, abs=0.02)


def test_press_fit_of_a_bushing_in_a_ring() -> None:
    """Exact: Air Force manual, 9.16, in plane stress, psi."""
    E, interference = 10.3e6, 0.001
    outline = LugOutline("ring", 0.375, 1.5, interface=0.5)
    fields = plane_fields(outline, Elasticity(0.33, 16.0 / 10.3, 0.33))
    strain = interference / 0.5 * E
    assert fields.hole is not None
    assert strain * fields.hole.hoop[-1] == pytest.approx(7022.7, rel=3e-3)
    assert strain * fields.hole.radial[-1] == pytest.approx(-5618.2, rel=3e-3)
    assert strain * fields.bore.hoop[-1] == pytest.approx(-25683.0, rel=3e-3)
    assert strain * fields.hole.shear[-1] == pytest.approx(0.0, abs=30.0)


def test_a_bushing_of_the_lugs_material_is_no_bushing() -> None:
    """But for its misfit: the bore's stress is that of one piece."""
    one = plane_fields(LugOutline("round", 2.0, 5.0, 5.0, 10.0, 2.5), Elasticity(0.3))
    outline = LugOutline("round", 2.0, 5.0, 5.0, 10.0, 2.5, interface=2.6)
    two = plane_fields(outline, Elasticity(0.3, 1.0, 0.3))
    assert two.bore.hoop[:9] == pytest.approx(one.bore.hoop[:9], abs=0.03)
    assert two.flexibility[:9, :9] == pytest.approx(one.flexibility[:9, :9], rel=5e-3, abs=5e-3)


def test_the_traction_about_a_bushing_is_in_balance_with_the_pin() -> None:
    outline = LugOutline("round", 2.0, 5.0, 5.0, 10.0, 2.5, interface=2.6)
    hole = plane_fields(outline, Elasticity(0.3, 0.5, 0.34)).hole
    assert hole is not None
    for k, axis in ((1, 0), (HARMONICS + 1, 1)):  # the resultant of a unit pressure is pi
        c, s = np.cos(hole.angles), np.sin(hole.angles)
        x, y = hole.radial[k] * c - hole.shear[k] * s, hole.radial[k] * s + hole.shear[k] * c
        along = np.array([x, y]) * 1.3 * 2.0 * np.pi / len(c)
        assert -along.sum(axis=1)[axis] == pytest.approx(np.pi, rel=2e-3)


@pytest.mark.parametrize(
    ("outline", "code"),
    [
        (("round", 2.0, 2.0, 2.0, 10.0, 1.0), "lug-too-narrow"),
        (("round", 2.0, 5.0, 1.9, 10.0, 2.5), "shank-too-narrow"),
        (("round", 2.0, 5.0, 5.5, 10.0, 2.5), "shank-too-wide"),
        (("tapered", 2.0, 5.0, 5.5, 2.0, 2.5), "shank-too-short"),
        (("square", 2.0, 5.0, 5.0, 10.0, 0.9), "lug-too-narrow"),
        (("round", 2.0, 5.0, 5.0, 10.0, 2.5, 5.0), "lug-too-narrow"),
    ],
)
def test_an_impossible_outline_is_refused(outline: tuple[float, ...], code: str) -> None:
    with pytest.raises(ArgumentError) as error:
        LugOutline(*outline)  # type: ignore[arg-type]
    assert error.value.code == code

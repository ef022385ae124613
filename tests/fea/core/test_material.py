"""Isotropic elasticity: its constants and its limits."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from geometry import ArgumentError
from tests.support.each import each
from tests.support.errors import raises


@each(
    ("modulus", "nu", "code"),
    [
        (0.0, 0.3, "not-positive"),
        (-1.0, 0.3, "not-positive"),
        (float("nan"), 0.3, "not-positive"),
        (2e11, 0.5, "out-of-range"),
        (2e11, -1.0, "out-of-range"),
    ],
)
def test_what_is_no_material_is_refused(modulus: float, nu: float, code: str) -> None:
    with raises(ArgumentError, code, "material steel"):
        Material("steel", modulus, nu)


@each("nu", [-0.5, 0.0, 0.3, 0.49])
def test_hookes_law_the_other_way_round(nu: float) -> None:
    """Strain from stress is the textbook's form: (1 + nu) / E s - nu / E tr s."""
    material = Material("m", 7e10, nu)
    stress = np.array([[3.0, -1.0, 2.0, 0.5, -0.7, 1.1], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
    strain = (1.0 + nu) / 7e10 * stress
    strain[:, :3] -= nu / 7e10 * stress[:, :3].sum(axis=1, keepdims=True)
    np.testing.assert_allclose(material.stress(strain), stress, rtol=1e-12, atol=1e-12)
    lam, mu = material.lame
    assert (3.0 * lam + 2.0 * mu) * mu / (lam + mu) == pytest.approx(7e10)
    assert lam / (2.0 * (lam + mu)) == pytest.approx(nu)

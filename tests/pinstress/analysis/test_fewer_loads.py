"""Surfaces with as few unit loads as make their fields."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.pin_loads import Floats
from fea.core.unit_surface import UnitSurface
from pinstress.analysis.thinning import fewer_loads
from reports.data.surface import SurfaceCase

POINTS, LOADS, INSTANTS, MADE_OF = 30, 24, 40, 3


def surface_case(amounts: Floats, instant: int) -> SurfaceCase:
    """Largest stresses of the fields below are about one per unit."""
    maxima = np.abs(amounts).sum(axis=(1, 2))
    none = np.zeros(POINTS, dtype=bool)
    return SurfaceCase("c", None, instant, amounts, maxima, none, np.zeros(POINTS))


def test_loads_that_vary_together_become_few() -> None:
    """Amounts of 24 unit loads of two harmonics that are made of three courses each: six remain,
    with the same fields at every instant to 1 %, at the governing one to 0.2 %.
    """
    rng = np.random.default_rng(3)
    n = np.repeat([1, 2], LOADS // 2)
    surface = UnitSurface(
        points=np.zeros((POINTS, 3)),
        triangles=np.zeros((0, 3), dtype=np.int64),
        n=n,
        even=(True,) * 8,
        stress=rng.normal(size=(POINTS, 5, LOADS)),
        displacement=1e-9 * rng.normal(size=(POINTS, 3, LOADS)),
    )
    mixes = [rng.normal(size=(MADE_OF, LOADS // 2)) for _ in range(2)]
    courses = rng.normal(size=(2, INSTANTS, 2, MADE_OF))
    amounts = np.concatenate(
        [np.einsum("tpm,mk->tkp", c, m) for c, m in zip(courses, mixes, strict=True)], axis=1
    )
    amounts += 1e-6 * rng.normal(size=amounts.shape)
    case = surface_case(amounts, 7)
    fewer, (other,) = fewer_loads(surface, [case])
    assert fewer.n.tolist() == [1] * MADE_OF + [2] * MADE_OF
    assert other.amounts.shape == (INSTANTS, 2 * MADE_OF, 2)
    for which, first, second in (
        ("stress", surface.stress, fewer.stress),
        ("displacement", surface.displacement, fewer.displacement),
    ):
        full = np.einsum("pik,tkq->tpiq", first, amounts)
        few = np.einsum("pik,tkq->tpiq", second, other.amounts)
        assert few == pytest.approx(full, abs=1e-2 * np.abs(full).max()), which
        assert few[7] == pytest.approx(full[7], abs=2e-3 * np.abs(full[7]).max()), which

"""Stress at turned points: that of every unit load by itself, summed."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from fea.core.pin_loads import LoadAmounts, UnitLoad
from fea.core.voigt import von_mises
from fea.harmonic.fatigue_points import stress_at
from fea.harmonic.fields import MeridianFields
from fea.harmonic.five_numbers import numbers
from fea.harmonic.superposition import Circumference


def test_loads_of_harmonics_in_any_order_are_superposed() -> None:
    random = np.random.default_rng(3)
    loads = tuple(UnitLoad(f"s{k}", "pressure", n) for k, n in enumerate((2, 0, 1, 2, 5)))
    points, instants = 7, 3
    stress = random.normal(size=(points, 6, len(loads)))
    x = random.normal(size=(points, 2))
    fields = MeridianFields(x, loads, stress, np.zeros((0, 3, len(loads))), points, 0)
    # The first of the solved loads does not act.
    acting = {load: random.normal(size=(instants, 2)) for load in loads[1:]}
    rows, angles = np.array([4, 0, 4, 6, 1]), np.array([0.0, 0.4, 0.4, -2.0, 0.4])
    at = stress_at(fields, LoadAmounts("c", acting, instants))(rows, angles, np.array([2, 0]))
    for j, (row, angle) in enumerate(zip(rows, angles, strict=True)):
        for t, instant in enumerate((2, 0)):
            total = np.zeros(6)
            for k, load in enumerate(loads[1:], 1):
                for phase in range(2):
                    psi = load.n * angle - 0.5 * np.pi * phase
                    c, s = np.cos(psi), np.sin(psi)
                    varies = np.array([c, c, c, s, c, s])  # rr, tt, zz, tz, rz, rt
                    total += acting[load][instant, phase] * varies * stress[row, :, k]
            assert np.abs(at[j, t] - total).max() < 1e-12


def test_without_loads_there_is_no_stress() -> None:
    fields = MeridianFields(
        np.zeros((2, 2)),
        (UnitLoad("s", "pressure", 1),),
        np.ones((2, 6, 1)),
        np.zeros((0, 3, 1)),
        2,
        0,
    )
    loads = LoadAmounts("c", {}, 3)
    rows, angles = np.array([1, 0]), np.array([0.0, 1.0])
    assert np.array_equal(stress_at(fields, loads)(rows, angles, np.arange(3)), np.zeros((2, 3, 6)))
    around = Circumference(fields, loads)
    assert np.array_equal(around.stress(rows, 1, angles), np.zeros((2, 2, 6)))
    assert np.array_equal(around.envelope(rows, angles), np.zeros((2, 2)))


def test_the_five_numbers_of_many_loads_take_no_more_memory_than_they_have() -> None:
    """Copies of the stress of 800 loads, 275 MB each, were what a pin in three lugs with friction
    ran out of memory by. Their squares sum to von Mises stress squared, here of one harmonic.
    """
    loads = tuple(UnitLoad("s", "pressure", n) for n in range(100))
    stress = np.random.default_rng(5).normal(size=(4000, 6, len(loads)))
    fields = MeridianFields(
        np.zeros((4000, 2)), loads, stress, np.zeros((4000, 3, len(loads))), 4000, 0
    )
    at = tuple(range(99, -1, -1))
    tracemalloc.start()
    made = numbers(fields, at)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1.4 * (made.five.nbytes + made.reach.nbytes)
    whole = von_mises(stress[..., at].swapaxes(1, 2))
    assert np.sqrt(np.square(made.five).sum(axis=1)) == pytest.approx(whole, rel=1e-12)

"""A leaf-sprung leg of 600 lb at 7 ft/s with lift of 2/3 of the weight, by conservation of energy.

Published in the tests of pyavia (E. J. Whitney, test/motion/test_landing.py), without mass of the
tyre: strut 0.695 ft, 521.6 ft lbf and 1500.5 lbf; tyre 0.166 ft, 107.6 ft lbf and 1500.5 lbf. Its
tyre is a cubic through deflection over force, ours through force over deflection.

| quantity | tolerance | because |
| --- | --- | --- |
| strut, tyre by the energy method | last digit | of forces 2e-4, for the interpolation |
| the drop, 1 % and 0.1 % of the mass in the axle | 2 %, 1.3 % | the axle swings by V / omega |
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from loads.landing import Drop, LinearSpring, Strut, TableTyre, land
from tests.support.each import each

FOOT, LBF = 0.3048, 4.4482216152605
SLUG = LBF / FOOT
INCHES = (0, 0.535, 0.91, 1.18, 1.3, 1.46, 1.65, 1.84, 2.02, 2.21, 2.455, 2.67, 2.825, 2.895)
POUNDS = (0, 270, 530, 740, 840, 980, 1160, 1345, 1525, 1725, 2000, 2250, 2500, 2700)
TYRE = TableTyre(tuple(x * FOOT / 12.0 for x in INCHES), tuple(x * LBF for x in POUNDS))
LEAF = LinearSpring(2158.3 * LBF / FOOT)
GRAVITY, SPEED, LIFT = 32.174 * FOOT, 7.0 * FOOT, 2.0 / 3.0
MASS = 1200.0 * 0.031081 / 2.0 * SLUG


def lowest_point() -> tuple[float, float]:
    """Deflections of strut and tyre at which the energy of the fall is stored, under one force."""

    def strut(tyre: float) -> float:
        return float(TYRE.force(np.array([tyre]))[0]) / LEAF.stiffness

    def excess(tyre: float) -> float:
        s = strut(tyre)
        fallen = 0.5 * MASS * SPEED**2 + MASS * GRAVITY * (1.0 - LIFT) * (s + tyre)
        return fallen - 0.5 * LEAF.stiffness * s**2 - float(TYRE.energy(np.array([tyre]))[0])

    tyre = brentq(excess, 0.01, TYRE.max_deflection, xtol=1e-14)
    return strut(tyre), tyre


def test_the_energy_method_gives_the_published_numbers() -> None:
    strut, tyre = lowest_point()
    assert strut / FOOT == pytest.approx(0.695, abs=6e-4)
    assert tyre / FOOT == pytest.approx(0.166, abs=6e-4)
    assert LEAF.stiffness * strut / LBF == pytest.approx(1500.5, rel=2e-4)
    assert LEAF.energy(np.array([strut]))[0] / LBF / FOOT == pytest.approx(521.6, rel=4e-4)
    assert TYRE.energy(np.array([tyre]))[0] / LBF / FOOT == pytest.approx(107.6, rel=2e-3)


@each(("part", "within"), [(1e-2, 0.02), (1e-3, 0.013)])
def test_the_drop_approaches_it_as_the_axle_gets_lighter(part: float, within: float) -> None:
    strut, _ = lowest_point()
    leg = Strut(LEAF, 1.0)
    found = land(
        Drop(
            MASS * (1.0 - part), MASS * part, SPEED, TYRE, leg, lift=LIFT, gravity=GRAVITY,
            duration=0.35,
        )
    )  # fmt: skip
    assert found.peaks["stroke"].value == pytest.approx(strut, rel=within)
    assert found.peaks["along"].value == pytest.approx(LEAF.stiffness * strut, rel=within)

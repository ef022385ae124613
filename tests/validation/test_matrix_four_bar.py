"""Matrix dynamic analysis for four bar (lecture notes): one instant with gravity.

| quantity | tolerance | because |
| --- | --- | --- |
| forces, torque from the printed inertia forces | last digit | from the same rounded numbers |
| masses and inertias | last digit | |
| angular rates from the crank's motion | a unit of the last digit | the geometry is rounded, too |
| linear accelerations | 3e-3 | the print's contradict its angular ones by up to 0.2 % |
| the crank's | 0.3 cm/s^2 of 1649 | arms are rounded to 1e-3 |
| forces from the motion alone | 0.02 N, 1e-3 of the torque | the same 0.2 % of m a = 5 to 16 N |
| balance of powers | 1e-12 | round-off |
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from loads import Dynamics, Linkage, ledger
from pinstress import load_study
from pinstress.study.model import cases as build
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.reading.file import Study

ROOT = Path(__file__).parents[2]
PRINTED = {
    "F12": (-22.236, -6.221),
    "F23": (-18.729, -6.550),
    "F34": (-5.067, -1.788),
    "F14": (-2.648, 0.317),
}


@pytest.fixture(scope="module")
def study() -> Study:
    return load_study(ROOT / "studies" / "matrix_four_bar.toml")


@pytest.fixture(scope="module")
def bars(study: Study) -> Linkage:
    return linkage(study)


def solved(study: Study, bars: Linkage, case: str) -> Dynamics:
    found = build.case_loads(study, case, bars).dynamics
    assert found is not None
    return found


def test_the_printed_solution_to_its_last_digit(study: Study, bars: Linkage) -> None:
    found = solved(study, bars, "printed")
    for name, printed in PRINTED.items():
        ours = found.reactions.force(name)[0]
        assert (round(ours[0], 3), round(ours[1], 3)) == printed
    assert round(100.0 * found.drive[0, 0], 3) == 81.135  # N cm


def test_rates_follow_from_the_cranks_motion_to_their_digits(study: Study, bars: Linkage) -> None:
    motion = solved(study, bars, "motion").motion
    for body, speed, acceleration in (("coupler", 12.82, -39.6), ("rocker", -6.20, 482.5)):
        # as printed, half a unit of the last digit more for geometry that is itself rounded
        assert motion.angular_velocity(body)[0] == pytest.approx(speed, abs=0.01)
        assert motion.angular_acceleration(body)[0] == pytest.approx(acceleration, abs=0.1)
    _, _, a = motion.centres
    assert 100.0 * a[0, 0] == pytest.approx(-1414.2 - 848.5j, abs=0.3)  # cm/s^2
    assert 100.0 * a[0, 1] == pytest.approx(-3672.5 - 2260.9j, rel=3e-3)
    assert 100.0 * a[0, 2] == pytest.approx(-2262.4 - 1412.4j, rel=3e-3)


def test_the_prints_linear_accelerations_contradict_its_angular_ones() -> None:
    """Rigid bodies: the centre of 3 from B, the centre of 4 from D, with the print's own rates."""
    b = 8.0 * (100j - 400.0) * np.exp(1j * np.pi / 4)
    g3 = b + 6.0 * (-39.6j - 12.82**2) * np.exp(1j * np.radians(20.0))
    g4 = 5.5 * (482.5j - 6.20**2) * np.exp(1j * np.radians(117.4))
    assert abs(g3 - (-3672.5 - 2260.9j)) > 3.0  # print's rounding would allow 0.1
    assert abs(g4 - (-2262.4 - 1412.4j)) > 3.0


def test_from_motion_alone_the_forces_agree_as_far_as_the_accelerations_do(
    study: Study, bars: Linkage
) -> None:
    found = solved(study, bars, "motion")
    for name, printed in PRINTED.items():
        gap = np.abs(found.reactions.force(name)[0, :2] - printed)
        assert gap.max() < 0.02  # 0.2 % of m a = 5 to 16 N, and arms
    assert 100.0 * found.drive[0, 0] == pytest.approx(81.135, rel=1e-3)
    assert ledger(found).violation < 1e-12


def test_bars_have_the_printed_masses() -> None:
    from loads.linkage.mass_properties import flat_bar

    for length, mass, inertia in ((8, 0.248, 1.405), (12, 0.372, 4.588), (11, 0.341, 3.552)):
        m, j = flat_bar(0.01 * length, 0.02, 0.02, 7750.0)
        assert round(m, 3) == mass
        assert round(1e4 * j, 3) == inertia

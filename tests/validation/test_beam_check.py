"""Pin B of Grenier (2008) beside beam theory, as the publication checked it (figure 27)."""

from __future__ import annotations

import numpy as np
import pytest

from pinstress.pipeline import prepare, solve
from pinstress.study import Study
from reports.results import BeamCheck


@pytest.fixture(scope="module")
def check(gear: Study) -> BeamCheck:
    found = solve(prepare(gear, pins=["B"], cases=["retract"])).beam_check
    assert found is not None
    return found


def test_the_load_and_the_diagrams_are_the_publications(check: BeamCheck) -> None:
    """101 lbf over 2 in: 50.5 lbf/in, V = 101 lbf and M = 101 lbf in at the root, M r / I with
    I = pi r^4 / 4 and r = 1 in.
    """
    assert check.force == pytest.approx(101.06, rel=1e-3)
    assert check.shear[0] == pytest.approx(check.force)
    assert check.moment[0] == pytest.approx(check.force * 1.0)
    assert check.beam_axial_stress[0] == pytest.approx(check.force * 4.0 / np.pi)
    assert (check.shear[-1], check.moment[-1]) == (0.0, 0.0)
    assert check.moment == pytest.approx(check.force / 4.0 * (2.0 - check.z) ** 2, abs=1e-9)


def test_the_solid_agrees_away_from_the_root(check: BeamCheck) -> None:
    """Within 10 % of the peak from 30 to 80 % of the length, whichever way the load is applied."""
    inside = (check.z >= 0.6) & (check.z <= 1.6)
    for stress in (check.fea_axial_stress, check.fea_axial_stress_axis_load):
        error = (stress - check.beam_axial_stress)[inside] / check.beam_axial_stress.max()
        assert np.abs(error).max() < 0.10


def test_what_remains_is_michells_term(check: BeamCheck) -> None:
    """The loads' exact constants (-4.74 and -8.19 psi) leave 1 % rms of the beam's peak: the pin is
    one diameter long, so the window is not quite free of its ends.
    """
    assert check.expected_offset == pytest.approx(-4.743, abs=2e-3)
    assert check.expected_offset_axis_load == pytest.approx(-8.189, abs=2e-3)
    assert check.rms_beyond_offset < 0.01
    assert check.rms_axis_load_beyond_offset < 0.015
    assert check.rms > 3.0 * check.rms_beyond_offset
    assert check.rms_axis_load > 3.0 * check.rms_axis_load_beyond_offset


def test_the_largest_difference_is_at_the_root(check: BeamCheck) -> None:
    assert check.largest_at < 0.1
    assert check.largest_anywhere > 0.5

"""Torque of friction in lugs: closed forms of known pressures, the torsion of sections against all
senses of turning, and a clevis by hand.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from fea.core.requirement import Requirement
from fea.core.tractions import tractions_of
from fea.solve.solve import solve_in_lugs
from fea.support.bands import Bands
from fea.support.contact.contact_state import ContactState
from fea.support.contact.friction import band_torques, coefficient_words, opposed, turning_traction
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem, Solution
from geometry import ArgumentError, Pin, Segment
from pinbase.arrays import Floats
from tests.fea.support.contact.test_solve_in_lugs import FORCE, LUGS, PIN, STEADY, STEEL, D, pull

MU, R, LENGTH, SECTORS = 0.2, 0.01, 0.03, 720


def torque_of(pressure: Floats) -> float:
    """The torque of a pressure (M,) on one band of three rings, N m."""
    lengths = np.array([0.5, 0.3, 0.2]) * LENGTH
    z, none = np.cumsum(lengths) - lengths / 2.0, np.zeros(3, dtype=np.int64)
    bands = Bands(z, lengths, np.full(3, R), none, np.zeros(3), none[:1])
    model = SimpleNamespace(bands=bands, lugs=[Lug("A", 0.05, STEEL, friction=MU)])
    cells = np.tile(pressure, (3, 1))
    state = ContactState(cells, 0.0 * cells, np.zeros((1, 2)), np.zeros(2), 1)
    ((torque,),) = band_torques(cast(ContactModel, model), [state])
    return float(torque)


def test_a_uniform_pressure_rubs_all_around() -> None:
    assert torque_of(np.full(SECTORS, 5e6)) == pytest.approx(
        MU * 5e6 * 2.0 * math.pi * R**2 * LENGTH, rel=1e-12
    )


def test_a_cosine_pressure_has_four_over_pi_of_mu_f_r() -> None:
    angles = 2.0 * math.pi * np.arange(SECTORS) / SECTORS
    force = 5e6 * math.pi / 2.0 * R * LENGTH
    torque = torque_of(5e6 * np.maximum(np.cos(angles), 0.0))
    assert torque == pytest.approx(MU * force * R * 4.0 / math.pi, rel=1e-5)


def test_every_section_has_the_largest_torque_of_any_senses() -> None:
    torques = np.array([1.0, 3.0, 2.0, 0.0, 2.5])
    out = opposed(torques, np.arange(5.0))
    assert out.sum() == pytest.approx(0.0, abs=1e-12)
    # All extremes: each ring at an end of its range but one, which balances the others.
    largest = np.zeros(4)
    for free in range(5):
        for senses in itertools.product((-1.0, 1.0), repeat=5):
            trial = np.array(senses) * torques
            trial[free] -= trial.sum()
            if abs(trial[free]) <= torques[free]:
                largest = np.maximum(largest, np.abs(np.cumsum(trial)[:-1]))
    assert (np.cumsum(out)[:-1] >= largest - 1e-12).all()
    assert np.cumsum(out).max() == pytest.approx(torques.sum() / 2.0)


def test_the_order_of_rings_is_that_along_the_pin() -> None:
    z, torques = np.array([2.0, 0.0, 1.0]), np.array([1.0, 2.0, 3.0])
    order = np.argsort(z)
    np.testing.assert_allclose(opposed(torques, z)[order], opposed(torques[order], z[order]))
    assert not opposed(np.zeros(3), z).any()


def test_torques_on_rings_are_one_traction_about_the_axis() -> None:
    """Every ring has its torque, without an edge that would be a singularity of its own."""
    names, radius = ("A", "B"), np.array([0.010, 0.012])
    segments = [
        Segment(L, 2.0 * r, connection=name)
        for L, r, name in zip((0.02, 0.03), radius, names, strict=True)
    ]
    pin = Pin("P", tuple(segments))
    bands = SimpleNamespace(radius=radius, length=np.array([0.02, 0.03]))
    model = cast(ContactModel, SimpleNamespace(bands=bands, rings=names))
    torque = np.array([3.0, -5.0])
    ((load, amount),) = turning_traction(model, torque).items()
    assert not load.shears
    assert load.phases == (1,)
    for one, expected in zip(tractions_of(pin, load), torque, strict=True):
        band = pin.band(one.surface)
        shear = one.mean * amount[0, 1]
        assert shear[[0, 2]].tolist() == [0.0, 0.0]
        assert -shear[1] * band.area * band.radius == pytest.approx(expected, rel=1e-12)
    assert not turning_traction(model, np.zeros(2))


def test_coefficients_outside_their_range_are_refused() -> None:
    for wrong in (-0.1, 1.1, math.nan):
        with pytest.raises(ArgumentError, match="friction must be from 0 to 1"):
            Lug("A", 0.05, STEEL, friction=wrong)
    lugs = [replace(lug, friction=mu) for lug, mu in zip(LUGS, (0.1, 0.2, 0.15), strict=True)]
    assert coefficient_words(lugs) == "0.1 to 0.2"
    assert coefficient_words([replace(lug, friction=0.15) for lug in LUGS]) == "0.15"


@pytest.fixture(scope="module")
def rubbing() -> Solution:
    lugs = tuple(replace(lug, friction=0.15) for lug in LUGS)
    return solve_in_lugs(PinProblem(PIN, STEEL, lugs, (STEADY,)), Requirement(tolerance=0.1))[0]


def test_the_torque_of_a_clevis_is_that_of_its_arcs_of_contact(rubbing: Solution) -> None:
    """More than mu F R, and less than of a pressure that is uniform on half of the bore, where the
    ratio is pi / 2: that of contact falls towards the ends of its arc.
    """
    assert rubbing.joint is not None
    for band in rubbing.joint.bands:
        assert band.friction_torque is not None
        assert 1.0 < band.friction_torque / (0.15 * band.force * D / 2.0) < math.pi / 2.0


def test_torsion_by_friction_adds_to_bending_as_by_hand(rubbing: Solution) -> None:
    """sqrt(s^2 + 3 t^2) at mid-span, t = 16 T / (pi d^3), T half of all torque. The bound reverses
    the friction within the middle lug, and the step of its traction there adds 1.5 % locally.
    """
    joint, peak = rubbing.joint, rubbing.peak
    assert joint is not None
    assert joint.range is not None
    assert peak.max_von_mises is not None
    torque = sum(band.friction_torque or 0.0 for band in joint.bands) / 2.0
    shear = 16.0 * torque / (math.pi * D**3)
    (turning,) = (v for v in joint.range.variations if v.value == "0.15, links turning on the pin")
    expected = math.sqrt(1.0 + 3.0 * (shear / peak.max_von_mises) ** 2)
    assert turning.what == "friction"
    assert expected <= turning.max_von_mises / peak.max_von_mises <= 1.02 * expected
    assert joint.range.max_von_mises[1] >= turning.max_von_mises


def test_the_torque_is_the_largest_over_all_instants(rubbing: Solution) -> None:
    """Without clearance it grows with the load: that of the third instant, which is the steady one
    in another direction.
    """
    lugs = tuple(replace(lug, friction=0.15) for lug in LUGS)
    along = FORCE * np.array([[0.4, 0.0], [0.0, 0.7], [0.0, 1.0], [-0.3, 0.2]])
    moving = pull(along, np.arange(4.0))
    (solution,) = solve_in_lugs(PinProblem(PIN, STEEL, lugs, (moving,)), Requirement(tolerance=0.1))
    assert solution.joint is not None
    assert rubbing.joint is not None
    for band, steady in zip(solution.joint.bands, rubbing.joint.bands, strict=True):
        assert band.friction_torque == pytest.approx(steady.friction_torque, rel=1e-9)


def test_friction_changes_nothing_else(rubbing: Solution) -> None:
    plain = solve_in_lugs(PinProblem(PIN, STEEL, LUGS, (STEADY,)), Requirement(tolerance=0.1))[0]
    assert plain.joint is not None
    assert rubbing.joint is not None
    assert plain.joint.range is not None
    assert rubbing.joint.range is not None
    assert plain.peak.max_von_mises == rubbing.peak.max_von_mises
    assert plain.peak.error_estimate == rubbing.peak.error_estimate
    others = [v for v in rubbing.joint.range.variations if v.what != "friction"]
    assert others == list(plain.joint.range.variations)
    assert plain.joint.bands[0].friction_torque is None

"""Friction along the axis as a pin bends: bending by axial tractions in closed form, on the section
and on the surface; senses of sliding; and full slip of a clevis by hand.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.beam.line_load import line_couples
from fea.beam.timoshenko import MOMENT, SHEAR, stepped_beam
from fea.core.pin_loads import LoadAmounts, UnitLoad
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.section.section_stress import SectionField
from fea.solve.solve import solve_in_lugs
from fea.support.contact.friction import SLIDING, along_axis, rubbed
from fea.support.contact.pressure_loads import PressureLoads
from fea.support.contact.solve_joint import ContactModel
from fea.support.support import PinProblem
from geometry import Pin, Segment
from tests.fea.support.contact.test_solve_in_lugs import FORCE, LUGS, PIN, STEADY, STEEL, D, pull

R, BAND, GAP, Z = 0.01, 0.01, 0.06, 3e6
ROD = Pin(
    "P",
    (
        Segment(BAND, 2.0 * R, connection="A"),
        Segment(GAP, 2.0 * R),
        Segment(BAND, 2.0 * R, connection="B"),
    ),
)
AXIAL = UnitLoad("", "axial", 1, (("A", Z), ("B", -Z)))
AMOUNTS = LoadAmounts("bend", {AXIAL: np.array([[1.0, 0.0]])}, 1)
STRESS = 4.0 * Z * BAND / R  # M R / I with M = pi Z R^2 times the band's length


def test_axial_tractions_bend_a_beam_without_shear() -> None:
    forces = stepped_beam(ROD, STEEL, (AXIAL,))
    inside = forces.at(np.array([0.5 * BAND, BAND, BAND + GAP / 2.0, BAND + GAP]))[:, :, 0]
    moment = math.pi * Z * R**2 * BAND
    assert inside[:, MOMENT] == pytest.approx([0.5 * moment, moment, moment, moment], rel=1e-9)
    assert np.abs(inside[:, SHEAR]).max() < 1e-9 * moment / R
    couples = line_couples(ROD, forces.stations, (AXIAL, UnitLoad("A", "force", 1)))
    assert couples[[0, -1], 0] == pytest.approx([-moment / BAND, moment / BAND])
    assert not couples[:, 1].any()


def test_one_band_alone_is_closed_by_the_couple_of_all() -> None:
    alone = UnitLoad("", "axial", 1, (("A", Z),))
    forces = stepped_beam(ROD, STEEL, (alone,))
    end = forces.coefficients[-1, :, :, 0].T @ (BAND ** np.arange(4))
    assert np.abs(end[[SHEAR, MOMENT]]).max() < 1e-9 * math.pi * Z * R**2 * BAND / R


def test_section_and_surface_have_the_stress_of_bending() -> None:
    place = SectionField(ROD, STEEL, (), (AMOUNTS,)).place(AMOUNTS)
    assert place.value == pytest.approx(STRESS, rel=1e-6)
    none = np.zeros((1, 2, 3))
    loads = PressureLoads("bend", ("A", "B"), none, acting=AMOUNTS.acting)
    section = harmonic_solution(SectionProblem(ROD, STEEL, (), (loads,), ()), 0, 1.0)
    around = HarmonicField(section, ()).reader(loads)
    near = np.linalg.norm(around.fields.points - [R, BAND + GAP / 2.0], axis=1) < 0.1 * R
    assert around.maxima(near)[0] == pytest.approx(STRESS, rel=0.01)


@pytest.fixture(scope="module")
def model() -> ContactModel:
    return ContactModel(PIN, STEEL, [replace(lug, friction=0.1) for lug in LUGS])


def test_full_slip_changes_the_moment_of_a_clevis_by_mu_f_r(model: ContactModel) -> None:
    """In the section at mid-span: mu F R less, and as much more, whichever way the load points."""
    for angle in (0.0, 0.9):
        contact = model.solve(pull(FORCE * np.array([[math.cos(angle), math.sin(angle)]])))
        without, changed = rubbed(model, contact)
        moments = []
        for loads in (without, *changed[SLIDING][:2]):
            field = SectionField(model.pin, STEEL, (), (loads.in_sections,))
            near = np.abs(field.fields.points[:, 1] - PIN.length / 2.0) < 1e-4
            stress = float(field.around(loads.in_sections).maxima(near)[0])
            moments.append(stress * math.pi * D**3 / 32.0)
        change = 0.1 * FORCE * D / 2.0
        assert sorted(moments[1:]) == pytest.approx(
            [moments[0] - change, moments[0] + change], rel=0.01
        )


def test_friction_along_the_axis_is_in_balance_and_no_more_than_mu(model: ContactModel) -> None:
    contact = model.solve(STEADY)
    share = along_axis(model, contact)
    couple = share * model.bands.radius * contact.line_load[0, :, 0] * model.bands.length
    assert couple.sum() == pytest.approx(0.0, abs=1e-9 * np.abs(couple).sum())
    assert np.abs(share).max() == pytest.approx(0.1, rel=0.1)
    assert not along_axis(ContactModel(PIN, STEEL, LUGS), contact).any()


def test_the_range_has_both_ends_and_torsion() -> None:
    lugs = tuple(replace(lug, friction=0.1) for lug in LUGS)
    (solution,) = solve_in_lugs(PinProblem(PIN, STEEL, lugs, (STEADY,)), Requirement(tolerance=0.1))
    joint, largest = solution.joint, solution.peak.max_von_mises
    assert joint is not None
    assert joint.range is not None
    assert largest is not None
    by = {
        v.value: v.max_von_mises / largest for v in joint.range.variations if v.what == "friction"
    }
    # mu F R over the moment without friction, which is 0.84 F / 2 (5 + 1 + 5) mm
    change = 0.1 * D / 2.0 / (0.84 * 0.0055)
    assert by["0.1, load growing"] == pytest.approx(1.0 - change, abs=0.05)
    assert by["0.1, load falling after a larger one"] == pytest.approx(1.0 + change, abs=0.05)
    assert joint.range.max_von_mises[0] > largest * (1.0 - change)
    assert joint.range.max_von_mises[1] >= largest * by["0.1, load falling after a larger one"]

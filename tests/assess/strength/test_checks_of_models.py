"""Checks of what models give: section forces of a solved joint, stress, limit loads."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.plastic.records import LimitLoad
from assess.situation import LoadFactors, Situation, SolvedRow
from assess.strength.bending_arms import bending_arms, layout
from assess.strength.case_crushing import crushed_case
from assess.strength.collapse import collapse
from assess.strength.hand_checks import bending
from assess.strength.model_stress import model_rupture, model_yield
from assess.strength.section_forces import of_joint, section_forces
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.places import CaseCrushing, ContactPlace, Places, SurfacePlace
from fea.support.records import JointForces
from geometry import Pin, Segment
from tests.assess.strength.test_strength import S235, in_double_shear, margins
from tests.support.each import each


def test_bending_and_shear_of_a_solved_joint_take_its_section_forces() -> None:
    """A moment of half the even one: half the utilisation, at the joint's own instant; the even
    loads and the concentrated forces are for comparison, or the joint is.
    """
    s = in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0)
    even, _ = section_forces(s)
    z = np.union1d(np.linspace(0.0, s.pin.length, 40), s.pin.stations)
    moment = np.interp(z, even.z, even.moment[0])
    shear = np.full_like(z, 2500.0)
    course = np.array([0.1, 0.5])[:, None]
    times, none = np.array([1.0, 2.0]), np.zeros((2, 0, 2))
    along = JointForces(z, times, 2 * course * shear, course * moment, (), none)
    plain = margins(s)
    found = margins(replace(s, joint=along, replaceable=True))
    bent = found["EN 1993 bending", "ultimate"]
    assert bent.utilisation == pytest.approx(
        0.5 * (plain["EN 1993 bending", "ultimate"].utilisation or 0.0), rel=1e-2
    )
    assert (bent.time, bent.basis, bent.governs) == (2.0, "joint model", True)
    assert bent.shown == "EN 1993 bending (joint model)"
    assert plain["EN 1993 bending", "ultimate"].shown == "EN 1993 bending"
    assert found["bending, joint model", "limit"].utilisation == pytest.approx(
        0.5 * (plain["bending", "limit"].utilisation or 0.0), rel=1e-2
    )
    shear_of = found["EN 1993 shear", "ultimate"]
    assert shear_of.demand == pytest.approx(2500.0)
    compared = {method for (method, _), m in found.items() if not m.governs}
    assert compared == {
        f"{name}, for comparison"
        for name in (
            "bending", "bending, concentrated forces", "plastic bending and shear",
            "EN 1993 shear", "EN 1993 bending", "EN 1993 shear and bending",
            "EN 1993 bending, replaceable",
        )
    }  # fmt: skip
    strict = margins(replace(s, joint=along, even_governs=True))
    assert strict["EN 1993 bending", "ultimate"] == plain["EN 1993 bending", "ultimate"]
    assert not strict["bending, joint model, for comparison", "limit"].governs
    assert all(m.governs for m in plain.values())


def test_a_shoulder_is_checked_on_both_sides() -> None:
    """The moment of the joint at a step loads the thinner section there."""
    pin = Pin("P", (Segment(0.02, 0.03, connection="A"), Segment(0.02, 0.02, connection="B")))
    z = np.array([0.0, 0.02, 0.04])
    moment, none = np.array([[0.0, 100.0, 0.0]]), np.zeros((1, 0, 2))
    along = JointForces(z, None, np.zeros((1, 3)), moment, (), none)
    s = replace(in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0), profile=pin)
    (found,) = bending(replace(s, section_forces=of_joint(s, along)))
    assert (found.method, found.clause) == ("bending, joint model", "Shigley, 3-10")
    assert found.demand == pytest.approx(100.0 / (math.pi / 32.0 * 0.02**3))
    assert found.at == "B"


def test_arms_stand_next_to_the_joint_model() -> None:
    s = in_double_shear(0.01, 0.001, 0.02, 0.02, 50e3)
    found = bending_arms(s, 200.0, "contact")
    assert found.layout == "double shear"
    assert found.even == pytest.approx(50e3 * (0.02 + 4 * 0.001 + 2 * 0.01) / 8.0)
    assert found.concentrated > found.even
    assert (found.joint, found.model) == (200.0, "contact")
    uneven = in_double_shear(0.01, 0.001, 0.02, 0.02, 50e3).loads
    forces = uneven.forces * np.array([1.2, 1.0, 0.8])[:, None]
    assert layout(replace(s, loads=replace(uneven, forces=forces))).endswith("not symmetrical")


def test_a_limit_load_is_a_margin_at_ultimate_load() -> None:
    """1.35 to 1.40 times the loads: short of 1.5 by a tenth, by the lower end."""
    factors = LoadFactors(fitting=1.15)
    instant = PinLoads("c", ("A",), np.zeros((1, 1, 3)), times=np.array([0.2]))
    peak = Maximum("P", "c", "solid", "converged", "", 300e6, 2e6, governing=instant)
    row = SolvedRow(peak, LimitLoad("solid", 1.35, 1.40, True, time=0.3))
    s = Situation(None, S235, factors=factors, row=row)
    (found,) = collapse(s)
    assert found.margin == pytest.approx(1.35 / (1.5 * 1.15) - 1.0)
    assert (found.level, found.time) == ("ultimate", 0.3)  # not that of the largest stress
    (none,) = collapse(replace(s, row=SolvedRow(peak, LimitLoad("none", note="no mesh"))))
    assert none.needs == "a limit load: no mesh"


def test_a_crushed_case_has_the_factor_that_is_required_against_yield() -> None:
    """A core of 300 MPa at 250: enough for a factor of 1.1, not for 1.5; fittings may ask more."""
    crushing = CaseCrushing("B", 0.01, 250e6, 0.002, 400e6, 300e6)
    contact = ContactPlace(
        250e6, 0.0, (0.0, 0.0, 0.01), None, None, None, (), (), crushing=crushing
    )
    surface = SurfacePlace(200e6, 0.0, "converged", (0.0, 0.0, 0.01), None)
    peak = Maximum(
        "P", "c", "harmonic", "converged", "", 200e6, 0.0,
        places=Places("surface", surface, contact=contact),
    )  # fmt: skip
    s = Situation(None, S235, row=SolvedRow(peak, required=1.5))
    (crushed,), (lenient,) = crushed_case(s), crushed_case(replace(s, row=SolvedRow(peak)))
    assert (crushed.factor, lenient.factor) == (1.5, 1.0)
    assert crushed.margin == pytest.approx(300.0 / (1.5 * 250.0) - 1.0)
    (fitted,) = crushed_case(replace(s, factors=LoadFactors(fitting=2.0)))
    assert fitted.factor == 2.0


@each(
    ("peak", "demand"),
    [
        (Maximum("P", "c", "beam", "converged", "", 100e6, 2e6), 102e6),
        (Maximum("P", "c", "harmonic", "singular", "", 100e6, 20e6, interval=(90e6, 120e6)), 120e6),
        (Maximum("P", "c", "solid", "rigid", ""), None),
        (
            Maximum("P", "c", "beam", "unconverged", "", 1e6, 1e6, reasons=("no-notch-factor",)),
            None,
        ),
    ],
)
def test_stress_of_the_model_with_its_error(peak: Maximum, demand: float | None) -> None:
    s = Situation(None, S235, row=SolvedRow(peak))
    (yields,), (ruptures,) = model_yield(s), model_rupture(s)
    assert yields.demand == ruptures.demand == demand
    if demand is None:
        assert "maximum" in yields.needs
    else:
        assert yields.margin == pytest.approx(235e6 / demand - 1.0)
        assert ruptures.margin == pytest.approx(360e6 / (1.5 * demand) - 1.0)
    (missing,) = model_rupture(replace(s, material=replace(S235, ultimate_strength=None)))
    assert missing.needs == "material.S235.ultimate_strength"

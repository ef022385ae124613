"""A clevis pin with a grease hole in its middle lug."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.peak import ErrorParts
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.verdict import Evidence
from fea.cut.region import RingedCutPin
from fea.solve.solve import solve_in_lugs
from fea.support.contact.cut_in_lugs import CUT_CONTACT_ERROR, cuts_in_lugs, with_cuts_in_lugs
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import CutPin, Hole, Pin, Segment, Slot
from tests.support.pins.plain_pins import CLEVIS

D, F = 0.02, 50e3
STEEL = Material("steel", 2.1e11, 0.3, 7850.0, yield_strength=9e8)
LUGS = tuple(Lug(n, 0.05, STEEL, 0.0, 0.0, 2.1e5) for n in "ABC")
ONCE = Requirement(0.05, cells="usual", meshes=1)  # cells small beside cuts, on one mesh
ROUGHLY = Requirement(0.05, cells="rough", meshes=1)


def test_cuts_in_lugs_have_an_error_and_a_note() -> None:
    """One in a lug has both; one between lugs, which contact sees whole, has none."""
    inside, outside = Hole(0.023, 0.15 * D), Hole(0.001, 0.0006)
    evidence = Evidence("P", "pull", "harmonic+local", 1e8, ErrorParts(1e6), (0.0, 0.0, 0.023))
    places = cuts_in_lugs(CutPin(CLEVIS, (inside, outside)), "ABC")
    assert places == {"hole 1": "B"}
    judged = with_cuts_in_lugs(evidence, places)
    assert judged.parts.model == pytest.approx(CUT_CONTACT_ERROR["hole"] * 1e8)
    assert "hole 1 in lug B" in judged.remarks.text
    assert "cut-in-lug" in judged.remarks.codes
    assert with_cuts_in_lugs(evidence, {}) == evidence


def test_a_ringed_pin_weighs_what_contact_balances() -> None:
    """The profile; of a hole with rounded mouths on the seam of two rings there is no solid."""
    halves = (Segment(0.02, D, connection="A 1"), Segment(0.02, D, connection="A 2"))
    rings = RingedCutPin(Pin("P", halves), (Hole(0.02, 0.15 * D, mouth_radius=5e-4),))
    assert rings.volume == rings.profile.volume


def test_rounded_mouths_under_weight() -> None:
    """The weight that contact balances is that of the pin without its cuts: OpenCASCADE cannot
    round a mouth that the ends of rings cross, and was asked to for the volume. Nothing is left
    over, so no note says so.
    """
    weight = STEEL.density * CLEVIS.volume * 9.81 if STEEL.density else 0.0
    assert weight
    forces = np.array([[[-0.5 * F, 0.0, 0.0], [F, weight, 0.0], [-0.5 * F, 0.0, 0.0]]])
    loads = PinLoads("pull", ("A", "B", "C"), forces, body=np.array([0.0, -9.81, 0.0]))
    cut = CutPin(CLEVIS, (Hole(0.023, 0.15 * D, np.pi / 2.0, mouth_radius=5e-4),))
    (found,) = solve_in_lugs(PinProblem(cut, STEEL, LUGS, (loads,)), ROUGHLY)
    assert found.peak.model == "harmonic+local"
    assert "imbalance-reacted" not in found.peak.reasons


@pytest.mark.slow
def test_the_crest_at_a_hole_is_found_between_samples() -> None:
    """A force that turns across a hole and swells. The maximum stands among 401 instants of the
    same solution, and a run of that instant alone, with pressures of its own, agrees.
    """

    def at(times: np.ndarray) -> PinLoads:
        size = F * np.exp(-(((times - 0.37) / 0.6) ** 2))
        angle = 1.2 + 1.4 * times
        along = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
        forces = (size[:, None] * along)[:, None] * np.array([-0.5, 1.0, -0.5])[:, None]
        return PinLoads("turn", ("A", "B", "C"), forces, times=times)

    cut = CutPin(CLEVIS, (Hole(0.023, 0.2 * D, np.radians(15.0)),))
    case = at(np.linspace(0.0, 1.0, 5))
    given = PinProblem(cut, STEEL, LUGS, (case,), between={"turn": at})
    (found,) = solve_in_lugs(given, ROUGHLY)
    peak = found.peak
    assert peak.max_von_mises is not None
    assert peak.time is not None
    assert found.answer is not None
    dense = np.linspace(0.0, 1.0, 401)
    each = found.answer.maxima(found.pressed(at(dense)))
    assert abs(dense[each.argmax()] - peak.time) < 0.003
    assert case.times is not None
    assert not np.isclose(case.times, peak.time, atol=0.05).any()
    assert peak.max_von_mises == pytest.approx(each.max(), rel=1e-5)
    assert peak.max_von_mises >= each.max() * (1.0 - 1e-9)
    alone = replace(at(np.array([peak.time])), times=None)
    (single,) = solve_in_lugs(PinProblem(cut, STEEL, LUGS, (alone,)), ROUGHLY)
    assert single.peak.max_von_mises == pytest.approx(peak.max_von_mises, rel=2e-3)


def test_a_grease_hole_at_the_extreme_fibre() -> None:
    """3.1 times the bending stress of its joint (four-point bending: 3.10), whose moment is a
    little less than that without the hole, as the mouth does not press.
    """
    forces = F * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
    loads = PinLoads("pull", ("A", "B", "C"), forces)
    cut = CutPin(CLEVIS, (Hole(0.023, 0.2 * D),))
    (plain,) = solve_in_lugs(PinProblem(CLEVIS, STEEL, LUGS, (loads,)), ONCE)
    (holed,) = solve_in_lugs(PinProblem(cut, STEEL, LUGS, (loads,)), ONCE)
    assert plain.joint is not None
    assert holed.joint is not None
    assert plain.joint.bending_moment is not None
    assert holed.joint.bending_moment is not None
    assert 0.95 < holed.joint.bending_moment / plain.joint.bending_moment < 0.99
    nominal = 32.0 * holed.joint.bending_moment / (np.pi * D**3)
    peak = holed.peak
    assert peak.model == "harmonic+local"
    assert peak.max_von_mises is not None
    assert peak.max_von_mises == pytest.approx(3.1 * nominal, rel=0.04)
    assert peak.parts is not None
    assert peak.parts.model == pytest.approx(CUT_CONTACT_ERROR["hole"] * peak.max_von_mises)
    assert "cut-in-lug" in peak.reasons


@pytest.mark.slow
def test_a_keyway_that_faces_the_load_moves_its_pressure() -> None:
    """What pressed on it presses beside it and before its ends, so that the moment falls; turned
    away from the load it changes the joint by its softness alone. The lug has its force in both.
    (Contact by whole solids, with clearance: 0.968 of the moment, which is 1.7 % less.)
    """
    forces = F * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
    loads = PinLoads("pull", ("A", "B", "C"), forces)
    long, wide, moments = 0.01, 0.004, []
    (plain,) = solve_in_lugs(PinProblem(CLEVIS, STEEL, LUGS, (loads,)), ONCE)
    assert plain.joint is not None
    assert plain.joint.bending_moment is not None
    for angle in (0.0, np.pi):
        key = Slot(0.023 - long / 2, 0.023 + long / 2, wide, 0.0025, angle, 0.0008, False)
        pin = CutPin(CLEVIS, (key,))
        (found,) = solve_in_lugs(PinProblem(pin, STEEL, LUGS, (loads,)), ONCE)
        peak = found.peak
        assert found.joint is not None
        assert peak.model == "harmonic+local"
        assert "slot 1 in lug B" in peak.note
        assert found.joint.bending_moment is not None
        moments.append(found.joint.bending_moment / plain.joint.bending_moment)
        (band,) = (b for b in found.joint.bands if b.name == "B")
        assert band.force == pytest.approx(F, rel=1e-9)
    assert moments[0] == pytest.approx(1.0, abs=0.012)
    assert 0.96 < moments[1] < moments[0]

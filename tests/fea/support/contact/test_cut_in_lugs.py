"""A clevis pin with a grease hole in its middle lug."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.cut.region import RingedCutPin
from fea.solve.solve import solve_in_lugs
from fea.support.contact.cut_in_lugs import NeglectedCuts
from fea.support.lugs.lug import Lug
from fea.support.records import Variation
from fea.support.support import PinProblem
from geometry import CutPin, Hole, Pin, Segment, Slot

D, F = 0.02, 50e3
STEEL = Material("steel", 2.1e11, 0.3, 7850.0, yield_strength=9e8)
CLEVIS = Pin(
    "clevis",
    (
        *(Segment(0.002, D), Segment(0.01, D, connection="A"), Segment(0.001, D)),
        *(Segment(0.02, D, connection="B"), Segment(0.001, D)),
        *(Segment(0.01, D, connection="C"), Segment(0.002, D)),
    ),
)
LUGS = tuple(Lug(n, 0.05, STEEL, 0.0, 0.0, 2.1e5) for n in "ABC")


def test_what_is_neglected() -> None:
    """A pin softer by 1 % is one in lugs stiffer by 1 %: with stress that falls to 0.8 in lugs of
    half the stiffness, 0.32 % of it; the pressure on a mouth counts at the hole alone. What is lost
    on it and what moves away from it are the same force.
    """
    left = NeglectedCuts(0.01, 5e6, 0.02, 0.015, {"hole 1": "B"})
    over = (
        Variation("stiffness of the lugs", "half", 0.8e8),
        Variation("clearance", "none", 0.5e8),
    )
    share = 0.01 * np.log(1.25) / np.log(2.0) + 0.02
    assert left.error(1e8, False, over) == pytest.approx(share * 1e8)
    assert left.error(1e8, True, over) == pytest.approx(share * 1e8 + 5e6)
    moved = replace(left, moved=0.1)
    assert moved.error(1e8, False, over) == pytest.approx((share + 0.08) * 1e8)
    assert left.note.codes == ("cut-in-lug",)
    assert "2.0% of the force of a lug" in left.note.text
    assert not NeglectedCuts(0.01, 0.0, 0.0, 0.0, {}).note.text


def test_a_ringed_pin_weighs_what_contact_balances() -> None:
    """The profile; of a hole with rounded mouths on the seam of two rings there is no solid."""
    halves = (Segment(0.02, D, connection="A 1"), Segment(0.02, D, connection="A 2"))
    rings = RingedCutPin(Pin("P", halves), (Hole(0.02, 0.15 * D, mouth_radius=5e-4),))
    assert rings.volume == rings.profile.volume


@pytest.mark.slow
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
    requirement = Requirement(0.05, cells="rough", meshes=1)
    (found,) = solve_in_lugs(PinProblem(cut, STEEL, LUGS, (loads,)), requirement)
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
    (found,) = solve_in_lugs(given, Requirement(0.05))
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
    (single,) = solve_in_lugs(PinProblem(cut, STEEL, LUGS, (alone,)), Requirement(0.05))
    assert single.peak.max_von_mises == pytest.approx(peak.max_von_mises, rel=2e-3)


@pytest.mark.slow
def test_a_grease_hole_at_the_extreme_fibre() -> None:
    """3.1 times the bending stress of contact without the hole (four-point bending: 3.10), a little
    less where the moment falls towards the hole's sides; contact itself is not changed.
    """
    forces = F * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
    loads = PinLoads("pull", ("A", "B", "C"), forces)
    cut = CutPin(CLEVIS, (Hole(0.023, 0.2 * D),))
    (plain,) = solve_in_lugs(PinProblem(CLEVIS, STEEL, LUGS, (loads,)), Requirement(0.05))
    (holed,) = solve_in_lugs(PinProblem(cut, STEEL, LUGS, (loads,)), Requirement(0.05))
    assert plain.joint is not None
    assert holed.joint is not None
    assert holed.joint.bending_moment == plain.joint.bending_moment
    assert plain.joint.bending_moment is not None
    nominal = 32.0 * plain.joint.bending_moment / (np.pi * D**3)
    peak = holed.peak
    assert peak.model == "harmonic+local"
    assert peak.max_von_mises is not None
    assert peak.max_von_mises == pytest.approx(3.1 * nominal, rel=0.04)
    assert peak.parts is not None
    assert 0.0 < peak.parts.model < 0.2 * peak.max_von_mises
    assert "cut-in-lug" in peak.reasons


@pytest.mark.slow
def test_a_keyway_that_faces_the_load_loses_its_pressure() -> None:
    """What presses on it, by the contact of the round pin: the cosine about it, to some per cent.
    Turned away from the load it loses none, and contact is the same.
    """
    forces = F * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
    loads = PinLoads("pull", ("A", "B", "C"), forces)
    long, wide, models, moments = 0.01, 0.004, [], []
    for angle in (0.0, np.pi):
        key = Slot(0.023 - long / 2, 0.023 + long / 2, wide, 0.0025, angle, 0.0008, False)
        pin = CutPin(CLEVIS, slots=(key,))
        (found,) = solve_in_lugs(PinProblem(pin, STEEL, LUGS, (loads,)), Requirement(0.1))
        peak = found.peak
        assert found.joint is not None
        assert peak.model == "harmonic+local"
        assert peak.parts is not None
        assert "slot 1 in lug B" in peak.note
        models.append(peak.parts.model / (peak.max_von_mises or 1.0))
        moments.append(found.joint.bending_moment)
        (band,) = (b for b in found.joint.bands if b.name == "B")
        assert band.force == pytest.approx(F, rel=1e-9)
    assert moments[0] == moments[1]
    cosine = 2.0 / np.pi * wide / D * long / 0.02 * 2.0  # 4 p0 / pi on the crest, even along it
    assert models[0] < 0.02
    assert 0.5 * cosine < models[1]

"""Rows of beams on foundations: their places, and bounds of what contact says."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.joints.foundation import bounds_of, contact_places, played
from benchmarks.joints.random_joints import JointTrial, filleted_trials, joint_trials
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem, Solution
from geometry import Pin, Segment

D, F = 0.02, 50e3
STEEL = Material("steel", 210e9, 0.3, yield_strength=1e9)
PULL = PinLoads("pull", tuple("LMR"), F * np.outer([-0.5, 1.0, -0.5], np.eye(3)[0])[None])


def clevis(fillet: float, apart: float) -> Pin:
    """Lugs of 10, 20 and 10 mm, the middle of the pin 1.2 d thick; its fillets begin `apart` from
    the outer lugs and end as far from the middle one.
    """
    gap, wide = fillet + apart, 1.2 * D
    return Pin(
        "P",
        (
            *(Segment(0.002, D), Segment(0.01, D, connection="L"), Segment(gap, D, fillet=fillet)),
            *(Segment(apart, wide), Segment(0.02, wide, connection="M")),
            *(Segment(apart, wide, fillet=fillet), Segment(gap, D)),
            *(Segment(0.01, D, connection="R"), Segment(0.002, D)),
        ),
    )


def solved(pin: Pin, joints: str, requirement: Requirement, loads: PinLoads = PULL) -> Solution:
    lugs = tuple(Lug(n, 0.06, STEEL, edge_radius=2e-4, tilt=2e5) for n in "LMR")
    return solve(PinProblem(pin, STEEL, lugs, (loads,)), replace(requirement, joints=joints))[0]  # type: ignore[arg-type]


def test_places_of_a_row() -> None:
    """Surface and section of a plain pin in bending are one fibre, of 32 M / pi d^3; the row is the
    larger one; the error of the section is that of the moment, that of the row has more.
    """
    plain = Pin("P", (Segment(0.01, D, connection="L"), Segment(0.001, D),
                      Segment(0.02, D, connection="M"), Segment(0.001, D),
                      Segment(0.01, D, connection="R")))  # fmt: skip
    found = solved(plain, "foundation", Requirement())
    peak, joint = found.peak, found.joint
    assert joint is not None
    assert peak.places is not None
    assert joint.bending_moment is not None
    places, section = peak.places, peak.places.section
    assert section is not None
    assert section.bending_moment == pytest.approx(joint.bending_moment, rel=0.01)
    bending = 32.0 * section.bending_moment / (math.pi * D**3)
    assert section.max_von_mises == pytest.approx(bending, rel=0.02)
    assert places.surface.max_von_mises == pytest.approx(section.max_von_mises, rel=0.01)
    assert peak.max_von_mises == max(places.surface.max_von_mises, section.max_von_mises)
    assert section.error_estimate < places.surface.error_estimate <= (peak.error_estimate or 0.0)
    assert section.plastic_utilisation is not None


def test_a_stub_is_governed_by_its_section() -> None:
    """Shear on the axis of a short pin, V (3 + 2 nu) / (2 A (1 + nu)), of Saint-Venant."""
    stub = Pin("P", (Segment(0.006, D, connection="L"), Segment(0.007, D, connection="M"),
                     Segment(0.006, D, connection="R")))  # fmt: skip
    peak = solved(stub, "foundation", Requirement()).peak
    assert peak.places is not None
    assert peak.places.section is not None
    assert peak.places.governs == "section"
    force = peak.places.section.shear_force
    assert 0.49 * F < force < 0.7 * F
    shear = force / (math.pi * D**2 / 4.0) * (3.0 + 2.0 * 0.3) / 2.0 / 1.3
    assert peak.max_von_mises == pytest.approx(math.sqrt(3.0) * shear, rel=0.03)
    assert peak.location is not None
    assert math.hypot(*peak.location[:2]) < 0.2 * D


@pytest.mark.parametrize(("apart", "known"), [(0.001, False), (0.0035, True)])
def test_no_bounds_for_a_fillet_beside_the_edge_of_a_lug(apart: float, known: bool) -> None:
    peak = solved(clevis(0.001, apart), "foundation", Requirement()).peak
    assert ("no-error-known" not in peak.reasons) == known
    assert ("nearer than 0.15 diameters to the edge of a lug" in peak.note) != known


@pytest.mark.parametrize(("share", "known"), [(1e-5, True), (0.2, False)])
def test_no_bounds_for_a_shoulder_pressed_along_the_axis(share: float, known: bool) -> None:
    """Contact has twice the stress at the fillet of a pressed head, whose factor is no shaft's: a
    pin was safe at a factor of 1.86 that fails at 0.90.
    """
    along = share * F * np.outer([1.0, -1.0, 0.0], np.eye(3)[2])
    loads = replace(PULL, forces=PULL.forces + along)
    peak = solved(clevis(0.001, 0.0035), "foundation", Requirement(), loads).peak
    assert ("no-error-known" not in peak.reasons) == known
    assert ("a shoulder whose face a force along the axis presses" in peak.note) != known


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("play", [0.0, 10.0])
def test_contact_and_what_lies_beneath_it_are_within_the_bounds(play: float) -> None:
    """Of joints that had no part in any constant: 2 to 3 lugs, tubes, sharp edges; with fillets
    0.15 to 0.3 d from edges, which may be rounded by 0.05 d. None is above its bound by more than
    5 %; 9 in 10 are within both.
    """
    trials = [played(x, play) for x in joint_trials(9, 41)]
    trials += filleted_trials(9, 42)
    known = [(t, b.bounds) for t in trials if (b := bounds_of(t)).bounds]
    assert len(known) > 0.75 * len(trials)
    inside = 0
    for trial, (low, high) in known:
        try:
            places = contact_places(trial)
        except SolveError:  # contact does not settle
            inside += 1
            continue
        assert max(places.row, places.beneath) < 1.05 * high
        inside += low <= places.row and max(places.row, places.beneath) <= high
    assert inside >= 0.9 * len(known)


@pytest.mark.long
@pytest.mark.slow
def test_auto_is_never_safe_where_contact_is_not() -> None:
    """At factors around that of contact, of pins whose lugs have rounded edges: wherever a
    foundation answers, row and what lies beneath contact have the factor that it says.
    """
    answered = 0
    for trial in filleted_trials(6, 43):
        truth = contact_places(trial)
        for share in (0.5, 0.8, 0.95, 1.05):
            strength = 1e9
            need = share * strength / max(truth.row, truth.beneath)
            peak = _auto(trial, strength, need).peak
            if peak.model == "foundation":
                answered += 1
                assert share < 1.0
    assert answered


def _auto(trial: JointTrial, strength: float, need: float) -> Solution:
    material = replace(trial.material, yield_strength=strength)
    given = PinProblem(trial.pin, material, trial.lugs, (trial.loads,))
    return solve(given, Requirement(goal="decide", required=need, cells="rough", meshes=1))[0]

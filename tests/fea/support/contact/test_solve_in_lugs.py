"""Pins in their lugs: stress with its errors, its range over the joint, and all instants."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve_in_lugs
from fea.support.contact.joint_changes import JointChanges
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.changes import joint_variations
from fea.support.lugs.lug import Lug, LugRange
from fea.support.records import TOGETHER
from fea.support.support import PinProblem, Solution
from geometry import Pin, Segment
from pinbase.memo import Memo
from tests.support.pins.clevis import CLEVIS_PIN

STEEL = Material("steel", 210e9, 0.3)
D, EYE, FORCE = 0.02, 0.05, 50e3
SHANK = 210e9 * EYE * 0.01**3 / (12.0 * 0.04)
PIN = CLEVIS_PIN
LUGS = (
    Lug("L", EYE, STEEL, tilt=SHANK),
    Lug("M", EYE, STEEL),
    Lug("R", EYE, STEEL, tilt=SHANK),
)
SHARE = np.array([-0.5, 1.0, -0.5])
QUICK = Requirement(tolerance=0.1)
# Flexibilities and meshes are those of all loads on the same pin and lugs.
problem = partial(PinProblem, memo=Memo())


def pull(along: Floats, times: Floats | None = None) -> PinLoads:
    """Forces (T, 2) N on the middle band, half of them back on each of the others."""
    forces = np.zeros((len(along), 3, 3))
    forces[:, :, :2] = SHARE[None, :, None] * along[:, None, :]
    return PinLoads("pull", ("L", "M", "R"), forces, times=times)


STEADY = pull(np.array([[FORCE, 0.0]]))


@pytest.fixture(scope="module")
def sharp() -> Solution:
    return solve_in_lugs(problem(PIN, STEEL, LUGS, (STEADY,)), Requirement())[0]


def test_a_clevis_beside_contact_in_three_dimensions(sharp: Solution) -> None:
    """Two programs give 306.3 MPa at mid-span and M / M0 = .8418. The free surface there has that
    without any distance from the edges, which are sharp; the section has 32 M / (pi d^3).
    """
    peak, joint = sharp.peak, sharp.joint
    assert joint is not None
    assert joint.range is not None
    assert peak.verdict == "converged"
    assert peak.max_von_mises == pytest.approx(306.3e6, rel=0.03)
    assert peak.location is not None
    assert peak.location[2] == pytest.approx(0.023, abs=0.0005)
    assert peak.singular_at == ()
    low, high = joint.range.max_von_mises
    assert low < 306.3e6 < high < 1.25 * low
    nominal = FORCE / 2.0 * (0.005 + 0.001 + 0.005)
    middle = dict(joint.bending_moments)[0.023]
    assert middle / nominal == pytest.approx(0.8418, abs=0.03)
    assert peak.places is not None
    assert peak.places.section is not None
    bending = 32.0 * 0.8418 * nominal / (math.pi * D**3)
    assert peak.places.section.max_von_mises == pytest.approx(bending, rel=0.03)
    assert peak.places.section.z == pytest.approx(0.023, abs=0.0005)
    assert "contact" in peak.why


@pytest.mark.parametrize("force", [0.0, 1e-9])
def test_a_press_fit_without_load_has_the_stress_of_the_fit(force: float) -> None:
    """In proportion to the interference; the round-off of its pressures is no load out of balance,
    for which such a pin was said not to be held. Nor is it beside that of a linkage's forces. None
    is a force of a band.
    """
    idle, most = pull(np.array([[force, 0.0]])), []
    for size in (1e-5, 2e-5):
        lugs = tuple(replace(lug, clearance=-size) for lug in LUGS)
        (found,) = solve_in_lugs(problem(PIN, STEEL, lugs, (idle,)), QUICK)
        assert found.peak.verdict == "converged"
        most.append(found.peak.max_von_mises)
        assert found.joint is not None
        assert [band.force for band in found.joint.bands] == [0.0] * 3
        assert found.joint.bending_moment == 0.0
        assert found.peak.places is not None
        assert found.peak.places.section is not None
        assert found.peak.places.section.max_von_mises == 0.0
    assert most[0]
    assert most[1] == pytest.approx(2.0 * most[0], rel=1e-3)
    assert most[1] == pytest.approx(STEEL.youngs_modulus * 0.5e-3 * (1.0 - 0.4**2), rel=0.3)


def test_the_error_names_the_cells(sharp: Solution) -> None:
    peak = sharp.peak
    assert peak.parts is not None
    assert peak.max_von_mises is not None
    assert 0.0 < peak.parts.cells < 0.02 * peak.max_von_mises
    assert peak.interval is None
    assert peak.error_estimate == pytest.approx(peak.parts.total)


def test_bands_carry_what_their_links_exert(sharp: Solution) -> None:
    assert sharp.joint is not None
    bands = {band.name: band for band in sharp.joint.bands}
    assert [bands[n].force for n in "LMR"] == pytest.approx([25e3, 50e3, 25e3], rel=1e-9)
    for name, length in (("L", 0.01), ("M", 0.02), ("R", 0.01)):
        ends = [q for _, q in bands[name].line_load]
        assert max(ends) > bands[name].force / length > min(ends)
    assert bands["L"].couple == pytest.approx(bands["R"].couple, rel=0.02)
    assert bands["M"].couple < 1e-2 * bands["L"].couple
    assert 60.0 < bands["M"].contact_angle < 100.0


def test_section_forces_along_the_pin_are_those_of_statics(sharp: Solution) -> None:
    """Half of the force in the gaps, none at the ends, and the moment of the governing instant."""
    joint = sharp.joint
    assert joint is not None
    assert joint.along is not None
    along = joint.along
    assert along.times is None
    gap = (along.z > 0.0121) & (along.z < 0.0129)
    assert along.shear[0, gap] == pytest.approx(FORCE / 2.0, rel=1e-3)
    assert along.moment[0, [0, -1]] == pytest.approx(0.0, abs=1e-3)
    assert along.moment.max() == pytest.approx(joint.bending_moment)


def test_stress_is_in_proportion_without_clearance(sharp: Solution) -> None:
    """Also in what is asked for later, of which contact is not solved again."""
    given = problem(PIN, STEEL, LUGS, (STEADY,), also={"pull": pull(np.array([[1.0, 0.0]]))})
    (found,) = solve_in_lugs(given, replace(Requirement(), meshes=1))
    answer = found.answer
    assert answer is not None
    more = pull(np.array([[FORCE, 0.0], [0.5 * FORCE, 0.0], [0.0, 0.0]]))
    full, half, none = answer.maxima(found.pressed(more))
    assert half == pytest.approx(0.5 * full, rel=1e-9)
    assert none == 0.0


def test_the_edges_of_lugs_are_contacts_and_leave_the_row(sharp: Solution) -> None:
    """Rounded by 0.5 mm they move it by 1 % at most; they have a peak then, and none if sharp. All
    but the outer ones of the fork have a K, to a quarter the same.
    """
    lugs = tuple(replace(lug, edge_radius=0.0005) for lug in LUGS)
    (found,) = solve_in_lugs(problem(PIN, STEEL, lugs, (STEADY,)), QUICK)
    rounded, plain = found.peak, sharp.peak
    assert rounded.verdict == "converged"
    assert rounded.singular_at == ()
    assert rounded.max_von_mises == pytest.approx(plain.max_von_mises, rel=0.023)
    strengths = []
    for peak in (plain, rounded):
        assert peak.places is not None
        assert peak.places.contact is not None
        edges = {(e.band, e.end): e for e in peak.places.contact.edges}
        assert {e.max_pressure is None for e in edges.values()} == {peak is plain}
        strengths.append([edges["M", "start"].K, edges["L", "end"].K])
    assert strengths[0] == pytest.approx(strengths[1], rel=0.25)


def test_the_crest_of_a_motion_is_found_between_samples() -> None:
    """A force that turns and is largest at 0.37 s, where there is no sample."""
    crest = 0.37

    def at(times: Floats) -> PinLoads:
        size = FORCE * np.exp(-(((times - crest) / 0.3) ** 2))
        angle = 0.5 * times
        along = size[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return pull(along, times)

    case = at(np.linspace(0.0, 1.0, 5))
    given = problem(PIN, STEEL, LUGS, (case,), between={"pull": at})
    (found,) = solve_in_lugs(given, QUICK)
    peak = found.peak
    assert peak.time == pytest.approx(crest, abs=0.01)
    assert peak.max_von_mises == pytest.approx(306.3e6, rel=0.03)
    assert peak.parts is not None
    assert peak.parts.time < 0.02 * 306.3e6
    assert peak.governing is not None
    assert peak.governing.surfaces == ("L", "M", "R")
    joint = found.joint
    assert joint is not None
    assert joint.along is not None
    assert joint.along.times is not None
    assert set(np.linspace(0.0, 1.0, 5)) <= set(joint.along.times)
    largest = joint.along.moment.max(axis=1)
    assert joint.along.times[largest.argmax()] == pytest.approx(crest, abs=0.01)
    assert largest.max() == pytest.approx(joint.bending_moment, rel=5e-3)


def test_lugs_of_a_structure_share_what_the_link_leaves_over() -> None:
    """A pin whose ends sit in a structure: half of the force each, as a fork's would be told to."""
    segments = tuple(
        replace(s, connection=None, name=s.connection) if s.connection in ("L", "R") else s
        for s in PIN.segments
    )
    pin = replace(PIN, segments=segments)
    loads = PinLoads("pull", ("M",), np.array([[[FORCE, 0.0, 0.0]]]))
    (found,) = solve_in_lugs(problem(pin, STEEL, LUGS, (loads,)), replace(Requirement(), meshes=1))
    assert found.joint is not None
    forces = {band.name: band.force for band in found.joint.bands}
    assert forces["L"] + forces["R"] == pytest.approx(FORCE, rel=1e-9)
    assert forces["L"] == pytest.approx(forces["R"], rel=1e-3)
    assert found.peak.max_von_mises == pytest.approx(306.3e6, rel=0.04)


def test_a_structure_beside_takes_more_than_one_farther_away() -> None:
    """Statically indeterminate: lugs of one structure shift together."""
    pin = Pin(
        "P",
        (
            Segment(0.010, D, name="L"),
            Segment(0.001, D),
            Segment(0.020, D, connection="M"),
            Segment(0.020, D),
            Segment(0.010, D, name="R"),
        ),
    )
    loads = PinLoads("pull", ("M",), np.array([[[FORCE, 0.0, 0.0]]]))
    (found,) = solve_in_lugs(problem(pin, STEEL, LUGS, (loads,)), replace(Requirement(), meshes=1))
    assert found.joint is not None
    forces = {band.name: band.force for band in found.joint.bands}
    assert forces["L"] > 1.5 * forces["R"] > 0.0
    assert forces["L"] + forces["R"] == pytest.approx(FORCE, rel=1e-9)


def test_a_rounded_weight_is_shared_and_reported() -> None:
    forces = STEADY.forces.copy()
    forces[0, 0, 0] *= 1.001
    loads = replace(STEADY, forces=forces)
    (found,) = solve_in_lugs(problem(PIN, STEEL, LUGS, (loads,)), replace(Requirement(), meshes=1))
    share = found.peak.imbalance
    assert share is not None
    assert share[0] == pytest.approx(0.5e-3, rel=1e-3)


@pytest.mark.parametrize(
    ("forces", "lugs", "said"),
    [
        (SHARE * [2.0, 1.0, 1.0], LUGS, "their resultant is"),
        ([-0.3, 1.0, -0.7], tuple(replace(lug, tilt=0.0) for lug in LUGS), "no lug reacts"),
    ],
)
def test_what_cannot_be_in_equilibrium_is_not_held_and_says_why(
    forces: list[float], lugs: tuple[Lug, ...], said: str
) -> None:
    along = np.zeros((1, 3, 3))
    along[0, :, 0] = FORCE * np.array(forces)
    loads = PinLoads("pull", ("L", "M", "R"), along)
    (found,) = solve_in_lugs(problem(PIN, STEEL, lugs, (loads,)), QUICK)
    peak = found.peak
    assert (peak.verdict, peak.max_von_mises, found.joint) == ("rigid", None, None)
    assert said in peak.note


def test_the_range_says_what_it_leaves_out() -> None:
    """Forces whose couple is taken by the tilt of the lugs, which cannot be free then."""
    along = np.zeros((1, 3, 3))
    along[0, :, 0] = FORCE * np.array([-0.4, 1.0, -0.6])
    (found,) = solve_in_lugs(
        problem(PIN, STEEL, LUGS, (PinLoads("pull", ("L", "M", "R"), along),)), QUICK
    )
    assert found.joint is not None
    assert found.joint.range is not None
    assert ("tilt", "free") not in {(v.what, v.value) for v in found.joint.range.variations}
    assert found.joint.remark.startswith("not included: tilt free (the links leave a couple")


def test_the_range_holds_joints_with_every_property_at_an_end() -> None:
    """Each solved as a joint of its own. What one property alone adds is 3 % less here: pins
    were safe that such a joint overloads.
    """
    loose = tuple(replace(lug, range=LugRange(clearance=(0.0, 1e-4))) for lug in LUGS)
    (found,) = solve_in_lugs(problem(PIN, STEEL, loose, (STEADY,)), QUICK)
    assert found.joint is not None
    assert found.joint.range is not None
    alone = replace(QUICK, varied=False)
    values = []
    for clearance, stiffness, tilt in itertools.product((0.0, 1e-4), (0.5, 2.0), (0.0, math.inf)):
        metal = replace(STEEL, youngs_modulus=stiffness * STEEL.youngs_modulus)
        lugs = tuple(Lug(x.connection, EYE, metal, clearance, tilt=tilt) for x in LUGS)
        (one,) = solve_in_lugs(problem(PIN, STEEL, lugs, (STEADY,)), alone)
        values.append(one.peak.max_von_mises or 0.0)
    low, high = found.joint.range.max_von_mises
    assert min(values) == pytest.approx(low, rel=0.02)
    assert max(values) == pytest.approx(high, rel=0.02)
    one_by_one = [v.max_von_mises for v in found.joint.range.variations if v.what != TOGETHER]
    assert max(one_by_one) < 0.98 * high


def test_larger_cells_decide_and_have_the_range_of_the_usual_ones() -> None:
    """The same joint by four rings and 24 sectors, with edges that are rounded."""
    rounded = tuple(replace(lug, edge_radius=5e-4) for lug in LUGS)
    steel = replace(STEEL, yield_strength=3e9)
    given = problem(PIN, steel, rounded, (STEADY,))
    (usual,), (decided,) = (
        solve_in_lugs(given, requirement)
        for requirement in (QUICK, replace(QUICK, goal="decide", required=1))
    )
    peaks = usual.peak, decided.peak
    assert decided.rings is not None
    assert usual.rings is not None
    assert len(decided.rings.connections) < len(usual.rings.connections)
    assert "contact" in peaks[1].reasons
    value, error = peaks[0].max_von_mises or 0.0, peaks[1].error_estimate or 0.0
    assert abs((peaks[1].max_von_mises or 0.0) - value) <= error
    ratios = []
    for found, peak in zip((usual, decided), peaks, strict=True):
        assert found.joint is not None
        assert found.joint.range is not None
        over = found.joint.range.variations
        ratios.append([x.max_von_mises / (peak.max_von_mises or 1.0) for x in over])
    assert ratios[1] == pytest.approx(ratios[0], abs=0.015)


def test_a_softer_joint_is_that_of_softer_lugs() -> None:
    """What the range varies is what a model of its own would have."""
    model = ContactModel(PIN, STEEL, LUGS)
    soft = Material("soft", 105e9, 0.3)
    own = ContactModel(PIN, STEEL, tuple(replace(lug, material=soft) for lug in LUGS))
    varied = model.varied(model.lugs, (2.0,) * len(model.lugs))
    z = np.array([0.023])
    ours, theirs = (m.solve(STEADY).bending_moment(z)[0, 0, 0] for m in (varied, own))
    assert ours == pytest.approx(theirs, rel=1e-9)
    tilted = model.varied(tuple(replace(lug, tilt=math.inf) for lug in model.lugs))
    assert abs(tilted.solve(STEADY).bending_moment(z)[0, 0, 0]) < abs(ours)


def test_varied_joints_begin_with_the_cells_of_those_with_their_gaps() -> None:
    """They are as from any other guess, and found in fewer steps."""
    span = LugRange(stiffness=(0.5, 2.0), tilt=(0.0, math.inf))
    lugs = tuple(replace(lug, tilt=1e3, range=span) for lug in LUGS)
    model = ContactModel(PIN, STEEL, lugs)
    changes = JointChanges(model, [model.solve(STEADY)], Requirement(), (), ("own",))
    ((solved, missing),) = changes.joints([tuple(joint_variations(model.whole, model.lugs))])
    steps, steps_anew = 0, 0
    for change, joint in solved:
        (anew,) = model.varied(change.lugs, change.softness).pressed(STEADY)
        (state,) = joint.states
        size = anew.pressure.max()
        assert state.pressure == pytest.approx(anew.pressure, rel=1e-9, abs=1e-9 * size)
        steps, steps_anew = steps + state.steps, steps_anew + anew.steps
    assert (len(solved), missing) == (15, [])
    assert steps < steps_anew


def test_nothing_is_in_contact_without_loads() -> None:
    (found,) = solve_in_lugs(problem(PIN, STEEL, LUGS, (pull(np.zeros((1, 2))),)), QUICK)
    peak = found.peak
    assert (peak.verdict, peak.max_von_mises, peak.error_estimate) == ("converged", 0.0, 0.0)
    assert found.joint is not None
    assert all(band.mean_pressure == 0.0 for band in found.joint.bands)


def test_surfaces_have_the_names_of_the_whole_pin() -> None:
    """Also the corners between bores, and those of its rings."""
    tube = replace(
        PIN, segments=tuple(replace(s, bore=0.012) if s.connection else s for s in PIN.segments)
    )
    (found,) = solve_in_lugs(problem(tube, STEEL, LUGS, (STEADY,)), replace(QUICK, meshes=1))
    names = {name for zone in found.peak.singular_at for name in zone.between}
    steps = {f"bore step {i}" for i in range(1, 7)}
    assert names <= {*"LMR", "its lug", "bore L", "bore M", "bore R", *steps}
    assert {"bore M", "bore step 3"} <= names
    assert "ring" not in found.peak.note

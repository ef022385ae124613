"""Pins on foundations in their lugs: stress, how far contact may be away, when that is enough."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.joints.foundation import bounds_of, clevis, contact_places, played
from benchmarks.joints.joint import TRUTH
from benchmarks.joints.random_joints import joint_trials
from fea.beam.model import BeamField
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.peak import meets_limit
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve
from fea.support.foundation.bounds import StressBounds, stress_bounds
from fea.support.foundation.foundation_model import FoundationModel
from fea.support.foundation.plane_contact import half_angle, largest_pressure
from fea.support.foundation.stress import FoundationStress
from fea.support.foundation.variations import FoundationRange, prescribed_ranges
from fea.support.lugs.lug import Bushing, Lug
from fea.support.support import PinProblem, Solution
from geometry import Pin, Segment
from tests.support.each import each, sampled
from tests.support.exact.plane_contact import PERSSON

D, FORCE = 0.02, 50e3
STEEL = Material("steel", 210e9, 0.3, density=7850.0)
SHARE = np.array([-0.5, 1.0, -0.5])
PULL = PinLoads("pull", ("L", "M", "R"), FORCE * SHARE[None, :, None] * np.eye(3)[0])


def usual() -> tuple[Pin, tuple[Lug, ...]]:
    pin, lugs = clevis(20, 10, 1)
    return pin, tuple(lugs)


def on_foundations(pin: Pin, lugs: tuple[Lug, ...], loads: PinLoads = PULL) -> StressBounds:
    model = FoundationModel(pin, STEEL, lugs)
    return stress_bounds(FoundationStress.of(model), model.solve(loads))


def solved(
    lugs: tuple[Lug, ...], pin: Pin, requirement: Requirement, joints: str = "auto"
) -> Solution:
    given = PinProblem(pin, STEEL, lugs, (PULL,))
    (found,) = solve(given, replace(requirement, joints=joints))  # type: ignore[arg-type]
    return found


def odd_loads() -> tuple[Pin, tuple[Lug, ...], PinLoads]:
    """A step with a fillet, forces in two planes and along the axis, a torque, weight."""
    profile = (
        Segment(0.004, D),
        Segment(0.011, D, connection="L"),
        Segment(0.004, D),
        Segment(0.025, 0.026, connection="M"),
        Segment(0.003, 0.026),
        Segment(0.015, 0.026, connection="R"),
    )
    pin = Pin("P", profile, fillet=0.001)
    tilts = {"L": 2e4, "M": 0.0, "R": math.inf}
    lugs = tuple(Lug(name, 0.06, STEEL, tilt=k) for name, k in tilts.items())
    body = np.array([[300.0, -9.81, 0.0]])
    forces = FORCE * np.array([[[-0.4, 0.2, 0.1], [1.0, 0.4, -0.3], [0.0, 0.0, 0.2]]])
    forces[0, 2, :2] = -forces[0, :2, :2].sum(axis=0) - 7850.0 * pin.volume * body[0, :2]
    moments = np.array([[[0.0, 0.0, 80.0], [0.0, 0.0, -110.0], [0.0, 0.0, 30.0]]])
    return pin, lugs, PinLoads("odd", ("L", "M", "R"), forces, moments, body=body)


def test_stress_is_that_of_the_beam_under_the_rings_loads() -> None:
    """As fea.beam has it from the loads of the rings, by another way."""
    pin, lugs, loads = odd_loads()
    model = FoundationModel(pin, STEEL, lugs)
    found = model.solve(loads)
    top = FoundationStress.of(model).von_mises(found)
    beam = BeamField(model.pin, STEEL, (), found.loads)
    assert top.von_mises.max() == pytest.approx(beam.estimate.maximum, rel=2e-3)
    assert top.theta[top.place] == pytest.approx(beam.estimate.theta % (2 * math.pi), abs=0.02)


def test_what_acts_along_a_pin_ends_with_it() -> None:
    pin, lugs, loads = odd_loads()
    found = FoundationModel(pin, STEEL, lugs).solve(loads)
    ends = np.array([0.0, pin.length])
    assert found.shear_force(ends) == pytest.approx(np.zeros((1, 2, 2)), abs=1e-9 * FORCE)
    pull, torque = found.along(ends)
    assert pull == pytest.approx(np.zeros((1, 2)), abs=1e-9 * FORCE)
    assert torque == pytest.approx(np.zeros((1, 2)), abs=1e-9 * FORCE * D)


def as_structure(pin: Pin, names: str) -> Pin:
    """With bands on which no link bears."""
    segments = (
        replace(s, name=s.connection, connection=None) if s.connection in (*names,) else s
        for s in pin.segments
    )
    return replace(pin, segments=tuple(segments))


def test_lugs_of_a_structure_react_what_links_leave_over() -> None:
    """By symmetry half of it each, so that the pin has the loads of a clevis."""
    pin, lugs = usual()
    links = FoundationModel(pin, STEEL, lugs).solve(PULL)
    held = FoundationModel(as_structure(pin, "LR"), STEEL, lugs)
    along = PinLoads("one", ("M",), PULL.forces[:, 1:2] + [0.0, 0.0, 900.0])
    found = held.solve(replace(along, moments=np.array([0.0, 0.0, 40.0])))
    assert found.line_load == pytest.approx(links.line_load, rel=1e-9)
    pull, torque = found.along(np.array([0.5 * pin.length, pin.length]))
    assert pull[0] == pytest.approx([0.0, 0.0], abs=1e-6)  # half of it on either side
    assert torque[0] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_single_lug_of_a_structure_reacts_a_couple() -> None:
    """Which the other, free one cannot."""
    pin = Pin("S", (Segment(D, D, name="A"), Segment(D, D, connection="B")))
    lugs = Lug("A", 2.5 * D, STEEL), Lug("B", 2.5 * D, STEEL, tilt=0.0)
    model = FoundationModel(pin, STEEL, lugs)
    loads = PinLoads("shear", ("B",), np.array([[[1e4, 0.0, 0.0]]]))
    moment = model.solve(loads).bending_moment(np.array([D]))
    assert abs(moment[0, 0, 0]) == pytest.approx(1e4 * D / 2.0, rel=1e-9)
    with pytest.raises(SolveError):
        FoundationModel(pin, STEEL, [replace(lug, tilt=0.0) for lug in lugs]).solve(loads)


@each("gap", PERSSON)
def test_plane_contact_is_perssons(gap: float) -> None:
    angle, peak = PERSSON[gap]
    assert math.degrees(half_angle(gap)) == pytest.approx(angle, abs=1e-3)
    assert largest_pressure(gap) == pytest.approx(peak, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("play", sampled([3.0, 0.0], every=2))
@pytest.mark.parametrize("count", sampled([6, 20], every=2))
def test_contact_is_within_the_bounds_of_most_pins(play: float, count: int) -> None:
    """9 in 10, on pins that had no part in any constant: the larger of surface and section,
    and what lies beneath contact.
    """
    inside = 0
    for trial in (played(x, play) for x in joint_trials(count, 25)):
        low, high = bounds_of(trial).bounds or (0.0, 0.0)
        found = contact_places(trial)
        inside += low <= found.row <= max(found.row, found.beneath) <= high
    assert inside >= math.floor(0.9 * count)


def test_what_the_beam_leaves_out_makes_the_bounds_wider() -> None:
    pin, lugs = usual()
    tight = on_foundations(pin, lugs)
    loose = on_foundations(pin, tuple(replace(lug, clearance=2e-5) for lug in lugs))
    round_ = on_foundations(pin, tuple(replace(lug, edge_radius=5e-4) for lug in lugs))
    assert tight.maximum == loose.maximum == round_.maximum
    assert tight.bounds is not None
    for wider in (loose, round_):
        assert wider.bounds is not None
        assert wider.bounds[0] < tight.bounds[0]
        assert wider.bounds[1] > tight.bounds[1]


@each(
    "change",
    [{"clearance": 1.9e-3}, {"edge_radius": 2e-3}, {"outer_diameter": 0.1}],
)
def test_no_bounds_beyond_what_was_measured(change: dict[str, float]) -> None:
    pin, lugs = usual()
    found = on_foundations(pin, tuple(replace(lug, **change) for lug in lugs))  # type: ignore[arg-type]
    assert found.bounds is None
    assert found.error is None
    assert found.why


def test_sharp_corners_are_left_out_and_fillets_without_a_factor_are_not() -> None:
    pin, lugs = usual()
    wide = replace(pin, segments=(*pin.segments[:4], replace(pin.segments[4], diameter=0.03),
                                  *pin.segments[5:]))  # fmt: skip
    assert on_foundations(wide, lugs).bounds is not None
    tiny = on_foundations(replace(wide, fillet=1e-4), lugs)
    assert tiny.bounds is None
    assert "fillet" in tiny.why
    head = replace(pin, segments=(*pin.segments, Segment(0.005, 0.03)), fillet=1e-4)
    assert on_foundations(head, lugs).bounds is not None  # beyond which nothing acts


def test_a_row_has_the_error_of_the_model_alone() -> None:
    pin, lugs = usual()
    found = solved(lugs, pin, Requirement(tolerance=0.02), "foundation")
    peak, joint = found.peak, found.joint
    assert (peak.model, peak.verdict) == ("foundation", "unconverged")
    assert peak.parts is not None
    assert peak.error_estimate == peak.parts.model > 0.11 * (peak.max_von_mises or 0.0)
    assert peak.max_von_mises == pytest.approx(300e6, rel=0.02)  # 306 in three dimensions
    assert joint is not None
    assert joint.model == "foundation"
    assert [b.force for b in joint.bands] == pytest.approx([25e3, 50e3, 25e3])
    lengths = [np.diff(b.ends) @ [q for _, q in b.line_load] for b in joint.bands]
    assert lengths == pytest.approx([25e3, 50e3, 25e3])
    assert joint.bands[0].contact_angle == pytest.approx(PERSSON[0.0][0], abs=1e-3)
    assert joint.bands[1].couple == pytest.approx(0.0, abs=1e-6)
    assert joint.bands[0].couple > 1.0
    rough = solved(lugs, pin, Requirement(tolerance=0.9), "foundation")
    assert rough.peak.verdict == "converged"


def test_a_row_without_a_known_error_has_one_as_large_as_itself() -> None:
    pin, lugs = clevis(10, 5, 0.5)  # thinner lugs than were measured
    peak = solved(tuple(lugs), pin, Requirement(tolerance=0.9), "foundation").peak
    assert peak.verdict == "unconverged"
    assert peak.error_estimate == peak.max_von_mises
    assert "no-error-known" in peak.reasons
    assert peak.max_von_mises is not None
    assert meets_limit(peak, 100.0 * peak.max_von_mises) is None  # nothing bounds it


def test_a_motion_governs_between_its_samples() -> None:
    """A force that turns and swells: the instant of the largest, and its loads."""

    def at(times: Floats) -> PinLoads:
        size, angle = FORCE * (1.0 - (times - 0.41) ** 2), 2.0 * times
        across = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1) * size[:, None]
        return PinLoads("swing", ("L", "M", "R"), across[:, None] * SHARE[:, None], times=times)

    pin, lugs = usual()
    case = at(np.linspace(0.0, 1.0, 4))
    given = PinProblem(pin, STEEL, lugs, (case,), {"swing": at})
    (found,) = solve(given, Requirement(joints="foundation"))
    peak = found.peak
    assert peak.time == pytest.approx(0.41, abs=1e-3)
    assert peak.max_von_mises == pytest.approx(on_foundations(pin, lugs).maximum, rel=1e-4)
    assert found.answer is not None
    assert found.answer.maxima(PULL)[0] == pytest.approx(peak.max_von_mises, rel=1e-4)


def far_apart() -> tuple[Pin, tuple[Lug, ...]]:
    """A slender pin under loads far apart, in lugs 1.5 diameters thick."""
    lug, gap = Segment(1.5 * D, D), Segment(5.0 * D, D)
    left, middle, right = (replace(lug, connection=name) for name in "LMR")
    lugs = tuple(Lug(name, 2.5 * D, STEEL, tilt=0.0) for name in "LMR")
    return Pin("F", (left, gap, middle, gap, right)), lugs


def test_auto_takes_foundations_where_bending_governs() -> None:
    pin, lugs = far_apart()
    assert solved(lugs, pin, Requirement(tolerance=0.3)).peak.model == "foundation"


STRONG = replace(STEEL, yield_strength=1e9)


def decided(required: float, edges: float = 3e-4) -> Solution:
    """The clevis of about 300 MPa, with rounded or sharp edges of its lugs."""
    pin, lugs = usual()
    rounded = tuple(replace(lug, edge_radius=edges) for lug in lugs)
    requirement = Requirement(goal="decide", required=required)
    (found,) = solve(PinProblem(pin, STRONG, rounded, (PULL,)), requirement)
    return found


def test_auto_takes_foundations_where_they_show_that_a_pin_is_safe() -> None:
    peak = decided(1.5).peak
    assert (peak.model, "foundation-decides" in peak.reasons) == ("foundation", True)
    assert (peak.max_von_mises or 0.0) + (peak.error_estimate or 0.0) < 1e9 / 1.5


@pytest.mark.slow
@pytest.mark.parametrize(
    ("required", "edges"), sampled([(2.6, 3e-4), (10.0, 3e-4), (1.5, 0.0)], every=2)
)
def test_auto_takes_contact_for_what_is_close_or_fails_or_is_singular(
    required: float, edges: float
) -> None:
    """Foundations say 176 to 424 MPa; a factor of 2.6 permits 385 MPa."""
    assert decided(required, edges).peak.model == "harmonic"


@pytest.mark.slow
def test_auto_takes_contact_for_more_than_foundations_can() -> None:
    """The clevis, though its error is within the tolerance, is pressed too hard."""
    pin, lugs = usual()
    assert solved(lugs, pin, Requirement(tolerance=0.5)).peak.model == "harmonic"


@each(("lugs", "clearance", "largest"), [
    ((inner, outer, gap), clearance, mid)
    for inner, outer, gap, clearance, _, mid in TRUTH if inner != 10
])  # fmt: skip
def test_contact_in_three_dimensions_is_within_the_range(
    lugs: tuple[float, float, float], clearance: float, largest: float
) -> None:
    pin, eyes = clevis(*lugs)
    loose = [replace(lug, clearance=clearance / 1e3) for lug in eyes]
    found, _ = FoundationRange(pin, STEEL, loose, 0.1, assumed=False).at(PULL)
    assert found is not None
    low, high = found.max_von_mises
    assert low < largest * 1e6 < high


def test_discs_between_sharp_corners_have_no_surface_to_read() -> None:
    """A beam says nothing of them: contact answers, unless foundations are requested, and there is
    no range around a pin with another support.
    """
    profile = (
        Segment(0.0075, 0.300, connection="L"),
        Segment(0.005, 0.296),
        Segment(0.0075, 0.300, connection="M"),
        Segment(0.005, 0.296),
        Segment(0.0075, 0.300, connection="R"),
    )
    discs, eyes = Pin("D", profile), tuple(Lug(name, 0.6, STEEL) for name in "LMR")
    why = "no surface is left to read"
    with pytest.raises(SolveError, match=why):
        FoundationRange(discs, STEEL, eyes, 0.1, assumed=True)
    (around,) = prescribed_ranges(discs, STEEL, eyes, (PULL,), (0.1, True))
    assert around is not None
    assert (around.range, why in around.remark) == (None, True)
    decide = Requirement(goal="decide", required=2.0)
    (found,) = solve(PinProblem(discs, replace(STEEL, yield_strength=800e6), eyes, (PULL,)), decide)
    assert found.joint is not None
    assert found.joint.model == "contact"


SOFT_AND_FREE = "stiffness of the lugs times 0.5, tilt free"


def test_a_range_by_what_is_changed() -> None:
    pin, lugs = usual()
    found, remark = FoundationRange(pin, STEEL, lugs, 0.1, assumed=True).at(PULL)
    assert found is not None
    assert (found.model, found.assumed, remark) == ("foundation", True, "")
    by = {(v.what, v.value): v for v in found.variations}
    assert {x for x in by if x[0] != "together"} == {
        ("clearance", "0.002 of the diameter"), ("stiffness of the lugs", "times 0.5"),
        ("stiffness of the lugs", "times 2"), ("tilt", "free"), ("tilt", "guided"),
    }  # fmt: skip
    assert ("together", "stiffness of the lugs times 2, tilt guided") in by
    alone = max(v.max_von_mises for v in found.variations if v.what != "together")
    assert by["together", SOFT_AND_FREE].max_von_mises > 1.02 * alone
    assert by["clearance", "0.002 of the diameter"].length == pytest.approx(4e-5)
    soft, stiff = (by["stiffness of the lugs", f"times {k}"].max_von_mises for k in ("0.5", "2"))
    assert stiff < soft
    assert by["tilt", "guided"].max_von_mises < by["tilt", "free"].max_von_mises
    ends = [end for v in found.variations for end in v.interval or ()]
    assert found.max_von_mises == (min(ends), max(ends))


def test_clearance_that_is_wide_for_a_small_load_is_left_out() -> None:
    pin, lugs = usual()
    over = FoundationRange(pin, STEEL, lugs, 0.1, assumed=True)
    found, remark = over.at(replace(PULL, forces=1e-3 * PULL.forces))
    assert found is not None
    assert {v.what for v in found.variations} == {"stiffness of the lugs", "tilt", "together"}
    assert "clearance" in remark


def test_the_range_says_what_no_lug_holds() -> None:
    """Forces whose couple is taken by the tilt of the lugs, which cannot be free then."""
    pin, lugs = usual()
    uneven = replace(PULL, forces=PULL.forces * [[[0.8], [1.0], [1.2]]])
    found, remark = FoundationRange(pin, STEEL, lugs, 0.1, assumed=True).at(uneven)
    assert found is not None
    assert ("tilt", "free") not in {(v.what, v.value) for v in found.variations}
    assert remark.startswith("not included: tilt free (pin ")
    assert "which no lug reacts" in remark


def test_why_there_is_no_range() -> None:
    """One row for each case that was solved."""
    pin, lugs = usual()
    turning = replace(PULL, moments=FORCE * D * np.array([1.0, 0.0, 0.0]))  # that nothing reacts
    unbalanced = replace(PULL, forces=PULL.forces * [[[1.0], [0.5], [1.0]]])
    found = prescribed_ranges(pin, STEEL, lugs, (PULL, turning, None, unbalanced), (0.1, True))
    assert found[2] is None
    rows = [row for row in found if row is not None]
    assert [row.range is not None for row in rows] == [True, False, False]
    assert [bool(row.remark) for row in rows] == [False, True, True]
    assert all((row.model, row.bands) == ("prescribed", ()) for row in rows)
    tight = tuple(replace(lug, clearance=-1e-5) for lug in lugs)
    lined = tuple(replace(lug, bushing=Bushing(1e-3, STEEL)) for lug in lugs)
    for other in (tight, lined):
        (none,) = prescribed_ranges(pin, STEEL, other, (PULL,), (0.1, True))
        assert none is not None
        assert none.range is None
        assert none.remark

"""Links that state moments across the axis: contact and foundations carry just these.

Statics determines every resultant, so most references here are exact.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import Between
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.solve.solve import solve
from fea.support.contact.coarser_cells import on_coarser_cells
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.foundation.foundation_model import FoundationModel, JointFoundation
from fea.support.lugs.lug import Lug
from fea.support.support import PinProblem
from geometry import CutPin, Hole, Pin, Segment
from tests.support.each import each
from tests.support.pins.clevis import CLEVIS_PIN

STEEL = Material("steel", 210e9, 0.3, density=7850.0, yield_strength=600e6)
D, FORCE = 0.02, 50e3
PIN = CLEVIS_PIN
TILT = 210e9 * 0.05 * 0.01**3 / (12.0 * 0.04)
LUGS = tuple(Lug(name, 0.05, STEEL, tilt=TILT) for name in "LMR")
FORK = FORCE * np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]])
# About all bands, in balance with a couple of forces about x: R reacts what L and M bring.
MOMENTS = np.array([[[0.0, -40.0, 0.0], [30.0, 100.0, 0.0], [0.0, 0.0, 0.0]]])
ROUGH = Resolution(4, 24, 8)


def pull(moments: Floats = MOMENTS, forces: Floats = FORK) -> PinLoads:
    return PinLoads("pull", ("L", "M", "R"), forces, moments)


def band_moments(joint: JointContact | JointFoundation, instant: int = 0) -> Floats:
    """What each lug brings to the pin about the middle of its band, by sums over its rings,
    (B, 2).
    """
    bands, loads = joint.bands, joint.loads
    arm = (bands.z - bands.middles[bands.band])[:, None]
    by_ring = np.stack([-loads.forces[instant, :, 1], loads.forces[instant, :, 0]], axis=1) * arm
    # Contact has forces that are even along a ring; foundations state moments of rings, too.
    by_ring = by_ring + loads.moments[instant, :, :2]
    return np.stack([by_ring[bands.band == b].sum(axis=0) for b in range(len(bands))])


@pytest.fixture(scope="module")
def model() -> ContactModel:
    return ContactModel(PIN, STEEL, LUGS, ROUGH)


@each("kind", ["contact", "foundation"])
def test_the_pressure_has_the_moment_of_the_link(kind: str, model: ContactModel) -> None:
    """Whatever the stiffness of its tilt; the lug without a moment reacts the rest."""
    other = FoundationModel(PIN, STEEL, LUGS)
    joint = model.solve(pull()) if kind == "contact" else other.solve(pull())
    exact = np.array([[0.0, -40.0], [30.0, 100.0], [-30.0, -60.0]])
    assert band_moments(joint) == pytest.approx(exact, abs=1e-6 * FORCE * PIN.length)
    for guided in (0.0, math.inf):
        lugs = (*(replace(lug, tilt=guided) for lug in LUGS[:2]), LUGS[2])
        same = model.varied(lugs) if kind == "contact" else FoundationModel(PIN, STEEL, lugs)
        assert same.solve(pull()).loads.forces == pytest.approx(joint.loads.forces, abs=1e-5)


@each("kind", ["contact", "foundation"])
def test_sections_between_lugs_are_those_of_statics(kind: str, model: ContactModel) -> None:
    """Where every link states its moment: the couples and forces before a section, by hand."""
    moments = MOMENTS.copy()
    moments[0, 2, :2] = -moments[0, :2, :2].sum(axis=0)
    model = model if kind == "contact" else FoundationModel(PIN, STEEL, LUGS)  # type: ignore[assignment]
    joint = model.solve(pull(moments))
    gaps = np.array([0.0125, 0.0335])
    by_x = -FORCE / 2.0 * (gaps - 0.007) + [0.0, FORCE * (0.0335 - 0.023)] - [-40.0, 60.0]
    by_y = [0.0, 30.0]
    found = joint.bending_moment(gaps)[0]
    assert found[:, 0] == pytest.approx(by_x, abs=1e-5 * FORCE * D)
    assert found[:, 1] == pytest.approx(by_y, abs=1e-5 * FORCE * D)


def test_a_lug_may_carry_a_moment_alone() -> None:
    """Two lugs with a pair of moments and no force: one couple all along between them."""
    pin = Pin("S", (Segment(D, D, connection="A"), Segment(D, D), Segment(D, D, connection="B")))
    lugs = tuple(Lug(name, 0.05, STEEL, clearance=1e-5) for name in "AB")
    moments = 200.0 * np.array([[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]])
    loads = PinLoads("couple", ("A", "B"), np.zeros((1, 2, 3)), moments)
    for model in (ContactModel(pin, STEEL, lugs, ROUGH), FoundationModel(pin, STEEL, lugs)):
        joint = model.solve(loads)
        inside = joint.bending_moment(np.linspace(D, 2 * D, 5))[0]
        assert np.linalg.norm(inside, axis=1) == pytest.approx([200.0] * 5, rel=1e-6)
        assert joint.bending_moment(np.array([0.0, 3 * D]))[0] == pytest.approx(
            np.zeros((2, 2)), abs=1e-6 * 200.0
        )


def test_contact_and_foundation_agree(model: ContactModel) -> None:
    """Within the error that the foundation is known to have of the largest moment, 6 %."""
    z = np.linspace(0.0, PIN.length, 93)
    beam = FoundationModel(PIN, STEEL, LUGS)
    ours, theirs = (
        np.linalg.norm(m.solve(pull()).bending_moment(z)[0], axis=1).max() for m in (model, beam)
    )
    assert theirs == pytest.approx(ours, rel=0.06)


def test_moments_turn_with_the_loads(model: ContactModel) -> None:
    """Rotated by a right angle, as the forces; doubled together, pressures double."""
    loads = pull()
    turned = loads.turned(math.pi / 2.0)
    one, other = model.solve(loads), model.solve(turned)
    assert band_moments(other) == pytest.approx(
        band_moments(one) @ np.array([[0.0, 1.0], [-1.0, 0.0]]), abs=1e-6 * FORCE * D
    )
    twice = model.solve(pull(2.0 * MOMENTS, 2.0 * FORK))
    assert twice.contact[0].pressure == pytest.approx(2.0 * one.contact[0].pressure, rel=1e-6)


def test_links_share_a_small_couple_and_a_large_one_is_refused(model: ContactModel) -> None:
    """All links state moments: 3 N m too much are 1 N m each."""
    moments = MOMENTS.copy()
    moments[0, 2, :2] = -moments[0, :2, :2].sum(axis=0)
    rounded = moments + np.array([0.0, 1.0, 0.0])
    exact, shared = (band_moments(model.solve(pull(m))) for m in (moments, rounded))
    assert shared == pytest.approx(exact, abs=1e-6 * FORCE * D)
    for other in (model, FoundationModel(PIN, STEEL, LUGS)):
        with pytest.raises(SolveError, match="no lug reacts") as error:
            other.solve(pull(moments + np.array([0.0, 0.2 * FORCE * PIN.length, 0.0])))
        assert error.value.code == "couple-not-reacted"


def swinging(times: Floats) -> PinLoads:
    """A pull and a moment, which passes through zero while the pull does not."""
    t = times[:, None, None]
    moments = 4.0 * np.cos(t) * MOMENTS
    return PinLoads("swing", ("L", "M", "R"), (1.0 - 0.1 * np.sin(t)) * FORK, moments, times=times)


def governs(joints: str) -> None:
    """Check a motion against its instant of the largest moment alone, which must govern."""
    times = np.linspace(0.0, math.pi / 2.0, 7)
    between: dict[str, Between] = {"swing": swinging}
    requirement = Requirement(tolerance=0.3, joints=joints, meshes=1, varied=False)  # type: ignore[arg-type]
    (found,) = solve(PinProblem(PIN, STEEL, LUGS, (swinging(times),), between), requirement)
    alone = replace(swinging(times[:1]), times=None)
    (first,) = solve(PinProblem(PIN, STEEL, LUGS, (alone,)), requirement)
    assert found.peak.time == pytest.approx(0.0, abs=1e-9)
    assert found.peak.max_von_mises == pytest.approx(first.peak.max_von_mises, rel=0.01)


def test_a_motion_with_moments() -> None:
    governs("foundation")


@pytest.mark.slow
def test_a_motion_with_moments_in_contact() -> None:
    governs("contact")


def test_a_moment_that_passes_through_zero_is_still_stated() -> None:
    """Lugs are as free to tilt where moments are zero as at the other instants of a case."""
    times = np.linspace(0.0, math.pi / 2.0, 7)
    problem = PinProblem(PIN, STEEL, LUGS, (swinging(times),), {"swing": swinging})
    model = ContactModel(PIN, STEEL, LUGS, ROUGH)
    last = band_moments(model.solve(problem.between["swing"](times[-1:])))
    assert last[:2] == pytest.approx(np.zeros((2, 2)), abs=1e-6)


@pytest.mark.slow
def test_a_cut_pin_carries_moments(model: ContactModel) -> None:
    """A small cross hole in the middle lug: statics are the same."""
    cut = CutPin(PIN, (Hole(0.023, 0.002, math.pi / 2.0),))
    moments = band_moments(model.seeing(cut).solve(pull()))
    exact = np.array([[0.0, -40.0], [30.0, 100.0], [-30.0, -60.0]])
    assert moments == pytest.approx(exact, abs=1e-6 * FORCE * PIN.length)


def test_a_body_force_is_in_balance_on_coarser_cells_whose_middle_is_another() -> None:
    pin = Pin(
        "P",
        (
            Segment(0.016, D, connection="A"),
            Segment(0.004, D),
            Segment(0.024, D, connection="B"),
        ),
    )
    body = np.array([[0.0, -500.0, 0.0]])
    assert STEEL.density is not None
    weight = STEEL.density * pin.volume * body[0]
    forces = np.array([[[0.0, 4000.0, 0.0], [0.0, -4000.0, 0.0]]])
    forces[0, 1] -= weight
    first = 0.008 * forces[0, 0, 1] + 0.032 * forces[0, 1, 1] + 0.022 * weight[1]
    moments = np.array([[[30.0, 0.0, 0.0], [first - 30.0, 0.0, 0.0]]])
    loads = PinLoads("pull", ("A", "B"), forces, moments, body=body)
    model = ContactModel(pin, STEEL, tuple(Lug(name, 0.05, STEEL) for name in "AB"), ROUGH)
    coarser, _ = on_coarser_cells(model)
    assert abs(coarser.bands.middle - model.bands.middle) > 1e-4
    for problem in (model.contact, coarser):
        (state,) = model.pressed(loads, problem)
        bands, angles = problem.bands, problem.angles
        area = bands.radius * bands.length * (angles[1] - angles[0])
        pressed = -(state.pressure @ np.sin(angles + state.angle)) * area
        chord = np.sinc(0.5 * (angles[1] - angles[0]) / np.pi)  # pressure is even on a sector
        assert pressed.sum() * chord == pytest.approx(-weight[1], rel=1e-9)
        by_ring = (pressed * chord * bands.z).sum() + 0.022 * weight[1]
        assert by_ring == pytest.approx(0.0, abs=1e-9 * 4000.0 * pin.length)

"""A pin in its lugs: stress, moments and pressures of clevises beside those of 3D contact."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_pin
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from fea.support.support import Solution
from geometry import Pin, Segment
from geometry.shape.lug_outline import LugOutline
from tests.support.each import each

E, NU, D, EYE, HELD, FORCE = 210e9, 0.3, 0.02, 0.05, 0.05, 50e3
STEEL = Material("steel", E, NU, density=7850.0)
FORK = np.array([[[-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]]) * FORCE


def clevis(inner: float, outer: float, gap: float, clearance: float = 0.0) -> ContactModel:
    """Of steel, all in m; the fork's sides tilt as their shanks bend."""
    over, apart = Segment(0.002, D), Segment(gap, D)
    left, middle, right = (
        Segment(t, D, connection=name) for t, name in zip((outer, inner, outer), "LMR", strict=True)
    )
    pin = Pin("P", (over, left, apart, middle, apart, right, over))
    outline = LugOutline("round", D, EYE, EYE, HELD, EYE / 2.0)
    tilt = E * outer**3 / (12.0 * outline.bending)
    stiffness = {"L": tilt, "M": math.inf, "R": tilt}
    lugs = [Lug(name, EYE, STEEL, clearance, tilt=k) for name, k in stiffness.items()]
    return ContactModel(pin, STEEL, lugs)


@pytest.fixture(scope="module")
def model() -> ContactModel:
    return clevis(0.02, 0.01, 0.001)


@pytest.fixture(scope="module")
def joint(model: ContactModel) -> JointContact:
    return model.solve(PinLoads("pull", ("L", "M", "R"), FORK))


@pytest.fixture(scope="module")
def solution(joint: JointContact) -> Solution:
    requirement = Requirement(model="harmonic", meshes=2)
    return solve_pin(joint.pin, STEEL, (), (joint.loads,), requirement)[0]


def von_mises(solution: Solution, r: float, z: float, angle: float) -> float:
    """At the point that is read next to a place, MPa."""
    assert solution.answer is not None
    fields = solution.answer.fields  # type: ignore[attr-defined]
    near = np.hypot(fields.points[:, 0] - r, fields.points[:, 1] - z).argmin(keepdims=True)
    found = Circumference(fields, solution.loads).envelope(near, np.array([angle]))
    return float(found[0, 0]) / 1e6


def test_stresses_of_a_clevis(solution: Solution) -> None:
    """306.3 MPa on the tension fibre at mid-span, 177.0 on the neutral axis in the shear plane, by
    contact in three dimensions with two programs: within 2 %. A clamped fork with an even
    pressure gives 0.67 of the first, prescribed pressures 1.14 to 1.18.
    """
    assert von_mises(solution, D / 2.0, 0.023, 0.0) == pytest.approx(306.3, rel=0.02)
    assert von_mises(solution, 0.0, 0.0125, math.pi / 2.0) == pytest.approx(177.0, rel=0.02)


def test_the_shape_of_the_line_load(joint: JointContact) -> None:
    """Over its mean, at the middle lug's centre 0.60; more at its edges, and at the inner ends of
    the outer ones, whose sharp edges no mesh resolves.
    """
    load = joint.line_load[0, :, 0].reshape(3, -1)
    means = np.array([-FORCE / 2 / 0.01, FORCE / 0.02, -FORCE / 2 / 0.01])
    left, middle, right = load / means[:, None]
    assert 0.5 * (middle[3] + middle[4]) == pytest.approx(0.60, abs=0.05)
    assert middle[0] > 1.5
    assert left[-1] > left[0]
    assert right[1:-1] == pytest.approx(left[-2:0:-1], rel=0.02)  # on a mesh that is not symmetric


def test_the_bending_moment_closes(joint: JointContact) -> None:
    """Zero beyond the last lug, and by symmetry largest at mid-span: 0.8418 of the nominal one."""
    at = joint.bending_moment(np.array([0.0, 0.023, 0.046]))[0]
    assert at[0] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert at[2] == pytest.approx([0.0, 0.0], abs=1e-6 * abs(at[1, 0]))
    nominal = FORCE / 2.0 * (0.005 + 0.001 + 0.005)
    assert abs(at[1, 0]) / nominal == pytest.approx(0.8418, abs=0.004)


def test_pressures_have_the_forces_of_the_links(joint: JointContact) -> None:
    by_band = joint.loads.forces.reshape(1, 3, -1, 3).sum(axis=2)
    assert by_band == pytest.approx(FORK, abs=1e-9 * FORCE)


def test_angles_and_pressures_by_band(joint: JointContact) -> None:
    """Without clearance a lug touches half way round, as in a plate (Persson: 84.8 degrees)."""
    assert np.degrees(joint.contact_angle[0]) == pytest.approx([85.0] * 3, abs=11.0)
    mean = FORCE / (D * 0.02)
    assert (joint.largest_pressure[0] > mean).all()


def test_instants_are_those_of_each_alone(model: ContactModel) -> None:
    """Warm starts change no answer; without clearance pressures follow a load in proportion."""
    turned = FORK[:, :, [1, 0, 2]]
    together = model.solve(
        PinLoads("m", ("L", "M", "R"), np.concatenate([FORK, 2.0 * FORK, turned]))
    )
    alone = model.solve(PinLoads("m", ("L", "M", "R"), turned))
    first, twice, last = together.contact
    assert twice.pressure == pytest.approx(2.0 * first.pressure, rel=1e-9)
    assert last.pressure == pytest.approx(alone.contact[0].pressure, rel=1e-9)
    assert last.pressure == pytest.approx(first.pressure, rel=1e-9)
    assert last.angle - first.angle == pytest.approx(math.pi / 2.0)
    assert last.shift == pytest.approx(first.shift[:, [1, 0]], abs=1e-9 * np.abs(first.shift).max())
    one, _, other = together.loads.forces
    assert other == pytest.approx(one[:, [1, 0, 2]], abs=1e-9 * FORCE)


def test_axial_forces_and_the_body_force_come_along(model: ContactModel) -> None:
    """Gravity of the pin is answered by the links; a force along the axis is even over a band."""
    mass = 7850.0 * model.whole.volume
    forces = FORK.copy()
    forces[0, 1, 1] = mass * 9.81
    forces[0, :, 2] = [1e3, -2e3, 1e3]
    loads = PinLoads("w", ("L", "M", "R"), forces, body=np.array([0.0, -9.81, 0.0]))
    found = model.solve(loads)
    by_band = found.loads.forces.reshape(1, 3, -1, 3).sum(axis=2)
    assert by_band == pytest.approx(forces, abs=1e-8 * FORCE)
    assert found.loads.body[0] == pytest.approx([0.0, -9.81, 0.0])


def test_sharp_edges_of_lugs_leave_the_surface_a_maximum(
    joint: JointContact, solution: Solution
) -> None:
    """The tension fibre at mid-span, 306.3 MPa, already on the second mesh, without zones."""
    peak = solution.peak
    assert peak.max_von_mises == pytest.approx(306.3e6, rel=0.03)
    assert peak.location is not None
    assert peak.location[2] == pytest.approx(0.023, abs=0.0005)
    assert peak.singular_at == ()
    assert peak.verdict == "converged"
    first = solve_pin(joint.pin, STEEL, (), (joint.loads,), Requirement(model="harmonic", meshes=1))
    assert first[0].peak.max_von_mises == pytest.approx(peak.max_von_mises, rel=0.03)


def test_an_edge_radius_takes_load_from_the_edge() -> None:
    """Over a radius of 2 mm, and what it takes from the gap is a quarter round's."""
    sharp, round_ = Lug("M", EYE, STEEL), Lug("M", EYE, STEEL, edge_radius=0.002)
    ends = np.linspace(0.0, 0.02, 401)
    middle = 0.5 * (ends[1:] + ends[:-1])
    inside = np.maximum(0.002 - np.minimum(middle, 0.02 - middle), 0.0)
    depth = 0.002 - np.sqrt(0.002**2 - inside**2)
    assert round_.gap(ends)[3:-3] == pytest.approx(depth[3:-3], abs=2e-6)  # steep at the very edge
    assert round_.gap(ends).sum() * 5e-5 == pytest.approx(
        2 * 0.002**2 * (1 - math.pi / 4), rel=1e-6
    )
    assert not sharp.gap(ends).any()


@each(
    ("change", "said"),
    [
        ({"outer_diameter": 0.0}, "outer diameter"),
        ({"clearance": math.nan}, "clearance"),
        ({"edge_radius": -1.0}, "edge radius"),
        ({"tilt": -1.0}, "tilt"),
    ],
)
def test_lugs_that_cannot_be(change: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Lug(**{"connection": "A", "outer_diameter": 0.1, "material": STEEL, **change})  # type: ignore[arg-type]


def test_lugs_that_do_not_fit_the_pin(model: ContactModel) -> None:
    lugs = list(model.lugs)
    for wrong in (lugs[:2], [*lugs[:2], Lug("Q", EYE, STEEL)], [*lugs[:2], Lug("R", D, STEEL)]):
        with pytest.raises(ValueError, match="lug"):
            ContactModel(model.whole, STEEL, wrong)


def test_forces_out_of_balance_are_refused(model: ContactModel) -> None:
    with pytest.raises(SolveError):
        model.solve(PinLoads("x", ("L", "M"), FORK[:, :2]))


def test_cells_converge(model: ContactModel) -> None:
    """The moment at mid-span with coarser and finer cells: within 1 % of each other."""
    loads, moments = PinLoads("pull", ("L", "M", "R"), FORK), []
    for cells in (Resolution(5, 24, 8), Resolution(10, 48, 16)):
        other = ContactModel(model.whole, STEEL, model.lugs, cells)
        moments.append(other.solve(loads).bending_moment(np.array([0.023]))[0, 0, 0])
    assert moments[0] == pytest.approx(moments[1], rel=0.01)

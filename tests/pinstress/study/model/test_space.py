"""A linkage in space, from its file to the wrenches on its pins."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from loads.forces.reactions import Reactions
from loads.space.linkage import RigidBody
from pinbase.arrays import Floats
from pinstress import load_study
from pinstress.analysis.plan import all_loads
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.mechanism.linkage import any_linkage
from pinstress.study.model.mechanism.space import pin_axes
from pinstress.study.reading.errors import InputError
from pinstress.study.schema.space import SpaceJointTable
from tests.support.each import each
from tests.support.study_text import edited_once, study_file

RSSR = """
title = "A crank, a coupler and a rocker about skew axes"
units = "m-N-s"
[mechanism]
dimension = 3
gravity = [0, 0, "-9.81 m/s^2"]
[mechanism.joint.A]
at = [0, 0, 0]
axis = [0, 0, 2]
fixed_in = "ground"
connections = { A1 = "crank" }
[mechanism.joint.B]
at = [0.1, 0, 0]
kind = "universal"
axis = [0, 0, 1]
second_axis = [0, 1, 0]
fixed_in = "crank"
connections = { B1 = "coupler" }
[mechanism.joint.C]
at = [0.3, 0.25, 0.2]
kind = "spherical"
fixed_in = "rocker"
connections = { C1 = "coupler" }
[mechanism.joint.D]
at = [0.3, 0.25, 0]
axis = [1, 0, 0]
fixed_in = "ground"
connections = { D1 = "rocker" }
[mechanism.body.crank]
mass = 2
inertia = [1e-3, 2e-3, 2e-3, 1e-4, 0, 0]
[mechanism.body.coupler]
bar = { joints = ["B", "C"], diameter = 0.02, density = "7850 kg/m^3" }
[mechanism.body.rocker]
[mechanism.body.rocker.bar]
joints = ["D", "C"]
section = [0.03, 0.02]
depth_along = [0, 1, 0]
density = "7850 kg/m^3"
[mechanism.drive]
joint = "A"
law = "cycloidal"
start = "0 deg"
end = "90 deg"
duration = 0.5
[case.turn]
kind = "motion"
samples = 21
[case.rest]
kind = "static"
position = "30 deg"
[[case.rest.apply]]
body = "rocker"
at = "C"
force = [0, 1000, 300]
"""  # fmt: skip


def solved(folder: Path, text: str) -> dict[str, CaseLoads]:
    """The loads of all cases of a study."""
    study = load_study(study_file(folder, text))
    return all_loads(study, [*study.table.case])


def message(folder: Path, text: str) -> str:
    """What is wrong with a study, from reading, its mechanism or its cases."""
    with pytest.raises(InputError) as error:
        solved(folder, text)
    return str(error.value)


def edited(*changes: tuple[str, str]) -> str:
    return edited_once(RSSR, changes)


def test_a_load_from_time_zero_acts_at_the_first_instant(tmp_path: Path) -> None:
    push = '[[case.turn.apply]]\nbody = "rocker"\nat = "C"\nforce = [0, 1000, 0]\n'
    always, begun = (solved(tmp_path, RSSR + push + more) for more in ("", "begin = 0\n"))
    assert np.array_equal(begun["turn"].reactions.forces, always["turn"].reactions.forces)


def test_a_tabled_load_ends_when_a_constant_one_does(tmp_path: Path) -> None:
    """At 0.3 s, which is an instant but for round-off."""
    push = '[[case.turn.apply]]\nbody = "rocker"\nat = "C"\nend = 0.3\n'
    tabled = "direction = [0, 1, 0]\nforce_law = { points = [[0, 1000], [1, 1000]] }\n"
    constant, found = (
        solved(tmp_path, RSSR + push + how) for how in ("force = [0, 1000, 0]\n", tabled)
    )
    assert found["turn"].reactions.forces == pytest.approx(constant["turn"].reactions.forces)


def test_crank_and_rocker_obey_the_input_output_equation(tmp_path: Path) -> None:
    """The coupler's length is constant: (C - B)^2, with B on the crank's circle about z and C on
    the rocker's about x.
    """
    study = load_study(study_file(tmp_path, RSSR))
    case = all_loads(study, ["turn"])["turn"]
    assert case.space is not None
    motion = case.space.dynamics.motion
    theta = motion.coordinate("A")[0]
    end = motion.point("rocker", (0.3, 0.25, 0.2))[0]
    crank = 0.1 * np.stack([np.cos(theta), np.sin(theta), 0.0 * theta], axis=1)
    length = np.linalg.norm([0.2, 0.25, 0.2])
    assert np.linalg.norm(end - crank, axis=1) == pytest.approx(np.full(21, length), rel=1e-12)
    assert np.hypot(end[:, 1] - 0.25, end[:, 2]) == pytest.approx(np.full(21, 0.2), rel=1e-12)
    assert end[:, 0] == pytest.approx(np.full(21, 0.3))


def test_power_of_the_drive_is_the_change_of_energy(tmp_path: Path) -> None:
    """Over a motion from rest to rest the work is that against gravity."""
    study = load_study(study_file(tmp_path, RSSR))
    case = all_loads(study, ["turn"])["turn"]
    assert case.space is not None
    assert case.space.efforts is not None
    kinetic, potential = case.space.energies
    change = kinetic + potential - potential[0]
    work = case.space.efforts[0].work
    assert work == pytest.approx(change, abs=1e-7 * np.abs(change).max())
    assert np.ptp(kinetic) > 0.1 * np.ptp(change)


def test_couple_of_the_crank_by_virtual_work(tmp_path: Path) -> None:
    """At rest the drive's couple times the crank's rate is minus the power of load and weights."""
    study = load_study(study_file(tmp_path, RSSR))
    case = all_loads(study, ["rest"])["rest"]
    assert case.space is not None
    dynamics = case.space.dynamics

    def work(theta: float) -> float:
        """The work of load and weights from the drawing to an angle of the crank."""
        text = edited(('position = "30 deg"', f'position = "{theta!r} rad"'))
        moved = all_loads(load_study(study_file(tmp_path, text)), ["rest"])["rest"].space
        assert moved is not None
        end = moved.dynamics.motion.point("rocker", (0.3, 0.25, 0.2))[0][0]
        return float(end @ (0.0, 1000.0, 300.0)) - float(moved.energies[1][0])

    step = 1e-4
    theta = float(np.radians(30.0))
    slope = (work(theta + step) - work(theta - step)) / (2.0 * step)
    assert dynamics.drive[0, 0] == pytest.approx(-slope, rel=1e-6)


def test_forces_on_the_coupler_are_in_equilibrium_with_its_weight(tmp_path: Path) -> None:
    study = load_study(study_file(tmp_path, RSSR))
    r = all_loads(study, ["rest"])["rest"].reactions
    mass = 7850.0 * np.pi / 4.0 * 0.02**2 * np.linalg.norm([0.2, 0.25, 0.2])
    pushes = r.force("B1")[0] + r.force("C1")[0]  # of the coupler on its pins
    assert pushes == pytest.approx([0.0, 0.0, -9.81 * mass], abs=1e-9)
    moments = dict(zip(r.connections, r.moments[0], strict=True))
    assert moments["C1"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)  # a ball carries none


def test_pins_turn_with_their_carriers(tmp_path: Path) -> None:
    """The pin at B is fixed in the crank, of which the angle is 90 degrees at the end."""
    study = load_study(study_file(tmp_path, RSSR))
    r = all_loads(study, ["turn"])["turn"].reactions
    x, y, z = r.force("B1")[-1]
    assert r.in_pin_axes("B1")[-1] == pytest.approx([y, -x, z], abs=1e-9)
    assert r.in_pin_axes("B1")[0] == pytest.approx(r.force("B1")[0])


@each(
    ("axis", "columns"),
    [
        ((0.0, 0.0, 3.0), [(1, 0, 0), (0, 1, 0), (0, 0, 1)]),
        ((2.0, 0.0, 0.0), [(0, 1, 0), (0, 0, 1), (1, 0, 0)]),
        ((0.0, 1.0, 0.0), [(1, 0, 0), (0, 0, -1), (0, 1, 0)]),
        ((0.0, 3.0, 4.0), [(1, 0, 0), (0, 0.8, -0.6), (0, 0.6, 0.8)]),
    ],
)
def test_axes_of_a_pin_by_the_rule(
    axis: tuple[float, float, float], columns: list[tuple[float, float, float]]
) -> None:
    joint = SpaceJointTable.model_validate(
        {"at": [0, 0, 0], "axis": list(axis), "fixed_in": "ground", "connections": {"A": "a"}}
    )
    assert pin_axes(joint) == pytest.approx(np.transpose(columns))


def test_a_floating_pin_is_in_equilibrium(tmp_path: Path) -> None:
    """Also the wrench of its first connection, in whose body it is fixed, is found."""
    text = edited(
        ('kind = "spherical"\nfixed_in = "rocker"\nconnections = { C1 = "coupler" }',
         'kind = "spherical"\nweight = 20\nconnections = { C1 = "coupler", C2 = "rocker" }'),
    )  # fmt: skip
    study = load_study(study_file(tmp_path, text))
    cases = all_loads(study, ["rest", "turn"])
    r = cases["rest"].reactions
    assert r.force("C1") + r.force("C2") == pytest.approx(np.array([[0.0, 0.0, 20.0]]), abs=1e-8)
    r, space = cases["turn"].reactions, cases["turn"].space
    assert space is not None
    at = r.connections.index("C1")
    need = 20.0 / 9.81 * (space.accelerations[:, at] - space.gravity)
    assert r.force("C1") + r.force("C2") == pytest.approx(need, abs=1e-8)
    assert np.linalg.norm(space.accelerations[:, at], axis=1).max() > 1.0


def test_inertia_of_a_skew_rectangular_bar(tmp_path: Path) -> None:
    """Against a sum over many particles of the bar."""
    study = load_study(study_file(tmp_path, edited(("[0.3, 0.25, 0]", "[0.35, 0.2, 0]"))))
    linkage = any_linkage(study)
    bar = next(b for b in linkage.bodies if b.name == "rocker")
    assert isinstance(bar, RigidBody)
    first, second = np.array([0.35, 0.2, 0.0]), np.array([0.3, 0.25, 0.2])
    along = second - first
    length = float(np.linalg.norm(along))
    e = along / length
    a = np.array([0.0, 1.0, 0.0]) - e[1] * e
    a /= np.linalg.norm(a)
    b = np.cross(e, a)
    n = 60
    grid = (np.arange(n) + 0.5) / n - 0.5
    s, t, u = np.meshgrid(grid * length, grid * 0.03, grid * 0.02, indexing="ij")
    r = s[..., None] * e + t[..., None] * a + u[..., None] * b
    r = r.reshape(-1, 3)
    mass = 7850.0 * 0.03 * 0.02 * length
    tensor = mass * ((r * r).sum(1).mean() * np.eye(3) - r.T @ r / len(r))
    assert bar.mass == pytest.approx(mass)
    assert np.array(bar.inertia) == pytest.approx(tensor, rel=1e-3, abs=1e-6 * tensor.max())
    assert bar.centre == pytest.approx(0.5 * (first + second))


@each(
    ("old", "new", "key", "words"),
    [
        ("dimension = 3\n", "", "mechanism.joint.A: ", "mechanism.dimension = 3"),
        ("at = [0, 0, 0]", "at = [0, 0]", "mechanism.joint.A: ", "[x, y, z]"),
        ("axis = [0, 0, 2]\n", "", "mechanism.joint.A: ", "needs axis"),
        ("axis = [0, 0, 2]\n", "axis = [0, 0, 0]\n", "mechanism.joint.A: ", "not be zero"),
        ("axis = [0, 0, 2]\n", 'axis = "z"\n', "mechanism.joint.A: ", "axis = [x, y, z]"),
        ("second_axis = [0, 1, 0]", "second_axis = [0, 1, 1]", "mechanism.joint.B: ", "45 deg"),
        ("second_axis = [0, 1, 0]", "second_axis = [0, 1, 1e-4]", "mechanism.joint.B: ",
         "second_axis = [0, 1, 0]"),
        ("second_axis = [0, 1, 0]", "second_axis = [1e-5, 0, 1]", "mechanism.joint.B: ",
         "second_axis = [1, 0, 0]"),
        ('kind = "spherical"', 'kind = "ball"', "mechanism.joint.C.kind: ", "'spherical'"),
        ('fixed_in = "crank"', 'fixed_in = "crnk"', "mechanism.joint.B.fixed_in: ", "'crank'"),
        ('joint = "A"', 'joint = "C"', "mechanism.drive.joint: ", "has no angle"),
        ('joint = "A"', 'joint = "E"', "mechanism.drive.joint: ", "no joint 'E'"),
        ("[mechanism.drive]", '[mechanism.spring.s]\nslide = "A"\n[mechanism.drive]',
         "mechanism.spring.s.slide: ", "has no travel"),
        ("force = [0, 1000, 300]", "force = [0, 1000]", "case.rest.apply[1].force: ", "[x, y, z]"),
        ('position = "30 deg"', 'hold = ["B"]', "case.rest.hold: ", "no drive or stop 'B'"),
        ("1e-3, 2e-3, 2e-3, 1e-4, 0, 0", "1e-3, 9e-3, 2e-3", "mechanism: body crank", "sum of"),
        ("[1e-3, 2e-3, 2e-3, 1e-4, 0, 0]", "1e-3", "mechanism.body.crank: ", "[xx, yy, zz]"),
        ("depth_along = [0, 1, 0]", "depth_along = [0, 0, 1]", "mechanism: body rocker", "across"),
        ("depth_along = [0, 1, 0]", "depth_along = [0, 0.01, 1]", "mechanism: body rocker",
         "across"),
        ("[mechanism.drive]", '[mechanism.stop.s]\nbodies = ["ground", "crank"]\n'
         "[mechanism.drive]", "mechanism.stop.s: ", "joint, slide or between"),
        ('fixed_in = "rocker"\n', "", "mechanism.joint.C: ", "two connections"),
        ('end = "90 deg"', 'end = "170 deg"', "case.turn: ", ""),
    ],
)  # fmt: skip
def test_mistakes_are_told_at_their_keys(
    tmp_path: Path, old: str, new: str, key: str, words: str
) -> None:
    told = message(tmp_path, edited((old, new)))
    assert words in told
    assert re.search(rf"study\.toml:\d+: {re.escape(key)}", told)


@each(
    "bands",
    [
        '{ length = 0.01, diameter = 0.02 }, { length = 0.02, diameter = 0.02, connection = "D1" }',
        '{ length = 0.01, diameter = 0.02, connection = "D1" }, { length = 0.02, diameter = 0.02 },'
        ' { length = 0.01, diameter = 0.02, name = "FAR", ear_of = "D1" }',
    ],
)
def test_moments_of_links_are_about_the_middles_of_their_bands(tmp_path: Path, bands: str) -> None:
    """The wrench at D with the band 40 mm out on the pin is that at the joint's point, moved; so
    is that of a clevis with its ears about this place.
    """
    pin = f"""
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.D]
material = "steel"
clamp = ["start"]
profile = [{{ length = 0.02, diameter = 0.02 }}, {bands}]
"""
    here = solved(tmp_path, RSSR + pin)["rest"].reactions
    there = solved(tmp_path, edited(("axis = [1, 0, 0]", "axis = [1, 0, 0]\nz = 0.01")) + pin)
    moved = there["rest"].reactions
    force, moment = (r[0, here.connections.index("D1")] for r in (here.forces, here.moments))
    assert moved.force("D1")[0] == pytest.approx(force)
    about = moment - np.cross([0.05, 0.0, 0.0], force)
    assert moved.moments[0, here.connections.index("D1")] == pytest.approx(about)
    assert np.linalg.norm(about - moment) > 1.0


PIN = """
[material.steel]
youngs_modulus = "200 GPa"
poisson_ratio = 0.3
[pin.NAME]
material = "steel"
clamp = ["start"]
profile = [
  { length = 0.02, diameter = 0.02 },
  { length = 0.01, diameter = 0.02, connection = "A1" },
]
"""  # fmt: skip


def test_a_pin_of_another_name_than_its_joint_places_its_bands(tmp_path: Path) -> None:
    """By z the link is 0.035 from the joint's point, in whose name no pin need be."""
    placed = edited(('fixed_in = "ground"\nconnections = { A1', 'fixed_in = "ground"\nz = 0.01\n'
                     'connections = { A1'))  # fmt: skip
    plain = solved(tmp_path, RSSR + PIN.replace("NAME", "spindle"))["rest"].reactions
    named = solved(tmp_path, placed + PIN.replace("NAME", "A"))["rest"].reactions
    other = solved(tmp_path, placed + PIN.replace("NAME", "spindle"))["rest"].reactions

    def moment(of: Reactions) -> Floats:
        return np.asarray(of.moments[0, of.connections.index("A1")])

    force = plain.force("A1")[0]
    arm = np.array([0.0, 0.0, 0.01 + 0.025])
    assert moment(named) == pytest.approx(moment(plain) - np.cross(arm, force), abs=1e-6)
    assert moment(other) == pytest.approx(moment(named), abs=1e-9)
    assert np.abs(np.cross(arm, force)).max() > 1.0
    two = placed.replace('A1 = "crank"', 'A1 = "crank", A2 = "arm"') + PIN.replace("NAME", "P")
    two += PIN[PIN.index("[pin") :].replace("NAME", "Q").replace("A1", "A2")
    two += "[mechanism.body.arm]\nmass = 1\n"
    two = two.replace('joint = "A"\n', 'joint = "A"\nconnection = "A1"\n')
    assert "mechanism.joint.A.z: may be the start of any of the pins P, Q" in message(tmp_path, two)


@each("size", ["1e308", "1e-300"])
def test_directions_may_have_any_length(tmp_path: Path, size: str) -> None:
    wanted = solved(tmp_path, RSSR)["rest"].reactions.forces
    changes = [
        ("axis = [1, 0, 0]", f"axis = [{size}, 0, 0]"),
        ("second_axis = [0, 1, 0]", f"second_axis = [0, {size}, 0]"),
        ("depth_along = [0, 1, 0]", f"depth_along = [0, {size}, 0]"),
    ]
    found = solved(tmp_path, edited(*changes))["rest"].reactions.forces
    assert found == pytest.approx(wanted, rel=1e-12)

"""Gears and racks in space, from their study to the forces at teeth and bearings."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from pinbase.arrays import Floats
from pinstress import load_study
from pinstress.analysis.mechanics.gather_space import skeleton_in_space
from pinstress.analysis.plan import all_loads
from pinstress.study.model.space_cases import InSpace
from tests.pinstress.study.model.test_space import message, solved
from tests.support.each import each
from tests.support.study_text import study_file

HEAD = """
title = "Gears"
units = "m-N-s"
[mechanism]
dimension = 3
gravity = [0, 0, 0]
"""


def shaft(name: str, at: Floats, axis: Floats, on: str = "ground") -> str:
    """A body on a revolute joint of its own."""
    return (
        f"[mechanism.joint.{name}]\nat = {np.asarray(at).tolist()}\n"
        f'axis = {np.asarray(axis).tolist()}\nfixed_in = "{on}"\n'
        f'connections = {{ {name}1 = "{name.lower()}" }}\n'
        f"[mechanism.body.{name.lower()}]\nmass = 2\ncentre = {np.asarray(at).tolist()}\n"
        "inertia = [0.02, 0.02, 0.02]\n"
    )


def couple(body: str, axis: Floats, size: float) -> str:
    return f'[[case.rest.apply]]\nbody = "{body}"\ncouple = {(size * np.asarray(axis)).tolist()}\n'


def rest(folder: Path, text: str) -> InSpace:
    found = solved(folder, text)["rest"].space
    assert found is not None
    return found


def force(found: InSpace, name: str) -> Floats:
    r = found.reactions
    return np.asarray(r.forces[0, r.connections.index(name)])


@each("helix", [0.0, 35.0, -20.0])
@each("shaft_angle", [90.0, 60.0, 110.0])
def test_forces_of_bevel_gears_are_those_of_the_textbook(
    tmp_path: Path, shaft_angle: float, helix: float
) -> None:
    """Tangential, radial and axial force at the pitch point (Shigley, 13-15 and 15-1, of spiral
    gears with their hand) by the teeth numbers 15 and 25, whatever the axes in the world.
    """
    sigma, phi, psi = (math.radians(x) for x in (shaft_angle, 20.0, helix))
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    tip = np.array([0.3, -0.2, 0.5])
    e1, e2 = turn @ [0.0, 0.0, 1.0], turn @ [math.sin(sigma), 0.0, math.cos(sigma)]
    r1 = 0.045
    torque = 30.0
    text = (
        HEAD + shaft("A", tip + 0.2 * e1, -2.0 * e1) + shaft("B", tip + 0.3 * e2, e2)
        + f'[mechanism.gear.g]\nbodies = ["a", "b"]\njoints = ["A", "B"]\nteeth = [15, 25]\n'
        f'module = {2.0 * r1 / 15}\nhelix_angle = "{helix} deg"\n[mechanism.drive]\njoint = "B"\n'
        '[case.rest]\nkind = "static"\n' + couple("a", e1, torque)
    )  # fmt: skip
    found = rest(tmp_path, text)
    first = math.atan2(math.sin(sigma), 25.0 / 15.0 + math.cos(sigma))
    radial = (e2 - (e2 @ e1) * e1) / np.linalg.norm(e2 - (e2 @ e1) * e1)
    along = np.cross(e1, radial)
    # The load turns the first gear along `along`; the teeth of the second hold it.
    tangential = -torque / r1
    oblique = -tangential * math.tan(psi)
    apart = abs(tangential) * math.tan(phi) / math.cos(psi)
    on_first = (
        tangential * along
        + (oblique * math.sin(first) - apart * math.cos(first)) * radial
        + (oblique * math.cos(first) + apart * math.sin(first)) * e1
    )
    r = found.reactions
    k = r.connections.index("g")
    assert r.bodies[k] == "a"
    assert force(found, "g") == pytest.approx(-on_first, abs=1e-9 * abs(tangential))
    # The bearing of the first holds the rest; its moment about the joint follows by statics.
    assert force(found, "A1") == pytest.approx(on_first, abs=1e-9 * abs(tangential))
    pitch = tip + r1 / math.tan(first) * e1 + r1 * radial
    moment = np.cross(pitch - tip - 0.2 * e1, on_first) + torque * e1
    ours = r.moments[0, r.connections.index("A1")]
    assert ours == pytest.approx(moment, abs=1e-9 * torque)
    assert found.dynamics.drive[0, 0] == pytest.approx(torque * 25.0 / 15.0, rel=1e-9)


def test_helical_gears_push_along_their_axes_by_their_hand(tmp_path: Path) -> None:
    """A right-handed gear that its motor drives about +z is pushed along +z (the rule of the right
    hand), where its teeth are.
    """
    z = np.array([0.0, 0.0, 1.0])
    text = (
        HEAD + shaft("A", 0.0 * z, z)
        + shaft("B", np.array([0.12, 0.0, 0.1]), z)
        + '[mechanism.gear.g]\nbodies = ["a", "b"]\njoints = ["A", "B"]\nteeth = [20, 40]\n'
        'helix_angle = "25 deg"\nat = [0, 0, 0.03]\n[mechanism.drive]\njoint = "A"\n'
        '[case.rest]\nkind = "static"\n' + couple("b", z, 50.0)
    )  # fmt: skip
    found = rest(tmp_path, text)
    ft = 50.0 / 0.08  # the second gear is turned by its load, the motor of the first holds it
    spread = ft * math.tan(math.radians(20.0)) / math.cos(math.radians(25.0))
    push = ft * math.tan(math.radians(25.0))
    on_first = -force(found, "g")
    # Load on b about +z moves its teeth at the pitch point towards -y; so it pushes a towards -y.
    assert on_first == pytest.approx([-spread, -ft, push], rel=1e-9)
    assert found.dynamics.drive[0, 0] == pytest.approx(25.0, rel=1e-9)
    at = np.array([0.04, 0.0, 0.03])
    moments = found.reactions.moments[0, found.reactions.connections.index("A1")]
    assert moments[:2] == pytest.approx(np.cross(at, on_first)[:2], rel=1e-9)


BEVEL_DIFFERENTIAL = (
    HEAD.replace("[0, 0, 0]", '[0, 0, "-9.81 m/s^2"]')
    + """
[mechanism.joint.L]
at = [-0.1, 0, 0]
axis = [1, 0, 0]
fixed_in = "ground"
connections = { L1 = "left" }
[mechanism.joint.R]
at = [0.1, 0, 0]
axis = [1, 0, 0]
fixed_in = "ground"
connections = { R1 = "right" }
[mechanism.joint.C]
at = [-0.2, 0, 0]
axis = [1, 0, 0]
fixed_in = "ground"
connections = { C1 = "cage", C2 = "left" , C3 = "right" }
[mechanism.joint.P]
at = [0, 0.08, 0]
axis = [0, 1, 0]
fixed_in = "cage"
connections = { P1 = "planet" }
[mechanism.body.left]
mass = 1
inertia = [0.002, 0.001, 0.001]
[mechanism.body.right]
mass = 1
inertia = [0.002, 0.001, 0.001]
[mechanism.body.cage]
mass = 3
centre = [0.01, 0.02, 0.03]
inertia = [0.03, 0.02, 0.02]
[mechanism.body.planet]
mass = 0.5
centre = [0.001, 0.08, 0.0]
inertia = [0.0004, 0.0005, 0.0004]
[mechanism.gear.gl]
bodies = ["left", "planet"]
joints = ["C", "P"]
teeth = [18, 12]
at = [-0.04, 0.06, 0]
[mechanism.gear.gr]
bodies = ["right", "planet"]
joints = ["C", "P"]
teeth = [18, 12]
helix_angle = "30 deg"
at = [0.04, 0.06, 0]
[[mechanism.drive]]
joint = "C"
connection = "C1"
law = "cycloidal"
start = "0 deg"
end = "700 deg"
duration = 1
[[mechanism.drive]]
joint = "L"
law = "constant"
start = "0 deg"
end = "500 deg"
duration = 1
[case.turn]
kind = "motion"
samples = 41
[[case.turn.apply]]
body = "right"
couple = [-7, 0, 0]
"""
)


def test_a_differential_splits_turns_and_torques(tmp_path: Path) -> None:
    """The cage turns at the mean of both sides; without the accelerations the torques of the sides
    are equal. Power balances to round-off, with all weights and inertias.
    """
    found = solved(tmp_path, BEVEL_DIFFERENTIAL)["turn"].space
    assert found is not None
    motion = found.dynamics.motion
    cage, left = (motion.spin(b)[:, 0] for b in ("cage", "left"))
    assert motion.spin("right")[:, 0] == pytest.approx(2.0 * cage - left, abs=1e-9)
    assert found.violation is not None
    assert found.violation < 1e-10


STEERING = """
title = "A rack, its pinion and an idler"
units = "m-N-s"
[mechanism]
GRAVITY
[mechanism.joint.P]
at = [0, 0]
fixed_in = "ground"
connections = { P1 = "pinion" }
[mechanism.joint.I]
at = [-0.1, 0.06]
fixed_in = "ground"
connections = { I1 = "idler" }
[mechanism.body.pinion]
mass = 2
centre = [0.01, 0.02]
inertia = 0.01
[mechanism.body.idler]
mass = 1
inertia = 0.02
[mechanism.body.rack]
mass = 3
centre = [0.1, -0.03]
inertia = 0.02
SLIDER
[mechanism.rack.teeth]
pinion = "pinion"
joint = "P"
SLIDE
side = "right"
radius = 0.03
pressure_angle = "25 deg"
[mechanism.gear.pair]
bodies = ["idler", "pinion"]
joints = ["I", "P"]
teeth = [60, 21]
[mechanism.drive]
DRIVEN
law = "cycloidal"
start = "0 deg"
end = "300 deg"
duration = 0.3
[case.move]
kind = "motion"
samples = 15
[[case.move.apply]]
body = "rack"
at = [0.1, -0.03]
force = [50, -20]
"""


def test_gears_and_racks_of_parallel_axes_are_those_in_the_plane(tmp_path: Path) -> None:
    flat = {
        "GRAVITY": 'gravity = [0, "-9.81 m/s^2"]', "DRIVEN": 'body = "idler"',
        "SLIDER": '[mechanism.slider.s]\nbodies = ["ground", "rack"]\n'
        "joints = [[-1, -0.03], [0, -0.03]]",
        "SLIDE": 'slider = "s"',
    }  # fmt: skip
    deep = {
        "GRAVITY": 'dimension = 3\ngravity = [0, "-9.81 m/s^2", 0]', "DRIVEN": 'joint = "I"',
        "SLIDER": '[mechanism.joint.S]\nat = [0, -0.03]\nkind = "prismatic"\n'
        'fixed_in = "ground"\nconnections = { s = "rack" }',
        "SLIDE": 'slide = "S"',
    }  # fmt: skip
    texts = []
    for words in (flat, deep):
        text = STEERING
        for old, new in words.items():
            text = text.replace(old, new)
        texts.append(text)
    pair = re.compile(r"\[(-?[\d.]+), (-?[\d.]+)\]")
    body = pair.sub(r"[\1, \2, 0]", texts[1]).replace("[60, 21, 0]", "[60, 21]")
    for old, new in (
        ("at = [0, 0, 0]", "at = [0, 0, 0]\naxis = [0, 0, 1]"),
        ("at = [-0.1, 0.06, 0]", "at = [-0.1, 0.06, 0]\naxis = [0, 0, 1]"),
        ("at = [0, -0.03, 0]\nkind", "at = [0, -0.03, 0]\naxis = [2, 0, 0]\nkind"),
    ):
        assert body.count(old) == 1, old
        body = body.replace(old, new)
    body = re.sub(r"inertia = (0.0\d)", r"inertia = [\1, \1, \1]", body)
    plane, space = solved(tmp_path, texts[0])["move"], solved(tmp_path, body)["move"]
    assert plane.peaks is not None
    assert space.peaks is not None
    size = plane.reactions.magnitudes.max()
    for name in ("P1", "I1", "teeth", "pair"):
        a, b = (x.reactions.connections.index(name) for x in (plane, space))
        ours, theirs = space.reactions.forces[:, b], plane.reactions.forces[:, a]
        assert ours == pytest.approx(theirs, abs=1e-9 * size)
        assert space.peaks.force[name].value == pytest.approx(plane.peaks.force[name].value)
    assert plane.dynamics is not None
    assert space.space is not None
    drive = plane.dynamics.drive
    assert space.space.dynamics.drive == pytest.approx(drive, abs=1e-9 * np.abs(drive).max())


@each(
    ("old", "new", "words"),
    [
        ("at = [0.04, 0.06, 0]\n", "", "size of its pitch cones is not known"),
        ('joints = ["C", "P"]\nteeth = [18, 12]\nhelix', 'joints = ["C", "C"]\nteeth = [18, 12]\n'
         "helix", "joint C is not on planet"),
        ("axis = [0, 1, 0]", "axis = [0, 1, 0.001]", "neither parallel nor do they meet"),
        ("teeth = [18, 12]\nhelix", "teeth = [18, 12]\ninternal = true\nhelix", "remove internal"),
        ('"30 deg"', '"70 deg"', "between -60 and 60 deg"),
        ("at = [0, 0.08, 0]", 'kind = "cylindrical"\nat = [0, 0.08, 0]', "one that is revolute"),
        ('bodies = ["right", "planet"]', 'bodies = ["right", "plenet"]', "no body 'plenet'"),
        ("[mechanism.gear.gr]", "[mechanism.gear.P1]", "named twice"),
    ],
)  # fmt: skip
def test_what_cannot_mesh_is_said(tmp_path: Path, old: str, new: str, words: str) -> None:
    text = BEVEL_DIFFERENTIAL
    assert text.count(old) == 1, old
    assert words in message(tmp_path, text.replace(old, new))


def test_gears_are_drawn_about_their_axes(tmp_path: Path) -> None:
    """The pitch circles lie square to their axes and pass through the pitch point."""
    study = load_study(study_file(tmp_path, BEVEL_DIFFERENTIAL))
    found = all_loads(study, ["turn"])["turn"].space
    assert found is not None
    skeleton = skeleton_in_space(study, "turn", found)
    assert tuple(name for name, _, _ in skeleton.connections) == found.reactions.connections
    pitch = skeleton.position[0, skeleton.joints.index("gl")]
    circle = np.array([c.ends[0, 0] for c in skeleton.pitch if c.body == "left"])
    assert circle[:, 0] == pytest.approx(np.full(len(circle), pitch[0]))
    radii = np.linalg.norm(circle[:-1, 1:], axis=1)  # the last is a radius, from the hub
    assert radii == pytest.approx(np.full(len(radii), np.linalg.norm(pitch[1:])))
    assert circle[-1, 1:] == pytest.approx(np.zeros(2), abs=1e-12)


PLANETARY = (
    HEAD
    + """
[mechanism.joint.O]
at = [0, 0, 0]
axis = [0, 0, 1]
fixed_in = "ground"
connections = { O1 = "sun", O2 = "arm" }
[mechanism.joint.P]
at = [0.06, 0, 0.02]
axis = [0, 0, -1]
fixed_in = "arm"
connections = { P1 = "planet" }
[mechanism.body.sun]
mass = 1
[mechanism.body.arm]
mass = 1
centre = [0.03, 0, 0]
[mechanism.body.planet]
mass = 0.3
[mechanism.gear.a]
bodies = ["sun", "planet"]
joints = ["O", "P"]
teeth = [20, 40]
helix_angle = "15 deg"
[mechanism.gear.b]
RING
teeth = TEETH
internal = true
helix_angle = "HAND"
[mechanism.drive]
joint = "O"
connection = "O1"
[case.rest]
kind = "static"
[[case.rest.apply]]
body = "arm"
couple = [0, 0, -30]
"""
)


@each(
    ("ring", "teeth", "hand"),
    [
        ('bodies = ["ground", "planet"]\njoints = ["O", "P"]', "[100, 40]", "-15 deg"),
        ('bodies = ["planet", "ground"]\njoints = ["P", "O"]', "[40, 100]", "-15 deg"),
    ],
)
def test_a_planet_is_not_pushed_along_its_axis(
    tmp_path: Path, ring: str, teeth: str, hand: str
) -> None:
    """A planet of the other hand than its sun, in a ring of its own hand: the axial forces of both
    meshes cancel. The fixed ring makes the sun turn six times as fast as the arm (Willis).
    """
    text = PLANETARY.replace("RING", ring).replace("TEETH", teeth).replace("HAND", hand)
    found = rest(tmp_path, text)
    tangential = 30.0 / 0.06
    assert force(found, "P1") == pytest.approx(force(found, "P1") * [1, 1, 0], abs=1e-9)
    assert np.abs(force(found, "a")[2]) == pytest.approx(
        0.5 * tangential * math.tan(math.radians(15.0)), rel=1e-9
    )
    assert abs(force(found, "P1")[1]) == pytest.approx(tangential, rel=1e-9)
    assert found.dynamics.drive[0, 0] == pytest.approx(30.0 / 6.0, rel=1e-9)

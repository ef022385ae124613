"""What is drawn of a linkage in space, from its dynamics."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from loads import (
    Body,
    Connection,
    ConstantDrive,
    CosineDrive,
    Joint,
    Linkage,
    Turn,
    motion_reactions,
    move,
)
from loads.forces.acting import ForceLaw
from loads.space.acting import SpaceForce, SpaceSpring
from loads.space.dynamics import space_reactions
from loads.space.linkage import JointAngle, PointDistance, RigidBody, SpaceJoint, SpaceLinkage
from loads.space.motion import space_move
from pinstress.analysis.mechanics.space_skeleton import space_skeleton
from reports.format.drawing.projection import three_views
from reports.page.linkage_drawing import draw_linkage
from reports.page.linkage_panel import Instant, Mark
from tests.support.results.space_results import rssr

TIMES = np.linspace(0.0, 2.0, 73)
UPRIGHT = np.array([0.0, 0.0, 1.0])
BALL = ((1e-3, 0.0, 0.0), (0.0, 1e-3, 0.0), (0.0, 0.0, 1e-3))


def crank_and_rocker() -> SpaceLinkage:
    """The linkage of `rssr` in metres, its rod without an idle spin."""
    at = dict(zip("APQB", (rssr().space[0].position[0] * 1e-3).tolist(), strict=True))
    a, p, q, b = (tuple(at[name]) for name in "APQB")
    rod = np.subtract(q, p)
    across = np.cross(rod, [0.0, 0.0, 1.0])
    middle = [tuple(0.5 * np.add(x, y)) for x, y in ((a, p), (p, q), (q, b))]
    bodies = [
        RigidBody(name, 1.0, centre, BALL)
        for name, centre in zip(("crank", "rod", "rocker"), middle, strict=True)
    ]
    joints = (
        SpaceJoint("A1", "revolute", "ground", "crank", a, (0.0, 0.0, 1.0)),
        SpaceJoint(
            "P1", "universal", "crank", "rod", p, (0.0, 0.0, 1.0),
            tuple(across / np.linalg.norm(across)),
        ),
        SpaceJoint("Q1", "spherical", "rod", "rocker", q),
        SpaceJoint("B1", "revolute", "ground", "rocker", b, (2.0, 0.0, 0.0)),
    )  # fmt: skip
    gravity = (0.0, 0.0, -9.81)
    return SpaceLinkage(tuple(bodies), joints, (JointAngle("crank", "A1"),), ("crank",), gravity)


def test_an_rssr_stands_where_its_closed_form_says() -> None:
    """Joints, and the axes of the two pins; spherical joints have none."""
    exact = rssr().space[0]
    motion = space_move(crank_and_rocker(), [ConstantDrive(0.0, 2.0 * np.pi, 2.0)], TIMES)
    load = SpaceForce("rod", motion.linkage.joint("Q1").at, (0.0, 3.0, 4.0), (2.0, 0.0, 0.0))
    dynamics = space_reactions("turn", motion, [load])
    pins = {f"{name}1": name for name in "APQB"}
    axes = {"A": UPRIGHT, "B": np.array([2.0, 0.0, 0.0])}
    skeleton = space_skeleton("turn", dynamics, pins, axes)
    assert skeleton.joints == exact.joints
    assert skeleton.links == exact.links
    assert skeleton.ground == exact.ground
    assert 1e3 * skeleton.position == pytest.approx(exact.position, abs=1e-6)
    assert skeleton.axes[:, [0, 3]] == pytest.approx(exact.axes[:, [0, 3]], abs=1e-12)
    assert not skeleton.axes[:, 2].any()
    assert skeleton.stems == ()
    assert skeleton.connections[1] == ("P1", "rod", "P")
    (applied,) = skeleton.applied
    assert 1e3 * applied.position == pytest.approx(exact.position[:, 2], abs=1e-6)
    assert applied.sizes == pytest.approx(5.0)
    (couple,) = skeleton.couples
    assert couple.couple == pytest.approx(np.tile([2.0, 0.0, 0.0], (73, 1)))
    assert skeleton.up == (0.0, 0.0, 1.0)


def test_a_lifted_linkage_has_the_picture_of_its_plane_in_front() -> None:
    """The front view of a four-bar in space, by the spatial equations, is the planar drawing."""
    at = {"A": (0.0, 0.0), "B": (0.3, 0.4), "C": (1.2, 0.7), "D": (1.0, 0.0)}
    ends = {"crank": ("A", "B"), "coupler": ("B", "C"), "rocker": ("C", "D")}
    on = {"A": ("crank", "ground"), "B": ("coupler", "crank"), "C": ("rocker", "coupler"),
          "D": ("rocker", "ground")}  # fmt: skip
    middle = {b: tuple(0.5 * np.add(at[p], at[q])) for b, (p, q) in ends.items()}
    flat = Linkage(
        tuple(Body(b, 1.0, middle[b], 0.02) for b in ends),
        tuple(Joint(n, at[n], (Connection(n, b),), base) for n, (b, base) in on.items()),
        ("crank",), turns=(Turn("crank", "crank", 0.0),), gravity=(0.0, -9.81),
    )  # fmt: skip
    solid = SpaceLinkage(
        tuple(RigidBody(b, 1.0, (*middle[b], 0.0), BALL) for b in ends),
        tuple(
            SpaceJoint(n, "revolute", base, b, (*at[n], 0.0), (0.0, 0.0, 1.0))
            for n, (b, base) in on.items()
        ),
        (JointAngle("crank", "A"),), ("crank",), (0.0, -9.81, 0.0),
    )  # fmt: skip
    law, times = [CosineDrive(0.0, 1.0, 1.0)], np.linspace(0.0, 1.0, 5)
    planar = motion_reactions("turn", move(flat, law, times)).motion
    dynamics = space_reactions("turn", space_move(solid, law, times))
    skeleton = space_skeleton("turn", dynamics, {n: n for n in at}, dict.fromkeys(at, UPRIGHT))
    assert skeleton.up == (0.0, 1.0, 0.0)
    front = three_views(skeleton.up)[0]
    for k, name in enumerate(skeleton.joints):
        known = planar.joint(name)[0]
        plane = np.stack([known.real, known.imag], axis=1) if np.iscomplexobj(known) else known
        assert front(skeleton.position[:, k]) == pytest.approx(plane, abs=1e-12)
    drawing = draw_linkage(Instant(skeleton, 3), [Mark(n, n) for n in at], "four-bar", "N")
    panels = [e for e in ET.fromstring(drawing).iter() if e.get("class") == "view"]
    axes = [len([e for e in p.iter() if e.get("class") == "axis"]) for p in panels]
    assert axes == [0, 4, 4]  # its pins are rings from the front
    assert len(re.findall('class="ground"', drawing)) == 4 * 2


def test_a_wheel_hangs_on_its_axle_and_pins_are_no_bodies() -> None:
    """A wheel is drawn up to its centre; a pin between two links and what is welded are not."""
    bodies = (
        RigidBody("wing", 1.0, (0.0, 0.0, 0.0), BALL),
        RigidBody("leg", 5.0, (0.0, 0.0, -0.5), BALL),
        RigidBody("wheel", 2.0, (0.1, 0.0, -1.0), BALL),
        RigidBody("pin W", 0.1, (0.0, 0.0, -1.0), BALL),
    )
    x = (1.0, 0.0, 0.0)
    joints = (
        SpaceJoint("T1", "revolute", "wing", "leg", (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
        SpaceJoint("weld", "fixed", "ground", "wing", (0.0, 0.0, 0.0)),
        SpaceJoint("W1", "fixed", "pin W", "leg", (0.0, 0.0, -1.0)),
        SpaceJoint("W2", "revolute", "pin W", "wheel", (0.0, 0.0, -1.0), x),
    )
    ends = (0.5, 0.0, 0.0), (0.0, 0.0, -0.4)
    jack, spin = PointDistance("jack", ("ground", "leg"), ends), JointAngle("spin", "W2")
    rope = PointDistance("spring rope", ("ground", "leg"), ((0.0, 0.3, 0.0), ends[1]))
    linkage = SpaceLinkage(bodies, joints, (jack, spin, rope), ("jack", "spin"))
    start = float(np.hypot(0.5, 0.4))
    laws = [CosineDrive(start, start + 0.05, 1.0), CosineDrive(0.0, 1.0, 1.0)]
    motion = space_move(linkage, laws, np.linspace(0.0, 1.0, 4))
    pull = SpaceSpring("rope", "spring rope", ForceLaw(stiffness=1e3))
    dynamics = space_reactions("fold", motion, (pull,))
    pins = {"T1": "T", "W1": "W", "W2": "W"}
    axes = {"T": np.array([0.0, 1.0, 0.0]), "W": np.array(x)}
    skeleton = space_skeleton("fold", dynamics, pins, axes)
    assert skeleton.bodies == ("leg", "wheel")
    assert skeleton.links == (("T", "W"), ("W",))
    assert skeleton.stems == ("wheel",)
    assert skeleton.joints == ("T", "W")
    assert skeleton.ground == ("T",)  # on the wing, which is fixed to the ground
    along = np.diff(skeleton.slides["jack"], axis=1)[:, 0]
    assert np.linalg.norm(along, axis=1) == pytest.approx(dynamics.motion.drives[:, 0])
    assert set(skeleton.slides) == {"jack"}
    long = np.linalg.norm(np.diff(skeleton.springs["rope"], axis=1)[:, 0], axis=1)
    assert long == pytest.approx(motion.coordinate("spring rope")[0])
    # The axle turns with the leg, about y.
    assert np.linalg.norm(skeleton.axes[:, 1], axis=1) == pytest.approx(1.0)
    assert skeleton.axes[0, 1] == pytest.approx([1.0, 0.0, 0.0])
    leg = skeleton.position[:, 1] - skeleton.position[:, 0]
    assert np.einsum("ti,ti->t", skeleton.axes[:, 1], leg) == pytest.approx(0.0, abs=1e-12)

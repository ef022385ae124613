"""Loads out of the plane of planar linkages: closed forms, and a frame solved by stiffness.

The frame is a beam for every arm of every link, assembled from the textbook's stiffness matrix
(Przemieniecki, Theory of Matrix Structural Analysis, 1968, ch. 5); pins join the ends of beams in
all displacements but the turning about z. Nothing of it knows trees, loops or energies.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from loads import GROUND, Applied, Body, Connection, Joint, Linkage, Turn, at_rest, motion_reactions
from loads.space.out_of_plane import Links, Offsets, OutOfPlane, SideLoad, over_stiffness
from loads.space.stiffness import LinkStiffness, flat_link, round_link
from loads.space.straight import straight
from tests.support.each import each

Floats = NDArray[np.float64]


def _boom() -> Linkage:
    """A boom from the ground at the origin to (2, 0), and a second on its end to (2, 3)."""
    return Linkage(
        bodies=(Body("boom", 10.0, (1.0, 0.0), 1.0), Body("jib", 5.0, (2.0, 1.5), 1.0)),
        joints=(
            Joint("A", (0.0, 0.0), (Connection("A1", "boom"),), GROUND),
            Joint("B", (2.0, 0.0), (Connection("B1", "jib"),), "boom"),
        ),
        driven=("turn", "bend"),
        turns=(Turn("turn", "boom", 0.0), Turn("bend", "jib", 0.0, "boom")),
        gravity=(0.0, -10.0),
    )


def test_an_open_chain_is_its_closed_form() -> None:
    """A side force F at the tip (2, 3): r x F about each pin, whatever is stiff."""
    F = 100.0
    linkage = _boom()
    tip = SideLoad(Applied("jib", (2.0, 3.0)), force=F)
    solved = motion_reactions("side", at_rest(linkage, (0.0, 0.0)), timed=False)
    r = OutOfPlane(solved, [tip], Offsets()).reactions(Links())
    # On the pins: +F; moments (y F, -x F) of the arm from the pin to the tip.
    assert r.force("A1")[0, 2] == pytest.approx(F, rel=1e-12)
    assert r.moments[0, 0] == pytest.approx([3.0 * F, -2.0 * F, 0.0], rel=1e-12)
    assert r.force("B1")[0, 2] == pytest.approx(F, rel=1e-12)
    assert r.moments[0, 1] == pytest.approx([3.0 * F, 0.0, 0.0], rel=1e-12, abs=1e-9)
    assert np.array_equal(r.forces[..., :2], solved.reactions.forces[..., :2])


def test_links_beside_each_other_load_their_pins_by_their_weight() -> None:
    """The jib 0.2 m in front of the boom: its weight W at z = 0.2 bends A and not B."""
    linkage = _boom()
    solved = motion_reactions("offset", at_rest(linkage, (0.0, 0.0)), timed=False)
    r = OutOfPlane(solved, [], Offsets({"B1": 0.2, "A1": 0.0}, {"boom": 0.0})).reactions(Links())
    # W = 50 N along -y at z = 0.2: moment about x is -z fy = +10 N m.
    assert r.moments[0, 0] == pytest.approx([10.0, 0.0, 0.0], rel=1e-12, abs=1e-12)
    assert r.moments[0, 1] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_links_lie_as_far_apart_as_the_pin_between_them_says() -> None:
    """A pin that the boom carries: its link lies beside the boom by band less clamp, or else in the
    boom's plane, however far along the pins the bands are.
    """
    bands = {"A1": 0.7, "B1": 0.3}
    for roots, apart in (({"B": 0.1}, 0.2), ({}, 0.0)):
        at, askew = straight(_boom(), bands, {"A": 0.0}, roots)
        assert at["A1"] == pytest.approx(0.7)
        assert at["B1"] - at["A1"] == pytest.approx(apart)
        assert max(askew.values()) == pytest.approx(0.0, abs=1e-12)


def _four_bar() -> Linkage:
    return Linkage(
        bodies=(
            Body("crank", 3.0, (0.1, 0.45), 0.1),
            Body("coupler", 5.0, (1.0, 1.2), 0.4),
            Body("rocker", 4.0, (1.9, 0.7), 0.2),
        ),
        joints=(
            Joint("A", (0.0, 0.0), (Connection("A1", "crank"),), GROUND),
            Joint("B", (0.2, 1.0), (Connection("B1", "crank"), Connection("B2", "coupler")), None),
            Joint("C", (1.8, 1.5), (Connection("C1", "coupler"),), "rocker"),
            Joint("D", (2.0, 0.0), (Connection("D1", "rocker"),), GROUND),
        ),
        driven=("turn",),
        turns=(Turn("turn", "crank", 0.0),),
        gravity=(0.0, -9.81),
    )


STATED = {
    "crank": round_link(0.05, 2.1e11),
    "coupler": flat_link(0.08, 0.03, 2.1e11),
    "rocker": flat_link(0.02, 0.06, 7.0e10),
}


@dataclass
class _Frame:
    """A frame of beams: numbers of unknowns by node and direction, stiffness, and loads."""

    count: int = 0

    def node(self, like: list[int] | None = None, apart: tuple[int, ...] = ()) -> list[int]:
        """Six new unknowns; those of another node but in the directions `apart`."""
        out = []
        for k in range(6):
            if like is not None and k not in apart:
                out.append(like[k])
            else:
                out.append(self.count)
                self.count += 1
        return out


def _beam(arm: Floats, s: LinkStiffness) -> Floats:
    """Stiffness (12, 12) of a beam between its two ends, world axes; `bending` is in the plane."""
    L = float(np.linalg.norm(arm))
    x = arm / L
    side = np.cross([0.0, 0.0, 1.0], x)
    y = side / np.linalg.norm(side)
    axes = np.stack([x, y, np.cross(x, y)])
    k = np.zeros((12, 12))
    for a, b, at_end in ((0, 0, 1), (6, 6, 1), (0, 6, -1), (6, 0, -1)):
        k[a, b] = at_end * s.axial / L
        k[a + 3, b + 3] = at_end * s.torsion / L
    for EI, v, turn, sign in ((s.bending, 1, 5, 1.0), (s.across, 2, 4, -1.0)):
        d = [v, turn, v + 6, turn + 6]
        e = EI / L**3
        m = np.array(
            [[12, 6 * L, -12, 6 * L], [6 * L, 4 * L * L, -6 * L, 2 * L * L],
             [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L * L, -6 * L, 4 * L * L]]
        )  # fmt: skip
        flip = np.array([1.0, sign, 1.0, sign])
        k[np.ix_(d, d)] += e * m * np.outer(flip, flip)
    turned = np.kron(np.eye(4), axes)
    return np.asarray(turned.T @ k @ turned)


def _by_frame(
    linkage: Linkage,
    links: dict[str, LinkStiffness],
    at: dict[str, Floats],
    centres: dict[str, Floats],
    loads: dict[str, Floats],
) -> dict[str, Floats]:
    """The wrench (6,) on the body at every connection, about its point.

    at: points of connections. centres: of bodies. loads: (6,) on bodies at their centres.
    """  # fmt: skip
    frame = _Frame()
    node = {body: frame.node() for body in links}
    fixed = frame.node()
    beams: list[tuple[str, str, list[int], Floats]] = []
    for joint in linkage.joints:
        pin = fixed if joint.fixed_in == GROUND else frame.node()
        if joint.fixed_in not in (None, GROUND):
            beams.append(("", str(joint.fixed_in), pin, at[joint.connections[0].name]))
        for n, c in enumerate(joint.connections):
            # The first body of a floating pin turns with it; all others turn on it.
            end = pin if joint.fixed_in is None and n == 0 else frame.node(pin, (5,))
            beams.append((c.name, c.body, end, at[c.name]))
    K = np.zeros((frame.count, frame.count))
    for _, body, end, p in beams:
        d = [*node[body], *end]
        K[np.ix_(d, d)] += _beam(p - centres[body], links[body])
    driven = node["crank"]  # held at its centre, where couples on a body act
    P = np.zeros(frame.count)
    for body, load in loads.items():
        P[node[body]] += load
    free = [k for k in range(frame.count) if k not in {*fixed, driven[5]}]
    u = np.zeros(frame.count)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], P[free])
    out = {}
    for name, body, end, p in beams:
        d = [*node[body], *end]
        out[name] = (_beam(p - centres[body], links[body]) @ u[d])[6:]
    return out


@each("depth", [0.0, 1.0])
def test_a_redundant_loop_shares_like_a_frame(depth: float) -> None:
    """A four-bar under side force, couples and its weight, its links in four planes or in one.

    The loop leaves three wrenches to elasticity. 1e-8 is the round-off of the frame's stiffness
    matrix, whose condition is 1e8.
    """
    linkage = _four_bar()
    z = {"A1": 0.10, "B1": 0.12, "B2": -0.05, "C1": -0.02, "D1": 0.07}
    z = {k: depth * v for k, v in z.items()}
    zb = {"crank": 0.11 * depth, "coupler": -0.03 * depth, "rocker": 0.0, "pin B": 0.0}
    side = [
        SideLoad(Applied("coupler", (1.0, 1.2)), force=700.0, couple=(30.0, -50.0)),
        SideLoad(Applied("rocker", (1.9, 0.7)), force=-200.0),
    ]
    solved = motion_reactions("side", at_rest(linkage, (0.0,)), timed=False)
    got = OutOfPlane(solved, side, Offsets(z, zb)).reactions(Links(STATED))

    at = {c.name: np.array([*j.at, z[c.name]]) for j, c in linkage.connections}
    centres = {b.name: np.array([*b.centre, zb[b.name]]) for b in linkage.bodies}
    loads = {b.name: np.array([0.0, -9.81 * b.mass, 0, 0, 0, 0]) for b in linkage.bodies}
    loads["coupler"][2:5] += [700.0, 30.0, -50.0]
    loads["rocker"][2] -= 200.0
    # The frame's pin B has one place: that of B1, to which a rigid arm would join B2.
    if depth:
        z["B2"], at["B2"] = z["B1"], at["B1"]
        got = OutOfPlane(solved, side, Offsets(z, zb)).reactions(Links(STATED))
    expected = _by_frame(linkage, STATED, at, centres, loads)
    largest = max(np.abs(w[:3]).max() for w in expected.values())
    turning = max(np.abs(w[3:]).max() for w in expected.values())
    for k, name in enumerate(got.connections):
        assert got.forces[0, k] == pytest.approx(-expected[name][:3], abs=1e-8 * largest), name
        moment = -expected[name][3:5]
        assert got.moments[0, k, :2] == pytest.approx(moment, abs=1e-8 * turning), name


def test_without_loads_out_of_the_plane_there_are_no_forces_out_of_it() -> None:
    linkage = _four_bar()
    solved = motion_reactions("plane", at_rest(linkage, (0.3,)), timed=False)
    r = OutOfPlane(solved, [], Offsets()).reactions(Links())
    assert np.array_equal(r.forces, solved.reactions.forces)
    assert not r.moments.any()


def test_what_statics_determines_does_not_depend_on_stiffness() -> None:
    """All wrenches at any stiffness balance the loads on the whole linkage, but divide apart."""
    linkage = _four_bar()
    side = [SideLoad(Applied("coupler", (1.0, 1.2)), force=700.0)]
    solved = motion_reactions("side", at_rest(linkage, (0.0,)), timed=False)
    balance = OutOfPlane(solved, side, Offsets())
    others = over_stiffness(balance, Links(), 10.0)
    assert len([x for x in others if "than the rest" not in x]) == 2 * (3 + 1)
    at_a = []
    for r in others.values():
        on_ground = r.force("A1") + r.force("D1")
        assert on_ground[0, 2] == pytest.approx(700.0, rel=1e-9)
        at_a.append(r.force("A1")[0, 2])
    assert max(at_a) - min(at_a) > 70.0


def test_two_equal_arms_share_by_symmetry_and_by_the_ratio_of_their_stiffness() -> None:
    """A beam on two parallel arms, pushed in its middle: half each; with one arm r times as stiff
    as the other, and the beam rigid, the closed form of two cantilevers in parallel.

    Pushed where it does not turn about y, the beam gives both arms the same displacement and slope,
    so their forces are in the ratio of their stiffness.
    """
    L = 1.0
    linkage = Linkage(
        bodies=(
            Body("left", 0.0, (-0.5, 0.5), 0.0),
            Body("right", 0.0, (0.5, 0.5), 0.0),
            Body("beam", 0.0, (0.0, 1.0), 0.0),
        ),
        joints=(
            Joint("A", (-0.5, 0.0), (Connection("A1", "left"),), GROUND),
            Joint("B", (0.5, 0.0), (Connection("B1", "right"),), GROUND),
            Joint("C", (-0.5, L), (Connection("C1", "left"),), "beam"),
            Joint("D", (0.5, L), (Connection("D1", "right"),), "beam"),
        ),
        driven=("turn",),
        turns=(Turn("turn", "left", 0.0),),
    )
    solved = motion_reactions("side", at_rest(linkage, (0.0,)), timed=False)
    arm, rigid = round_link(0.05), round_link(0.05).times(1e9)
    for ratio in (1.0, 4.0):
        x = 0.5 * (ratio - 1.0) / (ratio + 1.0)
        push = SideLoad(Applied("beam", (x, L)), force=100.0)
        links = Links({"left": arm, "right": arm.times(ratio), "beam": rigid})
        r = OutOfPlane(solved, [push], Offsets()).reactions(links)
        assert r.force("A1")[0, 2] == pytest.approx(100.0 / (1.0 + ratio), rel=1e-6)
        assert r.force("B1")[0, 2] == pytest.approx(100.0 * ratio / (1.0 + ratio), rel=1e-6)


def test_a_follower_couple_turns_with_its_body() -> None:
    linkage = replace(_boom(), gravity=(0.0, 0.0))
    load = SideLoad(Applied("jib", (2.0, 1.5), follows=True), couple=(5.0, 0.0))
    solved = motion_reactions("couple", at_rest(linkage, (np.pi / 2, 0.0)), timed=False)
    r = OutOfPlane(solved, [load], Offsets()).reactions(Links())
    assert r.moments[0, 1] == pytest.approx([0.0, 5.0, 0.0], abs=1e-12)

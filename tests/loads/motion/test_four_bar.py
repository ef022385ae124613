"""Four-bars: closed forms, branches, classes, dead and change points, and the laws of mechanics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    ConstantDrive,
    CycloidalDrive,
    Joint,
    Linkage,
    MotionBlocked,
    StateDrive,
    Turn,
    ledger,
    mobility,
    motion_reactions,
    move,
)
from loads.motion.four_bar import four_bar as recognised
from loads.motion.transmission_angles import transmission_angles
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import circles, coupled_wheels, four_bar

LINK = st.floats(0.2, 1.5)


@settings(max_examples=40, deadline=None)
@given(LINK, LINK, LINK, LINK, st.floats(-3.0, 3.0), st.sampled_from([1.0, -1.0]))
def test_random_four_bars_obey_the_laws(
    ground: float, crank: float, coupler: float, rocker: float, angle: float, side: float
) -> None:
    """Loop closure, Newton's third law at the pins, the energy ledger."""
    reach = abs(ground - crank * np.exp(1j * angle))
    assume(abs(coupler - rocker) + 0.05 < reach < coupler + rocker - 0.05)
    linkage = four_bar(ground, crank, coupler, rocker, angle, side)
    law = CycloidalDrive(angle, angle + 0.05, 0.3)
    try:
        motion = move(linkage, [law], np.linspace(0.0, 0.3, 13))
    except MotionBlocked:
        assume(False)
    a, b = (motion.joint(j)[0] @ [1.0, 1.0j] for j in "AB")
    assert np.abs(np.abs(b - a) - coupler).max() < 1e-12
    assert np.abs(np.abs(b - ground) - rocker).max() < 1e-12
    assert a == pytest.approx(crank * np.exp(1j * law(motion.times)[0]), abs=1e-12)
    found = motion_reactions("turn", motion)
    for joint, mass in (("A", 0.1), ("B", 0.2)):
        _, _, acceleration = motion.joint(joint)
        on_pin = sum(found.reactions.force(f"{joint}{k}") for k in ("23" if joint == "A" else "34"))
        wanted = mass * (acceleration - np.array([0.0, -9.81]))
        size = float(np.abs(found.reactions.forces).max())
        assert np.asarray(on_pin)[:, :2] == pytest.approx(wanted, abs=1e-12 * size)
    assert ledger(found).violation < 1e-9


def test_the_whole_turn_of_a_crank_stays_on_its_branch() -> None:
    for side in (1.0, -1.0):
        linkage = four_bar(side=side)
        motion = move(linkage, [ConstantDrive(0.9, 0.9 + 4 * np.pi, 2.0)], np.linspace(0, 2, 7))
        a = 0.4 * np.exp(1j * motion.drives[:, 0])
        wanted = [circles(p, 0.9, 1.0, 0.8, side) for p in a]
        assert motion.joint("B")[0] @ [1.0, 1.0j] == pytest.approx(np.array(wanted), abs=1e-12)
        assert motion.angle("crank")[-1] == pytest.approx(4 * np.pi)


def test_rates_are_derivatives() -> None:
    linkage, h = four_bar(), 1e-4
    law = CycloidalDrive(0.9, 2.0, 1.0)
    at = np.linspace(0.1, 0.9, 7)
    q = {d: move(linkage, [law], at + d * h).q for d in (-1, 0, 1)}
    motion = move(linkage, [law], at)
    assert (q[1] - q[-1]) / (2 * h) == pytest.approx(motion.v, abs=1e-6)
    assert (q[1] - 2 * q[0] + q[-1]) / h**2 == pytest.approx(motion.a, abs=1e-5)


def test_forces_are_those_of_the_textbook_system() -> None:
    """The nine equations of three bodies, written out by hand with massless pins."""
    linkage = four_bar()
    joints = tuple(replace(j, mass=0.0) for j in linkage.joints)
    linkage = replace(linkage, joints=joints)
    found = motion_reactions("now", move(linkage, [StateDrive(1.1, 3.0, -7.0)], np.zeros(1)))
    motion = found.motion
    centre, _, acceleration = motion.centres
    at = {j: complex(*motion.joint(j)[0][0]) for j in ("O2", "A", "B", "O4")}
    order = ("O2", "A", "B", "O4")
    M, rhs = np.zeros((9, 9)), np.zeros(9)
    for k, body in enumerate(linkage.bodies):
        g = complex(centre[0, k])
        for joint, sign in ((order[k], 1.0), (order[k + 1], -1.0)):
            arm, column = at[joint] - g, 2 * order.index(joint)
            M[3 * k, column] = M[3 * k + 1, column + 1] = sign
            M[3 * k + 2, column : column + 2] = -sign * arm.imag, sign * arm.real
        force = body.mass * (acceleration[0, k] + 9.81j)
        spin = motion.angular_acceleration(body.name)[0]
        rhs[3 * k : 3 * k + 3] = force.real, force.imag, (body.inertia or 0.0) * spin
    M[2, 8] = 1.0
    x = np.linalg.solve(M, rhs)
    assert -found.reactions.force("F12")[0, :2] == pytest.approx(x[:2])  # on the pin, so negative
    assert found.reactions.force("A2")[0, :2] == pytest.approx(x[2:4])
    assert found.reactions.force("B3")[0, :2] == pytest.approx(x[4:6])
    assert found.reactions.force("F14")[0, :2] == pytest.approx(x[6:8])  # row order: O4 is minus
    assert found.drive[0, 0] == pytest.approx(x[8])


def test_a_pin_may_be_fixed_in_the_link_and_turn_in_the_ground() -> None:
    linkage = four_bar()
    o2 = Joint("O2", (0.0, 0.0), (Connection("F12", GROUND),), "crank")
    other = replace(linkage, joints=(o2, *linkage.joints[1:]))
    law, times = CycloidalDrive(0.9, 2.0, 1.0), np.linspace(0.0, 1.0, 5)
    ours, same = (motion_reactions("x", move(k, [law], times)) for k in (linkage, other))
    assert same.reactions.force("F12") == pytest.approx(-ours.reactions.force("F12"))
    assert same.drive == pytest.approx(ours.drive)
    assert same.reactions.turn[:, 0] == pytest.approx(law(times)[0] - 0.9)


@each(
    ("lengths", "kind"),
    [
        ((1.0, 0.4, 0.9, 0.8), "crank-rocker (Grashof)"),
        ((0.3, 0.9, 0.8, 1.0), "double-crank (Grashof)"),
        ((0.9, 0.8, 0.3, 1.0), "double-rocker (Grashof)"),
        ((0.9, 0.8, 1.0, 0.3), "rocker-crank (Grashof)"),
        ((1.0, 0.8, 0.5, 0.6), "triple-rocker (not Grashof)"),
        ((1.0, 0.5, 1.0, 0.5), "change point"),
    ],
)
def test_grashof(lengths: tuple[float, float, float, float], kind: str) -> None:
    ring = recognised(four_bar(*lengths, angle=1.0))
    assert ring is not None
    assert ring.kind == kind
    assert ring.joints == ("O2", "A", "B", "O4")


@settings(max_examples=60, deadline=None)
@given(LINK, LINK, LINK, LINK, st.floats(-3.0, 3.0), st.sampled_from([1.0, -1.0]))
def test_open_or_crossed_as_drawn(
    ground: float, crank: float, coupler: float, rocker: float, angle: float, side: float
) -> None:
    """Round a crossed ring two corners turn left and two right; in a simple one at most one turns
    the other way. Mirrored it is as it was.
    """
    reach = abs(ground - crank * np.exp(1j * angle))
    assume(abs(coupler - rocker) + 0.05 < reach < coupler + rocker - 0.05)
    drawn = four_bar(ground, crank, coupler, rocker, angle, side)
    ring, mirrored = (recognised(x) for x in (drawn, mirror(drawn)))
    assert ring is not None
    assert mirrored is not None
    at = np.array([complex(*drawn.joint(name).at) for name in ring.joints])
    sides = np.roll(at, -1) - at
    turns = np.imag(np.conj(np.roll(sides, 1)) * sides)
    assume(np.abs(turns).min() > 1e-6)
    assert ring.crossed == mirrored.crossed == ((turns > 0.0).sum() == 2)


def mirror(linkage: Linkage) -> Linkage:
    """The mirror image of a linkage at the x axis."""
    return replace(
        linkage,
        joints=tuple(replace(j, at=(j.at[0], -j.at[1])) for j in linkage.joints),
        bodies=tuple(replace(b, centre=(b.centre[0], -b.centre[1])) for b in linkage.bodies),
        turns=tuple(replace(t, drawn=-t.drawn) for t in linkage.turns),
    )


def test_links_adjacent_to_the_shortest_cross() -> None:
    """Norton's definition on an antiparallelogram, whose ground and coupler cross, and its twin."""
    for side, crossed in ((1.0, False), (-1.0, True)):
        ring = recognised(four_bar(1.0, 0.4, 1.0, 0.4, angle=1.0, side=side))
        assert ring is not None
        assert ring.crossed == crossed


def test_mobility_by_count_and_by_rank() -> None:
    found = mobility(four_bar())
    assert (found.kutzbach, found.degrees, found.redundant) == (1, 1, 0)


def test_the_transmission_angle_is_that_of_the_textbooks() -> None:
    linkage = four_bar()
    motion = move(linkage, [ConstantDrive(0.9, 7.0, 1.0)], np.linspace(0.0, 1.0, 50))
    angles = transmission_angles(motion)
    assert list(angles) == [("coupler", "B")]
    a, b = (motion.joint(j)[0] @ [1.0, 1.0j] for j in "AB")
    between = np.abs(np.angle((b - a) / (b - 1.0)))
    assert angles["coupler", "B"] == pytest.approx(np.minimum(between, np.pi - between))


def test_a_four_bar_on_a_moving_arm_keeps_its_transmission_angle() -> None:
    """Drives are taken one at a time: for that of the crank the arm stands still like a ground; for
    that of the arm nothing moves against anything.
    """
    linkage = four_bar()
    fixed = tuple(replace(j, fixed_in="arm") if j.fixed_in == GROUND else j for j in linkage.joints)
    carried = replace(
        linkage,
        bodies=(*linkage.bodies, Body("arm", 5.0, (-1.0, 0.0), 1.0)),
        joints=(*fixed, Joint("R", (-2.0, 0.0), (Connection("R", "arm"),), GROUND)),
        turns=(Turn("crank", "crank", 0.9, "arm"), Turn("arm", "arm", 0.0)),
        driven=("crank", "arm"),
    )
    times = np.linspace(0.0, 1.0, 9)
    laws = [ConstantDrive(0.9, 3.0, 1.0), ConstantDrive(0.0, 0.8, 1.0)]
    alone = transmission_angles(move(linkage, laws[:1], times))
    both = transmission_angles(move(carried, laws, times))
    assert list(both) == [("coupler", "B")]
    assert both["coupler", "B"] == pytest.approx(alone["coupler", "B"])


def toggle() -> float:
    """Crank angle at which coupler and rocker of a long-cranked four-bar are in line."""
    crank, ground, reach = 0.9, 1.0, 0.5 + 0.6
    return float(np.arccos((crank**2 + ground**2 - reach**2) / (2 * crank * ground)))


@each(
    ("driven", "poor"),
    [
        (Turn("crank", "crank", 0.0), True),
        (Turn("hinge", "coupler", 0.0, "crank"), False),
        (Turn("link", "coupler", 0.0), False),
        (Turn("across", "rocker", 0.0, "crank"), False),
    ],
)
def test_a_small_transmission_angle_is_told_where_forces_grow(driven: Turn, poor: bool) -> None:
    """Near the crank's dead point, coupler and rocker in line to 1 deg: it takes 20 times the
    largest load or more to hold them by the crank's drive. Others hold a load on the coupler and
    one on the rocker with forces of their size, and had the same angle.
    """
    linkage = four_bar(1.0, 0.9, 0.5, 0.6, angle=toggle() - 1e-6, gravity=(0.0, 0.0))
    linkage = replace(linkage, turns=(driven,), driven=(driven.name,))
    motion = move(linkage, [StateDrive(0.0)], np.zeros(1))
    loads = [Applied("coupler", (0.5, 0.9), (0.0, -1.0)), Applied("rocker", (0.9, 0.3), (1.0, 0.0))]
    largest = motion_reactions("", motion, loads, timed=False).reactions.magnitudes.max()
    angles = [*transmission_angles(motion).values()]
    assert bool(largest > 20.0) == bool(angles) == poor
    assert all(np.degrees(angle) < 1.0 for angle in angles)


def test_a_dead_point_is_told_with_what_has_no_bound() -> None:
    linkage = four_bar(1.0, 0.9, 0.5, 0.6, angle=0.5)
    with raises(MotionBlocked, "dead-point") as caught:
        move(linkage, [CycloidalDrive(0.5, 2.0, 1.0)], np.linspace(0.0, 1.0, 11))
    assert caught.value.kind == "dead point"
    assert caught.value.reached[0] == pytest.approx(toggle(), abs=1e-6)
    assert caught.value.connections == ("F12", "A2", "A3", "B3", "B4", "F14")
    assert caught.value.bodies == ("crank", "coupler", "rocker")[1:]


@each("short", [1e-2, 1e-4, 1e-6, 1e-8])
def test_near_a_dead_point_the_path_still_converges(short: float) -> None:
    linkage = four_bar(1.0, 0.9, 0.5, 0.6, angle=0.5)
    motion = move(linkage, [ConstantDrive(0.5, toggle() - short, 1.0)], np.array([0.0, 1.0]))
    a, b = (motion.joint(j)[0] @ [1.0, 1.0j] for j in "AB")
    assert np.abs(b - a) == pytest.approx(0.5, abs=1e-13)
    assert np.abs(b - 1.0) == pytest.approx(0.6, abs=1e-13)
    assert motion.condition[-1] > 0.3 / np.sqrt(short)


def test_a_parallelogram_stops_at_its_change_point() -> None:
    linkage = four_bar(1.0, 0.5, 1.0, 0.5, angle=1.0)
    with raises(MotionBlocked, "change-point") as caught:
        move(linkage, [ConstantDrive(1.0, -1.0, 1.0)], np.linspace(0.0, 1.0, 8))
    assert caught.value.reached[0] == pytest.approx(0.0, abs=1e-6)


def test_a_second_crank_takes_a_parallelogram_through() -> None:
    """As the coupled wheels of a locomotive."""
    triangle = coupled_wheels(1.0, 1.0, 1.0)
    found = mobility(triangle)
    assert (found.kutzbach, found.degrees, found.redundant) == (0, 1, 1)
    motion = move(triangle, [ConstantDrive(1.0, -1.0, 1.0)], np.linspace(0.0, 1.0, 8))
    assert motion.angle("rocker") == pytest.approx(motion.drives[:, 0] - 1.0, abs=1e-12)
    assert np.abs(motion.angle("coupler")).max() < 1e-12
    assert ledger(motion_reactions("through", motion)).violation < 1e-9


def test_sharing_connections_are_springs() -> None:
    """Of force^2 / stiffness the sum is least: it does not change along the one way in which forces
    may differ without any load, which is the difference of what two rules give.
    """
    names, drive = ("F12", "F14", "F15"), ConstantDrive(1.0, 0.7, 1.0)

    def forces(*stiffness: float) -> np.ndarray:
        motion = move(coupled_wheels(*stiffness), [drive], np.linspace(0.0, 1.0, 5))
        found = motion_reactions("shared", motion).reactions
        return np.stack([found.force(name)[:, :2] for name in names])

    soft, hard = (1.0, 2.0, 4.0), (9.0, 3.0, 1.0)
    f, g = forces(*soft), forces(*hard)
    loose = f - g
    assert np.abs(loose).max(axis=(0, 2)).min() > 1e-3 * np.abs(f).max()
    for found, stiffness in ((f, soft), (g, hard)):
        parts = np.sum(found * loose, axis=2) / np.array(stiffness)[:, None]
        assert np.abs(parts.sum(axis=0) / np.abs(parts).sum(axis=0)).max() < 1e-9


def test_redundant_links_that_do_not_fit_are_told() -> None:
    linkage = four_bar(1.0, 0.5, 1.0, 0.5, angle=1.0)
    crooked = replace(
        linkage,
        bodies=(*linkage.bodies, Body("third", 1.0, (0.5, 0.3), 0.05)),
        joints=(
            *linkage.joints,
            Joint("O5", (0.5, 0.4), (Connection("F15", "third"),), GROUND),
            Joint("D", (0.9, 0.7), (Connection("D5", "third"),), "coupler"),
        ),
    )
    with raises(MotionBlocked, "does-not-close"):
        move(crooked, [ConstantDrive(1.0, 1.5, 1.0)], np.linspace(0.0, 1.0, 8))


def test_the_gap_of_links_that_do_not_fit_is_told() -> None:
    """A third crank of a parallelogram is 1.5 mm too long in 300. As the others turn its end has
    to stay at a fixed distance of the pivot: off by what 1.5 mm along one direction are in another.
    """
    a, angle, end, off = 0.3, 1.0, 1.6, 1.5e-3
    linkage = four_bar(1.0, a, 1.0, a, angle=angle)
    pivot, e = np.array([0.5, 0.2]), np.array([np.cos(angle), np.sin(angle)])
    top = pivot + a * e + off * np.array([-e[1], e[0]])  # on the coupler, drawn beside its place
    crooked = replace(
        linkage,
        bodies=(*linkage.bodies, Body("third", 1.0, (0.5, 0.3), 0.05)),
        joints=(
            *linkage.joints,
            Joint("O5", tuple(pivot.tolist()), (Connection("F15", "third"),), GROUND),
            Joint("D", tuple(top.tolist()), (Connection("D5", "third"),), "coupler"),
        ),
    )
    with pytest.raises(MotionBlocked) as blocked:
        move(crooked, [ConstantDrive(angle, end, 1.0)], np.linspace(0.0, 1.0, 8))
    # The coupler only shifts: D is at pivot + a e(t) + off, the crank's length is that as drawn.
    drawn = np.hypot(a, off)
    now = a * np.array([np.cos(end), np.sin(end)]) + off * np.array([-e[1], e[0]])
    miss = abs(np.hypot(*now) - drawn)
    assert 0.2 * miss < blocked.value.gap < miss  # the drive and other joints take a part of it
    assert f"{blocked.value.gap:.6g} m apart" in str(blocked.value)


def test_two_drives_move_a_five_bar() -> None:
    """Two cranks and two rods: the joint between the rods follows from two circles."""
    p, q = 0.3 * np.exp(2.0j), 1.0 + 0.3 * np.exp(1.2j)
    c = circles(p, 0.7, q, 0.7, 1.0)
    linkage = Linkage(
        bodies=(
            Body("left", 1.0, (0.0, 0.1), 0.01),
            Body("right", 1.0, (1.0, 0.1), 0.01),
            Body("rod", 1.0, (0.2, 0.5), 0.05),
            Body("bar", 1.0, (0.8, 0.5), 0.05),
        ),
        joints=(
            Joint("O", (0.0, 0.0), (Connection("O", "left"),), GROUND),
            Joint("E", (1.0, 0.0), (Connection("E", "right"),), GROUND),
            Joint("P", (p.real, p.imag), (Connection("P", "rod"),), "left"),
            Joint("Q", (q.real, q.imag), (Connection("Q", "bar"),), "right"),
            Joint("C", (c.real, c.imag), (Connection("C1", "rod"), Connection("C2", "bar")), None),
        ),
        driven=("left", "right"),
        turns=(Turn("left", "left", 2.0), Turn("right", "right", 1.2)),
        gravity=(0.0, -9.81),
    )
    laws = [CycloidalDrive(1.8, 1.4, 1.0), CycloidalDrive(1.4, 0.9, 1.5, begin=0.2)]
    times = np.linspace(0.0, 1.7, 35)
    motion = move(linkage, laws, times)
    left, right = (laws[k](times)[0] for k in (0, 1))
    wanted = [
        circles(0.3 * np.exp(1j * x), 0.7, 1.0 + 0.3 * np.exp(1j * y), 0.7, 1.0)
        for x, y in zip(left, right, strict=True)
    ]
    assert motion.joint("C")[0] @ [1.0, 1.0j] == pytest.approx(np.array(wanted), abs=1e-12)
    assert ledger(motion_reactions("both", motion)).violation < 1e-9

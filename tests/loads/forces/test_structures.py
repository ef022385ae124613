"""Structures without a degree of freedom, solved as statics, against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    Gear,
    Joint,
    Linkage,
    LinkageError,
    Parallel,
    Sharing,
    Slider,
    Turn,
    at_rest,
    gear_pair,
    locked,
    motion_reactions,
)
from loads.forces.inverse_dynamics import Dynamics
from loads.motion.mobility import mobility, require_determined
from pinbase.arrays import Floats
from tests.support.errors import raises

Point = tuple[float, float]


def truss(nodes: dict[str, Point], bars: str, fixed: str, mass: float = 0.0) -> Linkage:
    """Bars between pins, named by their two nodes; `fixed` are pins of the ground. Gravity is
    9 m/s^2 downwards.

    mass: of every bar, kg, in its middle.
    """
    names = bars.split()
    middles = {n: np.mean([nodes[n[0]], nodes[n[1]]], axis=0) for n in names}
    joints = tuple(
        Joint(
            node,
            at,
            tuple(Connection(f"{n} at {node}", n) for n in names if node in n),
            GROUND if node in fixed else None,
        )
        for node, at in nodes.items()
        if node in bars
    )
    bodies = tuple(Body(n, mass, (float(x), float(y)), 0.0) for n, (x, y) in middles.items())
    return Linkage(bodies, joints, (), gravity=(0.0, -9.0))


def on_roller(structure: Linkage, node: str) -> Linkage:
    """The structure with a particle at a node that slides along x on the ground."""
    joint = structure.joint(node)
    carried = replace(joint, connections=(*joint.connections, Connection("roller", "roller")))
    return replace(
        structure,
        bodies=(*structure.bodies, Body("roller", 0.0, joint.at, None)),
        joints=tuple(carried if j is joint else j for j in structure.joints),
        sliders=(Slider("rail", GROUND, "roller", joint.at, joint.at, (1.0, 0.0)),),
    )


def pushed(structure: Linkage, body: str, at: Point, force: Point) -> Dynamics:
    """The forces under a load at a point as drawn."""
    load = Applied(body, at, force)
    return motion_reactions("load", at_rest(structure, ()), (load,), timed=False)


def force(solved: Dynamics, connection: str) -> Point:
    """The force of a body on a pin, N."""
    k = solved.reactions.connections.index(connection)
    x, y, _ = solved.reactions.forces[0, k]
    return float(x), float(y)


def near(x: float, y: float) -> object:
    """A force, N, up to round-off."""
    return pytest.approx((x, y), rel=1e-12, abs=1e-9)


def test_a_three_hinged_arch_has_the_thrust_of_the_textbook() -> None:
    """Of span 2 b and rise h, under P at a from the left: H = P a / (2 h), V = P a / (2 b) on
    the right.
    """
    b, h, a, P = 4.0, 3.0, 1.5, 800.0
    arch = truss({"A": (0.0, 0.0), "C": (b, h), "B": (2.0 * b, 0.0)}, "AC CB", "AB")
    solved = pushed(arch, "AC", (a, 2.0), (0.0, -P))
    H, V = P * a / (2.0 * h), P * a / (2.0 * b)
    assert force(solved, "CB at B") == near(H, -V)
    assert force(solved, "AC at A") == near(-H, V - P)
    assert force(solved, "AC at C") == near(H, -V)
    assert solved.drive.shape == solved.power.shape == (1, 0)


def test_the_forces_of_a_truss_are_those_of_the_method_of_joints() -> None:
    """A roof truss of seven bars, on a pin and a roller, under a load at its top."""
    nodes = {"A": (0.0, 0.0), "B": (2.0, 0.0), "C": (4.0, 0.0), "D": (1.0, 1.5), "E": (3.0, 1.5)}
    roof = on_roller(truss(nodes, "AB BC AD DB BE EC DE", "A"), "C")
    load = np.array([300.0, -1000.0])
    solved = pushed(roof, "DE", nodes["E"], (load[0], load[1]))
    for bar, tension in method_of_joints(nodes, "AB BC AD DB BE EC DE", load).items():
        along = np.subtract(nodes[bar[1]], nodes[bar[0]])
        pull = tension * along / np.linalg.norm(along)
        # A pulled bar pulls its pins towards its middle; the load acts on DE, which hands it on.
        handed = load if bar == "DE" else np.zeros(2)
        assert force(solved, f"{bar} at {bar[0]}") == near(*pull), bar
        assert force(solved, f"{bar} at {bar[1]}") == near(*(handed - pull)), bar
    assert force(solved, "roller") == near(0.0, (1000.0 * 3.0 + 300.0 * 1.5) / 4.0)


def method_of_joints(nodes: dict[str, Point], bars: str, load: Floats) -> dict[str, float]:
    """Tension of every bar, N, of the truss held at A and, across x, at C, with a load at E."""
    names = bars.split()
    rows, side = [], []
    for node, axis in ("Bx", "By", "Cx", "Dx", "Dy", "Ex", "Ey"):
        k = "xy".index(axis)
        others = [nodes[bar.replace(node, "")] if node in bar else None for bar in names]
        ways = [None if o is None else np.subtract(o, nodes[node]) for o in others]
        rows.append([0.0 if w is None else w[k] / np.linalg.norm(w) for w in ways])
        side.append(-load[k] if node == "E" else 0.0)
    return dict(zip(names, np.linalg.solve(np.array(rows), np.array(side)), strict=True))


def test_the_tie_of_an_a_frame_holds_its_legs_together() -> None:
    """Legs of height h and half span b, a tie e above the ground, P at the top:
    T = P b / (2 (h - e)).
    """
    b, h, e, P = 1.2, 3.0, 1.0, 5000.0
    x = b * (1.0 - e / h)
    frame = Linkage(
        tuple(Body(name, 0.0, (0.0, e), 0.0) for name in ("left", "right", "tie")),
        (
            Joint("A", (-b, 0.0), (Connection("A", "left"),), GROUND),
            Joint("B", (b, 0.0), (), "right"),
            Joint("C", (0.0, h), (Connection("C", "right"),), "left"),
            Joint("D", (-x, e), (Connection("D", "tie"),), "left"),
            Joint("E", (x, e), (Connection("E", "tie"),), "right"),
        ),
        (),
    )
    solved = pushed(on_roller(frame, "B"), "left", (0.0, h), (0.0, -P))
    T = P * b / (2.0 * (h - e))
    assert force(solved, "D") == near(T, 0.0)
    assert force(solved, "E") == near(-T, 0.0)
    assert force(solved, "roller") == near(0.0, P / 2.0)
    assert force(solved, "A") == near(0.0, -P / 2.0)


def test_gravity_acts_on_a_structure() -> None:
    """Two bars of mass m that lean on each other: each pin of the ground carries m g, and
    H = m g b / (2 h).
    """
    b, h, m = 2.0, 1.5, 10.0
    arch = truss({"A": (0.0, 0.0), "C": (b, h), "B": (2.0 * b, 0.0)}, "AC CB", "AB", mass=m)
    solved = motion_reactions("load", at_rest(arch, ()), timed=False)
    assert force(solved, "AC at A") == near(-m * 9.0 * b / (2.0 * h), -m * 9.0)
    assert force(solved, "AC at C") == near(m * 9.0 * b / (2.0 * h), 0.0)


def braced(*sharing: Sharing) -> Linkage:
    """A square panel with two diagonals, of which one is redundant."""
    nodes = {"A": (0.0, 0.0), "B": (1.0, 0.0), "C": (1.0, 1.0), "D": (0.0, 1.0)}
    return replace(truss(nodes, "AD BC CD AC BD", "AB"), sharing=sharing)


def test_a_redundant_bar_is_refused_by_name_or_shares_by_its_stiffness() -> None:
    """Under P at the top the tensions of the diagonals differ by P sqrt(2); of stiffnesses
    1 and k their share is 1 and k of it.
    """
    with raises(LinkageError, "statically-indeterminate", "AC at A", "BD at D"):
        pushed(braced(), "CD", (0.0, 1.0), (100.0, 0.0))
    for k in (1.0, 3.0):
        rule = Sharing(("AC at A", "BD at B"), (1.0, k))
        solved = pushed(braced(rule), "CD", (0.0, 1.0), (100.0, 0.0))
        assert solved.shared
        each = 100.0 / (1.0 + k)
        assert force(solved, "AC at A") == near(each, each)
        assert force(solved, "BD at B") == near(k * each, -k * each)


def test_two_redundant_bars_share_each_in_its_storey() -> None:
    """One panel upon another, pushed at the top: the shear in both is P, so that the diagonals of
    each carry P sqrt(2) between them, in the ratio of their own stiffnesses.
    """
    nodes = {"A": (0.0, 0.0), "B": (1.0, 0.0), "C": (1.0, 1.0), "D": (0.0, 1.0), "E": (1.0, 2.0),
             "F": (0.0, 2.0)}  # fmt: skip
    below, above = (
        Sharing(("AC at A", "BD at B"), (1.0, 4.0)),
        Sharing(("DE at D", "CF at C"), (3.0, 1.0)),
    )
    tower = truss(nodes, "AD BC CD AC BD CE DF EF DE CF", "AB")
    solved = pushed(replace(tower, sharing=(below, above)), "EF", (0.0, 2.0), (100.0, 0.0))
    assert force(solved, "AC at A") == near(20.0, 20.0)
    assert force(solved, "BD at B") == near(80.0, -80.0)
    assert force(solved, "DE at D") == near(75.0, 75.0)
    assert force(solved, "CF at C") == near(25.0, -25.0)


def test_what_lacks_a_drive_is_told_how_many() -> None:
    nodes = {"A": (0.0, 0.0), "B": (1.0, 0.0), "C": (1.0, 1.0), "D": (0.0, 1.2), "E": (0.5, 2.0)}
    four = truss(nodes, "AD BC CD", "AB")
    with raises(LinkageError, "underconstrained", "no drive", "1 degree of", "AD, BC, CD"):
        require_determined(four)
    five = truss(nodes, "AD BC CE DE", "AB")
    with raises(LinkageError, "underconstrained", "no drive", "2 degrees of") as caught:
        require_determined(five)
    assert caught.value.at == ("drive",)


def test_an_arch_with_its_hinges_in_line_carries_nothing() -> None:
    flat = truss({"A": (0.0, 0.0), "C": (1.0, 0.0), "B": (2.0, 0.0)}, "AC CB", "AB")
    with raises(LinkageError, "unstable-form", "AC, CB"):
        require_determined(flat)


def test_a_drive_of_a_structure_is_told_to_go() -> None:
    arch = truss({"A": (0.0, 0.0), "C": (1.0, 1.0), "B": (2.0, 0.0)}, "AC CB", "AB")
    driven = replace(arch, turns=(Turn("left", "AC", 0.0),), driven=("left",))
    with raises(LinkageError, "statically-indeterminate", "remove the drive of left"):
        motion_reactions("load", at_rest(driven, (0.0,)), timed=False)


def gears() -> Linkage:
    """Two gears with radii of 0.1 and 0.2 m, and a lock on each."""
    return Linkage(
        (Body("small", 0.0, (0.0, 0.0), 0.0), Body("large", 0.0, (0.3, 0.0), 0.0)),
        (
            Joint("A", (0.0, 0.0), (Connection("A", "small"),), GROUND),
            Joint("B", (0.3, 0.0), (Connection("B", "large"),), GROUND),
        ),
        (),
        turns=(Turn("on small", "small", 0.0), Turn("on large", "large", 0.0)),
        teeth=(
            gear_pair("teeth", (Gear("small", "A"), Gear("large", "B")), GROUND,
                      ((0.0, 0.0), (0.3, 0.0)), (1.0, 2.0), np.radians(20.0)),
        ),
    )  # fmt: skip


def test_a_locked_gear_is_held_without_a_drive() -> None:
    """A couple of 50 N m on the small gear pushes the teeth with 500 N, the lock with 100 N m."""
    held = locked(gears(), ["on large"])
    solved = motion_reactions(
        "load", at_rest(held, (0.0,)), (Applied("small", (0.0, 0.0), couple=50.0),), timed=False,
        hold=("on large",),
    )  # fmt: skip
    assert solved.drive[0] == pytest.approx([100.0])
    assert force(solved, "teeth") == near(500.0 * np.tan(np.radians(20.0)), 500.0)
    assert mobility(gears()).degrees == 1


def test_two_locks_need_a_rule_and_one_must_hold() -> None:
    both = ("on small", "on large")
    with raises(LinkageError, "hold-too-many", "2 for 1"):
        locked(gears(), both)
    shared = replace(gears(), parallel=(Parallel(both, (1.0, 1.0), "stiffness"),))
    held = locked(shared, both)
    solved = motion_reactions(
        "load", at_rest(held, (0.0,)), (Applied("small", (0.0, 0.0), couple=50.0),), timed=False,
        hold=both,
    )  # fmt: skip
    # The small gear turns twice as far as the large one: of 50 N m its lock takes 4 parts of 5.
    assert solved.drive[0] == pytest.approx([-40.0, 20.0])
    with raises(LinkageError, "hold-free", "large"):
        locked(replace(gears(), teeth=(), turns=(*gears().turns, Turn("too", "small", 0.0))),
               ("on small", "too"))  # fmt: skip

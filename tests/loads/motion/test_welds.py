"""Welded bodies: a part cut in two and welded again moves and pushes as it did in one piece."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    CosineDrive,
    Dynamics,
    Joint,
    Linkage,
    LinkageError,
    motion_reactions,
    move,
)
from loads.motion.four_bar import four_bar as as_four_bar
from loads.motion.mobility import mobility, require_determined
from loads.motion.transmission_angles import transmission_angles
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import four_bar, slider_crank

TIMES = np.linspace(0.0, 1.0, 9)


def cut(body: Body, shares: Sequence[float], apart: float) -> tuple[Body, Body]:
    """A body as two halves with centres `apart`, m, and together the same mass, centre and
    inertia; the second is welded to the first.
    """
    one, other = body.mass * shares[0], body.mass * shares[1]
    x, y = body.centre
    inertia = (
        (body.inertia or 0.0) - one * (apart * shares[1]) ** 2 - other * (apart * shares[0]) ** 2
    )
    return (
        Body(body.name, one, (x - apart * shares[1], y), 0.7 * inertia),
        Body(f"{body.name} end", other, (x + apart * shares[0], y), 0.3 * inertia, body.name),
    )


def moved(joint: Joint, old: str, new: str) -> Joint:
    """The joint with a body renamed."""
    on = tuple(replace(c, body=new if c.body == old else c.body) for c in joint.connections)
    return replace(joint, connections=on, fixed_in=new if joint.fixed_in == old else joint.fixed_in)


def in_two(linkage: Linkage, name: str, joint: str) -> Linkage:
    """The linkage with one body cut in two, of which the second has the joint of that name."""
    halves = {name: cut(next(b for b in linkage.bodies if b.name == name), (0.6, 0.4), 0.07)}
    return replace(
        linkage,
        bodies=tuple(half for b in linkage.bodies for half in halves.get(b.name, (b,))),
        joints=tuple(
            moved(j, name, f"{name} end") if j.name == joint else j for j in linkage.joints
        ),
    )


def pushed(linkage: Linkage, body: str, at: tuple[float, float]) -> Dynamics:
    """The forces of a motion under a load."""
    start = linkage.drives[0].drawn
    motion = move(linkage, [CosineDrive(start, start + 0.6, 1.0)], TIMES)
    return motion_reactions("push", motion, (Applied(body, at, (30.0, -70.0), 4.0),))


def same(one: Dynamics, other: Dynamics) -> None:
    """The same forces on the pins and of the drive, and the same friction."""
    assert one.reactions.connections == other.reactions.connections
    size = np.abs(one.reactions.forces).max()
    assert np.abs(one.reactions.forces - other.reactions.forces).max() < 1e-11 * size
    assert other.drive == pytest.approx(one.drive, rel=1e-10, abs=1e-10)
    assert other.sliders.couple == pytest.approx(one.sliders.couple, rel=1e-9, abs=1e-9)
    assert other.sliders.friction == pytest.approx(one.sliders.friction, rel=1e-9, abs=1e-9)


def test_a_welded_coupler_is_one_coupler() -> None:
    whole = four_bar()
    halves = in_two(whole, "coupler", "B")
    same(pushed(whole, "coupler", (0.5, 0.4)), pushed(halves, "coupler end", (0.5, 0.4)))
    free = mobility(halves)
    assert (free.kutzbach, free.degrees, free.free, free.redundant) == (1, 1, 0, 0)
    # Neither half is a link along which a force acts, so neither has a transmission angle.
    motion = move(halves, [CosineDrive(0.9, 1.0, 1.0)], TIMES)
    assert not any("coupler" in body for body, _ in transmission_angles(motion))
    assert as_four_bar(whole) is not None
    assert as_four_bar(halves) is None


def test_a_welded_block_carries_the_couple_of_its_guide() -> None:
    """With friction of two pads; the force of the rod acts on the half that does not slide."""
    whole = slider_crank(friction=0.1, bearing=0.4)
    block = replace(whole.bodies[2], inertia=0.01)
    whole = replace(whole, bodies=(*whole.bodies[:2], block))
    off = (block.centre[0] + 0.02, block.centre[1] + 0.03)
    one, other = pushed(whole, "block", off), pushed(in_two(whole, "block", "C"), "block end", off)
    same(one, other)
    assert np.abs(one.sliders.couple).max() > 1.0
    assert np.abs(one.sliders.friction).max() > 1.0


def test_a_body_welded_to_the_ground_is_ground() -> None:
    whole = four_bar()
    column = Body("column", 7.0, (1.0, -0.5), 1.0, GROUND)
    carried = replace(
        whole,
        bodies=(*whole.bodies, column),
        joints=tuple(
            moved(j, GROUND, "column") if j.name == "O4" else j for j in whole.joints
        ),
    )  # fmt: skip
    same(pushed(whole, "rocker", (0.8, 0.4)), pushed(carried, "rocker", (0.8, 0.4)))


def test_three_bodies_welded_in_a_row_are_one() -> None:
    whole = four_bar()
    halves = in_two(whole, "coupler", "B")
    third = Body("tip", 0.0, (0.3, 0.9), 0.0, "coupler end")
    thirds = replace(halves, bodies=(third, *halves.bodies))
    same(pushed(whole, "coupler", (0.5, 0.4)), pushed(thirds, "tip", (0.5, 0.4)))
    assert set(thirds.rigid["tip"]) == {"tip", "coupler", "coupler end"}


def test_two_pins_instead_of_a_weld_are_named() -> None:
    """Their forces along the line between them are open; the weld is what it may have meant."""
    halves = in_two(four_bar(), "coupler", "B")
    loose = tuple(replace(b, welded=None) for b in halves.bodies)
    pins = tuple(
        Joint(name, at, (Connection(name, "coupler end"),), "coupler")
        for name, at in (("P", (0.4, 0.3)), ("Q", (0.5, 0.5)))
    )
    pinned = replace(halves, bodies=loose, joints=(*halves.joints, *pins))
    with raises(LinkageError, "statically-indeterminate", "at P, Q;", "P and Q", "welded_to"):
        pushed(pinned, "coupler", (0.5, 0.4))


def test_a_weld_that_cannot_be_is_refused() -> None:
    bar = four_bar()
    for welded, inertia, code in (
        ("nobody", 0.0, "unknown-body"),
        ("spare", 0.0, "same-body"),
        ("crank", None, "missing-inertia"),
    ):
        with raises(LinkageError, code, "spare"):
            replace(bar, bodies=(*bar.bodies, Body("spare", 1.0, (0.0, 0.0), inertia, welded)))
    require_determined(
        replace(bar, bodies=(*bar.bodies, Body("spare", 1.0, (0.0, 0.0), 0.0, "crank")))
    )

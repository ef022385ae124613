"""Linkages of sliders: a wedge, where sliders alone close the loop, a Scotch yoke, a ram."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from loads import (
    GROUND,
    Applied,
    Body,
    Connection,
    ConstantDrive,
    Joint,
    Linkage,
    LinkageError,
    Slider,
    StateDrive,
    Turn,
    ledger,
    mobility,
    motion_reactions,
    move,
)
from tests.support.errors import raises

SLOPE = 0.4


def wedge() -> Linkage:
    """A wedge on the ground lifts a follower that slides on its slope and in a vertical guide; a
    weight hangs on the follower's pin. The drive pushes the wedge along x.
    """
    return Linkage(
        bodies=(
            Body("wedge", 2.0, (0.0, 0.0), None),
            Body("follower", 3.0, (0.5, 0.5), None),
            Body("weight", 4.0, (0.5, 1.0), None),
        ),
        joints=(Joint("P", (0.5, 1.0), (Connection("P", "weight"),), "follower"),),
        driven=("push",),
        sliders=(
            Slider("push", GROUND, "wedge", (-1.0, 0.0), (0.0, 0.0)),
            Slider(
                "slope", "wedge", "follower", (0.0, 0.0), (0.5, 0.5), (np.cos(SLOPE), np.sin(SLOPE))
            ),
            Slider("lift", GROUND, "follower", (0.5, 0.0), (0.5, 0.5), (0.0, 1.0)),
        ),
        gravity=(0.0, -9.81),
    )


def test_a_wedge_lifts_by_its_slope() -> None:
    linkage = wedge()
    found = mobility(linkage)
    # 3 . 2 - 2 . 3 = 0: the count misses that three sliders share one angle
    assert (found.kutzbach, found.degrees, found.redundant) == (0, 1, 0)
    law = ConstantDrive(1.0, 0.8, 1.0)  # the wedge goes left, so the follower rises
    motion = move(linkage, [law], np.linspace(0.0, 1.0, 5))
    x, v, _ = motion.joint("P")
    assert x[:, 0] == pytest.approx(0.5)
    assert x[:, 1] == pytest.approx(1.0 + np.tan(SLOPE) * (1.0 - motion.drives[:, 0]))
    assert v[0, 1] == pytest.approx(0.2 * np.tan(SLOPE))
    forces = motion_reactions("lift", motion)
    assert forces.drive[0, 0] == pytest.approx(-7.0 * 9.81 * np.tan(SLOPE))
    assert forces.reactions.force("P")[0, :2] == pytest.approx([0.0, -4.0 * 9.81])
    assert ledger(forces).violation < 1e-12


def test_two_guides_of_one_body_are_named() -> None:
    """A platen on two columns: nothing says what each of them carries, but no pin is concerned."""
    linkage = wedge()
    lift = linkage.sliders[2]
    for at in (-0.3, 0.4):
        moved = replace(lift, name="column", start=(at, 0.0), end=(at, 0.5))
        twice = replace(linkage, sliders=(*linkage.sliders, moved))
        assert mobility(twice).shared == ("lift", "column")
        with raises(LinkageError, "redundant-sliders", "lift, column guide"):
            motion_reactions("x", move(twice, [StateDrive(1.0)], np.zeros(1)))


def test_pads_whose_couple_is_open_are_refused_in_any_order() -> None:
    """Three sliders for two bodies that cannot turn: of their couples one is open. Of it depends
    what pads rub, so that the drive's force would depend on the order of the sliders; without pads
    it does not.
    """
    law = ConstantDrive(1.0, 0.8, 1.0)
    side = Applied("follower", (0.9, 1.0), (30.0, -40.0))
    alone = list[float]()
    for order in permutations(replace(s, friction=0.2) for s in wedge().sliders):
        rubbing = replace(wedge(), sliders=order)
        motion = move(rubbing, [law], np.array([0.3, 0.6]))
        alone.append(float(motion_reactions("lift", motion, [side]).drive[0, 0]))
        padded = replace(rubbing, sliders=tuple(replace(s, bearing=0.2) for s in order))
        motion = move(padded, [law], np.array([0.3, 0.6]))
        with raises(LinkageError, "couple-indeterminate", "push", "slope", "lift"):
            motion_reactions("lift", motion, [side])
        motion_reactions("still", move(padded, [StateDrive(0.9)], np.zeros(1)), [side])
    assert alone == pytest.approx([alone[0]] * 6, rel=1e-12)


def test_a_wedge_with_friction_holds_itself() -> None:
    """With friction mu on the slope alone the push is W tan(slope + atan mu) upwards, W tan(slope -
    atan mu) downwards.
    """
    mu = 0.3
    linkage = wedge()
    sliders = tuple(replace(s, friction=mu if s.name == "slope" else 0.0) for s in linkage.sliders)
    rough = replace(linkage, sliders=sliders)
    found = motion_reactions("up", move(rough, [StateDrive(1.0, -1.0)], np.zeros(1)))
    weight = 7.0 * 9.81
    assert abs(found.drive[0, 0]) == pytest.approx(weight * np.tan(SLOPE + np.arctan(mu)))
    down = motion_reactions("down", move(rough, [StateDrive(1.0, 1.0)], np.zeros(1)))
    assert abs(down.drive[0, 0]) == pytest.approx(weight * np.tan(SLOPE - np.arctan(mu)))
    assert ledger(found).violation < 1e-12


def test_a_scotch_yoke_moves_as_a_cosine() -> None:
    """The yoke slides on the ground along x; the crank pin's block slides in its vertical slot."""
    r, w = 0.2, 3.0
    a = r * np.exp(1j * 0.5)
    linkage = Linkage(
        bodies=(
            Body("crank", 1.0, (0.0, 0.0), 0.02),
            Body("block", 0.3, (a.real, a.imag), 0.001),
            Body("yoke", 5.0, (a.real, 0.0), None),
        ),
        joints=(
            Joint("O", (0.0, 0.0), (Connection("O", "crank"),), GROUND),
            Joint("A", (a.real, a.imag), (Connection("A", "block"),), "crank"),
        ),
        driven=("crank",),
        sliders=(
            Slider("bed", GROUND, "yoke", (-1.0, 0.0), (a.real, 0.0)),
            Slider("slot", "yoke", "block", (a.real, 0.0), (a.real, a.imag), (0.0, 1.0)),
        ),
        turns=(Turn("crank", "crank", 0.5),),
    )
    motion = move(linkage, [ConstantDrive(0.5, 0.5 + w, 1.0)], np.linspace(0.0, 1.0, 9))
    turn = motion.drives[:, 0]
    x, v, acceleration = motion.point("yoke", (a.real, 0.0))
    assert x[:, 0] == pytest.approx(r * np.cos(turn))
    assert v[:, 0] == pytest.approx(-r * w * np.sin(turn))
    assert acceleration[:, 0] == pytest.approx(-r * w**2 * np.cos(turn))
    found = motion_reactions("turn", motion)
    # the crank moves the yoke along x, and the block in both directions
    wanted = np.stack([-5.3 * r * w**2 * np.cos(turn), -0.3 * r * w**2 * np.sin(turn)], axis=1)
    assert -found.reactions.force("A")[:, :2] == pytest.approx(wanted, abs=1e-12)
    # the slot pushes the block along x alone (normals count to the left of the axis, which is up),
    # at the block's height: the bed bears the couple
    slot, bed = (found.sliders.normal[:, k] for k in (1, 0))
    assert slot == pytest.approx(-5.0 * r * w**2 * np.cos(turn), abs=1e-12)
    assert bed == pytest.approx(0.0, abs=1e-12)
    assert np.abs(found.sliders.couple[:, 0]) == pytest.approx(
        np.abs(5.0 * r * w**2 * np.cos(turn) * r * np.sin(turn)), abs=1e-12
    )
    assert ledger(found).violation < 1e-12


def test_a_couple_on_a_slider_is_borne_by_its_guide() -> None:
    linkage = Linkage(
        bodies=(Body("ram", 1.0, (0.0, 1.0), None), Body("pad", 1.0, (0.2, 1.0), None)),
        joints=(Joint("P", (0.2, 1.0), (Connection("P", "pad"),), "ram"),),
        driven=("guide",),
        sliders=(Slider("guide", GROUND, "ram", (0.0, 0.0), (0.0, 1.0)),),
    )
    load = Applied("ram", (0.2, 1.0), (0.0, -50.0), couple=3.0)
    found = motion_reactions("held", move(linkage, [StateDrive(1.0)], np.zeros(1)), [load])
    assert found.drive[0, 0] == pytest.approx(50.0)
    assert found.sliders.couple[0, 0] == pytest.approx(0.2 * 50.0 - 3.0)
    assert found.sliders.normal[0, 0] == pytest.approx(0.0)

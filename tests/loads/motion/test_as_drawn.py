"""What cannot be determined as drawn: because something is missing, or because of the position."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from loads import (
    GROUND,
    Body,
    Connection,
    Joint,
    Linkage,
    LinkageError,
    Sharing,
    Slider,
    Turn,
    at_rest,
    motion_reactions,
)
from loads.motion.mobility import mobility, require_determined
from tests.support.each import each
from tests.support.errors import raises
from tests.support.mechanism.mechanisms import coupled_wheels, four_bar


def flat(ground: float, crank: float, coupler: float, rocker: float, angle: float) -> Linkage:
    """A four-bar with all its joints on the x-axis, its crank at 0 or pi."""
    bar = four_bar(angle=0.9)
    a = crank * np.cos(angle)
    b = ground + rocker if abs(ground + rocker - a) == pytest.approx(coupler) else ground - rocker
    at = {"O2": 0.0, "A": a, "B": b, "O4": ground}
    assert abs(b - a) == pytest.approx(coupler)
    return replace(
        bar,
        joints=tuple(replace(j, at=(at[j.name], 0.0)) for j in bar.joints),
        bodies=tuple(replace(b, centre=(0.3, 0.0)) for b in bar.bodies),
        turns=(Turn("crank", "crank", angle),),
    )


@each("angle", [0.0, np.pi])
def test_a_parallelogram_drawn_flat_is_at_its_change_point(angle: float) -> None:
    with raises(LinkageError, "change-point"):
        require_determined(flat(1.0, 0.5, 1.0, 0.5, angle))


def test_coupled_wheels_drawn_flat_are_at_it_too() -> None:
    wheels = coupled_wheels(1.0, 1.0, 1.0)
    at = {"A": (0.5, 0.0), "B": (1.5, 0.0), "D": (1.0, 0.0), "O5": (0.5, 0.0)}
    drawn = replace(
        wheels, joints=tuple(replace(j, at=at.get(j.name, j.at)) for j in wheels.joints)
    )
    with raises(LinkageError, "change-point"):
        require_determined(drawn)


def test_a_rocker_that_is_driven_in_the_toggle_is_at_a_dead_point() -> None:
    """The crank-rocker's crank and coupler in line: the rocker cannot move them."""
    stretched, rocker, ground = 0.4 + 0.9, 0.8, 1.0
    x = (stretched**2 + ground**2 - rocker**2) / (2.0 * ground)
    b = complex(x, np.sqrt(stretched**2 - x**2))
    bar = four_bar(angle=float(np.angle(b)))
    drawn = replace(
        bar, turns=(Turn("rocker", "rocker", float(np.angle(b - 1.0))),), driven=("rocker",)
    )
    with raises(LinkageError, "dead-point", "rocker"):
        require_determined(drawn)
    require_determined(bar)  # the crank can


def test_what_misses_a_connection_is_told_so_also_when_it_is_drawn_flat() -> None:
    bar = four_bar()
    loose = replace(bar, joints=bar.joints[:3], bodies=bar.bodies)
    with raises(LinkageError, "underconstrained"):
        require_determined(loose)
    line = flat(1.0, 0.5, 1.0, 0.5, 0.0)
    with raises(LinkageError, "underconstrained"):
        require_determined(replace(line, joints=line.joints[:3]))
    undriven = replace(coupled_wheels(1.0, 1.0, 1.0), driven=(), turns=())
    with raises(LinkageError, "underconstrained"):
        require_determined(undriven)


def lift(*driven: str, sharing: tuple[Sharing, ...] = ()) -> Linkage:
    """A boom on the ground, lifted by two cylinders side by side, which the plane shows as one."""
    bodies, joints, sliders = [Body("boom", 100.0, (1.0, 0.0), 30.0)], [], []
    joints.append(Joint("O", (0.0, 0.0), (Connection("O", "boom"),), GROUND))
    for side in ("left", "right"):
        bodies += [Body(f"{side}_barrel", 10.0, (0.6, -0.6), 1.0)]
        bodies += [Body(f"{side}_rod", 5.0, (0.9, -0.2), 0.5)]
        joints += [
            Joint(f"{side}_foot", (0.5, -0.8), (Connection(f"{side} foot", f"{side}_barrel"),),
                  GROUND),
            Joint(f"{side}_eye", (1.0, 0.0), (Connection(f"{side} eye", f"{side}_rod"),), "boom"),
        ]  # fmt: skip
        sliders.append(Slider(side, f"{side}_barrel", f"{side}_rod", (0.5, -0.8), (1.0, 0.0)))
    return Linkage(tuple(bodies), tuple(joints), driven, tuple(sliders), (), (0.0, -9.81), sharing)


def test_a_sharing_that_changes_nothing_is_refused() -> None:
    assert mobility(lift("left")).shared == ()
    shares = (Sharing(("left eye", "right eye"), (1.0, 1.0)),)
    with raises(LinkageError, "sharing-idle", "left eye, right eye", "Slider right") as caught:
        require_determined(lift("left", sharing=shares))
    assert caught.value.at == ("sharing",)


def test_a_sharing_needs_one_connection_that_it_can_change() -> None:
    """Over all connections of a linkage it is plain least squares, which is a rule, too."""
    wheels = coupled_wheels(1.0, 1.0, 1.0)
    hung = replace(
        wheels,
        bodies=(*wheels.bodies, Body("load", 5.0, (0.7, 0.1), None)),
        joints=(
            *wheels.joints,
            Joint("W", (0.7, 0.1), (Connection("W", "load"),), "coupler"),
        ),
    )
    alone, both = (Sharing(names, (1.0,) * len(names)) for names in (("W",), ("W", "F12")))
    with raises(LinkageError, "sharing-idle", "over W", "F12"):
        require_determined(replace(hung, sharing=(*wheels.sharing, alone)))
    require_determined(replace(hung, sharing=(both,)))


def test_a_sharing_that_leaves_a_redundant_way_open_is_refused() -> None:
    """A fourth crank is a second way, and one connection along its crank decides only one."""
    wheels = coupled_wheels(1.0, 1.0, 1.0)
    at = np.array([0.25, -0.3])
    fourth = replace(
        wheels,
        bodies=(*wheels.bodies, Body("fourth", 1.0, (0.3, 0.0), 0.05)),
        joints=(
            *wheels.joints,
            Joint("O6", (at[0], at[1]), (Connection("F16", "fourth"),), GROUND),
            Joint(
                "G",
                (at[0] + 0.5 * np.cos(1.0), at[1] + 0.5 * np.sin(1.0)),
                (Connection("G6", "fourth"),),
                "coupler",
            ),
        ),
        sharing=(Sharing(("F15",), (1.0,)),),
    )
    with raises(LinkageError, "sharing-incomplete", "F15"):
        motion_reactions("held", at_rest(fourth, [1.0]))

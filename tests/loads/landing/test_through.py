"""A drop through a mechanism: forces in the leg against those of the fall, by Newton's law."""

from __future__ import annotations

import math

import numpy as np
import pytest

from loads import (
    GROUND,
    ArgumentError,
    Body,
    Connection,
    Course,
    Joint,
    Linkage,
    Slider,
    Turn,
    motion_reactions,
)
from loads.landing import (
    Drop,
    GasSpring,
    Landing,
    Oil,
    PowerTyre,
    Strut,
    Touchdown,
    Wheel,
    at_deflection,
    axes,
    effective_mass,
    land,
    laws,
    pushes,
    travel,
)
from loads.landing.through import fall
from tests.support.each import each
from tests.support.errors import raises

G, STROKE, ARM, TILT = 9.80665, 0.3, 0.5, 0.3
GAS = GasSpring(8e5, 0.003, 0.008, 1.2, 1.01e5)
WHEEL = Wheel(1.5, 0.3, 45.0, 0.7, 1.5e6, 60.0, 0.03)


def telescopic(forward: str, turned: float) -> tuple[Linkage, Touchdown]:
    """An upright piston of 60 kg with the axle, in a cylinder that is welded to the aircraft; drawn
    with gravity turned from -y.
    """

    def at(x: float, y: float) -> tuple[float, float]:
        z = complex(x, y) * complex(math.cos(turned), math.sin(turned))
        return z.real, z.imag

    linkage = Linkage(
        bodies=(Body("piston", 48.0, at(0, -1.0)), Body("wheel", 12.0, at(0, -1.2))),
        joints=(Joint("W", at(0, -1.2), (Connection("W", "wheel"),), "piston"),),
        driven=("strut",),
        sliders=(Slider("strut", GROUND, "piston", at(0, 0), at(0, -1.2)),),
        gravity=at(0, -G),
    )
    up, aft = axes(linkage, forward)
    return linkage, Touchdown("piston", "W", up, aft, 0, (1.2,))


def falling(linkage: Linkage, place: Touchdown) -> Landing:
    strut = Strut(GAS, STROKE, Oil(860.0, 0.006, 2.2e-4, 0.9, 1.2e-4), 300.0)
    return land(
        Drop(
            1050.0, effective_mass(linkage, place, STROKE), 2.5, PowerTyre(1.2e6, 1.25, 0.05),
            strut, WHEEL, 0.9, duration=0.4, travel=travel(linkage, place, STROKE),
        )
    )  # fmt: skip


@each(("forward", "turned"), [("left", 2.2), ("right", 0.0)])
def test_an_upright_strut_carries_what_the_fall_says(forward: str, turned: float) -> None:
    """The strut's force on the leg, the wheel's pin and the guide at every instant of the fall."""
    linkage, place = telescopic(forward, turned)
    ahead = np.array([-1.0 if forward == "left" else 1.0, 0.0])
    turn = np.array([[math.cos(turned), -math.sin(turned)], [math.sin(turned), math.cos(turned)]])
    assert np.array(place.up) == pytest.approx(turn @ [0.0, 1.0])
    assert np.array(place.aft) == pytest.approx(turn @ -ahead)
    assert effective_mass(linkage, place, STROKE) == pytest.approx(60.0)
    landing = falling(linkage, place)
    course = Course(linkage, laws(landing, place), 0.0, 0.4)
    times = np.linspace(0.0, 0.4, 41)[1:]
    found = motion_reactions("drop", course.at(times), pushes(linkage, landing, place))
    f = landing.at(times).forces
    force = f.vertical.max()
    # The slider is longer where the axle is lower: its force on the leg is downwards.
    assert found.drive[:, 0] == pytest.approx(f.along, abs=1e-8 * force)
    up, aft = np.array(place.up), np.array(place.aft)
    own = found.reactions.force("W")[:, :2]
    # The wheel falls with the axle: on its pin, its weight less what its fall takes.
    expected = -12.0 * (G - f.unsprung)
    assert own @ up == pytest.approx(expected, abs=1e-8 * force)
    assert own @ aft == pytest.approx(0.0 * times, abs=1e-8 * force)
    guided = found.sliders.normal[:, 0, None] * (turn @ [1.0, 0.0])  # left of the slider's axis
    assert guided @ aft == pytest.approx(-f.on_leg, abs=1e-8 * force)
    down = fall(course.at(times), found.applied)
    assert down == pytest.approx(np.outer(f.sprung, -up))
    assert fall(course.at(times), ()) == pytest.approx(np.zeros((40, 2)))
    (rest,) = at_deflection(landing, place, 0.1, 0.75)
    stroke = landing.at(np.array([0.1])).forces.stroke[0]
    assert rest(times[:1])[0][0] == pytest.approx(1.2 - 0.75 * stroke)


def trailing() -> tuple[Linkage, Touchdown]:
    """A trailing arm about O with a wheel at its end, which a strut holds amid the arm."""
    end = (ARM * math.cos(TILT), -ARM * math.sin(TILT))
    middle = (end[0] / 2.0, end[1] / 2.0)
    linkage = Linkage(
        bodies=(
            Body("arm", 9.0, middle, 0.2),
            Body("upper", 3.0, (0.15, 0.3), 0.02),
            Body("lower", 2.0, (0.2, 0.1), 0.01),
            Body("wheel", 12.0, end),
        ),
        joints=(
            Joint("O", (0.0, 0.0), (Connection("O", "arm"),), GROUND),
            Joint("S", middle, (Connection("S", "lower"),), "arm"),
            Joint("T", (0.1, 0.6), (Connection("T", "upper"),), GROUND),
            Joint("W", end, (Connection("W", "wheel"),), "arm"),
        ),
        driven=("strut",),
        sliders=(Slider("strut", "upper", "lower", (0.1, 0.6), middle),),
        gravity=(0.0, -G),
    )
    up, aft = axes(linkage, "left")
    return linkage, Touchdown("arm", "W", up, aft, 0, (linkage.sliders[0].drawn,))


def test_a_trailing_arm_keeps_the_momentum_of_its_fall() -> None:
    """What the fixed pins carry is the ground's force and the weights less the rate of momentum of
    all bodies, by differences of their positions in the axes of the ground.
    """
    linkage, place = trailing()
    landing = falling(linkage, place)
    course = Course(linkage, laws(landing, place), 0.0, 0.4)
    h, times = 2e-5, np.array([0.03, 0.08, 0.19, 0.27])
    sunk = {k: landing.at(times + k * h).sink_velocity for k in (-1, 1)}
    fell = {k: course.at(times + k * h).centres[1] for k in (-1, 1)}
    masses = np.array([item.mass for item in linkage.items])
    rate = sum(k * (fell[k] @ masses - 1j * sunk[k] * masses.sum()) for k in (-1, 1)) / (2.0 * h)
    found = motion_reactions("drop", course.at(times), pushes(linkage, landing, place))
    f = landing.at(times).forces
    fixed = np.sum([found.reactions.force(name)[:, :2] for name in ("O", "T")], axis=0)
    given = 1j * f.vertical + f.on_leg - 1j * G * masses.sum()  # aft is to the right
    force = float(f.vertical.max())
    assert fixed[:, 0] + 1j * fixed[:, 1] == pytest.approx(given - rate, abs=1e-4 * force)
    # The mean over the stroke of 2 T / v^2: that of the arm and wheel alone about O is constant.
    alone = (9.0 / 4.0 * ARM**2 + 0.2 + 12.0 * ARM**2) / (ARM * math.cos(TILT)) ** 2
    assert effective_mass(linkage, place, 0.01) == pytest.approx(alone, rel=0.15)


def test_a_fall_needs_gravity() -> None:
    linkage = Linkage(
        (Body("a", 1.0, (0.0, 0.0), 1.0),),
        (Joint("O", (0.0, 0.0), (Connection("O", "a"),), GROUND),),
        ("a",),
        turns=(Turn("a", "a", 0.0),),
    )
    with raises(ArgumentError, "no-gravity", "which says where up is"):
        axes(linkage, "left")

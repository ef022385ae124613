"""Linkages for tests: four-bars and slider-cranks of any proportions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from loads import GROUND, Body, Connection, Joint, Linkage, Sharing, Slider, Turn


def circles(p: complex, a: float, q: complex, b: float, side: float) -> complex:
    """Return the point at distances a from p and b from q, left (side 1) or right (-1) of
    p to q.
    """
    d = abs(q - p)
    along = (a * a - b * b + d * d) / (2.0 * d)
    return complex(p + (q - p) / d * (along + 1j * side * np.sqrt(a * a - along * along)))


def xy(z: complex) -> tuple[float, float]:
    return (float(z.real), float(z.imag))


def four_bar(
    ground: float = 1.0,
    crank: float = 0.4,
    coupler: float = 0.9,
    rocker: float = 0.8,
    angle: float = 0.9,
    side: float = 1.0,
    gravity: tuple[float, float] = (0.0, -9.81),
) -> Linkage:
    """Return a crank on O2 at the origin and a rocker on O4 at (ground, 0); floating pins of 0.1
    and 0.2 kg.
    """
    a = crank * np.exp(1j * angle)
    b = circles(a, coupler, ground, rocker, side)
    o4 = complex(ground)
    return Linkage(
        bodies=(
            Body("crank", 2.0, xy(0.5 * a), 0.03),
            Body("coupler", 3.0, xy(0.5 * (a + b) + 0.05j), 0.2),
            Body("rocker", 1.5, xy(0.4 * b + 0.6 * o4), 0.1),
        ),
        joints=(
            Joint("O2", (0.0, 0.0), (Connection("F12", "crank"),), GROUND),
            Joint("A", xy(a), (Connection("A2", "crank"), Connection("A3", "coupler")), None, 0.1),
            Joint("B", xy(b), (Connection("B3", "coupler"), Connection("B4", "rocker")), None, 0.2),
            Joint("O4", xy(o4), (Connection("F14", "rocker"),), GROUND),
        ),
        driven=("crank",),
        turns=(Turn("crank", "crank", angle),),
        gravity=gravity,
    )


def slider_crank(
    crank: float = 0.1,
    rod: float = 0.3,
    offset: float = 0.0,
    angle: float = 0.7,
    friction: float = 0.0,
    bearing: float | None = None,
    masses: tuple[float, float, float] = (1.0, 0.8, 0.5),
    gravity: tuple[float, float] = (0.0, 0.0),
) -> Linkage:
    """Return a crank on O at the origin with a block on the ground along x at y = offset; all pins
    are massless and fixed in the outer ends of the crank and the rod.
    """
    a = crank * np.exp(1j * angle)
    c = complex(a.real + np.sqrt(rod**2 - (a.imag - offset) ** 2), offset)
    return Linkage(
        bodies=(
            Body("crank", masses[0], xy(0.3 * a), 0.002 * masses[0]),
            Body("rod", masses[1], xy(0.6 * a + 0.4 * c), 0.01 * masses[1]),
            Body("block", masses[2], xy(c), None),
        ),
        joints=(
            Joint("O", (0.0, 0.0), (Connection("O", "crank"),), GROUND),
            Joint("A", xy(a), (Connection("A", "rod"),), "crank"),
            Joint("C", xy(c), (Connection("C", "rod"),), "block"),
        ),
        driven=("crank",),
        sliders=(
            Slider("guide", GROUND, "block", (0.0, offset), xy(c), (1.0, 0.0), friction, bearing),
        ),
        turns=(Turn("crank", "crank", angle),),
        gravity=gravity,
    )


def coupled_wheels(*stiffness: float) -> Linkage:
    """Return a parallelogram with a third, redundant crank, so that the forces need a rule of
    sharing.
    """
    linkage = four_bar(1.0, 0.5, 1.0, 0.5, angle=1.0)
    return replace(
        linkage,
        bodies=(*linkage.bodies, Body("third", 1.0, (0.5, 0.3), 0.05)),
        joints=(
            *linkage.joints,
            Joint("O5", (0.5, 0.4), (Connection("F15", "third"),), GROUND),
            Joint(
                "D",
                (0.5 + 0.5 * np.cos(1.0), 0.4 + 0.5 * np.sin(1.0)),
                (Connection("D5", "third"),),
                "coupler",
            ),
        ),
        sharing=(Sharing(("F12", "F14", "F15"), stiffness),),
    )

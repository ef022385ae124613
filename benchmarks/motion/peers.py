"""The motions for which other codes are compared with ours, and the result of each code."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, radians, sqrt

import numpy as np

from benchmarks import ROOT
from loads import (
    GROUND,
    Body,
    Connection,
    CycloidalDrive,
    Joint,
    Law,
    Linkage,
    Turn,
    motion_reactions,
    move,
)
from loads.linkage.parts import Point
from pinbase.arrays import Floats
from pinstress import load_study
from pinstress.study.model.mechanism.drives import laws, span
from pinstress.study.model.mechanism.linkage import linkage

STUDY = ROOT / "studies" / "grenier2008.toml"
INCH, POUND = 0.0254, 0.45359237


@dataclass(frozen=True)
class Case:
    """A linkage with one drive, at rest as drawn and then moved.

    times: T instants to compare, s, equally spaced. The start is not among them, because the other
    codes begin with a transient.
    """

    name: str
    linkage: Linkage
    law: Law
    times: Floats

    def drive(self, time: float) -> tuple[float, float, float]:
        """Return the travel of the drive from the drawn position, its rate and second rate."""
        value, rate, second = (float(x[0]) for x in self.law(np.array([time])))
        return value - self.linkage.drives[0].drawn, rate, second


@dataclass(frozen=True)
class Found:
    """A result. forces: (T, C, 2) on the pins in world axes, N. drive: (T,), N or N m."""

    forces: Floats
    drive: Floats


@dataclass(frozen=True)
class Code:
    """Another code.

    solve: solves a case with a number of steps from one instant to the next.
    steps: the numbers to try, each twice the one before.
    shares: whether the code follows our rule where connections share a force.
    """

    name: str
    solve: Callable[[Case, int], Found]
    steps: tuple[int, ...]
    shares: bool


def ours(case: Case) -> Found:
    """Return the result of pinstress."""
    found = motion_reactions(case.name, move(case.linkage, [case.law], case.times))
    return Found(found.reactions.forces[..., :2], found.drive[:, 0])


def landing_gear() -> Case:
    """Return the retract motion of studies/grenier2008.toml, driven by a slider under gravity."""
    study = load_study(STUDY)
    (law,) = laws(study)
    return Case("landing gear", linkage(study), law, _instants(span(study)))


def four_bar() -> Case:
    """Return Bowman's crank and rocker (2019) from 236.09 to 360 degrees in 5 s, without
    gravity.
    """
    start = radians(236.09)
    crank_pin = 12.0 * np.exp(1j * start)
    pivot = complex(-32.0, 0.0)
    tip = _dyad(pivot, crank_pin, 26.0, 30.0)
    drawn = Linkage(
        bodies=(
            _bar("crank", 42.8, 513.6, 0j, crank_pin),
            _bar("coupler", 107.1, 8032.5, crank_pin, tip),
            _bar("rocker", 92.8, 5227.7, pivot, tip),
        ),
        joints=(
            Joint("O2", _metres(0j), (Connection("O2", "crank"),), GROUND),
            Joint("A", _metres(crank_pin), (Connection("A", "coupler"),), "crank"),
            Joint("B", _metres(tip), (Connection("B", "coupler"),), "rocker"),
            Joint("O4", _metres(pivot), (Connection("O4", "rocker"),), GROUND),
        ),
        driven=("crank",),
        turns=(Turn("crank", "crank", start),),
    )
    return Case("four-bar", drawn, CycloidalDrive(start, 2.0 * pi, 5.0), _instants(5.0))


def _instants(duration: float) -> Floats:
    return np.linspace(0.0, duration, 41)[1:]


def _metres(z: complex) -> Point:
    return float(z.real) * INCH, float(z.imag) * INCH


def _bar(name: str, pounds: float, inertia: float, start: complex, end: complex) -> Body:
    return Body(name, pounds * POUND, _metres(0.5 * (start + end)), inertia * POUND * INCH**2)


def _dyad(first: complex, second: complex, from_first: float, from_second: float) -> complex:
    """Return the point at these distances from two others, to the right of the line from the first
    to the second.
    """
    line = second - first
    along = (abs(line) ** 2 + from_first**2 - from_second**2) / (2.0 * abs(line))
    return first + line / abs(line) * (along - 1j * sqrt(from_first**2 - along**2))

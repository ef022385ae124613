"""The forces on the pins in an animation: arrows, table, number formats."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pinbase.dimensions import Floats
from reports.animation.frames import nice
from reports.animation.scene import APPLIED_GAP, Scene
from reports.data.mechanics import DriveTable
from reports.data.row import Units
from reports.format.numbers import DASH, short, ten_to

DIGITS_OF_LARGEST = 4  # of a changing value; all instants share its number of decimals
ARROW_HEAD_LENGTH = 10.0  # length of an arrow's head
KEY_ARROW_SHARE = 0.45  # of the largest force, about; the arrow in the key


@dataclass(frozen=True)
class Arrow:
    """The arrow of a force at the first frame.

    at: its tail on the picture.
    length: on the picture.
    angle: its direction, degrees clockwise from x.
    """

    colour: str
    at: tuple[float, float]
    length: float
    angle: float

    @property
    def head(self) -> float:
        """The length of the head, which shrinks with a short arrow."""
        return min(ARROW_HEAD_LENGTH, 0.6 * self.length)


def arrows(scene: Scene) -> list[Arrow]:
    """Return an arrow for each connection, with a length proportional to its force."""
    shown_arrows = []
    forces = scene.projection(scene.forces[0]).tolist()
    for c, ((fx, fy), joint) in enumerate(zip(forces, scene.tails, strict=True)):
        x, y = scene.joints[0, joint].tolist()
        length = scene.longest * float(np.hypot(fx, fy)) / (scene.largest or 1.0)
        colour = scene.colour(scene.skeleton.connections[c][1])
        shown_arrows.append(Arrow(colour, (x, y), length, float(np.degrees(np.arctan2(-fy, fx)))))
    return shown_arrows


def applied_arrows(scene: Scene) -> list[tuple[Arrow, float]]:
    """Return for each applied force its arrow, which ends just before its point, and its
    magnitude.
    """
    return [_ending(scene, *load, scene.largest) for load in scene.applied]


def couple_arrows(scene: Scene) -> list[tuple[Arrow, float]]:
    """Return for each applied couple its arrow, about which it turns, and its magnitude."""
    return [_ending(scene, *load, scene.largest_couple) for load in scene.couples]


def _ending(scene: Scene, at: Floats, force: Floats, largest: float) -> tuple[Arrow, float]:
    """Return the arrow of a load, which ends just before its point, at the first frame, and its
    magnitude.

    at, force: (F, 3) over the frames.
    largest: the largest load of this kind.
    """
    (x, y), (fx, fy) = scene.seen(at[0]).tolist(), scene.projection(force[0]).tolist()
    size, shown = float(np.linalg.norm(force[0])), float(np.hypot(fx, fy))
    length = scene.longest * shown / (largest or 1.0)
    if shown > 0.0:
        back = length + APPLIED_GAP
        x, y = x - back * fx / shown, y + back * fy / shown
    angle = float(np.degrees(np.arctan2(-fy, fx)))
    return Arrow("plain", (x, y), length, angle), size


def key(scene: Scene) -> tuple[float, Arrow] | None:
    """Return a round force and its arrow for the key; None if no force acts."""
    if not scene.largest > 0.0:
        return None
    force = nice(KEY_ARROW_SHARE * scene.largest)
    return force, Arrow("plain", (0.0, -24.0), scene.longest * force / scene.largest, 0.0)


@dataclass(frozen=True)
class Shown:
    """The number formats of the forces, the couples, and each drive's position and force."""

    force: Fixed
    couple: Fixed
    drives: list[tuple[Fixed, Fixed]]

    @staticmethod
    def of(scene: Scene, drives: list[DriveTable], units: Units) -> Shown:
        pairs = []
        for d in drives:
            rotary = d.kind == "rotary"
            torque = f"{units.force}·{units.length}"
            pairs.append(
                (
                    Fixed.of(d.position, "°" if rotary else units.length),
                    Fixed.of(d.force, torque if rotary else units.force),
                )
            )
        couple = Fixed.of(np.array([scene.largest_couple]), f"{units.force}·{units.length}")
        return Shown(Fixed.of(np.array([scene.largest]), units.force), couple, pairs)


@dataclass(frozen=True)
class ForceRow:
    """A connection in the table: its values at the first frame, its largest force and the time of
    it.
    """

    name: str
    body: str
    joint: int
    colour: str
    components: list[str]
    force: str
    largest: str
    when: str


def rows(scene: Scene, shown: Shown) -> list[ForceRow]:
    """Return a row for each connection, in the order of the joints."""
    table = scene.table
    if table is None:
        return []
    peaks, first, force_rows = table.largest, scene.instants[0], []
    for c, (name, body, _) in enumerate(scene.skeleton.connections):
        components = [shown.force(v) for v in scene.forces[0, c, : len(scene.axes)].tolist()]
        peak, when = peaks[c].force, peaks[c].time
        force_rows.append(
            ForceRow(
                name,
                body,
                scene.tails[c],
                scene.colour(body),
                components,
                shown.force(float(table.magnitudes[first, c])),
                shown.force(peak),
                "" if when is None else short(float(f"{when:.4g}")),
            )
        )
    return force_rows


@dataclass(frozen=True)
class Fixed:
    """The format of a quantity: divided by `factor`, in `unit`, with a fixed number of decimals."""

    unit: str
    factor: float
    decimals: int

    @staticmethod
    def of(values: Floats, unit: str) -> Fixed:
        """Return the format with four digits for the largest value.

        Very large and very small numbers have a power of ten in the unit.
        """
        largest = float(np.max(np.abs(values[np.isfinite(values)]), initial=0.0))
        if largest == 0.0:
            return Fixed(unit, 1.0, 0)
        size = math.floor(math.log10(largest))
        power = 0 if -2 <= size < 6 else 3 * (size // 3)
        heading = unit if power == 0 else f"{ten_to(power)} {unit}"
        return Fixed(heading, 10.0**power, max(DIGITS_OF_LARGEST - 1 - (size - power), 0))

    def __call__(self, value: float) -> str:
        if not math.isfinite(value):
            return DASH
        text = f"{value / self.factor:,.{self.decimals}f}"
        return text.removeprefix("-") if not text.strip("-0.,") else text.replace("-", "−")

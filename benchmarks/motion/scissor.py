"""The cost of motion, forces and their maxima by the number of bodies: scissor lifts of many
stages.
"""

from __future__ import annotations

import resource
import time

import numpy as np

from benchmarks.timing import table
from loads import (
    GROUND,
    Body,
    Connection,
    Course,
    CycloidalDrive,
    Joint,
    Linkage,
    Slider,
    motion_reactions,
    over_time,
)
from loads.linkage.parts import Point

BAR = 2.0  # m
LOW, HIGH, SPAN = 1.9, 1.3, 4.0  # first and last distance of the feet, m; duration, s
CASES = ((2, 20_000), (10, 20_000), (50, 20_000))  # stages, instants


def lift(stages: int) -> Linkage:
    """Return a scissor lift with 2 stages + 3 bodies, driven at its sliding foot."""
    height = float(np.sqrt(BAR**2 - LOW**2))

    def at(x: float, level: float) -> Point:
        return x * LOW, level * height

    inertia = 20.0 * BAR**2 / 12.0
    bodies = [Body("foot", 4.0, at(1, 0), 0.01), Body("roller", 4.0, at(1, stages), 0.01)]
    bodies.append(Body("platform", 150.0, at(0.5, stages), 40.0))
    joints = [
        Joint("O", at(0, 0), (Connection("O", "a0"),), GROUND),
        Joint("S", at(1, 0), (Connection("S", "b0"),), "foot"),
    ]
    for k in range(stages):
        bodies += [Body(f"{name}{k}", 20.0, at(0.5, k + 0.5), inertia) for name in "ab"]
        joints.append(Joint(f"M{k}", at(0.5, k + 0.5), (Connection(f"M{k}", f"b{k}"),), f"a{k}"))
        last = k == stages - 1
        left, right = ("platform", "roller") if last else (f"a{k + 1}", f"b{k + 1}")
        joints.append(Joint(f"L{k}", at(0, k + 1), (Connection(f"L{k}", left),), f"b{k}"))
        joints.append(Joint(f"R{k}", at(1, k + 1), (Connection(f"R{k}", right),), f"a{k}"))
    sliders = (
        Slider("drive", GROUND, "foot", at(0, 0), at(1, 0)),
        Slider("top", "platform", "roller", at(0, stages), at(1, stages)),
    )
    return Linkage(tuple(bodies), tuple(joints), ("drive",), sliders, gravity=(0.0, -9.81))


def scissor() -> str:
    """Return the times of path, motion and forces, and maxima, and the largest memory."""
    head = ("bodies", "instants", "path, s", "motion and forces, s", "ms an instant", "maxima, s")
    rows = [_row(*case) for case in CASES]
    return table((*head, "memory, MB"), rows)


def _row(stages: int, instants: int) -> tuple[object, ...]:
    linkage = lift(stages)
    marks = [time.perf_counter()]
    course = Course(linkage, [CycloidalDrive(LOW, HIGH, SPAN)], 0.0, SPAN)
    marks.append(time.perf_counter())
    times = np.linspace(0.0, SPAN, instants)
    found = motion_reactions("lift", course.at(times))
    marks.append(time.perf_counter())
    over_time(course, lambda t: motion_reactions("lift", course.at(t)), found)
    marks.append(time.perf_counter())
    path, solved, maxima = np.diff(marks).tolist()
    memory = f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0:.0f}"
    each = 1e3 * solved / instants
    return len(linkage.bodies), f"{instants:,}", path, solved, each, maxima, memory

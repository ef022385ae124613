"""Results of made-up linkages whose positions are known in closed form."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from pinbase.dimensions import Floats
from reports.data.mechanics import DriveTable, ReactionTable
from reports.data.motion import LinkageMotion, PowerLedger
from reports.data.results import Results
from reports.data.row import Units

CRANK, COUPLER, ROCKER, BASE = 1.0, 3.5, 3.0, 4.0


def four_bar(count: int = 181) -> Results:
    """Return the results of a crank that turns once in 3 s, with made-up forces; C is found by the
    cosine rule.
    """
    time = np.linspace(0.0, 3.0, count)
    turn = 2.0 * np.pi * time / 3.0
    a, d = np.zeros((count, 2)), np.tile([BASE, 0.0], (count, 1))
    b = CRANK * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    to_b = b - d
    far = np.linalg.norm(to_b, axis=1)
    at_d = np.arccos((ROCKER**2 + far**2 - COUPLER**2) / (2.0 * ROCKER * far))
    slope = np.arctan2(to_b[:, 1], to_b[:, 0]) - at_d
    c = d + ROCKER * np.stack([np.cos(slope), np.sin(slope)], axis=1)
    size = 100.0 + 50.0 * np.sin(turn)
    forces = np.zeros((count, 3, 3))
    forces[:, :, 0] = size[:, None] * [1.0, -1.0, 0.5]
    forces[:, :, 1] = 40.0 * np.cos(turn)[:, None]
    table = ReactionTable(
        "turn", time, np.degrees(turn), ("F12", "F23", "F34"), ("ground", "crank", "coupler"),
        ("A", "B", "C"), forces, np.zeros_like(forces),
    )  # fmt: skip
    drive = DriveTable(
        "turn", time, np.degrees(turn), 0.0 * time + 2.0, 0.0 * time, size, 2.0 * size,
        2.0 * size * time, 0.0 * time, 0.0 * time, "crank", "rotary",
    )  # fmt: skip
    motion = linkage("turn", time, ("A", "B", "C", "D"), np.stack([a, b, c, d], axis=1))
    return Results(
        "Four-bar", "s.toml", "0", Units("mm", "N", "MPa", "s"), None, 0.02, (),
        reactions=(table,), drive=(drive,), motion=(motion,),
    )  # fmt: skip


def linkage(case: str, time: Floats | None, joints: tuple[str, ...], at: Floats) -> LinkageMotion:
    """Return the motion of a chain of bars between joints at (T, J, 2), the first and last of which
    are on the ground.
    """
    bodies = ("crank", "coupler", "rocker", *(f"link {k}" for k in range(4, len(joints))))
    count, shape = len(at), (len(at), len(joints) - 1)
    centre = 0.5 * (at[:, 1:] + at[:, :-1])
    still, zero = np.zeros((*shape, 2)), np.zeros(count)
    return LinkageMotion(
        case=case,
        time=time,
        bodies=bodies[: len(joints) - 1],
        links=tuple(pairwise(joints)),
        centre=centre,
        velocity=still,
        acceleration=still,
        angle=np.zeros(shape),
        angular_velocity=np.zeros(shape),
        angular_acceleration=np.zeros(shape),
        joints=joints,
        ground=(joints[0], joints[-1]),
        joint_position=at,
        joint_velocity=np.zeros_like(at),
        joint_acceleration=np.zeros_like(at),
        slides={},
        connections=tuple(
            (f"F{j + 1}{j + 2}", ("ground", *bodies)[j], joints[j])
            for j in range(len(joints) - 1)
        ),
        transmission={"coupler at C": np.full(count, 60.0)},
        condition=np.full(count, 2.0),
        shaking_force=np.zeros((count, 2)),
        shaking_moment=zero,
        shaking_about=joints[0],
        ledger=PowerLedger(zero, zero, zero, zero, zero, 0.0),
    )  # fmt: skip


def chain(joints: int, count: int) -> Results:
    """Return the results of many bars in a row, each joint moving on its own circle."""
    time = np.linspace(0.0, 40.0, count)
    j = np.arange(joints)
    phase = 0.3 * time[:, None] + j
    at = np.stack([3.0 * j + np.sin(phase), np.cos(phase)], axis=2)
    names = tuple(f"joint {k}" for k in j)
    motion = linkage("sweep", time, names, at)
    forces = np.stack([np.sin(phase), np.cos(2.0 * phase), 0.0 * phase], axis=2)[:, :-1]
    forces *= 1e6 * (1.0 + np.exp(-(((time - 17.3) / 0.02) ** 2)))[:, None, None]
    connections = tuple(name for name, _, _ in motion.connections)
    table = ReactionTable(
        "sweep", time, None, connections, tuple(b for _, b, _ in motion.connections),
        names[:-1], forces, np.zeros_like(forces),
    )  # fmt: skip
    return replace(four_bar(3), reactions=(table,), drive=(), motion=(motion,))

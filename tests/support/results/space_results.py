"""Results of made-up linkages in space whose positions are known in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pinbase.dimensions import Floats
from reports.data.mechanics import DriveTable, ReactionTable
from reports.data.motion import AppliedForce
from reports.data.results import Results
from reports.data.row import Units
from reports.data.skeleton import Skeleton

FOLD_AXIS = np.array([0.9, 0.4, 0.1]) / np.linalg.norm([0.9, 0.4, 0.1])
FOLD_ANGLE = 1.4  # rad
AS_DRAWN = {  # mm
    "trunnion aft": (0.0, 0.0, 0.0),
    "trunnion fwd": tuple((400.0 * FOLD_AXIS).tolist()),
    "stay lug": (200.0, 90.0, -600.0),
    "axle": (180.0, 60.0, -1500.0),
}
STAY_END = (150.0, 1000.0, -50.0)


def turned(point: Floats, axis: Floats, angle: Floats) -> Floats:
    """Return a point (3,) turned about an axis through the origin by angles (T,), by Rodrigues'
    formula, (T, 3).
    """
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return np.asarray(c * point + s * np.cross(axis, point) + (1.0 - c) * (axis @ point) * axis)


def landing_gear(count: int = 61) -> Results:
    """Return a leg that folds about a skewed axis in 6 s, on a side stay that shortens, with its
    wheel.
    """
    time = np.linspace(0.0, 6.0, count)
    angle = 0.5 * FOLD_ANGLE * (1.0 - np.cos(np.pi * time / 6.0))
    at = {name: turned(np.array(p), FOLD_AXIS, angle) for name, p in AS_DRAWN.items()}
    at["stay root"] = np.tile(STAY_END, (count, 1))
    joints = tuple(at)
    axle = turned(np.array([0.0, 1.0, 0.0]), FOLD_AXIS, angle)
    axes = np.zeros((count, len(joints), 3))
    axes[:, :2], axes[:, 3] = FOLD_AXIS, axle
    wheel = at["axle"] + 160.0 * axle
    size = 30000.0 + 5000.0 * np.sin(time)
    load = AppliedForce("wheel", wheel, size[:, None] * np.array([-0.25, 0.3, 1.0]))
    position = np.stack(list(at.values()), axis=1)
    skeleton = Skeleton(
        case="retract",
        time=time,
        bodies=("leg", "wheel", "stay"),
        links=(("trunnion aft", "trunnion fwd", "stay lug", "axle"), ("axle",), ("stay lug",)),
        centre=np.stack([position[:, :4].mean(axis=1), wheel, at["stay lug"]], axis=1),
        joints=joints,
        ground=("trunnion aft", "trunnion fwd", "stay root"),
        position=position,
        axes=axes,
        connections=(
            ("aft", "leg", "trunnion aft"),
            ("fwd", "leg", "trunnion fwd"),
            ("lug", "stay", "stay lug"),
            ("wheel", "wheel", "axle"),
            ("root", "stay", "stay root"),
        ),
        stems=("wheel",),
        slides={"stay": np.stack([at["stay root"], at["stay lug"]], axis=1)},
        applied=(load,),
    )
    along = at["stay lug"] - at["stay root"]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    stay = 22000.0 * np.cos(0.3 * time)[:, None] * along
    forces = np.stack([-0.6 * load.force, -0.4 * load.force - stay, stay, load.force, stay], axis=1)
    table = ReactionTable(
        "retract", time, np.degrees(angle), tuple(c for c, _, _ in skeleton.connections),
        tuple(b for _, b, _ in skeleton.connections), ("T", "U", "V", "W", "X"), forces,
        np.zeros_like(forces),
    )  # fmt: skip
    drive = DriveTable(
        "retract", time, np.degrees(angle), 0.0 * time + 0.2, 0.0 * time, 9e5 + size, 2.0 * size,
        2.0 * size * time, 0.0 * time, 0.0 * time, "fold", "rotary",
    )  # fmt: skip
    return Results(
        "Main gear", "s.toml", "0", Units("mm", "N", "MPa", "s"), None, 0.02, (),
        reactions=(table,), drive=(drive,), space=(skeleton,),
    )  # fmt: skip


def rssr(count: int = 73) -> Results:
    """Return a crank that turns about z and a rocker that swings about x, joined by a rod with two
    balls.

    With the rod's length known, the rocker's angle follows from A cos + B sin = C.
    """
    crank, rod, rocker, base = 40.0, 140.0, 90.0, np.array([60.0, 110.0, 20.0])
    time = np.linspace(0.0, 2.0, count)
    turn = np.pi * time
    zero = np.zeros((count, 3))
    p = crank * np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    away = base - p
    a, b = 2.0 * rocker * away[:, 1], 2.0 * rocker * away[:, 2]
    c = rod**2 - rocker**2 - (away**2).sum(axis=1)
    swing = np.arctan2(b, a) + np.arccos(c / np.hypot(a, b))
    q = base + rocker * np.stack([0.0 * swing, np.cos(swing), np.sin(swing)], axis=1)
    position = np.stack([zero, p, q, base + zero], axis=1)
    axes = np.zeros_like(position)
    axes[:, 0, 2] = axes[:, 3, 0] = 1.0
    skeleton = Skeleton(
        case="turn", time=time, bodies=("crank", "rod", "rocker"),
        links=(("A", "P"), ("P", "Q"), ("Q", "B")),
        centre=0.5 * (position[:, 1:] + position[:, :-1]), joints=("A", "P", "Q", "B"),
        ground=("A", "B"), position=position, axes=axes,
        connections=(
            ("A", "crank", "A"), ("P", "rod", "P"), ("Q", "rod", "Q"), ("B", "rocker", "B"),
        ),
    )  # fmt: skip
    return replace(landing_gear(2), reactions=(), drive=(), space=(skeleton,))

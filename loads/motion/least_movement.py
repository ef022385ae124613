"""The least movement of joints by which the loops of a redundant linkage close in motion.

Any drawing closes in its own position. Redundant links, such as the third crank of a parallelogram,
let a body move only if their lengths are consistent; dimensions from a drawing with tolerances are
not consistent. The joints are moved so that all loops close at sampled positions of the drives,
with the least sum of squares of the movements. Loop equations are analytic, so loops that close
over a range of a drive also close beyond that range.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from loads.linkage.linkage import Linkage
from loads.linkage.parts import Point
from loads.motion.planar_equations import PlanarEquations
from pinbase.arrays import Floats

Draw = Callable[[Mapping[str, Point]], Linkage]

MIN_RANGE = 0.5  # rad (or length scales) to either side of the drawing over which loops must close
MAX_SAMPLE_STEP = 0.2  # rad (or length scales) of the drives between samples
MIN_SAMPLES, MAX_SAMPLES = 6, 48  # samples on the way of the drives to each end of their range
MIN_SINGULAR_RATIO = 0.05  # smallest to largest singular value; below it a dead point is near
# Up to this number of drives all combinations of their ends are sampled; for more drives only all
# low ends and all high ends.
MAX_CORNERS = 3
DIFFERENCE = 1e-4  # length scales by which a joint is moved for a derivative; gaps are linear in it
MAX_STEPS = 60
# Conditions that become dependent where the loops close have singular values of the order of the
# remaining gap. The damping (a squared singular value) therefore follows the gap, and falls by at
# least this ratio in each step.
DAMPING_RATIO = 0.3
MIN_DAMPING = 1e-16  # squared singular value; derivatives by differences have errors of 1e-12
SETTLED_MOVE = 1e-12  # last correction of the coordinates, over the length scale
CLOSED_GAP = 3e-12  # gap of a closed loop, over the length scale; a motion is refused at 1e-11


@dataclass(frozen=True)
class LeastMovement:
    """The least movement of joints with which the loops close.

    moves: movement (dx, dy) of every joint, m.
    gap: largest distance by which the members that close loops miss each other as drawn, with the
    coordinates that fit best, m.
    members: names of the members that miss each other.
    """

    moves: Mapping[str, Point]
    gap: float
    members: tuple[str, ...]

    @property
    def largest(self) -> float:
        """The largest movement of a joint, m."""
        return max(float(np.hypot(*move)) for move in self.moves.values())


def least_movement(
    draw: Draw, at: Mapping[str, Point], reach: tuple[Floats, Floats]
) -> LeastMovement | None:
    """The least movement of joints by which the loops close, or None where none is found.

    The joints move by Gauss-Newton steps, in which damping keeps their movement least. After each
    step the coordinates of all samples are fitted again.

    draw: returns the linkage with its joints at given places.
    at: places of the joints as drawn, m.
    reach: (D,) least and largest values of the drives, m or rad.
    """
    names, places = list(at), np.array(list(at.values()))
    loops = PlanarEquations(draw(at))
    scale = loops.linkage.length_scale
    ways = _ways(loops, reach)
    if not ways:  # a structure, or a drawing at a dead point
        return LeastMovement(dict.fromkeys(at, (0.0, 0.0)), 0.0, ())
    drives = np.concatenate([drives for drives, _ in ways])
    q = np.concatenate([q for _, q in ways])
    widest = int(np.abs(_rows(loops, q, drives)[:, : loops.guides]).max(axis=1).argmax())
    members, gap = loops.apart(q[widest], drives[widest])
    moves, damping = np.zeros(places.size), 1.0
    for _ in range(MAX_STEPS):
        # The conditions, linear in the movements: A (moves - old moves) + open_by = 0.
        A, open_by = _conditions(draw, loops, names, places + moves.reshape(-1, 2), (q, drives))
        wide = float(np.abs(open_by).max(initial=0.0)) / scale
        if wide <= CLOSED_GAP:
            return LeastMovement(_at(names, moves.reshape(-1, 2)), gap, members)
        # Least squares with damping of the whole movement, which keeps it least.
        damping = max(min(wide, DAMPING_RATIO * damping), MIN_DAMPING)
        weight = np.sqrt(damping) * np.eye(moves.size)
        side = np.append(A @ moves - open_by, np.zeros(moves.size))
        moves = np.linalg.lstsq(np.concatenate([A, weight]), side, rcond=None)[0]
        # Fit the coordinates of all samples to the moved joints.
        loops = PlanarEquations(draw(_at(names, places + moves.reshape(-1, 2))))
        if (settled := _settled(loops, q, drives)) is None:
            return None
        q = settled
    return None


def _at(names: list[str], places: Floats) -> dict[str, Point]:
    return {name: (float(x), float(y)) for name, (x, y) in zip(names, places, strict=True)}


def _ways(loops: PlanarEquations, reach: tuple[Floats, Floats]) -> list[tuple[Floats, Floats]]:
    """Samples on straight ways from the drawing to the ends of the drives' range.

    Each way has the values (K, D) of the drives and the coordinates (K, n) that close the loops
    best. It ends early near a dead point, or where no such coordinates are found.
    """
    drawn, scale = loops.drawn_drives, loops.linkage.length_scale
    margin = MIN_RANGE * scale / loops.drive_scale
    low, high = np.minimum(reach[0], drawn - margin), np.maximum(reach[1], drawn + margin)
    count = len(drawn)
    ends = product((0.0, 1.0), repeat=count) if count <= MAX_CORNERS else [(0.0,) * count] * 2
    corners = [low + np.array(end) * (high - low) for end in ends] if count else []
    if count > MAX_CORNERS:
        corners[1] = high
    ways = []
    # Follow the straight way to each corner in equal steps; each sample starts from the one before.
    for corner in corners:
        longest = float(np.abs((corner - drawn) * loops.drive_scale).max()) / scale
        steps = int(np.clip(np.ceil(longest / MAX_SAMPLE_STEP), MIN_SAMPLES, MAX_SAMPLES))
        q, line = np.zeros((1, loops.columns)), list[Floats]()
        drives = drawn + np.linspace(0.0, 1.0, steps + 1)[1:, None] * (corner - drawn)
        for values in drives:
            if (settled := _settled(loops, q, values[None])) is None:
                break
            singular = np.linalg.svd(_slopes(loops, settled), compute_uv=False)[0]
            if singular[-1] < MIN_SINGULAR_RATIO * singular[0]:
                break
            q = settled
            line.append(q[0])
        if line:
            ways.append((drives[: len(line)], np.array(line)))
    return ways


def _rows(loops: PlanarEquations, q: Floats, drives: Floats) -> Floats:
    """Gaps of the members that close loops (x, then y), then of teeth and drives, (K, rows) m."""
    pose = loops.pose(q)
    gap = loops.place(pose, loops.gaps)
    fixed = loops.residual(q, pose, drives)[:, 2 * len(loops.closing) :]
    return np.concatenate([gap.real, gap.imag, fixed], axis=1)


def _slopes(loops: PlanarEquations, q: Floats) -> Floats:
    """Derivatives of the rows by the scaled coordinates, (K, rows, n)."""
    pose = loops.pose(q)
    gaps = np.swapaxes(loops.partials(pose, loops.gaps) / loops.scale[:, None], 1, 2)
    fixed = loops.jacobian(pose)[:, 2 * len(loops.closing) :]
    return np.concatenate([gaps.real, gaps.imag, fixed], axis=1)


def _settled(loops: PlanarEquations, q: Floats, drives: Floats) -> Floats | None:
    """Coordinates (K, n) with the least rows by the Gauss-Newton method; None where it fails."""
    for _ in range(MAX_STEPS):
        x = -np.linalg.pinv(_slopes(loops, q)) @ _rows(loops, q, drives)[..., None]
        q = q + x[..., 0] / loops.scale
        if np.abs(x).max() <= SETTLED_MOVE * loops.linkage.length_scale:
            return q
        if not np.abs(x).max() <= loops.linkage.length_scale:
            break
    return None


def _conditions(
    draw: Draw,
    loops: PlanarEquations,
    names: list[str],
    places: Floats,
    samples: tuple[Floats, Floats],
) -> tuple[Floats, Floats]:
    """The conditions on the places (J, 2) of the joints under which the loops close at all samples.

    A condition is a combination of rows that no change of the coordinates affects. Returns the
    derivatives of the conditions by the places, (conditions, 2 J), and the distances by which they
    are open, (conditions,) m.
    """
    q, drives = samples
    rows = _rows(loops, q, drives)
    step = DIFFERENCE * loops.linkage.length_scale
    by_place = np.empty((*rows.shape, places.size))
    for k in range(places.size):
        moved = places.copy()
        moved.flat[k] += step
        other = PlanarEquations(draw(_at(names, moved)))
        by_place[..., k] = (_rows(other, q, drives) - rows) / step
    # Left null vectors of the slopes combine rows so that coordinates have no effect.
    left = np.swapaxes(np.linalg.svd(_slopes(loops, q))[0][:, :, loops.columns :], 1, 2)
    A = left @ by_place
    return A.reshape(-1, places.size), (left @ rows[..., None]).ravel()

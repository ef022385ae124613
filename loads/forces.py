"""Newton-Euler for every body and pin, at all instants at once.

The equations of motion are J^T f = M a - Q: the transposed constraint Jacobian times the forces of
all connections, sliders and the drive. With more connections than equations the forces along the
null vectors of J^T are not determined by rigid-body statics; the linkage's sharing rule does it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.constraints import Constraints
from loads.linkage import Floats, Linkage, LinkageError, Point
from loads.mobility import require_determined
from loads.motion import Motion, at_rest
from loads.reactions import Reactions


@dataclass(frozen=True)
class Applied:
    """A constant force (N, world axes) on a body's point (m, as drawn)."""

    body: str
    at: Point
    force: Point


@dataclass(frozen=True)
class Dynamics:
    """Reactions with what goes along: drive (T,) N, pushing the slider longer; the motion itself;
    shared: connections whose forces follow the sharing rule.
    """

    reactions: Reactions
    drive: Floats
    motion: Motion
    shared: tuple[str, ...]

    @property
    def power(self) -> Floats:
        """Power of the drive, (T,) W."""
        return self.drive * self.motion.speed

    @property
    def work(self) -> Floats:
        """Work of the drive since the first instant, (T,) J: the integral of a cubic spline."""
        from scipy.interpolate import CubicSpline

        times = self.motion.times
        if len(times) < 2:
            return np.zeros(len(times))
        return np.asarray(CubicSpline(times, self.power).antiderivative()(times))


def motion_reactions(case: str, motion: Motion) -> Dynamics:
    """Reactions of a driven motion under gravity."""
    return _reactions(case, motion, motion.times, ())


def static_reactions(
    case: str, linkage: Linkage, length: float, applied: tuple[Applied, ...]
) -> Dynamics:
    """Reactions of the linkage held at a length (m) of its driven slider, under applied forces."""
    return _reactions(case, at_rest(linkage, length), None, applied)


def _reactions(
    case: str, motion: Motion, times: Floats | None, applied: tuple[Applied, ...]
) -> Dynamics:
    linkage, system = motion.linkage, motion.system
    unbalanced = _inertia(motion) - _applied_forces(motion, applied)
    J = system.jacobian(motion.q)
    Q, R = np.linalg.qr(J, mode="complete")
    n = system.columns
    determined = np.linalg.solve(np.swapaxes(R[:, :n], 1, 2), system.gather(unbalanced)[..., None])
    f = (Q[:, :, :n] @ determined)[..., 0]
    null = Q[:, :, n:]
    shared: tuple[str, ...] = ()
    if null.shape[2]:
        shared = require_determined(linkage).shared
        f = f + (null @ _shares(system, f, null, shared)[..., None])[..., 0]
    count = len(linkage.connections)
    on_pin = np.zeros((len(f), count, 3))
    on_pin[..., :2] = -f[:, : 2 * count].reshape(-1, count, 2)
    turn = np.stack([motion.angle(_frame(linkage, j.fixed_in)) for j, _ in linkage.connections], 1)
    reactions = Reactions(
        case=case,
        times=times,
        connections=tuple(c.name for _, c in linkage.connections),
        bodies=tuple(c.body for _, c in linkage.connections),
        forces=on_pin,
        moments=np.zeros_like(on_pin),
        turn=turn,
    )
    return Dynamics(reactions, f[:, -1], motion, shared)


def _frame(linkage: Linkage, fixed_in: str | None) -> str:
    """The item whose rotation the pin's own axes follow; a floating pin keeps the world's."""
    return fixed_in if fixed_in in linkage.index else "ground"


def _inertia(motion: Motion) -> Floats:
    """M a minus the weights, (T, items + ground, 3)."""
    items = motion.linkage.items
    m = np.array([item.mass for item in items] + [0.0])
    inertia = np.array([item.inertia or 0.0 for item in items] + [0.0])
    force = np.zeros_like(motion.a)
    force[..., :2] = m[:, None] * (motion.a[..., :2] - np.array(motion.linkage.gravity))
    force[..., 2] = inertia * motion.a[..., 2]
    return force


def _applied_forces(motion: Motion, applied: tuple[Applied, ...]) -> Floats:
    force = np.zeros_like(motion.a)
    for load in applied:
        i = motion.linkage.index[load.body]
        position, _, _ = motion.point(load.body, load.at)
        arm = position - motion.q[:, i, :2]
        force[:, i, :2] += load.force
        force[:, i, 2] += arm[:, 0] * load.force[1] - arm[:, 1] * load.force[0]
    return force


def _shares(system: Constraints, f: Floats, null: Floats, shared: tuple[str, ...]) -> Floats:
    """Amounts (T, k) of the null vectors that make the sharing connections behave like springs:
    the sum of force^2 / stiffness over them is least.
    """
    linkage = system.linkage
    names = [c.name for _, c in linkage.connections]
    told = f"the forces at {', '.join(shared)} are not determined by rigid-body statics"
    if not linkage.sharing:
        raise LinkageError(
            f"{told}; say how they share: [[mechanism.sharing]] with connections = [...] and "
            "stiffness = [...], one entry for each way in which they are redundant"
        )
    pairs = [p for s in linkage.sharing for p in zip(s.connections, s.stiffness, strict=True)]
    rows = [2 * names.index(name) + k for name, _ in pairs for k in (0, 1)]
    weight = np.repeat([1.0 / stiffness for _, stiffness in pairs], 2)
    N = null[:, rows]
    G = np.swapaxes(N, 1, 2) @ (weight[:, None] * N)
    if np.linalg.eigvalsh(G).min() < 1e-9 * weight.min():
        raise LinkageError(
            f"{told}, and the sharing over {', '.join(name for name, _ in pairs)} does not "
            "determine them; name connections among those on both redundant sides"
        )
    b = -np.swapaxes(N, 1, 2) @ (weight * f[:, rows])[..., None]
    return np.asarray(np.linalg.solve(G, b)[..., 0], dtype=np.float64)

"""Wrenches that rigid-body statics leaves open, shared by stated rules and by the links' stiffness.

With more conditions than degrees of freedom, some sets of wrenches are in equilibrium by
themselves. Their amounts follow in two steps. First come the linkage's rules, by which named joints
share like springs. Then the complementary energy of the links is minimised, each link being a beam
from its centre of mass to each of its joints.

Links whose stiffness is not stated have the geometric mean of the others. The result is then one of
several: each of these links is also taken a tenth and ten times as stiff, then all of them in
torsion, then groups of them that are ten times as stiff as the rest.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from loads.forces.reactions import Reactions
from loads.linkage.linkage import LinkageError
from loads.linkage.parts import GROUND
from loads.space.equations import SpaceEquations
from loads.space.linkage import SpaceLinkage
from loads.space.pose import SpacePose
from loads.space.stiffness import (
    LinkStiffness,
    cantilever,
    complete,
    load_sizes,
    variations,
    worst_groups,
)
from pinbase.arrays import Floats

STIFFNESS_RATIO = 10.0  # variation of a stiffness that is not stated, up and down
OPEN_TOLERANCE = 1e-9  # singular value over the largest, up to which a set remains undetermined
MIN_END = 1e-9  # arm over the length scale, up to which a joint at the centre has no beam


@dataclass(frozen=True)
class _End:
    """The beam of a body to one of its joints.

    joint, body: numbers of the joint and the body.
    rows: (6, 6) matrix, whose product with the wrench (force, moment at the joint; axes as drawn)
    has a sum of squares of twice the complementary energy.
    """

    joint: int
    body: int
    rows: Floats


def unstated(linkage: SpaceLinkage, stressed: tuple[str, ...]) -> tuple[str, ...]:
    """Bodies without stated stiffness at joints that carry self-equilibrated sets of wrenches.

    stressed: names of these joints.
    """
    stated = {*linkage.stiffness, GROUND}
    ends = (b for j in linkage.joints if j.name in stressed for b in (j.base, j.moving))
    return tuple(dict.fromkeys(b for b in ends if b not in stated))


def others(linkage: SpaceLinkage, stressed: tuple[str, ...]) -> dict[str, SpaceLinkage]:
    """The linkage with other, equally plausible stiffness, by a text that says what differs.

    stressed: names of the joints that carry self-equilibrated sets of wrenches.
    """
    loose = unstated(linkage, stressed)
    each = variations(stiffness_of(linkage), loose, STIFFNESS_RATIO)
    return {text: replace(linkage, stiffness=stiffness) for text, stiffness in each.items()}


def groups(
    linkage: SpaceLinkage, stressed: tuple[str, ...], reactions: Mapping[str, Reactions]
) -> dict[str, SpaceLinkage]:
    """The linkage with the groups of stiffer links that raise the force or moment of a joint most.

    stressed: names of the joints that carry self-equilibrated sets of wrenches.
    reactions: reactions of each of `others`, by its text.
    """
    loads = {text: load_sizes(r.forces, r.moments) for text, r in reactions.items()}
    loose = unstated(linkage, stressed)
    each = worst_groups(stiffness_of(linkage), loose, STIFFNESS_RATIO, loads)
    return {text: replace(linkage, stiffness=stiffness) for text, stiffness in each.items()}


def stiffness_of(linkage: SpaceLinkage) -> dict[str, LinkStiffness]:
    """The stiffness of every body: as stated, otherwise by `complete`."""
    names = [b.name for b in linkage.bodies]
    return complete(names, linkage.stiffness, linkage.length_scale)


@dataclass(frozen=True)
class RedundantSets:
    """The k self-equilibrated sets of wrenches at the instants of a pose.

    multipliers: (T, rows, k). wrenches: (T, J + G, 6, k) of joints, then of teeth.
    """

    multipliers: Floats
    wrenches: Floats


def redundant_sets(equations: SpaceEquations, pose: SpacePose, null: Floats) -> RedundantSets:
    """The self-equilibrated sets from their multipliers `null` (T, rows, k)."""
    each = [equations.transmitted(pose, s) for s in np.moveaxis(null, -1, 0)]
    return RedundantSets(null, np.stack(each, axis=-1))


def shared(
    equations: SpaceEquations,
    linkage: SpaceLinkage,
    pose: SpacePose,
    f: Floats,
    sets: RedundantSets,
) -> Floats:
    """The multipliers (T, rows) plus the self-equilibrated sets in the amounts that are demanded.

    Rules come first; the stiffness determines the sets that they leave open.
    linkage: the linkage with its rules and stiffness.
    f: (T, rows) multipliers in equilibrium with the loads.

    Raises: LinkageError where neither rules nor stiffness determine the amounts.
    """
    first, null, own = equations.transmitted(pose, f), sets.multipliers, sets.wrenches
    for rows in (_rules(linkage), _Energy(linkage, pose)):
        if rows is None or not own.shape[-1]:
            continue
        A, b = rows(own), rows(first[..., None])[..., 0]
        amounts, rest = _least(A, b)
        f = f + np.einsum("trk,tk->tr", null, amounts)
        first = first + np.einsum("tjck,tk->tjc", own, amounts)
        null, own = null @ rest, np.einsum("tjck,tkl->tjcl", own, rest)
    if own.shape[-1]:
        size = np.abs(own).max(axis=(0, 2, 3))
        named = zip(linkage.forces, size, strict=True)
        names = (name for (name, _), s in named if s > 1e-6 * size.max())
        raise LinkageError(
            f"rigid-body statics does not determine the forces at {', '.join(names)}, nor does the "
            "stiffness of the links, since these joints lie at their centres of mass, on the "
            "ground or on rigid links; state how they share the load: [[mechanism.sharing]]",
            "sharing-incomplete",
            ("sharing",),
        )
    return f


def _least(A: Floats, b: Floats) -> tuple[Floats, Floats]:
    """The shortest amounts (T, k) that minimise |A amounts + b|.

    Returns also a basis (T, k, l) of the amounts that A leaves undetermined.
    A: (T, m, k). b: (T, m).
    """
    missing = max(A.shape[2] - A.shape[1], 0)  # rows of zeros give a complete basis
    A, b = np.pad(A, ((0, 0), (0, missing), (0, 0))), np.pad(b, ((0, 0), (0, missing)))
    left, s, right = np.linalg.svd(A, full_matrices=False)
    rank = int(np.max(np.sum(s > OPEN_TOLERANCE * max(float(s.max(initial=0.0)), 1e-300), axis=1)))
    determined = s > OPEN_TOLERANCE * s.max(axis=1, initial=1e-300, keepdims=True)
    along = np.einsum("tml,tm->tl", left, b) / np.where(determined, s, np.inf)
    return -np.einsum("tl,tlk->tk", along, right), np.swapaxes(right[:, rank:], 1, 2)


class _Rules:
    """The rows of all rules: force over the square root of stiffness, by named joint or gear."""

    def __init__(self, linkage: SpaceLinkage) -> None:
        names = [name for name, _ in linkage.forces]
        members = [p for s in linkage.sharing for p in zip(s.connections, s.stiffness, strict=True)]
        self._which = [names.index(name) for name, _ in members]
        self._weight = np.array([stiffness**-0.5 for _, stiffness in members])

    def __call__(self, wrenches: Floats) -> Floats:
        """Rows (T, m, k) of wrenches (T, J + G, 6, k)."""
        force = wrenches[:, self._which, :3] * self._weight[:, None, None]
        return np.asarray(force.reshape(len(force), -1, wrenches.shape[-1]))


def _rules(linkage: SpaceLinkage) -> _Rules | None:
    return _Rules(linkage) if linkage.sharing else None


class _Energy:
    """The rows of the complementary energy of all links."""

    def __init__(self, linkage: SpaceLinkage, pose: SpacePose) -> None:
        self._ends = list(_ends(linkage))
        self._turn = pose.rotation

    def __call__(self, wrenches: Floats) -> Floats:
        """Rows (T, m, k) of wrenches (T, J + G, 6, k), world axes."""
        out = []
        for end in self._ends:
            turn = np.swapaxes(self._turn[:, end.body], -1, -2)
            w = wrenches[:, end.joint].reshape(len(turn), 2, 3, -1)
            as_drawn = (turn[:, None] @ w).reshape(len(turn), 6, -1)
            out.append(end.rows @ as_drawn)
        none = np.zeros((len(wrenches), 0, wrenches.shape[-1]))
        return np.concatenate([none, *out], axis=1)


def _ends(linkage: SpaceLinkage) -> Iterator[_End]:
    """The beams of all bodies."""
    stiffness = stiffness_of(linkage)
    for k, joint in enumerate(linkage.joints):
        for body in (joint.base, joint.moving):
            if body == GROUND:
                continue  # it does not yield
            arm = np.subtract(joint.at, linkage.bodies[linkage.index[body]].centre)
            if np.linalg.norm(arm) > MIN_END * linkage.length_scale:
                size, axes = np.linalg.eigh(cantilever(arm, stiffness[body]))
                rows = np.sqrt(np.maximum(size, 0.0))[:, None] * axes.T
                yield _End(k, linkage.index[body], rows)

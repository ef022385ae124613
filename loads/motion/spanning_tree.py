"""The spanning tree of connections and sliders that joins bodies to the ground.

The connections and sliders beyond the tree close loops.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import GROUND
from pinbase.arrays import Complex, Floats, Ints

LENGTH_ROUND_OFF = 1e-14  # relative to a length: the remainder where equal lengths cancel


@dataclass(frozen=True)
class LoopEdge:
    """A member of the tree, which joins some items to the ground.

    slides: whether the member is a slider; otherwise it is a connection.
    which: number of the slider or connection.
    away: numbers of the items on the side away from the ground.
    forward: whether the connection's body (the slider's moving body) is on that side.
    """

    slides: bool
    which: int
    away: frozenset[int]
    forward: bool


def ends_of(linkage: Linkage, slides: bool, which: int) -> tuple[int, int]:
    """Numbers of the items that a slider or connection joins: (moving) body and base or carrier."""
    if slides:
        s = linkage.sliders[which]
        return linkage.index[s.moving], linkage.index[s.base]
    joint, c = linkage.connections[which]
    return linkage.index[c.body], linkage.index[linkage.carrier(joint)]


def _welds(linkage: Linkage) -> list[tuple[int, int]]:
    """Numbers of the items at the two ends of every weld."""
    index = linkage.index
    return [(index[b.name], index[b.welded]) for b in linkage.bodies if b.welded is not None]


def frames(linkage: Linkage) -> tuple[int, Ints]:
    """Number of frames, and the frame of every item, (items + ground,); 0 is the ground's.

    Items that slide on each other or are welded share a frame. Floating pins and particles have no
    angle; their frame is the ground's, and does not affect their positions.
    """
    index = linkage.index
    joined = _Sets(len(index))
    for s in linkage.sliders:
        joined.join(index[s.base], index[s.moving])
    for body, base in _welds(linkage):
        joined.join(body, base)
    ground = joined.of(index[GROUND])
    frame = np.zeros(len(index), dtype=np.int64)
    numbers: dict[int, int] = {ground: 0}
    for i, item in enumerate(linkage.items):
        if item.inertia is not None or joined.of(i) == ground:
            frame[i] = numbers.setdefault(joined.of(i), len(numbers))
    for i in range(len(linkage.items)):
        frame[i] = numbers.get(joined.of(i), 0)
    return len(numbers), frame


def shortest(gaps: Complex) -> Floats:
    """Whole numbers (K, K) that combine gaps (n, K) into gaps with few nonzeros.

    Each combination is a sum or difference of two gaps: where two loops run along the same bodies,
    their difference does not contain these bodies.
    """
    count = gaps.shape[1]
    combined, gaps = np.eye(count), gaps.copy()
    size = np.abs(gaps).max(initial=0.0)
    # Replace a gap, those with most nonzeros first, by its sum or difference with another gap as
    # long as this reduces its number of nonzeros.
    improved = True
    while improved:
        improved = False
        for k in np.argsort(-(gaps != 0.0).sum(axis=0), kind="stable"):
            for sign in (1.0, -1.0):
                new = gaps[:, k, None] - sign * gaps
                new[np.abs(new) < LENGTH_ROUND_OFF * size] = 0.0
                entries = (new != 0.0).sum(axis=0)
                entries[k] = len(gaps) + 1
                j = int(entries.argmin())
                if entries[j] < (gaps[:, k] != 0.0).sum():
                    gaps[:, k] = new[:, j]
                    combined[:, k] -= sign * combined[:, j]
                    improved = True
    return combined


class _Sets:
    """Disjoint sets of items."""

    def __init__(self, count: int) -> None:
        self._parent = list(range(count))

    def of(self, i: int) -> int:
        """The set of item i, identified by one of its items."""
        while self._parent[i] != i:
            i = self._parent[i]
        return i

    def join(self, i: int, j: int) -> bool:
        """Join the sets of two items; true if they were different."""
        a, b = self.of(i), self.of(j)
        self._parent[a] = b
        return a != b


def spanning_tree(linkage: Linkage) -> tuple[tuple[LoopEdge, ...], tuple[tuple[bool, int], ...]]:
    """Edges of a spanning tree, from the ground outwards, and the members that close loops.

    The latter are pairs (slides, which). Welds and sliders enter the tree first. So they join the
    bodies of one frame, and no loop equation contains a rotation of a frame relative to itself.
    Welds are in neither list, because nothing moves at a weld.

    Raises: LinkageError for bodies that nothing joins to the ground.
    """
    index = linkage.index
    members: list[tuple[bool | None, int, int, int]]
    members = [(None, k, *ends) for k, ends in enumerate(_welds(linkage))]
    members += [(True, k, *ends_of(linkage, True, k)) for k in range(len(linkage.sliders))]
    members += [(False, k, *ends_of(linkage, False, k)) for k in range(len(linkage.connections))]
    joined = _Sets(len(index))
    inside = [m for m in members if joined.join(m[2], m[3])]
    closing = tuple((m[0], m[1]) for m in members if m not in inside and m[0] is not None)
    ground = index[GROUND]
    adrift = [
        item.name for i, item in enumerate(linkage.items) if joined.of(i) != joined.of(ground)
    ]
    if adrift:
        raise LinkageError(
            f"no connection or slider joins {', '.join(adrift)} to the ground; add one",
            "not-joined",
        )
    # Breadth-first from the ground, for the order of the edges.
    neighbours: dict[int, list[tuple[tuple[bool | None, int, int, int], int]]] = {}
    for m in inside:
        neighbours.setdefault(m[2], []).append((m, m[3]))
        neighbours.setdefault(m[3], []).append((m, m[2]))
    order: list[tuple[tuple[bool | None, int, int, int], int, int]] = []
    seen, queue = {ground}, [ground]
    for inner in queue:
        for m, outer in neighbours.get(inner, ()):
            if outer not in seen:
                seen.add(outer)
                queue.append(outer)
                order.append((m, inner, outer))
    # Items beyond each edge, collected from the outermost edges inwards.
    away: dict[int, set[int]] = {outer: {outer} for _, _, outer in order}
    for _, inner, outer in reversed(order):
        if inner != ground:
            away[inner] |= away[outer]
    edges = tuple(
        LoopEdge(m[0], m[1], frozenset(away[o]), m[2] == o) for m, _, o in order if m[0] is not None
    )
    return edges, closing

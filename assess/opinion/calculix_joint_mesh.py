"""Structured meshes of hexahedra with 20 nodes: stepped pins, hollow or solid, and annuli.

A cross-section of cells is drawn along z: circles at all radii of the outline, cut into equal
sectors, round a core of squares where the pin is solid. Cells outside of the outline are left out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from geometry import ArgumentError, Pin
from geometry.mesh.hexahedra import Fillet, filleted, fillets_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Pairs of corners of the nodes 9 to 20 of C3D20, and the corners of its faces 4 and 6, counted
# from 0, which are the outer and the inner one of a cell drawn from a ring.
C3D20_EDGES = np.array(
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
)
OUTER_FACE, INNER_FACE = 4, 6
FACE_NODES = {OUTER_FACE: [1, 5, 6, 2, 17, 13, 18, 9], INNER_FACE: [3, 7, 4, 0, 19, 15, 16, 11]}
# Of the contact, times Young's modulus over the diameter. Halved or doubled it changes the moment
# and the stress of a clevis by 0.1 to 0.2 %, of two lugs with clearance by up to 0.6 %.
CONTACT_STIFFNESS = 200.0
# So that displacements are small compared with elements: contact is found on moved nodes
SMALL_LOAD_SCALE = 0.01
CORE_SIZE = 0.55  # of the least radius of a solid pin: half the side of the core, about
CORE_ROUNDNESS = 0.4  # how round the core is: 0 a square, 1 a circle
MAX_LOCATING_STEPS, LOCATING_TOLERANCE = 12, 1e-9  # of Newton's method for a point in an element
# Of the layers behind a fillet, whose depths grow as this power of their number.
FILLET_GRADING = 1.5
CORNER_SIGNS = np.array(
    [[x, y, z] for z in (-1.0, 1.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
)


@dataclass(frozen=True)
class Fineness:
    """The fineness of CalculiX's meshes, and the constants of its contact.

    rings: of a band between its rounded edges.
    parts: elements along each ring.
    sectors: over the whole circumference, a multiple of 8.
    layers: elements through the pin's wall, or from the core of a solid one to its surface.
    eye: elements through the wall of a lug, in addition to one in a bushing.
    arc: elements of half of a fillet's arc, and behind it to the depth of its radius.
    along: elements of a segment without a lug, for every length of a diameter; at least two.
    stiffness: of the contact, times Young's modulus of the pin over its smallest diameter.
    scale: of forces and gaps; results are the same multiple where displacements are small.
    """

    rings: int = 8
    parts: int = 1
    sectors: int = 32
    layers: int = 2
    eye: int = 3
    arc: int = 4
    along: float = 4.0
    stiffness: float = CONTACT_STIFFNESS
    scale: float = SMALL_LOAD_SCALE

    @property
    def arc_places(self) -> Floats:
        """Distances (arc + 1,) from the corner below a fillet, over its radius, of nodes that are
        moved onto its arc at equal angles.
        """
        return np.asarray(math.sqrt(2.0) * np.sin(np.linspace(0.0, math.pi / 4.0, self.arc + 1)))

    @property
    def arc_depths(self) -> Floats:
        """Depths (arc + 1,) of the layers behind a fillet, over that to which nodes are moved."""
        return np.asarray(np.linspace(0.0, 1.0, self.arc + 1) ** FILLET_GRADING)

    def __post_init__(self) -> None:
        if self.sectors % 8:
            raise ArgumentError("sectors must be a multiple of 8", "not-a-multiple")


@dataclass(frozen=True)
class Hexahedra:
    """A mesh of hexahedra with 20 nodes.

    nodes: (N, 3) m.
    elements: (M, 20), in the order of C3D20.
    layer: (M,), number along z.
    inner, outer: (M,), radii of the element where it is a ring's, m; 0 in the core.
    """

    nodes: Floats
    elements: Ints
    layer: Ints
    inner: Floats
    outer: Floats

    def face(self, elements: Ints, face: int) -> Ints:
        """The nodes (K, 8) of a face of elements: corners, then the middles of its edges."""
        return self.elements[elements][:, FACE_NODES[face]]


@dataclass(frozen=True)
class _Section:
    """The cells of a cross-section.

    points: (P, 2) m.
    cells: (Q, 4), anticlockwise, rings from their inner edge on.
    on: radius of the circle of a point, 0 in the core.
    inner, outer: radii of the cells' circles.
    """

    points: Floats
    cells: Ints
    on: Floats
    inner: Floats
    outer: Floats


def pin_mesh(pin: Pin, z: Sequence[Floats], fineness: Fineness, half: bool) -> Hexahedra:
    """The mesh of a pin.

    z: ends of the layers of each segment, m.
    half: only y > 0.

    Raises: ArgumentError for a pin with cones, rounded edges, or a fillet before a thin wall.
    """
    if not pin.stepped:
        raise ArgumentError(f"CalculiX's model has only cylinders (pin {pin.name})", "cone")
    fillets = fillets_of(pin)
    if len(fillets) < sum(pin.fillet_at(i) > 0.0 for i in range(len(pin.segments) - 1)):
        raise ArgumentError(
            f"CalculiX's model has no fillet larger than the wall behind it (pin {pin.name})",
            "fillet",
        )
    bores = [s.bore / 2.0 for s in pin.segments]
    every = {s.diameter / 2.0 for s in pin.segments} | {b for b in bores if b}
    every |= {fillet.r + fillet.radius for fillet in fillets}
    steps = [r for below, r in pairwise([0.0, *sorted(every)]) if r - below > pin.tolerance]
    solid = min(bores) == 0.0
    radii = _refined(_radii(steps, solid, fineness.layers), fillets, fineness)
    section = _section(radii, solid, fineness.sectors, half)
    counts = [len(part) - 1 for part in z]
    outer = np.repeat([s.diameter / 2.0 for s in pin.segments], counts)
    ends = np.unique(np.concatenate(list(z)).round(12))
    sharp = _drawn(section, ends, np.repeat(bores, counts), outer)
    return replace(sharp, nodes=filleted(pin, sharp.nodes)) if fillets else sharp


def annulus_mesh(radii: tuple[float, ...], z: Floats, fineness: Fineness, half: bool) -> Hexahedra:
    """The mesh of a lug of layers with ends z, m.

    radii: of its bore, of a bushing's outside if it has one, and its own, m.
    """
    wall = (radii[-1] / radii[-2]) ** np.linspace(0.0, 1.0, fineness.eye + 1)
    section = _section(np.array([*radii[:-2], *radii[-2] * wall]), False, fineness.sectors, half)
    count = np.ones(len(z) - 1)
    return _drawn(section, z, radii[0] * count, radii[-1] * count)


def _radii(steps: list[float], solid: bool, layers: int) -> Floats:
    """The radii of all circles: those of the outline, and between them, finer towards the larger
    one.
    """
    first = CORE_SIZE * steps[0] if solid else steps[0]
    whole = [first, *steps] if solid else steps
    widest = (steps[-1] - first) / layers
    out = [whole[0]]
    for a, b in pairwise(whole):
        count = max(1, round((b - a) / widest))
        s = np.linspace(0.0, 1.0, count + 1)[1:]
        out += list(a + (b - a) * s * (1.3 - 0.3 * s))
    return np.array(out)


def _refined(radii: Floats, fillets: list[Fillet], fineness: Fineness) -> Floats:
    """The radii with those of the layers behind fillets and of the ends of elements on their
    arcs.
    """
    out = radii
    for fillet in fillets:
        depths, places = fillet.depth * fineness.arc_depths, fillet.radius * fineness.arc_places
        out = with_added(out, fillet.r - depths, depths[1] / 2.0)
        out = with_added(out, fillet.r + places, (places[-1] - places[-2]) / 2.0)
    return out


def layers_at_fillets(z: Floats, fillets: Sequence[Fillet], fineness: Fineness) -> Floats:
    """The ends of the layers of a segment, m, with those of a fillet at either end."""
    for fillet in fillets:
        depths, places = fillet.depth * fineness.arc_depths, fillet.radius * fineness.arc_places
        z = with_added(z, fillet.z + fillet.direction * places, (places[-1] - places[-2]) / 2.0)
        z = with_added(z, fillet.z - fillet.direction * depths, depths[1] / 2.0)
    return z


def with_added(positions: Floats, added: Floats, nearest: float) -> Floats:
    """The sorted positions, with those added that lie between them and are not nearer to one than
    a distance.
    """
    between = added[(added > positions[0]) & (added < positions[-1])]
    apart = np.abs(between[:, None] - positions).min(axis=1, initial=np.inf)
    return np.sort(np.concatenate([positions, between[apart > nearest]]))


def _section(radii: Floats, solid: bool, sectors: int, half: bool) -> _Section:
    angles = 2.0 * np.pi * np.arange(sectors) / sectors
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    circles = radii[:, None, None] * around
    on = np.repeat(radii, sectors)
    first = np.arange(len(radii))[:, None] * sectors + np.arange(sectors)
    points, cells, core = circles.reshape(-1, 2), [], np.empty((0, 4), dtype=np.int64)
    if solid:
        grid, numbers = _core(sectors, radii[0])
        edge = _edge(numbers)
        first[0] = edge
        first[1:] += len(grid) - sectors
        points = np.concatenate([grid, circles[1:].reshape(-1, 2)])
        on = np.concatenate([np.zeros(len(grid)), on[sectors:]])
        a, b, c, d = numbers[:-1, :-1], numbers[1:, :-1], numbers[1:, 1:], numbers[:-1, 1:]
        core = np.stack([a, b, c, d], axis=-1).reshape(-1, 4)
    for low, high in pairwise(first):
        cells.append(np.stack([low, high, np.roll(high, -1), np.roll(low, -1)], axis=1))
    inner, outer = (np.repeat(r, sectors) for r in (radii[:-1], radii[1:]))
    none = np.zeros(len(core))
    section = _Section(
        points,
        np.concatenate([core, *cells]),
        on,
        np.concatenate([none, inner]),
        np.concatenate([none, outer]),
    )
    return _upper(section) if half else section


def _upper(section: _Section) -> _Section:
    keep = section.points[section.cells].mean(axis=1)[:, 1] > 0.0
    return replace(
        section, cells=section.cells[keep], inner=section.inner[keep], outer=section.outer[keep]
    )


def _core(sectors: int, radius: float) -> tuple[Floats, Ints]:
    """The points of a square whose sides bulge, and their numbers (n + 1, n + 1) along x and y."""
    n = sectors // 4
    u, v = np.meshgrid(*2 * [np.linspace(-1.0, 1.0, n + 1)], indexing="ij")
    s = np.maximum(np.abs(u), np.abs(v))
    safe = np.where(s > 0.0, s, 1.0)
    side = np.pi / 4.0 * np.where(np.abs(u) >= np.abs(v), v / safe, u / safe)
    flat = np.abs(u) >= np.abs(v)
    long, short = s * np.cos(side), s * np.sin(side)
    x = np.where(flat, np.sign(u) * long, short)
    y = np.where(flat, short, np.sign(v) * long)
    square, weight = np.stack([u, v], axis=-1) * 0.8, (CORE_ROUNDNESS * s**2)[..., None]
    points = radius * ((1.0 - weight) * square + weight * np.stack([x, y], axis=-1))
    return points.reshape(-1, 2), np.arange((n + 1) ** 2).reshape(n + 1, n + 1)


def _edge(numbers: Ints) -> Ints:
    """The numbers along the square's edge, anticlockwise from the middle of its side at x > 0."""
    n = len(numbers) - 1
    loop = np.concatenate([numbers[n, :-1], numbers[:0:-1, n], numbers[0, :0:-1], numbers[:-1, 0]])
    return np.roll(loop, -(n // 2))


def _drawn(section: _Section, z: Floats, bore: Floats, outer: Floats) -> Hexahedra:
    """The mesh of the cells drawn along z, (L + 1,) m.

    bore, outer: radii between which cells exist, (L,) m, of each layer.
    """
    tiny = 1e-9 * outer.max()
    count, elements, layer, inner, out = len(section.points), [], [], [], []
    for k in range(len(z) - 1):
        ring = (section.inner > bore[k] - tiny) & (section.outer < outer[k] + tiny)
        present = np.where(section.outer == 0.0, bore[k] == 0.0, ring)
        cells = section.cells[present] + k * count
        elements.append(np.concatenate([cells, cells + count], axis=1))
        layer.append(np.full(len(cells), k))
        inner.append(section.inner[present])
        out.append(section.outer[present])
    corners = np.concatenate([np.column_stack([section.points, np.full(count, h)]) for h in z])
    nodes, quadratic = _quadratic(corners, np.concatenate(elements), np.tile(section.on, len(z)))
    return Hexahedra(
        nodes, quadratic, np.concatenate(layer), np.concatenate(inner), np.concatenate(out)
    )


def _quadratic(corners: Floats, elements: Ints, on: Floats) -> tuple[Floats, Ints]:
    """The mesh with nodes in the middles of edges, without unused nodes.

    A middle lies on the circle if both ends of the edge do.
    """
    edges = np.sort(elements[:, C3D20_EDGES], axis=2).reshape(-1, 2)
    pairs, number = np.unique(edges, axis=0, return_inverse=True)
    middle = corners[pairs].mean(axis=1)
    r = on[pairs]
    arc = (r[:, 0] > 0.0) & (r[:, 0] == r[:, 1])
    middle[arc, :2] *= (r[arc, 0] / np.hypot(middle[arc, 0], middle[arc, 1]))[:, None]
    whole = np.concatenate([elements, len(corners) + number.reshape(-1, 12)], axis=1)
    used, compact = np.unique(whole, return_inverse=True)
    return np.concatenate([corners, middle])[used], compact.reshape(whole.shape)


def trilinear(natural: Floats) -> tuple[Floats, Floats]:
    """Shape functions (8,) of a hexahedron's corners, and their slopes (8, 3)."""
    parts = 1.0 + CORNER_SIGNS * natural
    shape = parts.prod(axis=1) / 8.0
    others = np.stack([parts[:, [1, 2]], parts[:, [0, 2]], parts[:, [0, 1]]], axis=1).prod(axis=2)
    return shape, CORNER_SIGNS * others / 8.0


def natural_coordinates(corners: Floats, point: Floats) -> Floats:
    """Natural coordinates (3,) of a point in a hexahedron, by Newton's method."""
    x = np.zeros(3)
    for _ in range(MAX_LOCATING_STEPS):
        shape, slopes = trilinear(x)
        step = np.linalg.solve(corners.T @ slopes, point - shape @ corners)
        x = np.clip(x + step, -2.0, 2.0)
        if np.abs(step).max() < LOCATING_TOLERANCE:
            break
    return x

"""Structured meshes of 20-node hexahedra: stepped pins, hollow or solid, and annuli.

A cross-section of cells is extruded along z. Its cells are circles at all radii of the outline, cut
into equal sectors, around a core of squares if the pin is solid. Cells outside the outline are left
out.
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

# The corner pairs of the midside nodes 9 to 20 of C3D20, and the nodes of its faces 4 and 6; all
# counted from 0. These are the outer and the inner face of a cell extruded from a ring.
C3D20_EDGES = np.array(
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
)
OUTER_FACE, INNER_FACE = 4, 6
FACE_NODES = {OUTER_FACE: [1, 5, 6, 2, 17, 13, 18, 9], INNER_FACE: [3, 7, 4, 0, 19, 15, 16, 11]}
# Stiffness of the contact, times Young's modulus over the diameter. Half or twice this value
# changes the moment and the stress of a clevis by 0.1 to 0.2 %, those of two lugs with clearance by
# up to 0.6 %.
CONTACT_STIFFNESS = 200.0
# Keeps displacements small compared with elements, because contact is found on displaced nodes
SMALL_LOAD_SCALE = 0.01
CORE_SIZE = 0.55  # approximate half side of the core over the smallest radius of a solid pin
CORE_ROUNDNESS = 0.4  # shape of the core: 0 is a square, 1 is a circle
MAX_LOCATING_STEPS, LOCATING_TOLERANCE = 12, 1e-9  # of Newton's method for a point in an element
# The depths of the layers behind a fillet grow with this power of their number.
FILLET_GRADING = 1.5
CORNER_SIGNS = np.array(
    [[x, y, z] for z in (-1.0, 1.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
)


@dataclass(frozen=True)
class Fineness:
    """The fineness of CalculiX's meshes, and the constants of its contact.

    rings: number of rings of a band between its rounded edges.
    parts: elements along each ring.
    sectors: number over the whole circumference, a multiple of 8.
    layers: elements through the wall of the pin, or from the core of a solid pin to its surface.
    eye: elements through the wall of a lug, in addition to one in a bushing.
    arc: elements over half of a fillet's arc, and layers behind it down to the depth of the fillet.
    along: elements of a segment without a lug per diameter of length; at least two in total.
    stiffness: of the contact, times Young's modulus of the pin over its smallest diameter.
    scale: factor on forces and gaps; results scale by the same factor if displacements are small.
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
        """The distances (arc + 1,) from the corner below a fillet, relative to its radius, of the
        nodes that are moved onto its arc at equal angles.
        """
        return np.asarray(math.sqrt(2.0) * np.sin(np.linspace(0.0, math.pi / 4.0, self.arc + 1)))

    @property
    def arc_depths(self) -> Floats:
        """The depths (arc + 1,) of the layers behind a fillet, relative to the depth down to which
        nodes are moved.
        """
        return np.asarray(np.linspace(0.0, 1.0, self.arc + 1) ** FILLET_GRADING)

    def __post_init__(self) -> None:
        if self.sectors % 8:
            raise ArgumentError("sectors must be a multiple of 8", "not-a-multiple")


@dataclass(frozen=True)
class Hexahedra:
    """A mesh of 20-node hexahedra.

    nodes: (N, 3) m.
    elements: (M, 20), in the order of C3D20.
    layer: (M,), number of the layer along z.
    inner, outer: (M,), radii between which a ring element lies, m; 0 in the core.
    """

    nodes: Floats
    elements: Ints
    layer: Ints
    inner: Floats
    outer: Floats

    def face(self, elements: Ints, face: int) -> Ints:
        """Return the nodes (K, 8) of a face of elements: corners, then midside nodes."""
        return self.elements[elements][:, FACE_NODES[face]]


@dataclass(frozen=True)
class _Section:
    """The cells of a cross-section.

    points: (P, 2) m.
    cells: (Q, 4), anticlockwise; those of rings start at their inner edge.
    on: (P,) radius of the circle on which a point lies, 0 in the core.
    inner, outer: (Q,) radii between which a cell lies, 0 in the core.
    """

    points: Floats
    cells: Ints
    on: Floats
    inner: Floats
    outer: Floats


def pin_mesh(pin: Pin, z: Sequence[Floats], fineness: Fineness, half: bool) -> Hexahedra:
    """Return the mesh of a pin.

    z: ends of the layers of each segment, m.
    half: whether only y > 0 is meshed.

    Raises: ArgumentError for a pin with cones, rounded edges, or a fillet larger than the wall
    behind it.
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
    """Return the mesh of a lug whose layers end at z, m.

    radii: of the bore, of the outside of a bushing if there is one, and of the lug's outside, m.
    """
    wall = (radii[-1] / radii[-2]) ** np.linspace(0.0, 1.0, fineness.eye + 1)
    section = _section(np.array([*radii[:-2], *radii[-2] * wall]), False, fineness.sectors, half)
    count = np.ones(len(z) - 1)
    return _drawn(section, z, radii[0] * count, radii[-1] * count)


def _radii(steps: list[float], solid: bool, layers: int) -> Floats:
    """Return the radii of all circles: those of the outline, and intermediate ones that are closer
    together towards the larger radius.
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
    """Return the radii with added circles for the layers behind fillets and for the elements on
    their arcs.
    """
    out = radii
    for fillet in fillets:
        depths, places = fillet.depth * fineness.arc_depths, fillet.radius * fineness.arc_places
        out = with_added(out, fillet.r - depths, depths[1] / 2.0)
        out = with_added(out, fillet.r + places, (places[-1] - places[-2]) / 2.0)
    return out


def layers_at_fillets(z: Floats, fillets: Sequence[Fillet], fineness: Fineness) -> Floats:
    """Return the ends of the layers of a segment, m, with those of fillets at its ends added."""
    for fillet in fillets:
        depths, places = fillet.depth * fineness.arc_depths, fillet.radius * fineness.arc_places
        z = with_added(z, fillet.z + fillet.direction * places, (places[-1] - places[-2]) / 2.0)
        z = with_added(z, fillet.z - fillet.direction * depths, depths[1] / 2.0)
    return z


def with_added(positions: Floats, added: Floats, nearest: float) -> Floats:
    """Return sorted positions with added ones.

    Only added positions count that lie within the range of the positions and are farther than
    `nearest` from each of them.
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
    """Return the points of a square with bulging sides, and their numbers (n + 1, n + 1) along x
    and y.
    """
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
    """Return the point numbers along the edge of the square, anticlockwise from the middle of its
    side at x > 0.
    """
    n = len(numbers) - 1
    loop = np.concatenate([numbers[n, :-1], numbers[:0:-1, n], numbers[0, :0:-1], numbers[:-1, 0]])
    return np.roll(loop, -(n // 2))


def _drawn(section: _Section, z: Floats, bore: Floats, outer: Floats) -> Hexahedra:
    """Return the mesh of the cells extruded along z, (L + 1,) m.

    bore, outer: (L,) radii between which each layer has cells, m.
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
    """Return the nodes and elements with midside nodes, without unused nodes.

    on: radius of the circle of each corner. A midside node lies on the circle if both ends of its
    edge do.
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
    """Return the trilinear shape functions (8,) of a hexahedron, and their slopes (8, 3)."""
    parts = 1.0 + CORNER_SIGNS * natural
    shape = parts.prod(axis=1) / 8.0
    others = np.stack([parts[:, [1, 2]], parts[:, [0, 2]], parts[:, [0, 1]]], axis=1).prod(axis=2)
    return shape, CORNER_SIGNS * others / 8.0


def natural_coordinates(corners: Floats, point: Floats) -> Floats:
    """Return the natural coordinates (3,) of a point in a hexahedron, by Newton's method; they are
    clipped at -2 and 2.
    """
    x = np.zeros(3)
    for _ in range(MAX_LOCATING_STEPS):
        shape, slopes = trilinear(x)
        step = np.linalg.solve(corners.T @ slopes, point - shape @ corners)
        x = np.clip(x + step, -2.0, 2.0)
        if np.abs(step).max() < LOCATING_TOLERANCE:
            break
    return x

"""The mesh of a lug's eye, whose rectangular section is a grid of triangles, fine at the bore."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from skfem import MeshQuad, MeshTri2

from geometry.mesh.section_mesh import MeridianMesh
from geometry.shape.pin import Pin
from pinbase.arrays import Floats

LAYER_GROWTH = 1.6  # ratio of each layer to the one before, from the bore outwards
# With a single element, the pressure at a rounded edge is 6 % too high, at a bushing 3 %.
MIN_WALL_ELEMENTS = 2.0


def eye_mesh(eye: Pin, across: float, interface: float | None = None) -> MeridianMesh:
    """The mesh of a lug's annulus, with one surface for each segment outside and in the bore.

    across: element size at the bore, as elements per diameter of the bore; each ring, and the wall
    between bore and interface, has at least MIN_WALL_ELEMENTS elements.
    interface: radius, m, along which elements end, or None.
    """
    bore, outer = eye.segments[0].bore / 2.0, eye.segments[0].diameter / 2.0
    ends = [bore, *([] if interface is None else [interface]), outer]
    size, rings = 2.0 * bore / across, np.diff(eye.stations)
    first = min(size, min(float(rings.min()), ends[1] - bore) / MIN_WALL_ELEMENTS)
    r = np.concatenate([[bore], *_layers(ends, first)])
    along = (_even(s, e, min(size, (e - s) / MIN_WALL_ELEMENTS)) for s, e in pairwise(eye.stations))
    z = np.concatenate([[0.0], *along])
    grid = MeshTri2.from_mesh(MeshQuad.init_tensor(r, z).to_meshtri(style="x"))
    return MeridianMesh.of(grid, _edges(eye, grid), np.zeros(0, dtype=np.int64))


def _even(start: float, end: float, size: float) -> Floats:
    """The ends of equal elements of at most `size` from start to end, without the start."""
    count = max(1, int(np.ceil((end - start) / size - 1e-9)))
    return np.linspace(start, end, count + 1)[1:]


def _layers(ends: list[float], size: float) -> list[Floats]:
    """The radii of layers after the first of `ends`, which include the other ends.

    size: thickness of the first layer, m; layers grow outwards.
    """
    radii, step = [], size
    # Between each two ends, the number of layers follows from the geometric series that begins with
    # `step`; the layers are then stretched to fit.
    for start, end in pairwise(ends):
        ratio = 1.0 + (end - start) * (LAYER_GROWTH - 1.0) / step
        count = max(1, int(np.ceil(np.log(ratio) / np.log(LAYER_GROWTH) - 1e-9)))
        parts = LAYER_GROWTH ** np.arange(count)
        radii.append(start + (end - start) * np.cumsum(parts) / parts.sum())
        step *= LAYER_GROWTH**count
    return radii


def _edges(eye: Pin, grid: MeshTri2) -> dict[str, np.ndarray[tuple[int, int], np.dtype[np.int64]]]:
    """The edges (E, 3) of each surface, counter-clockwise: node numbers of ends, then middle."""
    facets = grid.boundary_facets()
    ends, middle = grid.facets[:, facets], grid.dofs.facet_dofs[0, facets]
    x, at = grid.doflocs, grid.doflocs[:, middle]
    (inner, outer), length = np.sort([at[0].min(), at[0].max()]), eye.length
    tiny = 1e-9 * length
    onwards = np.where(at[0] > outer - tiny, 1.0, 0.0) - np.where(at[0] < inner + tiny, 1.0, 0.0)
    rightwards = np.where(at[1] < tiny, 1.0, 0.0) - np.where(at[1] > length - tiny, 1.0, 0.0)
    along = x[:, ends[1]] - x[:, ends[0]]
    back = along[0] * rightwards + along[1] * onwards < 0.0
    nodes = np.stack([*np.where(back, ends[::-1], ends), middle], axis=1).astype(np.int64)
    edges = {"start": nodes[rightwards > 0.0], "end": nodes[rightwards < 0.0]}
    for label, (z0, z1) in zip(eye.labels, pairwise(eye.stations), strict=True):
        here = (at[1] > z0) & (at[1] < z1)
        edges[label] = nodes[here & (onwards > 0.0)]
        edges[f"bore {label}"] = nodes[here & (onwards < 0.0)]
    return edges

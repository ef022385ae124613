"""The number of unknowns of a mesh of tetrahedra, estimated from its size fields before meshing."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from geometry.mesh.gmsh_session import MeshError
from pinbase.arrays import Floats

MAX_UNKNOWNS = 5e6  # largest number in any mesh, which takes gmsh minutes to make
EXPECTED_WITHIN = 2.0  # factor allowed between expected and actual unknowns; measured 0.64 to 1.43
# Unknowns of curved tetrahedra of size h in a volume V. The first factor is multiplied by
# N = V / h^3, the second by N^(2/3), for nodes on the surface. Both are fitted to 40 meshes, some
# of which are in the benchmark "expected".
UNKNOWNS_PER_VOLUME, UNKNOWNS_PER_SURFACE = 27.0, 100.0
CELL_SIZE_RATIO = 2.0  # largest ratio of the side of a cell to the element size in its middle
FIRST_CELLS = 8  # number of cells along the longest side of the box around the body
MAX_CELLS = 200_000  # beyond this number, cells that are too large are not divided any more
BODY_SAMPLES = 600  # sample points that show which share of the cells is in the body
CURVE_SAMPLES, FACE_SAMPLES = 100, 16  # samples along a curve, and along each direction of a face


def require_few(gmsh: Any, name: str, most: float) -> None:
    """Check that the mesh of gmsh's model will not have too many unknowns.

    name: name of the pin. most: limit on the unknowns, beside MAX_UNKNOWNS; the smaller one holds.

    Raises: MeshError where even half of the expected unknowns are too many.
    """
    sizes, limit = _Sizes(gmsh), min(most, MAX_UNKNOWNS)
    cells = _Cells(gmsh, sizes)
    if unknowns(cells.elements) <= EXPECTED_WITHIN * limit:  # including cells outside the body
        return
    if (expected := unknowns(cells.elements * cells.inside(gmsh))) <= EXPECTED_WITHIN * limit:
        return
    fit = "fit into the memory allowed (--memory-limit): allow more, or close other programs"
    why = fit if most < MAX_UNKNOWNS else "are allowed"
    raise MeshError(
        f"pin {name}: its first mesh of tetrahedra would have about {_plain(expected)} unknowns, "
        f"of which {_plain(limit)} {why}. Its smallest elements, for a radius, hole or face, are "
        f"{_plain(1.0 / cells.smallest)} times smaller than what is meshed: make that larger or "
        "leave it out, or model the critical part on its own",
        "too-many-elements",
    )


def expected_unknowns(gmsh: Any) -> float:
    """The expected unknowns of the mesh of curved tetrahedra that gmsh will make of its model."""
    cells = _Cells(gmsh, _Sizes(gmsh))
    return unknowns(cells.elements * cells.inside(gmsh))


def unknowns(elements: float) -> float:
    """The unknowns of a mesh. elements: its volume over the cube of the element size."""
    return float(UNKNOWNS_PER_VOLUME * elements + UNKNOWNS_PER_SURFACE * elements ** (2.0 / 3.0))


def _plain(number: float) -> str:
    """A large number as text with two significant digits."""
    return f"{float(f'{number:.2g}'):,.0f}"


class _Cells:
    """Cubes that fill the box around gmsh's model, small where its elements are small.

    elements: sum over the cubes of volume over element size cubed.
    smallest: smallest element size, relative to the longest side of the box.
    """

    def __init__(self, gmsh: Any, sizes: _Sizes) -> None:
        box = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
        longest = float((box[1] - box[0]).max())
        side = longest / FIRST_CELLS
        counts = np.maximum(np.ceil((box[1] - box[0]) / side).astype(int), 1)
        middles = box[0] + side * _grid(*(np.arange(n) + 0.5 for n in counts))
        found: list[tuple[Floats, Floats, Floats]] = []
        least, many = longest, 0
        # Divide cells into eight until each is small compared with its elements.
        while len(middles):
            h = sizes.at(middles)
            done = side <= CELL_SIZE_RATIO * h
            if many + 8 * np.count_nonzero(~done) > MAX_CELLS:
                done[:] = True
            kept = middles[done]
            found.append((kept, np.full(len(kept), side), (side / h[done]) ** 3))
            many, least = many + len(kept), min(least, float(h.min()))
            side /= 2.0
            eight = side * _grid(*[np.array([-0.5, 0.5])] * 3)
            middles = (middles[~done][:, None] + eight).reshape(-1, 3)
        self._middles, self._sides, self._elements = map(np.concatenate, zip(*found, strict=True))
        self.elements, self.smallest = float(self._elements.sum()), least / longest

    def inside(self, gmsh: Any) -> float:
        """The share of the elements that is inside the body, from a random sample."""
        rng, sums = np.random.default_rng(1), np.cumsum(self._elements)
        at = (np.arange(BODY_SAMPLES) + rng.random(BODY_SAMPLES)) / BODY_SAMPLES * sums[-1]
        cell = np.minimum(np.searchsorted(sums, at), len(sums) - 1)
        moved = self._sides[cell, None] * (rng.random((len(cell), 3)) - 0.5)
        points, solids = (self._middles[cell] + moved).ravel(), gmsh.model.getEntities(3)
        within = sum(gmsh.model.isInside(3, tag, points) for _, tag in solids)
        return min(float(within) / BODY_SAMPLES, 1.0)


class _Sizes:
    """The size fields of gmsh's model, evaluated here, because gmsh does so only while meshing."""

    def __init__(self, gmsh: Any) -> None:
        field = gmsh.model.mesh.field
        (least,) = (tag for tag in field.list() if field.getType(tag) == "Min")
        tags = [int(tag) for tag in field.getNumbers(least, "FieldsList")]
        self._formulas = [field.getString(tag, "F").replace("^", "**") for tag in tags]
        distances = {int(tag) for f in self._formulas for tag in re.findall(r"\bF(\d+)", f)}
        self._near = {f"F{tag}": KDTree(_cloud(gmsh, tag)) for tag in sorted(distances)}

    def at(self, points: Floats) -> Floats:
        """The element size at points (P, 3)."""
        x, y, z = points.T
        known = {"x": x, "y": y, "z": z, "Sqrt": np.sqrt, "Fabs": np.abs}
        known |= {name: tree.query(points)[0] for name, tree in self._near.items()}
        # eval is safe: all formulas come from this program (gmsh_session.formula_size).
        sizes = [eval(formula, {"__builtins__": {}}, known) for formula in self._formulas]
        return np.asarray(np.min(np.broadcast_arrays(x, *sizes)[1:], axis=0))


def _cloud(gmsh: Any, distance: int) -> Floats:
    """Points (P, 3) on the curves and faces from which a field measures the distance."""
    field, model = gmsh.model.mesh.field, gmsh.model
    curves = [int(tag) for tag in field.getNumbers(distance, "CurvesList")]
    points: list[float] = []
    for face in map(int, field.getNumbers(distance, "SurfacesList")):
        low, high = model.getParametrizationBounds(2, face)
        at = _grid(*(np.linspace(a, b, FACE_SAMPLES) for a, b in zip(low, high, strict=True)))
        points += list(model.getValue(2, face, at[_on_face(gmsh, face, at)].ravel()))
        curves += [tag for _, tag in model.getBoundary([(2, face)], oriented=False)]
    for curve in dict.fromkeys(curves):
        (a,), (b,) = model.getParametrizationBounds(1, curve)
        points += list(model.getValue(1, curve, np.linspace(a, b, CURVE_SAMPLES)))
    return np.reshape(points, (-1, 3))


def _on_face(gmsh: Any, face: int, at: Floats) -> list[bool]:
    """Whether parameters (P, 2) of a surface are within its edges."""
    return [bool(gmsh.model.isInside(2, face, p, parametric=True)) for p in at.tolist()]


def _grid(*along: Floats) -> Floats:
    """All combinations (P, D) of coordinates."""
    return np.stack(np.meshgrid(*along, indexing="ij"), axis=-1).reshape(-1, len(along))

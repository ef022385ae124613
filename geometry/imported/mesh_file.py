"""The mesh in a file, read by meshio, as quadratic tetrahedra with named surfaces."""

from __future__ import annotations

import io
import warnings
from contextlib import redirect_stderr, redirect_stdout

import meshio
import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from skfem import MeshTet2

from geometry.imported.body_file import BodyFile
from geometry.mesh.quality import distortion, folded
from geometry.mesh.solid_mesh import MeshError, SolidMesh
from geometry.mesh.tet10 import find_facets, quadratic
from geometry.shape.band import GeometryError
from pinbase.arrays import Ints

SURFACE_CELLS = ("triangle", "triangle6")
MAX_COORDINATE = 1000.0  # m; the same limit as for profiles
ACCEPTED_CELLS = ("vertex", "line", "line3", *SURFACE_CELLS)


def mesh_from_file(file: BodyFile) -> SolidMesh:
    """The mesh in a file by quadratic tetrahedra, m; linear tetrahedra become straight ones.

    Its boundaries are the file's named sets of triangles, or of nodes.

    Raises: GeometryError when the file is not a mesh of tetrahedra in one piece; MeshError when
    elements are inverted or overlap.
    """
    mesh = _read(file)
    where = f"pin {file.name}: {file.path.name}"
    _require_tetrahedra({block.type for block in mesh.cells}, where)
    points = np.asarray(mesh.points, dtype=float)
    if not (np.isfinite(points).all() and np.abs(points).max() < MAX_COORDINATE / file.unit):
        raise GeometryError(
            f"{where}: it has nodes whose coordinates are not finite or exceed "
            f"{MAX_COORDINATE:g} m; check geometry_unit, or export it again",
            "bad-nodes",
        )
    cells = np.concatenate([b.data for b in mesh.cells if b.type.startswith("tetra")])
    named = _triangles(mesh)
    sets = {str(name): np.asarray(n, dtype=np.int64) for name, n in mesh.point_sets.items()}
    for indices in (cells, *named.values(), *sets.values()):
        if not ((indices >= 0) & (indices < len(points))).all():
            raise GeometryError(
                f"{where}: the file is damaged: elements refer to nodes that do not exist",
                "unknown-nodes",
            )
    tetrahedra = quadratic(points * file.unit, cells.astype(np.int64))
    jacobians = distortion(tetrahedra)
    if inverted := int(np.sum(~(jacobians > 0.0))):
        raise MeshError(
            f"{where}: {inverted} elements are inverted (their Jacobian is not positive); repair "
            "them in the program that made the mesh",
            "inverted-elements",
        )
    if overlaps := folded(tetrahedra.mesh):
        raise MeshError(
            f"{where}: elements overlap their neighbours at {overlaps} facets; repair them in the "
            "program that made the mesh",
            "overlapping-elements",
        )
    if (pieces := _pieces(tetrahedra.mesh)) > 1:
        raise GeometryError(
            f"{where}: the mesh consists of {pieces} pieces that share no facet, but a pin is one "
            "piece: merge coincident nodes, or export the pin alone",
            "several-pieces",
        )
    boundaries = {name: find_facets(tetrahedra, t) for name, t in named.items() if len(t)}
    for name, nodes in sets.items():
        facets = tetrahedra.mesh.facets[:, tetrahedra.mesh.boundary_facets()].T
        in_set = np.isin(facets, tetrahedra.vertex[nodes]).all(axis=1)
        if in_set.any():
            boundaries.setdefault(name, tetrahedra.mesh.boundary_facets()[in_set])
    return SolidMesh(tetrahedra.mesh.with_boundaries(boundaries), float(jacobians.min()), 0)


def _require_tetrahedra(kinds: set[str], where: str) -> None:
    """Raise GeometryError unless the elements are tetrahedra of one kind."""
    if not kinds & {"tetra", "tetra10"}:
        raise GeometryError(
            f"{where}: no volume: the mesh has no tetrahedra, only "
            f"{', '.join(sorted(kinds)) or 'nodes'}; export a mesh of tetrahedra",
            "no-volume",
        )
    if other := kinds - {"tetra", "tetra10", *ACCEPTED_CELLS}:
        raise GeometryError(
            f"{where}: only tetrahedra are supported, but the mesh also has "
            f"{', '.join(sorted(other))}",
            "unsupported-elements",
        )
    if {"tetra", "tetra10"} <= kinds:
        raise GeometryError(
            f"{where}: the mesh mixes linear and quadratic tetrahedra; use one kind",
            "mixed-elements",
        )


def _read(file: BodyFile) -> meshio.Mesh:
    """The file's mesh as read by meshio. Raises: GeometryError where meshio cannot read it."""
    try:
        # meshio prints warnings while it tries several formats.
        printed = io.StringIO()
        with redirect_stdout(printed), redirect_stderr(printed), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return meshio.read(file.path)
    except MemoryError:
        raise
    except SystemExit:  # meshio exits when no format fits
        known = file.path.suffix.lower() in meshio.extension_to_filetypes
        reason = "it is damaged" if known else "its suffix is not that of a mesh format"
    except Exception as error:
        reason = str(error) or type(error).__name__
    raise GeometryError(
        f"pin {file.name}: {file.path.name} cannot be read as geometry ({reason}); give a STEP "
        "file, or a mesh of tetrahedra such as .msh, .inp or .vtk",
        "unreadable-geometry",
    )


def _triangles(mesh: meshio.Mesh) -> dict[str, Ints]:
    """Corner nodes (T, 3) of the triangles of every named set, by name."""
    out: dict[str, list[Ints]] = {}
    for name, blocks in mesh.cell_sets.items():
        if name.startswith("gmsh:"):
            continue
        for block, rows in zip(mesh.cells, blocks, strict=True):
            if block.type in SURFACE_CELLS and rows is not None and len(rows):
                out.setdefault(name, []).append(block.data[np.asarray(rows, dtype=np.int64), :3])
    marked = mesh.cell_data.get("gmsh:physical")
    for name, (tag, dimension) in mesh.field_data.items() if marked is not None else ():
        for block, tags in zip(mesh.cells, marked, strict=True):
            if dimension == 2 and block.type in SURFACE_CELLS and name not in mesh.cell_sets:
                out.setdefault(name, []).append(block.data[np.asarray(tags) == tag, :3])
    return {name: np.concatenate(parts).astype(np.int64) for name, parts in out.items()}


def _pieces(mesh: MeshTet2) -> int:
    """Number of pieces of a mesh that share no facet."""
    first, second = mesh.f2t[:, mesh.f2t[1] >= 0]
    n = mesh.nelements
    joined = sp.coo_matrix((np.ones(len(first)), (first, second)), shape=(n, n))
    return int(connected_components(joined, directed=False)[0])

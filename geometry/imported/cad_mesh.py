"""The mesh of a CAD file (STEP, BREP, IGES) by curved quadratic tetrahedra of gmsh.

Planes at the ends of bands split the solid, so that the ends of bands lie on edges of elements.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from geometry.imported.body_file import BodyFile
from geometry.imported.solid_volume import solid_volume
from geometry.mesh.cut_solid import near
from geometry.mesh.entities import along, curves_of, grid_on, points_at
from geometry.mesh.expected import require_few
from geometry.mesh.gmsh_session import failure, formula_size, gmsh_model, set_size, silence
from geometry.mesh.gmsh_tetrahedra import collect, repair
from geometry.mesh.solid_mesh import MeshSize, SolidMesh, sound_mesh
from geometry.shape.band import GeometryError

MAX_PLANE_CURVATURE = 1e-9  # curvature times the body's size, below which a surface is plane
QUARTERS = np.linspace(0.0, 1.0, 5)
INNER_FRACTIONS = np.linspace(0.0, 1.0, 24)[1:-1]  # of a face's parameters, avoiding the middle


def cad_mesh(file: BodyFile, size: MeshSize, most: float = math.inf) -> SolidMesh:
    """The mesh of the solid in a file, m.

    Its boundaries are the file's surfaces, by their names or as "face 1" and so on.
    most: largest number of unknowns that is allowed.

    Raises: GeometryError when the file is not geometry or does not contain exactly one solid;
    MeshError when the solid cannot be meshed.
    """
    cause = f"very small faces and edges in {file.path.name}"
    return sound_mesh(lambda finer: _mesh(file, finer, most), size, file.name, cause)


def cad_volume(file: BodyFile) -> float:
    """Volume of the solid in a file, m^3. Raises: GeometryError as for `cad_mesh`."""
    with gmsh_model(file.name) as gmsh:
        solids = solids_of(gmsh, file)
        return solid_volume(gmsh, solids[0]) * file.unit**3


def _mesh(file: BodyFile, size: MeshSize, most: float) -> SolidMesh:
    """A mesh of this size of the solid in a file, m, after repair."""
    with gmsh_model(f"{file.name}, {file.path.name}") as gmsh:
        solids = solids_of(gmsh, file)
        z = dict.fromkeys(v for place in file.places if place.z for v in place.z)
        cuts = [v / file.unit for v in z]
        faces = _split(gmsh, file, solids, cuts)
        _set_sizes(gmsh, size, cuts)
        require_few(gmsh, file.name, most)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        jacobian, repaired = repair(gmsh)
        mesh = collect(gmsh, faces)
    return SolidMesh(replace(mesh, doflocs=mesh.doflocs * file.unit), jacobian, repaired)


def solids_of(gmsh: Any, file: BodyFile) -> list[tuple[int, int]]:
    """Read a CAD file into gmsh's model; return the entity of its only solid, in a list.

    Raises: GeometryError when the file is not geometry or does not contain one solid.
    """
    try:
        gmsh.option.setNumber("Geometry.OCCImportLabels", 0)
        with silence():
            gmsh.model.occ.importShapes(str(file.path))
        gmsh.model.occ.synchronize()
    except Exception as error:
        if type(error) is not Exception:
            raise
        raise GeometryError(
            f"pin {file.name}: {file.path.name} cannot be read as geometry (gmsh: {error}); export "
            "it as STEP",
            failure(str(error), "unreadable-geometry"),
        ) from None
    solids: list[tuple[int, int]] = gmsh.model.getEntities(3)
    if not solids:
        raise GeometryError(
            f"pin {file.name}: {file.path.name} has no solid, only surfaces or curves; export the "
            "pin as a solid",
            "no-volume",
        )
    if len(solids) > 1:
        raise GeometryError(
            f"pin {file.name}: {file.path.name} contains {len(solids)} solids, but a pin must be "
            "one: export it alone, or unite them",
            "several-pieces",
        )
    return solids


def face_names(file: BodyFile, tags: list[int]) -> dict[int, str]:
    """Names of a file's faces by gmsh's tags (`tags`, in order).

    gmsh numbers faces in the order in which the shells of a STEP file list them, but does not pass
    on their names.
    """
    names = [f"face {tag}" for tag in tags]
    if file.path.suffix.lower() in (".step", ".stp"):
        text = file.path.read_text(encoding="utf-8", errors="replace")
        named = dict(re.findall(r"(#\d+)\s*=\s*ADVANCED_FACE\s*\(\s*'([^']*)'", text))
        shells = re.findall(r"CLOSED_SHELL\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)", text)
        listed = [named.get(f, "") for s in shells for f in re.findall(r"#\d+", s)]
        if len(listed) == len(tags):
            names = [a or b for a, b in zip(listed, names, strict=True)]
    return dict(zip(tags, names, strict=True))


def _split(
    gmsh: Any, file: BodyFile, solids: list[tuple[int, int]], cuts: Iterable[float]
) -> dict[str, list[int]]:
    """Split the solids at z = `cuts` (file's unit); return tags of the outer faces by name."""
    model, occ = gmsh.model, gmsh.model.occ
    tags = [tag for _, tag in model.getEntities(2)]
    names = face_names(file, tags)
    x0, y0, z0, x1, y1, z1 = model.getBoundingBox(-1, -1)
    size = max(x1 - x0, y1 - y0, z1 - z0)
    inner = [z for z in cuts if z0 + 1e-6 * size < z < z1 - 1e-6 * size]
    if not inner:
        return _by_name({tag: [tag] for tag in tags}, names)
    # gmsh's report on which face becomes which is wrong here, so pieces are compared with copies of
    # the whole faces.
    whole = [tag for _, tag in occ.copy([(2, tag) for tag in tags])]
    extent = (x0 - size, y0 - size), (x1 - x0 + 2 * size, y1 - y0 + 2 * size)
    planes = [(2, occ.addRectangle(*extent[0], z, *extent[1])) for z in inner]
    pieces, _ = occ.fragment(solids, planes)
    occ.synchronize()
    volumes = [e for e in pieces if e[0] == 3]
    pieces_of: dict[int, list[int]] = {}
    for _, face in model.getBoundary(volumes, oriented=False):
        k = _same_surface(gmsh, face, whole, 1e-5 * size)
        pieces_of.setdefault(tags[k], []).append(face)
    bounding = {t for _, t in model.getBoundary(volumes, combined=False, oriented=False)}
    occ.remove([e for e in model.getEntities(2) if e[1] not in bounding], recursive=True)
    occ.synchronize()
    return _by_name(pieces_of, names)


def _by_name(pieces: dict[int, list[int]], names: dict[int, str]) -> dict[str, list[int]]:
    """Tags of pieces of faces, by the name of the whole face."""
    named: dict[str, list[int]] = {}
    for tag, faces in pieces.items():
        named.setdefault(names[tag], []).extend(faces)
    return named


def _same_surface(gmsh: Any, face: int, whole: list[int], slack: float) -> int:
    """Index of the face among `whole` of which a face is a part.

    The part lies within the bounding box of the whole face, to the distance `slack`, and on it.
    """
    model = gmsh.model
    # The rim alone is not enough: an end face and the side that it closes share it, and both may be
    # splines.
    rim = (along(gmsh, curve, QUARTERS) for curve in curves_of(gmsh, [face]))
    x = np.concatenate([_inside(gmsh, face), *rim])

    def holds(other: int) -> bool:
        box = np.array(model.getBoundingBox(2, other)).reshape(2, 3)
        within = (x > box[0] - slack).all() and (x < box[1] + slack).all()
        return bool(within and model.getType(2, other) == model.getType(2, face))

    likely = [k for k, other in enumerate(whole) if holds(other)] or list(range(len(whole)))
    near = [np.reshape(model.getClosestPoint(2, whole[k], x.ravel())[0], (-1, 3)) for k in likely]
    return likely[int(np.argmin([np.abs(points - x).max() for points in near]))]


def _inside(gmsh: Any, face: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """A point of a face off its edges, (1, 3): the first on the face of a grid of parameters.

    The result is empty, (0, 3), where the face is thinner than the grid.
    """
    low, high = gmsh.model.getParametrizationBounds(2, face)
    for share in product(INNER_FRACTIONS, INNER_FRACTIONS):
        at = low + np.array(share) * (high - low)
        if gmsh.model.isInside(2, face, at, parametric=True):
            return points_at(gmsh, (2, face), at)
    return np.zeros((0, 3))


def _set_sizes(gmsh: Any, size: MeshSize, cuts: list[float]) -> None:
    """Set the element size from the curvature of every face, finer at the ends of bands."""
    model = gmsh.model
    x0, y0, z0, x1, y1, z1 = model.getBoundingBox(-1, -1)
    body_size = max(x1 - x0, y1 - y0, z1 - z0)
    far = min(x1 - x0, y1 - y0) / size.across
    tags = []
    for _, face in model.getBoundary(model.getEntities(3), oriented=False):
        radius, coaxial = _curvature(gmsh, face, body_size)
        if radius < math.inf:
            h = 2.0 * radius / size.across
            if not coaxial:
                h = min(math.pi / 2 * radius / size.arc, math.pi * radius / size.across)
            tags.append(near(gmsh, "SurfacesList", [face], min(h, far), size.growth))
    rims = [c for _, c in model.getEntities(1) if _lies_at(gmsh, c, cuts, 1e-6 * body_size)]
    if rims:
        thin = min([far, *(2.0 * _reach(gmsh, c) / size.across for c in rims)])
        tags.append(near(gmsh, "CurvesList", rims, thin / size.corner, size.growth))
    set_size(gmsh, [*tags, formula_size(gmsh, f"{far!r}")])


def _curvature(gmsh: Any, face: int, body_size: float) -> tuple[float, bool]:
    """Smallest radius of curvature of a face, and whether it is a cylinder about the z-axis."""
    at = grid_on(gmsh, (2, face), QUARTERS[1:-1])
    largest = max(np.abs(k).max() for k in gmsh.model.getPrincipalCurvatures(face, at.ravel())[:2])
    if largest * body_size < MAX_PLANE_CURVATURE:
        return math.inf, False
    x = points_at(gmsh, (2, face), at)
    r = np.hypot(x[:, 0], x[:, 1])
    coaxial = gmsh.model.getType(2, face) == "Cylinder" and np.ptp(r) < 1e-6 * body_size
    return float(1.0 / largest), bool(coaxial and abs(r[0] * largest - 1.0) < 1e-6)


def _lies_at(gmsh: Any, curve: int, cuts: list[float], slack: float) -> bool:
    """Whether a curve lies in one of the planes z = `cuts`."""
    z = along(gmsh, curve, QUARTERS)[:, 2]
    return any(float(np.abs(z - cut).max()) < slack for cut in cuts)


def _reach(gmsh: Any, curve: int) -> float:
    """Largest distance of a curve from the z-axis."""
    x = along(gmsh, curve, QUARTERS)
    return float(np.hypot(x[:, 0], x[:, 1]).max())

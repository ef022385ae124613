"""The solids that a body lacks of the profile of its faces of revolution."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from geometry.imported.recognised_cuts import CutFaces
from geometry.imported.sampled_face import SampledFace, sampled_face
from geometry.imported.solid_volume import solid_volume
from geometry.mesh.cut_pin import CutPin
from geometry.mesh.cut_solid import BOOLEAN_TOLERANCE, cut_solid
from geometry.mesh.entities import Entity, along, curves_of, grid_on, points_at
from geometry.mesh.gmsh_session import MeshError, gmsh_model, silence
from geometry.mesh.revolve import revolve
from geometry.shape.band import END_FACES, GeometryError
from geometry.shape.features import Cut
from geometry.shape.pin import Pin
from geometry.shape.profile import meridian, off_edge
from geometry.shape.recess import Line, Recess, RemovedFace, RemovedSolid, is_on_outside, of_solid
from pinbase.arrays import Floats

ON_PROFILE = 1e-5  # of the pin's size: points this close to the outline are on the outline
FACE_FRACTIONS = np.linspace(0.0, 1.0, 17)
EDGE_FRACTIONS = np.linspace(0.0, 1.0, 49)
MAX_SOLIDS = 40  # each takes up to half a second of the time allowed for reading a file
LEAST_VOLUME = 1e-8  # of the pin's volume: smaller solids come from round-off
KNOWN_VOLUME = 1e-4  # of a removed solid's volume: cuts whose volume differs by less replace it
PROBE = 0.05  # step, over the radius of curvature, that shows on which side the centre is
FLAT_CURVATURE = 1e-4  # curvature times the pin's size, up to which a direction is flat


@dataclass(frozen=True)
class Removed:
    """A removed solid. Lengths are in the file's unit.

    faces: faces of the solid that are within the profile.
    """

    recess: Recess
    faces: Sequence[SampledFace]
    volume: float

    def cuts(self, pin: Pin, size: float) -> tuple[Cut, ...]:
        """The known cuts that remove the solid from a profile, otherwise the recess.

        size: size of the body.
        """
        try:
            cuts = CutFaces(self.faces, size).cuts(pin)
            with gmsh_model(pin.name) as gmsh:
                solid = cut_solid(gmsh, pin, CutPin(pin, cuts).cuts)
                removed = sum(solid_volume(gmsh, e) for e in _lacking(gmsh, solid, pin))
        except (ValueError, MeshError):  # GeometryError is a ValueError
            return (self.recess,)
        known = abs(removed - self.volume) < KNOWN_VOLUME * self.volume
        return cuts if known else (self.recess,)


def removed_solids(gmsh: Any, body: Entity, pin: Pin) -> list[Removed]:
    """The solids that a body in gmsh's model lacks of a profile in the same axes.

    Raises: GeometryError where the body is not within the profile, or lacks too many solids of it.
    """
    volume = solid_volume(gmsh, body)
    solids = _lacking(gmsh, body, pin)
    if len(solids) > MAX_SOLIDS:
        raise GeometryError(f"{len(solids)} solids are removed from it", "too-many-recesses")
    out = [_removed(gmsh, solid, pin) for solid in solids]
    if abs(pin.volume - sum(r.volume for r in out) - volume) > ON_PROFILE * volume:
        raise GeometryError("a part of it stands out of its faces of revolution", "stands-out")
    return [
        replace(r, recess=replace(r.recess, solid=replace(r.recess.solid, text=text)))
        for r, text in zip(out, _texts(gmsh, solids), strict=True)
    ]


def _lacking(gmsh: Any, body: Entity, pin: Pin) -> list[Entity]:
    """The solids that a body in gmsh's model lacks of a profile; the body is removed."""
    occ = gmsh.model.occ
    gmsh.model.mesh.clear()
    gmsh.option.setNumber("Geometry.ToleranceBoolean", BOOLEAN_TOLERANCE * pin.length)
    lacking, _ = occ.cut([revolve(gmsh, meridian(pin))], [body])
    occ.synchronize()
    return [(d, t) for d, t in lacking if occ.getMass(d, t) > LEAST_VOLUME * pin.volume]


def _removed(gmsh: Any, solid: Entity, pin: Pin) -> Removed:
    """A removed solid in gmsh's model."""
    edges, near = meridian(pin), ON_PROFILE * max(pin.length, pin.largest_diameter)
    off = [off_edge(edge) for edge in edges]
    mouth, inner, seen = list[Line](), list[Line](), set[int]()
    faces, sampled = list[RemovedFace](), list[SampledFace]()
    for _, tag in gmsh.model.getBoundary([solid], oriented=False):
        x = _points(gmsh, tag)
        r = np.hypot(x[:, 0], x[:, 1])
        if min(float(f(r, x[:, 2]).max()) for f in off) < near:
            continue
        radius = _rounding(gmsh, solid, tag, x, pin)
        faces.append(_face(f"{'fillet' if radius else 'face'} {len(faces) + 1}", radius, x))
        sampled.append(sampled_face(gmsh, tag, f"face {tag}"))
        for curve in curves_of(gmsh, [tag]):
            if curve not in seen:
                seen.add(curve)
                points = along(gmsh, curve, EDGE_FRACTIONS)
                line = tuple((a, b, c) for a, b, c in points.tolist())
                (mouth if is_on_outside(pin, points) else inner).append(line)
    every = [p for line in (*mouth, *inner) for p in line]
    z = [p[2] for p in every]
    cut = min(z) < near, max(z) > pin.length - near
    ends = tuple(name for name, is_cut in zip(END_FACES, cut, strict=True) if is_cut)
    removed = RemovedSolid("", tuple(faces), tuple(mouth), tuple(inner), ends)
    return Removed(of_solid(removed, _width(removed)), sampled, solid_volume(gmsh, solid))


def _texts(gmsh: Any, solids: Sequence[Entity]) -> list[str]:
    """The solids of gmsh's model, each in OpenCASCADE's BREP format.

    Afterwards another model is current in gmsh.
    """
    middles = [gmsh.model.occ.getCenterOfMass(*solid) for solid in solids]
    out = []
    with tempfile.TemporaryDirectory() as folder:
        every, path = Path(folder) / "all.brep", Path(folder) / "solid.brep"
        gmsh.write(str(every))
        for middle in middles:
            gmsh.model.add("solid")  # one model for each solid, because gmsh writes whole models
            occ = gmsh.model.occ
            with silence():
                read = occ.importShapes(str(every))
            far = [math.dist(occ.getCenterOfMass(*entity), middle) for entity in read]
            kept = int(np.argmin(far))
            occ.remove([e for k, e in enumerate(read) if k != kept], recursive=True)
            occ.synchronize()
            gmsh.write(str(path))
            out.append(path.read_text())
    return out


def _points(gmsh: Any, face: int) -> Floats:
    """Points on a face and its edges, (P, 3)."""
    at = grid_on(gmsh, (2, face), FACE_FRACTIONS)
    on = [gmsh.model.isInside(2, face, p, parametric=True) > 0 for p in at.tolist()]
    inside = points_at(gmsh, (2, face), at[on])
    rim = (along(gmsh, curve, EDGE_FRACTIONS) for curve in curves_of(gmsh, [face]))
    return np.concatenate([inside, *rim])


def _face(part: str, radius: float, x: Floats) -> RemovedFace:
    """A face from points x (P, 3) on it."""
    distance = np.asarray(KDTree(x).query(x, min(5, len(x)))[0])
    points = tuple((a, b, c) for a, b, c in x.tolist())
    return RemovedFace(part, radius, points, float(distance[:, -1].max()))


def _rounding(gmsh: Any, solid: Entity, face: int, x: Floats, pin: Pin) -> float:
    """The least radius of an inner corner of the pin that a face rounds; 0 where it rounds none.

    A face rounds an inner corner if its centre of curvature is on the side of the removed solid.
    x: (P, 3) points on the face.
    """
    model, size = gmsh.model, pin.largest_diameter
    at = model.getParametrization(2, face, x.ravel())
    most, least, along, across = model.getPrincipalCurvatures(face, at)
    k = np.stack([most, least], axis=1)
    radii = []
    for column, directions in enumerate((along, across)):
        for row in np.argsort(-np.abs(k[:, column])).tolist():
            curvature = abs(float(k[row, column]))
            if not FLAT_CURVATURE < curvature * size < math.inf:
                continue
            # A step along a curved direction leaves the surface on the side away from the centre of
            # curvature. The distance must agree with the curvature, which is wrong at poles of
            # splines.
            step = PROBE / curvature
            beside = x[row] + step * np.reshape(directions, (-1, 3))[row]
            back = np.reshape(model.getClosestPoint(2, face, beside)[0], 3) - beside
            length = float(np.linalg.norm(back))
            if abs(length - 0.5 * PROBE * step) < PROBE * step / 6.0:
                if model.isInside(*solid, (x[row] + step / length * back).tolist()):
                    radii.append(1.0 / curvature)
                break
    return min(radii, default=0.0)


def _width(solid: RemovedSolid) -> float:
    """The width of a removed solid: the second of its three extents, or twice the least if less."""
    x = np.array([p for line in (*solid.mouth, *solid.inner) for p in line])
    x = np.concatenate([x, *(np.array(face.points) for face in solid.faces)])
    x = x - x.mean(axis=0)
    axes = np.linalg.svd(x, full_matrices=False)[2]
    _, second, least = sorted(np.ptp(x @ axes.T, axis=0), reverse=True)
    return float(min(second, 2.0 * least))

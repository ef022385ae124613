"""The bands and end faces of a body, identified on its mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import ElementTetP2, FacetBasis, MeshTet2

from geometry.imported.body_file import BodyFile, Place
from geometry.shape.band import END_FACES, Band, GeometryError
from pinbase.arrays import Floats, Ints, Mask

MIN_OUTWARD_COSINE = 0.5  # least cosine of the angle between normal and radius on outer surfaces
MAX_FACET_DEPTH = 0.02  # of the local radius: largest depth of corners of a band's facets below it
BAND_END_SLACK = 1e-6  # of the body's length: facets this close to an end lie in the end face


@dataclass(frozen=True)
class MeasuredBand(Band):
    """A band whose area and mean radius are measured on the mesh. measured: area, m^2."""

    measured: float = 0.0

    @property
    def area(self) -> float:
        """Area on the mesh, m^2."""
        return self.measured


@dataclass(frozen=True)
class Facets:
    """The boundary facets of a mesh, treated as plane.

    number: (F,) numbers of the facets in the mesh.
    corners: (F, 3, 3) m.
    normals: (F, 3) outward normals, whose length is the area, m^2.
    """

    number: Ints
    corners: Floats
    normals: Floats

    @property
    def areas(self) -> Floats:
        """Areas of the facets, (F,) m^2."""
        return np.asarray(np.linalg.norm(self.normals, axis=1))


def facets(mesh: MeshTet2) -> Facets:
    """The boundary facets of a mesh."""
    number = mesh.boundary_facets()
    x = mesh.doflocs.T
    corners = x[mesh.facets[:, number].T]
    normals = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inside = x[mesh.t[:, mesh.f2t[0, number]].T].mean(axis=1)
    inward = np.sum(normals * (inside - corners[:, 0]), axis=1) > 0.0
    normals[inward] *= -1.0
    return Facets(number, corners, normals)


def with_places(mesh: MeshTet2, file: BodyFile) -> MeshTet2:
    """The mesh with the file's bands among its boundaries.

    Plane faces at the least and greatest z become "start" and "end".

    Raises: GeometryError when a band is not on the mesh.
    """
    named: dict[str, Ints] = dict(mesh.boundaries or {})
    surface = facets(mesh)
    z = surface.corners[..., 2]
    slack = BAND_END_SLACK * np.ptp(z)
    for name, at in zip(END_FACES, (z.min(), z.max()), strict=True):
        flat = (np.abs(z - at) < slack).all(axis=1)
        if flat.any():
            named.setdefault(name, surface.number[flat])
    bands = {p.name: _band_facets(surface, named, p, file) for p in file.places}
    return mesh.with_boundaries({**named, **bands})


def _band_facets(surface: Facets, named: dict[str, Ints], place: Place, file: BodyFile) -> Ints:
    """Numbers of the facets of a band. Raises: GeometryError when there are none."""
    where = f"pin {file.name}: band {place.name}"
    if place.surface is not None:
        if place.surface not in named:
            known = ", ".join(n for n in named if n not in END_FACES) or "none"
            raise GeometryError(
                f"{where}: {file.path.name} has no surface {place.surface!r}; its surfaces are "
                f"{known}",
                "unknown-surface",
                ("band", place.name),
            )
        return named[place.surface]
    assert place.z is not None
    on = outermost(surface, *place.z)
    if not on.any():
        low, high = surface.corners[..., 2].min(), surface.corners[..., 2].max()
        a, b, low, high = (v / file.unit for v in (*place.z, low, high))
        raise GeometryError(
            f"{where}: no outer surface between z = {a:.6g} and {b:.6g} in {file.path.name}, "
            f"which extends from z = {low:.6g} to {high:.6g} (in the file's unit); a surface that "
            "is not a cylinder about the z-axis can be given by its name",
            "band-not-found",
            ("band", place.name),
        )
    return surface.number[on]


def outermost(surface: Facets, z0: float, z1: float) -> Mask:
    """Mask (F,) of the facets of the outermost surface between z0 and z1 (m).

    The middle of such a facet lies between z0 and z1, the facet faces away from the z-axis, and at
    its z no other such facet is farther from the axis.
    """
    middle = surface.corners.mean(axis=1)
    r = np.hypot(middle[:, 0], middle[:, 1])
    outward = np.sum(middle[:, :2] * surface.normals[:, :2], axis=1)
    facing = outward > MIN_OUTWARD_COSINE * r * surface.areas
    on = (middle[:, 2] > z0) & (middle[:, 2] < z1) & facing
    candidates = np.flatnonzero(on)
    # Compare each candidate with the largest radius of the candidates in its range of z.
    candidates = candidates[np.argsort(middle[candidates, 2])]
    height, radius = middle[candidates, 2], np.hypot(*np.moveaxis(surface.corners, -1, 0)[:2])
    largest = radius[candidates].max(axis=1, initial=0.0)
    z = surface.corners[candidates][..., 2]
    first = np.searchsorted(height, z.min(axis=1, initial=np.inf))
    last = np.searchsorted(height, z.max(axis=1, initial=-np.inf))
    for i, facet in enumerate(candidates):
        outer = max(largest[first[i] : last[i]].max(initial=0.0), largest[i])
        on[facet] = radius[facet].min() > (1.0 - MAX_FACET_DEPTH) * outer
    return np.asarray(on)


def measure(mesh: MeshTet2, place: Place) -> MeasuredBand:
    """A band with its ends, mean radius and area on the mesh."""
    basis = FacetBasis(mesh, ElementTetP2(), facets=mesh.boundaries[place.name], intorder=4)
    x, weight = np.asarray(basis.global_coordinates()), np.asarray(basis.dx)
    z = mesh.doflocs[2, mesh.facets[:, mesh.boundaries[place.name]]]
    z0, z1 = place.z or (float(z.min()), float(z.max()))
    area = float(weight.sum())
    radius = float((np.hypot(x[0], x[1]) * weight).sum()) / area
    return MeasuredBand(place.name, z0, z1, radius, area)

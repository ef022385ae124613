"""Bands and end faces of a body, found on its mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import ElementTetP2, FacetBasis, MeshTet2

from geometry.imported.body_file import BodyFile, Place
from geometry.shape.pin import END_FACES, Band, GeometryError
from pinbase.arrays import Floats, Ints, Mask

MIN_OUTWARD_COSINE = 0.5  # cosine to the radius above which a facet belongs to an outer surface
MAX_FACET_DEPTH = 0.02  # of the local radius: how far below it corners of a band's facets may lie
BAND_END_SLACK = 1e-6  # of the body's length


@dataclass(frozen=True)
class MeasuredBand(Band):
    """A band whose area (m^2) and mean radius are those of the mesh."""

    measured: float = 0.0

    @property
    def area(self) -> float:
        """m^2."""
        return self.measured


@dataclass(frozen=True)
class Facets:
    """The boundary: facets (F,) by number, corners (F, 3, 3) m, normals (F, 3) outward with the
    area as length, m^2; linear between the corners.
    """

    number: Ints
    corners: Floats
    normals: Floats

    @property
    def areas(self) -> Floats:
        """(F,) m^2."""
        return np.asarray(np.linalg.norm(self.normals, axis=1))


def facets(mesh: MeshTet2) -> Facets:
    """The boundary of a mesh."""
    number = mesh.boundary_facets()
    x = mesh.doflocs.T
    corners = x[mesh.facets[:, number].T]
    normals = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inside = x[mesh.t[:, mesh.f2t[0, number]].T].mean(axis=1)
    inward = np.sum(normals * (inside - corners[:, 0]), axis=1) > 0.0
    normals[inward] *= -1.0
    return Facets(number, corners, normals)


def with_places(mesh: MeshTet2, file: BodyFile) -> MeshTet2:
    """The mesh with the file's bands among its boundaries, and "start" and "end" where there are
    plane faces at the least and greatest z.

    Raises: GeometryError when a band is not on it.
    """
    named: dict[str, Ints] = dict(mesh.boundaries or {})
    here = facets(mesh)
    z = here.corners[..., 2]
    slack = BAND_END_SLACK * np.ptp(z)
    for name, at in zip(END_FACES, (z.min(), z.max()), strict=True):
        flat = (np.abs(z - at) < slack).all(axis=1)
        if flat.any():
            named.setdefault(name, here.number[flat])
    found = {p.name: _find(here, named, p, file) for p in file.places}
    return mesh.with_boundaries({**named, **found})


def _find(here: Facets, named: dict[str, Ints], place: Place, file: BodyFile) -> Ints:
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
    on = outermost(here, *place.z)
    if not on.any():
        low, high = here.corners[..., 2].min(), here.corners[..., 2].max()
        a, b, low, high = (v / file.unit for v in (*place.z, low, high))
        raise GeometryError(
            f"{where}: no outer surface between z = {a:.6g} and {b:.6g} in {file.path.name}, "
            f"which extends from z = {low:.6g} to {high:.6g} (in the file's unit); a surface that "
            "is not a cylinder about the z-axis can be given by its name",
            "band-not-found",
            ("band", place.name),
        )
    return here.number[on]


def outermost(here: Facets, z0: float, z1: float) -> Mask:
    """Which facets have their middle between z0 and z1 (m) and, at their z, lie furthest from the
    z-axis, facing away from it.
    """
    middle = here.corners.mean(axis=1)
    r = np.hypot(middle[:, 0], middle[:, 1])
    facing = (
        np.sum(middle[:, :2] * here.normals[:, :2], axis=1) > MIN_OUTWARD_COSINE * r * here.areas
    )
    on = (middle[:, 2] > z0) & (middle[:, 2] < z1) & facing
    candidates = np.flatnonzero(on)
    candidates = candidates[np.argsort(middle[candidates, 2])]
    height, radius = middle[candidates, 2], np.hypot(*np.moveaxis(here.corners, -1, 0)[:2])
    largest = radius[candidates].max(axis=1, initial=0.0)
    z = here.corners[candidates][..., 2]
    first = np.searchsorted(height, z.min(axis=1, initial=np.inf))
    last = np.searchsorted(height, z.max(axis=1, initial=-np.inf))
    for i, facet in enumerate(candidates):
        outer = max(largest[first[i] : last[i]].max(initial=0.0), largest[i])
        on[facet] = radius[facet].min() > (1.0 - MAX_FACET_DEPTH) * outer
    return np.asarray(on)


def measure(mesh: MeshTet2, place: Place) -> MeasuredBand:
    """A band's ends, mean radius and area on the mesh."""
    basis = FacetBasis(mesh, ElementTetP2(), facets=mesh.boundaries[place.name], intorder=4)
    x, weight = np.asarray(basis.global_coordinates()), np.asarray(basis.dx)
    z = mesh.doflocs[2, mesh.facets[:, mesh.boundaries[place.name]]]
    z0, z1 = place.z or (float(z.min()), float(z.max()))
    area = float(weight.sum())
    radius = float((np.hypot(x[0], x[1]) * weight).sum()) / area
    return MeasuredBand(place.name, z0, z1, radius, area)

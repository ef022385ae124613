"""A pin of any shape, from a CAD file or a mesh; the z-axis of the file is the pin's axis."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar, Never

import numpy as np
from skfem import MeshTet2

from geometry.imported.body_file import BodyFile
from geometry.imported.cad_mesh import cad_mesh, cad_volume
from geometry.imported.mesh_file import mesh_from_file
from geometry.imported.named_bands import facets, measure, with_places
from geometry.mesh.solid_mesh import MeshSize, SolidMesh
from geometry.mesh.tet10 import refined
from geometry.shape.band import Band, GeometryError

MEASURING_MESH_SIZE = MeshSize(across=3.0, corner=1.0)  # mesh on which a CAD file is measured


MIN_ARC_ANGLE = 0.035  # rad (2 deg): flatter arcs lose less than 0.02 % of their section
# Largest difference between the inclinations of the normals at an arc's ends to its chord, relative
# to the arc's angle.
MAX_LEAN_DIFFERENCE = 0.3
CHORD_NODE_TOLERANCE = 0.05  # of an arc's sag: a midside node nearer to the chord lies on the chord
MAX_STRAIGHT_SHARE = 0.5  # of the arcs; a larger share of straight edges means straight elements


def call_directly(work: Callable[..., Any], *arguments: object) -> Any:
    """The result of `work`, run in this process."""
    return work(*arguments)


@dataclass(frozen=True)
class SolidBody:
    """The body in a file, with its bands measured on a mesh.

    call: function that runs `work(file, ...)`. It may use another process, because the libraries
    that read the file crash on some damaged files.
    source: reason why the body is not a profile, for people.

    Raises: GeometryError when the file is missing or not a solid, or a band is not on it;
    MeshError when the body cannot be meshed.
    """

    file: BodyFile
    call: Callable[..., Any] = field(default=call_directly, compare=False, repr=False)
    source: str = field(default="", compare=False)

    revolved: ClassVar[bool] = False  # it is not known to be a body of revolution
    profile: ClassVar[None] = None
    cuts: ClassVar[Mapping[str, Never]] = MappingProxyType({})

    def __post_init__(self) -> None:
        if not self.file.path.is_file():
            raise GeometryError(
                f"pin {self.name}: file {self.file.path} does not exist", "no-such-file"
            )
        for place in self.file.places:
            if place.z is not None and not place.z[0] < place.z[1]:
                raise GeometryError(
                    f"pin {self.name}: band {place.name}: z = [a, b] requires a < b",
                    "z-reversed",
                    ("band", place.name),
                )
        self._coarse  # noqa: B018  so that a file that cannot be used is reported at once

    @cached_property
    def _coarse(self) -> SolidMesh:
        """The coarse mesh on which the body is measured."""
        return self.mesh(MEASURING_MESH_SIZE)

    def mesh(self, size: MeshSize, *most: float) -> SolidMesh:
        """A mesh of this size.

        The elements of a mesh file are halved once for every factor of two by which `size` is finer
        than the default.
        most: for CAD files, optionally the largest number of unknowns that is allowed.
        """
        if not self.meshed:
            solid: SolidMesh = self.call(cad_mesh, self.file, size, *most)
            return SolidMesh(with_places(solid.mesh, self.file), solid.jacobian, solid.repaired)
        solid = self._read
        mesh = with_places(solid.mesh, self.file)
        for _ in range(round(np.log2(max(size.across / MeshSize().across, 1.0)))):
            mesh = refined(mesh)
        return SolidMesh(mesh, solid.jacobian, solid.repaired)

    @cached_property
    def _read(self) -> SolidMesh:
        """The mesh in a mesh file."""
        solid: SolidMesh = self.call(mesh_from_file, self.file)
        return solid

    @property
    def name(self) -> str:
        """Name of the pin."""
        return self.file.name

    @property
    def meshed(self) -> bool:
        """Whether the body's file is a mesh."""
        return self.file.meshed

    @cached_property
    def ends(self) -> tuple[float, float]:
        """Least and greatest z, m."""
        z = self._coarse.nodes[:, 2]
        return float(z.min()), float(z.max())

    @property
    def length(self) -> float:
        """Overall length, m."""
        return self.ends[1] - self.ends[0]

    @cached_property
    def volume(self) -> float:
        """Volume of the CAD file's solid, or of the mesh, m^3."""
        if not self.meshed:
            volume: float = self.call(cad_volume, self.file)
            return volume
        from skfem import Basis, ElementTetP2

        return float(Basis(self._coarse.mesh, ElementTetP2(), intorder=3).dx.sum())

    @cached_property
    def cut_off(self) -> float:
        """Approximate fraction of the volume that a file's mesh cuts off.

        A mesh cuts off volume where its elements have straight edges although the surface is
        curved.
        """
        return _cut_off(self._coarse.mesh) / self.volume if self.meshed else 0.0

    @property
    def connections(self) -> tuple[str, ...]:
        """Names of the bands on which links bear, in order of z."""
        bands = (self.band(p.name) for p in self.file.places if p.connection)
        return tuple(b.name for b in sorted(bands, key=lambda b: b.middle))

    @cached_property
    def _bands(self) -> dict[str, Band]:
        """All bands by name, measured."""
        return {p.name: measure(self._coarse.mesh, p) for p in self.file.places}

    def band(self, name: str) -> Band:
        """The measured band of this name.

        Raises: GeometryError for an unknown name, with a list of all names.
        """
        if name not in self._bands:
            raise self._unknown(name)
        return self._bands[name]

    def surface(self, name: str) -> str:
        """The mesh boundary of this name: a band, a surface of the file, "start" or "end".

        Raises: GeometryError for an unknown name, with a list of all names.
        """
        if name not in self._coarse.mesh.boundaries:
            raise self._unknown(name)
        return name

    def _unknown(self, name: str) -> GeometryError:
        """The error for a name that is not a surface."""
        known = ", ".join(self._coarse.mesh.boundaries)
        return GeometryError(
            f"pin {self.name} has no surface {name!r}; its surfaces are {known}", "unknown-surface"
        )


def _cut_off(mesh: MeshTet2) -> float:
    """Volume (m^3) between a mesh with straight edges and the round surface that it approximates.

    It is 0 for curved edges, and for bodies that are not round. An edge is the chord of an arc if
    the surface's normals at its ends are inclined away from each other by equal angles, together
    the arc's angle. The sags of a facet's edges, as quadratic shapes, enclose a third of the
    facet's area times their sum.
    """
    here, x = facets(mesh), mesh.doflocs.T
    normals = np.zeros((mesh.nvertices, 3))
    for corner in mesh.facets[:, here.number]:
        np.add.at(normals, corner, here.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    edge = mesh.f2e[:, here.number].ravel()
    a, b = mesh.edges[:, edge]
    length = np.linalg.norm(x[b] - x[a], axis=1)
    lean = [np.sum(normals[end] * (x[b] - x[a]), axis=1) / length for end in (a, b)]
    angle = np.abs(lean[1] - lean[0])
    arcs = (angle > MIN_ARC_ANGLE) & (np.abs(lean[0] + lean[1]) < MAX_LEAN_DIFFERENCE * angle)
    off = np.linalg.norm(x[mesh.nvertices + edge] - 0.5 * (x[a] + x[b]), axis=1)
    straight = arcs & (off < CHORD_NODE_TOLERANCE * length * angle / 8.0)
    if straight.sum() <= MAX_STRAIGHT_SHARE * arcs.sum():
        return 0.0
    sag = np.where(straight, length * angle / 8.0, 0.0)
    return float(np.tile(here.areas, 3) @ sag / 3.0)

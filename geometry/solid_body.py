"""A pin of any shape, from a CAD file or a mesh; the z-axis of the file is the pin's axis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from geometry.body_file import BodyFile
from geometry.cad_mesh import cad_mesh, cad_volume
from geometry.mesh_file import mesh_from_file
from geometry.pin import Band, GeometryError
from geometry.places import measure, with_places
from geometry.quadratic import refined
from geometry.solid_mesh import MeshSize, SolidMesh
from geometry.straight import cut_off

MEASURE = MeshSize(across=3.0, corner=1.0)  # the mesh on which a CAD file is measured


@dataclass(frozen=True)
class SolidBody:
    """What a file holds, with its bands measured.

    Raises: GeometryError when the file is missing or no solid, or a band is nowhere on it;
    MeshError when it cannot be meshed.
    """

    file: BodyFile

    def __post_init__(self) -> None:
        if not self.file.path.is_file():
            raise GeometryError(f"pin {self.name}: there is no file {self.file.path}")
        for place in self.file.places:
            if place.z is not None and not place.z[0] < place.z[1]:
                raise GeometryError(
                    f"pin {self.name}: band {place.name}: z = [a, b] needs a below b"
                )
        self._coarse  # noqa: B018  a file that cannot be used is told at once

    @cached_property
    def _coarse(self) -> SolidMesh:
        return self.mesh(MEASURE)

    def mesh(self, size: MeshSize) -> SolidMesh:
        """A mesh of this size; a file that is a mesh is halved as often as `size` is twice as fine
        as the usual one.
        """
        if not self.meshed:
            made = cad_mesh(self.file, size)
            return SolidMesh(with_places(made.mesh, self.file), made.jacobian, made.repaired)
        made = mesh_from_file(self.file)
        mesh = with_places(made.mesh, self.file)
        for _ in range(round(np.log2(max(size.across / MeshSize().across, 1.0)))):
            mesh = refined(mesh)
        return SolidMesh(mesh, made.jacobian, made.repaired)

    @property
    def name(self) -> str:
        """The pin's."""
        return self.file.name

    @property
    def revolved(self) -> bool:
        """Whether it is known to be the same all round its axis: never."""
        return False

    @property
    def meshed(self) -> bool:
        """Whether it comes with a mesh."""
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
        """m^3: of the CAD file's solids, or of the mesh."""
        if not self.meshed:
            return cad_volume(self.file)
        from skfem import Basis, ElementTetP2

        return float(Basis(self._coarse.mesh, ElementTetP2(), intorder=3).dx.sum())

    @cached_property
    def cut_off(self) -> float:
        """Part of the volume that a file's mesh lacks, or has in excess, because its elements'
        sides are straight where the surface is round, roughly.
        """
        return cut_off(self._coarse.mesh) / self.volume if self.meshed else 0.0

    @property
    def connections(self) -> tuple[str, ...]:
        """Bands on which links bear, by z."""
        bands = (self.band(p.name) for p in self.file.places if p.connection)
        return tuple(b.name for b in sorted(bands, key=lambda b: b.middle))

    @cached_property
    def _bands(self) -> dict[str, Band]:
        return {p.name: measure(self._coarse.mesh, p) for p in self.file.places}

    def band(self, name: str) -> Band:
        """A band by name, measured. Raises: GeometryError listing the names there are."""
        if name not in self._bands:
            raise GeometryError(self._unknown(name))
        return self._bands[name]

    def surface(self, name: str) -> str:
        """The mesh boundary of that name: a band, a surface of the file, "start" or "end".

        Raises: GeometryError listing the names there are.
        """
        if name not in self._coarse.mesh.boundaries:
            raise GeometryError(self._unknown(name))
        return name

    def _unknown(self, name: str) -> str:
        known = ", ".join(self._coarse.mesh.boundaries)
        return f"pin {self.name} has no surface {name!r}; it has {known}"

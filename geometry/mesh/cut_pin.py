"""A pin turned on a lathe and then drilled across and milled flat in places."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from geometry.mesh.cut_solid import cut_solid, name_faces
from geometry.mesh.gmsh_session import gmsh_model
from geometry.mesh.scale import unit_of_solid
from geometry.shape.features import Flat, Hole, check_flat, check_hole
from geometry.shape.pin import Band, GeometryError, Pin


@dataclass(frozen=True)
class CutPin:
    """A profile with holes and flats; its bands keep their names and positions, less what is cut.
    Ends of flats within the profile's tolerance of a band's lie there.

    Raises: GeometryError when a feature does not cut the pin, or cuts it in two.
    """

    profile: Pin
    holes: tuple[Hole, ...] = ()
    flats: tuple[Flat, ...] = ()

    meshed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        marks = {*self.profile.stations, *(z for b in self.profile.bands for z in (b.z0, b.z1))}
        flats = tuple(flat.snapped(marks, self.profile.tolerance) for flat in self.flats)
        object.__setattr__(self, "flats", flats)
        for i, hole in enumerate(self.holes, 1):
            check_hole(self.profile, i, hole)
        for i, flat in enumerate(self.flats, 1):
            check_flat(self.profile, i, flat)

    @property
    def name(self) -> str:
        """The profile's."""
        return self.profile.name

    @property
    def source(self) -> str:
        """The profile's."""
        return self.profile.source

    @property
    def length(self) -> float:
        """Overall length, m."""
        return self.profile.length

    @property
    def ends(self) -> tuple[float, float]:
        """Least and greatest z, m."""
        return self.profile.ends

    @property
    def revolved(self) -> bool:
        """Whether nothing is cut."""
        return not (self.holes or self.flats)

    @property
    def connections(self) -> tuple[str, ...]:
        """Connections that bear on it, in the order of the profile."""
        return self.profile.connections

    def band(self, name: str) -> Band:
        """The outer surface called `name` before it is cut."""
        return self.profile.band(name)

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study: also "hole 1" or "flat 1".

        Raises: GeometryError listing the names there are.
        """
        own = [f"hole {i}" for i in range(1, len(self.holes) + 1)]
        own += [f"flat {i}" for i in range(1, len(self.flats) + 1)]
        if name in own:
            return name
        try:
            return self.profile.surface(name)
        except GeometryError as error:
            raise GeometryError(", ".join([str(error), *own]), error.code) from None

    @cached_property
    def volume(self) -> float:
        """Volume, m^3, of the solid that OpenCASCADE cuts.

        Raises: GeometryError where the cuts leave several pieces, or nothing of a band or of each
        other; MeshError.
        """
        if self.revolved:
            return self.profile.volume
        unit = unit_of_solid(self.profile)
        cut = self.scaled(1.0 / unit)
        with gmsh_model(self.name) as gmsh:
            solid = cut_solid(gmsh, cut.profile, cut.holes, cut.flats)
            name_faces(gmsh, cut.profile, cut.holes, cut.flats)
            return float(gmsh.model.occ.getMass(*solid)) * unit**3

    def require_whole(self) -> None:
        """Raises: as `volume`, which is found on the way."""
        assert self.volume > 0.0

    def scaled(self, factor: float) -> CutPin:
        """The same pin in another unit."""
        holes = tuple(hole.scaled(factor) for hole in self.holes)
        flats = tuple(flat.scaled(factor) for flat in self.flats)
        return CutPin(self.profile.scaled(factor), holes, flats)

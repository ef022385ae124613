"""A pin that is turned on a lathe, then drilled and milled."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import ClassVar

from geometry.mesh.cut_solid import cut_solid, named_parts
from geometry.mesh.gmsh_session import gmsh_model
from geometry.mesh.scale import unit_of_solid
from geometry.shape.band import Band, GeometryError
from geometry.shape.features import Cut
from geometry.shape.hole import Hole
from geometry.shape.pin import Pin
from pinbase.errors import Place

KINDS = ("hole", "flat", "slot", "passage", "recess")  # in this order they are cut


@dataclass(frozen=True)
class CutPin:
    """A profile with cuts, whose bands keep their names and positions.

    Ends of flats and slots within the profile's tolerance of the end of a band are moved there.

    Raises: GeometryError when a cut does not cut the pin, or cuts it in two.
    """

    profile: Pin
    features: Iterable[Cut] = ()

    meshed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        profile = self.profile
        by_kind = sorted(self.features, key=lambda cut: KINDS.index(cut.what))
        named = _named(tuple(cut.on(profile) for cut in by_kind))
        for name, cut in named.items():
            what, i = name.split()
            cut.check(profile, name, (what, int(i)))
            _require_own_name(profile, name, (what, int(i)))
        holes = [(name, cut) for name, cut in named.items() if isinstance(cut, Hole)]
        for (first, a), (second, b) in combinations(holes, 2):
            if (a.z, a.angle, a.offset, a.tilt) != (b.z, b.angle, b.offset, b.tilt):
                b.check_beside(a, (second, first), profile, ("hole", int(second.split()[1])))
        features = tuple(cut.past(profile) for cut in named.values())
        object.__setattr__(self, "features", features)

    @cached_property
    def cuts(self) -> dict[str, Cut]:
        """All cuts by their names, such as "hole 1": each kind is numbered in its own order."""
        return _named(self.features)

    @property
    def name(self) -> str:
        """Name of the profile."""
        return self.profile.name

    @property
    def source(self) -> str:
        """Source of the profile's shape, for people."""
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
        """Whether the pin is a body of revolution: it has no cuts."""
        return not self.cuts

    @property
    def connections(self) -> tuple[str, ...]:
        """Connections that bear on this pin, in the order of the profile."""
        return self.profile.connections

    def band(self, name: str) -> Band:
        """The outer surface called `name`, before cutting."""
        return self.profile.band(name)

    def surface(self, name: str) -> str:
        """The mesh boundary for a name in a study, including "hole 1", "flat 1" and so on.

        Raises: GeometryError for an unknown name, with a list of all names.
        """
        if name in self.cuts:
            return name
        try:
            return self.profile.surface(name)
        except GeometryError as error:
            raise GeometryError(", ".join([str(error), *self.cuts]), error.code) from None

    @cached_property
    def volume(self) -> float:
        """Volume of the solid that OpenCASCADE cuts, m^3.

        Raises: GeometryError where the cuts leave several pieces, or remove all of a band or of
        another cut; MeshError where OpenCASCADE fails.
        """
        if self.revolved:
            return self.profile.volume
        unit = unit_of_solid(self.profile, self.cuts.values())
        cut = self.scaled(1.0 / unit)
        with gmsh_model(self.name) as gmsh:
            solid = cut_solid(gmsh, cut.profile, cut.cuts)
            named_parts(gmsh, cut.profile, cut.cuts)
            return float(gmsh.model.occ.getMass(*solid)) * unit**3

    def require_whole(self) -> None:
        """Compute the volume, and raise its errors."""
        assert self.volume > 0.0

    def scaled(self, factor: float) -> CutPin:
        """The same pin in another unit of length: all lengths times `factor`."""
        cuts = (cut.scaled(factor) for cut in self.cuts.values())
        return CutPin(self.profile.scaled(factor), cuts)


def _require_own_name(profile: Pin, cut: str, at: Place) -> None:
    """Raise GeometryError where a segment of the profile has the name of a cut or of its part."""
    for segment in profile.segments:
        for name in (segment.connection, segment.name):
            if name and f"{name} ".startswith(f"{cut} "):
                raise GeometryError(
                    f"pin {profile.name}: the segment {name!r} has the name that {cut} has of "
                    "itself; choose another name",
                    "duplicate-name",
                    at,
                )


def _named(cuts: Iterable[Cut]) -> dict[str, Cut]:
    """The cuts by name, which consists of kind and number."""
    count: Counter[str] = Counter()
    named = {}
    for cut in cuts:
        count[cut.what] += 1
        named[f"{cut.what} {count[cut.what]}"] = cut
    return named

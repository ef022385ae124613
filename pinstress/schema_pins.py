"""The study file's form: materials and pins."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from pinstress.quantities import (
    Angle,
    Density,
    Length,
    NotNegativeLength,
    PositiveLength,
    Stress,
    Table,
)


class MaterialTable(Table):
    """An isotropic linear-elastic material."""

    youngs_modulus: Stress
    """Young's modulus."""
    poisson_ratio: Annotated[float, Field(gt=-1.0, lt=0.5)]
    """Poisson's ratio."""
    density: Density | None = None
    """For weights; of a pin that nothing holds also for its inertia. Absent: no weight."""
    yield_strength: Stress | None = None
    """For factors of safety, which are absent without it."""


class SegmentTable(Table):
    """A cylinder of a pin's profile."""

    length: PositiveLength
    """Along the axis."""
    diameter: PositiveLength
    """Outer diameter."""
    bore: NotNegativeLength = 0.0
    """Inner diameter, less than the outer one; 0: solid."""
    name: str | None = None
    """What `clamp` calls its outer surface; its connection if absent."""
    connection: str | None = None
    """The link that bears on its outer surface; also the surface's name."""
    fillet: NotNegativeLength | None = None
    """Radius at the inner corner at its far end, instead of the pin's `fillet`."""


class HoleTable(Table):
    """A hole through the whole pin and its axis."""

    z: PositiveLength
    """Where its axis crosses the pin's."""
    diameter: PositiveLength
    """Of the hole."""
    angle: Angle = 0.0
    """Direction of its axis, from x."""


class FlatTable(Table):
    """A plane face milled along a stretch of the pin."""

    z: tuple[Length, Length]
    """Where it begins and ends."""
    distance: PositiveLength
    """What lies further from the axis than this, in the direction `angle`, is taken away."""
    angle: Angle = 0.0
    """Direction of its normal, from x."""


class BandTable(Table):
    """A band of a pin from a file. Give either `z` or `surface`."""

    z: tuple[Length, Length] | None = None
    """The outermost surface between two z of the file."""
    surface: str | None = None
    """The file's surface of that name."""
    connection: bool = True
    """Whether the link of the band's name bears there; false for what is only clamped."""

    @model_validator(mode="after")
    def _one_place(self) -> "BandTable":
        if (self.z is None) == (self.surface is None):
            raise ValueError('give either z = [a, b] or surface = "..."')
        return self


class PinTable(Table):
    """A pin: a body of revolution, or what a file holds, and what holds it."""

    material: str
    """Name of a `[material]`."""
    profile: Annotated[list[SegmentTable], Field(min_length=1)] | None = None
    """Segments from z = 0 on. Give either `profile` or `geometry`."""
    fillet: NotNegativeLength = 0.0
    """Radius at every inner corner of the shaft, tangent to the thinner shaft and to the shoulder
    face; 0: sharp. With a profile only."""
    hole: list[HoleTable] = []
    """Cross holes. With a profile only."""
    flat: list[FlatTable] = []
    """Flats. With a profile only."""
    geometry: str | None = None
    """A CAD file (STEP, BREP, IGES) or a mesh of tetrahedra, beside the study."""
    geometry_unit: Literal["mm", "cm", "m", "in"] = "mm"
    """Unit of the file's numbers. With `geometry` only."""
    band: dict[str, BandTable] = {}
    """Bands of a pin from a file, by name. With `geometry` only."""
    clamp: list[str] = []
    """What holds it: "start" and "end" (faces), a segment's name or connection (its outer surface),
    "hole 1", "flat 1", a band. Empty: nothing, and the loads must be nearly in balance."""

    @model_validator(mode="after")
    def _one_shape(self) -> "PinTable":
        if (self.profile is None) == (self.geometry is None):
            raise ValueError('give either profile = [...] or geometry = "file.step"')
        turned = ("fillet", "hole", "flat")
        told = ("band", "geometry_unit") if self.profile is not None else turned
        for key in told:
            if key in self.model_fields_set:
                other = "geometry" if self.profile is not None else "a profile"
                raise ValueError(f"{key} goes with {other} only")
        return self

    @property
    def connections(self) -> list[tuple[str, str]]:
        """Connections that bear on it, each with the key that says so."""
        if self.profile is not None:
            named = enumerate(self.profile, 1)
            return [(f"profile[{i}].connection", s.connection) for i, s in named if s.connection]
        return [(f"band.{name}", name) for name, band in self.band.items() if band.connection]

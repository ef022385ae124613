"""The study file's form: materials and pins."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from loads.coded import LoadsArgumentError
from pinstress.schema.types import (
    Angle,
    Density,
    Length,
    NotNegativeLength,
    Number,
    PositiveLength,
    Stress,
    StrictTable,
    Switch,
    Tilt,
)


class MaterialTable(StrictTable):
    """An isotropic linear-elastic material."""

    youngs_modulus: Stress
    """Young's modulus."""
    poisson_ratio: Annotated[Number, Field(gt=-1.0, lt=0.5)]
    """Poisson's ratio."""
    density: Density | None = None
    """For weights; for an unconstrained pin also its inertia. Absent: no weight."""
    yield_strength: Stress | None = None
    """For factors of safety, which are absent without it."""


class SegmentTable(StrictTable):
    """A cylinder of a pin's profile."""

    length: PositiveLength
    """Along the axis."""
    diameter: PositiveLength
    """Outer diameter."""
    bore: NotNegativeLength = 0.0
    """Inner diameter, less than the outer one; 0: solid."""
    name: str | None = None
    """Name of its outer surface, for `clamp`; by default its connection."""
    connection: str | None = None
    """The link that bears on its outer surface; also the surface's name."""
    fillet: NotNegativeLength | None = None
    """Radius at the inner corner at its far end, instead of the pin's `fillet`."""


class HoleTable(StrictTable):
    """A hole through the whole pin and its axis."""

    z: PositiveLength
    """Position of its axis along the pin."""
    diameter: PositiveLength
    """Of the hole."""
    angle: Angle = 0.0
    """Direction of its axis, from x."""


class FlatTable(StrictTable):
    """A plane face milled along a stretch of the pin."""

    z: tuple[Length, Length]
    """Its start and end along the pin."""
    distance: PositiveLength
    """Distance of the plane from the axis; material beyond it, in direction `angle`, is removed."""
    angle: Angle = 0.0
    """Direction of its normal, from x."""


class BandTable(StrictTable):
    """A band of a pin from a file. Give either `z` or `surface`."""

    z: tuple[Length, Length] | None = None
    """The outermost surface between two z of the file."""
    surface: str | None = None
    """The file's surface of that name."""
    connection: Switch = True
    """Whether the link of the band's name bears on it; false for a band that is only clamped."""

    @model_validator(mode="after")
    def _one_place(self) -> "BandTable":
        if (self.z is None) == (self.surface is None):
            raise LoadsArgumentError('give either z = [a, b] or surface = "..."', "give-one")
        return self


class BushingTable(StrictTable):
    """A ring of another material that is bonded in a lug's bore."""

    thickness: PositiveLength
    """Of its wall."""
    material: str
    """Name of a `[material]`."""


class LugTable(StrictTable):
    """The eye in which the pin sits, a ring about its band: of the link at a connection, or of the
    structure at a segment of that name, where no link bears; the structure holds still.
    """

    outer_diameter: PositiveLength | None = None
    """Of the eye; absent: 2.5 times the band's diameter."""
    material: str | None = None
    """Name of a `[material]`; absent: the pin's."""
    clearance: Length = 0.0
    """Of the bore's diameter over the pin's; negative: interference."""
    edge_radius: NotNegativeLength = 0.0
    """Of the bore's edges. 0 is sharp: a singularity of the contact stress."""
    tilt: Tilt | None = None
    """How the link holds its eye against tilting: "guided" (rigidly), "free", or a stiffness;
    absent: the bending of an eye that is held 0.8 of its outer diameter away."""
    bushing: BushingTable | None = None
    """A ring bonded in the eye, in which the pin turns."""


class PinTable(StrictTable):
    """A pin: a body of revolution or the body in a file, and its clamped surfaces."""

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
    """A CAD file (STEP, BREP, IGES) or a mesh of tetrahedra, in the study's folder."""
    geometry_unit: Literal["mm", "cm", "m", "in"] = "mm"
    """Unit of the file's numbers. With `geometry` only."""
    band: dict[str, BandTable] = {}
    """Bands of a pin from a file, by name. With `geometry` only."""
    lug: dict[str, LugTable] = {}
    """What surrounds its bands, by connection or by the name of a segment; an empty table takes all
    defaults. With any, its lugs hold the pin (`analysis.joints`). With a profile only."""
    clamp: list[str] = []
    """Clamped surfaces: "start" and "end" (faces), a segment's name or connection (its outer
    surface), "hole 1", "flat 1", a band. Empty: none, and the loads must be nearly in balance."""

    @model_validator(mode="after")
    def _one_shape(self) -> "PinTable":
        if (self.profile is None) == (self.geometry is None):
            raise LoadsArgumentError(
                'give either profile = [...] or geometry = "file.step"', "give-one"
            )
        turned = ("fillet", "hole", "flat", "lug")
        excluded = ("band", "geometry_unit") if self.profile is not None else turned
        for key in excluded:
            if key in self.model_fields_set:
                other = "geometry" if self.profile is not None else "a profile"
                raise LoadsArgumentError(
                    f"{key} can only be used with {other}; remove it", "key-not-applicable"
                )
        return self

    @property
    def connections(self) -> list[tuple[str, str]]:
        """Connections that bear on it, each with its key."""
        if self.profile is not None:
            named = enumerate(self.profile, 1)
            return [(f"profile[{i}].connection", s.connection) for i, s in named if s.connection]
        return [(f"band.{name}", name) for name, band in self.band.items() if band.connection]

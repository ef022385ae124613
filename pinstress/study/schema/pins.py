"""Keys of pins in a study file."""

from itertools import groupby
from math import inf
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from pinbase.errors import ArgumentError
from pinbase.keys import key_part
from pinstress.study.schema.lugs import LugTable
from pinstress.study.schema.materials import HardenedTable
from pinstress.study.schema.rules import condition, exactly_one
from pinstress.study.schema.types import (
    Angle,
    Length,
    NotNegativeAtEnds,
    NotNegativeLength,
    Number,
    PositiveLength,
    StrictTable,
    Switch,
    Tapered,
)


class SegmentTable(StrictTable):
    """A cylinder or a cone of a pin's profile."""

    length: PositiveLength
    """Length along the axis."""
    diameter: Tapered
    """Outer diameter; [a, b] for a cone, at its start and at its far end. A chamfer is a short
    cone."""
    bore: NotNegativeAtEnds = 0.0
    """Inner diameter; 0 is solid; [a, b] for a cone."""
    name: str | None = None
    """Name of the outer surface, for `clamp`. Default: its connection."""
    connection: str | None = None
    """Connection of the link that bears on the outer surface; also the name of the surface."""
    ear_of: str | None = None
    """Connection of the pin whose link bears here, too, with the other ear of a clevis. The segment
    needs a `name`, which is that of the ear's lug."""
    fillet: NotNegativeLength | None = None
    """Fillet radius at the inner corner at the far end; overrides the pin's `fillet`."""
    edge_radius: NotNegativeAtEnds = 0.0
    """Radius to which the edge of the outer surface at the far end is rounded; [a, b] at its start
    and at its far end."""
    bore_radius: NotNegativeAtEnds = 0.0
    """The same for the corners of the bore, including inner corners."""
    hardened: HardenedTable | None = None
    """Hardened outer surface of this segment. Default: that of the pin or its material."""

    @condition
    def _is_named_ear(self) -> None:
        if self.ear_of is not None and (self.name is None or self.connection is not None):
            raise ArgumentError(
                "ear_of is for a segment with a name, by which the lug of this ear is called, and "
                "without a connection of its own",
                "ear-without-name",
            )

    @field_validator("bore")
    @classmethod
    def _leaves_a_wall(cls, bore: NotNegativeAtEnds, info: ValidationInfo) -> NotNegativeAtEnds:
        diameter = info.data.get("diameter", inf)
        ends = zip(*(x if isinstance(x, tuple) else (x, x) for x in (bore, diameter)), strict=True)
        if not all(inner < outer for inner, outer in ends):
            raise ArgumentError("must be less than the diameter", "bore-too-large")
        return bore

    @property
    def diameters(self) -> tuple[float, float]:
        """The diameters at the start and the far end of the segment, m."""
        return self.diameter if isinstance(self.diameter, tuple) else (self.diameter,) * 2

    @property
    def bores(self) -> tuple[float, float]:
        """The bores at the start and the far end of the segment, m."""
        return self.bore if isinstance(self.bore, tuple) else (self.bore,) * 2


Corners = Annotated[
    list[Annotated[list[NotNegativeLength], Field(min_length=2, max_length=3)]],
    Field(min_length=2),
]


class BottomTable(StrictTable):
    """A drilled hole, perhaps with a bottom."""

    diameter: PositiveLength
    """Diameter of the hole."""
    angle: Angle = 0.0
    """Direction from the axis of the pin to the mouth of a cross hole, or to a passage; from x."""
    depth: PositiveLength | None = None
    """Depth to the end of the full diameter: of a cross hole from the surface at its `z`, on the
    side of `angle`; of a passage from the end face. Default: through the pin."""
    tip_angle: Angle | None = None
    """Angle of the cone that the drill leaves at the bottom. Default: flat, "180 deg"."""
    bottom_radius: NotNegativeLength = 0.0
    """Radius of the corners at the bottom; 0 is sharp, where stress is unbounded."""

    @condition
    def _has_bottom(self) -> None:
        if self.depth is None and (self.tip_angle is not None or self.bottom_radius):
            raise ArgumentError(
                "tip_angle and bottom_radius are of a blind hole; give its depth, too",
                "key-not-applicable",
            )


class HoleTable(BottomTable):
    """A hole across the pin."""

    z: PositiveLength
    """Position of the hole's axis along the pin."""
    chamfer: NotNegativeLength = 0.0
    """Width of a countersink of 90 degrees at the mouths, where the surface is highest."""
    mouth_radius: NotNegativeLength = 0.0
    """Radius to which the edges of the mouths are rounded."""
    offset: Length = 0.0
    """Distance of the hole's axis from the pin's, towards `angle` plus 90 degrees."""
    tilt: Angle = 0.0
    """Angle by which the hole's axis leans towards z, at most 60 degrees."""


class FlatTable(StrictTable):
    """A flat milled on part of the length."""

    z: tuple[Length, Length]
    """Start and end along the pin."""
    distance: PositiveLength
    """Distance of the flat from the axis; the material beyond it is removed."""
    angle: Angle = 0.0
    """Direction of the flat's normal, from x."""
    radius: NotNegativeLength = 0.0
    """Radius of the inner corners at its ends; 0 is sharp, where stress is unbounded."""


class SlotTable(StrictTable):
    """A keyway or slot along the pin."""

    z: tuple[Length, Length]
    """Start and end along the pin, including the round ends; an end outside the pin is open."""
    width: PositiveLength
    """Width across the pin."""
    depth: PositiveLength | None = None
    """Depth from the surface. Default: through the pin."""
    angle: Angle = 0.0
    """Direction from the axis in which it is milled, from x."""
    radius: NotNegativeLength = 0.0
    """Radius of the corners at the bottom; 0 is sharp, where stress is unbounded."""
    ends: Literal["round", "square"] = "round"
    """Shape of its ends seen from outside: half circles, or sharp corners."""


class PassageTable(BottomTable):
    """A hole along the pin, on its axis or parallel to it."""

    end: Literal["start", "end"] = "start"
    """End face from which it is drilled."""
    offset: NotNegativeLength = 0.0
    """Distance of its axis from that of the pin."""


class BandTable(StrictTable):
    """A band of a pin from a file. Give either `z` or `surface`."""

    z: tuple[Length, Length] | None = None
    """The outermost surface between two z of the file."""
    surface: str | None = None
    """The surface of this name in the file."""
    connection: Switch = True
    """Whether a link bears on the band, at the connection of the same name; false for a band that
    is only clamped."""

    _one_place = exactly_one('either z = [a, b] or surface = "..."', "z", "surface")


SHAPE_KEYS = "profile", "meridian", "geometry"
SHAPES_OF_KEY = {
    "fillet": ("profile",),
    "bore_meridian": ("meridian",),
    "hole": ("profile", "meridian"),
    "flat": ("profile", "meridian"),
    "slot": ("profile", "meridian"),
    "passage": ("profile", "meridian"),
    "lug": ("profile", "meridian"),
    "band": ("meridian", "geometry"),
    "geometry_unit": ("geometry",),
}


class PinTable(StrictTable):
    """A pin: a body of revolution or the body in a file, and its clamped surfaces."""

    material: str
    """Name of a `[material]`."""
    profile: Annotated[list[SegmentTable], Field(min_length=1)] | None = None
    """Segments, starting at z = 0. Give either `profile`, `meridian` or `geometry`."""
    meridian: Corners | None = None
    """Instead of a profile: the outline from z = 0 to the far end by its corners, [z, r] or
    [z, r, radius to which the corner is rounded], r being half the diameter."""
    bore_meridian: Corners | None = None
    """The outline of the bore in the same form. Default: solid. Only with `meridian`."""
    fillet: NotNegativeLength = 0.0
    """Radius at every inner corner of the shaft, tangent to the thinner shaft and to the shoulder
    face; 0 is sharp. Only with a profile."""
    hole: list[HoleTable] = []
    """Cross holes. Not with `geometry`."""
    flat: list[FlatTable] = []
    """Flats. Not with `geometry`."""
    slot: list[SlotTable] = []
    """Keyways and slots. Not with `geometry`."""
    passage: list[PassageTable] = []
    """Holes along the pin. Not with `geometry`."""
    geometry: str | None = None
    """A CAD file (STEP, BREP, IGES) or a mesh of tetrahedra, in the study's folder."""
    geometry_unit: Literal["mm", "cm", "m", "in"] = "mm"
    """Unit of length in the file. Only with `geometry`."""
    band: dict[str, BandTable] = {}
    """Bands, by name. Only with `geometry` or `meridian`."""
    lug: dict[str, LugTable] = {}
    """Lugs, by connection or by the name of a segment; an empty table takes all defaults. With any,
    the pin is supported by its lugs (see `analysis.joints`). Not with `geometry`."""
    lugs: Switch = True
    """Whether `lug_defaults` gives this pin a lug at every connection; it does so for no pin that
    is clamped, in a case or in all."""
    balance: str | None = None
    """Connection whose force, in cases of given forces, is minus the sum of the others, and
    likewise its torque about the axis; such cases do not state it. Useful for forces that scatter
    independently. Default: the cases state all forces."""
    hardened: HardenedTable | None = None
    """Hardened outer surface of all segments. Default: that of its material. Not with `geometry`,
    and not with holes, flats, slots or passages."""
    replaceable: Switch = False
    """Whether the pin is meant to be replaced; then EN 1993-1-8, 3.13 limits bearing, bending and
    contact stress at limit load, too."""
    bending_factor: Annotated[Number, Field(gt=0.0)] | None = None
    """Bending stress Mc/I at rupture over the ultimate strength of the material, read from a
    figure, for the code "aircraft". Default: by Cozzone, from the material's `ultimate_strain`."""
    clamp: list[str] = []
    """Clamped surfaces: "start" and "end" (the end faces), the name or connection of a segment (its
    outer surface), "hole 1", "flat 1", "slot 1", "passage 1", or a band. Default: none; forces and
    couples must then be nearly in equilibrium, or carried by lugs."""

    @condition
    def _one_shape(self) -> None:
        given = [shape for shape in SHAPE_KEYS if getattr(self, shape) is not None]
        if len(given) != 1:
            raise ArgumentError(
                'give one of profile = [...], meridian = [...] or geometry = "file.step"',
                "give-one",
            )
        for key, shapes in SHAPES_OF_KEY.items():
            if key in self.model_fields_set and given[0] not in shapes:
                of_file = " (`pinstress import` prints the profile of a CAD file)"
                way = of_file if self.geometry else ""
                raise ArgumentError(
                    f"{key} can only be used with {' or '.join(shapes)}{way}; remove it",
                    "key-not-applicable",
                )
        if self.lug and not self.lugs:
            raise ArgumentError("lugs = false, but lugs are given; remove either", "give-one")
        for name, band in self.band.items():
            if self.meridian is not None and band.z is None:
                raise ArgumentError(
                    f"band {name}: with meridian give z = [a, b], since only files name surfaces",
                    "key-not-applicable",
                )

    @property
    def diameters(self) -> tuple[float, ...]:
        """The diameters of the segments or corners in order, m; empty for a pin from a file.

        Successive equal diameters are listed once.
        """
        of_segments = (d for s in self.profile or () for d in s.diameters)
        of_corners = (2.0 * corner[1] for corner in self.meridian or ())
        return tuple(d for d, _ in groupby((*of_segments, *of_corners)))

    @property
    def connections(self) -> list[tuple[str, str]]:
        """The connections that bear on the pin, each with its key."""
        if self.profile is not None:
            named = enumerate(self.profile, 1)
            return [(f"profile[{i}].connection", s.connection) for i, s in named if s.connection]
        return [
            (f"band.{key_part(name)}", name) for name, band in self.band.items() if band.connection
        ]

    @condition
    def _ears_alike(self) -> None:
        for connection, ear in self.ears.items():
            if connection in self.lug:
                self.lug.setdefault(ear, self.lug[connection])

    @property
    def ears(self) -> dict[str, str]:
        """The name of the second ear of each link that is a clevis, by the link's connection."""
        return {s.ear_of: s.name for s in self.profile or () if s.ear_of and s.name}

    @property
    def shared_lugs(self) -> dict[str, str]:
        """The connection of the link, by the name of its second ear, if both ears share one lug
        table.
        """
        alike = ((ear, name) for name, ear in self.ears.items() if name in self.lug)
        return {ear: name for ear, name in alike if self.lug[ear] is self.lug[name]}

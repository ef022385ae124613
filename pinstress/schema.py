"""The study file's form: every table and key, with its unit and domain."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from pinstress.quantities import (
    Acceleration,
    Angle,
    Density,
    Duration,
    Force,
    Length,
    Mass,
    Moment,
    Name,
    NotNegativeLength,
    Point,
    PositiveLength,
    Stress,
    Table,
    Velocity,
    Weight,
    positive,
)
from pinstress.schema_leg import SpatialLegTable
from pinstress.schema_mechanism import MechanismTable


class MaterialTable(Table):
    """An isotropic linear-elastic material."""

    youngs_modulus: Stress
    poisson_ratio: Annotated[float, Field(gt=-1.0, lt=0.5)]
    density: Density | None = None
    yield_strength: Stress | None = None


class SegmentTable(Table):
    """A cylinder of a pin's profile; `fillet` is at its far end."""

    length: PositiveLength
    diameter: PositiveLength
    bore: NotNegativeLength = 0.0
    name: str | None = None
    connection: str | None = None
    fillet: NotNegativeLength | None = None


class HoleTable(Table):
    """A hole through the whole pin and its axis, at an angle from x."""

    z: PositiveLength
    diameter: PositiveLength
    angle: Angle = 0.0


class FlatTable(Table):
    """What lies further than `distance` from the axis, at an angle from x, is milled away."""

    z: tuple[Length, Length]
    distance: PositiveLength
    angle: Angle = 0.0


class BandTable(Table):
    """A band of a pin from a file: the outermost surface between two z, or the file's surface of
    that name. connection: whether the link of the band's name bears there.
    """

    z: tuple[Length, Length] | None = None
    surface: str | None = None
    connection: bool = True

    @model_validator(mode="after")
    def _one_place(self) -> "BandTable":
        if (self.z is None) == (self.surface is None):
            raise ValueError('give either z = [a, b] or surface = "..."')
        return self


class PinTable(Table):
    """A pin: a body of revolution, or what a file holds, and what holds it."""

    material: str
    profile: Annotated[list[SegmentTable], Field(min_length=1)] | None = None
    fillet: NotNegativeLength = 0.0
    hole: list[HoleTable] = []
    flat: list[FlatTable] = []
    geometry: str | None = None
    geometry_unit: Literal["mm", "cm", "m", "in"] = "mm"
    band: dict[str, BandTable] = {}
    clamp: list[str] = []

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


class CaseTable(Table):
    """What all cases may say: how loads spread over bands, which pins are held otherwise here."""

    distribution: Literal["uniform", "cosine"] = "uniform"
    clamp: dict[str, list[str]] = {}


class GivenCase(CaseTable):
    """Stated forces and moments, or a table of them."""

    kind: Literal["given"]
    forces: dict[str, Annotated[list[Force], Field(min_length=2, max_length=3)]] | None = None
    moments: dict[str, Annotated[list[Moment], Field(min_length=2, max_length=3)]] | None = None
    table: str | None = None

    @model_validator(mode="after")
    def _one_source(self) -> "GivenCase":
        stated = {"forces": self.forces, "moments": self.moments}
        if (self.forces is None and self.moments is None) == (self.table is None):
            raise ValueError(
                'give forces = { ... }, moments = { ... } or both, or else table = "file.csv"'
            )
        for key, given in stated.items():
            if given is not None and not given:
                raise ValueError(f"{key} names no connection")
        return self


class ImpulseRange(Table):
    """Values to try in place of the impulse's own: the factor of safety over all pairs."""

    impulse_time: Annotated[list[Duration], Field(min_length=1)]
    velocity_change: Annotated[
        list[Annotated[Velocity, AfterValidator(positive)]], Field(min_length=1)
    ]


class ImpulseTable(Table):
    """A landing force from an impulse: mass times velocity change over time, times the peak of the
    pulse over its mean: rectangular 1, half-sine pi/2, triangular 2.
    """

    weight: Weight | None = None
    gravity: Annotated[Acceleration, AfterValidator(positive)] = 9.80665
    mass: Mass | None = None
    velocity_change: Annotated[Velocity, AfterValidator(positive)]
    impulse_time: Duration
    pulse: Literal["rectangular", "half-sine", "triangular"] = "rectangular"
    direction: tuple[float, float]
    range: ImpulseRange | None = None

    @model_validator(mode="after")
    def _one_mass(self) -> "ImpulseTable":
        if (self.mass is None) == (self.weight is None):
            raise ValueError("give either mass or weight (with gravity)")
        if not any(self.direction):
            raise ValueError("direction must not be zero")
        return self


class ApplyTable(Table):
    """A load on a body, at a joint (by name), a point as drawn or its centre of mass: a force or an
    impulse, a couple (counter-clockwise), or both. follows: the force turns with the body.
    """

    body: str
    at: str | Point | None = None
    force: tuple[Force, Force] | None = None
    couple: Moment = 0.0
    follows: bool = False
    impulse: ImpulseTable | None = None

    @model_validator(mode="after")
    def _one_force(self) -> "ApplyTable":
        if self.force is not None and self.impulse is not None:
            raise ValueError("give either force = [fx, fy] or impulse = { ... }")
        if self.force is None and self.impulse is None and not self.couple:
            raise ValueError("give force = [fx, fy], impulse = { ... } or couple")
        return self


class MechanismCase(CaseTable):
    """What all cases of a mechanism may say: loads on its bodies."""

    apply: list[ApplyTable] = []


class MotionCase(MechanismCase):
    """The mechanism driven from the start of its drives to the end."""

    kind: Literal["motion"]
    samples: Annotated[int, Field(ge=2, le=100_001)] = 201


Coordinate = float | str  # of a drive: a length, or an angle with its unit
Coordinates = Coordinate | dict[str, Coordinate]


class StaticCase(MechanismCase):
    """The mechanism held still, under gravity and applied loads.

    position: of the drive, or by drive; as drawn by default.
    """

    kind: Literal["static"]
    position: Coordinates | None = None


class InstantCase(MechanismCase):
    """One instant of a motion: position, velocity and acceleration of the drive, or by drive."""

    kind: Literal["instant"]
    position: Coordinates | None = None
    velocity: Coordinates = 0.0
    acceleration: Coordinates = 0.0


class LegCase(CaseTable):
    """The leg that folds in space, over its fold."""

    kind: Literal["spatial_leg"]
    samples: Annotated[int, Field(ge=2, le=100_001)] = 201


class AnalysisTable(Table):
    """What is asked of the analysis. goal: "value", the maximum to the tolerance, or "decide", on
    which side of the required safety factor it is. excluded_distance: of the local diameter, from
    corners and edges of clamps, where no stress is read if they are singular.
    """

    model: Literal["auto", "beam", "harmonic", "solid"] = "auto"
    goal: Literal["value", "decide"] = "value"
    tolerance: Annotated[float, Field(gt=0.0, lt=1.0)] = 0.02
    excluded_distance: Annotated[float, Field(ge=0.01, le=0.5)] = 0.1
    required_safety_factor: Annotated[float, Field(gt=0.0)] | None = None


class BeamCheckTable(Table):
    """Compare a cantilever pin's axial stress with beam theory; the load also on a thin bore."""

    pin: str
    case: str
    axis_bore: PositiveLength


class MotionCheckTable(Table):
    """Compare a joint's speed and acceleration with the closed form of a lever: the joint turns
    about the fixed `pivot` with the moving end of the driven slider.
    """

    case: str
    joint: str
    pivot: str


class PublishedTable(Table):
    """Tables (CSV) of published values to print beside ours.

    peaks: pin,case,max_von_mises,safety_factor. reactions: case,connection,force. motion:
    time,speed,acceleration of the joint in motion_check. values: case,time,quantity,name,published,
    reason.
    """

    source: str
    peaks: str | None = None
    reactions: str | None = None
    motion: str | None = None
    values: str | None = None


class StudyTable(Table):
    """A study: pins, their materials, what loads them and what is asked."""

    title: str
    units: Literal["in-lbf-s", "mm-N-s", "m-N-s"]
    material: dict[str, MaterialTable] = {}
    pin: dict[Name, PinTable] = {}
    case: Annotated[
        dict[
            Name,
            Annotated[
                GivenCase | MotionCase | StaticCase | InstantCase | LegCase,
                Field(discriminator="kind"),
            ],
        ],
        Field(min_length=1),
    ]
    mechanism: MechanismTable | None = None
    spatial_leg: SpatialLegTable | None = None
    analysis: AnalysisTable = AnalysisTable()
    beam_check: BeamCheckTable | None = None
    motion_check: MotionCheckTable | None = None
    published: PublishedTable | None = None
    assumptions: list[str] = []

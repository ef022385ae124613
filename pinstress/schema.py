"""The study file's form: every table and key, with its unit and domain."""

import difflib
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator
from pydantic_core import core_schema

from pinstress.units import DIMENSIONS, SYSTEMS, to_si

KINDS = ("given", "derived", "fitted", "assumed")


@dataclass(frozen=True)
class Quantity:
    """Marks a float that is read from a number or a string with a unit, and kept in SI."""

    dimension: str

    def __get_pydantic_core_schema__(self, *_: object) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self._read)

    def __get_pydantic_json_schema__(self, *_: object) -> dict[str, Any]:
        plain: list[dict[str, Any]] = [
            {"type": "number"},
            {"type": "string", "examples": [DIMENSIONS[self.dimension][1]]},
        ]
        return {"anyOf": [*plain, sourced(plain)], "description": self.dimension}

    def _read(self, value: object, info: core_schema.ValidationInfo) -> float:
        system = (info.context or {}).get("system", SYSTEMS["m-N-s"])
        return to_si(value, self.dimension, system)


PROVENANCE: dict[str, Any] = {
    "provenance": {"enum": list(KINDS), "description": "where the numbers here come from"},
    "note": {"type": "string", "description": "why, in words"},
}


def _allow_provenance(schema: dict[str, Any]) -> None:
    schema["properties"].update(PROVENANCE)


def sourced(value: list[dict[str, Any]]) -> dict[str, Any]:
    """JSON Schema of { value = ..., provenance = "given", note = "..." }."""
    return {
        "type": "object",
        "properties": {
            "value": {"anyOf": value},
            **PROVENANCE,
        },
        "required": ["value", "provenance"],
        "additionalProperties": False,
    }


def _positive(value: float) -> float:
    if not value > 0.0:
        raise ValueError("must be positive")
    return value


def _pin_sized(value: float) -> float:
    if not 1e-6 < value < 1e3:
        raise ValueError("must lie between 1e-6 m and 1000 m")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise ValueError("must not be negative")
    return value


def _usable_name(name: str) -> str:
    if not name or len(name) > 64 or name[0] in ". " or any(c in '/\\:*?"<>|' for c in name):
        raise ValueError(f"{name!r} cannot be part of a file name; use letters, digits, - and _")
    if not name.isprintable():
        raise ValueError(f"{name!r} contains characters that cannot be printed")
    return name


Length = Annotated[float, Quantity("length")]
Force = Annotated[float, Quantity("force")]
PositiveLength = Annotated[Length, AfterValidator(_positive), AfterValidator(_pin_sized)]
Fillet = Annotated[Length, AfterValidator(_not_negative)]
Stress = Annotated[Annotated[float, Quantity("stress")], AfterValidator(_positive)]
Density = Annotated[Annotated[float, Quantity("density")], AfterValidator(_positive)]
Weight = Annotated[Force, AfterValidator(_not_negative)]
Mass = Annotated[Annotated[float, Quantity("mass")], AfterValidator(_not_negative)]
Inertia = Annotated[Annotated[float, Quantity("inertia")], AfterValidator(_positive)]
Duration = Annotated[Annotated[float, Quantity("time")], AfterValidator(_positive)]
Velocity = Annotated[float, Quantity("velocity")]
Acceleration = Annotated[float, Quantity("acceleration")]
Name = Annotated[str, AfterValidator(_usable_name)]
Point = tuple[Length, Length]


class Table(BaseModel):
    """A table of the study file: unknown keys are errors.

    Any table may also have `provenance` and `note`; they are taken out before validation.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, json_schema_extra=_allow_provenance)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: Any) -> Any:
        if isinstance(data, dict):
            for key in data:
                if key not in cls.model_fields:
                    near = difflib.get_close_matches(str(key), cls.model_fields, n=1, cutoff=0.5)
                    known = ", ".join(cls.model_fields)
                    hint = f"did you mean {near[0]!r}?" if near else f"known here: {known}"
                    raise ValueError(f"unknown key {key!r}; {hint}")
        return data


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
    bore: Annotated[Length, AfterValidator(_not_negative)] = 0.0
    name: str | None = None
    connection: str | None = None
    fillet: Fillet | None = None


class PinTable(Table):
    """A pin: a body of revolution, and what holds it."""

    material: str
    profile: Annotated[list[SegmentTable], Field(min_length=1)]
    clamp: list[str] = []
    fillet: Fillet = 0.0


class CaseTable(Table):
    """What all cases may say: how loads spread over bands, which pins are held otherwise here."""

    distribution: Literal["uniform", "cosine"] = "uniform"
    clamp: dict[str, list[str]] = {}


class GivenCase(CaseTable):
    """Stated forces, or a table of them."""

    kind: Literal["given"]
    forces: dict[str, Annotated[list[Force], Field(min_length=2, max_length=3)]] | None = None
    table: str | None = None

    @model_validator(mode="after")
    def _one_source(self) -> "GivenCase":
        if (self.forces is None) == (self.table is None):
            raise ValueError('give either forces = { ... } or table = "file.csv"')
        if self.forces is not None and not self.forces:
            raise ValueError("forces names no connection")
        return self


class MotionCase(CaseTable):
    """The mechanism driven from the start of its drive to the end."""

    kind: Literal["motion"]
    samples: Annotated[int, Field(ge=2, le=100_001)] = 201


class ImpulseTable(Table):
    """A landing force from an impulse: mass times velocity change over time."""

    weight: Weight | None = None
    gravity: Annotated[Acceleration, AfterValidator(_positive)] = 9.80665
    mass: Mass | None = None
    velocity_change: Annotated[Velocity, AfterValidator(_positive)]
    impulse_time: Duration
    direction: tuple[float, float]

    @model_validator(mode="after")
    def _one_mass(self) -> "ImpulseTable":
        if (self.mass is None) == (self.weight is None):
            raise ValueError("give either mass or weight (with gravity)")
        if not any(self.direction):
            raise ValueError("direction must not be zero")
        return self


class ApplyTable(Table):
    """A force on a body, at a joint (by name) or a point as drawn."""

    body: str
    at: str | Point
    force: tuple[Force, Force] | None = None
    impulse: ImpulseTable | None = None

    @model_validator(mode="after")
    def _one_force(self) -> "ApplyTable":
        if (self.force is None) == (self.impulse is None):
            raise ValueError("give either force = [fx, fy] or impulse = { ... }")
        return self


class StaticCase(CaseTable):
    """The mechanism held still, under gravity and applied forces."""

    kind: Literal["static"]
    drive_length: PositiveLength | None = None
    apply: list[ApplyTable] = []


class JointTable(Table):
    """A pin of the mechanism as drawn, and the body on each of its connections.

    fixed_in: "ground" or a body; absent for a floating pin, whose weight is that of its profile
    unless given here.
    """

    at: Point
    connections: Annotated[dict[str, str], Field(min_length=1)]
    fixed_in: str | None = None
    weight: Weight | None = None


class BodyTable(Table):
    """A rigid body: weight or mass, its centre as drawn, inertia about it (none: a particle)."""

    weight: Weight | None = None
    mass: Mass | None = None
    centre: Point
    inertia: Inertia | None = None

    @model_validator(mode="after")
    def _one_mass(self) -> "BodyTable":
        if (self.mass is None) == (self.weight is None):
            raise ValueError("give either weight or mass")
        return self


class SliderTable(Table):
    """One body sliding on another along the line between two joints: [base, moving]."""

    bodies: tuple[str, str]
    joints: tuple[str, str]


class DriveTable(Table):
    """The law of a slider's length: half a cosine from start to end, at rest at both."""

    slider: str
    law: Literal["cosine"] = "cosine"
    start: PositiveLength
    end: PositiveLength
    duration: Duration
    position_offset: Length = 0.0


class SharingTable(Table):
    """How redundant connections share: as springs of these stiffnesses (only ratios matter)."""

    connections: Annotated[list[str], Field(min_length=1)]
    stiffness: Annotated[list[Annotated[float, Field(gt=0.0)]], Field(min_length=1)]

    @model_validator(mode="after")
    def _same_length(self) -> "SharingTable":
        if len(self.connections) != len(self.stiffness):
            raise ValueError("give one stiffness for each connection")
        return self


class MechanismTable(Table):
    """A planar linkage in the position in which it is drawn."""

    gravity: tuple[Acceleration, Acceleration] = (0.0, -9.80665)
    joint: Annotated[dict[str, JointTable], Field(min_length=1)]
    body: Annotated[dict[str, BodyTable], Field(min_length=1)]
    slider: dict[str, SliderTable]
    drive: DriveTable
    sharing: list[SharingTable] = []


class AnalysisTable(Table):
    """What is asked of the analysis."""

    model: Literal["auto", "beam", "harmonic", "solid"] = "auto"
    tolerance: Annotated[float, Field(gt=0.0, lt=1.0)] = 0.02
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
    time,speed,acceleration of the joint in motion_check.
    """

    source: str
    peaks: str | None = None
    reactions: str | None = None
    motion: str | None = None


class StudyTable(Table):
    """A study: pins, their materials, what loads them and what is asked."""

    title: str
    units: Literal["in-lbf-s", "mm-N-s", "m-N-s"]
    material: Annotated[dict[str, MaterialTable], Field(min_length=1)]
    pin: Annotated[dict[Name, PinTable], Field(min_length=1)]
    case: Annotated[
        dict[
            Name,
            Annotated[GivenCase | MotionCase | StaticCase, Field(discriminator="kind")],
        ],
        Field(min_length=1),
    ]
    mechanism: MechanismTable | None = None
    analysis: AnalysisTable = AnalysisTable()
    beam_check: BeamCheckTable | None = None
    motion_check: MotionCheckTable | None = None
    published: PublishedTable | None = None
    assumptions: list[str] = []

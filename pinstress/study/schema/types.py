"""Types of the values in a study file, i.e. quantities with units, names, and tables that reject
unknown keys.

The JSON Schema, for editors and for the reference in the documentation, states the `dimension` and
`domain` of every quantity and the description of every key, which is the string below the key in
the code.
"""

import ast
import inspect
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from textwrap import dedent
from typing import Annotated, Any, Literal, TypeVar
from urllib.parse import quote

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
    PlainValidator,
    Tag,
    ValidationError,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError, core_schema

from pinbase.errors import ArgumentError
from pinstress.study.schema.shown import as_text, listed, nearest
from pinstress.study.schema.units import DIMENSION_EXPONENTS, MAX_SI_VALUE, UNIT_SYSTEMS, to_si

PROVENANCE_KINDS = ("given", "derived", "fitted", "assumed")
REMOVED_KEYS = {
    "lug_edges": "it was removed: stress near the edges of lugs is read as surface, section and "
    "contact, without an excluded distance (docs/lugs.md), so delete the line"
}
PROVENANCE_HINT = 'write provenance = "given", "derived", "fitted" or "assumed", and note beside it'
UNKNOWN_KEY_ERROR = "unknown_key"  # the type of pydantic's error
MIN_SI_VALUE = 1.0 / MAX_SI_VALUE  # in SI units: its square does not underflow
FORBIDDEN_CHARACTERS = '/\\:*?"<>|'  # each is forbidden in file names of some system
MAX_THERMAL_EXPANSION = 1e-3  # 1/K: metals have 1e-6 to 4e-5, rubber 2e-4
MAX_NAME_LENGTH = 100  # characters after URL quoting, so that two names fit into a file name


class Probe(float):
    """A number that is validated in place of a quantity, to learn the `dimension` of the key."""

    dimension = ""


@dataclass(frozen=True)
class Quantity:
    """Marks a float that is read from a number or a string with a unit, and stored in SI units."""

    dimension: str

    def __get_pydantic_core_schema__(self, *_: object) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self._read)

    def __get_pydantic_json_schema__(self, *_: object) -> dict[str, Any]:
        plain: list[dict[str, Any]] = [
            {"type": "number"},
            {"type": "string", "examples": [DIMENSION_EXPONENTS[self.dimension][1]]},
        ]
        return {"anyOf": [*plain, sourced(plain)], "dimension": self.dimension}

    def _read(self, value: object, info: core_schema.ValidationInfo) -> float:
        if isinstance(value, Probe):
            value.dimension = self.dimension
        system = (info.context or {}).get("system", UNIT_SYSTEMS["m-N-s"])
        return to_si(value, self.dimension, system)


PROVENANCE_PROPERTIES: dict[str, Any] = {
    "provenance": {
        "enum": list(PROVENANCE_KINDS),
        "description": "where the numbers here come from",
    },
    "note": {"type": "string", "description": "why, in words"},
}


def complete_schema(schema: dict[str, Any], table: type["StrictTable"]) -> None:
    """Add descriptions and provenance to a table's JSON Schema."""
    for key, words in described(table).items():
        schema["properties"][table.model_fields[key].alias or key]["description"] = words
    schema["properties"].update(PROVENANCE_PROPERTIES)


def described(table: type["StrictTable"]) -> dict[str, str]:
    """Return the description of each key: the string below the field in the code.

    The source is read only when a schema is requested, since that takes time.
    """
    descriptions: dict[str, str] = {}
    for one in reversed(table.__mro__):
        if not issubclass(one, StrictTable) or one is StrictTable:
            continue
        (definition,) = ast.parse(dedent(inspect.getsource(one))).body
        assert isinstance(definition, ast.ClassDef)
        for field, text in pairwise(definition.body):
            match (field, text):
                case (
                    ast.AnnAssign(target=ast.Name(id=key)),
                    ast.Expr(value=ast.Constant(value=str(words))),
                ):
                    descriptions[key] = " ".join(words.split())
    return descriptions


def sourced(value: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the JSON Schema of { value = ..., provenance = "given", note = "..." }."""
    return {
        "type": "object",
        "properties": {"value": {"anyOf": value}, **PROVENANCE_PROPERTIES},
        "required": ["value", "provenance"],
        "additionalProperties": False,
    }


@dataclass(frozen=True)
class Within(AfterValidator):
    """Restricts a quantity to a domain, which the JSON Schema states as text."""

    domain: str

    def __get_pydantic_json_schema__(
        self, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return handler(core) | {"domain": self.domain}


def _positive(value: float) -> float:
    if not value > 0.0:
        raise ArgumentError("must be positive", "not-positive")
    if value < MIN_SI_VALUE:
        raise ArgumentError(f"must be at least {MIN_SI_VALUE:g} in SI units", "out-of-range")
    return value


def _pin_sized(value: float) -> float:
    if not 1e-6 < value < 1e3:
        raise ArgumentError("must be between 1e-6 m and 1000 m", "out-of-range")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise ArgumentError("must not be negative", "negative")
    return value


POSITIVE = Within(_positive, "> 0")


def _expansion(value: float) -> float:
    if not abs(value) < MAX_THERMAL_EXPANSION:
        raise ArgumentError(
            f"must be less than {MAX_THERMAL_EXPANSION:g} 1/K; steel has about 12e-6 1/K",
            "out-of-range",
        )
    return value


NOT_NEGATIVE = Within(_not_negative, "≥ 0")
PIN_SIZED = Within(_pin_sized, "from 1 µm to 1 km")


def usable_name(name: str) -> str:
    bad = [c for c in dict.fromkeys(name) if c in FORBIDDEN_CHARACTERS]
    what, instead = "", "letters, digits, - and _"
    if bad:
        what = f"cannot be part of a file name on every system, because of {' '.join(bad)}"
    elif not name or name[0] in ". ":
        what = "cannot be part of a file name"
    elif len(quote(name)) > MAX_NAME_LENGTH:
        what = "is too long for a part of a file name"
        instead = f"at most {MAX_NAME_LENGTH} characters"
    elif not name.isprintable():
        what = "has unprintable characters"
    if what:
        raise ArgumentError(f"{as_text(name)} {what}; use {instead}", "unusable-name")
    return name


Number = Annotated[float, Field(strict=True)]  # otherwise pydantic reads "1" and true as 1.0
Whole = Annotated[int, Field(strict=True)]
Side = Literal["left", "right"]
Switch = Annotated[bool, Field(strict=True)]
Length = Annotated[float, Quantity("length")]
Force = Annotated[float, Quantity("force")]
PositiveLength = Annotated[Length, POSITIVE, PIN_SIZED]
NotNegativeLength = Annotated[Length, NOT_NEGATIVE]


def _one_or_both(value: object) -> str:
    return "<both>" if isinstance(value, list | tuple) else "<one>"


ONE_OR_BOTH = Discriminator(_one_or_both)
Tapered = Annotated[
    Annotated[PositiveLength, Tag("<one>")]
    | Annotated[tuple[PositiveLength, PositiveLength], Tag("<both>")],
    ONE_OR_BOTH,
]
NotNegativeAtEnds = Annotated[
    Annotated[NotNegativeLength, Tag("<one>")]
    | Annotated[tuple[NotNegativeLength, NotNegativeLength], Tag("<both>")],
    ONE_OR_BOTH,
]
Stress = Annotated[Annotated[float, Quantity("stress")], POSITIVE]
Density = Annotated[Annotated[float, Quantity("density")], POSITIVE]
Weight = Annotated[Force, NOT_NEGATIVE]
Mass = Annotated[Annotated[float, Quantity("mass")], NOT_NEGATIVE]
Inertia = Annotated[Annotated[float, Quantity("inertia")], NOT_NEGATIVE]
Duration = Annotated[Annotated[float, Quantity("time")], POSITIVE]
Velocity = Annotated[float, Quantity("velocity")]
Acceleration = Annotated[float, Quantity("acceleration")]
SignedInertia = Annotated[float, Quantity("inertia")]
AngularVelocity = Annotated[float, Quantity("angular velocity")]
AngularAcceleration = Annotated[float, Quantity("angular acceleration")]
Angle = Annotated[float, Quantity("angle")]
Moment = Annotated[float, Quantity("moment")]
Time = Annotated[float, Quantity("time")]
Name = Annotated[str, AfterValidator(usable_name)]
Stiffness = Annotated[Annotated[float, Quantity("stiffness")], NOT_NEGATIVE]
Damping = Annotated[Annotated[float, Quantity("damping")], NOT_NEGATIVE]
TorsionalStiffness = Annotated[Annotated[float, Quantity("torsional stiffness")], NOT_NEGATIVE]
TorsionalDamping = Annotated[Annotated[float, Quantity("torsional damping")], NOT_NEGATIVE]
ANY_CASE = "*"  # in the name of a section that stands for several cases


def _usable_section(name: str) -> str:
    usable_name(name.replace(ANY_CASE, "case"))
    return name


CaseName = Annotated[str, AfterValidator(_usable_section)]
Point = tuple[Length, Length]
Temperature = Annotated[float, Quantity("temperature")]
ThermalExpansion = Annotated[
    Annotated[float, Quantity("thermal expansion")],
    Within(_expansion, f"less than {MAX_THERMAL_EXPANSION:g} 1/K"),
]
TiltStiffness = Annotated[Annotated[float, Quantity("torsional stiffness")], POSITIVE]

LENGTHS_OF_DIRECTIONS = (1e-6, 1e6)  # outside, squares may overflow or vanish
SpaceDirection = TypeVar("SpaceDirection", bound="Sequence[float]")


def of_usual_length(direction: SpaceDirection) -> SpaceDirection:
    """Return a direction, whose length does not matter. If it is extremely short or long, it is
    divided by its largest component. A zero vector is returned unchanged.
    """
    low, high = LENGTHS_OF_DIRECTIONS
    largest = max(map(abs, direction))
    if not largest or low <= largest <= high:
        return direction
    return type(direction)(x / largest for x in direction)  # type: ignore[call-arg]


Joint = Annotated[str, Tag("<joint>")]
BY_NAME_OR_PLACE = Discriminator(lambda x: "<joint>" if isinstance(x, str) else "<point>")
JointOrPoint = Annotated[Joint | Annotated[Point, Tag("<point>")], BY_NAME_OR_PLACE]

Point3 = tuple[Length, Length, Length]
Direction = Annotated[tuple[Number, Number, Number], AfterValidator(of_usual_length)]
JointOrPoint3 = Annotated[Joint | Annotated[Point3, Tag("<point>")], BY_NAME_OR_PLACE]

Place3 = Annotated[list[Length], Field(min_length=2, max_length=3)]
JointOrPlace = Annotated[Joint | Annotated[Place3, Tag("<point>")], BY_NAME_OR_PLACE]

LimitLoads = Annotated[
    Annotated[Literal["auto", "always", "never"], Tag("<way>")]
    | Annotated[list[Name], Tag("<pins>")],
    Discriminator(lambda value: "<pins>" if isinstance(value, list) else "<way>"),
]


def _coordinate(value: object) -> float | str:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ArgumentError('must be a number or a text like "45 deg"', "not-a-number")
    return value


# A number or a text with a unit, whose dimension depends on the drive or key that it is for.
Coordinate = Annotated[float | str, PlainValidator(_coordinate, json_schema_input_type=float | str)]


TILT_KINDS = ("guided", "free")
Tilt = Annotated[
    Annotated[Literal["guided", "free"], Tag("<way>")]
    | Annotated[TiltStiffness, Tag("<stiffness>")],
    Discriminator(lambda value: "<way>" if value in TILT_KINDS else "<stiffness>"),
]


class OneOrSeveral(BeforeValidator):
    """Reads a list of tables, which the study may abbreviate to a single table."""

    def __get_pydantic_json_schema__(
        self, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return handler(core) | {"one_or_several": True}


def _listed(value: Any) -> Any:
    return [value] if isinstance(value, dict) else value


ONE_OR_SEVERAL = OneOrSeveral(_listed)


class StrictTable(BaseModel):
    """A table of the study file, in which unknown keys are errors.

    Any table may also have `provenance` and `note`; they are removed before validation.
    """

    model_config = ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, json_schema_extra=complete_schema
    )

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: Any) -> Any:
        known = _keys(cls)
        unknown = data.keys() - known if isinstance(data, dict) else ()
        if unknown:
            wrong = [unknown_key(key, known) for key in data if key in unknown]
            raise ValidationError.from_exception_data(cls.__name__, wrong)
        return data


@cache
def _keys(table: type[StrictTable]) -> list[str]:
    """Return the keys of a table. They are cached, since a study is read again for every design."""
    return [field.alias or name for name, field in table.model_fields.items()]


def unknown_key(key: object, known: list[str]) -> InitErrorDetails:
    context: dict[str, Any] = {"text": f"unknown key {as_text(key)}; ", "key": key, "known": known}
    return InitErrorDetails(
        type=PydanticCustomError(UNKNOWN_KEY_ERROR, "{text}", context), input=None
    )


def hint_for_key(key: str, known: list[str]) -> str:
    """Return a hint for an unknown key. It takes time, so it is only requested for errors that are
    printed.
    """
    if key in REMOVED_KEYS:
        return REMOVED_KEYS[key]
    if key in PROVENANCE_PROPERTIES:
        return PROVENANCE_HINT
    near = nearest(key, known, cutoff=0.5)
    return f"did you mean {near!r}?" if near else f"known here: {listed(known)}"

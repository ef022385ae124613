"""The study file's words: quantities with units, names, tables that know their keys.

For editors and for the reference in the documentation the JSON Schema says of every quantity its
`dimension` and `domain`, and of every key what it is: the string under it in the code.
"""

import ast
import difflib
import inspect
from dataclasses import dataclass
from itertools import pairwise
from textwrap import dedent
from typing import Annotated, Any
from urllib.parse import quote

from pydantic import AfterValidator, BaseModel, ConfigDict, GetJsonSchemaHandler, model_validator
from pydantic_core import core_schema

from pinstress.units import DIMENSIONS, SYSTEMS, to_si

KINDS = ("given", "derived", "fitted", "assumed")
LONGEST_NAME = 100  # as it is quoted: two of them fit into a file name


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
        return {"anyOf": [*plain, sourced(plain)], "dimension": self.dimension}

    def _read(self, value: object, info: core_schema.ValidationInfo) -> float:
        system = (info.context or {}).get("system", SYSTEMS["m-N-s"])
        return to_si(value, self.dimension, system)


PROVENANCE: dict[str, Any] = {
    "provenance": {"enum": list(KINDS), "description": "where the numbers here come from"},
    "note": {"type": "string", "description": "why, in words"},
}


def _complete(schema: dict[str, Any], table: type["Table"]) -> None:
    """Descriptions and provenance for a table's JSON Schema."""
    for key, words in described(table).items():
        schema["properties"][key]["description"] = words
    schema["properties"].update(PROVENANCE)


def described(table: type["Table"]) -> dict[str, str]:
    """By key what it is: the strings under a table's fields, read when a schema is asked for so
    that nothing else waits for it.
    """
    told: dict[str, str] = {}
    for one in reversed(table.__mro__):
        if not issubclass(one, Table) or one is Table:
            continue
        (made,) = ast.parse(dedent(inspect.getsource(one))).body
        assert isinstance(made, ast.ClassDef)
        for field, text in pairwise(made.body):
            match (field, text):
                case (
                    ast.AnnAssign(target=ast.Name(id=key)),
                    ast.Expr(value=ast.Constant(value=str(words))),
                ):
                    told[key] = " ".join(words.split())
    return told


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


@dataclass(frozen=True)
class Within(AfterValidator):
    """Restricts a quantity to a domain, which the JSON Schema states in words."""

    domain: str

    def __get_pydantic_json_schema__(
        self, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return handler(core) | {"domain": self.domain}


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


POSITIVE = Within(_positive, "> 0")
NOT_NEGATIVE = Within(_not_negative, "≥ 0")
PIN_SIZED = Within(_pin_sized, "from 1 µm to 1 km")


def usable_name(name: str) -> str:
    if not name or name[0] in ". " or any(c in '/\\:*?"<>|' for c in name):
        raise ValueError(f"{name!r} cannot be part of a file name; use letters, digits, - and _")
    if len(quote(name)) > LONGEST_NAME:
        raise ValueError(f"{name!r} is too long for a part of a file name")
    if not name.isprintable():
        raise ValueError(f"{name!r} contains characters that cannot be printed")
    return name


Length = Annotated[float, Quantity("length")]
Force = Annotated[float, Quantity("force")]
PositiveLength = Annotated[Length, POSITIVE, PIN_SIZED]
NotNegativeLength = Annotated[Length, NOT_NEGATIVE]
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
Point = tuple[Length, Length]


class Table(BaseModel):
    """A table of the study file: unknown keys are errors.

    Any table may also have `provenance` and `note`; they are taken out before validation.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, json_schema_extra=_complete)

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

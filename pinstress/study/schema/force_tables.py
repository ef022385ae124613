"""Keys in a study file that describe tables of forces from other programs."""

import math
import re
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    model_validator,
)

from pinbase.errors import ArgumentError
from pinstress.study.schema.rules import condition, exactly_one
from pinstress.study.schema.shown import in_toml
from pinstress.study.schema.types import (
    Duration,
    Length,
    Number,
    StrictTable,
    Time,
    Whole,
    complete_schema,
    unknown_key,
)
from pinstress.study.schema.units import UNIT_SYSTEMS, to_si

CONNECTIONS_ALIAS = "<connections>"  # in angle brackets, so that messages leave it out
AXIS_NAMES = "x", "y", "z"
MAX_AXES_ERROR = 1e-4  # of products of the rows of `axes`, which may have four digits only

JOINED_UNITS_PATTERN = re.compile(r"([kM]?N)([cm]?m)")  # Nm, kNmm
HYPHEN_PATTERN = re.compile(r"(?<=[A-Za-z])-(?=[A-Za-z])")  # in-lbf


def unit_factor(text: str, dimension: str) -> float:
    """Return the SI value of a unit as programs write it.

    Raises: ArgumentError for a text that is not a unit of this dimension.
    """
    spelled = HYPHEN_PATTERN.sub(" ", JOINED_UNITS_PATTERN.sub(r"\1 \2", text))
    return to_si(f"1 {spelled}", dimension, UNIT_SYSTEMS["m-N-s"])


def _unit_of(dimension: str) -> AfterValidator:
    def check(text: str) -> str:
        unit_factor(text, dimension)
        return text

    return AfterValidator(check)


Column = Annotated[
    Annotated[str, Tag("<header>")] | Annotated[int, Field(strict=True), Tag("<number>")],
    Discriminator(lambda value: "<header>" if isinstance(value, str) else "<number>"),
]
Axes = Annotated[
    Annotated[tuple[str, str, str], Tag("<names>")]
    | Annotated[
        tuple[
            tuple[Number, Number, Number],
            tuple[Number, Number, Number],
            tuple[Number, Number, Number],
        ],
        Tag("<matrix>"),
    ],
    Discriminator(
        lambda value: (
            "<matrix>"
            if isinstance(value, list | tuple) and value and isinstance(value[0], list | tuple)
            else "<names>"
        )
    ),
]
Matrix = tuple[tuple[float, float, float], ...]


class ForceAxes(StrictTable):
    """Units and axes of forces in a table."""

    unit: Annotated[str, _unit_of("force")] | None = None
    """Unit of the forces, where the file does not state it."""
    moment_unit: Annotated[str, _unit_of("moment")] | None = None
    """Unit of the moments, where the file does not state it."""
    axes: Axes | None = None
    """The pin's axes x, y, z in terms of the table's axes, for instance ["x", "-z", "y"] if the pin
    points along y of the table; or by their components, three rows of three numbers. Both systems
    are right-handed."""
    acts_on: Literal["pin", "link"] | None = None
    """The body on which the forces and moments act: the pin (default), or the link, which reverses
    their signs."""

    @condition
    def _right_handed(self) -> None:
        if self.axes is not None:
            _require_rotation(matrix_of(self.axes))


def matrix_of(axes: tuple[Any, Any, Any]) -> Matrix:
    """Return (3, 3) the pin's axes in those of the table, as rows.

    Raises: ArgumentError for a name that is not an axis.
    """
    rows = []
    for axis in axes:
        if not isinstance(axis, str):
            rows.append(axis)
            continue
        name = axis.removeprefix("-").removeprefix("+")
        if name not in AXIS_NAMES:
            raise ArgumentError(
                f'axes has {in_toml(axis)}; write "x", "-x", "y", "-y", "z" or "-z"', "not-a-choice"
            )
        sign = -1.0 if axis.startswith("-") else 1.0
        rows.append(tuple(sign * (name == other) for other in AXIS_NAMES))
    return tuple(rows)


def _require_rotation(rows: Matrix) -> None:
    """Raise ArgumentError unless the rows are right-handed unit vectors at right angles."""
    for i, one in enumerate(rows):
        for j, other in enumerate(rows):
            product = sum(p * q for p, q in zip(one, other, strict=True))
            if not math.isclose(product, float(i == j), abs_tol=MAX_AXES_ERROR):
                raise ArgumentError("axes must be unit vectors at right angles", "not-a-rotation")
    x, y, z = rows
    across = (y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0])
    if sum(p * q for p, q in zip(x, across, strict=True)) < 0.0:
        raise ArgumentError(
            'axes are left-handed: reverse one of them; for reactions write acts_on = "link"',
            "not-a-rotation",
        )


class JointColumns(ForceAxes):
    """The columns of a connection's force and moment: headers, or numbers from 1; with a minus sign
    in front if the sign is opposite.
    """

    fx: Column | None = None
    """Force along x of the table's axes."""
    fy: Column | None = None
    """Force along y."""
    fz: Column | None = None
    """Force along z. Default: zero."""
    mx: Column | None = None
    """Moment about x. Default: zero."""
    my: Column | None = None
    """Moment about y. Default: zero."""
    mz: Column | None = None
    """Moment about z. Default: zero."""
    moments_at: tuple[Length, Length, Length] | None = None
    """Point about which moments are taken, in pin axes from the middle of the band, which is the
    default."""

    @property
    def columns(self) -> dict[str, str | int]:
        """The stated columns by component."""
        stated = {c: getattr(self, c) for c in ("fx", "fy", "fz", "mx", "my", "mz")}
        return {name: column for name, column in stated.items() if column is not None}


class TimeColumn(StrictTable):
    """The times of a table: a column of it, or equal steps."""

    column: Column | None = None
    """Header of the column, or its number from 1."""
    unit: Annotated[str, _unit_of("time")] | None = None
    """Its unit, where the file does not state it."""
    step: Duration | None = None
    """Time between rows, instead of `column`."""
    offset: Time = 0.0
    """Added to all times."""

    _one_source = exactly_one('either column = "t" or step = "1 ms"', "column", "step")


def _with_connections(schema: dict[str, Any], table: type[StrictTable]) -> None:
    """Complete the JSON Schema of a table whose other keys are the names of connections."""
    complete_schema(schema, table)
    connections = schema["properties"].pop(CONNECTIONS_ALIAS)
    words = {"description": connections["description"]}
    schema["additionalProperties"] = connections["additionalProperties"] | words


class TableFile(ForceAxes):
    """A table of another program, and the columns of each connection by its name; without any, the
    headers name them, as B.fx.
    """

    model_config = ConfigDict(json_schema_extra=_with_connections)

    file: str
    """File in the study's folder: text, .xlsx or .parquet."""
    sheet: str | None = None
    """Sheet of a workbook that has several."""
    header_line: Annotated[Whole, Field(ge=1, le=1_000_000)] | None = None
    """Line of the header (row of a sheet), where lines precede it that are not comments."""
    separator: Literal[",", ";", "tab", "blank"] | None = None
    """Separator of the columns. Default: the first of ; tab , blank that the header contains."""
    decimal: Literal[".", ","] | None = None
    """The decimal sign, where the file does not show it; the other one then separates thousands."""
    encoding: Literal["utf-8", "utf-16-le", "utf-16-be", "cp1252"] | None = None
    """The encoding of a text without a byte order mark. Default: "utf-8"."""
    time: TimeColumn | None = None
    """The times. Default: none, one row; or a column `time` where headers name the columns."""
    connections: dict[str, JointColumns] = Field(default={}, alias="<connections>")
    """The columns of the connection with this name."""

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        keys = [f.alias or name for name, f in cls.model_fields.items()]
        keys.remove(CONNECTIONS_ALIAS)
        others = {key: value for key, value in data.items() if key not in keys}
        wrong = [unknown_key(k, keys) for k, v in others.items() if not isinstance(v, dict)]
        if wrong:
            raise ValidationError.from_exception_data(cls.__name__, wrong)
        return {k: v for k, v in data.items() if k in keys} | {CONNECTIONS_ALIAS: others}


Tables = Annotated[
    Annotated[str, Tag("<file>")]
    | Annotated[TableFile, Tag("<table>")]
    | Annotated[list[TableFile], Field(min_length=1, max_length=100), Tag("<tables>")],
    Discriminator(
        lambda value: (
            "<table>"
            if isinstance(value, dict | TableFile)
            else "<tables>"
            if isinstance(value, list)
            else "<file>"
        )
    ),
]

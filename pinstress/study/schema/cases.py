"""Keys of the load cases in a study file."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from pinbase.errors import ArgumentError
from pinstress.study.schema.force_tables import TableFile, Tables
from pinstress.study.schema.forces import ForceLawTable
from pinstress.study.schema.rules import condition, exactly_one, not_zero
from pinstress.study.schema.types import (
    NOT_NEGATIVE,
    POSITIVE,
    Acceleration,
    AngularAcceleration,
    AngularVelocity,
    Coordinate,
    Duration,
    Force,
    JointOrPlace,
    Mass,
    Moment,
    Number,
    StrictTable,
    Switch,
    Temperature,
    Time,
    Velocity,
    Weight,
    Whole,
    of_usual_length,
)

KEYS_OF_ANY_TABLE = "table_case", "table_units"


class CaseTable(StrictTable):
    """Keys of all cases."""

    distribution: Literal["uniform", "cosine"] = "cosine"
    """Distribution of a transverse force over its band, where no lug carries it: "cosine", a
    bearing pressure on the loaded half, or "uniform", a traction of constant direction, under whose
    edge stress is unbounded."""
    clamp: dict[str, list[str]] = {}
    """Pins that are clamped differently in this case, each with its clamped surfaces."""
    temperature: Temperature | None = None
    """Temperature of all pins, lugs and bushings, the same throughout. It changes clearances and
    interferences by `thermal_expansion` of the materials. Default: `reference_temperature`."""


class GivenCase(CaseTable):
    """Stated forces and moments on pins, or a table of them."""

    kind: Literal["given"]
    """Kind of case."""
    forces: dict[str, Annotated[list[Force], Field(min_length=2, max_length=3)]] | None = None
    """Force on the pin at each connection, in pin axes x, y (and z, along the pin)."""
    moments: dict[str, Annotated[list[Moment], Field(min_length=2, max_length=3)]] | None = None
    """Moment on the pin at each connection, about x, y (and z) through the middle of the band."""
    table: Tables | None = None
    """File in the study's folder, instead of `forces` and `moments`; a sweep if it has times. Its
    columns are connection,fx,fy[,fz][,mx,my,mz][,time][,case], or one per component, as B.fx,B.fy
    for connection B; units in brackets, fx [kN], or in a row under the header. Columns are
    separated by commas, semicolons, tabs or blanks; decimal commas are read unless commas separate
    the columns. For a file of another program, give a table that states its columns; several with
    [[case.NAME.table]]."""
    table_case: str | None = None
    """Name in the column `case` of the rows that are read; by default the name of this case."""
    columns: dict[str, str | int] = {}
    """Columns of a table of another program: for each name used here, the header in the table, or
    the number from 1 if the table has no header; with a minus sign in front if the sign is
    opposite."""
    labels: dict[str, str | int] = {}
    """Names of the connections in the table's column `connection`; rows with other names are
    skipped."""
    time_step: Annotated[Duration, POSITIVE] | None = None
    """Time between the rows of one connection, where the table has no times."""
    table_units: Literal["in-lbf-s", "mm-N-s", "m-N-s"] | None = None
    """System of units of the table's numbers, by default the study's."""

    @property
    def tables(self) -> tuple[TableFile, ...]:
        """The tables that give the forces."""
        if isinstance(self.table, str):
            return (TableFile.model_validate({"file": self.table}),)
        if isinstance(self.table, TableFile):
            return (self.table,)
        return tuple(self.table or ())

    @condition
    def _one_source(self) -> None:
        if (self.forces is None and self.moments is None) == (self.table is None):
            raise ArgumentError(
                'give either forces = { ... }, moments = { ... } or both, or table = "file.csv"',
                "give-one",
            )
        for key in ("table_case", "columns", "labels", "time_step", "table_units"):
            value = getattr(self, key)
            if value and not isinstance(self.table, str | None) and key not in KEYS_OF_ANY_TABLE:
                raise ArgumentError(
                    f"{key} is for a table that is only a file name; state columns in the table",
                    "give-one",
                )
            if value and self.table is None:
                raise ArgumentError(f'{key} describes a table; give table = "file.csv"', "no-table")
        for key in ("forces", "moments"):
            if getattr(self, key) == {}:
                raise ArgumentError(f"{key} is empty; give at least one connection", "empty")


Direction = Annotated[
    list[Number], Field(min_length=2, max_length=3), AfterValidator(of_usual_length)
]
Pulse = Literal["rectangular", "half-sine", "triangular"]


class ImpulseRange(StrictTable):
    """Other, equally possible values of the impulse: the safety factor is computed for all
    combinations, and a pin is safe only if it meets its factor in all of them.
    """

    impulse_time: Annotated[list[Duration], Field(min_length=1)] | None = None
    """Durations of the impulse. Default: its own."""
    velocity_change: Annotated[list[Annotated[Velocity, POSITIVE]], Field(min_length=1)] | None = (
        None
    )
    """Velocity changes. Default: its own."""
    pulse: Annotated[list[Pulse], Field(min_length=1)] | None = None
    """Shapes of the pulse. Default: its own."""

    @condition
    def _of_something(self) -> None:
        if self.impulse_time is None and self.velocity_change is None and self.pulse is None:
            raise ArgumentError(
                "give one of impulse_time = [...], velocity_change = [...] and pulse = [...]",
                "give-one",
            )


class ImpulseTable(StrictTable):
    """A landing force from an impulse: mass times velocity change over time, times the peak of the
    pulse over its mean.
    """

    weight: Weight | None = None
    """Weight of the body that is stopped. Give either `weight` or `mass`."""
    gravity: Annotated[
        Acceleration, POSITIVE, Field(json_schema_extra={"default": "9.80665 m/s^2"})
    ] = 9.80665
    """Converts the weight to a mass."""
    mass: Mass | None = None
    """Mass of the body that is stopped."""
    velocity_change: Annotated[Velocity, POSITIVE]
    """Change of velocity."""
    impulse_time: Duration
    """Duration of the impulse."""
    pulse: Pulse = "rectangular"
    """Shape of the pulse; its ratio of peak to mean is 1, pi/2 or 2."""
    direction: Direction
    """Direction of the force in world axes, [x, y] or [x, y, z]; a vector of any length except
    0."""
    range: ImpulseRange | None = None
    """Range of values; for one impulse per case."""

    _one_mass = exactly_one("either mass or weight (with gravity)", "mass", "weight")
    _directed = not_zero("direction")


Couple = Annotated[
    Annotated[Moment, Tag("<about z>")]
    | Annotated[tuple[Moment, Moment, Moment], Tag("<components>")],
    Discriminator(lambda value: "<components>" if isinstance(value, list | tuple) else "<about z>"),
]


class ApplyTable(StrictTable):
    """A load on a body: a force or an impulse, a couple, or both."""

    body: str
    """Name of a body of the mechanism."""
    at: JointOrPlace | None = None
    """Point of application in the drawn position: a joint or [x, y], in the plane of the body, or
    [x, y, z], where pins have a `z`. Default: the centre of mass."""
    force: Annotated[list[Force], Field(min_length=2, max_length=3)] | None = None
    """Force [fx, fy] or [fx, fy, fz] in world axes, in the drawn position; z is along the pins."""
    force_law: ForceLawTable | None = None
    """Force along `direction` by a table, instead of `force`."""
    direction: Direction | None = None
    """Direction [x, y] or [x, y, z] of the force of `force_law` in the drawn position; a vector of
    any length except 0."""
    couple: Couple = 0.0
    """Couple about z, positive counter-clockwise, or [mx, my, mz]."""
    couple_law: ForceLawTable | None = None
    """Couple by a table, instead of `couple`; of a linkage in space about `couple_axis`."""
    couple_axis: (
        Annotated[list[Number], Field(min_length=3, max_length=3), AfterValidator(of_usual_length)]
        | None
    ) = None
    """Axis [x, y, z] of the couple of `couple_law`, of a linkage in space."""
    follows: Switch = False
    """Whether the force, of a linkage in space also the couple, rotates with the body; otherwise
    its direction is constant in world axes."""
    impulse: ImpulseTable | None = None
    """A force estimated from an impulse, instead of `force`."""
    begin: Annotated[Time, NOT_NEGATIVE] | None = None
    """Time from which the load acts, in a motion. Default: the start of the motion."""
    end: Annotated[Time, POSITIVE] | None = None
    """Time until which the load acts. Default: the end of the motion."""

    @condition
    def _one_force(self) -> None:
        forces = sum(x is not None for x in (self.force, self.impulse, self.force_law))
        couples = any(self.moments) + (self.couple_law is not None)
        if forces > 1 or couples > 1 or not forces + couples:
            raise ArgumentError(
                "give one of force = [fx, fy], impulse = { ... } and force_law = { ... }, or one "
                "of couple and couple_law = { ... }, or one of each",
                "give-one",
            )
        directed = self.direction is not None and any(self.direction)
        if (self.force_law is not None) != directed:
            raise ArgumentError(
                "force_law and direction = [x, y], not zero, must be given together", "give-both"
            )
        if self.couple_axis is not None and (self.couple_law is None or not any(self.couple_axis)):
            raise ArgumentError(
                "couple_axis = [x, y, z], not zero, is the axis of couple_law", "give-both"
            )
        if self.end is not None and self.end <= (self.begin or 0.0):
            raise ArgumentError("end must be later than begin", "out-of-range")

    @property
    def moments(self) -> tuple[float, float, float]:
        """The couple about x, y and z, N m."""
        return self.couple if isinstance(self.couple, tuple) else (0.0, 0.0, self.couple)

    @property
    def out_of_plane(self) -> bool:
        """Whether the load acts out of the plane: along z, about x or y, or at a stated z."""
        impulse = None if self.impulse is None else self.impulse.direction
        along_z = any(any((d or [])[2:]) for d in (self.force, self.direction, impulse))
        return along_z or self.at_height or any(self.moments[:2])

    @property
    def at_height(self) -> bool:
        """Whether the z of the point of application is stated."""
        return self.at is not None and not isinstance(self.at, str) and len(self.at) > 2


class GroundMotionTable(StrictTable):
    """A motion of the ground on which a linkage in space stands: an aircraft that turns, a vehicle.
    Components are along the mechanism's axes, which move with it, as does gravity's direction.
    """

    velocity: tuple[Velocity, Velocity, Velocity] = (0.0, 0.0, 0.0)
    """Velocity [vx, vy, vz] of the origin at the start."""
    acceleration: tuple[Acceleration, Acceleration, Acceleration] = (0.0, 0.0, 0.0)
    """Constant rate of these components."""
    axis: Annotated[tuple[Number, Number, Number], AfterValidator(of_usual_length)] = (
        0.0,
        0.0,
        1.0,
    )
    """Direction about which the ground turns."""
    rate: AngularVelocity = 0.0
    """Rate of turn about it at the start, right-handed."""
    rate_change: AngularAcceleration = 0.0
    """Constant change of this rate."""
    path: Literal["turns", "straight"] = "turns"
    """Whether the velocity turns with the ground, as with wheels that do not slip ("turns"), or
    keeps its direction, as in a skid ("straight")."""

    _about_a_direction = not_zero("axis")


class MechanismCase(CaseTable):
    """Keys of all cases of a mechanism."""

    apply: list[ApplyTable] = []
    """Loads on the bodies."""
    ground_motion: GroundMotionTable | None = None
    """A motion of the ground, of a linkage in space. A case at one instant has it at the start."""


class MotionCase(MechanismCase):
    """The mechanism driven from the start of its drives to the end."""

    kind: Literal["motion"]
    """Kind of case."""
    samples: Annotated[Whole, Field(ge=2, le=100_001)] = 201
    """Number of equally spaced instants."""


Coordinates = Annotated[
    Annotated[Coordinate, Tag("<one>")] | Annotated[dict[str, Coordinate], Tag("<by drive>")],
    Discriminator(lambda value: "<by drive>" if isinstance(value, dict) else "<one>"),
]


class StaticCase(MechanismCase):
    """The mechanism at rest, under gravity and applied loads."""

    kind: Literal["static"]
    """Kind of case."""
    position: Coordinates | None = None
    """Position of the drive, a length or an angle with its unit; for several drives, a table by
    drive. Default: as drawn."""
    hold: Annotated[list[str], Field(min_length=1)] | None = None
    """Names of the drives, sliders and stops that hold the mechanism in this case. Default: the
    drives."""


class InstantCase(MechanismCase):
    """One instant of a motion."""

    kind: Literal["instant"]
    """Kind of case."""
    position: Coordinates | None = None
    """Position of the drive, a length or an angle with its unit; for several drives, a table by
    drive. Default: as drawn."""
    velocity: Coordinates = 0.0
    """Velocity of the drive, or a table by drive."""
    acceleration: Coordinates = 0.0
    """Acceleration of the drive, or a table by drive."""

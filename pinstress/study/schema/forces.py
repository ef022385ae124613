"""Keys of forces given by tables, of springs and of dampers in a study file."""

from typing import Annotated, Literal

from pydantic import Field

from pinbase.errors import ArgumentError
from pinstress.study.schema.rules import both_or_none, condition, exactly_one
from pinstress.study.schema.types import (
    Angle,
    Coordinate,
    Damping,
    Force,
    JointOrPoint,
    Length,
    Moment,
    Stiffness,
    StrictTable,
    TorsionalDamping,
    TorsionalStiffness,
)


class CurveTable(StrictTable):
    """A function given by rows."""

    table: str | None = None
    """CSV file in the study's folder with the argument in the first column: `time`, `position`,
    `position_deg`, `length`, `angle_deg`, `velocity` or `angular_velocity`, and `force` or `moment`
    in the second."""
    points: Annotated[list[tuple[Coordinate, Coordinate]], Field(min_length=2)] | None = None
    """Rows [argument, value] instead of a file, each a number or a text with a unit."""
    interpolation: Literal["linear", "monotone"] = "linear"
    """Interpolation between the rows: "linear", or "monotone", a cubic without extremes that the
    rows do not have."""
    outside: Literal["error", "hold", "repeat"] = "error"
    """Values outside the rows: "error", "hold" (the value of the last row) or "repeat" (the table
    is repeated)."""

    _one_source = exactly_one(
        'either table = "file.csv" or points = [[x, y], ...]', "table", "points"
    )


class ForceLawTable(CurveTable):
    """A force or couple given by a table over time or, if stated, over a position or distance."""

    position_of: str | None = None
    """A drive or slider, whose position (its length or angle) is the argument."""
    length_between: tuple[str, str] | None = None
    """Two joints, whose distance is the argument."""

    @condition
    def _one_argument(self) -> None:
        if self.position_of is not None and self.length_between is not None:
            raise ArgumentError("give either position_of or length_between", "give-one")


class LineLawTable(StrictTable):
    """Keys of all springs that act along a length."""

    stiffness: Stiffness = 0.0
    """Stiffness."""
    reference: Length | None = None
    """Length at which the force of the stiffness is zero. Default: as drawn."""
    preload: Force = 0.0
    """Force at the reference length, positive in compression of the spring."""
    damping: Damping = 0.0
    """Coefficient of a linear damper."""
    force: CurveTable | None = None
    """Force as a table over the length."""
    damper: CurveTable | None = None
    """Force as a table over the velocity, the rate of the length."""


class LineSpringTable(LineLawTable):
    """A spring, damper or gas spring along a slider, or between two points. Its force, positive
    where it pushes them apart, is preload - stiffness (length - reference) - damping velocity, and
    what the tables add.
    """

    slider: str | None = None
    """The slider along which it acts. Give either `slider`, or `bodies` and `joints`."""
    bodies: tuple[str, str] | None = None
    """The two bodies between which it acts; one may be "ground"."""
    joints: tuple[JointOrPoint, JointOrPoint] | None = None
    """A point of each, a joint or [x, y]; pins are not loaded at these joints."""

    _between = exactly_one("either slider, or bodies and joints", "slider", "bodies")
    _ends = both_or_none("bodies", "joints")


class TorsionLawTable(StrictTable):
    """Keys of all springs that act about an axis."""

    stiffness: TorsionalStiffness = 0.0
    """Stiffness."""
    reference: Angle = 0.0
    """Angle since the drawing at which the couple of the stiffness is zero."""
    preload: Moment = 0.0
    """Couple at the reference angle."""
    damping: TorsionalDamping = 0.0
    """Coefficient of a linear damper."""
    couple: CurveTable | None = None
    """Couple as a table over the angle."""
    damper: CurveTable | None = None
    """Couple as a table over the angular velocity."""


class TorsionSpringTable(TorsionLawTable):
    """A spring or damper that turns a body against another. Its couple on the second, positive
    counter-clockwise, is preload - stiffness (angle - reference) - damping angular velocity, and
    what the tables add; the angle is zero as drawn.
    """

    bodies: tuple[str, str]
    """[base, body]; the base may be "ground"."""

"""Keys of drives and of the laws of their motion in a study file."""

import math
from typing import Annotated, ClassVar, Literal

from pinbase.errors import ArgumentError
from pinstress.study.schema.rules import condition
from pinstress.study.schema.types import NOT_NEGATIVE, Angle, Duration, Length, StrictTable, Time

MAX_TURNS = 1000  # limit on work, since each turn is followed in steps of 0.25 rad


class LawTable(StrictTable):
    """Keys of all laws of motion: from start to end in `duration`, or a table. Without either the
    drive can only be used by cases that give its position.
    """

    slides: ClassVar[bool]  # whether it drives a length, instead of an angle

    name: str | None = None
    """Name of the drive. Default: the name of its slider or body."""
    law: Literal["cosine", "cycloidal", "constant", "table"] = "cosine"
    """Law of motion: "cosine" (zero velocity at both ends), "cycloidal" (also zero acceleration),
    "constant" (speed), or "table"."""
    duration: Duration | None = None
    """Time from start to end."""
    begin: Annotated[Time, NOT_NEGATIVE] = 0.0
    """Time at which the motion starts."""
    table: str | None = None
    """CSV file in the study's folder for `law = "table"`, with the columns time,position (or
    position_deg)[,velocity,acceleration]."""

    @condition
    def _course(self) -> None:
        course = [getattr(self, key, None) for key in ("start", "end", "duration")]
        if self.law == "table":
            if self.table is None or any(v is not None for v in course):
                raise ArgumentError(
                    'law = "table" needs table = "file.csv", without start, end and duration',
                    "law-and-keys",
                )
        elif self.table is not None:
            raise ArgumentError(f'table needs law = "table", not {self.law!r}', "law-and-keys")
        elif len({v is None for v in course}) > 1:
            raise ArgumentError(f"law {self.law!r} needs start, end and duration", "law-and-keys")

    @property
    def moves(self) -> bool:
        """Whether a course is given."""
        return self.table is not None or self.duration is not None


class SlidingDrive(LawTable):
    """Keys of all drives that change a length."""

    start: Length | None = None
    """Length, travel or distance at the start."""
    end: Length | None = None
    """The same at the end."""
    position_offset: Length = 0.0
    """Offset that plots subtract from it."""

    slides: ClassVar[bool] = True


class TurningDrive(LawTable):
    """Keys of all drives that change an angle."""

    start: Angle | None = None
    """Angle at the start."""
    end: Angle | None = None
    """Angle at the end."""

    slides: ClassVar[bool] = False

    @condition
    def _few_turns(self) -> None:
        if abs((self.end or 0.0) - (self.start or 0.0)) > MAX_TURNS * 2.0 * math.pi:
            text = f"start and end are more than {MAX_TURNS} turns apart"
            raise ArgumentError(text, "out-of-range")


class SliderDrive(SlidingDrive):
    """A drive of a slider's length (hydraulic piston, screw)."""

    slider: str
    """The driven slider."""


class RotaryDrive(TurningDrive):
    """A drive of a body's angle: the direction of a line between two of its joints,
    counter-clockwise from x or, for a drive between two bodies, from a line of the other; without a
    line, the rotation of the body since the drawing.
    """

    body: str
    """The driven body."""
    line: tuple[str, str] | None = None
    """Two joints of the body; the angle is that of the line from the first to the second. Default:
    the angle is zero as drawn."""
    against: str = "ground"
    """The body from which the angle is measured."""
    against_line: tuple[str, str] | None = None
    """Two joints of that body; required with `line` and `against`."""

    @condition
    def _both(self) -> None:
        if (self.against == "ground" or self.line is None) != (self.against_line is None):
            raise ArgumentError(
                "with a line, against (a body) and against_line (two of its joints) must be given "
                "together; without one, give no against_line",
                "give-both",
            )


def drive_name(drive: LawTable) -> str:
    """Return the name of a drive: its slider, its own name, or the name of the body or joint that
    it moves.
    """
    if isinstance(drive, SliderDrive):
        return drive.slider
    moved = (getattr(drive, key, None) for key in ("body", "joint", "slide"))
    return drive.name or next(filter(None, moved), "")

"""Keys of sequences of cases in a study file."""

from typing import Annotated

from pydantic import Field

from pinstress.study.schema.types import Duration, StrictTable, Whole


class StepTable(StrictTable):
    """One case of a sequence."""

    case: str
    """A case of the study, including cases of a table."""
    repeat: Annotated[Whole, Field(ge=1, le=10_000)] = 1
    """Number of repetitions in this step."""
    duration: Duration | None = None
    """Duration of a case at rest; a motion has its own time."""


class SequenceTable(StrictTable):
    """A duty cycle: cases one after the other on one time axis. Nothing is solved again."""

    steps: Annotated[list[StepTable], Field(min_length=1, max_length=1000)]
    """The cases in their order."""

"""Keys of the limits for `pinstress size` in a study file."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from pinstress.study.schema.types import Number, PositiveLength, StrictTable, Switch

MAX_LISTED_DIAMETERS = 1_000

Series = Annotated[
    Annotated[Literal["R5", "R10", "R20", "R40"], Tag("<series>")]
    | Annotated[
        list[PositiveLength], Field(min_length=1, max_length=MAX_LISTED_DIAMETERS), Tag("<list>")
    ],
    Discriminator(lambda value: "<list>" if isinstance(value, list) else "<series>"),
]


class SizeTable(StrictTable):
    """The limits within which `pinstress size` may change a pin; `run` ignores them."""

    largest_diameter: PositiveLength | None = None
    """Largest diameter of a pin, shoulders included. Default: no limit."""
    room: PositiveLength | None = None
    """The room around a joint: largest outer diameter of an eye about a pin. Default: no limit."""
    scale_lugs: Switch = True
    """Whether an eye with a stated `outer_diameter` grows with its pin, once it is narrower than
    `eye_ratio` allows; otherwise a pin grows only as far as its eyes allow."""
    eye_ratio: Annotated[Number, Field(gt=1.0, le=10.0)] = 1.5
    """Least ratio of the outer diameter of an eye to its bore; an eye that has less in the study
    keeps its own ratio."""
    series: Series | None = None
    """Standard diameters to which the diameters of a pin are rounded up: preferred numbers of ISO 3
    in the unit in which the study writes the diameter ("R5", "R10", "R20" or "R40"), or a list of
    diameters. Default: any diameter."""

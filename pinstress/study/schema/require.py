"""Keys of [[require]] in a study file, which states factors that checks of pins must reach."""

from typing import Annotated

from pydantic import Field

from assess.requirement import LEVELS_OF_CHECK, RequiredCheck, RequiredLevel
from pinstress.study.schema.types import Number, StrictTable


class RequireTable(StrictTable):
    """A requirement on one check of pins in cases. Each pin and case has at most one for a check at
    a level.
    """

    pins: Annotated[list[str], Field(min_length=1)] | None = None
    """Names of the pins. Default: all."""
    cases: Annotated[list[str], Field(min_length=1)] | None = None
    """Names of the cases; not for fatigue, which is over all cases of the spectrum. Default: all
    that load a pin."""
    check: RequiredCheck
    """The quantity that is checked: the largest von Mises stress against the yield strength
    ("yield") or against the ultimate strength ("rupture"), the load at which the pin collapses
    ("limit load"), the nominal pressure on bands and lugs ("bearing"), the nominal shear of pin and
    lugs ("shear"), the life under the spectrum ("fatigue")."""
    level: RequiredLevel | None = None
    """The loads under which the check must be passed: "limit" and "proof" (no yielding) or
    "ultimate" (no failure). Default: "limit", for rupture and limit load "ultimate"."""
    factor: Annotated[Number, Field(gt=0.0)]
    """The least factor: strength over stress under the loads of the study, which are not multiplied
    by limit_factor, ultimate_factor or fitting_factor; for fatigue, life over the required life. At
    proof load, it is the proof load over the loads of the study."""


def level_of(table: RequireTable) -> RequiredLevel:
    """Return the level of a requirement; by default that of its check."""
    return table.level or LEVELS_OF_CHECK[table.check][0]

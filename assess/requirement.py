"""Requirements on pins as a study states them: a check at a level, and the factor it must reach.

A factor is the allowable over the demand under the loads of the study. The level states what the
pin must survive under `factor` times these loads: no yielding at limit and proof load, no failure
at ultimate load.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

RequiredLevel = Literal["limit", "proof", "ultimate"]
RequiredCheck = Literal["yield", "rupture", "limit load", "bearing", "shear", "fatigue"]

# The levels at which each check can be required; the first is the default.
LEVELS_OF_CHECK: Mapping[RequiredCheck, tuple[RequiredLevel, ...]] = MappingProxyType(
    {
        "yield": ("limit", "proof"),
        "rupture": ("ultimate",),
        "limit load": ("ultimate", "limit", "proof"),
        "bearing": ("limit", "proof", "ultimate"),
        "shear": ("limit", "proof", "ultimate"),
        "fatigue": ("limit",),
    }
)
TO_BE_RUN = " to be run"  # ends the text of `needs` where the run leaves out the pin or the case
REQUIRED_LEVELS: tuple[RequiredLevel, ...] = "limit", "proof", "ultimate"
REQUIRED_CHECKS = tuple(LEVELS_OF_CHECK)  # in the order of tables


@dataclass(frozen=True)
class StatedRequirement:
    """A requirement of a study on one pin in one case.

    case: empty for fatigue, which is checked over several cases. factor: allowable over demand
    under the loads of the study; for fatigue, the life over the required life.
    needs: what is missing if no row can meet the requirement ("pin E to be run"), else empty.
    """

    pin: str
    case: str
    level: RequiredLevel
    check: RequiredCheck
    factor: float
    needs: str = ""

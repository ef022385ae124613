"""Requirements on pins as a study states them: a check at a level, and the factor it must reach.

A factor is the allowable over the demand under the loads of the study. The level says what must
not happen under `factor` times these loads: no yielding at limit and proof load, no failure at
ultimate load.
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
TO_BE_RUN = " to be run"  # the end of what a requirement needs that the run leaves out
REQUIRED_LEVELS: tuple[RequiredLevel, ...] = "limit", "proof", "ultimate"
REQUIRED_CHECKS = tuple(LEVELS_OF_CHECK)  # in the order of tables


@dataclass(frozen=True)
class StatedRequirement:
    """A requirement of a study on one pin in one case.

    case: empty for a check over several cases, fatigue. factor: allowable over demand under the
    loads of the study; of fatigue, the life over the required one.
    needs: why there is no row that could meet it ("pin E to be run"), empty if there is one.
    """

    pin: str
    case: str
    level: RequiredLevel
    check: RequiredCheck
    factor: float
    needs: str = ""

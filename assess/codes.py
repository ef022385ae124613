"""The design codes by which a study can have its pins and lugs checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

Code = Literal["general", "aircraft", "lifting", "civil"]
AiscDesign = Literal["LRFD", "ASD"]


@dataclass(frozen=True)
class PartialFactors:
    """Partial factors of EN 1993-1-8, which national annexes may change; as recommended in 2.2."""

    M0: float = 1.0
    M2: float = 1.25
    M6_ser: float = 1.0


RECOMMENDED = PartialFactors()
DEFAULT_CODES: tuple[Code, ...] = ("general",)
# The fitting factor that a code demands where the study states none: 14 CFR 25.625(a)
FITTING_FACTORS: Mapping[Code, float] = MappingProxyType({"aircraft": 1.15})

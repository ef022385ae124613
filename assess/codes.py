"""The codes by which a study lets pins and lugs be checked."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

Code = Literal["general", "aircraft", "lifting", "civil"]
DEFAULT_CODES: tuple[Code, ...] = ("general",)
# That a code demands where the study states none: 14 CFR 25.625(a)
FITTING_FACTORS: Mapping[Code, float] = MappingProxyType({"aircraft": 1.15})

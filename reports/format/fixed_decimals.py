"""Number formats for changing values: the same decimals for all, so that digits do not move."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from reports.data.results import Floats
from reports.format.numbers import DASH, ten_to

DIGITS_OF_LARGEST = 4  # of the largest


@dataclass(frozen=True)
class Fixed:
    """Format of a quantity: in `unit`, multiplied by `factor`, with a fixed number of decimals."""

    unit: str
    factor: float
    decimals: int

    @staticmethod
    def of(values: Floats, unit: str) -> Fixed:
        """Return the format with four digits of the largest value.

        Very large and very small numbers are written with powers of ten.
        """
        largest = float(np.max(np.abs(values[np.isfinite(values)]), initial=0.0))
        if largest == 0.0:
            return Fixed(unit, 1.0, 0)
        size = math.floor(math.log10(largest))
        power = 0 if -2 <= size < 6 else 3 * (size // 3)
        heading = unit if power == 0 else f"{ten_to(power)} {unit}"
        return Fixed(heading, 10.0**power, max(DIGITS_OF_LARGEST - 1 - (size - power), 0))

    def __call__(self, value: float) -> str:
        if not math.isfinite(value):
            return DASH
        text = f"{value / self.factor:,.{self.decimals}f}"
        return text.removeprefix("-") if not text.strip("-0.,") else text.replace("-", "−")

"""Standard diameters: multiples of a step, preferred numbers, or those of a list."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pinstress.analysis.remedies.secant import NoSizeError
from pinstress.study.schema.size import SizeTable

# ISO 3:1973, table 1; a decade each
PREFERRED_NUMBERS: dict[str, tuple[float, ...]] = {
    "R5": (1.0, 1.6, 2.5, 4.0, 6.3),
    "R10": (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0),
    "R20": (
        1.0, 1.12, 1.25, 1.4, 1.6, 1.8, 2.0, 2.24, 2.5, 2.8,
        3.15, 3.55, 4.0, 4.5, 5.0, 5.6, 6.3, 7.1, 8.0, 9.0,
    ),
    "R40": (
        1.0, 1.06, 1.12, 1.18, 1.25, 1.32, 1.4, 1.5, 1.6, 1.7,
        1.8, 1.9, 2.0, 2.12, 2.24, 2.36, 2.5, 2.65, 2.8, 3.0,
        3.15, 3.35, 3.55, 3.75, 4.0, 4.25, 4.5, 4.75, 5.0, 5.3,
        5.6, 6.0, 6.3, 6.7, 7.1, 7.5, 8.0, 8.5, 9.0, 9.5,
    ),
}  # fmt: skip
SAME = 1e-9  # relative: a diameter this close to a standard one is standard


@dataclass(frozen=True)
class StandardDiameters:
    """The permitted diameters of a pin; exactly one of the three is given.

    step: the diameters are multiples of this, m.
    preferred: one decade of preferred numbers, in the unit in which a diameter is written.
    listed: the diameters themselves, m.
    """

    step: float | None = None
    preferred: tuple[float, ...] = ()
    listed: tuple[float, ...] = ()

    def up(self, diameter: float, unit: float) -> float:
        """Return the smallest standard diameter that is at least `diameter`, m.

        unit: the unit in which it is written, m.

        Raises: NoSizeError if a list has none.
        """
        least = diameter * (1.0 - SAME)
        fitting = [d for d in self._near(diameter, unit) if d >= least]
        if not fitting:
            raise NoSizeError("no diameter in the list of [size] series is large enough")
        return min(fitting)

    def down(self, diameter: float, unit: float) -> float:
        """Return the largest standard diameter that is at most `diameter`, m; 0 if none is."""
        most = diameter * (1.0 + SAME)
        return max((d for d in self._near(diameter, unit) if d <= most), default=0.0)

    def _near(self, diameter: float, unit: float) -> tuple[float, ...]:
        """Return standard diameters, m, which include the nearest ones on both sides."""
        if self.step is not None:
            count = round(diameter / self.step)
            return tuple(n * self.step for n in range(max(count - 1, 1), count + 2))
        if self.listed:
            return self.listed
        decade = math.floor(math.log10(diameter / unit))
        powers = range(decade - 1, decade + 2)
        return tuple(float(f"{x:g}e{k}") * unit for k in powers for x in self.preferred)


def standard_diameters(table: SizeTable, step: float | None = None) -> StandardDiameters | None:
    """Return the permitted diameters of pins; None if any is permitted.

    step: the step of the command line, m, which replaces the series of a study's [size].
    """
    if step is not None:
        return StandardDiameters(step=step)
    if isinstance(table.series, str):
        return StandardDiameters(preferred=PREFERRED_NUMBERS[table.series])
    return None if table.series is None else StandardDiameters(listed=tuple(sorted(table.series)))

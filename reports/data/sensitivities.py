"""How a pin's largest stress and its factor of safety change with all that they depend on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pinbase.dimensions import Length, Stress, Time


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives with respect to one parameter. key: as the study has it, or "force B x" of a load
    in the axes of the pin; kind: its dimension ("length", "force", .., "1"), value: as it is.

    stress: of the maximum; factor: of the factor of safety, None without a strength. step: a little
    more of it, and factor_with_step what the derivative makes of the factor then.
    """

    key: str
    kind: str
    value: Annotated[float, "parameter"]
    step: Annotated[float, "parameter"]
    stress: Annotated[float, "stress_by_it"]
    factor: Annotated[float, "by_it"] | None
    factor_with_step: float | None

    @property
    def instead(self) -> dict[str, str]:
        """The dimensions of this parameter (reports.data.in_units)."""
        plain = self.kind == "1"
        return {
            "parameter": self.kind,
            "stress_by_it": "stress" if plain else f"stress {self.kind}^-1",
            "by_it": "1" if plain else f"{self.kind}^-1",
        }


@dataclass(frozen=True)
class PinSensitivities:
    """Of one pin in one case, whose maximum and factor are as reported. rows: by effect on the
    factor, the largest first. tied_places (r, z), tied_times: others whose stress is within the
    error of the maximum, so that they may govern with a little more of anything. without: keys of
    dimensions that have no derivative, and why. changing: how many cells of contact are
    about to open or to close, which makes them one-sided too. note: why there is none at all.
    """

    pin: str
    case: str
    maximum: Stress
    factor: float | None
    rows: tuple[Sensitivity, ...] = ()
    tied_places: tuple[tuple[Length, Length], ...] = ()
    tied_times: tuple[Time, ...] = ()
    without: tuple[tuple[str, str], ...] = ()
    changing: int = 0
    note: str = ""

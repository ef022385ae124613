"""Sensitivities of a pin's maximum stress and safety factor to the parameters of the study."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pinbase.dimensions import Length, Stress, Time


@dataclass(frozen=True)
class Sensitivity:
    """The derivatives with respect to one parameter.

    key: of the study ("pin.B.fillet"), or "force B x" for a load in the axes of the pin.
    kind: dimension of the parameter ("length", "force", .., "1").
    value: of the parameter.
    stress: derivative of the maximum.
    factor: derivative of the safety factor; None without a strength.
    step: a small increase of the parameter.
    factor_with_step: the safety factor after this step, by the derivative.
    """

    key: str
    kind: str
    value: Annotated[float, "parameter"]
    step: Annotated[float, "parameter"]
    stress: Annotated[float, "stress_by_it"]
    factor: Annotated[float, "by_it"] | None
    factor_with_step: float | None

    @property
    def dimension_of(self) -> dict[str, str]:
        """The dimensions of the parameter and of the derivatives (pinbase.records.in_units)."""
        plain = self.kind == "1"
        return {
            "parameter": self.kind,
            "stress_by_it": "stress" if plain else f"stress {self.kind}^-1",
            "by_it": "1" if plain else f"{self.kind}^-1",
        }


@dataclass(frozen=True)
class PinSensitivities:
    """The sensitivities of one pin in one case, whose maximum and factor are as reported.

    rows: the largest effect on the factor first.
    tied_places, tied_times: places (r, z) and times whose stress is within the error of the
    maximum, so that they may govern after a small increase of a parameter.
    without: keys of dimensions that have no derivative, and the reason.
    changing: number of contact cells about to open or close, which makes derivatives one-sided.
    note: the reason why there are no derivatives.
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

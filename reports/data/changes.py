"""What to change so that a pin reaches its factor of safety."""

from __future__ import annotations

from dataclasses import dataclass
from shlex import quote

from pinbase.dimensions import Stress, Time


@dataclass(frozen=True)
class Remedy:
    """Each alone makes a pin reach the required factor in the worst of its cases: a yield strength;
    a factor on all loads, exact where stress is `proportional` to them, as it is not in contact;
    a factor on all diameters, bores and fillets, None where `diameter_note` says why; the time of
    the impulse that loads it, None without one or where no time is long enough (given_time: as it
    is). Of a singular row they are by the upper end of its range. singular: the factor is reached
    only outside the excluded zones.
    """

    pin: str
    case: str
    required: float
    yield_strength: Stress
    load_factor: float
    proportional: bool
    diameter_factor: float | None
    diameter_note: str
    impulse_time: Time | None
    given_time: Time | None
    singular: bool


def command(changes: tuple[Remedy, ...], study: str, required: float | None) -> str:
    """The command that finds the diameters of the pins that have any; empty if none has."""
    pins = [c.pin for c in changes if c.diameter_factor or "pinstress size" in c.diameter_note]
    if not pins:
        return ""
    fos = "" if required is not None else " --fos 1"
    return f"pinstress size {quote(study)} --pins {quote(','.join(pins))}{fos}"

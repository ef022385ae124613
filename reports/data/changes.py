"""Changes by which a pin reaches its required safety factor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from shlex import quote

from pinbase.dimensions import Stress, Time


@dataclass(frozen=True)
class Remedy:
    """The changes, each sufficient alone, by which a pin reaches its required factor in its worst
    case.

    For a singular row they are computed from the upper end of its stress range.
    yield_strength: the strength that would suffice.
    load_factor: the factor on all loads; exact where stress is `proportional` to them (not in
    contact).
    diameter_factor: the factor on all diameters, bores and fillets; None where `diameter_note`
    gives a reason.
    impulse_time: the time of the impulse that loads the pin; None without an impulse or where no
    time suffices.
    given_time: the impulse time of the study.
    singular: whether the factor is reached only outside the excluded zones.
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


def unsized(changes: tuple[Remedy, ...]) -> tuple[Remedy, ...]:
    """Return the changes of the pins that reach their factor with no diameter."""
    return tuple(
        c for c in changes if not c.diameter_factor and "pinstress size" not in c.diameter_note
    )


def command(changes: tuple[Remedy, ...], study: str, required: float | None) -> str:
    """Return the command that sizes the pins for which diameters can be found; empty if none."""
    left_out = unsized(changes)
    return size_command([c.pin for c in changes if c not in left_out], study, required)


def size_command(
    pins: Sequence[str], study: str, required: float | None, over_ranges: bool = False
) -> str:
    """Return the command that sizes pins; empty without any.

    required: the factor that the study requires; None for none.
    over_ranges: whether over all ranges of the study.
    """
    if not pins:
        return ""
    fos = "" if required is not None else " --fos 1"
    over = " --over-ranges" * over_ranges
    return f"pinstress size {as_argument(study)} --pins {quote(','.join(pins))}{fos}{over}"


def as_argument(path: str) -> str:
    """Return a path as a shell takes it in a command: quoted, and never read as an option."""
    return quote(f"./{path}" if path.startswith("-") else path)

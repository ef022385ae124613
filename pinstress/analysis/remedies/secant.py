"""The smallest scale of a pin that reaches a factor of safety."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from assess.diameter_law import BENDING_EXPONENT

MIN_SLOPE, MAX_SLOPE = 0.5, 6.0  # limits of the slope of a secant
MIN_SCALE_RATIO = 1.2  # ratio of scales from which a low slope shows that larger pins hardly help
MAX_SCALE_STEP = 3.0  # the largest ratio of the scales of successive trials
FACTOR_TOLERANCE = 0.01  # relative excess over the required factor that is close enough
BRACKET_TOLERANCE = 0.001  # relative width of a bracket of scales that is not divided further
MIN_SCALE, MAX_SCALE = 0.02, 50.0
MAX_TRIALS = 14


class NoSizeError(Exception):
    """No scale reaches the required factor; the message says why."""


@dataclass(frozen=True)
class Trial:
    """A scale and the factor of safety at it."""

    scale: float
    factor: float


def smallest(
    factor_at: Callable[[float], float],
    required: float,
    start: float = 1.0,
    close: float = FACTOR_TOLERANCE,
) -> Trial:
    """Return the smallest scale whose factor is at least `required`, and at most `close` (relative)
    more.

    The factor grows with the scale. The logarithm of the factor is nearly linear in the logarithm
    of the scale, so secants converge fast; trials on both sides bracket the scale. The returned
    scale is one of the trials.

    start: the smallest scale allowed.

    Raises: NoSizeError.
    """
    below: Trial | None = None
    above: Trial | None = None
    before: Trial | None = None
    scale, slope = start, BENDING_EXPONENT
    for _ in range(MAX_TRIALS):
        now = Trial(scale, factor_at(scale))
        if now.factor >= required:
            above = now if above is None or now.scale < above.scale else above
            if now.factor <= required * (1.0 + close):
                return now
        else:
            below = now if below is None or now.scale > below.scale else below
        if above and below and above.scale <= below.scale * (1.0 + BRACKET_TOLERANCE):
            return above
        if before is not None and before.scale != now.scale:
            rise = math.log(now.factor / before.factor) / math.log(now.scale / before.scale)
            if above is None and rise < MIN_SLOPE and now.scale > MIN_SCALE_RATIO * before.scale:
                raise NoSizeError(
                    f"with {now.scale:.3g} times its diameters its factor is {now.factor:.4g} and "
                    "hardly grows with them: its bands must be longer, its material stronger or "
                    "its loads smaller"
                )
            slope = min(max(rise, MIN_SLOPE), MAX_SLOPE)
        before = now
        # The aim is a little high, because only a factor that is not below the required one counts.
        aim = required * (1.0 + 0.4 * close)
        scale = min(now.scale * (aim / now.factor) ** (1.0 / slope), MAX_SCALE_STEP * now.scale)
        if above and below and not below.scale < scale < above.scale:
            scale = math.sqrt(above.scale * below.scale)
        if not MIN_SCALE < scale < MAX_SCALE:
            raise NoSizeError(
                f"even with {now.scale:.3g} times its diameters its factor is {now.factor:.4g}"
            )
    if above is not None:
        return above
    raise NoSizeError(f"the factor is not reached in {MAX_TRIALS} trials")

"""The drop of one leg with a sprung and an unsprung mass, a strut, a tyre and a wheel.

Downwards is positive. z2, the distance that the axle has fallen since touch-down, is the deflection
of the tyre; u is the rise of the axle relative to the aircraft. The strut is at rest (extended
until its preload is overcome, or stuck by friction) or moves in one direction. The tyre touches the
ground or not. The wheel slides in one direction or rolls. Integration restarts whenever one of
these states changes.

Source: B. Milwitzky, F. E. Cook, NACA TR 1154 (1953), for the form of the equations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from loads.landing.strut import Strut
from loads.landing.travel import TELESCOPIC, Levered, Telescopic
from loads.landing.tyre import Tyre, damped
from loads.landing.wheel import Wheel
from pinbase.arrays import Floats
from pinbase.errors import CodedError, NumberInSI

RELATIVE_TOLERANCE = 1e-11
ABSOLUTE_TOLERANCE = 1e-13  # relative to the scale of each variable
# First integration step, relative to the remaining time. After it an event function that begins at
# zero must no longer be zero.
FIRST_STEP_SHARE = 1e-7
MIN_STEPS = 200  # steps in the duration, so that no event is missed within a step
MAX_SPANS = 500  # largest number of phases between changes of mode
Method = Literal["DOP853", "Radau"]
STATE_ROWS = (
    TYRE_DEFLECTION,
    DEFLECTION_RATE,
    WHEEL_TRAVEL,
    WHEEL_TRAVEL_RATE,
    LEG_DEFLECTION,
    LEG_DEFLECTION_RATE,
    WHEEL_SPIN,
    OIL_ENERGY,
    FRICTION_ENERGY,
    TYRE_ENERGY,
    SLIP_ENERGY,
    RUNWAY_ENERGY,
    STOP_ENERGY,
) = range(13)


class LandingError(CodedError, ValueError):
    """The leg does not survive the drop, or the drop cannot be computed."""


@dataclass(frozen=True)
class Drop:
    """One leg and the mass that falls on it.

    sprung, unsprung: masses, kg.
    velocity: descent velocity at touch-down, m/s.
    tyre, strut, wheel: without a strut the leg is rigid; without a wheel there is no drag.
    lift: lift as a fraction of the weight.
    gravity: m/s^2.
    duration: time from touch-down to the end of the drop, s.
    travel: relation between the strut's stroke and the rise of the axle.
    """

    sprung: float
    unsprung: float
    velocity: float
    tyre: Tyre
    strut: Strut | None = None
    wheel: Wheel | None = None
    lift: float = 0.0
    gravity: float = 9.80665
    duration: float = 0.5
    travel: Telescopic | Levered = TELESCOPIC

    @property
    def mass(self) -> float:
        """Sprung and unsprung mass, kg."""
        return self.sprung + self.unsprung

    @property
    def weight(self) -> float:
        """Weight of both masses, N."""
        return self.mass * self.gravity


@dataclass(frozen=True)
class Mode:
    """The state of motion of strut, wheel and tyre, constant between events.

    strut: 1 closing, -1 opening, 0 at rest.
    wheel: 1 sliding aft, -1 sliding forward, 0 rolling.
    touches: whether the tyre is on the ground.
    """

    strut: int = 0
    wheel: int = 1
    touches: bool = True


@dataclass(frozen=True)
class DropForces:
    """Forces and accelerations at T states, (T,) each.

    vertical, drag: forces of the ground on the tyre, upwards and aft, N.
    at_wheel, along: force of the strut, reduced to the wheel and along the strut, positive in
    compression, N.
    on_leg: drag that the leg passes on to the aircraft, N.
    sprung, unsprung: accelerations of the two masses, positive downwards, m/s^2.
    stroke, speed: stroke of the strut and its rate, m and m/s.
    lever: derivative of the stroke by the rise of the axle.
    """

    vertical: Floats
    drag: Floats
    at_wheel: Floats
    along: Floats
    on_leg: Floats
    sprung: Floats
    unsprung: Floats
    stroke: Floats
    speed: Floats
    lever: Floats


def forces(d: Drop, y: Floats, mode: Mode) -> DropForces:
    """Forces at states y (STATE_ROWS, T) in one mode."""
    vertical = damped(d.tyre, y[TYRE_DEFLECTION], y[DEFLECTION_RATE])
    stroke, lever, _ = d.travel.at(y[WHEEL_TRAVEL])
    speed = lever * y[WHEEL_TRAVEL_RATE]
    common = d.gravity * (1.0 - d.lift) - vertical / d.mass
    if d.strut is None or mode.strut == 0:
        # Both masses fall as one body; the strut carries the force that this requires.
        sprung = unsprung = common
        at_wheel = d.sprung * (d.gravity - common) - d.lift * d.weight
        along = at_wheel / lever
    else:
        push = d.strut.spring.force(stroke) + d.strut.oil_force(speed)
        along = push + mode.strut * d.strut.friction
        at_wheel = along * lever
        sprung = d.gravity - (d.lift * d.weight + at_wheel) / d.sprung
        unsprung = d.gravity + (at_wheel - vertical) / d.unsprung
    drag = on_leg = np.zeros_like(vertical)
    if d.wheel is not None:
        drag = mode.wheel * d.wheel.friction * vertical
        if mode.wheel == 0:
            drag = d.wheel.rolling_drag(y[LEG_DEFLECTION], y[LEG_DEFLECTION_RATE])
        on_leg = d.wheel.on_leg(drag, y[LEG_DEFLECTION], y[LEG_DEFLECTION_RATE])
    return DropForces(
        vertical, drag, at_wheel, along, on_leg, sprung, unsprung, stroke, speed, lever
    )


def _rates(d: Drop, y: Floats, mode: Mode) -> Floats:
    """Time derivatives (STATE_ROWS, T) of states y (STATE_ROWS, T) in one mode."""
    f, out = forces(d, y, mode), np.zeros_like(y)
    out[TYRE_DEFLECTION], out[DEFLECTION_RATE] = y[DEFLECTION_RATE], f.unsprung
    out[WHEEL_TRAVEL], out[WHEEL_TRAVEL_RATE] = y[WHEEL_TRAVEL_RATE], f.sprung - f.unsprung
    if d.strut is not None:
        out[OIL_ENERGY] = d.strut.oil_force(f.speed) * f.speed
        out[FRICTION_ENERGY] = mode.strut * d.strut.friction * f.speed
    out[TYRE_ENERGY] = (f.vertical - d.tyre.force(y[TYRE_DEFLECTION])) * y[DEFLECTION_RATE]
    if d.wheel is not None:
        out[LEG_DEFLECTION] = y[LEG_DEFLECTION_RATE]
        out[LEG_DEFLECTION_RATE], out[WHEEL_SPIN] = d.wheel.rates(
            f.drag, y[LEG_DEFLECTION], y[LEG_DEFLECTION_RATE]
        )
        slip = 0.0 if mode.wheel == 0 else d.wheel.slip(y[LEG_DEFLECTION_RATE], y[WHEEL_SPIN])
        out[SLIP_ENERGY] = f.drag * slip + d.wheel.rate * y[LEG_DEFLECTION_RATE] ** 2
        out[RUNWAY_ENERGY] = f.drag * d.wheel.speed
    return out


def _limits(d: Drop, y: Floats) -> tuple[float, float]:
    """Least and largest force at the wheel (N) between which a strut at rest remains at rest."""
    if d.strut is None:
        return -np.inf, np.inf
    stroke, lever, _ = d.travel.at(y[WHEEL_TRAVEL])
    spring, friction = d.strut.spring.force(stroke), d.strut.friction
    low = -np.inf if y[WHEEL_TRAVEL] == 0.0 else float(lever * (spring - friction))
    return low, float(lever * (spring + friction))


Event = tuple[str, int, Callable[[Floats], float]]


def _events(d: Drop, mode: Mode, y: Floats) -> list[Event]:
    """The events that may end a mode.

    Each event has a name, the direction of its change of sign, and the function of the state whose
    sign changes.
    """
    out: list[Event] = [("tyre", -1 if mode.touches else 1, lambda y: y[TYRE_DEFLECTION])]
    if np.isfinite(d.tyre.max_deflection):
        out.append(("tyre-exceeded", 1, lambda y: y[TYRE_DEFLECTION] - d.tyre.max_deflection))
    if d.strut is not None and mode.strut:
        max_rise = d.travel.rise(d.strut.stroke)
        out.append(("turns", -mode.strut, lambda y: y[WHEEL_TRAVEL_RATE]))
        out.append(("extended", -1, lambda y: y[WHEEL_TRAVEL]))
        out.append(("bottoms", 1, lambda y: y[WHEEL_TRAVEL] - max_rise))
    elif d.strut is not None:
        low, high = _limits(d, y)
        out.append(("moves", 1, lambda y: float(forces(d, y, mode).at_wheel) - high))
        if np.isfinite(low):
            out.append(("moves", -1, lambda y: float(forces(d, y, mode).at_wheel) - low))
    if d.wheel is None or not mode.touches:
        return out
    if mode.wheel:
        wheel = d.wheel
        out.append(
            (
                "rolls",
                -mode.wheel,
                lambda y: float(wheel.slip(y[LEG_DEFLECTION_RATE], y[WHEEL_SPIN])),
            )
        )
    elif d.wheel.stiffness is not None:
        out.append(("slides", 1, lambda y: _beyond_grip(d, y, mode)))
    return out


def _beyond_grip(d: Drop, y: Floats, mode: Mode) -> float:
    """Drag that rolling requires in excess of the friction available, N."""
    assert d.wheel is not None
    f = forces(d, y, replace(mode, wheel=0))
    return float(np.abs(f.drag) - d.wheel.friction * f.vertical)


def _after(d: Drop, event: str, y: Floats, mode: Mode) -> tuple[Floats, Mode]:
    """State and mode with which the integration continues after an event."""
    y = y.copy()
    if event == "tyre":
        y[TYRE_DEFLECTION] = 0.0
        return y, replace(mode, touches=not mode.touches, wheel=_slides(d, y))
    if event in ("rolls", "slides"):
        return y, replace(mode, wheel=_wheel(d, y, mode, event))
    if event == "extended":
        # Perfectly plastic impact at the stop: afterwards both masses have a common velocity.
        velocity = (
            d.sprung * (y[DEFLECTION_RATE] + y[WHEEL_TRAVEL_RATE]) + d.unsprung * y[DEFLECTION_RATE]
        ) / d.mass
        y[STOP_ENERGY] += 0.5 * d.sprung * d.unsprung / d.mass * y[WHEEL_TRAVEL_RATE] ** 2
        y[DEFLECTION_RATE], y[WHEEL_TRAVEL] = velocity, 0.0
    y[WHEEL_TRAVEL_RATE] = 0.0
    low, high = _limits(d, y)
    holding_force = float(forces(d, y, replace(mode, strut=0)).at_wheel)
    if event == "moves":
        direction = 1 if abs(holding_force - high) <= abs(holding_force - low) else -1
    else:
        direction = (holding_force > high) - (holding_force < low)
    # A strut that has come to rest cannot continue in the same direction. Where the forces say that
    # it does, its motion was shorter than the first step, and it moves in the opposite direction.
    reverses = event == "turns" and direction == mode.strut
    return y, replace(mode, strut=-direction if reverses else direction)


def _slides(d: Drop, y: Floats) -> int:
    """Sliding direction of a wheel that touches the ground: 1 aft, -1 forward."""
    wheel = d.wheel
    return -1 if wheel and wheel.slip(y[LEG_DEFLECTION_RATE], y[WHEEL_SPIN]) < 0.0 else 1


def _wheel(d: Drop, y: Floats, mode: Mode, event: str) -> int:
    """Mode of the wheel after the event "rolls" or "slides": it rolls only if friction suffices."""
    if event == "rolls" and _beyond_grip(d, y, mode) <= 0.0:
        return 0
    return 1 if float(forces(d, y, replace(mode, wheel=0)).drag) >= 0.0 else -1


@dataclass(frozen=True)
class DropPhase:
    """The part of a drop between two changes of mode.

    first, last: times at which the phase begins and ends, s.
    state: function that returns the states (STATE_ROWS, T) at times (T,) s of the phase.
    event: name of the event that ends the phase; "end" at the end of the drop.
    """

    first: float
    last: float
    state: Callable[[Floats], Floats]
    mode: Mode
    event: str


def fall(d: Drop, method: Method = "DOP853") -> tuple[DropPhase, ...]:
    """The phases of a drop, by integration from touch-down.

    Raises: LandingError where the strut bottoms or the tyre is deflected beyond its table.
    """
    y, mode, time, spans = _start(d), Mode(), 0.0, list[DropPhase]()
    for _ in range(MAX_SPANS):
        span, y, mode = _span(d, time, y, mode, method)
        if span.last > span.first:
            spans.append(span)
        if span.event == "end":
            return tuple(spans)
        time = span.last
    raise LandingError(
        f"the strut or the wheel changes its mode more than {MAX_SPANS:,} times until "
        f"{time:.6g} s; reduce the friction or the duration",
        "too-many-events",
    )


def _start(d: Drop) -> Floats:
    """The state at touch-down, (STATE_ROWS,)."""
    y = np.zeros(len(STATE_ROWS))
    y[DEFLECTION_RATE] = d.velocity
    return y


def _scales(d: Drop) -> Floats:
    """Typical magnitudes of the rows of the state, (STATE_ROWS,), for tolerances."""
    out = np.full(len(STATE_ROWS), d.mass * d.velocity**2)
    out[[DEFLECTION_RATE, WHEEL_TRAVEL_RATE, LEG_DEFLECTION_RATE]] = d.velocity
    out[[TYRE_DEFLECTION, WHEEL_TRAVEL, LEG_DEFLECTION]] = d.velocity * 0.1
    out[WHEEL_SPIN] = 1.0 if d.wheel is None else max(d.wheel.speed / d.wheel.radius, 1.0)
    return out


def _span(
    d: Drop, time: float, y: Floats, mode: Mode, method: Method
) -> tuple[DropPhase, Floats, Mode]:
    """The phase that begins at a time (s) with state y and a mode, and the next state and mode."""
    from scipy.integrate import solve_ivp

    possible = _events(d, mode, y)
    solution: Any = solve_ivp(
        lambda _, y: _rates(d, y, mode),
        (time, d.duration),
        y,
        method,
        dense_output=True,
        events=[_terminal(direction, of) for _, direction, of in possible],
        rtol=RELATIVE_TOLERANCE,
        atol=ABSOLUTE_TOLERANCE * _scales(d),
        max_step=d.duration / MIN_STEPS,
        first_step=FIRST_STEP_SHARE * (d.duration - time),
    )
    if solution.status < 0:
        raise LandingError(f"the drop cannot be integrated: {solution.message}", "not-integrated")
    last, end, event = float(solution.t[-1]), solution.y[:, -1], "end"
    if solution.status == 1:
        event = next(n for (n, *_), t in zip(possible, solution.t_events, strict=True) if len(t))
    if event in ("bottoms", "tyre-exceeded"):
        raise _destroyed(d, event, last, end, mode)
    span = DropPhase(time, last, solution.sol, mode, event)
    return (span, *(_after(d, event, end, mode) if event != "end" else (end, mode)))


def _terminal(direction: int, of: Callable[[Floats], float]) -> Any:
    """An event of `solve_ivp` that ends the integration where `of` changes sign in a direction."""

    def event(_: float, y: Floats) -> float:
        return of(y)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event


def _destroyed(d: Drop, event: str, time: float, y: Floats, mode: Mode) -> LandingError:
    """The error for a strut that bottoms, with the remaining energy, or a tyre beyond its table."""
    f = forces(d, y, mode)
    remaining = (
        0.5 * d.mass * float(y[DEFLECTION_RATE] + y[WHEEL_TRAVEL_RATE] * d.sprung / d.mass) ** 2
    )
    sinking = NumberInSI(float(y[DEFLECTION_RATE] + y[WHEEL_TRAVEL_RATE]), "velocity")
    where = f"{time:.4g} s after touch-down, the aircraft still sinking at "
    if event == "bottoms":
        return LandingError(
            [
                "the strut bottoms at ",
                NumberInSI(float(f.stroke), "length"),
                f" {where}",
                sinking,
                " (about ",
                NumberInSI(remaining, "energy"),
                " are left): a longer stroke, a higher gas pressure or a smaller orifice is needed",
            ],
            "strut-bottoms",
        )
    return LandingError(
        [
            "the tyre is deflected beyond the last row of its table, ",
            NumberInSI(d.tyre.max_deflection, "length"),
            f", {where}",
            sinking,
            "; give more rows, or a stiffer tyre",
        ],
        "tyre-exceeded",
    )

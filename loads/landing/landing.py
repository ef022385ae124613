"""Forces, motion and energies of a drop at any time, and their largest values."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loads.forces.over_time import Extremum
from loads.landing.drop import (
    DEFLECTION_RATE,
    FRICTION_ENERGY,
    LEG_DEFLECTION,
    LEG_DEFLECTION_RATE,
    OIL_ENERGY,
    RUNWAY_ENERGY,
    SLIP_ENERGY,
    STATE_ROWS,
    STOP_ENERGY,
    TYRE_DEFLECTION,
    TYRE_ENERGY,
    WHEEL_SPIN,
    WHEEL_TRAVEL,
    WHEEL_TRAVEL_RATE,
    Drop,
    DropForces,
    DropPhase,
    LandingError,
    fall,
    forces,
)
from loads.motion.refine import resolved
from pinbase.arrays import Floats

PEAK_NAMES = ("vertical", "along", "stroke", "deflection", "drag", "on_leg", "spring_back")


@dataclass(frozen=True)
class LandingEnergies:
    """Energies of a drop, (T,) J each.

    kinetic .. bending: energy stored in the masses, the strut's spring, the tyre and the bent leg.
    oil .. slip: energy dissipated by orifice, strut friction, impact at the stop, tyre damping, and
    sliding with the damping of the bending leg.
    lift: energy taken away by lift.
    runway: work done by the ground that passes under the wheel.
    """

    kinetic: Floats
    potential: Floats
    spring: Floats
    tyre: Floats
    bending: Floats
    oil: Floats
    friction: Floats
    stop: Floats
    tyre_damping: Floats
    slip: Floats
    lift: Floats
    runway: Floats

    @property
    def imbalance(self) -> Floats:
        """Error of the energy balance over the initial kinetic energy, (T,); ideally zero."""
        stored = self.kinetic + self.potential + self.spring + self.tyre + self.bending
        lost = self.oil + self.friction + self.stop + self.tyre_damping + self.slip + self.lift
        return np.asarray((stored + lost - self.runway - self.kinetic[0]) / self.kinetic[0])


@dataclass(frozen=True)
class LandingHistory:
    """A drop at T instants, (T,) each, SI units.

    deflection: deflection of the tyre, m.
    rise, rise_rate: rise of the axle relative to the aircraft, m, and its rate, m/s.
    sink_velocity: velocity of the sprung mass, downwards, m/s.
    spin: angular velocity of the wheel, rad/s.
    """

    times: Floats
    deflection: Floats
    rise: Floats
    rise_rate: Floats
    sink_velocity: Floats
    spin: Floats
    forces: DropForces
    energies: LandingEnergies


@dataclass(frozen=True)
class Landing:
    """A drop with its history, made by `land`. spans: phases of the drop."""

    drop: Drop
    spans: tuple[DropPhase, ...]

    @property
    def corners(self) -> tuple[float, ...]:
        """Times at which strut, tyre or wheel change their mode, s."""
        return tuple(span.last for span in self.spans[:-1])

    def events(self, name: str) -> tuple[float, ...]:
        """Times of an event, s. name: tyre, moves, turns, extended, rolls or slides."""
        return tuple(span.last for span in self.spans if span.event == name)

    def at(self, times: Floats) -> LandingHistory:
        """The history of the drop at times (T,) s.

        Times outside the drop have the values at its nearer end; a change of mode has the values
        just before it.
        """
        d, inside = self.drop, np.clip(times, 0.0, self.spans[-1].last)
        phase = np.searchsorted([span.last for span in self.spans], inside)
        y, histories = np.empty((len(STATE_ROWS), len(times))), dict[str, Floats]()
        for k in np.unique(phase):
            instants, span = phase == k, self.spans[k]
            y[:, instants] = span.state(inside[instants])
            for name, values in vars(forces(d, y[:, instants], span.mode)).items():
                histories.setdefault(name, np.empty(len(times)))[instants] = values
        f = DropForces(**histories)
        return LandingHistory(
            times,
            y[TYRE_DEFLECTION],
            y[WHEEL_TRAVEL],
            y[WHEEL_TRAVEL_RATE],
            y[DEFLECTION_RATE] + y[WHEEL_TRAVEL_RATE],
            y[WHEEL_SPIN],
            f,
            _energies(d, y, f.stroke),
        )

    @cached_property
    def peaks(self) -> dict[str, Extremum]:
        """Largest values over the whole drop, by name (PEAK_NAMES), at least zero.

        The peak "spring_back" is the largest forward drag on the leg.
        """
        times = np.linspace(0.0, self.spans[-1].last, 201)

        def columns(times: Floats) -> Floats:
            h = self.at(times)
            f = h.forces
            values = (f.vertical, f.along, f.stroke, h.deflection, f.drag, f.on_leg, -f.on_leg)
            return np.stack(values, axis=1)

        best, when = resolved(times, columns, self.corners).largest(lambda values: values)
        exact = np.diagonal(columns(when))
        return {
            name: Extremum(float(max(value, 0.0)), float(time))
            for name, value, time in zip(PEAK_NAMES, np.maximum(best, exact), when, strict=True)
        }

    @property
    def load_factor(self) -> float:
        """Largest vertical force of the ground over the weight."""
        return self.peaks["vertical"].value / self.drop.weight

    @property
    def equal_impulse_time(self) -> float:
        """Duration (s) of a rectangular pulse of the peak force with the momentum m V."""
        return self.drop.mass * self.drop.velocity / self.peaks["vertical"].value


def land(drop: Drop) -> Landing:
    """The landing from a drop.

    Raises: LandingError where the drop fails, or when the aircraft still sinks at its end.
    """
    landing = Landing(drop, fall(drop))
    ends = [span.last for span in landing.spans]
    if landing.at(np.array([0.0, *ends])).sink_velocity.min() > 0.0:
        raise LandingError(
            f"the aircraft still sinks after {drop.duration:g} s; give a longer duration",
            "drop-too-short",
        )
    return landing


def _energies(d: Drop, y: Floats, stroke: Floats) -> LandingEnergies:
    """Energies at states y (STATE_ROWS, T). stroke: (T,) stroke of the strut, m."""
    z1, v1 = y[TYRE_DEFLECTION] + y[WHEEL_TRAVEL], y[DEFLECTION_RATE] + y[WHEEL_TRAVEL_RATE]
    wheel, bending = d.wheel, (zero := np.zeros(y.shape[1]))
    kinetic = 0.5 * (d.sprung * v1**2 + d.unsprung * y[DEFLECTION_RATE] ** 2)
    if wheel is not None:
        bending_mass = wheel.mass if wheel.stiffness is not None else 0.0
        kinetic = kinetic + 0.5 * (
            bending_mass * y[LEG_DEFLECTION_RATE] ** 2 + wheel.inertia * y[WHEEL_SPIN] ** 2
        )
        bending = 0.5 * (wheel.stiffness or 0.0) * y[LEG_DEFLECTION] ** 2
    return LandingEnergies(
        kinetic=kinetic,
        potential=-d.gravity * (d.sprung * z1 + d.unsprung * y[TYRE_DEFLECTION]),
        spring=zero if d.strut is None else d.strut.spring.energy(stroke),
        tyre=d.tyre.energy(y[TYRE_DEFLECTION]),
        bending=bending,
        oil=y[OIL_ENERGY],
        friction=y[FRICTION_ENERGY],
        stop=y[STOP_ENERGY],
        tyre_damping=y[TYRE_ENERGY],
        slip=y[SLIP_ENERGY],
        lift=d.lift * d.weight * z1,
        runway=y[RUNWAY_ENERGY],
    )

"""Plots of a linkage's motion: bodies, transmission angles, shaking forces, powers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pinbase.dimensions import Floats
from reports.data.motion import MIN_TRANSMISSION_ANGLE, LinkageMotion, Posture
from reports.data.row import Units
from reports.format.file_names import plot_name
from reports.format.numbers import ten_to
from reports.plots.spec import Abscissa, Panel, Plot, Spec, clipped, curves, level, rows
from reports.plots.theme import SERIES_COLOURS

NEGLIGIBLE_MOTION_SHARE = 1e-9
MAX_BODIES_PER_PLOT = len(SERIES_COLOURS)


def motion_plots(motion: LinkageMotion, units: Units) -> Iterator[Plot]:
    """Yield all plots against time; none for a linkage at rest."""
    if motion.time is None:
        return
    time = Abscissa(f"time [{units.time}]", motion.time)
    yield from _bodies(motion, time, units)
    yield from transmission_plots(motion, units)
    yield _shaking(motion, time, units)
    yield _ledger(motion, time, units)


def _bodies(motion: LinkageMotion, time: Abscissa, units: Units) -> Iterator[Plot]:
    turning = _turning(motion)
    still = [clipped(b) for k, b in enumerate(motion.bodies) if k not in turning]
    names = ", ".join(still)
    note = f"; not rotating: {names if len(names) < 70 else f'{len(still)} bodies'}"
    for part, first in enumerate(range(0, len(turning), MAX_BODIES_PER_PLOT), start=1):
        shown = turning[first : first + MAX_BODIES_PER_PLOT]
        panels = [
            Panel(heading, {motion.bodies[b]: values[:, b] for b in shown})
            for values, heading in (
                (motion.angle, "angle [deg]"),
                (motion.angular_velocity, f"angular velocity [rad/{units.time}]"),
                (motion.angular_acceleration, f"angular acceleration [rad/{units.time}²]"),
            )
        ]
        title = f"{motion.case}: rotating bodies"
        if len(turning) > MAX_BODIES_PER_PLOT:
            title += f", {part} of {-(-len(turning) // MAX_BODIES_PER_PLOT)}"
        name = "bodies" if part == 1 else f"bodies-{part}"
        spec = curves(title, time, panels, common=True)
        yield Plot(plot_name(name, motion.case), title + (note if still else ""), spec)


def _turning(motion: LinkageMotion) -> list[int]:
    speeds = np.abs(motion.angular_velocity).max(axis=0, initial=0.0)
    rates = np.abs(motion.angular_acceleration).max(axis=0, initial=0.0)
    return [
        b
        for b in range(len(motion.bodies))
        if speeds[b] > NEGLIGIBLE_MOTION_SHARE * speeds.max()
        or rates[b] > NEGLIGIBLE_MOTION_SHARE * rates.max()
    ]


def transmission_plots(posture: Posture, units: Units) -> Iterator[Plot]:
    """Yield the plot of transmission angles, for a planar linkage with the condition number.

    There is no plot at rest, and none in space if no link has a transmission angle.
    """
    angles = {n: v for n, v in posture.transmission.items() if np.isfinite(v).any()}
    planar = isinstance(posture, LinkageMotion)
    if posture.time is None or not (angles or planar):
        return
    time = Abscissa(f"time [{units.time}]", posture.time)
    panels = [_conditioning(posture.condition)] if isinstance(posture, LinkageMotion) else []
    title = f"{posture.case}: transmission angles{' and conditioning' if planar else ''}"
    caption = title
    if angles:
        limits = {"domain": [0.0, 92.0]}
        under = _poor(), level(MIN_TRANSMISSION_ANGLE)
        heading = "transmission angle [deg]"
        panels.insert(0, Panel(heading, angles, under, scale=limits, height=150.0, zero=False))
        caption += (
            f"; shaded: below {MIN_TRANSMISSION_ANGLE:.0f} deg, where forces increase rapidly"
        )
    spec = curves(title, time, panels)
    yield Plot(plot_name("transmission", posture.case), caption, spec)


def _conditioning(values: Floats) -> Panel:
    condition = np.where(np.isfinite(values) & (values > 0.0), values, np.nan)
    top = max(1.3 * float(np.nanmax(condition, initial=1.0)), 10.0)
    return Panel(
        "condition number of the loop equations [1], logarithmic",
        {"": condition},
        scale={"type": "log", "domain": [1.0, top], "clamp": True},
        zero=False,
    )


def _poor() -> Spec:
    return {
        "data": rows([{}]),
        "mark": {"type": "rect", "style": "shade"},
        "encoding": {
            "x": {"value": 0}, "x2": {"value": "width"},
            "y": {"datum": 0.0, "type": "quantitative"}, "y2": {"datum": MIN_TRANSMISSION_ANGLE},
        },
    }  # fmt: skip


def _shaking(motion: LinkageMotion, time: Abscissa, units: Units) -> Plot:
    force = motion.shaking_force
    about = f"moment about {clipped(motion.shaking_about)} [{units.force}·{units.length}]"
    panels = [
        Panel(f"force [{units.force}]", {"Fx": force[:, 0], "Fy": force[:, 1]}),
        Panel(about, {"": motion.shaking_moment}),
    ]
    title = f"{motion.case}: force and moment of the linkage on its ground"
    return Plot(plot_name("shaking", motion.case), title, curves(title, time, panels))


def _ledger(motion: LinkageMotion, time: Abscissa, units: Units) -> Plot:
    p = motion.ledger
    unit = f"[{units.force}·{units.length}/{units.time}]"
    given = {
        "drives": p.drives,
        "gravity": p.gravity,
        "applied loads": p.applied,
        "friction": p.friction,
    }
    largest = max(float(np.abs(v).max()) for v in (*given.values(), p.kinetic_rate))
    acting = {n: v for n, v in given.items() if np.abs(v).max() > NEGLIGIBLE_MOTION_SHARE * largest}
    rate = {"rate of kinetic energy, and sum of powers": p.kinetic_rate}
    panels = [
        Panel(f"power {unit}", acting or {"drives": p.drives}),
        Panel(f"rate of kinetic energy {unit}", rate),
    ]
    title = f"{motion.case}: powers, and the rate of kinetic energy that they leave"
    caption = f"{title} (largest difference {_tiny(p.violation)} of the largest term)"
    return Plot(plot_name("ledger", motion.case), caption, curves(title, time, panels))


def _tiny(value: float) -> str:
    if value == 0.0 or not np.isfinite(value):
        return f"{value:g}"
    digits, power = f"{value:.1e}".split("e")
    return f"{digits}×{ten_to(int(power))}"

"""Plots of a linkage's motion: bodies, transmission angles, shaking forces, powers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from reports.data.results import Floats, LinkageMotion, Units
from reports.format.file_names import plot_name
from reports.format.numbers import ten_to
from reports.format.style import COLOURS, GREY, INK, clipped, line_style, panels, save
from reports.plots.curves import curves, finish

GUIDANCE = 40.0  # degrees; designers keep transmission angles above
NEGLIGIBLE = 1e-9
MOST = len(COLOURS)  # bodies in one figure


def motion_plots(motion: LinkageMotion, units: Units, directory: Path) -> list[Path]:
    """All plots against time; none for a static linkage."""
    if motion.time is None:
        return []
    return [
        path
        for draw in (_bodies, _transmission, _shaking, _ledger)
        for path in draw(motion, motion.time, units, directory)
    ]


def _bodies(motion: LinkageMotion, time: Floats, units: Units, directory: Path) -> list[Path]:
    turning = _turning(motion)
    still = [clipped(b) for k, b in enumerate(motion.bodies) if k not in turning]
    paths = []
    for part, first in enumerate(range(0, len(turning), MOST)):
        shown = turning[first : first + MOST]
        with panels(3, height=max(1.9, 0.3 * len(shown)), sharex=True) as (figure, axes):
            for panel, values, heading in (
                (axes[0], motion.angle, "angle [deg]"),
                (axes[1], motion.angular_velocity, f"angular velocity\n[rad/{units.time}]"),
                (
                    axes[2],
                    motion.angular_acceleration,
                    f"angular acceleration\n[rad/{units.time}²]",
                ),
            ):
                panel.set_ylabel(heading)
                curves(panel, time, {motion.bodies[b]: values[:, b] for b in shown})
            title = f"{motion.case}: rotating bodies"
            if len(turning) > MOST:
                title += f", {part + 1} of {-(-len(turning) // MOST)}"
            if still:
                names = ", ".join(still)
                names = names if len(names) < 70 else f"{len(still)} bodies"
                title += f"\n(not rotating: {names})"
            finish(figure, axes, units, title)
            name = "bodies" if part == 0 else f"bodies-{part + 1}"
            paths += save(figure, directory, plot_name(name, motion.case))
    return paths


def _turning(motion: LinkageMotion) -> list[int]:
    speeds = np.abs(motion.angular_velocity).max(axis=0, initial=0.0)
    rates = np.abs(motion.angular_acceleration).max(axis=0, initial=0.0)
    return [
        b
        for b in range(len(motion.bodies))
        if speeds[b] > NEGLIGIBLE * speeds.max() or rates[b] > NEGLIGIBLE * rates.max()
    ]


def _transmission(motion: LinkageMotion, time: Floats, units: Units, directory: Path) -> list[Path]:
    angles = {n: v for n, v in motion.transmission.items() if np.isfinite(v).any()}
    rows = 2 if angles else 1
    with panels(rows, height=max(2.2, 0.22 * len(angles)), sharex=True) as (figure, axes):
        if angles:
            axes[0].set(
                ylim=(0.0, 92.0), yticks=range(0, 91, 15), ylabel="transmission angle [deg]"
            )
            axes[0].plot(
                time[[0, -1]], [GUIDANCE] * 2, color=INK, linewidth=0.9, linestyle=(0, (1, 1))
            )
            axes[0].fill_between(time[[0, -1]], 0.0, GUIDANCE, color="#f0f0f0", linewidth=0.0)
            curves(axes[0], time, angles, zero=False)
        known = np.isfinite(motion.condition) & (motion.condition > 0.0)
        condition = np.where(known, motion.condition, np.nan)
        axes[-1].plot(time, condition, **line_style(0))
        axes[-1].set_ylabel("condition number [1]\nlogarithmic")
        _logarithmic(axes[-1], condition)
        title = f"{motion.case}: transmission angles and conditioning"
        if angles:
            title += f"\n(shaded: below {GUIDANCE:.0f} deg, where forces increase rapidly)"
        finish(figure, axes, units, title)
        return save(figure, directory, plot_name("transmission", motion.case))


def _logarithmic(axes: Axes, values: Floats) -> None:
    known = values[np.isfinite(values)]
    top = 1.3 * float(known.max(initial=1.0))
    axes.set_yscale("log")
    axes.set_ylim(1.0, max(top, 10.0))
    subs = (1.0, 2.0, 5.0) if top < 2e3 else (1.0,)
    axes.yaxis.set_major_locator(LogLocator(subs=subs, numticks=12))
    axes.yaxis.set_minor_formatter(NullFormatter())


def _shaking(motion: LinkageMotion, time: Floats, units: Units, directory: Path) -> list[Path]:
    with panels(2, height=2.2, sharex=True) as (figure, axes):
        axes[0].set_ylabel(f"force [{units.force}]")
        force = motion.shaking_force
        curves(axes[0], time, {"Fx": force[:, 0], "Fy": force[:, 1]})
        axes[1].set_ylabel(
            f"moment about {clipped(motion.shaking_about)}\n[{units.force}·{units.length}]"
        )
        axes[1].plot(time, motion.shaking_moment, **line_style(0))
        finish(figure, axes, units, f"{motion.case}: force and moment of the linkage on its ground")
        return save(figure, directory, plot_name("shaking", motion.case))


def _ledger(motion: LinkageMotion, time: Floats, units: Units, directory: Path) -> list[Path]:
    p = motion.ledger
    power = f"[{units.force}·{units.length}/{units.time}]"
    given = {
        "drives": p.drives,
        "gravity": p.gravity,
        "applied loads": p.applied,
        "friction": p.friction,
    }
    largest = max(float(np.abs(v).max()) for v in (*given.values(), p.kinetic_rate))
    acting = {n: v for n, v in given.items() if np.abs(v).max() > NEGLIGIBLE * largest}
    with panels(2, height=2.2, sharex=True) as (figure, axes):
        axes[0].set_ylabel(f"power {power}")
        curves(axes[0], time, acting)
        axes[1].set_ylabel(f"sum and rate {power}")
        both: Any = {"gid": "curve"}
        pale: Any = {"color": "#7d9cbf", "linewidth": 4.5, "label": "rate of\nkinetic energy"}
        axes[1].plot(time, p.kinetic_rate, **both, **pale)
        dashed: Any = {"color": INK, "linestyle": (0, (5, 3)), "label": "sum of powers"}
        axes[1].plot(time, sum(given.values()), **both, **dashed)
        axes[1].axhline(0.0, color=GREY, linewidth=0.8, zorder=1.0)
        finish(
            figure, axes, units,
            f"{motion.case}: powers in, and the rate of kinetic energy they leave\n"
            f"(largest violation {_tiny(p.violation)} of the largest term)",
        )  # fmt: skip
        return save(figure, directory, plot_name("ledger", motion.case))


def _tiny(value: float) -> str:
    if value == 0.0 or not np.isfinite(value):
        return f"{value:g}"
    digits, power = f"{value:.1e}".split("e")
    return f"{digits}×{ten_to(int(power))}"

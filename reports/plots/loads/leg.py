"""Plots of a spatial leg: rotation, motion, momenta, hinge and actuator loads."""

from __future__ import annotations

from collections.abc import Iterator

from reports.data.results import LegTable, Units
from reports.format.file_names import plot_name
from reports.plots.spec import Abscissa, Panel, Plot, curves

MOTION_QUANTITIES = {
    "wheel_omega": "angular velocity of the wheel",
    "wheel_alpha": "angular acceleration of the wheel",
    "v_C": "velocity of C",
    "a_C": "acceleration of C",
    "v_D": "velocity of D",
    "a_D": "acceleration of D",
}
MOMENTUM_QUANTITIES = {
    "p_leg_rate": "rate of momentum, leg",
    "p_wheel_rate": "rate of momentum, wheel",
    "L_leg_rate": "rate of angular momentum, leg",
    "L_wheel_rate": "rate of angular momentum, wheel",
}
HINGE_QUANTITIES = {"F_B": "force on the hinge B", "M_B": "moment on the hinge B"}
QUANTITY_GROUPS = {
    "motion": ("rotation of the wheel, velocities and accelerations", MOTION_QUANTITIES),
    "momenta": ("rates of momentum and of angular momentum", MOMENTUM_QUANTITIES),
    "hinge": ("force and moment on the hinge, actuator moment and spin moment", HINGE_QUANTITIES),
}


def leg_plots(table: LegTable, units: Units) -> Iterator[Plot]:
    """Yield one plot per group, with components in the aircraft's axes against time."""
    x = Abscissa(f"time [{units.time}]", table.time)
    for group, (what, members) in QUANTITY_GROUPS.items():
        panels = [_vector(table, name, title) for name, title in members.items()]
        if group == "hinge":
            panels += [_scalar(table, name) for name in ("actuator", "spin_moment")]
        title = f"{table.case}: {what} over time"
        yield Plot(plot_name(f"leg-{group}", table.case), title, curves(title, x, panels))


def _vector(table: LegTable, name: str, title: str) -> Panel:
    shown = table.vectors[name]
    parts = {f"{axis}'": shown.values[:, k] for k, axis in enumerate("xyz")}
    if name == "a_C":
        parts["y', Coriolis part"] = table.vectors["coriolis_C"].values[:, 1]
    return Panel(f"{title} [{_unit(shown.unit)}]", parts)


def _scalar(table: LegTable, name: str) -> Panel:
    shown = table.scalars[name]
    return Panel(f"{name.replace('_', ' ')} [{_unit(shown.unit)}]", {"": shown.values})


def _unit(unit: str) -> str:
    return unit.replace("^2", "²")

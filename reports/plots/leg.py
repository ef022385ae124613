"""Plots of a spatial leg: rotation, motion, momenta, hinge and actuator loads."""

from __future__ import annotations

from pathlib import Path

from reports.data.results import LegTable, Units
from reports.format.file_names import plot_name
from reports.format.style import GREY, line_style, panels, plain_numbers, save

GROUPS = {
    "motion": (
        ("wheel_omega", "angular velocity of the wheel"),
        ("wheel_alpha", "angular acceleration of the wheel"),
        ("v_C", "velocity of C"),
        ("a_C", "acceleration of C"),
        ("v_D", "velocity of D"),
        ("a_D", "acceleration of D"),
    ),
    "momenta": (
        ("p_leg_rate", "rate of momentum, leg"),
        ("p_wheel_rate", "rate of momentum, wheel"),
        ("L_leg_rate", "rate of angular momentum, leg"),
        ("L_wheel_rate", "rate of angular momentum, wheel"),
    ),
    "hinge": (("F_B", "force on the hinge B"), ("M_B", "moment on the hinge B")),
}


def leg_plots(table: LegTable, units: Units, directory: Path) -> list[Path]:
    """One figure per group, components in the aircraft's axes against time."""
    paths = []
    for group, members in GROUPS.items():
        hinge = group == "hinge"
        rows = len(members) // 2 + hinge
        with panels(rows, 2, height=2.3) as (figure, axes):
            for panel, (name, title) in zip(axes, members, strict=False):
                shown = table.vectors[name]
                for k, axis in enumerate("xyz"):
                    panel.plot(table.time, shown.values[:, k], label=f"{axis}'", **line_style(k))
                if name == "a_C":
                    coriolis = table.vectors["coriolis_C"].values
                    panel.plot(
                        table.time, coriolis[:, 1], label="y', Coriolis part", **line_style(3)
                    )
                panel.set(title=title, ylabel=f"[{shown.unit}]".replace("^2", "²"))
            if hinge:
                for panel, name in zip(axes[2:], ("actuator", "spin_moment"), strict=True):
                    shown = table.scalars[name]
                    panel.plot(table.time, shown.values, **line_style(0))
                    panel.set(title=name.replace("_", " "), ylabel=f"[{shown.unit}]")
            for panel in axes:
                panel.axhline(0.0, color=GREY, linewidth=0.8)
                panel.margins(x=0.0)
                panel.set_xlabel(f"time [{units.time}]")
                plain_numbers(panel)
            longest = max(axes, key=lambda a: len(a.lines))
            figure.legend(
                *longest.get_legend_handles_labels(),
                loc="outside lower left",
                ncols=4,
                handlelength=3.5,
            )
            figure.suptitle(f"{table.case}: the leg, {group}", x=0.01, ha="left")
            paths += save(figure, directory, plot_name(f"leg-{group}", table.case))
    return paths

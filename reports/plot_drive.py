"""Plots of the drive along a motion."""

from __future__ import annotations

from pathlib import Path

from reports.plot_names import plot_name
from reports.results import DriveTable, Units
from reports.style import GREY, label_ends, line_style, panels, plain_numbers, save


def drive_plot(table: DriveTable, units: Units, directory: Path) -> list[Path]:
    """The drive's force, its power, and work and energies against time."""
    energy = f"{units.force}·{units.length}"
    energies = (
        ("work of the drive", table.work),
        ("kinetic energy", table.kinetic_energy),
        ("potential energy", table.potential_energy),
    )
    with panels(3, height=1.9, sharex=True) as (figure, axes):
        axes[0].plot(table.time, table.force, **line_style(0))
        axes[0].set_ylabel(f"force [{units.force}]")
        axes[1].plot(table.time, table.power, **line_style(0))
        axes[1].set_ylabel(f"power [{energy}/{units.time}]")
        lines = []
        for order, (_, values) in enumerate(energies):
            lines += axes[2].plot(table.time, values, **line_style(order))
        axes[2].set_ylabel(f"energy [{energy}]")
        axes[2].set_xlabel(f"time [{units.time}]")
        for panel in axes:
            panel.axhline(0.0, color=GREY, linewidth=0.8)
            panel.margins(x=0.0)
            plain_numbers(panel)
        figure.align_ylabels()
        figure.suptitle(f"{table.case}: the drive", x=0.01, ha="left")
        label_ends(figure, axes[2], lines, [name for name, _ in energies])
        return save(figure, directory, plot_name("drive", table.case))

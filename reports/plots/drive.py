"""Plots of each drive along a motion."""

from __future__ import annotations

from pathlib import Path

from reports.data.results import DriveTable, Units
from reports.format.file_names import drive_names, plot_name
from reports.format.numbers import engineering
from reports.format.style import (
    GREY,
    INK,
    clipped,
    label_ends,
    line_style,
    panels,
    plain_numbers,
    save,
)


def drive_plot(table: DriveTable, units: Units, directory: Path) -> list[Path]:
    """The drive's position, its force or torque, its power, and work and energies, over time."""
    energy = f"{units.force}·{units.length}"
    rotary = table.kind == "rotary"
    what, unit = ("torque", energy) if rotary else ("force", units.force)
    energies = (
        ("work of the drive", table.work),
        ("kinetic energy", table.kinetic_energy),
        ("potential energy", table.potential_energy),
    )
    with panels(4, height=1.75, sharex=True) as (figure, axes):
        axes[0].plot(table.time, table.position, **line_style(0))
        axes[0].set_ylabel("angle [deg]" if rotary else f"position [{units.length}]")
        levels = axes[1].plot(table.time, table.force, **line_style(0))
        texts = [what]
        for name, level, dash in (
            ("mean", table.mean, (0, (7, 2))),
            ("RMS", table.rms, (0, (1, 1.2))),
        ):
            ends = table.time[[0, -1]]
            levels += axes[1].plot(ends, [level] * 2, color=INK, linewidth=0.9, linestyle=dash)
            texts.append(f"{name} {engineering(level)}")
        axes[1].set_ylabel(f"{what} [{unit}]")
        axes[2].plot(table.time, table.power, **line_style(0))
        axes[2].set_ylabel(f"power [{energy}/{units.time}]")
        lines = []
        for order, (_, values) in enumerate(energies):
            lines += axes[3].plot(table.time, values, **line_style(order))
        axes[3].set_ylabel(f"energy [{energy}]")
        axes[3].set_xlabel(f"time [{units.time}]")
        for panel in axes:
            panel.margins(x=0.0)
            plain_numbers(panel)
        for panel in axes[1:]:
            panel.axhline(0.0, color=GREY, linewidth=0.8, zorder=1.0)
        figure.align_ylabels()
        drive = f"drive {clipped(table.name)}" if table.name else "the drive"
        figure.suptitle(
            f"{table.case}: {drive}; kinetic and potential energy of the whole linkage",
            x=0.01,
            ha="left",
        )
        label_ends(figure, axes[1], levels, texts)
        label_ends(figure, axes[3], lines, [name for name, _ in energies], settled=True)
        return save(figure, directory, plot_name("drive", *drive_names(table)))

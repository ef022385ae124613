"""Plots of each drive along a motion."""

from __future__ import annotations

import numpy as np

from reports.data.results import DriveTable, Units
from reports.format.file_names import drive_names, plot_name
from reports.format.numbers import engineering
from reports.plots.spec import Abscissa, Panel, Plot, clipped, curves


def drive_plot(table: DriveTable, units: Units) -> Plot:
    """Return the drive's position, force or torque, power, work and energies over time."""
    assert table.time is not None
    energy = f"{units.force}·{units.length}"
    rotary = table.kind == "rotary"
    what, unit = ("torque", energy) if rotary else ("force", units.force)
    even = np.ones_like(table.time)
    efforts = {
        what: table.force,
        f"mean {engineering(table.mean)}": table.mean * even,
        f"RMS {engineering(table.rms)}": table.rms * even,
    }
    energies = {
        "work of the drive": table.work,
        "kinetic energy": table.kinetic_energy,
        "potential energy": table.potential_energy,
    }
    position = "angle [deg]" if rotary else f"position [{units.length}]"
    panels = [
        Panel(position, {"": table.position}, zero=False),
        Panel(f"{what} [{unit}]", efforts),
        Panel(f"power [{energy}/{units.time}]", {"": table.power}),
        Panel(f"energy [{energy}]", energies),
    ]
    drive = f"drive {clipped(table.name)}" if table.name else "the drive"
    title = f"{table.case}: {position.split(' [')[0]}, {what}, power and energies of {drive}"
    spec = curves(title, Abscissa(f"time [{units.time}]", table.time), panels)
    caption = f"{title}; kinetic and potential energy of the whole linkage"
    return Plot(plot_name("drive", *drive_names(table)), caption, spec)

"""Curves over time: drives, drops, and a joint's motion compared with its closed form."""

from __future__ import annotations

import numpy as np

from reports.data.drop import DropRecord
from reports.data.mechanics import DriveTable
from reports.data.motion import MotionCheck
from reports.data.row import Units
from reports.format.file_names import drive_names, plot_name
from reports.format.numbers import engineering, short
from reports.plots.spec import Abscissa, Panel, Plot, Spec, clipped, curves, points


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


ENERGY_NAMES = {
    "kinetic": "kinetic",
    "spring": "strut's spring",
    "tyre": "tyre",
    "oil": "oil",
    "friction": "friction",
    "stop": "extension stop",
    "slip": "sliding tyre",
}


def drop_plots(d: DropRecord, units: Units) -> list[Plot]:
    """Return the plots over time, and over stroke if the drop has a strut."""
    forces = {"vertical": d.vertical, "along the strut": d.strut, "drag on the leg": d.leg_drag}
    lengths = {"stroke": d.stroke, "tyre": d.deflection}
    energies = {
        words: d.energies[key] for key, words in ENERGY_NAMES.items() if d.energies[key].any()
    }
    panels = [
        Panel(f"force [{units.force}]", {k: v for k, v in forces.items() if v.any()}, height=190.0),
        Panel(f"stroke, deflection [{units.length}]", lengths),
        Panel(f"sink velocity [{units.length}/{units.time}]", {"": d.sink_velocity}),
        Panel(f"energy [{units.force}·{units.length}]", energies, height=150.0),
    ]
    title = f"{d.case}: forces, motion and energies of the drop"
    time = Abscissa(f"time [{units.time}]", d.time)
    plots = [Plot(plot_name("drop", d.case), title, curves(title, time, panels))]
    if np.isfinite(d.closing).any():
        title = f"{d.case}: vertical force over stroke"
        over = {"closing": d.closing, "opening": d.opening}
        panel = Panel(f"vertical force [{units.force}]", over, height=190.0)
        stroke = Abscissa(f"stroke [{units.length}]", d.strokes)
        plots.append(Plot(plot_name("drop-stroke", d.case), title, curves(title, stroke, [panel])))
    return plots


def motion_plot(check: MotionCheck, units: Units) -> Plot:
    """Return a joint's speed and acceleration with their closed form and the published points."""
    speed = f"{units.length}/{units.time}"
    panels = [
        Panel(heading, {"linkage": ours, "closed form": exact}, over=_published(check, column))
        for column, (heading, ours, exact) in enumerate(
            (
                (f"speed [{speed}]", check.speed, check.closed_form_speed),
                (f"acceleration [{speed}²]", check.acceleration, check.closed_form_acceleration),
            ),
            start=1,
        )
    ]
    title = f"{check.case}: speed and acceleration of joint {check.joint}"
    caption = title + ("; diamonds: published" if check.published else "")
    spec = curves(title, Abscissa(f"time [{units.time}]", check.time), panels)
    return Plot(plot_name("motion-check"), caption, spec)


def _published(check: MotionCheck, column: int) -> tuple[Spec, ...]:
    if not check.published:
        return ()
    rows = [
        {"x": row[0], "y": row[column], "text": f"published {short(row[column])}"}
        for row in check.published
    ]
    return (points(rows, "published", "diamond"),)

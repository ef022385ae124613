"""Plots of a joint's motion against its closed form."""

from __future__ import annotations

from reports.data.results import MotionCheck, Units
from reports.format.file_names import plot_name
from reports.format.numbers import short
from reports.plots.spec import Abscissa, Panel, Plot, Spec, curves, points


def motion_plot(check: MotionCheck, units: Units) -> Plot:
    """Return a joint's speed and acceleration with their closed form and published points."""
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

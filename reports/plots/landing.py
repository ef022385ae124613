"""Plots of the factor of safety over the ranges of a landing's impulse."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from reports.data.results import LandingRange, Units
from reports.format.file_names import plot_name
from reports.format.numbers import short
from reports.format.style import GREY, clipped, label_ends, line_style, panels, plain_numbers, save


def landing_plot(
    case: str, members: list[LandingRange], required: float | None, units: Units, directory: Path
) -> list[Path]:
    """Factor against impulse time: a panel per velocity change, a line per pin, logarithmic."""
    members = [m for m in members if m.safety_factor is not None]
    if not members:
        return []
    speeds = sorted({float(v) for v in members[0].velocity_change})
    shown = speeds if len(speeds) <= 2 else [speeds[0], speeds[-1]]
    with panels(len(shown), height=2.9) as (figure, axes):
        for panel, speed in zip(axes, shown, strict=True):
            lines = []
            for order, m in enumerate(members):
                assert m.safety_factor is not None
                here = np.isclose(m.velocity_change, speed)
                rank = np.argsort(m.impulse_time[here])
                lines += panel.semilogy(
                    m.impulse_time[here][rank], m.safety_factor[here][rank], **line_style(order)
                )
            for level, text in ((1.0, "yield"), (required, "required")):
                if level is not None:
                    panel.axhline(level, color=GREY, linewidth=0.9)
                    panel.annotate(
                        text,
                        (0.0, level),
                        xycoords=("axes fraction", "data"),
                        xytext=(3, 2),
                        textcoords="offset points",
                        fontsize=8,
                        color=GREY,
                    )
            panel.margins(x=0.0)
            panel.set(
                title=f"velocity change {short(speed)} {units.length}/{units.time}",
                xlabel=f"impulse time [{units.time}]",
                ylabel="factor of safety",
            )
            plain_numbers(panel)
            label_ends(figure, panel, lines, [_label(m) for m in members])
        note = "".join(_notes(members))
        figure.suptitle(f"{case}: safety factor against impulse time{note}", x=0.01, ha="left")
        return save(figure, directory, plot_name("landing-range", case))


def _label(m: LandingRange) -> str:
    """The pin, with its verdict unless it is converged."""
    name = clipped(m.pin)
    return f"pin {name}" if m.verdict == "converged" else f"pin {name}, {m.verdict}"


def _notes(members: list[LandingRange]) -> Iterator[str]:
    if any(m.verdict == "unconverged" for m in members):
        yield "\nunconverged: the error exceeds the tolerance"
    if any(m.verdict == "singular" for m in members):
        yield "\nsingular: no maximum exists; factors are those outside the excluded zones"

"""Plots of the safety factor over the ranges of a landing's impulse."""

from __future__ import annotations

import numpy as np

from pinbase.dimensions import Floats
from reports.data.row import LandingRange, Units
from reports.format.file_names import plot_name
from reports.format.numbers import short
from reports.plots.spec import Abscissa, Panel, Plot, curves, labels, level


def landing_plot(
    case: str, members: list[LandingRange], required: float | None, units: Units
) -> Plot | None:
    """Return the safety factor against the impulse time for the pulse of the case; None without
    factors.

    There is a panel for each velocity change (of more than two, the smallest and the largest) and a
    curve for each pin; the factors are on logarithmic axes.
    """
    names = labels(m.pin for m in members)
    known = {
        _label(names[m.pin], m): (m, m.safety_factor)
        for m in members
        if m.safety_factor is not None
    }
    if not known:
        return None
    first, _ = next(iter(known.values()))
    speeds = sorted({float(v) for v in first.velocity_change})
    levels = [level(1.0, "yield"), *([] if required is None else [level(required, "required")])]
    panels, x = [], np.empty(0)
    for speed in speeds if len(speeds) <= 2 else [speeds[0], speeds[-1]]:
        shown: dict[str, Floats] = {}
        for name, (m, factor) in known.items():
            nominal_pulse = np.array([pulse == m.nominal_pulse for pulse in m.pulses])
            here = np.flatnonzero(np.isclose(m.velocity_change, speed) & nominal_pulse)
            rank = here[np.argsort(m.impulse_time[here])]
            x, shown[name] = m.impulse_time[rank], factor[rank]
        heading = f"factor of safety, velocity change {short(speed)} {units.length}/{units.time}"
        scale = {"type": "log"}
        panels.append(
            Panel(heading, shown, tuple(levels), scale=scale, height=190.0, zero=False)
        )  # fmt: skip
    title = f"{case}: safety factor against impulse time"
    caption = "; ".join([title, *_notes(members)])
    spec = curves(title, Abscissa(f"impulse time [{units.time}]", x), panels, common=True)
    return Plot(plot_name("landing-range", case), caption, spec)


def _label(name: str, m: LandingRange) -> str:
    """Return the name of a pin, with its verdict unless this is "converged"."""
    return f"pin {name}" if m.verdict == "converged" else f"pin {name}, {m.verdict}"


def _notes(members: list[LandingRange]) -> list[str]:
    notes = {
        "unconverged": "unconverged: the error exceeds the tolerance",
        "singular": "singular: no maximum exists; factors are those outside the excluded zones",
    }
    return [text for verdict, text in notes.items() if any(m.verdict == verdict for m in members)]

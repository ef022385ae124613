"""Plots of safety factors over a landing's range, of the loading past yield, and of fatigue."""

from __future__ import annotations

import numpy as np

from assess.fatigue.records import CaseHistory, PointFatigue, PointHistory
from pinbase.dimensions import Floats
from reports.data.row import LandingRange, PinResult, Units
from reports.format.file_names import plot_name
from reports.format.numbers import short
from reports.plots.spec import (
    NUMBER_FORMAT,
    Abscissa,
    Panel,
    Plot,
    clipped,
    curves,
    headed,
    labels,
    level,
    rows,
)

STRESS_COLUMNS = ("signed", "von_mises")


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


def limit_plot(pin: PinResult, units: Units) -> Plot | None:
    """Return the load factor against displacement; None where no solid model was loaded
    past yield.
    """
    limit = pin.limit_load
    if limit is None or limit.curve is None or limit.upper is None:
        return None
    title = f"pin {pin.pin}, {pin.case}: load factor against the largest displacement"
    curve, levels = limit.curve, [level(1.0, "loads of the case")]
    x = np.unique(np.concatenate([curve.displacement, curve.permanent]))
    loaded = np.interp(x, curve.displacement, curve.factor)
    left = np.interp(x, np.maximum.accumulate(curve.permanent), curve.factor, right=np.nan)
    heading = "load factor"
    panel = Panel(heading, {"loaded": loaded, "left after unloading": left}, tuple(levels),
                  height=220.0)  # fmt: skip
    spec = curves(title, Abscissa(f"displacement [{units.length}]", x), [panel])
    return Plot(plot_name("limit-load", pin.pin, pin.case), title, spec)


def history_plot(history: PointHistory, units: Units) -> Plot:
    """Return signed and unsigned von Mises stress at a point over the instants.

    The cases follow each other with zero load between them.
    """
    signed, plain = (_course([getattr(c, name) for c in history.cases]) for name in STRESS_COLUMNS)
    title = f"Pin {clipped(history.pin)}, point {history.point}: stress over the cases"
    panel = Panel(f"stress [{units.stress}]", {"signed": signed, "von Mises": plain}, height=170.0)
    x = Abscissa("instant, case after case", np.arange(len(signed), dtype=np.float64))
    cases = ", ".join(_named(c) for c in history.cases)
    caption = f"{title}: {cases}; every case begins and ends at zero load"
    return Plot(plot_name("stress-history", history.pin), caption, curves(title, x, [panel]))


def _named(case: CaseHistory) -> str:
    count = len(case.signed)
    return f"{case.case} ({count} instant{'s' * (count > 1)})"


def _course(cases: list[Floats]) -> Floats:
    zero = np.zeros(1)
    return np.concatenate([zero, *(np.concatenate([case, zero]) for case in cases)])


def collective_plot(point: PointFatigue, unit: str, units: Units) -> Plot:
    """Return the number of cycles per unit in which amplitudes at a point are reached, cumulated
    from the largest amplitude.
    """
    reached = np.cumsum(point.counts)
    steps = [{"x": float(n), "y": float(a)} for a, n in zip(point.amplitudes, reached, strict=True)]
    title = f"Pin {clipped(point.pin)}, point {point.point}: cumulative spectrum per {unit}"
    heads = [f"cycles per {unit}", f"amplitude [{units.stress}]"]
    caption = f"{title}; amplitudes corrected for mean stress, where the method does"
    return Plot(plot_name("spectrum", point.pin), caption, {
        "title": headed(title),
        "usermeta": {"columns": heads},
        "data": rows(steps),
        "height": 170,
        "mark": {"type": "line", "interpolate": "step-before",
                 "point": {"size": 40, "filled": True}},
        "encoding": {
            "x": {"field": "x", "type": "quantitative", "title": f"{heads[0]}, logarithmic",
                  "scale": {"type": "log", "nice": False}},
            "y": {"field": "y", "type": "quantitative", "title": heads[1]},
            "tooltip": [
                {"field": "x", "type": "quantitative", "title": heads[0], "format": NUMBER_FORMAT},
                {"field": "y", "type": "quantitative", "title": heads[1], "format": NUMBER_FORMAT},
            ],
        },
    })  # fmt: skip

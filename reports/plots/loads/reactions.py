"""Plots of the forces on the pins, during a motion and in static cases."""

from __future__ import annotations

import numpy as np

from pinbase.dimensions import Floats
from reports.data.mechanics import PeakReaction, ReactionTable
from reports.data.row import Units
from reports.format.file_names import plot_name
from reports.format.numbers import engineering, short
from reports.plots.spec import (
    NUMBER_FORMAT,
    Abscissa,
    Panel,
    Plot,
    Spec,
    curves,
    headed,
    instant,
    points,
    rows,
)

NEGLIGIBLE_REACTION_SHARE = 1e-9
LOG_SCALE_RATIO = 100.0
NO_PIN_NAME = "no-pin"  # for connections that bear on no pin of the study


def reaction_plot(
    table: ReactionTable, pin: str, units: Units, governs: float | None = None
) -> Plot:
    """Return magnitudes and components of the forces of one pin's connections along a motion.

    governs: the abscissa at which the pin's stress is largest.
    """
    members = [c for c, name in enumerate(table.pins) if name == pin]
    names = [_name(table, c) for c in members]
    x = along(table, units)
    at: tuple[Spec, ...] = ()
    first: tuple[Spec, ...] = ()
    if governs is not None:
        late = governs > 0.5 * float(x.values.min() + x.values.max())
        at, first = (instant(governs),), (instant(governs, "governing instant", late),)
    peaks = _peaks(table, members, units)
    sizes = dict(zip(names, table.magnitudes[:, members].T, strict=True))
    panels = [
        Panel(f"force [{units.force}]", sizes, first, (peaks,), height=150.0),
        *(
            Panel(heading, dict(zip(names, values.T, strict=True)), at)
            for heading, values in _components_that_act(table, members, units).items()
        ),
    ]  # fmt: skip
    title = f"{_whose(pin)}, {table.case}: forces of the bodies on the pin, world axes"
    caption = f"{title}; dots mark maxima"
    if governs is not None:
        caption += ", the dashed line the governing instant"
    spec = curves(title, x, panels, common=True)
    return Plot(plot_name("reactions", table.case, pin or NO_PIN_NAME), caption, spec)


def along(table: ReactionTable, units: Units) -> Abscissa:
    """Return the abscissa of a motion's plots: the drive position, or the time if there is none."""
    if table.position is not None:
        unit = table.position_unit or units.length
        return Abscissa(f"drive position [{unit}]", table.position)
    if table.times is None:
        return Abscissa("instant", np.arange(len(table.forces), dtype=float))
    return Abscissa(f"time [{units.time}]", table.times)


def _whose(pin: str) -> str:
    return f"Pin {pin}" if pin else "Connections without a pin"


def _name(table: ReactionTable, c: int) -> str:
    name = table.connections[c]
    return f"{name} (shared)" if name in table.shared else name


def _peaks(table: ReactionTable, members: list[int], units: Units) -> Spec:
    along_time, largest = table.position is None, table.largest
    return points([
        {"x": (peak.time if along_time else peak.position) or 0.0, "y": peak.force,
         "text": f"{_name(table, c)}: {_peak(peak, units)}"}
        for c in members for peak in [largest[c]]
    ])  # fmt: skip


def _peak(peak: PeakReaction, units: Units) -> str:
    when = "" if peak.time is None else f", t = {short(float(f'{peak.time:.4g}'))} {units.time}"
    return f"largest {engineering(peak.force)} {units.force}{when}"


def _components_that_act(
    table: ReactionTable, members: list[int], units: Units
) -> dict[str, Floats]:
    """Return the components (T, members) by heading, without those that are zero up to
    round-off.
    """
    shown = {}
    for letter, all_values, unit in (
        ("F", table.forces, units.force),
        ("M", table.moments, f"{units.force}·{units.length}"),
    ):
        values = all_values[:, members]
        least = NEGLIGIBLE_REACTION_SHARE * float(np.abs(all_values).max(initial=0.0))
        for axis in range(3):
            if float(np.abs(values[:, :, axis]).max(initial=0.0)) > least:
                shown[f"{letter}{'xyz'[axis]} [{unit}]"] = values[:, :, axis]
    return shown or {f"Fx [{units.force}]": table.forces[:, members, 0]}


def bars(table: ReactionTable, units: Units) -> Plot:
    """Return a bar for each connection with the magnitude of its force, and the published
    values.
    """
    values = [peak.force for peak in table.largest]
    known = [v for v in (*values, *table.published.values()) if v > 0.0]
    log = bool(known) and max(known) / min(known) > LOG_SCALE_RATIO
    floor = 0.5 * min(known) if log else 0.0
    members = [
        {"name": _name(table, c), "force": max(value, floor), "text": engineering(value),
         "published": table.published.get(table.connections[c])}
        for c, value in enumerate(values)
    ]  # fmt: skip
    scale: Spec = {"type": "log", "domainMin": floor} if log else {"zero": True}
    title = f"{table.case}: force on the pin at each connection"
    spec = {
        "title": headed(title),
        "usermeta": {"columns": ["connection", f"force [{units.force}]"]},
        "data": rows(members),
        "height": {"step": 20},
        "encoding": {
            "y": {"field": "name", "type": "nominal", "sort": None, "title": None,
                  "axis": {"minExtent": 0}},
            "x": {"field": "force", "type": "quantitative", "scale": scale,
                  "title": f"force [{units.force}]" + (", logarithmic" if log else "")},
        },
        "layer": [
            {"mark": {"type": "bar", "style": "bar"}, "encoding": {
                "x2": {"datum": floor} if log else {"value": 0}}},
            {"mark": {"type": "text", "style": "note", "align": "left", "dx": 9},
             "encoding": {"text": {"field": "text", "type": "nominal"}}},
            *_published(table, units),
        ],
    }  # fmt: skip
    return Plot(plot_name("reactions", table.case), title + _key(table), spec)


def _key(table: ReactionTable) -> str:
    return "; diamonds: published" if table.published else ""


def _published(table: ReactionTable, units: Units) -> list[Spec]:
    if not table.published:
        return []
    tooltip = {"field": "published", "type": "quantitative", "format": NUMBER_FORMAT,
               "title": f"published [{units.force}]"}  # fmt: skip
    return [{
        "transform": [{"filter": "isValid(datum.published)"}],
        "mark": {"type": "point", "style": "published", "shape": "diamond", "size": 60,
                 "filled": True, "opacity": 1},
        "encoding": {"x": {"field": "published", "type": "quantitative"}, "tooltip": tooltip},
    }]  # fmt: skip

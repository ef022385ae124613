"""Plots of the forces on the pins, during a motion and in static cases."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from reports.data.results import Floats, PeakReaction, ReactionTable, Units
from reports.format.file_names import plot_name
from reports.format.numbers import engineering, short
from reports.format.style import GREY, INK, label_ends, line_style, panels, plain_numbers, save

NEGLIGIBLE = 1e-9
LOG_SPAN = 100.0
WITHOUT = "no-pin"  # connections that bear on no pin of the study


def reaction_plots(
    table: ReactionTable, pin: str, units: Units, directory: Path, governs: float | None = None
) -> list[Path]:
    """Of one pin its connections' components and magnitudes along the motion.

    governs: where on that axis the pin's stress is largest.
    """
    return [
        *_components(table, pin, units, directory, governs),
        *_magnitudes(table, pin, units, directory, governs),
    ]


def along(table: ReactionTable, units: Units) -> tuple[Floats, str]:
    """The abscissa of a motion's plots: drive position, or time if there is none."""
    if table.position is not None:
        return table.position, f"drive position [{table.position_unit or units.length}]"
    if table.times is None:
        return np.arange(len(table.forces), dtype=float), "instant"
    return table.times, f"time [{units.time}]"


def _whose(pin: str) -> str:
    return f"Pin {pin}" if pin else "Connections without a pin"


def _of_pin(table: ReactionTable, pin: str) -> list[int]:
    return [c for c, name in enumerate(table.pins) if name == pin]


def _name(table: ReactionTable, c: int) -> str:
    name = table.connections[c]
    return f"{name} (shared)" if name in table.shared else name


def _components(
    table: ReactionTable, pin: str, units: Units, directory: Path, governs: float | None
) -> list[Path]:
    members = _of_pin(table, pin)
    shown = _components_that_act(table, members, units)
    columns = 2 if len(shown) > 3 else 1
    rows = -(-len(shown) // columns)
    x, heading = along(table, units)
    with panels(rows, columns, 1.8) as (figure, axes):
        for panel, (name, values) in zip(axes, shown.items(), strict=False):
            _component(panel, x, values, members, table)
            panel.set(ylabel=name, xlabel=heading)
            _governs(panel, governs)
        for unused in axes[len(shown) :]:
            unused.remove()
        figure.align_ylabels()
        title = f"{_whose(pin)}, {table.case}: components, world axes; dots mark maxima"
        governing = "" if governs is None else "; dashed: governing instant"
        note = f"\n(zero components are omitted{governing})"
        figure.suptitle(title + note, x=0.01, ha="left")
        figure.legend(
            *axes[0].get_legend_handles_labels(),
            loc="outside lower left",
            ncols=min(3, len(members)),
            handlelength=3.5,
        )
        return save(figure, directory, plot_name("reactions", table.case, pin or WITHOUT))


def _components_that_act(
    table: ReactionTable, members: list[int], units: Units
) -> dict[str, Floats]:
    """Components (T, members) by heading, without those that are zero to round-off."""
    shown = {}
    for letter, all_values, unit in (
        ("F", table.forces, units.force),
        ("M", table.moments, f"{units.force}·{units.length}"),
    ):
        values = all_values[:, members]
        least = NEGLIGIBLE * float(np.abs(all_values).max(initial=0.0))
        for axis in range(3):
            if float(np.abs(values[:, :, axis]).max(initial=0.0)) > least:
                shown[f"{letter}{'xyz'[axis]} [{unit}]"] = values[:, :, axis]
    return shown or {f"Fx [{units.force}]": table.forces[:, members, 0]}


def _component(
    axes: Axes, x: Floats, values: Floats, members: list[int], table: ReactionTable
) -> None:
    for order, c in enumerate(members):
        axes.plot(x, values[:, order], label=_name(table, c), **line_style(order))
        peak = int(np.argmax(np.abs(values[:, order])))
        if values[peak, order]:
            axes.plot(x[peak], values[peak, order], "o", color=line_style(order)["color"], ms=4)
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.margins(x=0.0)
    plain_numbers(axes)


def _magnitudes(
    table: ReactionTable, pin: str, units: Units, directory: Path, governs: float | None
) -> list[Path]:
    members = _of_pin(table, pin)
    x, heading = along(table, units)
    with panels(1, height=3.2) as (figure, (axes,)):
        lines, texts = [], []
        for order, c in enumerate(members):
            values = table.magnitudes[:, c]
            lines += axes.plot(x, values, **line_style(order))
            peak = table.largest[c]
            at = peak.time if table.position is None else peak.position
            axes.plot(at or 0.0, peak.force, "o", color=line_style(order)["color"], ms=5)
            texts.append(f"{_name(table, c)}\n{_peak(peak, units)}")
        axes.set(xlabel=heading, ylabel=f"force [{units.force}]")
        axes.set_title(f"{_whose(pin)}, {table.case}: magnitudes; dots mark maxima", pad=10)
        axes.margins(x=0.0)
        # Room over the highest dot, however little the forces vary.
        axes.set_ylim(0.0, 1.06 * max(table.largest[c].force for c in members) or 1.0)
        plain_numbers(axes)
        _governs(axes, governs, "governing instant")
        label_ends(figure, axes, lines, texts)
        return save(figure, directory, plot_name("magnitudes", table.case, pin or WITHOUT))


def _governs(axes: Axes, at: float | None, text: str = "") -> None:
    """A line at the governing instant, where no single force need be maximal."""
    if at is None:
        return
    axes.axvline(at, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), zorder=0.5)
    low, high = sorted(axes.get_xlim())
    right = at > 0.5 * (low + high)
    axes.annotate(
        text, (at, 0.03), xycoords=("data", "axes fraction"), xytext=(-4 if right else 4, 0),
        textcoords="offset points", ha="right" if right else "left", fontsize=8.0, color=INK,
    )  # fmt: skip


def _peak(peak: PeakReaction, units: Units) -> str:
    when = "" if peak.time is None else f", t = {short(float(f'{peak.time:.4g}'))} {units.time}"
    return f"max {engineering(peak.force)}{when}"


def bars(table: ReactionTable, units: Units, directory: Path) -> list[Path]:
    """One bar per connection with its magnitude, and the published value."""
    values = np.array([peak.force for peak in table.largest])
    places = np.arange(len(values))[::-1]
    known = [v for v in (*values.tolist(), *table.published.values()) if v > 0.0]
    log = bool(known) and max(known) / min(known) > LOG_SPAN
    floor = 0.5 * min(known) if log else 0.0
    with panels(1, height=0.4 + 0.27 * len(values)) as (figure, (axes,)):
        axes.barh(places, np.maximum(values - floor, 0.0), 0.55, left=floor, color="#7d9cbf")
        ends = values.copy()
        for c, name in enumerate(table.connections):
            if name in table.published:
                ends[c] = max(ends[c], table.published[name])
                axes.plot(
                    table.published[name],
                    places[c],
                    "D",
                    ms=5.5,
                    mfc="white",
                    mec=INK,
                    label="published",
                )
        for end, value, place in zip(ends.tolist(), values.tolist(), places, strict=True):
            axes.annotate(
                engineering(value),
                (max(end, floor), place),
                xytext=(7, 0),
                textcoords="offset points",
                va="center",
                fontsize=8.5,
            )
        if log:
            axes.set_xscale("log")
            axes.set_xlim(floor, max(known) * (max(known) / floor) ** 0.12)
        else:
            axes.set_xlim(0.0, 1.14 * max(known, default=1.0))
        axes.set_yticks(places, [_name(table, c) for c in range(len(values))])
        axes.grid(axis="y", visible=False)
        axes.set_xlabel(f"force [{units.force}]" + (", logarithmic" if log else ""))
        axes.set_title(f"{table.case}: force on the pin at each connection", pad=8)
        plain_numbers(axes, "x")
        handles, labels = axes.get_legend_handles_labels()
        if handles:
            figure.legend(handles[:1], labels[:1], loc="outside lower left")
        return save(figure, directory, plot_name("reactions", table.case))

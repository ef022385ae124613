"""All plots of a run."""

from __future__ import annotations

from collections.abc import Iterator

from reports.data.decision import common_factor
from reports.data.mechanics import ReactionTable
from reports.data.results import Results
from reports.data.row import PinResult
from reports.plots.loads.histories import drive_plot, drop_plots, motion_plot
from reports.plots.loads.linkage import linkage_plot
from reports.plots.loads.motion import motion_plots, transmission_plots
from reports.plots.loads.reactions import bars, reaction_plot
from reports.plots.spec import Plot
from reports.plots.strength import collective_plot, history_plot, landing_plot, limit_plot
from reports.plots.stress.beam_check import beam_plots
from reports.plots.stress.joint import joint_plot
from reports.plots.stress.refinement import pin_refinement_plot, refinement_plot
from reports.plots.stress.surface import surface_plot
from reports.tables.strength.fatigue import worst_points


def all_plots(results: Results) -> dict[str, Plot]:
    """Return the plots by their names (reports.format.file_names)."""
    return {plot.name: plot for part in (_mechanics, _pins) for plot in part(results)}


def _mechanics(results: Results) -> Iterator[Plot]:
    units = results.units
    for table in results.reactions:
        if table.times is None:
            yield bars(table, units)
        else:
            at = governing(results, table)
            for pin in dict.fromkeys(table.pins):
                yield reaction_plot(table, pin, units, at.get(pin))
    for drive in results.drive:
        if drive.time is not None:
            yield drive_plot(drive, units)
    for drop in results.drops:
        yield from drop_plots(drop, units)
    for motion in results.motion:
        yield linkage_plot(motion, units)
        yield from motion_plots(motion, units)
    for posture in results.space_postures:
        yield from transmission_plots(posture, units)
    if results.motion_check is not None:
        yield motion_plot(results.motion_check, units)


def _pins(results: Results) -> Iterator[Plot]:
    units = results.units
    if results.beam_check is not None:
        yield from beam_plots(results.beam_check, units)
    for case in dict.fromkeys(r.case for r in results.landing):
        members = [r for r in results.landing if r.case == case]
        required = common_factor(pin for pin in results.pins if pin.case == case)
        plot = landing_plot(case, members, required, units)
        if plot is not None:
            yield plot
    for case in dict.fromkeys(pin.case for pin in results.pins):
        refined = [pin for pin in results.pins if pin.case == case and _refined(pin)]
        if refined:
            yield refinement_plot(case, refined, units)
    for name in dict.fromkeys(pin.pin for pin in results.pins):
        refined = [pin for pin in results.pins if pin.pin == name and _refined(pin)]
        if refined:
            yield pin_refinement_plot(name, refined, units)
    for pin in results.pins:
        if (limited := limit_plot(pin, units)) is not None:
            yield limited
        if pin.joint is not None and pin.joint.bands:
            yield joint_plot(pin.pin, pin.case, pin.joint, units)
    yield from _fatigue(results)
    pin_rows = {(p.pin, p.case): p for p in results.pins}
    shapes = {s.pin: s for s in results.shapes}
    for surface in results.surfaces:
        for shown in surface.cases if surface.revolved else ():
            row, shape = pin_rows[surface.pin, shown.case], shapes.get(surface.pin)
            yield surface_plot(surface, shown, row, shape, units)


def _fatigue(results: Results) -> Iterator[Plot]:
    """Yield the plots of the worst point of each pin."""
    if results.fatigue is None:
        return
    histories = {(h.pin, h.point): h for h in results.histories}
    for point in worst_points(results.fatigue):
        yield history_plot(histories[point.pin, point.point], results.units)
        yield collective_plot(point, results.fatigue.unit, results.units)


def governing(results: Results, table: ReactionTable) -> dict[str, float]:
    """Return the abscissa at which each pin's stress is largest: drive position, or time without
    one.
    """
    rows = (p for p in results.pins if p.case == table.case)
    at = {p.pin: p.time if table.position is None else p.position for p in rows}
    return {pin: x for pin, x in at.items() if x is not None}


def _refined(pin: PinResult) -> bool:
    """Return whether a row has several meshes to compare, without zeros, which a logarithmic axis
    cannot show.
    """
    steps = pin.history
    return len(steps) > 1 and all(s.max_von_mises > 0.0 and s.dofs > 0 for s in steps)

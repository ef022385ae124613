"""All plots of a run, each as SVG and as PNG."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

from reports.data.results import PinResult, ReactionTable, Results
from reports.plots.checks import beam_plots, motion_plot
from reports.plots.drive import drive_plot
from reports.plots.jobs import Draw, Plot, in_turn
from reports.plots.joint import joint_plot
from reports.plots.landing import landing_plot
from reports.plots.leg import leg_plots
from reports.plots.linkage import linkage_plot
from reports.plots.motion import motion_plots
from reports.plots.reactions import bars, reaction_plots
from reports.plots.refinement import pin_refinement_plot, refinement_plot
from reports.plots.surface import surface_plot


def save_plots(results: Results, directory: Path, draw: Draw = in_turn) -> list[Path]:
    """Draw all plots of the results into `directory`; returns the files."""
    directory.mkdir(parents=True, exist_ok=True)
    return draw([*_mechanics(results, directory), *_pins(results, directory)])


def _mechanics(results: Results, directory: Path) -> Iterator[Plot]:
    units = results.units
    for table in results.reactions:
        if table.times is None:
            yield partial(bars, table, units, directory)
        else:
            at = governing(results, table)
            for pin in dict.fromkeys(table.pins):
                yield partial(reaction_plots, table, pin, units, directory, at.get(pin))
    for drive in results.drive:
        yield partial(drive_plot, drive, units, directory)
    for motion in results.motion:
        yield partial(linkage_plot, motion, units, directory)
        yield partial(motion_plots, motion, units, directory)
    for leg in results.legs:
        yield partial(leg_plots, leg, units, directory)
    if results.motion_check is not None:
        yield partial(motion_plot, results.motion_check, units, directory)


def _pins(results: Results, directory: Path) -> Iterator[Plot]:
    units = results.units
    if results.beam_check is not None:
        yield partial(beam_plots, results.beam_check, units, directory)
    for case in dict.fromkeys(r.case for r in results.landing):
        members = [r for r in results.landing if r.case == case]
        yield partial(landing_plot, case, members, results.required_safety_factor, units, directory)
    for case in dict.fromkeys(pin.case for pin in results.pins):
        refined = [pin for pin in results.pins if pin.case == case and _can_be_drawn(pin)]
        if refined:
            yield partial(refinement_plot, case, refined, units, directory)
    for name in dict.fromkeys(pin.pin for pin in results.pins):
        refined = [pin for pin in results.pins if pin.pin == name and _can_be_drawn(pin)]
        # A single mesh says nothing about others.
        if any(len(pin.history) > 1 for pin in refined):
            yield partial(pin_refinement_plot, name, refined, units, directory)
    for pin in results.pins:
        if pin.joint is not None and pin.joint.bands:
            yield partial(joint_plot, pin.pin, pin.case, pin.joint, units, directory)
    found = {(p.pin, p.case): p for p in results.pins}
    shapes = {s.pin: s for s in results.shapes}
    for surface in results.surfaces:
        for shown in surface.cases if surface.revolved else ():
            row, shape = found[surface.pin, shown.case], shapes.get(surface.pin)
            yield partial(surface_plot, surface, shown, row, shape, units, directory)


def governing(results: Results, table: ReactionTable) -> dict[str, float]:
    """Position on a motion's axis (reports.plots.reactions.along) of each pin's maximum stress."""
    rows = (p for p in results.pins if p.case == table.case)
    at = {p.pin: p.time if table.position is None else p.position for p in rows}
    return {pin: x for pin, x in at.items() if x is not None}


def _can_be_drawn(pin: PinResult) -> bool:
    # A logarithmic axis cannot show zero.
    return len(pin.history) > 0 and all(s.max_von_mises > 0.0 and s.dofs > 0 for s in pin.history)

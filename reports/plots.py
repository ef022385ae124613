"""All plots of a run, each as SVG and as PNG."""

from __future__ import annotations

from pathlib import Path

from reports.plot_checks import beam_plots, motion_plot
from reports.plot_drive import drive_plot
from reports.plot_landing import landing_plot
from reports.plot_leg import leg_plots
from reports.plot_linkage import linkage_plot
from reports.plot_motion import motion_plots
from reports.plot_reactions import bars, reaction_plots
from reports.plot_refinement import pin_refinement_plot, refinement_plot
from reports.plot_surface import surface_plots
from reports.results import PinResult, ReactionTable, Results


def save_plots(results: Results, directory: Path) -> list[Path]:
    """Draw everything the results hold into `directory`; returns the files."""
    directory.mkdir(parents=True, exist_ok=True)
    units = results.units
    paths = []
    for table in results.reactions:
        moving = table.times is not None
        if moving:
            paths += reaction_plots(table, units, directory, governing(results, table))
        else:
            paths += bars(table, units, directory)
    for drive in results.drive:
        paths += drive_plot(drive, units, directory)
    for motion in results.motion:
        paths += linkage_plot(motion, units, directory)
        paths += motion_plots(motion, units, directory)
    for leg in results.legs:
        paths += leg_plots(leg, units, directory)
    if results.beam_check is not None:
        paths += beam_plots(results.beam_check, units, directory)
    if results.motion_check is not None:
        paths += motion_plot(results.motion_check, units, directory)
    for case in dict.fromkeys(r.case for r in results.landing):
        members = [r for r in results.landing if r.case == case]
        paths += landing_plot(case, members, results.required_safety_factor, units, directory)
    for case in dict.fromkeys(pin.case for pin in results.pins):
        refined = [pin for pin in results.pins if pin.case == case and _can_be_drawn(pin)]
        if refined:
            paths += refinement_plot(case, refined, units, directory)
    for name in dict.fromkeys(pin.pin for pin in results.pins):
        refined = [pin for pin in results.pins if pin.pin == name and _can_be_drawn(pin)]
        # A single mesh says nothing about others.
        if any(len(pin.history) > 1 for pin in refined):
            paths += pin_refinement_plot(name, refined, units, directory)
    return paths + surface_plots(results, directory)


def governing(results: Results, table: ReactionTable) -> dict[str, float]:
    """Where on a motion's axis (reports.plot_reactions.along) each pin's stress is largest."""
    rows = (p for p in results.pins if p.case == table.case)
    at = {p.pin: p.time if table.position is None else p.position for p in rows}
    return {pin: x for pin, x in at.items() if x is not None}


def _can_be_drawn(pin: PinResult) -> bool:
    # A logarithmic axis has no place for zero.
    return len(pin.history) > 0 and all(s.max_von_mises > 0.0 and s.dofs > 0 for s in pin.history)

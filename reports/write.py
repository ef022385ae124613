"""All reports of a run into one directory."""

from __future__ import annotations

from pathlib import Path

from reports.animation import write_animations
from reports.draw import Draw, in_turn
from reports.hand_checks import write_hand_checks
from reports.json_results import write_json
from reports.landing import write_landing
from reports.leg_tables import write_legs
from reports.linkage_tables import write_linkage
from reports.loads_summary import write_loads_summary
from reports.page import write_page
from reports.published_values import write_published_values
from reports.results import Results
from reports.tables import (
    write_beam_check,
    write_drive,
    write_motion_check,
    write_published_reactions,
    write_reactions,
    write_reactions_pin_axes,
    write_safety_factors,
)
from reports.zones import write_zones


def write_reports(
    results: Results,
    directory: Path,
    pictures: dict[tuple[str, str], Path],
    plots: bool = True,
    draw: Draw = in_turn,
) -> Path:
    """Write results.json, the tables, the plots and report.html; returns the page's path.

    pictures: of pins, by pin and case. plots: whether to draw them, which takes seconds,
    and `draw` by whom.
    """
    drawn = write_loads(results, directory, plots, draw)
    write_safety_factors(results, directory)
    write_hand_checks(results, directory)
    write_zones(results, directory)
    write_landing(results, directory)
    if results.beam_check is not None:
        write_beam_check(results.beam_check, directory / "beam_check.csv")
    return write_page(results, directory, pictures, drawn)


def write_loads(
    results: Results, directory: Path, plots: bool = True, draw: Draw = in_turn
) -> list[Path]:
    """Write results.json and all that needs no stresses; returns the plots."""
    directory.mkdir(parents=True, exist_ok=True)
    write_json(results, directory / "results.json")
    write_published_reactions(results, directory)
    write_published_values(results, directory)
    if results.reactions:
        write_reactions(results, directory / "reactions.csv")
        write_reactions_pin_axes(results, directory / "reactions_pin_axes.csv")
        write_loads_summary(results, directory / "loads.md")
    if results.drive:
        write_drive(results, directory / "drive.csv")
    if results.motion:
        write_linkage(results, directory)
        write_animations(results, directory)
    if results.legs:
        write_legs(results.legs, directory / "leg.csv")
    if results.motion_check is not None:
        write_motion_check(results.motion_check, directory / "motion_check.csv")
    if not plots:
        return []
    from reports.plots import save_plots

    return save_plots(results, directory / "plots", draw)

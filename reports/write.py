"""All reports of a run into one directory."""

from __future__ import annotations

from pathlib import Path

from reports.json_results import write_json
from reports.page import write_page
from reports.results import Results
from reports.tables import (
    write_beam_check,
    write_drive,
    write_motion_check,
    write_published_reactions,
    write_reactions,
    write_safety_factors,
)


def write_reports(
    results: Results, directory: Path, pictures: dict[tuple[str, str], Path], plots: bool = True
) -> Path:
    """Write results.json, the tables, the plots and report.html; returns the page's path.

    pictures: of pins, by pin and case. plots: whether to draw them, which takes seconds.
    """
    directory.mkdir(parents=True, exist_ok=True)
    write_json(results, directory / "results.json")
    write_safety_factors(results, directory)
    write_published_reactions(results, directory)
    if results.reactions:
        write_reactions(results, directory / "reactions.csv")
    if results.drive:
        write_drive(results, directory / "drive.csv")
    if results.beam_check is not None:
        write_beam_check(results.beam_check, directory / "beam_check.csv")
    if results.motion_check is not None:
        write_motion_check(results.motion_check, directory / "motion_check.csv")
    drawn: list[Path] = []
    if plots:
        from reports.plots import save_plots

        drawn = save_plots(results, directory / "plots")
    return write_page(results, directory, pictures, drawn)

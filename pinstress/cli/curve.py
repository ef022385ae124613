"""The `curve` command, which plots factors of safety against one number and writes a table."""

from __future__ import annotations

from pathlib import Path

from pinbase.processes.pool import processes
from pinstress.cli.output_folder import replacing, require_replaceable
from pinstress.cli.plots import draw_into, report_missing
from pinstress.cli.run import console, progress_bar
from pinstress.cli.shared import say
from pinstress.cli.streams import unneeded
from pinstress.explore.curve import Ends, curve
from pinstress.study.reading.file import Study
from pinstress.study.schema.units import split
from reports.data.curve import CURVE_NAME
from reports.plots.curve import curve_plot
from reports.tables.curve import curve_table
from reports.text.curve import print_curve

CURVE_CSV = f"{CURVE_NAME}.csv"


def curve_and_write(
    study: Study,
    key: str,
    ends: Ends,
    points: int,
    pins: list[str] | None,
    out: Path,
    jobs: int | None,
    quiet: bool,
) -> int:
    """Write curve.csv, curve.svg and curve.png into a folder. Return the exit status: 1 if no value
    has a factor.

    Raises: InputError.
    """
    require_replaceable(out, CURVE_CSV)
    with replacing(out, CURVE_CSV) as staging:
        with progress_bar(alone=processes(jobs) == 1, quiet=quiet) as progress:
            result = curve(study, key, ends, points, pins, processes(jobs), progress)
        curve_table(result).write(staging)
        failed = draw_into(staging, curve_plot(result))
    with unneeded(out):
        print_curve(result, console())
    if not quiet:
        say(f"Curve: {out / (CURVE_CSV if failed else f'{CURVE_NAME}.svg')}")
    status = report_missing(failed)
    if not any(point.safety_factor for point in result.points):
        say("Not decided: no value has a factor of safety.")
        return 1
    return status


def number_or_text(value: str | None) -> float | str | None:
    """Return the value of an option: a number, in the study's units, or a text with a unit."""
    if value is None:
        return None
    match split(value):
        case number, "":
            return number
    return value

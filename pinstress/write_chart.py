"""The `chart` command: climb, write the output folder as a whole, print what it says."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import click

from pinstress.chart import chart, prepare
from pinstress.output import replacing, require_replaceable
from pinstress.own_process import Limits, measure
from pinstress.study import Study
from pinstress.write import console, progress_bar
from reports.chart import NAME, Chart, write_chart_csv
from reports.chart_summary import percent
from reports.plot_names import plot_name
from reports.terminal_chart import print_chart

MARK = f"{NAME}.csv"


def chart_and_write(
    study: Study,
    pin: str,
    case: str,
    out: Path | None,
    tolerance: float | None,
    meshes: int | None,
    runs: int,
    limits: Limits,
) -> int:
    """Chart a pin into a folder; returns the exit status. Raises: InputError, ArithmeticError."""
    from reports.plot_chart import chart_plot

    directory = out or Path("out") / plot_name(f"{study.name}-{NAME}", pin, case)
    require_replaceable(directory, MARK)
    plan = prepare(study, pin, case, tolerance)
    with replacing(directory, MARK) as staging:
        with progress_bar() as progress:
            found = chart(plan, partial(measure, limits=limits), meshes, runs, progress)
        write_chart_csv(found, staging)
        chart_plot(found, staging)
    print_chart(found, console())
    click.echo(f"Chart: {directory / NAME}.svg", err=True)
    return _tell_not_reached(found)


def _tell_not_reached(found: Chart) -> int:
    tolerance, reference = percent(found.tolerance), found.reference.error
    if reference > found.tolerance:
        click.echo(
            f"Not reached: the reference is known to {percent(reference)} only, which is more "
            f"than the tolerance of {tolerance}.", err=True,
        )  # fmt: skip
        return 1
    if not any(p.error is not None and p.error <= found.tolerance for p in found.points):
        click.echo(f"Not reached: nothing charted is within {tolerance}.", err=True)
        return 1
    return 0

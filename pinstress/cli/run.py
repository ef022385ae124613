"""The `run` command, which analyses a study, writes the output folder and prints the table."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import click
from rich.console import Console

from pinbase.platform import portable
from pinbase.processes.pool import Job, ProcessDied, Progress, Tell, in_parallel, preload, processes
from pinstress.analysis.cache import Cache, user_cache
from pinstress.analysis.gather.gather import loads_only, results_of, units_of
from pinstress.analysis.plan import Plan, prepare
from pinstress.analysis.solve import entry_keys, solve_tasks
from pinstress.cli.closing import (
    EXIT_NUMERICS_FAILED,
    report_disagreements,
    report_left_out,
    report_missed,
    report_reused,
    report_slow_rows,
    report_status_zero,
    report_unchecked,
    report_violations,
)
from pinstress.cli.new_file import require_junit, write_over
from pinstress.cli.output_folder import replacing, require_replaceable
from pinstress.cli.plots import draw_and_print
from pinstress.cli.shared import open_page, say, warn
from pinstress.cli.streams import unneeded
from pinstress.study.model.balance import other_warnings
from pinstress.study.model.lost_fits import lost_fit_warnings
from pinstress.study.model.mechanism.linkage import fit_note
from pinstress.study.reading.choices import Selection
from pinstress.study.reading.extras import require_fatigue, require_package
from pinstress.study.reading.file import Study
from pinstress.study.reading.file_names import field_name
from pinstress.study.reading.inputs import inputs, require_unchanged
from reports.data.fields import Field
from reports.data.results import Results
from reports.data.row import Units
from reports.files import write_loads, write_pages, write_reports, write_stress_tables
from reports.junit import junit_xml
from reports.page.scripts import REPORT_PAGE
from reports.tables.column import MAX_CSV_ROWS
from reports.text.loads import print_loads
from reports.text.safety_factors import print_safety_factors
from reports.text.second_opinion import print_second_opinion
from reports.text.work import print_work
from reports.vtk.fields import surface, write_flow, write_pin
from reports.vtk.index import identify_files

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import ProgressColumn

FILE_COLUMNS = 120  # width of output that is not a terminal, unless the environment sets COLUMNS
# Modules that solving a pin imports on demand: libraries that nearly all pins need, and models
RUN_LIBRARIES = "gmsh", "pymetis", "cvxopt.cholmod", "vtkmodules.vtkIOXML"
RUN_MODELS = (
    "assess.fatigue.critical_points",
    "fea.solve.solve",
    "fea.support.foundation.variations",
    "pinstress.analysis.gather.gather_landing",
    "pinstress.analysis.gather.gather_surface",
    "pinstress.analysis.remedies.changes",
    "pinstress.analysis.remedies.sensitivities",
)


@dataclass(frozen=True)
class OutputOptions:
    """Options for the output of a run.

    plots: whether to write plots and pictures as files.
    pdf: whether to write report.pdf.
    second: whether CalculiX gives a second opinion.
    vtk: the fields, as --vtk names them.
    as_json: print results.json on stdout instead of the table.
    quiet: no progress and no notes.
    opens: whether to open the report.
    jobs: number of parallel processes, by default the number of cores.
    cached: whether results in the user's cache may be reused.
    sensitive: whether to compute sensitivities in all cases.
    strict: whether a pin that misses its requirements changes the exit status.
    junit: the file for the requirements as JUnit XML, if any.
    work: whether to print the work of every check.
    """

    plots: bool = False
    pdf: bool = False
    second: bool = False
    vtk: str = "model"
    as_json: bool = False
    quiet: bool = False
    opens: bool = False
    jobs: int | None = None
    cached: bool = True
    sensitive: bool = False
    strict: bool = False
    junit: Path | None = None
    work: bool = False


def run_and_write(
    study: Study, directory: Path, wanted: OutputOptions, **chosen: Unpack[Selection]
) -> int:
    """Run a study into a folder and return the exit status.

    chosen: arguments of pinstress.analysis.plan.prepare.

    Raises: InputError.
    """
    require_fatigue(study)
    if wanted.pdf:
        require_package("typst", "--pdf")
    require_replaceable(directory)
    junit = None if wanted.junit is None else require_junit(wanted.junit, directory)
    also: Any = wanted.vtk if wanted.vtk in ("motion", "solid") else None
    most = processes(wanted.jobs)
    cache = user_cache() if wanted.cached else None
    with replacing(directory) as staging:  # from here on a second run into the folder is refused
        before = inputs(study)
        plan = replace(prepare(study, also=also, **chosen), sensitive=wanted.sensitive)
        tasks = plan.tasks
        warn(*other_warnings(study, tasks), *lost_fit_warnings(study, tasks), *fit_note(study))
        ask = _second_opinion(plan, wanted.quiet) if wanted.second else {}
        if wanted.vtk != "none":
            (staging / "vtk").mkdir()
        keep = partial(_keep, staging, units_of(study), wanted.vtk)
        with progress_bar(alone=most == 1, quiet=wanted.quiet) as progress:
            _preload_for(plan, cache)
            outcomes = solve_tasks(plan, keep, progress, jobs=most, cache=cache, **ask)
            results = results_of(plan, outcomes)
            require_unchanged(study, before)
            if wanted.vtk != "none":
                _write_flows(results, staging / "vtk")
                files = {field_name(row.pin, row.case): row for row in results.pins}
                identify_files(results, files, staging / "vtk")
            progress("report", 1.0)
            _write(results, staging, most)
    if junit is not None:
        write_over(junit, junit_xml(results))
    if cache:
        cache.trim()
    _print_results(results, directory, study, wanted)
    if not wanted.quiet:
        report_left_out(results)
        report_reused(plan, outcomes)
        say(f"Report: {directory / REPORT_PAGE}")
        _large_tables(directory)
    status = report_missed(results, study.table.analysis.goal == "decide")
    status = max(status, report_unchecked(results), report_disagreements(results))
    violated = report_violations(results) if wanted.strict else 0
    if not (status or wanted.strict or wanted.quiet):
        report_status_zero(results)
    drawn = draw_and_print(directory, wanted.plots, wanted.pdf, wanted.quiet)
    if wanted.opens:
        open_page(directory / REPORT_PAGE)
    return status if status == EXIT_NUMERICS_FAILED else max(status, violated, drawn)


def _print_results(results: Results, directory: Path, study: Study, wanted: OutputOptions) -> None:
    """Print results.json or the tables that the options request."""
    if wanted.as_json:
        click.echo((directory / "results.json").read_bytes(), nl=False)  # bytes: any locale
        return
    with unneeded(directory):
        print_safety_factors(results, console(), str(study.path))
        if wanted.work:
            print_work(results, console())
        if wanted.second:
            print_second_opinion(results, console())


def _preload_for(plan: Plan, cache: Cache | None) -> None:
    """Import once, for all processes, the modules that solve the pins that are not in the cache.

    With a single such pin, only the libraries are preloaded; it imports the models that it needs
    itself.
    """
    unsolved = 0
    for task in plan.tasks:
        keys = () if cache is None else entry_keys(plan, task, cache)
        if cache is None or not any(cache.has(key) for key in keys if key):
            unsolved += 1
            preload(*(RUN_LIBRARIES if unsolved == 1 else RUN_MODELS))
        if unsolved > 1:
            return


def _second_opinion(plan: Plan, quiet: bool) -> dict[str, Any]:
    # The import includes the solid model, which takes time.
    from pinstress.analysis.calculix import ask_calculix, slow_rows

    if not quiet:
        report_slow_rows(slow_rows(plan))
    return {"ask": ask_calculix}


def _write(results: Results, staging: Path, most: int) -> None:
    """Write tables and page, in parallel if processes are forked; otherwise all results would first
    have to be sent to the other processes.
    """
    if most == 1 or portable():
        write_reports(results, staging)
        return
    writers = {"page": write_pages, "tables": write_stress_tables}
    jobs: list[Job[None]] = [
        Job(name, partial(_written, write, results, staging)) for name, write in writers.items()
    ]
    outcomes = in_parallel(jobs, most)
    for job, nothing in zip(jobs, outcomes, strict=True):
        if isinstance(nothing, ProcessDied):
            job.work(_silent)


def _written(
    write: Callable[[Results, Path], object], results: Results, staging: Path, _: Tell
) -> None:
    write(results, staging)


def _silent(_: str) -> None:
    pass


def _keep(staging: Path, units: Units, vtk: str, field: Field) -> None:
    """Write the requested output of a field."""
    if vtk != "none":
        shown = surface(field) if vtk == "surface" else field
        write_pin(shown, field_name(field.pin, field.case), staging / "vtk", units)


def _write_flows(results: Results, directory: Path) -> None:
    for pin in results.pins:
        if pin.limit_load and pin.limit_load.flow:
            path = directory / f"{field_name(pin.pin, pin.case)}.limit-load.vtu"
            write_flow(pin.limit_load.flow, path, results.units)


def loads_and_write(
    study: Study,
    directory: Path,
    *,
    plots: bool,
    cases: list[str] | None,
    quiet: bool = False,
) -> int:
    """Compute a study's mechanism into a folder and return the exit status.

    Raises: InputError.
    """
    require_replaceable(directory)
    with replacing(directory) as staging:
        results = loads_only(study, cases)
        warn(*fit_note(study))  # the linkage was fitted, so it differs from the drawn one
        write_loads(results, staging)
    with unneeded(directory):
        print_loads(results, console())
    if not quiet:
        say(f"Written: {directory}")
        _large_tables(directory)
    return draw_and_print(directory, plots, False, quiet)


def _large_tables(directory: Path) -> None:
    """Print the names of tables that are too long for CSV."""
    if names := sorted(path.name for path in directory.glob("*.parquet")):
        say(
            f"More than {MAX_CSV_ROWS:,} rows, so in Parquet (for pandas, polars, DuckDB): "
            f"{', '.join(names)}"
        )


def console() -> Console:
    """Return standard output as a console as wide as the terminal, or as COLUMNS states."""
    stated = os.environ.get("COLUMNS", "").isdecimal()  # as Console reads it
    return Console() if stated or sys.stdout.isatty() else Console(width=FILE_COLUMNS)


@contextmanager
def bar_on_stderr(*columns: ProgressColumn, alone: bool, quiet: bool) -> Iterator[Bar]:
    """Show a progress bar of these columns on stderr if it is a terminal; alone: as in
    `progress_bar`.
    """
    from rich.progress import Progress as Bar

    stderr = Console(stderr=True)
    silent = quiet or not stderr.file.isatty()  # Console would also accept FORCE_COLOR
    with Bar(*columns, console=stderr, transient=True, disable=silent, auto_refresh=alone) as bar:
        yield bar


@contextmanager
def progress_bar(alone: bool = True, quiet: bool = False) -> Iterator[Progress]:
    """Show a progress bar on stderr if it is a terminal.

    alone: whether this process does the work itself, so that a thread must refresh the bar;
    otherwise every call refreshes it.
    """
    from rich import progress as rich

    columns = (
        rich.TextColumn("{task.description}"),
        rich.BarColumn(),
        rich.TimeElapsedColumn(),
        rich.TextColumn("left"),
        rich.TimeRemainingColumn(),
    )
    with bar_on_stderr(*columns, alone=alone, quiet=quiet) as bar:
        task = bar.add_task("reactions", total=1.0)

        def show(message: str, part: float) -> None:
            bar.update(task, description=message, completed=part, refresh=not alone)

        yield show

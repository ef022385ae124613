"""The `run` command: analyse, write the output folder as a whole, print the table."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from pinstress.file_names import field_name
from pinstress.output import replacing, require_replaceable
from pinstress.pipeline import loads_only, prepare, results_of
from pinstress.second_opinion import Opinions
from pinstress.solving import solve_tasks
from pinstress.study import Study
from pinstress.workers import Died, Job, Progress, Tell, cores, preload, side_by_side
from reports.draw import Plot
from reports.results import Field, PinResult, Results, Units
from reports.terminal import print_safety_factors
from reports.terminal_loads import print_loads
from reports.vtk import render_pin, renderer_problem, write_vtu
from reports.write import write_loads, write_reports

SOLVERS = ("gmsh", "pymetis", "cvxopt.cholmod", "meshio")  # what fea and reports import on demand
PAINTERS = ("pyvista.plotting", "matplotlib.pyplot", "matplotlib.backends.backend_agg")


def run_and_write(
    study: Study,
    directory: Path,
    *,
    pictures: bool,
    second: bool = False,
    jobs: int | None = None,
    **chosen: Any,
) -> int:
    """Run a study into a folder; returns the exit status.

    second: whether CalculiX is asked for its opinion, too. jobs: processes at a time, by default as
    many as there are cores. chosen: what pinstress.plan.prepare takes.

    Raises: InputError.
    """
    require_replaceable(directory)
    plan = prepare(study, **chosen)
    problem = renderer_problem() if pictures else None
    most = jobs or cores()
    s = study.system
    units = Units(s.length, s.force, s.stress, s.time)
    opinions = Opinions(plan) if second else None
    with replacing(directory) as staging:
        vtk = staging / "vtk"
        vtk.mkdir()

        def keep(field: Field) -> None:
            name = field_name(field.pin, field.case)
            write_vtu(field, vtk / f"{name}.vtu", units)
            if pictures and problem is None:
                picture = staging / "plots" / f"pin_{name}.png"
                picture.parent.mkdir(exist_ok=True)
                render_pin(field, picture, units, f"pin {field.pin}, {field.case}")

        with progress_bar(alone=most == 1) as progress:
            if most > 1:
                preload(*SOLVERS, *(PAINTERS if pictures and problem is None else ()))
            ask = {"ask": opinions.ask} if opinions else {}
            found = solve_tasks(plan, keep, progress, jobs=most, **ask)
            results = results_of(plan, found)
            drawn = {
                (p.pin, p.case): path
                for p in results.pins
                if (path := staging / "plots" / f"pin_{field_name(p.pin, p.case)}.png").is_file()
            }
            progress("report", 1.0)
            write_reports(results, staging, drawn, pictures, partial(_draw, most))
            if opinions:
                opinions.hear(o for made in found for o in made.opinions)
                opinions.write(staging)
    print_safety_factors(results, console())
    if opinions:
        opinions.show(console())
    _tell_left_out(results)
    if problem is not None:
        click.echo(f"No pictures of the pins: {problem}", err=True)
    click.echo(f"Report: {directory / 'report.html'}", err=True)
    status = _tell_not_reached(results, study.table.analysis.goal == "decide")
    return max(status, opinions.tell_disagreements()) if opinions else status


def _files(plot: Plot, _: Tell) -> list[Path]:
    return plot()


def _draw(jobs: int, plots: Sequence[Plot]) -> list[Path]:
    """Have plots drawn side by side; their files."""
    work = [Job("plots", partial(_files, plot)) for plot in plots]
    found = []
    for files in side_by_side(work, jobs):
        if isinstance(files, Died):
            raise RuntimeError(f"a plot could not be drawn: {files.reason}")
        found += files
    return found


def loads_and_write(
    study: Study, directory: Path, *, plots: bool, cases: list[str] | None, jobs: int | None = None
) -> int:
    """The mechanics of a study into a folder; returns the exit status. Raises: InputError."""
    require_replaceable(directory)
    results = loads_only(study, cases)
    with replacing(directory) as staging:
        write_loads(results, staging, plots, partial(_draw, jobs or cores()))
    print_loads(results, console())
    click.echo(f"Written: {directory}", err=True)
    return 0


def console() -> Console:
    """Standard output, as wide as the terminal."""
    wide = {} if sys.stdout.isatty() else {"width": 120}  # a file has no width of its own
    return Console(**wide)  # type: ignore[arg-type]


def _tell_left_out(results: Results) -> None:
    ways: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for p in results.pins:
        if p.left_out:
            ways.setdefault((p.pin, p.left_out), []).append(p.case)
    for (pin, connections), cases in ways.items():
        click.echo(
            f"Pin {pin}, {', '.join(cases)}: the force at {', '.join(connections)} is left out, "
            "because the pin is held there.",
            err=True,
        )


def _tell_not_reached(results: Results, decide: bool) -> int:
    """Say on stderr what was not reached and what failed; the exit status."""
    failed = [p for p in results.pins if p.verdict == "failed"]
    missed = [
        p
        for p in results.pins
        if p.verdict not in ("converged", "failed")
        and not (decide and p.meets_required is not None)
    ]
    for which, reason in _by_reason(missed):
        click.echo(f"Not reached: {which}: {reason}.", err=True)
    for which, reason in _by_reason(failed):
        click.echo(f"Error: the numerics failed: {which}: {reason}", err=True)
    return 3 if failed else int(bool(missed))


def _by_reason(rows: list[PinResult]) -> list[tuple[str, str]]:
    """Which rows have the same note, and that note."""
    reasons: dict[str, list[str]] = {}
    for p in rows:
        reasons.setdefault(p.note, []).append(f"{p.pin} ({p.case})")
    return [(", ".join(which), reason) for reason, which in reasons.items()]


@contextmanager
def progress_bar(alone: bool = True) -> Iterator[Progress]:
    """A bar on stderr while it is a terminal; nothing otherwise. alone: whether this process does
    the work itself, so that a thread must move the bar; else every call does.
    """
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    console = Console(stderr=True)
    with Progress(
        *columns,
        console=console,
        transient=True,
        disable=not console.is_terminal,
        auto_refresh=alone,
    ) as bar:
        task = bar.add_task("reactions", total=1.0)

        def tell(message: str, part: float) -> None:
            bar.update(task, description=message, completed=part, refresh=not alone)

        show: Callable[[str, float], None] = tell
        yield show

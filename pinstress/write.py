"""The `run` command: analyse, write the output folder as a whole, print the table."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from pinstress.cache import Cache, user_cache
from pinstress.command import open_page
from pinstress.drawn import draw_once, plot_once
from pinstress.file_names import field_name
from pinstress.output import replacing, require_replaceable
from pinstress.pipeline import loads_only, prepare, results_of
from pinstress.plan import Plan
from pinstress.second_opinion import Opinions
from pinstress.solved import Solved
from pinstress.solving import solve_tasks
from pinstress.study import Study
from pinstress.workers import Died, Job, Progress, Tell, preload, processes, side_by_side
from reports.draw import Plot
from reports.results import Field, PinResult, Results, Units
from reports.terminal import print_safety_factors
from reports.terminal_loads import print_loads
from reports.vtk import render_pin, renderer_problem, surface, write_pin
from reports.write import write_loads, write_reports

SOLVERS = (
    "gmsh",
    "pymetis",
    "cvxopt.cholmod",
    "vtkmodules.vtkIOXML",
)  # what fea and reports import on demand
PAINTERS = ("pyvista.plotting", "matplotlib.pyplot", "matplotlib.backends.backend_agg")


@dataclass(frozen=True)
class Wanted:
    """What a run is to give besides its numbers: pictures; CalculiX's second opinion; fields (vtk,
    as --vtk names them); results.json on stdout instead of the table; no progress and no notes;
    the report opened. jobs: processes at a time, by default as many as there are cores. cached:
    whether pins that were solved before may be taken from the user's cache.
    """

    pictures: bool = True
    second: bool = False
    vtk: str = "model"
    as_json: bool = False
    quiet: bool = False
    opens: bool = False
    jobs: int | None = None
    cached: bool = True


def run_and_write(study: Study, directory: Path, wanted: Wanted, **chosen: Any) -> int:
    """Run a study into a folder; returns the exit status.

    chosen: what pinstress.plan.prepare takes. Raises: InputError.
    """
    require_replaceable(directory)
    also: Any = wanted.vtk if wanted.vtk in ("motion", "solid") else None
    plan = prepare(study, also=also, **chosen)
    problem = renderer_problem() if wanted.pictures else None
    most, paints = processes(wanted.jobs), wanted.pictures and problem is None
    opinions = Opinions(plan) if wanted.second else None
    cache = user_cache() if wanted.cached else None
    with replacing(directory) as staging:
        if wanted.vtk != "none":
            (staging / "vtk").mkdir()
        keep = partial(_keep, staging, _units(study), wanted.vtk, paints, cache)
        with progress_bar(alone=most == 1, quiet=wanted.quiet) as progress:
            preload(*SOLVERS, *(PAINTERS if paints else ()))
            ask = {"ask": opinions.ask} if opinions else {}
            found = solve_tasks(plan, keep, progress, jobs=most, cache=cache, **ask)
            results = results_of(plan, found)
            drawn = {
                (p.pin, p.case): path
                for p in results.pins
                if (path := _picture(staging, p.pin, p.case)).is_file()
            }
            progress("report", 1.0)
            write_reports(results, staging, drawn, wanted.pictures, partial(_draw, most, cache))
            if opinions:
                opinions.hear(o for made in found for o in made.opinions)
                opinions.write(staging)
    if cache:
        cache.trim()
    if wanted.as_json:
        click.echo((directory / "results.json").read_text(encoding="utf-8"), nl=False)
    else:
        print_safety_factors(results, console())
        if opinions:
            opinions.show(console())
    if not wanted.quiet:
        _tell_left_out(results)
        _tell_solved_before(plan, found)
        if problem is not None:
            click.echo(f"No pictures of the pins: {problem}", err=True)
        click.echo(f"Report: {directory / 'report.html'}", err=True)
    if wanted.opens:
        open_page(directory / "report.html")
    status = _tell_not_reached(results, study.table.analysis.goal == "decide")
    return max(status, opinions.tell_disagreements()) if opinions else status


def _units(study: Study) -> Units:
    s = study.system
    return Units(s.length, s.force, s.stress, s.time)


def _picture(staging: Path, pin: str, case: str) -> Path:
    return staging / "plots" / f"pin_{field_name(pin, case)}.png"


def _keep(
    staging: Path, units: Units, vtk: str, paints: bool, cache: Cache | None, field: Field
) -> None:
    """Write what is wanted of a field."""
    if vtk != "none":
        shown = surface(field) if vtk == "surface" else field
        write_pin(shown, field_name(field.pin, field.case), staging / "vtk", units)
    if paints:
        picture = _picture(staging, field.pin, field.case)
        picture.parent.mkdir(exist_ok=True)
        skin, title = replace(field, stills=(), volume=None), f"pin {field.pin}, {field.case}"

        def render() -> list[Path]:
            render_pin(skin, picture, units, title)
            return [picture]

        draw_once(render, ("render_pin", skin, units, title), picture.parent, cache)


def _files(plot: Plot, cache: Cache | None, _: Tell) -> list[Path]:
    return plot_once(plot, cache)


def _draw(jobs: int, cache: Cache | None, plots: Sequence[Plot]) -> list[Path]:
    """Have plots drawn side by side; their files."""
    work = [Job("plots", partial(_files, plot, cache)) for plot in plots]
    found = []
    for files in side_by_side(work, jobs):
        if isinstance(files, Died):
            raise RuntimeError(f"a plot could not be drawn: {files.reason}")
        found += files
    return found


def loads_and_write(
    study: Study,
    directory: Path,
    *,
    plots: bool,
    cases: list[str] | None,
    jobs: int | None = None,
    quiet: bool = False,
) -> int:
    """The mechanics of a study into a folder; returns the exit status. Raises: InputError."""
    require_replaceable(directory)
    results = loads_only(study, cases)
    with replacing(directory) as staging:
        write_loads(results, staging, plots, partial(_draw, processes(jobs), None))
    print_loads(results, console())
    if not quiet:
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


def _tell_solved_before(plan: Plan, found: list[Solved]) -> None:
    pins = {task.pin.name for task in plan.tasks}
    anew = {t.pin.name for t, made in zip(plan.tasks, found, strict=True) if not made.before}
    if pins - anew:
        click.echo(
            f"{len(pins - anew)} of {len(pins)} pin{'s' * (len(pins) > 1)} as solved before "
            "(--no-cache solves them again).",
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
def progress_bar(alone: bool = True, quiet: bool = False) -> Iterator[Progress]:
    """A bar on stderr while it is a terminal; nothing otherwise. alone: whether this process does
    the work itself, so that a thread must move the bar; else every call does.
    """
    from rich import progress as rich

    columns = (
        rich.TextColumn("{task.description}"),
        rich.BarColumn(),
        rich.TimeElapsedColumn(),
        rich.TextColumn("left"),
        rich.TimeRemainingColumn(),
    )
    console = Console(stderr=True)
    with rich.Progress(
        *columns,
        console=console,
        transient=True,
        disable=quiet or not console.is_terminal,
        auto_refresh=alone,
    ) as bar:
        task = bar.add_task("reactions", total=1.0)

        def tell(message: str, part: float) -> None:
            bar.update(task, description=message, completed=part, refresh=not alone)

        show: Callable[[str, float], None] = tell
        yield show

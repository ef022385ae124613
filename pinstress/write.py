"""The `run` command: analyse, write the output folder as a whole, print the table."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from pinstress.command import open_page
from pinstress.output import replacing, require_replaceable
from pinstress.pipeline import Progress, loads_only, prepare, solve
from pinstress.second_opinion import Opinions
from pinstress.study import Study
from reports.results import Field, Results, Units
from reports.terminal import print_safety_factors
from reports.terminal_loads import print_loads
from reports.vtk import render_pin, renderer_problem, surface, write_pin
from reports.write import write_loads, write_reports


@dataclass(frozen=True)
class Wanted:
    """What a run is to give besides its numbers: pictures; CalculiX's second opinion; fields (vtk,
    as --vtk names them); results.json on stdout instead of the table; no progress and no notes;
    the report opened.
    """

    pictures: bool = True
    second: bool = False
    vtk: str = "model"
    as_json: bool = False
    quiet: bool = False
    opens: bool = False


def run_and_write(study: Study, directory: Path, wanted: Wanted, **chosen: Any) -> int:
    """Run a study into a folder; returns the exit status.

    chosen: what pinstress.pipeline.prepare takes. Raises: InputError, ArithmeticError.
    """
    require_replaceable(directory)
    also: Any = wanted.vtk if wanted.vtk in ("motion", "solid") else None
    plan = prepare(study, also=also, **chosen)
    problem = renderer_problem() if wanted.pictures else None
    drawn: dict[tuple[str, str], Path] = {}
    s = study.system
    units = Units(s.length, s.force, s.stress, s.time)
    opinions = Opinions(plan) if wanted.second else None
    with replacing(directory) as staging:
        if wanted.vtk != "none":
            (staging / "vtk").mkdir()

        def keep(field: Field) -> None:
            if wanted.vtk != "none":
                shown = surface(field) if wanted.vtk == "surface" else field
                write_pin(shown, staging / "vtk", units)
            if wanted.pictures and problem is None:
                picture = staging / "plots" / f"pin_{field.pin}_{field.case}.png"
                picture.parent.mkdir(exist_ok=True)
                render_pin(field, picture, units, f"pin {field.pin}, {field.case}")
                drawn[field.pin, field.case] = picture

        with progress_bar(wanted.quiet) as progress:
            ask = {"ask": opinions.ask} if opinions else {}
            results = solve(plan, keep, progress, **ask)
            progress("report", 1.0)
            write_reports(results, staging, drawn, plots=wanted.pictures)
            if opinions:
                opinions.write(staging)
    if wanted.as_json:
        click.echo((directory / "results.json").read_text(encoding="utf-8"), nl=False)
    else:
        print_safety_factors(results, console())
        if opinions:
            opinions.show(console())
    if not wanted.quiet:
        _tell_left_out(results)
        if problem is not None:
            click.echo(f"No pictures of the pins: {problem}", err=True)
        click.echo(f"Report: {directory / 'report.html'}", err=True)
    if wanted.opens:
        open_page(directory / "report.html")
    status = _tell_not_reached(results, study.table.analysis.goal == "decide")
    return max(status, opinions.tell_disagreements()) if opinions else status


def loads_and_write(
    study: Study, directory: Path, *, plots: bool, cases: list[str] | None, quiet: bool = False
) -> int:
    """The mechanics of a study into a folder; returns the exit status. Raises: InputError."""
    require_replaceable(directory)
    results = loads_only(study, cases)
    with replacing(directory) as staging:
        write_loads(results, staging, plots=plots)
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


def _tell_not_reached(results: Results, decide: bool) -> int:
    missed = [
        p
        for p in results.pins
        if p.verdict != "converged" and not (decide and p.meets_required is not None)
    ]
    if not missed:
        return 0
    reasons: dict[str, list[str]] = {}
    for p in missed:
        reasons.setdefault(p.note, []).append(f"{p.pin} ({p.case})")
    for reason, which in reasons.items():
        click.echo(f"Not reached: {', '.join(which)}: {reason}.", err=True)
    return 1


@contextmanager
def progress_bar(quiet: bool = False) -> Iterator[Progress]:
    """A bar on stderr while it is a terminal; nothing otherwise."""
    from rich import progress as rich

    columns = (
        rich.TextColumn("{task.description}"),
        rich.BarColumn(),
        rich.TimeElapsedColumn(),
        rich.TextColumn("left"),
        rich.TimeRemainingColumn(),
    )
    console = Console(stderr=True)
    silent = quiet or not console.is_terminal
    with rich.Progress(*columns, console=console, transient=True, disable=silent) as bar:
        task = bar.add_task("reactions", total=1.0)

        def tell(message: str, part: float) -> None:
            bar.update(task, description=message, completed=part)

        show: Callable[[str, float], None] = tell
        yield show

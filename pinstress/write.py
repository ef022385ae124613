"""The `run` command: analyse, write the output folder as a whole, print the table."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich.console import Console

from pinstress.output import replacing, require_replaceable
from pinstress.pipeline import Progress, loads_only, prepare, solve
from pinstress.second_opinion import Opinions
from pinstress.study import Study
from reports.results import Field, Results, Units
from reports.terminal import print_safety_factors
from reports.terminal_loads import print_loads
from reports.vtk import render_pin, renderer_problem, surface, write_pin
from reports.write import write_loads, write_reports


def run_and_write(
    study: Study,
    directory: Path,
    *,
    pictures: bool,
    second: bool = False,
    vtk: str = "model",
    **chosen: Any,
) -> int:
    """Run a study into a folder; returns the exit status.

    second: whether CalculiX is asked for its opinion, too. vtk: which fields are written, as --vtk
    says. chosen: what pinstress.pipeline.prepare takes. Raises: InputError, ArithmeticError.
    """
    require_replaceable(directory)
    plan = prepare(study, motion=vtk == "motion", **chosen)
    problem = renderer_problem() if pictures else None
    drawn: dict[tuple[str, str], Path] = {}
    s = study.system
    units = Units(s.length, s.force, s.stress, s.time)
    opinions = Opinions(plan) if second else None
    with replacing(directory) as staging:
        if vtk != "none":
            (staging / "vtk").mkdir()

        def keep(field: Field) -> None:
            name = f"{field.pin}_{field.case}"
            if vtk != "none":
                shown = surface(field) if vtk == "surface" else field
                write_pin(shown, staging / "vtk", units)
            if pictures and problem is None:
                picture = staging / "plots" / f"pin_{name}.png"
                picture.parent.mkdir(exist_ok=True)
                render_pin(field, picture, units, f"pin {field.pin}, {field.case}")
                drawn[field.pin, field.case] = picture

        with progress_bar() as progress:
            ask = {"ask": opinions.ask} if opinions else {}
            results = solve(plan, keep, progress, **ask)
            progress("report", 1.0)
            write_reports(results, staging, drawn, plots=pictures)
            if opinions:
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


def loads_and_write(study: Study, directory: Path, *, plots: bool, cases: list[str] | None) -> int:
    """The mechanics of a study into a folder; returns the exit status. Raises: InputError."""
    require_replaceable(directory)
    results = loads_only(study, cases)
    with replacing(directory) as staging:
        write_loads(results, staging, plots=plots)
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
def progress_bar() -> Iterator[Progress]:
    """A bar on stderr while it is a terminal; nothing otherwise."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    console = Console(stderr=True)
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal
    ) as bar:
        task = bar.add_task("reactions", total=1.0)

        def tell(message: str, part: float) -> None:
            bar.update(task, description=message, completed=part)

        show: Callable[[str, float], None] = tell
        yield show

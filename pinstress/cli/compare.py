"""The `compare` command, which shows two results folders side by side."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from pinbase.processes.apart import Failed, apart
from pinbase.processes.pool import preload
from pinstress.cli.closing import EXIT_REQUIREMENT_MISSED
from pinstress.cli.output_folder import replacing, require_replaceable
from pinstress.cli.plots import (
    PICTURE_MODULES,
    PICTURE_SECONDS,
    draw_pin,
    images,
    report_missing,
)
from pinstress.cli.run import console
from pinstress.cli.shared import say
from pinstress.cli.streams import unneeded
from pinstress.cli.view import opened_results
from pinstress.study.reading.errors import InputError
from pinstress.study.schema.units import UNIT_SYSTEMS, UnitSystem
from reports.data.comparison import DECISION_CHANGED, UNCHANGED, RowPair, RunComparison, compared
from reports.data.requirement_pairs import GONE, LOST
from reports.page.comparison import PicturePair, write_comparison
from reports.plots.comparison import comparison_plot
from reports.text.comparison import print_comparison, write_markdown
from reports.vtk.read_back import Opened
from reports.vtk.renderer import renderer_problem

COMPARISON_PAGE = "comparison.html"
MAX_PICTURES = 6


def compare(first: Path, second: Path, out: Path | None, pictures: bool) -> int:
    """Print the differences between two results folders, and write them into a folder `out`, if
    given.

    Returns the exit status: 4 if a requirement was lost, 1 if something could not be drawn.

    Raises: InputError.
    """
    opened = opened_results(first), opened_results(second)
    if pictures and out is None:
        raise InputError("--pictures: give a folder for them with --out", code="no-folder")
    comparison = _compared(*opened)
    if out is not None:
        require_replaceable(out, COMPARISON_PAGE)
    with unneeded(out or first):
        print_comparison(comparison, console())
    status = _report_lost(comparison)
    if out is None:
        return status
    failed: dict[str, Failed] = {}
    with replacing(out, COMPARISON_PAGE) as staging:
        write_markdown(comparison, staging / "comparison.md")
        drawn = _pictures(comparison, opened, staging, failed) if pictures else ()
        write_comparison(comparison, staging / COMPARISON_PAGE, _plot(comparison, failed), drawn)
    say(f"Comparison: {out / COMPARISON_PAGE}")
    return max(status, report_missing(failed))


def _report_lost(comparison: RunComparison) -> int:
    """Report the requirements that were lost, and return the exit status."""
    lost = comparison.requirements_that(LOST, GONE)
    for change in (LOST, GONE):
        rows = [f"{x.row.where}: {x.row.title}" for x in lost if x.change == change]
        if rows:
            many = "s" * (len(rows) > 1)
            say(f"Requirement{many} {change}: {'; '.join(rows)}.")
    return EXIT_REQUIREMENT_MISSED if lost else 0


def _plot(comparison: RunComparison, failed: dict[str, Failed]) -> str:
    """Return the plot of the page as SVG; empty if there is none."""
    plot = comparison_plot(comparison)
    return "".join(image for _, image in images([plot] if plot else [], failed))


def _compared(a: Opened, b: Opened) -> RunComparison:
    one, other = (_system(x) for x in (a, b))
    units = tuple(other.factor(x) / one.factor(x) for x in ("stress", "force"))
    folders = str(a.directory), str(b.directory)
    return compared(a.content, b.content, folders, (units[0], units[1]))


def _system(opened: Opened) -> UnitSystem:
    """Return the unit system of a results folder.

    Raises: InputError for units that no system has.
    """
    units = opened.units
    for system in UNIT_SYSTEMS.values():
        if all(getattr(system, name) == value for name, value in vars(units).items()):
            return system
    raise InputError(
        f"{opened.directory}: results.json is damaged: units: not those of any of "
        f"{', '.join(UNIT_SYSTEMS)}",
        code="unreadable-results",
    )


def _pictures(
    comparison: RunComparison, opened: tuple[Opened, Opened], into: Path, failed: dict[str, Failed]
) -> tuple[PicturePair, ...]:
    """Draw both pictures of the rows that changed most.

    failed: receives the pictures that could not be drawn.

    Raises: InputError for damaged results.
    """
    problem = renderer_problem()
    if problem is not None:
        say(f"No pictures of the pins: {problem}")
        return ()
    preload(*PICTURE_MODULES)
    rows = [row for row in comparison.rows if row.kind != UNCHANGED][:MAX_PICTURES]
    units = 1.0, _system(opened[1]).factor("stress") / _system(opened[0]).factor("stress")
    drawings = [
        (
            pair,
            side,
            _drawing(opened[side], pair, units[side], into / f"picture_{k}_{'ab'[side]}.png"),
        )
        for k, pair in enumerate(rows, 1)
        for side in (0, 1)
    ]
    work = [(f"pin {pair.pin}, {pair.case}", work) for pair, _, work in drawings if work]
    results = iter(apart(work, PICTURE_SECONDS))
    files: dict[tuple[str, str], list[Path | None]] = {}
    for pair, side, drawing in drawings:
        one = next(results) if drawing else []
        if isinstance(one, Failed):
            if one.damaged:
                raise InputError(
                    f"{opened[side].directory}: {one.reason}", code="unreadable-results"
                )
            failed[f"the picture of pin {pair.pin} in {pair.case}"] = one
            one = []
        files.setdefault((pair.pin, pair.case), []).append(one[0] if one else None)
    return tuple(
        PicturePair(
            f"Pin {row.pin}, {row.case}" + f": {row.kind}" * (row.kind == DECISION_CHANGED),
            (files[row.pin, row.case][0], files[row.pin, row.case][1]),
        )
        for row in rows
    )


def _drawing(
    opened: Opened, pair: RowPair, unit: float, path: Path
) -> Callable[[], list[Path]] | None:
    """Return the function that draws one of two pictures with a common colour scale, or None for a
    row that is not in this run.

    unit: unit of stress, relative to that of the pair.
    """
    maxima = [s.maximum for s in (pair.first, pair.second) if s and s.maximum is not None]
    top = max(maxima, default=0.0) / unit
    try:
        row = opened.row(pair.pin, pair.case)
    except ValueError:
        return None
    return partial(draw_pin, opened.only(row), path, top)

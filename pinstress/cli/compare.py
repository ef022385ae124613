"""The `compare` command: two results folders side by side."""

from __future__ import annotations

from pathlib import Path

import click

from pinstress.cli.output_folder import replacing, require_replaceable
from pinstress.cli.plots import PAINTERS
from pinstress.cli.run import console
from pinstress.cli.streams import unneeded
from pinstress.cli.view import opened_results
from pinstress.processes.pool import preload
from pinstress.schema.units import SYSTEMS, UnitSystem
from pinstress.study.errors import InputError
from reports.data.comparison import DECISION, UNCHANGED, RowPair, RunComparison, compared
from reports.page.comparison import PicturePair, write_comparison
from reports.text.comparison import print_comparison, write_markdown
from reports.vtk.read_back import Opened
from reports.vtk.renderer import renderer_problem

MARK = "comparison.html"
MOST = 6  # pictures


def compare(first: Path, second: Path, out: Path | None, pictures: bool) -> None:
    """Print what differs between two results folders; also write it into a folder.

    Raises: InputError.
    """
    opened = opened_results(first), opened_results(second)
    if pictures and out is None:
        raise InputError("--pictures: give a folder for them with --out", code="no-folder")
    found = _compared(*opened)
    if out is not None:
        require_replaceable(out, MARK)
    with unneeded(out or first):
        print_comparison(found, console())
    if out is None:
        return
    with replacing(out, MARK) as staging:
        write_markdown(found, staging / "comparison.md")
        drawn = _pictures(found, opened, staging) if pictures else ()
        write_comparison(found, staging / MARK, drawn)
    click.echo(f"Comparison: {out / MARK}", err=True)


def _compared(a: Opened, b: Opened) -> RunComparison:
    folders = str(a.directory), str(b.directory)
    try:
        one, other = (_system(x) for x in (a, b))
        units = tuple(other.factor(x) / one.factor(x) for x in ("stress", "force"))
        return compared(a.content, b.content, folders, (units[0], units[1]))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise InputError(
            f"{' or '.join(folders)}: its results.json is not complete ({error!r}); run it again",
            code="unreadable-results",
        ) from None


def _system(opened: Opened) -> UnitSystem:
    units = opened.units
    return next(s for s in SYSTEMS.values() if (s.length, s.stress) == (units.length, units.stress))


def _pictures(
    found: RunComparison, opened: tuple[Opened, Opened], into: Path
) -> tuple[PicturePair, ...]:
    """Of the rows that changed most."""
    problem = renderer_problem()
    if problem is not None:
        click.echo(f"No pictures of the pins: {problem}", err=True)
        return ()
    preload(*PAINTERS)
    rows = [row for row in found.rows if row.kind != UNCHANGED][:MOST]
    return tuple(
        PicturePair(
            f"Pin {row.pin}, {row.case}" + f": {row.kind}" * (row.kind == DECISION),
            (
                _drawn(opened[0], row, 1.0, into / f"picture_{k}_a.png"),
                _drawn(opened[1], row, _stress_of(*opened), into / f"picture_{k}_b.png"),
            ),
        )
        for k, row in enumerate(rows, 1)
    )


def _stress_of(a: Opened, b: Opened) -> float:
    """The unit of stress of the second run in that of the first."""
    return _system(b).factor("stress") / _system(a).factor("stress")


def _drawn(opened: Opened, pair: RowPair, unit: float, path: Path) -> Path | None:
    """One of two pictures whose colours mean the same; unit: of stress, in that of the pair."""
    from reports.vtk.render import render_pin

    maxima = [s.maximum for s in (pair.first, pair.second) if s and s.maximum is not None]
    top = max(maxima, default=0.0) / unit
    try:
        row = opened.row(pair.pin, pair.case)
        render_pin(opened.field(row), path, opened.units, opened.title(row), top)
    except (ValueError, FileNotFoundError):  # not in this run, or a beam
        return None
    return path

"""The `plots` and `pdf` commands: what the report of a folder shows, as files."""

from __future__ import annotations

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from loads import FileError, read_regular
from pinstress.cli import manifest
from pinstress.processes.pool import preload
from pinstress.study.errors import InputError
from pinstress.study.file_names import field_name
from reports.page.scripts import document_of, plots_of
from reports.pdf.typeset import shown_plots, write_pdf
from reports.plots.draw import draw
from reports.vtk.read_back import LARGEST, open_results
from reports.vtk.renderer import renderer_problem

FOLDER, PAGE, PDF = "plots", "report.html", "report.pdf"
PAINTERS = ("pyvista.plotting",)


def plots(directory: Path, quiet: bool = False) -> None:
    """Draw the plots and the pins of a results folder into its folder `plots`.

    Raises: InputError.
    """
    known = require_results(directory)
    own = f"{FOLDER}/"
    strange = {n for n in manifest.entries(directory) - known - {own} if n.startswith(own)}
    if strange:
        text = f"{directory}: pinstress did not write {min(strange)}; move it elsewhere"
        raise InputError(text, code="strange-file")
    with TemporaryDirectory(prefix="pinstress-") as made:
        paths = draw_folder(directory, Path(made), quiet)
        try:
            manifest.add(directory, [own, *(own + path.name for path in paths)])
            (directory / FOLDER).mkdir(exist_ok=True)
            for path in paths:
                shutil.copyfile(path, directory / FOLDER / path.name)
        except OSError as error:
            text = f"{directory}: cannot be written ({error.strerror})"
            raise InputError(text, code="cannot-write") from None
    click.echo(f"Written: {directory / FOLDER}", err=True)


def require_results(directory: Path) -> set[str]:
    """The files of a results folder that are ours. Raises: InputError."""
    known = manifest.listed(directory)
    if known is None:
        raise InputError(
            f"{directory}: no results of pinstress; name the folder that `pinstress run` or "
            "`pinstress loads` wrote",
            code="no-results",
        )
    return known


def draw_folder(directory: Path, into: Path, quiet: bool = False) -> list[Path]:
    """Draw what the report of a folder shows, and its pins by their fields; returns the files.

    Raises: InputError.
    """
    try:
        drawn = list(plots_of(read_regular(directory / PAGE, LARGEST).decode("utf-8")))
        opened = open_results(directory)
    except (OSError, ValueError, FileError):
        text = f"{directory}: no report.html and results.json to draw from"
        raise InputError(text, code="no-results") from None
    paths = draw(drawn, into)
    rows = [row for row in opened.content["pins"] if (directory / "vtk").is_dir()]
    problem = renderer_problem() if rows else None
    if problem is not None and not quiet:
        click.echo(f"No pictures of the pins: {problem}", err=True)
    if rows and problem is None:
        preload(*PAINTERS)
        from reports.vtk.render import render_pin

        for row in rows:
            picture = into / f"pin_{field_name(row['pin'], row['case'])}.png"
            try:
                field = opened.field(row)
            except FileNotFoundError:  # a beam has none
                continue
            render_pin(field, picture, opened.units, opened.title(row))
            paths.append(picture)
    return paths


def pdf(directory: Path) -> None:
    """Write report.pdf into a results folder. Raises: InputError."""
    known = require_results(directory)
    target = directory / PDF
    if PDF in manifest.entries(directory) - known:
        text = f"{directory}: pinstress did not write {PDF}; move it elsewhere"
        raise InputError(text, code="strange-file")
    try:
        manifest.add(directory, [PDF])
        print_folder(directory)
    except OSError as error:
        text = f"{target}: cannot be written ({error.strerror})"
        raise InputError(text, code="cannot-write") from None
    click.echo(f"Written: {target}", err=True)


def print_folder(directory: Path) -> None:
    """Write report.pdf of what the folder's report.html says. Raises: InputError, OSError."""
    problem = f"{directory}: no report.html of this version of pinstress to print; run it again"
    try:
        page = read_regular(directory / PAGE, LARGEST).decode("utf-8")
        content = document_of(page)
    except (OSError, ValueError, FileError):
        content = None
    if content is None:
        raise InputError(problem, code="no-results")
    wanted = set(shown_plots(content))
    plots = {plot.name: plot for plot in plots_of(page) if plot.name in wanted}
    write_pdf(content, plots, directory / PDF)

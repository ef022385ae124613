"""The `plots` command: what a report draws in the browser, as files."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from loads import FileError, read_regular
from pinstress.cli import manifest
from pinstress.processes.pool import preload
from pinstress.study.errors import InputError
from pinstress.study.file_names import field_name
from reports.plots.draw import draw
from reports.plots.spec import Plot
from reports.vtk.read_back import LARGEST, open_results
from reports.vtk.renderer import renderer_problem

FOLDER, PAGE = "plots", "report.html"
PAINTERS = ("pyvista.plotting",)
FIGURE = re.compile(r'<script type="application/json" data-plot="([\w.%~-]+)">(.*?)</script>')


def plots(directory: Path, quiet: bool = False) -> None:
    """Draw the plots and the pins of a results folder into its folder `plots`.

    Raises: InputError.
    """
    known = manifest.listed(directory)
    if known is None:
        raise InputError(
            f"{directory}: no results of pinstress; name the folder that `pinstress run` or "
            "`pinstress loads` wrote",
            code="no-results",
        )
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


def draw_folder(directory: Path, into: Path, quiet: bool = False) -> list[Path]:
    """Draw what the report of a folder shows, and its pins by their fields; returns the files.

    Raises: InputError.
    """
    try:
        page = read_regular(directory / PAGE, LARGEST).decode("utf-8")
        opened = open_results(directory)
    except (OSError, ValueError, FileError):
        text = f"{directory}: no report.html and results.json to draw from"
        raise InputError(text, code="no-results") from None
    found = (Plot(name, "", json.loads(spec)) for name, spec in FIGURE.findall(page))
    paths = draw(found, into)
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

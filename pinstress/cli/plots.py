"""The `plots` and `pdf` commands, which write the plots and pictures of a report as files.

Files are drawn in a temporary folder, by engines in processes of their own. They are added to the
results folder one by one, each complete or not at all.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from pinbase.errors import Damaged
from pinbase.grouped import grouped
from pinbase.processes import interrupts
from pinbase.processes.apart import NO_MEMORY_REASON, Failed, apart
from pinbase.processes.interrupts import Unfinished
from pinbase.processes.pool import preload
from pinstress.cli import manifest
from pinstress.cli.output_folder import RESULTS_JSON
from pinstress.cli.shared import say
from pinstress.study.reading.errors import InputError, cannot_write
from pinstress.study.reading.extras import require_package
from pinstress.study.reading.file_names import field_name
from reports.data.changes import as_argument
from reports.folder.inside import NotPlain, is_inside, read_inside, write_inside
from reports.folder.results_json import MAX_RESULTS_SIZE
from reports.page.scripts import REPORT_PAGE, document_of, plots_of
from reports.pdf.typeset import Content, shown_plots, typeset
from reports.plots.draw import draw_plot, svg
from reports.plots.spec import Plot
from reports.plots.theme import on_paper
from reports.vtk.read_back import Opened, open_results
from reports.vtk.renderer import renderer_problem

PLOTS_FOLDER, PDF_FILE = "plots", "report.pdf"
PICTURE_MODULES = ("pyvista.plotting",)
NO_PAGE_MESSAGE = "no report.html of this version of pinstress to print; run it again"
MAX_NAMED_FILES = 3
PICTURE_SECONDS, PDF_SECONDS = 120, 600  # limits of processor time; the largest take a tenth


@dataclass(frozen=True)
class Drawn:
    """Files that were drawn, and the failures of the others, by their names in the folder."""

    paths: tuple[Path, ...]
    failed: dict[str, Failed]


def plots(directory: Path, quiet: bool = False) -> int:
    """Draw the plots and the pins of a results folder into its subfolder `plots`.

    Returns the exit status: 1 if something could not be drawn.

    Raises: InputError.
    """
    known = require_results(directory)
    prefix = f"{PLOTS_FOLDER}/"
    strange = {n for n in _entries(directory) - known - {prefix} if n.startswith(prefix)}
    if strange or PLOTS_FOLDER in _entries(directory):
        raise _strange(directory, min(strange, default=PLOTS_FOLDER))
    drawn = add_plots(directory, quiet)
    if drawn.paths:
        say(f"Written: {directory / PLOTS_FOLDER}")
    return report_failed(directory, drawn.failed)


def pdf(directory: Path) -> int:
    """Write report.pdf into a results folder and return the exit status: 1 if it could not be made.

    Raises: InputError.
    """
    require_package("typst", "pdf")
    known = require_results(directory)
    if PDF_FILE in _entries(directory) - known:
        raise _strange(directory, PDF_FILE)
    failed = add_pdf(directory)
    if not failed:
        say(f"Written: {directory / PDF_FILE}")
    return report_failed(directory, failed)


def draw_and_print(directory: Path, plots: bool, pdf: bool, quiet: bool = False) -> int:
    """Add drawings and report.pdf to the complete results of a run.

    Returns the exit status: 1 if something could not be drawn, which affects nothing else.
    """
    failed: dict[str, Failed] = {}
    try:
        if plots:
            failed |= _attempted(f"{PLOTS_FOLDER}/", lambda: add_plots(directory, quiet).failed)
        if pdf:
            failed |= _attempted(PDF_FILE, lambda: add_pdf(directory))
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt) or interrupts.came():
            raise Unfinished(f"the results in {directory} are complete but for pictures") from None
        raise
    return report_failed(directory, failed)


def _attempted(name: str, add: Callable[[], dict[str, Failed]]) -> dict[str, Failed]:
    try:
        return add()
    except (InputError, OSError, ImportError) as error:
        return {name: Failed(str(error))}
    except MemoryError:
        return {name: Failed(NO_MEMORY_REASON)}


def images(plots: Iterable[Plot], failed: dict[str, Failed]) -> Iterator[tuple[Plot, str]]:
    """Yield plots with their drawings as SVG. failed: receives the failures of plots that could not
    be drawn.
    """
    shown = list(plots)
    work = [(p.name, partial(svg, {**p.spec, "config": on_paper()})) for p in shown]
    for plot, image in zip(shown, apart(work, PICTURE_SECONDS), strict=True):
        if isinstance(image, Failed):
            failed[f"the plot {plot.name}"] = image
        else:
            yield plot, image


def draw_into(folder: Path, plot: Plot) -> dict[str, Failed]:
    """Write a plot as SVG and as PNG into a folder and return the failure, if any."""
    (drawn,) = apart([(plot.name, partial(draw_plot, plot, folder))], PICTURE_SECONDS)
    return {f"the plot {plot.name}": drawn} if isinstance(drawn, Failed) else {}


def report_missing(failed: dict[str, Failed]) -> int:
    """Report what is missing in a file that was written, and return the exit status."""
    if failed:
        said = "; ".join(f"{name}: {failure.reason}" for name, failure in failed.items())
        say(f"Error: missing in it: {said}")
    return int(bool(failed))


def require_results(directory: Path) -> set[str]:
    """Return the files of a results folder that pinstress wrote.

    Raises: InputError.
    """
    known = manifest.listed(directory)
    if known is None:
        raise InputError(
            f"{directory}: {lacking(directory, 'has no results of pinstress')}; give a folder "
            "written by `pinstress run` or `pinstress loads`",
            code="no-results",
        )
    return known


def lacking(directory: Path, else_lacks: str = "contains no results.json") -> str:
    """Return the reason why a folder has no results."""
    if not os.path.lexists(directory):
        return "no such folder"
    return else_lacks if directory.is_dir() else "not a folder"


def report_failed(directory: Path, failed: dict[str, Failed]) -> int:
    """Report the files that could not be drawn in one message, and return the exit status."""
    if not failed:
        return 0
    ordered = sorted(failed.items(), key=lambda item: item[0] != PDF_FILE)
    by_reason = grouped((failure.reason, name) for name, failure in ordered)
    said = "; ".join(f"{_listed(names)}: {why}" for why, names in by_reason.items())
    ways = ["pdf"] * (PDF_FILE in failed) + ["plots"] * bool(failed.keys() - {PDF_FILE})
    again = " and ".join(f"`pinstress {way} {as_argument(str(directory))}`" for way in ways)
    say(
        f"Error: not drawn: {said}. All other results in {directory} are complete; {again} "
        f"{'tries' if len(ways) == 1 else 'try'} again."
    )
    return 1


def add_plots(directory: Path, quiet: bool = False) -> Drawn:
    """Draw the plots of a folder's report, and pictures of its pins from their fields, into the
    folder.

    Raises: InputError if the folder is damaged or cannot be written.
    """
    with TemporaryDirectory(prefix="pinstress-") as folder:
        drawn = _drawn(directory, Path(folder), quiet)
        for failure in drawn.failed.values():
            if failure.damaged:
                raise _unreadable(directory, failure.reason)
        _add(directory, {f"{PLOTS_FOLDER}/{path.name}": path for path in drawn.paths})
        return drawn


def add_pdf(directory: Path) -> dict[str, Failed]:
    """Write report.pdf from the folder's report.html; return the failure if it could not be made.

    Raises: InputError if the folder is damaged or cannot be written.
    """
    try:
        is_inside(directory, PDF_FILE)  # refuse a link before the long work
        page = _page(directory)
        open_results(directory)  # refuses results of another version, whose texts differ
        content = document_of(page)
        shown = set() if content is None else set(shown_plots(content))
        drawings = {plot.name: plot for plot in plots_of(page) if plot.name in shown}
    except FileNotFoundError as error:
        if Path(error.filename).name == RESULTS_JSON:
            text = f"{directory}: {lacking(directory)}; run the study again"
            raise InputError(text, code="no-results") from None
        content = None
    except (OSError, Damaged) as error:
        raise _unreadable(directory, error) from None
    if content is None:
        raise InputError(f"{directory}: {NO_PAGE_MESSAGE}", code="no-results")
    with TemporaryDirectory(prefix="pinstress-") as folder:
        path = Path(folder, PDF_FILE)
        (printed,) = apart([(PDF_FILE, partial(_print, content, drawings, path))], PDF_SECONDS)
        if printed is None:
            _add(directory, {PDF_FILE: path})
            return {}
        if printed.damaged:
            raise _unreadable(directory, printed.reason)
        return {PDF_FILE: printed}


def _drawn(directory: Path, into: Path, quiet: bool) -> Drawn:
    try:
        shown = plots_of(_page(directory))
        opened = open_results(directory)
        solid = is_inside(directory, "vtk")
    except FileNotFoundError:
        text = f"{directory}: no report.html and results.json to draw from"
        raise InputError(text, code="no-results") from None
    except (OSError, Damaged) as error:
        raise _unreadable(directory, error) from None
    work: list[tuple[str, Callable[[], Sequence[Path]]]] = [
        (f"{PLOTS_FOLDER}/{plot.name}.svg", partial(draw_plot, plot, into)) for plot in shown
    ]
    rows = opened.content["pins"]
    problem = renderer_problem() if solid else "the folder has no fields (vtk/)"
    if rows and problem is not None and not quiet:
        say(f"No pictures of the pins: {problem}")
    if rows and problem is None:
        preload(*PICTURE_MODULES)
        for row in rows:
            name = f"pin_{field_name(row['pin'], row['case'])}.png"
            picture = partial(draw_pin, opened.only(row), into / name)
            work.append((f"{PLOTS_FOLDER}/{name}", picture))
    results = apart(work, PICTURE_SECONDS)
    drawings = list(zip((name for name, _ in work), results, strict=True))
    paths = [path for _, one in drawings if not isinstance(one, Failed) for path in one]
    return Drawn(tuple(paths), {name: one for name, one in drawings if isinstance(one, Failed)})


def draw_pin(opened: Opened, path: Path, top: float | None = None) -> list[Path]:
    """Draw a picture of the only row and return its path. A beam has no field and gets no picture.

    Raises: Damaged.
    """
    from reports.vtk.render import render_pin

    (row,) = opened.content["pins"]
    try:
        field = opened.field(row)
    except FileNotFoundError:
        return []
    except NotPlain as error:
        raise Damaged(str(error)) from None
    render_pin(field, path, opened.units, opened.title(row), top)
    return [path]


def _print(content: Content, shown: dict[str, Plot], path: Path) -> None:
    path.write_bytes(typeset(content, shown))


def _page(directory: Path) -> str:
    """Return the text of report.html.

    Raises: Damaged, OSError.
    """
    try:
        return read_inside(directory, REPORT_PAGE, MAX_RESULTS_SIZE).decode("utf-8")
    except UnicodeDecodeError as error:
        raise Damaged(f"{REPORT_PAGE} is damaged: no UTF-8 from byte {error.start:,} on") from None


def _add(directory: Path, files: dict[str, Path]) -> None:
    """Add files to a folder and its manifest.

    The manifest comes first, so that a killed process leaves no file that is not listed.
    """
    names = [*files, *({f"{PLOTS_FOLDER}/"} if any("/" in name for name in files) else ())]
    partial_names = manifest.partial_names(files)
    try:
        manifest.add(directory, [*names, *partial_names])
        for name, path in files.items():
            write_inside(directory, name, path.read_bytes())
        manifest.drop(directory, partial_names)
    except OSError as error:
        raise cannot_write(directory, error) from None


def _entries(directory: Path) -> set[str]:
    """Return all entries of a results folder.

    Raises: InputError if it cannot be read.
    """
    try:
        return manifest.entries(directory)
    except OSError as error:
        raise _unreadable(directory, error.strerror) from None


def _unreadable(directory: Path, why: object) -> InputError:
    return InputError(f"{directory}: {why}", code="unreadable-results")


def _strange(directory: Path, name: str) -> InputError:
    text = f"{directory}: pinstress did not write {name}; move it elsewhere"
    return InputError(text, code="strange-file")


def _listed(names: Iterable[str]) -> str:
    all_names = list(names)
    more = len(all_names) - MAX_NAMED_FILES
    return ", ".join(all_names[:MAX_NAMED_FILES]) + (f" and {more} more" if more > 0 else "")

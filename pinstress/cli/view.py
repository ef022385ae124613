"""The `view` command, which shows a pin of an earlier run in a window or writes a picture."""

from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from pinbase.processes.apart import apart
from pinbase.processes.pool import preload
from pinstress.cli.new_file import require_new, write_new, write_over
from pinstress.cli.plots import PICTURE_MODULES, PICTURE_SECONDS, lacking
from pinstress.cli.shared import say
from pinstress.study.reading.errors import InputError
from reports.vtk.read_back import Opened, open_results
from reports.vtk.render import render_pin, show_pin
from reports.vtk.renderer import renderer_problem

OVERWRITE_REMEDY = "choose another file, or overwrite it with --force"


def view(
    directory: Path,
    pin: str | None,
    case: str | None,
    screenshot: Path | None,
    force: bool = False,
) -> int:
    """Show a pin of a results folder, by default the one with the lowest factor.

    Returns the exit status: 1 if the pin could not be drawn.

    screenshot: a PNG file to write instead of opening a window.
    force: whether to overwrite the file.

    Raises: InputError.
    """
    opened = opened_results(directory)
    try:
        row = opened.row(pin, case)
        field = opened.field(row)
    except FileNotFoundError as error:
        raise InputError(
            f"{error}: no such file; there is no field for a beam, for a pin that was not "
            "solved, or after a run with --vtk none",
            code="no-field",
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{directory}: {error}", code="unreadable-results") from None
    title = opened.title(row)
    preload(*PICTURE_MODULES)
    if screenshot is None:
        _require_display()
        show_pin(field, opened.units, title)
        return 0
    if screenshot.suffix.lower() != ".png" or not screenshot.parent.is_dir():
        raise InputError(
            f"--screenshot {screenshot}: give a .png file in an existing folder",
            code="not-a-picture",
        )
    if not force:
        require_new(screenshot, OVERWRITE_REMEDY)
    problem = renderer_problem()
    if problem is not None:
        raise InputError(
            f"--screenshot: {problem}; install libosmesa6 or libegl1", code="no-display"
        )
    with TemporaryDirectory(prefix="pinstress-") as folder:
        picture = Path(folder) / "pin.png"
        drawing = partial(render_pin, field, picture, opened.units, title)
        (drawn,) = apart([(picture.name, drawing)], PICTURE_SECONDS)
        if drawn is not None:
            say(f"Error: {screenshot} could not be drawn: {drawn.reason}")
            return 1
        if force:
            _require_replaceable(screenshot)
            write_over(screenshot, picture.read_bytes())
        else:
            write_new(screenshot, picture.read_bytes(), OVERWRITE_REMEDY)
    return 0


def _require_replaceable(path: Path) -> None:
    """Check that a picture may take the place of what is at `path`: a file, a link or nothing.

    Raises: InputError for anything else.
    """
    if os.path.lexists(path) and not (path.is_file() or path.is_symlink()):
        raise InputError(
            f"--screenshot {path} is not a regular file and cannot be overwritten; choose another",
            code="not-a-file",
        )


def opened_results(directory: Path) -> Opened:
    """Open a folder that a run wrote.

    Raises: InputError.
    """
    try:
        return open_results(directory)
    except (FileNotFoundError, NotADirectoryError):
        raise InputError(
            f"{directory}: {lacking(directory)}; give a folder written by `pinstress run`",
            code="no-results",
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{directory}: {error}", code="unreadable-results") from None


def _require_display() -> None:
    shows = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if sys.platform == "linux" and not shows:
        raise InputError(
            "there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set); "
            "--screenshot FILE.png writes a picture instead",
            code="no-display",
        )

"""The `view` command: a pin of an earlier run in a window, or as a picture."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from pinstress.errors import InputError
from reports.opened import Opened, open_results
from reports.picture import render_pin, show_pin
from reports.renderer import renderer_problem


def view(directory: Path, pin: str | None, case: str | None, screenshot: Path | None) -> None:
    """Show a pin of a results folder; the one with the lowest factor by default.

    screenshot: a PNG file to write instead of opening a window. Raises: InputError.
    """
    opened = _opened(directory)
    try:
        row = opened.row(pin, case)
        field = opened.field(row)
    except ValueError as error:
        raise InputError(f"{directory}: {error}") from None
    except FileNotFoundError as error:
        raise InputError(
            f"{error}: no such file; a beam has no field, nor has a pin that was not solved, "
            "nor a run with --vtk none"
        ) from None
    title = opened.title(row)
    if screenshot is None:
        _require_display()
        show_pin(field, opened.units, title)
        return
    if screenshot.suffix.lower() != ".png" or not screenshot.parent.is_dir():
        raise InputError(f"--screenshot {screenshot}: name a .png file in a folder that exists")
    problem = renderer_problem()
    if problem is not None:
        raise InputError(f"--screenshot: {problem}; install libosmesa6 or libegl1")
    render_pin(field, screenshot, opened.units, title)


def _opened(directory: Path) -> Opened:
    try:
        return open_results(directory)
    except OSError:
        raise InputError(
            f"{directory}: no results.json in it; name the folder that `pinstress run` wrote"
        ) from None
    except ValueError as error:
        raise InputError(f"{directory}: {error}") from None


def _require_display() -> None:
    shows = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if sys.platform == "linux" and not shows:
        raise InputError(
            "there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set); "
            "--screenshot FILE.png writes a picture instead"
        )

"""Helpers shared by the commands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from pinstress.study.file import Study


def example(text: str) -> str:
    """The first line of a help text: an example, not wrapped."""
    return f"\b\nExample: {text}\n"


def names(_: click.Context, __: click.Parameter, value: str | None) -> list[str] | None:
    """A,B as a list."""
    if value is None:
        return None
    found = [n.strip() for n in value.split(",") if n.strip()]
    if not found:
        raise click.BadParameter("empty list; write for example A,B")
    return found


def read_study(path: Path) -> Study:
    """Load a study; warn of implausible or contradictory numbers. Raises: InputError."""
    from pinstress.model.weights import weight_warnings
    from pinstress.study.file import load_study

    study = load_study(path)
    for warning in (*study.warnings, *weight_warnings(study)):
        click.echo(f"Warning: {warning}", err=True)
    return study


def open_page(page: Path) -> None:
    """Open a page in the browser, if there is one."""
    import webbrowser

    if not webbrowser.open(page.resolve().as_uri()):
        click.echo(f"No browser found; open {page} yourself.", err=True)

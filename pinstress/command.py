"""What the commands of the command line share."""

from __future__ import annotations

import signal
from pathlib import Path

import click

INTERRUPTS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP


def example(text: str) -> str:
    """A help text that begins with an example, kept on its own line."""
    return f"\b\nExample: {text}\n"


def names(_: click.Context, __: click.Parameter, value: str | None) -> list[str] | None:
    """A,B as a list."""
    if value is None:
        return None
    found = [n.strip() for n in value.split(",") if n.strip()]
    if not found:
        raise click.BadParameter("names none; write for instance A,B")
    return found


def open_page(page: Path) -> None:
    """Show a page in the browser, if there is one."""
    import webbrowser

    if not webbrowser.open(page.resolve().as_uri()):
        click.echo(f"No browser was found; open {page} yourself.", err=True)

"""The `export` command, which writes the input deck of one row for a reviewer."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal
from urllib.parse import quote

import click

from pinstress.cli.new_file import require_new, write_new, write_over
from pinstress.cli.shared import QUIET_OPTION, example, read_study, say
from pinstress.study.reading.choices import ChoiceError
from pinstress.study.reading.errors import InputError, cannot_write

OVERWRITE_REMEDY = "choose another --out, or --force to replace it"


@click.command(
    short_help="Write one pin as an input file for another program.",
    help=example("pinstress export studies/one_pin.toml B landing --deck calculix")
    + "\nWrite a pin in a case, with its lugs, contact and loads at the governing instant, as one "
    "input file for CalculiX or Abaqus, in the study's units. The comments at its head have the "
    "expected numbers: maximum, safety factor, section moment, and the node at which to compare "
    "stress; and what differs.\n\n"
    "Exit status: 0 done; 2 bad input, or a row that the file cannot have; 130 interrupted.",
)
@click.argument("study", type=click.Path(path_type=Path))
@click.argument("pin")
@click.argument("case")
@click.option(
    "--deck",
    type=click.Choice(["calculix", "abaqus"]),
    required=True,
    help="The program that reads it.",
)
@click.option("--out", type=click.Path(path_type=Path), help="The file [out/<study>-PIN-CASE.inp].")
@click.option("--force", is_flag=True, help="Replace an existing file.")
@QUIET_OPTION
def export(
    study: Path,
    pin: str,
    case: str,
    deck: Literal["calculix", "abaqus"],
    out: Path | None,
    force: bool,
    quiet: bool,
) -> int:
    loaded = read_study(study)
    parts = (loaded.name, pin, case)
    path = out or Path("out") / f"{'-'.join(quote(part, safe='') for part in parts)}.inp"
    _require_writable(path, force, make_folder=out is None)
    from pinstress.analysis.export import review_deck

    def tell(step: str) -> None:
        if not quiet:
            say(f"{step} ...")

    try:
        lines = review_deck(loaded, pin, case, deck, tell)
    except ChoiceError as error:  # its text begins with an option, but here it is an argument
        raise InputError(str(error).partition(": ")[2], code=error.code) from None
    content = "".join(f"{line}\n" for line in lines).encode("ascii")
    if force:
        write_over(path, content)
    else:
        write_new(path, content, OVERWRITE_REMEDY)
    click.echo(f"Written: {path}")
    return 0


def _require_writable(path: Path, force: bool, make_folder: bool) -> None:
    """Check that a file can be written, before the pin is solved.

    make_folder: whether to create its folder.

    Raises: InputError.
    """
    if not force:
        require_new(path, OVERWRITE_REMEDY)
    elif path.is_dir():
        raise InputError(f"{path}: is a folder; --out names a file", code="not-a-file")
    try:
        if make_folder:
            path.parent.mkdir(parents=True, exist_ok=True)
        if not path.parent.is_dir():
            raise FileNotFoundError(2, "no such folder")
        if not os.access(path.parent, os.W_OK):
            raise PermissionError(13, "Permission denied")
    except OSError as error:
        raise cannot_write(path, error) from None

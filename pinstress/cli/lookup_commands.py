"""The commands that look something up: fits and materials."""

from __future__ import annotations

from pathlib import Path

import click

from pinstress.cli.shared import PATH, example

JSON_OPTION = click.option("--json", "as_json", is_flag=True, help="Print JSON instead of text.")


@click.command(
    short_help="Print the limits and the clearance of an ISO 286 fit.",
    help=example("pinstress fits 40 H7/f7")
    + "\nPrint the limits of hole and shaft and the least and largest clearance of a fit FIT by "
    "ISO 286-1, at a nominal diameter SIZE in mm, or with its unit ('1.5 in'). A lug has the same "
    'by fit = "H7/f7".',
)
@click.argument("size")
@click.argument("fit")
@JSON_OPTION
def fits(size: str, fit: str, as_json: bool) -> None:
    from pinstress.cli.fits import fits as look_up

    look_up(size, fit, as_json)


@click.command(
    short_help="List materials with the sources of their values.",
    help=example('pinstress materials "6061-T651"')
    + "\nList the materials that a study may name without defining them, or print one of them, "
    "NAME, as a study would define it, each value with its source.",
)
@click.argument("name", required=False)
@click.option(
    "--materials",
    "file",
    type=PATH,
    metavar="FILE",
    help='Also those of this file, which a study names as materials = "FILE".',
)
@JSON_OPTION
def materials(name: str | None, file: Path | None, as_json: bool) -> None:
    from pinstress.cli.materials import materials as look_up

    look_up(name, file, as_json)

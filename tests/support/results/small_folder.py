"""A results folder as a run writes it, of one pin in one case, made without a solution."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from pinstress.cli import manifest
from reports.files import write_reports
from reports.vtk.fields import write_vtu
from tests.support.results.made_up_run import UNITS, make_field, make_results, pin, shape, static

VTU = "vtk/B_landing.vtu"
SECRET = b"what is outside of the folder"


def small_folder(folder: Path) -> Path:
    """Make the folder with its tables, page and field, listed in its manifest, and return it."""
    results = replace(
        make_results(),
        pins=(pin("B", "landing"),),
        shapes=(shape("B"),),
        reactions=(static(),),
        drive=(),
        motion=(),
        published=(),
        beam_check=None,
        motion_check=None,
    )
    folder.mkdir(parents=True)
    write_reports(results, folder)
    (folder / "vtk").mkdir()
    write_vtu(make_field(), folder / VTU, UNITS)
    manifest.complete(folder)
    return folder

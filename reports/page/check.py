"""A checked study in one offline file: its linkage with loads, its pins, and the rows to solve."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from reports.data.check import CheckedStudy, PlannedRow
from reports.data.results import PinShape
from reports.data.row import Units
from reports.data.skeleton import Skeleton
from reports.folder.inside import write_inside
from reports.format.numbers import drawn
from reports.format.template import rendered
from reports.page.linkage_drawing import draw_linkage
from reports.page.linkage_panel import Instant, Mark
from reports.page.pin_drawing import draw_pin
from reports.tables.column import Column, Table, fields, headed, texts

MAX_DRAWN_CASES = 6  # cases whose linkage is drawn
MAX_DRAWN_PINS = 60  # the table lists all pins

ROW_COLUMNS: list[Column[PlannedRow]] = [
    *texts("pin case support model"),
    *headed("instants", show="{:,}".format),
    *fields("largest", "force", heading="largest force"),
    *fields("at", heading="from link", numeric=False),
]


def write_check(study: CheckedStudy, path: Path) -> None:
    """Write the page so that its file is complete or unchanged.

    Raises: OSError.
    """
    there = Path(os.path.realpath(path))  # `path` may be a link
    write_inside(there.parent, there.name, render(study).encode())


def render(study: CheckedStudy) -> str:
    """Return the page as text."""
    from markupsafe import Markup

    units = study.units
    return rendered(
        "check.html.j2",
        study=study,
        units=units,
        linkages=[
            (
                skeleton.case + ": a run finds its forces" * (skeleton.case in study.by_run),
                Markup(_loaded(skeleton, units)),
            )
            for skeleton in study.skeletons[:MAX_DRAWN_CASES]
        ],
        pins=[
            (
                pin.shape.pin,
                pin.shape.material,
                Markup(draw_pin(pin.shape, units)),
                _lug_words(pin.shape, units.length) or [pin.support],
            )
            for pin in study.pins[:MAX_DRAWN_PINS]
        ],
        more_linkages=len(study.skeletons) - MAX_DRAWN_CASES,
        more_pins=len(study.pins) - MAX_DRAWN_PINS,
        rows=Table("planned", ROW_COLUMNS, study.rows).grid(units),
    )


def _loaded(skeleton: Skeleton, units: Units) -> str:
    """Return the drawing of the linkage at the instant of the largest applied force, with joint
    names.
    """
    sizes = sum((load.sizes for load in skeleton.forces), np.zeros(len(skeleton.position)))
    title = f"The linkage in case {skeleton.case}, with its applied forces"
    marks = [Mark(joint, joint) for joint in skeleton.joints]
    return draw_linkage(
        Instant(skeleton, int(np.argmax(sizes))), marks, title, units.force, units.length
    )


def _lug_words(shape: PinShape, unit: str) -> list[str]:
    """Return a line for each group of lugs of the same size, material and clearance."""
    alike: dict[str, list[str]] = {}
    for lug in shape.lugs:
        size = f"⌀{drawn(lug.outer_diameter)} {unit}, {lug.material}"
        clearance = f"clearance {drawn(lug.clearance)} {unit}"
        alike.setdefault(f"{size}, {clearance}", []).append(lug.connection)
    return [
        f"lug{'s' * (len(names) > 1)} {', '.join(names)}: {words}" for words, names in alike.items()
    ]
